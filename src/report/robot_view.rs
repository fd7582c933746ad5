//! What a picture of a robot in space shows, and from where.

use super::canvas::Point;
use super::joint_mark::Mark;
use super::projection::View;
use nalgebra::{Isometry3, Vector3};

/// From above the horizon, radians.
const ELEVATION: f64 = 0.42;
/// Length of a frame's arrows in radii of a joint.
pub(super) const ARROW: f64 = 3.2;

/// The least and the largest coordinates of points with margins around them.
pub(super) fn bounds(points: impl Iterator<Item = (Vector3<f64>, f64)>) -> [Vector3<f64>; 2] {
    let start = Vector3::repeat(f64::INFINITY);
    points.fold([start, -start], |[low, high], (point, margin)| {
        [
            low.inf(&point.add_scalar(-margin)),
            high.sup(&point.add_scalar(margin)),
        ]
    })
}

/// Sides of a box around everything; none so short that its ticks run together.
pub(super) fn sides(
    points: &[Vector3<f64>],
    marks: &[Mark],
    frames: &[Isometry3<f64>],
    radius: f64,
) -> [[f64; 3]; 2] {
    let ends = marks
        .iter()
        .flat_map(|mark| [mark.end(-1.0), mark.end(1.0)]);
    let tip = |frame: &Isometry3<f64>, axis| {
        frame.translation.vector + frame.rotation * Vector3::ith(axis, ARROW * radius)
    };
    let tips = frames
        .iter()
        .flat_map(|frame| [0, 1, 2].map(|axis| tip(frame, axis)));
    let all = points
        .iter()
        .copied()
        .chain(ends)
        .map(|point| (point, 1.2 * radius));
    let [mut low, mut high] = bounds(all.chain(tips.map(|tip| (tip, 0.3 * radius))));
    let least = 0.5 * (high - low).max();
    for axis in 0..3 {
        let missing = (least - (high[axis] - low[axis])).max(0.0);
        // A robot stands on its floor: room is added above.
        let below = if axis == 2 { 0.0 } else { 0.5 * missing };
        low[axis] -= below;
        high[axis] += missing - below;
    }
    [low.into(), high.into()]
}

/// The view in which the joints and the corners of the links are farthest apart on the picture.
pub(super) fn best_view(corners: &[Vector3<f64>], marks: &[Mark], radius: f64) -> View {
    let mut points: Vec<Vector3<f64>> = marks.iter().map(|mark| mark.centre).collect();
    points.extend(corners);
    let mut best = (f64::NEG_INFINITY, View::new(-0.9, ELEVATION));
    // The viewer stands before the x axis or the y axis, so that x or y runs to the right.
    for degrees in (-70..=70)
        .step_by(5)
        .filter(|d| (20..=70).contains(&i32::abs(*d)))
    {
        let view = View::new(f64::from(degrees).to_radians(), ELEVATION);
        let flat: Vec<Point> = points.iter().map(|point| view.flat(point)).collect();
        let mut score = 0.0;
        for (index, a) in flat.iter().enumerate() {
            for b in &flat[..index] {
                let distance = (a[0] - b[0]).hypot(a[1] - b[1]) / radius;
                score += (distance * distance + 0.1).ln();
                // Joints should not cover each other; the pair's first point has the larger index.
                if index < marks.len() {
                    score -= 20.0 * (2.5 - distance).max(0.0);
                }
            }
        }
        if score > best.0 {
            best = (score, view);
        }
    }
    best.1
}
