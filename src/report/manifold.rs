//! Self-motion manifolds as curves in the joint space, cut where limits begin and end and where an
//! angle passes ±180°.

use crate::angle::wrap;
use crate::workspace::ArtificialLimits;
use std::f64::consts::{PI, TAU};

/// One self-motion manifold: joint angles that all hold the same task point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ManifoldCurve {
    /// Vertices in order, each with the angles of all joints, radians. Unwrapped: from one to the
    /// next an angle does not jump by 2π.
    pub points: Vec<Vec<f64>>,
    /// Whether the last vertex is followed by the first, modulo 2π.
    pub closed: bool,
}

/// A configuration at which the angle of a joint is extreme on its manifold [S4 §III].
#[derive(Clone, Debug, PartialEq)]
pub struct CriticalPoint {
    /// Number of that joint, from 1.
    pub joint: usize,
    /// Angles of all joints, radians.
    pub configuration: Vec<f64>,
}

/// A part of a curve that lies within the limits throughout or nowhere.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    pub points: Vec<Vec<f64>>,
    pub is_inside: bool,
}

/// Angles beyond this are no joint's, radians.
const MOST: f64 = 1e3 * TAU;

/// Whether a configuration has `joints` angles that can be drawn.
pub(super) fn is_drawable(configuration: &[f64], joints: usize) -> bool {
    let is_angle = |angle: &f64| angle.abs() < MOST;
    configuration.len() == joints && configuration.iter().all(is_angle)
}

/// Whether all joints but the first are within their limits.
pub(super) fn is_within(configuration: &[f64], limits: &ArtificialLimits) -> bool {
    let each = configuration.iter().zip(limits.joints()).skip(1);
    let mut each = each.filter(|(_, limit)| is_limiting(limit.lower, limit.upper));
    each.all(|(angle, limit)| limit.arc().contains(*angle))
}

fn is_limiting(lower: f64, upper: f64) -> bool {
    lower.abs() < MOST && upper.abs() < MOST && lower <= upper && upper - lower < TAU - 1e-12
}

/// Cuts a curve where it enters or leaves the box of all limits but joint 1's. Vertices that
/// cannot be drawn are left out.
pub(super) fn pieces(
    curve: &ManifoldCurve,
    joints: usize,
    limits: Option<&ArtificialLimits>,
) -> Vec<Piece> {
    let mut levels = Vec::new();
    for (joint, limit) in limits.iter().flat_map(|l| l.joints()).enumerate().skip(1) {
        if joint < joints && is_limiting(limit.lower, limit.upper) {
            levels.extend([(joint, limit.lower), (joint, limit.upper)]);
        }
    }
    let mut pieces: Vec<Piece> = Vec::new();
    for [a, b] in segments(curve, joints) {
        for [from, to] in cut(&a, &b, &levels) {
            let is_inside = limits.is_some_and(|limits| is_within(&middle(&from, &to), limits));
            match pieces.last_mut() {
                Some(piece)
                    if piece.is_inside == is_inside && piece.points.last() == Some(&from) =>
                {
                    piece.points.push(to);
                }
                _ => pieces.push(Piece {
                    points: vec![from, to],
                    is_inside,
                }),
            }
        }
    }
    pieces
}

/// A path seen in some joints (indices), in degrees within [−180, 180]; a new line starts where
/// one of these angles passes ±180°.
pub(super) fn wrapped<const N: usize>(
    points: &[Vec<f64>],
    joints: [usize; N],
) -> Vec<Vec<[f64; N]>> {
    wrapped_angles(points, joints.map(|joint| (joint, true)))
}

/// [`wrapped`] of columns that are angles (`true`) or lengths, which stay as they are.
pub(super) fn wrapped_angles<const N: usize>(
    points: &[Vec<f64>],
    columns: [(usize, bool); N],
) -> Vec<Vec<[f64; N]>> {
    let angles = columns.iter().filter(|(_, is_angle)| *is_angle);
    let levels: Vec<(usize, f64)> = angles.map(|(column, _)| (*column, PI)).collect();
    let mut lines: Vec<(Vec<[f64; N]>, [f64; N])> = Vec::new();
    for pair in points.windows(2) {
        for [from, to] in cut(&pair[0], &pair[1], &levels) {
            let inner = middle(&from, &to);
            let turns = columns.map(|(column, is_angle)| match is_angle {
                true => inner[column] - wrap(inner[column]),
                false => 0.0,
            });
            let seen = |point: &[f64]| -> [f64; N] {
                std::array::from_fn(|c| match columns[c] {
                    (column, true) => {
                        let degrees = (point[column] - turns[c]).to_degrees();
                        degrees.clamp(-180.0, 180.0)
                    }
                    (column, false) => point[column],
                })
            };
            // Turns are multiples of 2π up to round-off.
            let is_same = |last: &[f64; N]| (0..N).all(|c| (last[c] - turns[c]).abs() < 1.0);
            match lines.last_mut().filter(|(_, last)| is_same(last)) {
                Some((line, _)) => line.push(seen(&to)),
                None => lines.push((vec![seen(&from), seen(&to)], turns)),
            }
        }
    }
    lines.into_iter().map(|(line, _)| line).collect()
}

