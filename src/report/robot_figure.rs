//! A planar robot on its own, with what it reaches.

use super::arm::Arm;
use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::panel::{BOTTOM, LEFT, Panel};
use super::polar;
use super::style::{COLUMN, GREY, INK, MARGIN, PALE, TITLE, translucent};
use super::table::{Table, cell};
use super::ticks;
use plotters::style::text_anchor::HPos;
use std::f64::consts::TAU;

/// A planar robot stretched into a gentle curve over the annulus it reaches.
#[derive(Clone, Debug)]
pub struct RobotFigure<'a> {
    /// Name above the plot.
    pub title: String,
    /// Lengths of the links, metres.
    pub links: &'a [f64],
    /// Radii [inner, outer] that it reaches with all joints free, metres.
    pub unrestricted: [f64; 2],
}

/// The angle between neighbouring links (radians): enough to tell the joints apart.
const BEND: f64 = 0.45;

/// What a legend tells about planar robots.
pub(super) const LEGEND: [(Swatch, &str); 2] = [
    (Swatch::Area(PALE, GREY), "unrestricted workspace"),
    (Swatch::Arm(INK), "arm"),
];

impl RobotFigure<'_> {
    fn side() -> f64 {
        COLUMN - LEFT - MARGIN - 2.0
    }

    fn head() -> f64 {
        12.0 + LEGEND_ROW + MARGIN + 2.0
    }

    fn angles(&self) -> Vec<f64> {
        vec![BEND; self.links.len()]
    }

    /// The robot and what it reaches in a square of `side` points, axes beside it.
    pub(super) fn draw_in(&self, canvas: &mut Canvas, [left, top]: Point, side: f64) {
        let reach = 1.05 * self.unrestricted[1];
        let panel = Panel {
            left,
            top,
            width: side,
            height: side,
            x: [-reach, reach],
            y: [-reach, reach],
        };
        let annulus = polar::sector([0.0, 0.0], self.unrestricted, 0.0, TAU);
        canvas.fill(&panel.path(&annulus), PALE);
        for radius in self.unrestricted.into_iter().filter(|r| *r > 0.0) {
            let circle = polar::arc([0.0, 0.0], radius, 0.0, TAU);
            canvas.stroke(&panel.path(&circle), 0.5, GREY);
        }
        let nothing = crate::workspace::ArtificialLimits::new(Vec::new());
        let arm = Arm::new(self.links, &self.angles());
        arm.draw(canvas, &panel, &nothing, translucent(PALE, 0.0));
        let ticks = ticks::round(-reach, reach, 5);
        panel.axes(canvas, &ticks, &ticks, true);
        panel.x_label(canvas, "x (m)");
        panel.y_label(canvas, "y (m)", &ticks);
    }
}

impl Figure for RobotFigure<'_> {
    fn name(&self) -> &'static str {
        "robot"
    }

    fn caption(&self) -> String {
        "The robot and its unrestricted workspace (grey), seen from above.".into()
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: Self::head() + Self::side() + BOTTOM,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * COLUMN, 10.0], COLUMN - 2.0 * MARGIN);
        let top = Self::head() - 0.5 * LEGEND_ROW - 4.0;
        legend(canvas, [14.0, top], COLUMN - 14.0 - MARGIN, 2, &LEGEND);
        self.draw_in(canvas, [LEFT, Self::head()], Self::side());
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&["joint", "link_length_m"]);
        for (joint, length) in (1..).zip(self.links) {
            table.rows.push(vec![joint.to_string(), cell(*length)]);
        }
        table
    }
}
