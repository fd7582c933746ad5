//! The workspaces of two planar robots beside each other, as the one a search began with and the
//! one it found, at one scale.

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, legend};
use super::panel::{BOTTOM, LEFT};
use super::style::{DOUBLE_COLUMN, MARGIN, TITLE};
use super::table::Table;
use super::workspace_figure::WorkspaceFigure;
use plotters::style::text_anchor::HPos;

/// Two robots with their workspaces, each with its title.
#[derive(Clone, Debug)]
pub struct WorkspacePairFigure<'a> {
    /// Left and right.
    pub robots: [WorkspaceFigure<'a>; 2],
}

/// Width of a robot's half of the figure, points.
const HALF: f64 = 0.5 * DOUBLE_COLUMN;
/// Height above the plots: legend and titles, points.
const HEAD: f64 = MARGIN + LEGEND_ROW + 18.0;

impl WorkspacePairFigure<'_> {
    /// Side of either plot, points.
    fn side(&self) -> f64 {
        let right = self.robots.each_ref().map(WorkspaceFigure::right);
        HALF - LEFT - right[0].max(right[1])
    }
}

impl Figure for WorkspacePairFigure<'_> {
    fn name(&self) -> &str {
        "robots"
    }

    fn caption(&self) -> String {
        let [left, right] = self.robots.each_ref().map(|robot| &robot.title);
        format!("(a) {left}; (b) {right}. {}", self.robots[0].caption())
    }

    fn size(&self) -> Size {
        Size {
            width: DOUBLE_COLUMN,
            height: HEAD + self.side() + BOTTOM,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let entries = self.robots[0].legend_entries();
        let width = (DOUBLE_COLUMN - 14.0 - MARGIN).min(130.0 * entries.len() as f64);
        let at = [14.0, MARGIN + 3.0];
        legend(canvas, at, width, entries.len(), &entries);
        let [a, b] = self.robots.each_ref().map(WorkspaceFigure::reach);
        for (number, robot) in self.robots.iter().enumerate() {
            let left = number as f64 * HALF;
            // An underscore in a text makes an index of what follows.
            let title = robot.title.replace('_', "-");
            let title = format!("{} {title}", ["(a)", "(b)"][number]);
            let label = Label::new(&title, TITLE).bold().align(HPos::Center);
            let middle = left + LEFT + 0.5 * self.side();
            label.draw_within(canvas, [middle, HEAD - 5.0], HALF - 2.0 * MARGIN);
            robot.draw_in(canvas, [left + LEFT, HEAD], self.side(), a.max(b));
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::default();
        for robot in &self.robots {
            let own = robot.table();
            table.header = ["robot".to_owned()].into_iter().chain(own.header).collect();
            let named = own.rows.into_iter().map(|row| {
                let title = [robot.title.clone()];
                title.into_iter().chain(row).collect()
            });
            table.rows.extend(named);
        }
        table
    }
}