/// Pairs of neighbouring vertices, with the pair that closes the curve.
fn segments(curve: &ManifoldCurve, joints: usize) -> Vec<[Vec<f64>; 2]> {
    let is_fine = |point: &&Vec<f64>| is_drawable(point, joints);
    let mut points: Vec<Vec<f64>> = curve.points.iter().filter(is_fine).cloned().collect();
    if let (true, [first, .., last]) = (curve.closed, points.as_slice()) {
        // The first vertex again, after whole turns.
        let near = |(a, b): (&f64, &f64)| a + TAU * ((b - a) / TAU).round();
        points.push(first.iter().zip(last).map(near).collect());
    }
    points
        .windows(2)
        .map(|pair| [pair[0].clone(), pair[1].clone()])
        .collect()
}

/// The segment from `a` to `b` cut wherever a joint is at one of its levels modulo 2π.
fn cut(a: &[f64], b: &[f64], levels: &[(usize, f64)]) -> Vec<[Vec<f64>; 2]> {
    let mut at = vec![0.0, 1.0];
    for (joint, level) in levels {
        let (from, to) = (a[*joint], b[*joint]);
        let [low, high] = [from.min(to), from.max(to)];
        let mut angle = level + TAU * ((low - level) / TAU).ceil();
        while angle < high {
            at.push((angle - from) / (to - from));
            angle += TAU;
        }
    }
    at.sort_by(f64::total_cmp);
    at.dedup();
    let point = |t: f64| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a + t * (b - a)).collect() };
    at.windows(2)
        .map(|pair| [point(pair[0]), point(pair[1])])
        .collect()
}

fn middle(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn degrees(points: &[[f64; 2]]) -> Vec<Vec<f64>> {
        points
            .iter()
            .map(|p| p.map(f64::to_radians).to_vec())
            .collect()
    }

    fn rounded(lines: Vec<Vec<[f64; 2]>>) -> Vec<Vec<[i64; 2]>> {
        let whole = |p: &[f64; 2]| p.map(|c| (c * 10.0).round() as i64);
        lines
            .iter()
            .map(|line| line.iter().map(whole).collect())
            .collect()
    }

    #[test]
    fn lines_break_exactly_at_180_degrees() {
        let path = degrees(&[[170.0, 0.0], [190.0, 20.0], [200.0, 20.0]]);
        let lines = rounded(wrapped(&path, [0, 1]));
        let expected = [
            vec![[1700, 0], [1800, 100]],
            vec![[-1800, 100], [-1700, 200], [-1600, 200]],
        ];
        assert_eq!(lines, expected);
        // Several turns, and both angles at once.
        let path = degrees(&[[0.0, 0.0], [720.0, -720.0]]);
        assert_eq!(wrapped(&path, [0, 1]).len(), 3);
    }

    #[test]
    fn parts_within_the_limits_are_cut_out() {
        let curve = ManifoldCurve {
            points: degrees(&[[0.0, -60.0], [100.0, 0.0], [200.0, 60.0]]),
            closed: false,
        };
        let limits = ArtificialLimits::from_degrees(&[[0.0, 1.0], [330.0, 390.0]]);
        let pieces = pieces(&curve, 2, Some(&limits));
        let inside: Vec<bool> = pieces.iter().map(|piece| piece.is_inside).collect();
        assert_eq!(inside, [false, true, false]);
        // Joint 1's limits do not count.
        let ends = rounded(wrapped(&pieces[1].points, [0, 1]));
        assert_eq!(ends, [vec![[500, -300], [1000, 0], [1500, 300]]]);
    }

    #[test]
    fn a_closed_curve_may_wind() {
        let step = |k: usize| vec![0.1 * k as f64, (0.1 * k as f64).sin()];
        let curve = ManifoldCurve {
            points: (0..63).map(step).collect(),
            closed: true,
        };
        let segments = segments(&curve, 2);
        assert_eq!(segments.len(), 63);
        let end = &segments[62][1];
        assert!((end[0] - TAU).abs() < 1e-12 && end[1].abs() < 1e-12);
        assert_eq!(pieces(&curve, 2, None).len(), 1);
        let lines = wrapped(&pieces(&curve, 2, None)[0].points, [0, 1]);
        assert_eq!(lines.len(), 2);
    }

    #[test]
    fn odd_vertices_are_left_out() {
        let curve = ManifoldCurve {
            points: vec![
                vec![f64::NAN, 0.0],
                vec![1e300, 0.0],
                vec![0.0],
                vec![0.0, 0.0],
            ],
            closed: true,
        };
        assert!(pieces(&curve, 2, None).is_empty());
        assert!(pieces(&ManifoldCurve::default(), 0, None).is_empty());
    }
}
