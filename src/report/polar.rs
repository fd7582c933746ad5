//! Arcs and sectors as polygons. Angles in radians, counter-clockwise from the x axis.

use super::canvas::Point;
use std::f64::consts::TAU;

/// Corners of arcs are at most this far apart, radians.
const STEP: f64 = TAU / 360.0;

/// The point at radius `r` and angle `angle` about `centre`.
pub(super) fn point(centre: Point, r: f64, angle: f64) -> Point {
    [centre[0] + r * angle.cos(), centre[1] + r * angle.sin()]
}

/// The spiral from (r, angle) `from` to `to`, both included: linear in both.
pub(super) fn spiral(centre: Point, from: [f64; 2], to: [f64; 2]) -> Vec<Point> {
    let steps = ((to[1] - from[1]).abs() / STEP).ceil().clamp(1.0, 2e3) as usize;
    let corner = |k: usize| {
        let t = k as f64 / steps as f64;
        point(
            centre,
            from[0] + t * (to[0] - from[0]),
            from[1] + t * (to[1] - from[1]),
        )
    };
    (0..=steps).map(corner).collect()
}

/// The arc of radius `r` from `start` through `width` radians.
pub(super) fn arc(centre: Point, r: f64, start: f64, width: f64) -> Vec<Point> {
    spiral(centre, [r, start], [r, start + width])
}

/// The sector between radii `inner` and `outer` from `start` through `width` radians; with a
/// width of 2π a ring, slit along its start.
pub(super) fn sector(
    centre: Point,
    [inner, outer]: [f64; 2],
    start: f64,
    width: f64,
) -> Vec<Point> {
    let mut points = arc(centre, outer, start, width);
    if inner > 0.0 {
        points.extend(arc(centre, inner, start + width, -width));
    } else if width < TAU {
        points.push(centre);
    }
    points
}
