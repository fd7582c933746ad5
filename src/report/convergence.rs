//! How a search improved: best score against evaluations.

use super::canvas::Point;
use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::number::{plain, unit, with_unit};
use super::panel::{BOTTOM, Panel, left, range};
use super::style::{BLUE, COLUMN, HALF_CAPITAL, INK, MARGIN, ORANGE, SMALL};
use super::table::{Table, cell, column};
use super::ticks::{self, Tick};
use plotters::style::text_anchor::HPos;

/// The course of one search.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Convergence {
    /// Name of the method, as in "genetic algorithm".
    pub method: String,
    /// What is maximised, as in "S_F".
    pub score_label: String,
    /// Unit of the score, as in "m^2"; may be empty.
    pub unit: String,
    /// Points in order of evaluations.
    pub points: Vec<ConvergencePoint>,
    /// Duration of the search, seconds.
    pub seconds: Option<f64>,
}

/// The state of a search after a number of evaluations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConvergencePoint {
    /// Evaluations of the score so far.
    pub evaluations: u64,
    /// Best score so far.
    pub best: f64,
    /// Mean score of the present generation.
    pub mean: Option<f64>,
}

/// Height of the legend above the plot, points.
const HEAD: f64 = LEGEND_ROW + MARGIN;
/// Height of the figure, points.
const HEIGHT: f64 = 160.0;

impl Figure for Convergence {
    fn name(&self) -> &'static str {
        "convergence"
    }

    fn caption(&self) -> String {
        let time = self.seconds.filter(|s| s.is_finite());
        let time = time.map_or(String::new(), |s| format!(" in {s:.1} s"));
        let evaluations = self.points.last().map_or(0, |point| point.evaluations);
        let method = if self.method.is_empty() {
            "search"
        } else {
            &self.method
        };
        format!("Best score of the {method} against evaluations ({evaluations}{time}).")
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: HEIGHT,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let axis = Axis::new(&self.points);
        let scores = self
            .points
            .iter()
            .flat_map(|p| [p.best, p.mean.unwrap_or(p.best)]);
        let y = scores_range(scores);
        let y_ticks = ticks::round(y[0], y[1], 5);
        let left = left(&y_ticks);
        let panel = Panel {
            left,
            top: HEAD,
            width: COLUMN - left - 14.0,
            height: HEIGHT - HEAD - BOTTOM,
            x: axis.range,
            y,
        };
        panel.grid(canvas, &y_ticks);
        self.draw_curves(canvas, &panel, &axis);
        panel.axes(canvas, &axis.ticks(), &y_ticks, true);
        panel.x_label(canvas, "evaluations");
        let label = with_unit(&self.score_label, &self.unit);
        panel.y_label(canvas, &label, &y_ticks);
    }

    fn table(&self) -> Table {
        let [best, mean] = ["best", "mean"].map(|name| column(name, &self.unit));
        let mut table = Table::new(&["evaluations", &best, &mean]);
        let row = |p: &ConvergencePoint| {
            let mean = p.mean.map_or(String::new(), cell);
            vec![p.evaluations.to_string(), cell(p.best), mean]
        };
        table.rows = self.points.iter().map(row).collect();
        table
    }
}

impl Convergence {
    fn draw_curves(&self, canvas: &mut Canvas, panel: &Panel, axis: &Axis) {
        let means = self
            .points
            .iter()
            .filter_map(|p| p.mean.map(|mean| (p.evaluations, mean)));
        let means: Vec<Point> = finite(axis, means);
        let best = finite(axis, self.points.iter().map(|p| (p.evaluations, p.best)));
        let method = if self.method.is_empty() {
            String::new()
        } else {
            format!(" ({})", self.method)
        };
        let text = format!("best{method}");
        let mut entries = vec![(Swatch::Line(BLUE), text.as_str())];
        if !means.is_empty() {
            entries.push((Swatch::Line(ORANGE), "mean of the generation"));
        }
        legend(
            canvas,
            [20.0, MARGIN + 2.0],
            COLUMN - 20.0 - MARGIN,
            2,
            &entries,
        );
        canvas.stroke(&panel.path(&means), 0.9, ORANGE);
        canvas.stroke(&panel.path(&steps(&best)), 1.4, BLUE);
        if let Some(last) = best.last() {
            self.annotate(canvas, panel, *last);
        } else {
            panel.remark(canvas, "no data");
        }
    }

    /// Marks the final point and writes its value on the roomier side.
    fn annotate(&self, canvas: &mut Canvas, panel: &Panel, last: Point) {
        let at = panel.at(last[0], last[1]);
        canvas.disc(at, 2.0, BLUE);
        let text = format!("{} {}", plain(last[1]), unit(&self.unit));
        let is_high = at[1] < panel.top + 0.5 * panel.height;
        let base = if is_high {
            at[1] + 6.0 + 2.0 * HALF_CAPITAL * SMALL
        } else {
            at[1] - 5.0
        };
        let is_right = at[0] > panel.left + 0.5 * panel.width;
        let align = if is_right { HPos::Right } else { HPos::Left };
        let label = Label::new(text.trim_end(), SMALL)
            .bold()
            .align(align)
            .colour(INK);
        label.draw(canvas, [at[0], base]);
    }
}

/// The horizontal axis: evaluations, or their decimal logarithm over more than two decades.
struct Axis {
    is_logarithmic: bool,
    range: [f64; 2],
}

impl Axis {
    fn new(points: &[ConvergencePoint]) -> Axis {
        let first = points.iter().map(|p| p.evaluations).min().unwrap_or(0) as f64;
        let last = points.iter().map(|p| p.evaluations).max().unwrap_or(1) as f64;
        let is_logarithmic = last > 100.0 * first.max(1.0);
        let mut axis = Axis {
            is_logarithmic,
            range: [0.0, 1.0],
        };
        let (low, high) = if is_logarithmic {
            (first, last)
        } else {
            (0.0f64.min(first), last.max(1.0))
        };
        axis.range = range([axis.place(low), axis.place(high)].into_iter(), 0.0);
        axis
    }

    fn place(&self, evaluations: f64) -> f64 {
        if self.is_logarithmic {
            evaluations.max(1.0).log10()
        } else {
            evaluations
        }
    }

    fn ticks(&self) -> Vec<Tick> {
        let [low, high] = self.range;
        if self.is_logarithmic {
            ticks::decades(low, high, 6)
        } else {
            ticks::round(low, high, (high - low).clamp(1.0, 5.0) as usize)
        }
    }
}

/// Room around all scores, but none below zero if no score is negative.
fn scores_range(scores: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    let [low, high] = range(scores.clone(), 0.08);
    let is_negative = scores.into_iter().any(|score| score < 0.0);
    if is_negative {
        [low, high]
    } else {
        [low.max(0.0), high]
    }
}

fn finite(axis: &Axis, points: impl Iterator<Item = (u64, f64)>) -> Vec<Point> {
    points
        .filter(|(_, score)| score.is_finite())
        .map(|(evaluations, score)| [axis.place(evaluations as f64), score])
        .collect()
}

/// A score holds until the next point.
fn steps(points: &[Point]) -> Vec<Point> {
    let mut path: Vec<Point> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        path.extend([[pair[1][0], pair[0][1]], pair[1]]);
    }
    path
}
