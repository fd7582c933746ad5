//! The ranges of all joints over the manifolds of a location as bars [S1 Fig. 5b].

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::joint_bars;
use super::label::Label;
use super::panel::BOTTOM;
use super::style::{DOUBLE_COLUMN, MARGIN, TITLE};
use super::table::{Table, cell};
use crate::angle::AngleSet;
use plotters::style::text_anchor::HPos;

/// The ranges of all joints.
#[derive(Clone, Debug)]
pub struct JointRangesFigure<'a> {
    /// The angles that every joint takes.
    pub ranges: &'a [AngleSet],
    /// Title above the bars; none if empty.
    pub title: String,
}

const HEAD: f64 = 32.0;

impl Figure for JointRangesFigure<'_> {
    fn name(&self) -> &'static str {
        "joint_ranges"
    }

    fn caption(&self) -> String {
        let sum: f64 = self.ranges.iter().map(AngleSet::measure).sum();
        format!(
            "The angles that every joint takes over all self-motion manifolds of the location; \
             their sum, the size of the location, is {sum:.4} rad."
        )
    }

    fn size(&self) -> Size {
        Size {
            width: DOUBLE_COLUMN,
            height: HEAD + joint_bars::height(self.ranges.len()) + BOTTOM + 2.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        let middle = [0.5 * DOUBLE_COLUMN, 12.0];
        title.draw_within(canvas, middle, DOUBLE_COLUMN - 2.0 * MARGIN);
        let panel = joint_bars::panel(HEAD, self.ranges.len());
        joint_bars::draw(canvas, &panel, self.ranges, "all manifolds", None);
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&["joint", "lower_deg", "upper_deg"]);
        for (number, range) in (1..).zip(self.ranges) {
            for arc in range.arcs() {
                let ends = [arc.start(), arc.end()].map(|end| cell(end.to_degrees()));
                table
                    .rows
                    .push([vec![format!("{number}")], ends.to_vec()].concat());
            }
        }
        table
    }
}
