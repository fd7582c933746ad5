//! Merits that the sizes of workspaces do not tell: dexterity inside W_F and the margin beyond the
//! limits. They cost more than sizes, so they are measured only where they are asked for.

use super::arm::Arm;
use super::assessment::DesignProblem;
use super::measures::{Measures, Merit};
use crate::workspace::ArtificialLimits;
use crate::workspace::hybrid::Atlas;

/// Dexterity is a mean that scatters little: one fault-tolerant sample for so many samples of the
/// atlas, between these numbers of them, keeps its cost below that of tracing.
const SAMPLES_EACH: u64 = 8;
/// See [`SAMPLES_EACH`].
const POSES: [u64; 2] = [64, 4000];

impl DesignProblem {
    /// The same question with all merits measured, as for a report.
    pub fn with_all_merits(&self) -> DesignProblem {
        DesignProblem {
            merits: Merit::ALL.to_vec(),
            ..self.clone()
        }
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
