//! How much the score depends on each limit near the optimum.

use super::canvas::Point;
use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, dashed, legend};
use super::number::{joint_symbol, with_unit};
use super::panel::{BOTTOM, Panel, left, range};
use super::style::{BLUE, COLUMN, GREEN, GREY, MARGIN, NORMAL, VERMILLION};
use super::table::{Table, cell, column};
use super::ticks::{self, Tick};
use plotters::style::RGBAColor;
use plotters::style::text_anchor::HPos;

/// The score along each limit, the others held at the optimum.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sensitivity {
    /// What is maximised, as in "S_F".
    pub score_label: String,
    /// Unit of the score, as in "m^2"; may be empty.
    pub unit: String,
    /// What the marked point of every curve is, as in "optimum".
    pub mark: String,
    /// Curves, drawn in one panel per joint.
    pub curves: Vec<SensitivityCurve>,
}

/// Which limit of a joint is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitSide {
    /// The lower limit a̲.
    Lower,
    /// The upper limit ā.
    Upper,
    /// Both, symmetric about zero: ā = −a̲ is varied.
    HalfWidth,
}

/// The score against one limit.
#[derive(Clone, Debug, PartialEq)]
pub struct SensitivityCurve {
    /// Number of the joint, from 1.
    pub joint: usize,
    /// The limit that is varied.
    pub side: LimitSide,
    /// Limit (radians) and score, in order of the limit.
    pub values: Vec<(f64, f64)>,
    /// Limit (radians) and score at the optimum.
    pub optimum: (f64, f64),
}

/// Height of a panel with its labels, points.
const ROW: f64 = 96.0;

impl LimitSide {
    fn name(self) -> &'static str {
        match self {
            LimitSide::Lower => "lower limit",
            LimitSide::Upper => "upper limit",
            LimitSide::HalfWidth => "half-width",
        }
    }

    fn colour(self) -> RGBAColor {
        match self {
            LimitSide::Lower => BLUE,
            LimitSide::Upper => VERMILLION,
            LimitSide::HalfWidth => GREEN,
        }
    }
}

impl Figure for Sensitivity {
    fn name(&self) -> &'static str {
        "sensitivity"
    }

    fn caption(&self) -> String {
        format!(
            "Score against each artificial limit, the others held at the {} (dashed).",
            self.mark
        )
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: self.head() + self.rows() as f64 * ROW + 11.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        self.draw_legend(canvas);
        let scores = self.score_range();
        let y_ticks = ticks::round(scores[0], scores[1], 4);
        let left = left(&y_ticks);
        for (k, joint) in self.joints().into_iter().enumerate() {
            let panel = self.panel(k, joint, left, scores);
            self.draw_joint(canvas, &panel, joint, &y_ticks, k % self.columns() == 0);
        }
        let whole = Panel {
            left,
            top: self.head(),
            width: COLUMN - left - MARGIN,
            height: self.rows() as f64 * ROW - BOTTOM + 9.0,
            x: [0.0, 1.0],
            y: [0.0, 1.0],
        };
        if self.curves.is_empty() {
            whole.remark(canvas, "no data");
        }
        whole.x_label(canvas, "artificial limit (deg)");
        let label = with_unit(&self.score_label, &self.unit);
        whole.y_label(canvas, &label, &y_ticks);
    }

    fn table(&self) -> Table {
        let score = column("score", &self.unit);
        let mut table = Table::new(&["joint", "side", "limit_deg", &score, "is_optimum"]);
        for curve in &self.curves {
            let optimum = std::iter::once((&curve.optimum, "true"));
            let values = curve.values.iter().map(|value| (value, "false"));
            for ((limit, score), is_optimum) in values.chain(optimum) {
                let side = curve.side.name().replace([' ', '-'], "_");
                let limit = cell(limit.to_degrees());
                let row = [
                    curve.joint.to_string(),
                    side,
                    limit,
                    cell(*score),
                    is_optimum.into(),
                ];
                table.rows.push(row.to_vec());
            }
        }
        table
    }
}

impl Sensitivity {
    /// Numbers of the joints, ascending.
    fn joints(&self) -> Vec<usize> {
        let mut joints: Vec<usize> = self.curves.iter().map(|curve| curve.joint).collect();
        joints.sort_unstable();
        joints.dedup();
        joints
    }

