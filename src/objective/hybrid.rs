//! The size of any robot's fault-tolerant workspace over an atlas as a score.

use super::design_vector::DesignSpace;
use super::space::SearchSpace;
use super::{Design, Objective};
use crate::workspace::FailureSet;
use crate::workspace::hybrid::{Atlas, Rule};
use std::f64::consts::TAU;

/// S_F for limits in internal joint variables, from the pre-images of an atlas.
///
/// The samples are the same for every candidate, so the score is a function of the limits alone;
/// its maximum is biased upwards and is to be measured anew on other samples.
#[derive(Debug)]
pub struct HybridObjective<'a> {
    design: DesignSpace,
    atlas: &'a Atlas,
    failures: FailureSet,
    rule: Rule,
}

impl<'a> HybridObjective<'a> {
    /// S_F over `design`.
    pub fn new(
        design: DesignSpace,
        atlas: &'a Atlas,
        failures: FailureSet,
        rule: Rule,
    ) -> HybridObjective<'a> {
        HybridObjective {
            design,
            atlas,
            failures,
            rule,
        }
    }

    /// The score of a design.
    pub fn score_of(&self, design: &Design) -> f64 {
        let size = match self.rule {
            Rule::Definition => self
                .atlas
                .fault_tolerant_size(&design.limits, &self.failures),
            Rule::Paper => {
                let sizes = self.atlas.sizes(&design.limits, &self.failures, self.rule);
                sizes.fault_tolerant.value
            }
        };
        if size.is_finite() { size } else { 0.0 }
    }
}

impl Objective for HybridObjective<'_> {
    fn space(&self) -> &SearchSpace {
        self.design.space()
    }

    fn score(&self, x: &[f64]) -> f64 {
        self.score_of(&self.design.design(x))
    }

    /// Moves of one joint's limits, all widths in one pass over the atlas.
    fn scores_along(&self, x: &[f64], direction: &[f64], ts: &[f64]) -> Option<Vec<f64>> {
        if self.rule != Rule::Definition {
            return None;
        }
        let step = self.design.single_limit(direction)?;
        let limits = self.design.design(x).limits;
        let width = x[step.width_variable];
        let widths = ts.iter().map(|t| (width + step.per_t * t).clamp(0.0, TAU));
        let mut widths: Vec<f64> = widths.collect();
        let falls = step.per_t < 0.0;
        if falls {
            widths.reverse();
        }
        let (joint, failures) = (step.joint, &self.failures);
        let profile = self
            .atlas
            .profile(&limits, failures, joint, step.growth, &widths);
        profile.map(|mut scores| {
            if falls {
                scores.reverse();
            }
            scores
        })
    }
}
