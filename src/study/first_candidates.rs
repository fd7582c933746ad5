//! Where a search over an atlas begins, beside random limits.
//!
//! Arms built for other ends (the Panda, the xArm 7) have no fault-tolerant workspace for nearly all
//! limits: random ones score 0, and a search from there sees no slope. Then limits that some sample
//! survives show where to look, and a part of the samples, of which hardly any survives, would
//! mistake a single one for a mountain.

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

/// What a search begins with.
pub(super) struct Beginning {
    /// Points to begin at, beside random ones.
    pub starts: Vec<Vec<f64>>,
    /// Whether a part of the samples is too few to begin on.
    pub on_all_samples: bool,
}

/// How the search of `optimise` over `space` begins. `score` rests on all samples of `atlas`,
/// `coarse` on as few as the search would begin with.
pub(super) fn beginning(
    study: &Study,
    optimise: &Optimise,
    space: &DesignSpace,
    [coarse, score]: [&dyn Objective; 2],
    atlas: &Atlas,
) -> Beginning {
    if let Some(start) = &optimise.start {
        return Beginning {
            starts: vec![space.point(&start.to_limits(&study.design.robot))],
            on_all_samples: false,
        };
    }
    let mut rng = stream(study.seed, PROBING);
    let probes: Vec<Vec<f64>> = (0..PROBES)
        .map(|_| space.space().random(&mut rng))
        .collect();
    if coarse.scores(&probes).iter().any(|score| *score > 0.0) {
        return Beginning {
            starts: Vec::new(),
            on_all_samples: false,
        };
    }
    Beginning {
        starts: survivors(study, space, score, atlas),
        on_all_samples: true,
    }
}

/// The best limits among those drawn around surviving samples.
fn survivors(
    study: &Study,
    space: &DesignSpace,
    score: &dyn Objective,
    atlas: &Atlas,
) -> Vec<Vec<f64>> {
    let limits = atlas.surviving_limits(SURVIVORS, study.seed);
    let points: Vec<Vec<f64>> = limits.iter().map(|limits| space.point(limits)).collect();
    let mut scored: Vec<(f64, Vec<f64>)> = score.scores(&points).into_iter().zip(points).collect();
    // The sort is stable: equal scores stay in the order in which they were drawn.
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    scored.retain(|(score, _)| *score > 0.0);
    scored.into_iter().take(KEPT).map(|(_, x)| x).collect()
}
