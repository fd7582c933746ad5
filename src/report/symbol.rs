//! Symbols that tell named points apart, also in black and white, and a legend of them.

use super::canvas::{Canvas, Point};
use super::label::{LEGEND_ROW, Label};
use super::style::{
    BLUE, GREEN, GREY, HALF_CAPITAL, INK, ORANGE, PURPLE, SMALL, VERMILLION, WHITE, translucent,
};
use plotters::style::RGBAColor;

/// How a point looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Symbol {
    /// One of many in the background.
    Faint,
    /// On the front.
    Full,
    /// No longer on the front.
    Hollow,
    /// A robot with a name: the first, second … of them.
    Named(usize),
}

/// Corners of the symbols of named points, in units of their size; the last one is a star.
const SHAPES: [&[Point]; 4] = [
    &[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]],
    &[[0.0, -1.25], [1.25, 0.0], [0.0, 1.25], [-1.25, 0.0]],
    &[[0.0, -1.25], [1.15, 0.8], [-1.15, 0.8]],
    &[
        [0.0, -1.45],
        [0.36, -0.5],
        [1.38, -0.45],
        [0.58, 0.19],
        [0.85, 1.17],
        [0.0, 0.61],
        [-0.85, 1.17],
        [-0.58, 0.19],
        [-1.38, -0.45],
        [-0.36, -0.5],
    ],
];

const COLOURS: [RGBAColor; 4] = [BLUE, GREEN, ORANGE, PURPLE];

/// Half the width of the symbol of a named point, points.
const NAMED: f64 = 2.9;
/// Free space between entries of a legend, points.
const BETWEEN: f64 = 12.0;

impl Symbol {
    /// The colour of its error bars.
    pub(super) fn colour(self) -> RGBAColor {
        match self {
            Symbol::Faint => translucent(GREY, 0.55),
            Symbol::Full | Symbol::Hollow => VERMILLION,
            Symbol::Named(number) => COLOURS[number % COLOURS.len()],
        }
    }

    /// Draws the symbol with its middle at `at`.
    pub(super) fn draw(self, canvas: &mut Canvas, at: Point) {
        match self {
            Symbol::Faint => canvas.disc(at, 0.9, self.colour()),
            Symbol::Full => canvas.disc(at, 1.7, VERMILLION),
            Symbol::Hollow => {
                canvas.disc(at, 1.7, VERMILLION);
                canvas.disc(at, 1.1, WHITE);
            }
            Symbol::Named(number) => {
                // Colours and shapes have different periods only after 4 × 4 names.
                let shape = SHAPES[(number + number / 4) % SHAPES.len()];
                let corner = |c: &Point| [at[0] + NAMED * c[0], at[1] + NAMED * c[1]];
                let corners: Vec<Point> = shape.iter().map(corner).collect();
                canvas.fill(&corners, self.colour());
                canvas.outline(&corners, 0.6, INK);
            }
        }
    }
}

/// The rows of a legend within `width` points: entries with where each starts.
fn placed(entries: &[(Symbol, String)], width: f64) -> Vec<(Point, &(Symbol, String))> {
    let mut at = [0.0, 0.0];
    let mut places = Vec::with_capacity(entries.len());
    for entry in entries {
        let needed = 12.0 + Label::new(&entry.1, SMALL).width().min(width - 12.0);
        if at[0] > 0.0 && at[0] + needed > width {
            at = [0.0, at[1] + LEGEND_ROW];
        }
        places.push((at, entry));
        at[0] += needed + BETWEEN;
    }
    places
}

/// Height of [`symbol_legend`], points.
pub(super) fn legend_height(entries: &[(Symbol, String)], width: f64) -> f64 {
    let places = placed(entries, width);
    places.last().map_or(0.0, |(at, _)| at[1] + LEGEND_ROW)
}

/// Draws entries one after the other from `corner`, in as many rows as they need.
pub(super) fn symbol_legend(
    canvas: &mut Canvas,
    corner: Point,
    width: f64,
    entries: &[(Symbol, String)],
) {
    for (at, (symbol, text)) in placed(entries, width) {
        let middle = [corner[0] + at[0], corner[1] + at[1] + 0.5 * LEGEND_ROW];
        symbol.draw(canvas, [middle[0] + 5.0, middle[1]]);
        let base = [middle[0] + 11.0, middle[1] + HALF_CAPITAL * SMALL];
        Label::new(text, SMALL).draw_within(canvas, base, width - 12.0);
    }
}
