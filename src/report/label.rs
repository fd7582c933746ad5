//! Lines of text in a figure: subscripts, fitting into a width, legends.

use super::canvas::{Canvas, Lettering, Point};
use super::render;
use super::style::{HALF_CAPITAL, INK, SMALL, WHITE};
use plotters::style::RGBAColor;
use plotters::style::text_anchor::HPos;

/// A line of text; `_` before a character sets that character as a subscript: "W_F".
#[derive(Clone, Copy)]
pub(super) struct Label<'t> {
    pub text: &'t str,
    pub size: f64,
    pub bold: bool,
    pub colour: RGBAColor,
    pub align: HPos,
    pub upright: bool,
}

impl<'t> Label<'t> {
    /// Ink-coloured text of the given size in points, starting at its point.
    pub(super) fn new(text: &'t str, size: f64) -> Label<'t> {
        Label {
            text,
            size,
            bold: false,
            colour: INK,
            align: HPos::Left,
            upright: false,
        }
    }

    pub(super) fn align(self, align: HPos) -> Label<'t> {
        Label { align, ..self }
    }

    pub(super) fn bold(self) -> Label<'t> {
        Label { bold: true, ..self }
    }

    pub(super) fn colour(self, colour: RGBAColor) -> Label<'t> {
        Label { colour, ..self }
    }

    pub(super) fn upright(self) -> Label<'t> {
        Label {
            upright: true,
            ..self
        }
    }

    /// Draws with the base line at `at`, smaller if need be to stay within `width` points.
    pub(super) fn draw_within(self, canvas: &mut Canvas, at: Point, width: f64) {
        let (text, size) = fitted(&self, width);
        Label {
            text: &text,
            size,
            ..self
        }
        .draw(canvas, at);
    }

    /// Draws with the base line at `at`.
    pub(super) fn draw(self, canvas: &mut Canvas, at: Point) {
        let lettering = Lettering {
            size: self.size,
            bold: self.bold,
            colour: self.colour,
            align: self.align,
            upright: self.upright,
        };
        canvas.text(self.text, at, &lettering);
    }

    /// Width in points.
    pub(super) fn width(&self) -> f64 {
        self.size * render::text_width(self.text, self.bold)
    }
}

/// The text and size that stay within `width`: down to 70 % in size, then cut with an ellipsis.
fn fitted(label: &Label, width: f64) -> (String, f64) {
    let own = label.width();
    if own <= width {
        return (label.text.to_string(), label.size);
    }
    let size = label.size * (width / own).max(0.7);
    let mut text = label.text.to_string();
    while !text.is_empty() {
        let line = format!("{text}…");
        let candidate = Label {
            text: &line,
            size,
            ..*label
        };
        let whole = Label {
            text: &text,
            size,
            ..*label
        };
        if text == label.text && whole.width() <= width * 1.001 {
            return (text, size);
        }
        if candidate.width() <= width {
            return (line, size);
        }
        text.pop();
    }
    (text, size)
}

/// What a legend shows beside its text.
#[derive(Clone, Copy, Debug)]
pub(super) enum Swatch {
    Area(RGBAColor, RGBAColor),
    Line(RGBAColor),
    /// A link with a joint.
    Arm(RGBAColor),
    Dashed(RGBAColor),
    /// A heavy line.
    Thick(RGBAColor),
    Dot(RGBAColor),
    Cross(RGBAColor),
    Diamond(RGBAColor),
}

/// Height of one row of a legend, points.
pub(super) const LEGEND_ROW: f64 = 10.0;

/// Draws legend entries in `columns` columns over `width` points, the first row's middle at
/// `at`. Columns are as wide as their entries, and share what is left over.
pub(super) fn legend(
    canvas: &mut Canvas,
    at: Point,
    width: f64,
    columns: usize,
    entries: &[(Swatch, &str)],
) {
    let columns = columns.max(1);
    let needed = |column: usize| {
        let texts = entries.iter().skip(column).step_by(columns);
        let widths = texts.map(|(_, text)| 20.0 + Label::new(text, SMALL).width());
        widths.fold(0.0, f64::max)
    };
    let needed: Vec<f64> = (0..columns).map(needed).collect();
    let spare = (width - needed.iter().sum::<f64>()) / columns as f64;
    let mut x = at[0];
    for (column, needed) in needed.iter().enumerate() {
        let step = needed + spare;
        for (row, (swatch, text)) in entries.iter().skip(column).step_by(columns).enumerate() {
            let y = at[1] + row as f64 * LEGEND_ROW;
            draw_swatch(canvas, *swatch, [x, y]);
            let base = y + HALF_CAPITAL * SMALL;
            Label::new(text, SMALL).draw_within(canvas, [x + 16.0, base], step - 18.0);
        }
        x += step;
    }
}

pub(super) fn draw_swatch(canvas: &mut Canvas, swatch: Swatch, [x, y]: Point) {
    match swatch {
        Swatch::Area(fill, edge) => {
            let corners = rectangle(x, y - 3.0, 12.0, 6.0);
            canvas.fill(&corners, fill);
            canvas.outline(&corners, 0.5, edge);
        }
        Swatch::Line(colour) => canvas.stroke(&[[x, y], [x + 12.0, y]], 1.5, colour),
        Swatch::Arm(colour) => {
            canvas.stroke(&[[x, y], [x + 12.0, y]], 1.7, colour);
            canvas.disc([x + 6.0, y], 2.7, colour);
            canvas.disc([x + 6.0, y], 1.7, WHITE);
        }
        Swatch::Thick(colour) => canvas.stroke(&[[x, y], [x + 12.0, y]], 2.4, colour),
        Swatch::Dot(colour) => canvas.disc([x + 6.0, y], 1.5, colour),
        Swatch::Cross(colour) => {
            let (left, right) = (x + 3.8, x + 8.2);
            canvas.stroke(&[[left, y - 2.2], [right, y + 2.2]], 0.9, colour);
            canvas.stroke(&[[left, y + 2.2], [right, y - 2.2]], 0.9, colour);
        }
        Swatch::Diamond(colour) => {
            let (middle, half) = (x + 6.0, 1.7);
            let corners = [[0.0, -half], [half, 0.0], [0.0, half], [-half, 0.0]];
            canvas.fill(&corners.map(|c| [middle + c[0], y + c[1]]), colour);
        }
        Swatch::Dashed(colour) => dashed(canvas, [x, y], [x + 12.0, y], 0.8, colour),
    }
}

/// The corners of a rectangle.
pub(super) fn rectangle(x: f64, y: f64, width: f64, height: f64) -> [Point; 4] {
    [
        [x, y],
        [x + width, y],
        [x + width, y + height],
        [x, y + height],
    ]
}

/// A dashed straight line.
pub(super) fn dashed(canvas: &mut Canvas, from: Point, to: Point, width: f64, colour: RGBAColor) {
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    let dashes = (length / 4.5).ceil().clamp(1.0, 500.0) as usize;
    let point = |s: f64| {
        let t = s / dashes as f64;
        [
            from[0] + t * (to[0] - from[0]),
            from[1] + t * (to[1] - from[1]),
        ]
    };
    for k in 0..dashes {
        canvas.stroke(
            &[point(k as f64 + 0.15), point(k as f64 + 0.65)],
            width,
            colour,
        );
    }
}