    fn sides(&self) -> Vec<LimitSide> {
        let all = [LimitSide::Lower, LimitSide::Upper, LimitSide::HalfWidth];
        let is_used = |side: &LimitSide| self.curves.iter().any(|curve| curve.side == *side);
        all.into_iter().filter(is_used).collect()
    }

    fn columns(&self) -> usize {
        self.joints().len().clamp(1, 2)
    }

    fn rows(&self) -> usize {
        self.joints().len().div_ceil(self.columns()).max(1)
    }

    fn head(&self) -> f64 {
        (self.sides().len() + 1).div_ceil(2) as f64 * LEGEND_ROW + MARGIN
    }

    /// From 0 (or the least score) to a little above the best, the same for all panels.
    fn score_range(&self) -> [f64; 2] {
        let scores = self
            .curves
            .iter()
            .flat_map(|c| c.values.iter().chain([&c.optimum]));
        let [low, high] = range(scores.map(|(_, score)| *score).chain([0.0]), 0.0);
        if low >= 0.0 || high <= 0.0 {
            [low, high * 1.1]
        } else {
            [low, high + 0.1 * (high - low)]
        }
    }

    fn draw_legend(&self, canvas: &mut Canvas) {
        let sides = self.sides();
        if sides.is_empty() {
            return;
        }
        let mut entries: Vec<(Swatch, &str)> = sides
            .iter()
            .map(|side| (Swatch::Line(side.colour()), side.name()))
            .collect();
        entries.push((Swatch::Dashed(GREY), self.mark.as_str()));
        legend(
            canvas,
            [20.0, MARGIN + 2.0],
            COLUMN - 20.0 - MARGIN,
            2,
            &entries,
        );
    }

    /// The axes of the joint in the given place.
    fn panel(&self, place: usize, joint: usize, left: f64, scores: [f64; 2]) -> Panel {
        let curves = self.curves.iter().filter(|curve| curve.joint == joint);
        let limits = curves.flat_map(|c| c.values.iter().chain([&c.optimum]));
        let columns = self.columns();
        let step = (COLUMN - left - MARGIN) / columns as f64;
        Panel {
            left: left + (place % columns) as f64 * step,
            top: self.head() + (place / columns) as f64 * ROW + 11.0,
            width: step - 10.0,
            height: ROW - 11.0 - 16.0,
            x: range(limits.map(|(limit, _)| limit.to_degrees()), 0.04),
            y: scores,
        }
    }

    fn draw_joint(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        joint: usize,
        y_ticks: &[Tick],
        is_first: bool,
    ) {
        let count = if self.columns() == 1 { 8 } else { 4 };
        let x_ticks = ticks::degrees(panel.x[0], panel.x[1], count);
        panel.grid(canvas, y_ticks);
        for curve in self.curves.iter().filter(|curve| curve.joint == joint) {
            draw_curve(canvas, panel, curve);
        }
        panel.axes(canvas, &x_ticks, y_ticks, is_first);
        let title = format!("joint {joint}, {}", joint_symbol(joint));
        let title = Label::new(&title, NORMAL).bold().align(HPos::Center);
        title.draw_within(
            canvas,
            [panel.left + 0.5 * panel.width, panel.top - 3.5],
            panel.width,
        );
    }
}

fn draw_curve(canvas: &mut Canvas, panel: &Panel, curve: &SensitivityCurve) {
    let colour = curve.side.colour();
    let finite = curve
        .values
        .iter()
        .filter(|(limit, score)| limit.is_finite() && score.is_finite());
    let points: Vec<Point> = finite
        .map(|(limit, score)| [limit.to_degrees(), *score])
        .collect();
    let (limit, score) = (curve.optimum.0.to_degrees(), curve.optimum.1);
    if limit.is_finite() {
        let (from, to) = (panel.at(limit, panel.y[0]), panel.at(limit, panel.y[1]));
        dashed(canvas, from, to, 0.7, colour);
    }
    canvas.stroke(&panel.path(&points), 1.3, colour);
    if limit.is_finite() && score.is_finite() {
        canvas.disc(panel.at(limit, score), 1.8, colour);
    }
}
