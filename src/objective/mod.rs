//! What is maximised: design vectors and their scores.

mod design_vector;
mod hybrid;
mod planar;
mod space;

pub use design_vector::{Design, DesignSpace};
pub use hybrid::HybridObjective;
pub use planar::{PlanarObjective, PlanarTask};
pub use space::{SearchSpace, Variable};

use rayon::prelude::*;

/// A score to maximise over a box.
///
/// Scores are finite and never NaN; the worst is 0. The same point gives the same score on every
/// thread.
pub trait Objective: Sync {
    /// The box.
    fn space(&self) -> &SearchSpace;

    /// The score of a point of the box.
    fn score(&self, x: &[f64]) -> f64;

    /// The scores of many points, in their order.
    fn scores(&self, points: &[Vec<f64>]) -> Vec<f64> {
        points.par_iter().map(|x| self.score(x)).collect()
    }

    /// The scores of the points x + t · direction for all `ts` (ascending), if the objective
    /// knows a way that is faster than one by one.
    fn scores_along(&self, x: &[f64], direction: &[f64], ts: &[f64]) -> Option<Vec<f64>> {
        let _ = (x, direction, ts);
        None
    }
}
