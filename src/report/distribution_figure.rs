//! Distributions of the sizes of locations, side by side [S1 Fig. 6].

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::{Label, dashed};
use super::panel::{self, BOTTOM, Panel};
use super::style::{COLUMN, GREY, INK, MARGIN, SKY, SMALL, TITLE, VERMILLION};
use super::table::{Table, cell};
use super::ticks;
use plotters::style::text_anchor::HPos;

/// Sizes of the locations of one choice of configurations.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeSample {
    /// Lines of the name below its distribution.
    pub name: Vec<String>,
    /// The sizes, radians.
    pub sizes: Vec<f64>,
}

/// Distributions of sizes.
#[derive(Clone, Debug)]
pub struct DistributionFigure {
    /// One distribution each.
    pub samples: Vec<SizeSample>,
    /// Largest and smallest size known, shown as lines.
    pub extremes: [f64; 2],
    /// Title above the plot; none if empty.
    pub title: String,
}

const HEAD: f64 = 20.0;
const HEIGHT: f64 = 150.0;
const BINS: usize = 28;

/// The value below which a share of the sorted values lies.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    match sorted.len() {
        0 => f64::NAN,
        n => sorted[((n - 1) as f64 * share).round() as usize],
    }
}

impl DistributionFigure {
    fn range(&self) -> [f64; 2] {
        let all = self
            .samples
            .iter()
            .flat_map(|s| &s.sizes)
            .chain(&self.extremes);
        panel::range(all.copied(), 0.06)
    }

    /// One violin with its least, median and greatest value.
    fn draw_sample(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        middle: f64,
        half: f64,
        sizes: &[f64],
    ) {
        let mut sorted: Vec<f64> = sizes.iter().copied().filter(|s| s.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let [low, high] = [quantile(&sorted, 0.0), quantile(&sorted, 1.0)];
        let mut counts = vec![0.0; BINS];
        for size in &sorted {
            let share = (size - low) / (high - low).max(1e-9);
            counts[((share * BINS as f64) as usize).min(BINS - 1)] += 1.0;
        }
        // A light smoothing over neighbours.
        let at = |k: usize| counts.get(k).copied().unwrap_or(0.0);
        let smooth: Vec<f64> = (0..BINS)
            .map(|k| 0.25 * at(k.wrapping_sub(1)) + 0.5 * at(k) + 0.25 * at(k + 1))
            .collect();
        let most = smooth.iter().copied().fold(1e-9, f64::max);
        let edge = |k: usize, side: f64| {
            // The outer bins reach to the least and the greatest value.
            let place = k as f64 / (BINS - 1) as f64;
            let y = low + place * (high - low);
            [middle + side * half * smooth[k] / most, panel.at(0.0, y)[1]]
        };
        let shown: Vec<usize> = (0..BINS).filter(|&k| smooth[k] > 0.0).collect();
        let mut outline: Vec<[f64; 2]> = shown.iter().map(|&k| edge(k, 1.0)).collect();
        outline.extend(shown.iter().rev().map(|&k| edge(k, -1.0)));
        canvas.fill(&outline, SKY);
        canvas.outline(&outline, 0.5, INK);
        for (share, width, colour) in [(0.0, 0.9, INK), (0.5, 1.4, VERMILLION), (1.0, 0.9, INK)] {
            let y = panel.at(0.0, quantile(&sorted, share))[1];
            canvas.stroke(&[[middle - half, y], [middle + half, y]], width, colour);
        }
        let top = panel.at(0.0, quantile(&sorted, 1.0))[1];
        let text = format!("{:.2}", quantile(&sorted, 1.0));
        let label = Label::new(&text, SMALL).align(HPos::Left);
        label.draw(canvas, [middle + half + 1.5, top + 2.2]);
        let y = panel.at(0.0, quantile(&sorted, 0.5))[1];
        let text = format!("{:.2}", quantile(&sorted, 0.5));
        let label = Label::new(&text, SMALL)
            .align(HPos::Left)
            .colour(VERMILLION);
        label.draw(canvas, [middle + half + 1.5, y + 2.2]);
    }
}

impl Figure for DistributionFigure {
    fn name(&self) -> &'static str {
        "size_distributions"
    }

    fn caption(&self) -> String {
        format!(
            "Distributions of the sizes of locations (sum of all joint ranges over all their \
             manifolds) for configurations chosen in different ways. Lines: least and greatest \
             (black), median (red); dashed: the largest size found, {:.3} rad, and the smallest, \
             {:.3} rad.",
            self.extremes[0], self.extremes[1]
        )
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: HEAD + HEIGHT + BOTTOM + 8.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * COLUMN, 12.0], COLUMN - 2.0 * MARGIN);
        let y = self.range();
        let y_ticks = ticks::round(y[0], y[1], 6);
        let left = panel::left(&y_ticks);
        let panel = Panel {
            left,
            top: HEAD,
            width: COLUMN - left - MARGIN,
            height: HEIGHT,
            x: [0.0, 1.0],
            y,
        };
        panel.grid(canvas, &y_ticks);
        for extreme in self.extremes {
            let y = panel.at(0.0, extreme)[1];
            dashed(canvas, [left, y], [left + panel.width, y], 0.7, GREY);
        }
        let step = panel.width / self.samples.len().max(1) as f64;
        for (k, sample) in self.samples.iter().enumerate() {
            let middle = left + (k as f64 + 0.42) * step;
            if !sample.sizes.is_empty() {
                self.draw_sample(canvas, &panel, middle, 0.26 * step, &sample.sizes);
            }
            for (line, text) in sample.name.iter().enumerate() {
                let at = [
                    left + (k as f64 + 0.5) * step,
                    HEAD + HEIGHT + 10.0 + 8.0 * line as f64,
                ];
                Label::new(text, SMALL)
                    .align(HPos::Center)
                    .draw_within(canvas, at, step);
            }
        }
        panel.axes(canvas, &[], &y_ticks, true);
        panel.y_label(canvas, "size (rad)", &y_ticks);
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&["sample", "size_rad"]);
        for sample in &self.samples {
            let name = sample.name.join(" ");
            let rows = sample
                .sizes
                .iter()
                .map(|size| vec![name.clone(), cell(*size)]);
            table.rows.extend(rows);
        }
        table
    }
}
