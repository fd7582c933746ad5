//! A surrogate as a score to maximise.

use super::model::{Model, Surrogate};
use crate::objective::{Design, DesignSpace, Objective, SearchSpace};
use rayon::prelude::*;

/// Designs that are scored at once.
const TOGETHER: usize = 64;

/// The predicted S_F, or S_F/S_0max where link lengths are searched.
#[derive(Clone, Debug)]
pub struct SurrogateObjective<'a> {
    model: &'a Model,
    design: DesignSpace,
    normalised: bool,
}

impl<'a> SurrogateObjective<'a> {
    /// The prediction of `model` over `design`, divided by S_0max if `normalised`.
    pub fn new(model: &'a Model, design: DesignSpace, normalised: bool) -> SurrogateObjective<'a> {
        SurrogateObjective {
            model,
            design,
            normalised,
        }
    }

    fn scores_of(&self, designs: &[Design]) -> Vec<f64> {
        let sizes = self.model.sizes(designs);
        if !self.normalised {
            return sizes;
        }
        let arm = self.model.arm();
        let pairs = sizes.iter().zip(designs);
        pairs
            .map(|(size, design)| size / arm.unrestricted_size(&design.lengths))
            .collect()
    }
}

impl Objective for SurrogateObjective<'_> {
    fn space(&self) -> &SearchSpace {
        self.design.space()
    }

    fn score(&self, x: &[f64]) -> f64 {
        self.scores_of(&[self.design.design(x)])[0]
    }

    fn scores(&self, points: &[Vec<f64>]) -> Vec<f64> {
        points
            .par_chunks(TOGETHER)
            .flat_map_iter(|points| {
                let designs: Vec<Design> = points.iter().map(|x| self.design.design(x)).collect();
                self.scores_of(&designs)
            })
            .collect()
    }

    fn scores_along(&self, x: &[f64], direction: &[f64], ts: &[f64]) -> Option<Vec<f64>> {
        let space = self.design.space();
        let at = |&t: &f64| self.design.design(&space.along(x, direction, t));
        let designs: Vec<Design> = ts.iter().map(at).collect();
        Some(self.scores_of(&designs))
    }
}
