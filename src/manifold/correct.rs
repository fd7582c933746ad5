//! Newton steps onto a manifold, from nearby.

use super::curve::{Curve, CurveStatus};
use super::prober::Prober;
use crate::kinematics::{NewtonStep, dot};
use std::f64::consts::TAU;

/// Newton steps from `guess` onto the manifold; `None` if they do not converge.
pub(super) async fn correct<const N: usize, const M: usize>(
    prober: &impl Prober<N, M>,
    guess: &[f64; N],
) -> Option<([f64; N], NewtonStep<N>)> {
    let mut point = *guess;
    for _ in 0..12 {
        let newton = prober.probe(&point).await?;
        let size = dot(&newton.correction, &newton.correction).sqrt();
        if size.is_nan() || size >= 0.1 {
            return None;
        }
        point = std::array::from_fn(|k| point[k] + newton.correction[k]);
        // The next one would be about the square.
        if size < 1e-6 {
            return Some((point, newton));
        }
    }
    None
}

/// One Newton step at every vertex.
pub(super) async fn polish<const N: usize, const M: usize>(
    prober: &impl Prober<N, M>,
    allowed: f64,
    curve: &mut Curve<N>,
) {
    let ends = if curve.status == CurveStatus::Stroke {
        1
    } else {
        0
    };
    for index in ends..curve.points.len() - ends {
        let point = curve.points[index];
        let Some(newton) = prober.probe(&point).await else {
            continue;
        };
        let size = dot(&newton.correction, &newton.correction);
        if size.is_nan() || size > allowed * allowed {
            continue;
        }
        let old = curve.tangents[index];
        let sense = dot(&newton.tangent, &old).signum();
        if sense < 0.0 && curve.crossings.is_empty() {
            // The step led to a neighbouring strand.
            continue;
        }
        curve.points[index] = std::array::from_fn(|k| point[k] + newton.correction[k]);
        curve.tangents[index] = newton.tangent.map(|t| t * sense);
    }
    if curve.status == CurveStatus::Closed {
        // Both ends are the same configuration; keep them equal to the last bit but the turns.
        let last = curve.points.len() - 1;
        let (first, end) = (curve.points[0], curve.points[last]);
        curve.points[last] = std::array::from_fn(|k| first[k] + full_turns(end[k] - first[k]));
        curve.tangents[last] = curve.tangents[0];
    }
}

/// The multiple of a full turn next to `angle`.
pub(super) fn full_turns(angle: f64) -> f64 {
    (angle / TAU).round() * TAU
}
