//! Parts of an atlas on which coordinate ascent begins.
//!
//! What costs time is to find the right mountain, for which few samples do. The noise of few
//! samples moves its top, so the best are climbed again with more samples, and last with all.

use super::settings::{Optimise, OptimiserSettings};
use crate::design::TaskSpace;
use crate::workspace::hybrid::Atlas;

/// Parts of the samples: their share is one in that many; then how many of the best found on
/// them go on.
const PARTS: [(u64, usize); 2] = [(16, 6), (4, 3)];

/// Fewest samples of a part, which would otherwise mistake noise for mountains: the more
/// dimensions they fill, the more it takes. The 7R arm's best limits are missed with 6000.
fn fewest(task: TaskSpace) -> u64 {
    match task {
        TaskSpace::PlanarPosition | TaskSpace::SpatialPosition => 300,
        TaskSpace::PlanarPose => 2000,
        TaskSpace::SpatialPose => 10_000,
    }
}

/// A part of an atlas.
pub(super) struct Part {
    pub atlas: Atlas,
    pub samples: u64,
    /// How many of the best found on it go on.
    pub finalists: usize,
}

/// The parts of `atlas` for the search of `optimise`, smallest first; none for a genetic search.
pub(super) fn parts(optimise: &Optimise, atlas: &Atlas) -> Vec<Part> {
    if let OptimiserSettings::Genetic(_) = optimise.optimiser {
        return Vec::new();
    }
    let part = |&(every, finalists): &(u64, usize)| {
        let samples = atlas.plan().kept(every);
        (samples >= fewest(atlas.plan().task)).then(|| Part {
            atlas: atlas.thinned(every),
            samples,
            finalists,
        })
    };
    PARTS.iter().filter_map(part).collect()
}
