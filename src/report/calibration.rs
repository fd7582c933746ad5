//! How far predicted probabilities can be trusted: observed shares against them.

use super::agreement;
use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Swatch, legend};
use super::manifold_figure::COLOURS;
use super::panel::{BOTTOM, LEFT, Panel};
use super::style::{COLUMN, GREY, MARGIN};
use super::table::{Table, cell};
use super::ticks;

/// Observed share of fault-tolerant angles against the predicted probability.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Calibration {
    /// One curve per surrogate or kind of designs.
    pub curves: Vec<CalibrationCurve>,
}

/// The bins of one surrogate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CalibrationCurve {
    /// What the curve shows.
    pub label: String,
    /// Bins in order of probability; bins without a count are left out.
    pub bins: Vec<CalibrationBin>,
}

/// Predictions of about the same probability.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CalibrationBin {
    /// Mean predicted probability, in [0, 1].
    pub predicted: f64,
    /// Share that is fault tolerant, in [0, 1].
    pub observed: f64,
    /// Number of predictions.
    pub count: u64,
}

/// Side of the plot, points.
const SIDE: f64 = 165.0;
/// Columns of the legend.
const LEGEND_COLUMNS: usize = 2;

impl Figure for Calibration {
    fn name(&self) -> &str {
        "calibration"
    }

    fn caption(&self) -> String {
        "Share of predictions that are true against the predicted probability; on the dashed \
         line both are equal. The area of a dot grows with the share of a curve's predictions \
         in its bin."
            .into()
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: self.head() + SIDE + BOTTOM,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        self.draw_legend(canvas);
        let panel = Panel {
            left: LEFT + 8.0,
            top: self.head(),
            width: SIDE,
            height: SIDE,
            x: [0.0, 1.0],
            y: [0.0, 1.0],
        };
        let ticks = ticks::round(0.0, 1.0, 5);
        agreement::draw(canvas, &panel, &ticks, &ticks, true);
        for (k, curve) in self.curves.iter().enumerate() {
            curve.draw(canvas, &panel, COLOURS[k % COLOURS.len()]);
        }
        if self
            .curves
            .iter()
            .all(|curve| curve.used().next().is_none())
        {
            panel.remark(canvas, "no data");
        }
        panel.x_label(canvas, "predicted probability");
        panel.y_label(canvas, "observed share", &ticks);
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&["curve", "predicted", "observed", "count"]);
        for curve in &self.curves {
            let row = |bin: &CalibrationBin| {
                let [predicted, observed] = [bin.predicted, bin.observed].map(cell);
                vec![
                    curve.label.clone(),
                    predicted,
                    observed,
                    bin.count.to_string(),
                ]
            };
            table.rows.extend(curve.bins.iter().map(row));
        }
        table
    }
}

impl Calibration {
    fn head(&self) -> f64 {
        (self.curves.len() + 1).div_ceil(LEGEND_COLUMNS) as f64 * LEGEND_ROW + MARGIN + 2.0
    }

    fn draw_legend(&self, canvas: &mut Canvas) {
        let names: Vec<String> = self
            .curves
            .iter()
            .map(|c| agreement::spaced(&c.label))
            .collect();
        let mut entries: Vec<(Swatch, &str)> = names
            .iter()
            .enumerate()
            .map(|(k, name)| (Swatch::Line(COLOURS[k % COLOURS.len()]), name.as_str()))
            .collect();
        entries.push((Swatch::Dashed(GREY), "well calibrated"));
        let width = COLUMN - LEFT - 8.0 - MARGIN;
        legend(
            canvas,
            [LEFT + 8.0, MARGIN + 2.0],
            width,
            LEGEND_COLUMNS,
            &entries,
        );
    }
}

impl CalibrationCurve {
    /// Bins that can be drawn.
    fn used(&self) -> impl Iterator<Item = &CalibrationBin> {
        let is_share = |share: f64| (0.0..=1.0).contains(&share);
        let is_used = move |bin: &&CalibrationBin| {
            bin.count > 0 && is_share(bin.predicted) && is_share(bin.observed)
        };
        self.bins.iter().filter(is_used)
    }

    fn draw(&self, canvas: &mut Canvas, panel: &Panel, colour: plotters::style::RGBAColor) {
        let points: Vec<Point> = self
            .used()
            .map(|bin| [bin.predicted, bin.observed])
            .collect();
        canvas.stroke(&panel.path(&points), 1.1, colour);
        let total: f64 = self.used().map(|bin| bin.count as f64).sum();
        for bin in self.used() {
            let share = bin.count as f64 / total;
            let radius = 1.2 + 2.4 * share.sqrt();
            canvas.disc(panel.at(bin.predicted, bin.observed), radius, colour);
        }
    }
}
