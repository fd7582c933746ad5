//! Many equal dots as one picture: a vector per dot would make files of many megabytes.

use super::canvas::{Canvas, Point};
use super::panel::Panel;
use plotters::style::RGBAColor;

/// Cells per point, about the drawing units of a sheet.
const FINE: f64 = 13.0;

/// Draws dots of `radius` points at data points over the whole panel, the rest of it white.
/// Points outside the panel's ranges are left out.
pub(super) fn draw(
    canvas: &mut Canvas,
    panel: &Panel,
    points: impl Iterator<Item = Point>,
    radius: f64,
    colour: RGBAColor,
) {
    let mut cells = Cells::new(panel);
    let is_inside = |p: &Point| {
        let within = |value: f64, [low, high]: [f64; 2]| low <= value && value <= high;
        within(p[0], panel.x) && within(p[1], panel.y)
    };
    for point in points.filter(is_inside) {
        cells.stamp(panel.at(point[0], point[1]), radius);
    }
    let ink = [colour.0, colour.1, colour.2];
    let corner = [panel.left, panel.top];
    canvas.picture(corner, [panel.width, panel.height], |x, y| {
        match cells.has([x, y]) {
            true => ink,
            false => [255; 3],
        }
    });
}

/// Which parts of a panel are covered.
struct Cells {
    corner: Point,
    columns: usize,
    rows: usize,
    covered: Vec<bool>,
}

impl Cells {
    fn new(panel: &Panel) -> Cells {
        let count = |length: f64| (length * FINE).ceil().clamp(1.0, 1e4) as usize;
        let (columns, rows) = (count(panel.width), count(panel.height));
        Cells {
            corner: [panel.left, panel.top],
            columns,
            rows,
            covered: vec![false; columns * rows],
        }
    }

    fn stamp(&mut self, at: Point, radius: f64) {
        let centre = [0, 1].map(|c| (at[c] - self.corner[c]) * FINE);
        let radius = radius * FINE;
        let span = |middle: f64, most: usize| {
            let low = (middle - radius).floor().max(0.0) as usize;
            low..((middle + radius).ceil().max(0.0) as usize).min(most)
        };
        for row in span(centre[1], self.rows) {
            for column in span(centre[0], self.columns) {
                let off = [
                    column as f64 + 0.5 - centre[0],
                    row as f64 + 0.5 - centre[1],
                ];
                if off[0].hypot(off[1]) <= radius {
                    self.covered[row * self.columns + column] = true;
                }
            }
        }
    }

    fn has(&self, at: Point) -> bool {
        let [column, row] = [0, 1].map(|c| ((at[c] - self.corner[c]) * FINE).max(0.0) as usize);
        column < self.columns && row < self.rows && self.covered[row * self.columns + column]
    }
}
