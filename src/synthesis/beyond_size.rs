//! Merits that the sizes of workspaces do not tell: dexterity inside W_F and the margin beyond the
//! limits. They cost more than sizes, so they are measured only where they are asked for.

use super::arm::Arm;
use super::assessment::{DesignProblem, Draft, Look};
use super::link_space::Links;
use super::measures::{Measures, Merit};
use super::seeds::{Purpose, sample_seed};
use crate::workspace::ArtificialLimits;
use crate::workspace::hybrid::Atlas;

/// Dexterity is a mean that scatters little: one fault-tolerant sample for so many samples of the
/// atlas, between these numbers of them, keeps its cost below that of tracing.
const SAMPLES_EACH: u64 = 8;
/// See [`SAMPLES_EACH`].
const POSES: [u64; 2] = [64, 4000];

/// Task points on which the margin of a robot of a search is measured, as a multiple of those its
/// limits are fitted to: a tenth of S_F is carried by few of them.
pub const MARGIN_SAMPLES: u32 = 3;

impl DesignProblem {
    /// The same question with all merits measured, as for a report.
    pub fn with_all_merits(&self) -> DesignProblem {
        DesignProblem {
            merits: Merit::ALL.to_vec(),
            ..self.clone()
        }
    }

    /// `draft` with its margin, if that is asked for, measured on other task points than those of
    /// `look`. Limits that were fitted to samples end where the next one would be lost: on these
    /// samples the slightest overshoot loses some, and every margin is about 0.
    pub(super) fn with_margin_apart(&self, mut draft: Draft, look: Look) -> Draft {
        if !self.merits.contains(&Merit::Margin) {
            return draft;
        }
        let apart = Look {
            samples: MARGIN_SAMPLES * look.samples,
            seed: sample_seed(look.seed, Purpose::Margin, 0),
            ..look
        };
        let limits = &draft.limits;
        let arm = Arm::of_links(&self.links, &draft.links);
        let atlas = arm.and_then(|arm| self.atlas(&arm, apart, Some(limits)));
        draft.measures.margin = atlas.map(|atlas| self.margin(&atlas, limits));
        draft.score = self.score(&draft.measures);
        draft
    }

    /// `links` measured on samples that these limits, or those they come from, may have been fitted
    /// to.
    pub(super) fn measured_apart(
        &self,
        links: &Links,
        limits: &ArtificialLimits,
        look: Look,
    ) -> Option<Draft> {
        let draft = self.measured(links, limits, look)?;
        Some(self.with_margin_apart(draft, look))
    }

    /// Adds to `measures` what is asked for beyond sizes.
    pub(super) fn measure_beyond_size(
        &self,
        measures: &mut Measures,
        arm: &Arm,
        atlas: &Atlas,
        limits: &ArtificialLimits,
    ) {
        if self.merits.iter().any(|merit| merit.needs_configurations()) {
            let [fewest, most] = POSES;
            let poses = (atlas.counts().samples / SAMPLES_EACH).clamp(fewest, most);
            measures.dexterity = atlas.dexterity(&arm.robot, limits, &self.failures, poses);
        }
        if self.merits.contains(&Merit::Margin) {
            measures.margin = Some(self.margin(atlas, limits));
        }
    }
}
