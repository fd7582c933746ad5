//! Joint ranges and size of a location.

use crate::angle::{AngleSet, Arc};
use crate::manifold::{SelfMotionManifold, runs_inside};

/// Parts of a segment between which a curve is looked at.
const PARTS: usize = 8;

/// Angles of every joint over the parts of `manifolds` inside the physical limits of all joints,
/// given as arcs of internal variables.
pub fn joint_ranges(manifolds: &[SelfMotionManifold], physical: &[Arc]) -> Vec<AngleSet> {
    if physical.iter().all(Arc::is_full) {
        let range = |joint| AngleSet::from_arcs(manifolds.iter().map(|m| m.joint_range(joint)));
        return (0..physical.len()).map(range).collect();
    }
    let is_inside = |theta: &[f64]| {
        let mut pairs = theta.iter().zip(physical);
        pairs.all(|(&angle, arc)| arc.contains(angle))
    };
    let mut arcs: Vec<Vec<Arc>> = vec![Vec::new(); physical.len()];
    for manifold in manifolds {
        for run in runs_inside(manifold, PARTS, &is_inside) {
            for (arcs, [low, high]) in arcs.iter_mut().zip(run.spans) {
                arcs.push(Arc::from_interval(low, high));
            }
        }
    }
    arcs.into_iter().map(AngleSet::from_arcs).collect()
}

/// The sum of all ranges, radians: the size of a location [S1 §II.B].
pub fn size(ranges: &[AngleSet]) -> f64 {
    ranges.iter().map(AngleSet::measure).sum()
}
