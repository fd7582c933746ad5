//! Where a search over an atlas begins, beside random limits.
//!
//! Arms built for other ends (the Panda, the xArm 7) have no fault-tolerant workspace for nearly all
//! limits: random ones score 0, and a search from there sees no slope. Then limits that some sample
//! survives show where to look.

use super::settings::{Optimise, Study};
use crate::objective::{DesignSpace, Objective};
use crate::sampling::stream;
use crate::workspace::hybrid::Atlas;

/// Random limits that must all score 0 before survivors are asked for.
const PROBES: usize = 256;

/// Limits drawn around surviving samples.
const SURVIVORS: usize = 4096;

/// How many of them the search begins with.
const KEPT: usize = 12;

/// The random stream of the probes: no restart of a search has this number.
const PROBING: u64 = u64::MAX - 1;

/// Points of `space` that the search of `optimise` has to begin with. `score` is the one that it
/// begins on; it rests on samples of `atlas`.
pub(super) fn first_candidates(
    study: &Study,
    optimise: &Optimise,
    space: &DesignSpace,
    score: &dyn Objective,
    atlas: &Atlas,
) -> Vec<Vec<f64>> {
    if let Some(start) = &optimise.start {
        return vec![space.point(&start.to_limits(&study.design.robot))];
    }
    let mut rng = stream(study.seed, PROBING);
    let probes: Vec<Vec<f64>> = (0..PROBES)
        .map(|_| score.space().random(&mut rng))
        .collect();
    if score.scores(&probes).iter().any(|score| *score > 0.0) {
        return Vec::new();
    }
    let limits = atlas.surviving_limits(SURVIVORS, study.seed);
    let points: Vec<Vec<f64>> = limits.iter().map(|limits| space.point(limits)).collect();
    let mut scored: Vec<(f64, Vec<f64>)> = score.scores(&points).into_iter().zip(points).collect();
    // The sort is stable: equal scores stay in the order in which they were drawn.
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    scored.retain(|(score, _)| *score > 0.0);
    scored.into_iter().take(KEPT).map(|(_, x)| x).collect()
}
