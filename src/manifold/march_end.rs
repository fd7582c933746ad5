//! Where a march ends: back at its start, or at the end of a prismatic joint's stroke.

use super::correct::full_turns;
use super::curve::{Curve, short_way};
use super::march::March;
use super::prober::Prober;
use super::segment::Segment;
use crate::kinematics::dot;
use std::f64::consts::FRAC_PI_2;

/// If the start lies on the newest segment (modulo full turns): the start, unwrapped.
fn closure<const N: usize>(curve: &Curve<N>) -> Option<(Segment<N>, f64, [f64; N])> {
    let (start, last) = (&curve.points[0], curve.points.len() - 1);
    let (from, to) = (&curve.points[last - 1], &curve.points[last]);
    let mut gap = 0.0;
    let mut chord = 0.0;
    for k in 0..N {
        let d = short_way(start[k] - to[k]);
        gap += d * d;
        let c = to[k] - from[k];
        chord += c * c;
    }
    if gap > 1.7 * chord || dot(&curve.tangents[0], &curve.tangents[last]) < 0.5 {
        return None;
    }
    let lifted: [f64; N] = std::array::from_fn(|k| to[k] + short_way(start[k] - to[k]));
    let segment = Segment::new(from, to, &curve.tangents[last - 1], &curve.tangents[last]);
    let (u, miss) = segment.project(&lifted)?;
    (miss < 2e-3 + 0.005 * chord.sqrt()).then_some((segment, u, lifted))
}

impl<P: Prober<N, M>, const N: usize, const M: usize> March<'_, P, N, M> {
    /// The start, unwrapped, if the newest segment runs through it.
    ///
    /// Another strand may pass so near that only the manifold itself tells: from the segment,
    /// Newton steps within the plane across the start must lead to the start.
    pub(super) async fn back_at_start(&self, curve: &Curve<N>) -> Option<[f64; N]> {
        let (segment, u, start) = closure(curve)?;
        let across = &curve.tangents[0];
        let mut point = segment.at(u);
        for _ in 0..5 {
            let Some(newton) = self.prober.probe(&point).await else {
                break;
            };
            let tangent = newton.tangent.map(|t| t * self.sense);
            let along = dot(&tangent, across);
            if along < 0.5 {
                return None;
            }
            let moved: [f64; N] = std::array::from_fn(|k| point[k] + newton.correction[k]);
            let ahead: f64 = (0..N).map(|k| (start[k] - moved[k]) * across[k]).sum();
            point = std::array::from_fn(|k| moved[k] + tangent[k] * ahead / along);
        }
        let miss: [f64; N] = std::array::from_fn(|k| point[k] - start[k]);
        let first = &curve.points[0];
        (dot(&miss, &miss) < 1e-10)
            .then(|| std::array::from_fn(|k| first[k] + full_turns(start[k] - first[k])))
    }

    /// The prismatic joint that has left its stroke on the newest segment, and a parameter there
    /// at which it is outside; it may be back at the segment's end.
    pub(super) fn left_stroke(&self, curve: &Curve<N>) -> Option<(usize, f64)> {
        let outside = |joint: usize| {
            if self.prober.kernel().is_revolute(joint) {
                return None;
            }
            if self.point[joint].abs() > FRAC_PI_2 {
                return Some((joint, 1.0));
            }
            if self.tangents[0][joint] * self.tangents[1][joint] >= 0.0 {
                return None;
            }
            let segment = curve.segment(curve.segments() - 1);
            let mut extrema = segment.extrema(joint).into_iter().flatten();
            let u = extrema.find(|&u| segment.coordinate(joint, u).abs() > FRAC_PI_2)?;
            Some((joint, u))
        };
        (0..N).find_map(outside)
    }

    /// Moves the newest vertex back to where `joint` leaves its stroke before parameter `outside`.
    pub(super) async fn end_at_stroke(
        &mut self,
        curve: &mut Curve<N>,
        joint: usize,
        mut outside: f64,
    ) {
        let last = curve.points.len() - 1;
        let segment = curve.segment(last - 1);
        let limit = FRAC_PI_2.copysign(segment.coordinate(joint, outside));
        let mut inside = 0.0;
        for _ in 0..40 {
            let middle = 0.5 * (inside + outside);
            if segment.coordinate(joint, middle).abs() < FRAC_PI_2 {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        let mut point = segment.at(inside);
        let mut tangent = self.tangents[0];
        for _ in 0..4 {
            let Some(newton) = self.prober.probe(&point).await else {
                break;
            };
            tangent = newton.tangent.map(|t| t * self.sense);
            let ahead = limit - point[joint] - newton.correction[joint];
            let step = (ahead / tangent[joint]).clamp(-0.1, 0.1);
            if !step.is_finite() {
                break;
            }
            for k in 0..N {
                point[k] += newton.correction[k] + step * tangent[k];
            }
        }
        // Where the joint turns round just at its end, the steps may not converge.
        if (point[joint] - limit).abs() < 1e-9 && dot(&tangent, &self.tangents[0]) > 0.5 {
            point[joint] = limit;
            curve.points[last] = point;
            curve.tangents[last] = tangent;
        }
    }
}
