//! Vertices where a joint's angle is stationary, so that ranges are exact.
//!
//! The cubic between two vertices of a long step is off by about 1e-5 rad in the middle. An end of
//! a joint's range lies there as often as not; with a vertex next to it, it is known to about
//! 1e-9 rad.

use super::correct::correct;
use super::curve::Curve;
use super::prober::Prober;
use crate::kinematics::dot;
use smallvec::SmallVec;

/// Extrema nearer to a vertex, or to each other, than this share of a segment need none of their own.
const NEAR: f64 = 1e-3;

/// Puts a vertex on the manifold at every extremum of every joint along `curve`.
pub(super) async fn resolve<const N: usize, const M: usize>(
    prober: &impl Prober<N, M>,
    curve: &mut Curve<N>,
) {
    let mut resolved = Curve::new();
    // Vertices put in before each old vertex.
    let mut shifts = Vec::with_capacity(curve.points.len());
    for index in 0..curve.points.len() {
        shifts.push(resolved.points.len() - index);
        resolved.push(curve.points[index], curve.tangents[index]);
        if index < curve.segments() {
            resolve_segment(prober, curve, index, &mut resolved).await;
        }
    }
    curve.points = resolved.points;
    curve.tangents = resolved.tangents;
    for crossing in &mut curve.crossings {
        *crossing += shifts.get(*crossing).copied().unwrap_or_default();
    }
}

async fn resolve_segment<const N: usize, const M: usize>(
    prober: &impl Prober<N, M>,
    curve: &Curve<N>,
    index: usize,
    resolved: &mut Curve<N>,
) {
    let (first, last) = (&curve.tangents[index], &curve.tangents[index + 1]);
    let turning = (0..N).filter(|&joint| first[joint] * last[joint] <= 0.0);
    let segment = curve.segment(index);
    let mut places: SmallVec<[f64; 8]> = turning
        .flat_map(|joint| segment.extrema(joint).into_iter().flatten())
        .filter(|u| (NEAR..=1.0 - NEAR).contains(u))
        .collect();
    places.sort_unstable_by(f64::total_cmp);
    places.dedup_by(|a, b| *a - *b < NEAR);
    for u in places {
        let guess = segment.at(u);
        let Some((point, newton)) = correct(prober, &guess).await else {
            continue;
        };
        let moved: [f64; N] = std::array::from_fn(|k| point[k] - guess[k]);
        // Anything farther is another strand.
        if dot(&moved, &moved).sqrt() > 0.01 * segment.length {
            continue;
        }
        let sense = dot(&newton.tangent, first).signum();
        resolved.push(point, newton.tangent.map(|t| t * sense));
    }
}
