//! How a network learned: the loss on training data and on data kept back.

use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, dashed, legend};
use super::number::plain;
use super::panel::{BOTTOM, Panel, left, range};
use super::style::{BLUE, COLUMN, GREY, HALF_CAPITAL, MARGIN, ORANGE, SMALL};
use super::table::{Table, cell};
use super::ticks::{self, Tick};
use plotters::style::text_anchor::HPos;

/// The course of one training.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrainingCurve {
    /// Epochs in order.
    pub epochs: Vec<TrainingEpoch>,
    /// Number of the epoch whose weights were kept.
    pub best: u64,
}

/// The losses after one epoch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrainingEpoch {
    /// Number of the epoch.
    pub number: u64,
    /// Mean loss on the training data.
    pub training_loss: f64,
    /// Mean loss on the data kept back.
    pub kept_back_loss: f64,
}

/// Height of the legend above the plot, points.
const HEAD: f64 = LEGEND_ROW + MARGIN;
/// Height of the figure, points.
const HEIGHT: f64 = 160.0;

impl Figure for TrainingCurve {
    fn name(&self) -> &str {
        "training"
    }

    fn caption(&self) -> String {
        let best = self.epochs.iter().find(|epoch| epoch.number == self.best);
        let best = match best.filter(|epoch| epoch.kept_back_loss.is_finite()) {
            Some(epoch) => format!(
                " The weights of epoch {} were kept: loss {} on data kept back.",
                epoch.number,
                plain(epoch.kept_back_loss)
            ),
            None => String::new(),
        };
        let epochs = self.epochs.len();
        format!("Mean loss after every epoch of the training ({epochs} in all).{best}")
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: HEIGHT,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let axis = LossAxis::new(&self.epochs);
        let y_ticks = axis.ticks();
        let left = left(&y_ticks);
        let x = epoch_range(&self.epochs);
        let panel = Panel {
            left,
            top: HEAD,
            width: COLUMN - left - 14.0,
            height: HEIGHT - HEAD - BOTTOM,
            x,
            y: axis.range,
        };
        panel.grid(canvas, &y_ticks);
        self.draw_curves(canvas, &panel, &axis);
        let count = (x[1] - x[0]).clamp(1.0, 5.0) as usize;
        let x_ticks = ticks::round(x[0], x[1], count);
        panel.axes(canvas, &x_ticks, &y_ticks, true);
        panel.x_label(canvas, "epoch");
        panel.y_label(canvas, "mean loss", &y_ticks);
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&["epoch", "training_loss", "kept_back_loss", "is_best"]);
        let row = |epoch: &TrainingEpoch| {
            let losses = [epoch.training_loss, epoch.kept_back_loss].map(cell);
            let is_best = (epoch.number == self.best).to_string();
            let row = [epoch.number.to_string()].into_iter().chain(losses);
            row.chain([is_best]).collect()
        };
        table.rows = self.epochs.iter().map(row).collect();
        table
    }
}

impl TrainingCurve {
    fn draw_curves(&self, canvas: &mut Canvas, panel: &Panel, axis: &LossAxis) {
        let entries = [
            (Swatch::Line(ORANGE), "training data"),
            (Swatch::Line(BLUE), "data kept back"),
            (Swatch::Dashed(GREY), "best epoch"),
        ];
        let width = COLUMN - 20.0 - MARGIN;
        legend(canvas, [20.0, MARGIN + 2.0], width, 3, &entries);
        let places = |loss: fn(&TrainingEpoch) -> f64| -> Vec<Point> {
            let all = self.epochs.iter().map(|e| (e.number, loss(e)));
            let finite = all.filter(|(_, loss)| is_loss(*loss));
            finite
                .map(|(number, loss)| [number as f64, axis.place(loss)])
                .collect()
        };
        let training = places(|epoch| epoch.training_loss);
        let kept_back = places(|epoch| epoch.kept_back_loss);
        if training.is_empty() && kept_back.is_empty() {
            panel.remark(canvas, "no data");
        }
        let best = self.best as f64;
        let kept = kept_back.iter().find(|point| point[0] == best);
        if panel.x[0] <= best && best <= panel.x[1] && !self.epochs.is_empty() {
            let ends = panel.y.map(|y| panel.at(best, y));
            dashed(canvas, ends[0], ends[1], 0.8, GREY);
        }
        for (points, width, colour) in [(&training, 0.9, ORANGE), (&kept_back, 1.3, BLUE)] {
            let path = panel.path(points);
            canvas.stroke(&path, width, colour);
            // One point has no line.
            if let [only] = path.as_slice() {
                canvas.disc(*only, 1.6, colour);
            }
        }
        if let Some(kept) = kept {
            self.annotate(canvas, panel, *kept);
        }
    }

    /// Marks the best epoch and writes its number beside the dashed line.
    fn annotate(&self, canvas: &mut Canvas, panel: &Panel, kept: Point) {
        let at = panel.at(kept[0], kept[1]);
        canvas.disc(at, 2.2, BLUE);
        let is_right = at[0] > panel.left + 0.5 * panel.width;
        let (align, x) = match is_right {
            true => (HPos::Right, at[0] - 4.0),
            false => (HPos::Left, at[0] + 4.0),
        };
        let text = format!("epoch {}", self.best);
        let label = Label::new(&text, SMALL).bold().align(align);
        label.draw(canvas, [x, panel.top + 3.0 + 2.0 * HALF_CAPITAL * SMALL]);
    }
}

/// Whether a loss can be drawn.
fn is_loss(loss: f64) -> bool {
    loss.is_finite() && loss.abs() < 1e150
}

/// From the first to the last epoch, never of zero width.
fn epoch_range(epochs: &[TrainingEpoch]) -> [f64; 2] {
    let first = epochs.iter().map(|epoch| epoch.number).min().unwrap_or(0) as f64;
    let last = epochs.iter().map(|epoch| epoch.number).max().unwrap_or(1) as f64;
    match last - first >= 1.0 {
        true => [first, last],
        false => [first - 1.0, first + 1.0],
    }
}

/// The vertical axis: losses, or their decimal logarithm if all are positive.
struct LossAxis {
    is_logarithmic: bool,
    range: [f64; 2],
}

impl LossAxis {
    fn new(epochs: &[TrainingEpoch]) -> LossAxis {
        let losses = epochs
            .iter()
            .flat_map(|e| [e.training_loss, e.kept_back_loss]);
        let losses: Vec<f64> = losses.filter(|loss| is_loss(*loss)).collect();
        let is_logarithmic = !losses.is_empty() && losses.iter().all(|loss| *loss > 0.0);
        let mut axis = LossAxis {
            is_logarithmic,
            range: [0.0, 1.0],
        };
        axis.range = range(losses.iter().map(|loss| axis.place(*loss)), 0.08);
        axis
    }

    fn place(&self, loss: f64) -> f64 {
        if self.is_logarithmic {
            loss.log10()
        } else {
            loss
        }
    }

    fn ticks(&self) -> Vec<Tick> {
        let [low, high] = self.range;
        match self.is_logarithmic {
            true => ticks::logarithmic(low, high, 5),
            false => ticks::round(low, high, 5),
        }
    }
}
