//! Networks that give the size alone.
//!
//! The output is S_F as a share of what W₂ … W_n leave, which is known in closed form: the share
//! is in [0, 1], and the size is zero wherever these have nothing in common.

use crate::workspace::planar::LockedJoints;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Weight of the share's own error beside that of the size: without it small workspaces would not
/// count at all, and the order among them would be left to chance.
const SHARE_WEIGHT: f64 = 0.02;

/// A network with one output.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SizeHead {
    /// Whether the task is a pose.
    pub pose: bool,
    /// Largest S_F among the training data: the unit of errors.
    pub scale: f64,
}

impl SizeHead {
    /// The size of W₂ ∩ … ∩ W_n.
    pub fn bound(&self, locked: &LockedJoints) -> f64 {
        let [inner, outer] = locked.radii();
        let area = PI * (outer * outer - inner * inner).max(0.0);
        if self.pose { TAU * area } else { area }
    }

    /// The size for an output, given the bound.
    pub fn size(&self, output: f32, bound: f64) -> f64 {
        bound * f64::from(output).clamp(0.0, 1.0)
    }

    /// Squared error of the size, in units of the largest, plus a little of the share's.
    pub fn loss(&self, output: f32, bound: f64, size: f64, by_output: &mut f32) -> f64 {
        if bound <= 0.0 {
            return 0.0;
        }
        let error = f64::from(output) - size / bound;
        let weight = (bound / self.scale).powi(2) + SHARE_WEIGHT;
        *by_output += (2.0 * weight * error) as f32;
        weight * error * error
    }
}
