//! The bar that tells which colour stands for which number.

use super::canvas::{Canvas, Point};
use super::label::{Label, rectangle};
use super::share_scale::Palette;
use super::style::{HALF_CAPITAL, INK, NORMAL, SMALL};
use super::ticks::{self, Tick};
use plotters::style::text_anchor::HPos;

/// Width of the colours, points.
const WIDTH: f64 = 8.0;

/// A bar for numbers from 0 to `top`.
pub(super) struct ColourBar {
    top: f64,
    palette: Palette,
    ticks: Vec<Tick>,
}

impl ColourBar {
    pub(super) fn new(top: f64, palette: Palette) -> ColourBar {
        ColourBar {
            top,
            palette,
            ticks: ticks::round(0.0, top, 5),
        }
    }

    /// Space needed right of the bar's corner, points, its label included.
    pub(super) fn width(&self) -> f64 {
        self.numbers_width() + WIDTH + 4.0 + 3.0 + NORMAL + 2.0
    }

    fn numbers_width(&self) -> f64 {
        let ticks = self.ticks.iter();
        let widths = ticks.map(|tick| Label::new(&tick.label, SMALL).width());
        widths.fold(0.0, f64::max)
    }

    /// Draws the bar with its left upper corner at (x, y), `text` beside it.
    pub(super) fn draw(&self, canvas: &mut Canvas, [x, y]: Point, height: f64, text: &str) {
        canvas.picture([x, y], [WIDTH, height], |_, at| {
            let level = 1.0 - (at - y) / height;
            let colour = self.palette.colour(level.clamp(0.0, 1.0));
            [colour.0, colour.1, colour.2]
        });
        canvas.outline(&rectangle(x, y, WIDTH, height), 0.5, INK);
        for tick in &self.ticks {
            let at = y + height * (1.0 - tick.value / self.top);
            canvas.stroke(&[[x + WIDTH, at], [x + WIDTH + 2.5, at]], 0.6, INK);
            let place = [x + WIDTH + 4.0, at + HALF_CAPITAL * SMALL];
            Label::new(&tick.label, SMALL).draw(canvas, place);
        }
        let label = Label::new(text, NORMAL).align(HPos::Center).upright();
        let right = x + WIDTH + 4.0 + self.numbers_width() + 3.0 + NORMAL;
        label.draw_within(canvas, [right, y + 0.5 * height], height);
    }
}
