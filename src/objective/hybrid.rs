//! The size of any robot's fault-tolerant workspace over an atlas as a score.

use super::design_vector::DesignSpace;
use super::space::SearchSpace;
use super::{Design, Objective};
use crate::workspace::FailureSet;
use crate::workspace::hybrid::{Atlas, Rule};

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
}
