//! Sizes of workspaces, each with its error.

use serde::{Deserialize, Serialize};

/// A number and the bound within which it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The value, in the unit of the task space (m² for positions in the plane, m² rad for poses).
    pub value: f64,
    /// Estimated absolute error, same unit: refinement error for quadrature, standard error for
    /// Monte-Carlo estimates.
    pub error: f64,
}

/// Sizes of every workspace that makes up the fault-tolerant one.
///
/// `unrestricted` ≥ `pre_failure` ≥ `fault_tolerant`, and every `post_failure` ≥ `fault_tolerant`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorkspaceSizes {
    /// S_F, the size of W_F = W₀ ∩ ⋂ W_i.
    pub fault_tolerant: Estimate,
    /// Size of W₀: what is reachable inside the artificial limits before a failure.
    pub pre_failure: Estimate,
    /// Size of each W_i, joint 1 first: what is reachable wherever within A_i joint i locks, the
    /// other joints released. Given for every joint, prone to failure or not.
    pub post_failure: Vec<Estimate>,
    /// S_0max: what is reachable with all joints free.
    pub unrestricted: Estimate,
}

impl WorkspaceSizes {
    /// S_F / S_0max, in [0, 1].
    pub fn normalised(&self) -> f64 {
        if self.unrestricted.value > 0.0 {
            self.fault_tolerant.value / self.unrestricted.value
        } else {
            0.0
        }
    }
}
