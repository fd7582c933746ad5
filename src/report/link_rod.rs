//! Links and frames as shapes: rods with rims, and arrows.

use super::canvas::Point;
use super::scene::Shape;
use super::style::INK;
use plotters::style::RGBAColor;

/// Widths of the links' bodies and rims, points.
pub(super) const BODY_WIDTH: f64 = 2.6;
pub(super) const RIM_WIDTH: f64 = 3.6;
/// Colour of the links' bodies.
pub(super) const BODY: RGBAColor = RGBAColor(0xc4, 0xc4, 0xc4, 1.0);

/// A piece of a link: its body between two lines.
pub(super) fn rod(from: Point, to: Point) -> Vec<Shape> {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    if length < 1e-9 {
        return Vec::new();
    }
    let unit = along.map(|c| c / length);
    let side = |p: Point, across: f64, ahead: f64| {
        [
            p[0] - across * unit[1] + ahead * unit[0],
            p[1] + across * unit[0] + ahead * unit[1],
        ]
    };
    // Pieces overlap a little, so that no seam shows.
    let half = 0.5 * BODY_WIDTH;
    let body = vec![
        side(from, half, -0.15),
        side(to, half, 0.15),
        side(to, -half, 0.15),
        side(from, -half, -0.15),
    ];
    let rim = 0.5 * (RIM_WIDTH - BODY_WIDTH);
    let line = |across: f64| {
        let ends = vec![side(from, across, 0.0), side(to, across, 0.0)];
        Shape::Line(ends, rim, INK)
    };
    let edge = half + 0.5 * rim;
    vec![Shape::Area(body, BODY), line(edge), line(-edge)]
}

/// An arrow with a dot where it starts.
pub(super) fn arrow(line: [Point; 2], colour: RGBAColor) -> Vec<Shape> {
    let [from, to] = line;
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    let head = 3.6f64.min(length);
    let unit = along.map(|c| c / length.max(1e-9));
    let neck = [to[0] - head * unit[0], to[1] - head * unit[1]];
    let wing = |side: f64| {
        let across = 0.42 * head * side;
        [neck[0] - across * unit[1], neck[1] + across * unit[0]]
    };
    vec![
        Shape::Line(vec![from, neck], 1.1, colour),
        Shape::Area(vec![to, wing(1.0), wing(-1.0)], colour),
        Shape::Disc(from, 0.9, colour),
    ]
}
