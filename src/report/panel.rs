//! A pair of axes: from data to points of the sheet, with frame, ticks and labels.

use super::canvas::Canvas;
use super::canvas::Point;
use super::label::Label;
use super::style::{GRID, HALF_CAPITAL, INK, NORMAL, SMALL};
use super::ticks::Tick;
use plotters::style::text_anchor::HPos;

/// Space for tick labels and the label of the vertical axis, points.
pub(super) const LEFT: f64 = 34.0;
/// Space for tick labels and the label of the horizontal axis, points.
pub(super) const BOTTOM: f64 = 25.0;

/// A rectangle of the sheet that shows ranges of x and y.
#[derive(Clone, Copy, Debug)]
pub(super) struct Panel {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
    pub x: [f64; 2],
    pub y: [f64; 2],
}

impl Panel {
    /// The point of the sheet for the data point (x, y).
    pub(super) fn at(&self, x: f64, y: f64) -> Point {
        let share = |value: f64, [low, high]: [f64; 2]| (value - low) / (high - low);
        [
            self.left + self.width * share(x, self.x),
            self.top + self.height * (1.0 - share(y, self.y)),
        ]
    }

    /// Maps a path of data points.
    pub(super) fn path(&self, points: &[Point]) -> Vec<Point> {
        points.iter().map(|p| self.at(p[0], p[1])).collect()
    }

    /// Light lines across the panel at the ticks of y.
    pub(super) fn grid(&self, canvas: &mut Canvas, y_ticks: &[Tick]) {
        for tick in y_ticks {
            let y = self.at(self.x[0], tick.value)[1];
            canvas.stroke(&[[self.left, y], [self.left + self.width, y]], 0.4, GRID);
        }
    }

    /// Light lines down the panel at the ticks of x.
    pub(super) fn upright_grid(&self, canvas: &mut Canvas, x_ticks: &[Tick]) {
        for tick in x_ticks {
            let ends = self.y.map(|y| self.at(tick.value, y));
            canvas.stroke(&ends, 0.4, GRID);
        }
    }

    /// Left and lower axis with ticks; `labels_left` is false where a neighbour shows them.
    pub(super) fn axes(
        &self,
        canvas: &mut Canvas,
        x_ticks: &[Tick],
        y_ticks: &[Tick],
        labels_left: bool,
    ) {
        let (bottom, right) = (self.top + self.height, self.left + self.width);
        let frame = [[self.left, self.top], [self.left, bottom], [right, bottom]];
        canvas.stroke(&frame, 0.6, INK);
        for tick in x_ticks {
            let x = self.at(tick.value, self.y[0])[0];
            canvas.stroke(&[[x, bottom], [x, bottom + 2.5]], 0.6, INK);
            let label = Label::new(&tick.label, SMALL).align(HPos::Center);
            label.draw(canvas, [x, bottom + 4.5 + 0.76 * SMALL]);
        }
        for tick in y_ticks {
            let y = self.at(self.x[0], tick.value)[1];
            canvas.stroke(&[[self.left - 2.5, y], [self.left, y]], 0.6, INK);
            if labels_left {
                let label = Label::new(&tick.label, SMALL).align(HPos::Right);
                label.draw(canvas, [self.left - 4.5, y + HALF_CAPITAL * SMALL]);
            }
        }
    }

    /// Says in the lower left corner that there is nothing to see.
    pub(super) fn remark(&self, canvas: &mut Canvas, text: &str) {
        let at = [self.left + 4.0, self.top + self.height - 5.0];
        Label::new(text, SMALL).draw_within(canvas, at, self.width);
    }

    /// What the horizontal axis shows, below its ticks.
    pub(super) fn x_label(&self, canvas: &mut Canvas, text: &str) {
        let at = [
            self.left + 0.5 * self.width,
            self.top + self.height + BOTTOM - 5.0,
        ];
        let label = Label::new(text, NORMAL).align(HPos::Center);
        label.draw_within(canvas, at, self.width + LEFT);
    }

    /// What the vertical axis shows, read upwards, left of its tick labels.
    pub(super) fn y_label(&self, canvas: &mut Canvas, text: &str, ticks: &[Tick]) {
        let x = (self.left - left(ticks) + NORMAL + 2.0).max(NORMAL);
        let at = [x, self.top + 0.5 * self.height];
        let label = Label::new(text, NORMAL).align(HPos::Center).upright();
        label.draw_within(canvas, at, self.height + BOTTOM);
    }
}

/// Space that the labels of `ticks` and of their vertical axis need, points.
pub(super) fn left(ticks: &[Tick]) -> f64 {
    let widths = ticks
        .iter()
        .map(|tick| Label::new(&tick.label, SMALL).width());
    widths.fold(0.0, f64::max) + 4.5 + 4.0 + NORMAL + 4.0
}

/// The range of all finite `values`, widened by `share` on both sides; never of zero width.
pub(super) fn range(values: impl Iterator<Item = f64>, share: f64) -> [f64; 2] {
    let finite = values.filter(|value| value.is_finite() && value.abs() < 1e150);
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    let [low, high] = finite.fold(start, |[a, b], v| [a.min(v), b.max(v)]);
    if low > high {
        return [0.0, 1.0];
    }
    let least = 1e-9 * low.abs().max(high.abs());
    if high - low <= least {
        let half = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
        return [low - half, high + half];
    }
    let margin = share * (high - low);
    [low - margin, high + margin]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_have_a_width() {
        assert_eq!(range([].into_iter(), 0.1), [0.0, 1.0]);
        assert_eq!(range([f64::NAN, 5.0].into_iter(), 0.1), [4.5, 5.5]);
        assert_eq!(range([0.0].into_iter(), 0.0), [-1.0, 1.0]);
        assert_eq!(range([0.0, 10.0].into_iter(), 0.1), [-1.0, 11.0]);
    }

    #[test]
    fn corners_map_to_corners() {
        let panel = Panel {
            left: 10.0,
            top: 20.0,
            width: 100.0,
            height: 50.0,
            x: [0.0, 2.0],
            y: [-1.0, 1.0],
        };
        assert_eq!(panel.at(0.0, -1.0), [10.0, 70.0]);
        assert_eq!(panel.at(2.0, 1.0), [110.0, 20.0]);
    }
}
