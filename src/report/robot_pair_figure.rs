//! Two robots beside each other, as the one a search began with and the one it found.

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::panel::{BOTTOM, LEFT};
use super::robot_3d::{self, Drawing, SpatialRobotFigure};
use super::robot_figure::{self, RobotFigure};
use super::style::{DOUBLE_COLUMN, MARGIN, TITLE};
use super::table::Table;
use plotters::style::text_anchor::HPos;

/// One of two robots, with its title above it.
#[derive(Clone, Debug)]
pub enum PairedRobot<'a> {
    /// A robot in the plane.
    Planar(RobotFigure<'a>),
    /// A robot in space.
    Spatial(SpatialRobotFigure),
}

/// Two robots, each at its own scale.
#[derive(Clone, Debug)]
pub struct RobotPairFigure<'a> {
    /// The robots, left and right.
    pub robots: [PairedRobot<'a>; 2],
}

/// Width of a robot's half of the figure, points.
const HALF: f64 = 0.5 * DOUBLE_COLUMN;
/// Height above the robots: legend and titles, points.
const HEAD: f64 = MARGIN + LEGEND_ROW + 18.0;
/// Side of a planar robot's panel, points.
const SIDE: f64 = HALF - LEFT - 2.0 * MARGIN;

impl PairedRobot<'_> {
    fn title(&self) -> &str {
        match self {
            PairedRobot::Planar(robot) => &robot.title,
            PairedRobot::Spatial(robot) => &robot.title,
        }
    }

    /// The robot placed in the half that begins at `left`; nothing to place for planar ones.
    fn placed(&self, left: f64) -> Option<Drawing> {
        match self {
            PairedRobot::Planar(_) => None,
            PairedRobot::Spatial(robot) => {
                Some(robot.place_in([left + MARGIN, HEAD], HALF - 2.0 * MARGIN))
            }
        }
    }

    fn height(&self) -> f64 {
        self.placed(0.0)
            .map_or(SIDE + BOTTOM, |drawing| drawing.height)
    }

    fn draw(&self, canvas: &mut Canvas, left: f64) {
        // An underscore in a text makes an index of what follows.
        let title = self.title().replace('_', "-");
        let title = Label::new(&title, TITLE).bold().align(HPos::Center);
        let at = [left + 0.5 * HALF, HEAD - 5.0];
        title.draw_within(canvas, at, HALF - 2.0 * MARGIN);
        match (self, self.placed(left)) {
            (PairedRobot::Planar(robot), _) => {
                robot.draw_in(canvas, [left + LEFT + 2.0, HEAD + 2.0], SIDE);
            }
            (_, Some(drawing)) => drawing.draw(canvas),
            _ => {}
        }
    }

    fn table(&self) -> Table {
        match self {
            PairedRobot::Planar(robot) => robot.table(),
            PairedRobot::Spatial(robot) => robot.table(),
        }
    }
}

impl RobotPairFigure<'_> {
    fn legend_entries(&self) -> Vec<(Swatch, &'static str)> {
        let mut entries = Vec::new();
        if self
            .robots
            .iter()
            .any(|r| matches!(r, PairedRobot::Planar(_)))
        {
            entries.extend(robot_figure::LEGEND);
        }
        let kinds = self.robots.iter().filter_map(|robot| match robot {
            PairedRobot::Planar(_) => None,
            PairedRobot::Spatial(robot) => Some(robot.kinds()),
        });
        let either = |a: [bool; 2], b: [bool; 2]| [a[0] || b[0], a[1] || b[1]];
        if let Some([turns, slides]) = kinds.reduce(either) {
            entries.extend(robot_3d::legend_entries(turns, slides));
        }
        entries
    }
}

impl Figure for RobotPairFigure<'_> {
    fn name(&self) -> &str {
        "robots"
    }

    fn caption(&self) -> String {
        let titles = self.robots.each_ref().map(PairedRobot::title);
        let is_spatial = |robot| matches!(robot, &PairedRobot::Spatial(_));
        let how = match self.robots.iter().all(is_spatial) {
            true => ", in postures that show their joints, numbered from the base",
            false => ", seen from above",
        };
        let [left, right] = titles;
        format!("Left: {left}. Right: {right}. The robots{how}, each at its own scale.")
    }

    fn size(&self) -> Size {
        let heights = self.robots.each_ref().map(PairedRobot::height);
        Size {
            width: DOUBLE_COLUMN,
            height: HEAD + heights[0].max(heights[1]) + MARGIN,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let entries = self.legend_entries();
        let at = [14.0, MARGIN + 3.0];
        let width = (DOUBLE_COLUMN - 14.0 - MARGIN).min(100.0 * entries.len() as f64);
        legend(canvas, at, width, entries.len(), &entries);
        for (robot, left) in self.robots.iter().zip([0.0, HALF]) {
            robot.draw(canvas, left);
        }
    }

    /// The rows of both robots; columns that only one of them has are empty for the other.
    fn table(&self) -> Table {
        let tables = self.robots.each_ref().map(PairedRobot::table);
        let mut header: Vec<String> = vec!["robot".into()];
        for name in tables.iter().flat_map(|table| &table.header) {
            if !header.contains(name) {
                header.push(name.clone());
            }
        }
        let mut rows = Vec::new();
        for (robot, table) in self.robots.iter().zip(&tables) {
            for cells in &table.rows {
                let mut row = vec![String::new(); header.len()];
                row[0] = robot.title().to_owned();
                for (name, cell) in table.header.iter().zip(cells) {
                    if let Some(column) = header.iter().position(|known| known == name) {
                        row[column] = cell.clone();
                    }
                }
                rows.push(row);
            }
        }
        Table { header, rows }
    }
}
