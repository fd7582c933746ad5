//! How finely pose workspaces are computed.

pub use super::quadrature::Kronrod;

/// How finely a pose workspace is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseResolution {
    /// Relative error at which the radial quadrature stops. Too large: an optimiser climbs the
    /// noise; too small: time grows, while the bearing nodes bound the accuracy. Default 3e-4.
    pub tolerance: f64,
    /// Bearings β per full circle at which the set of γ is computed. Default 64.
    pub bearings: usize,
    /// Slices per full circle that joint 1 sweeps (five joints only), beside those at every bearing
    /// where something changes. Default 64.
    pub slices: usize,
    /// Radial panels after which refinement stops whatever the error. Default 200.
    pub max_panels: usize,
    /// Rule on each radial panel. Default 15 points.
    pub rule: Kronrod,
}

impl Default for PoseResolution {
    fn default() -> Self {
        PoseResolution {
            tolerance: 3e-4,
            bearings: 64,
            slices: 64,
            max_panels: 100,
            rule: Kronrod::Fifteen,
        }
    }
}

impl PoseResolution {
    /// Settings that keep the error of most workspaces within the relative `tolerance`: the error
    /// of the bearings and slices falls with the square of their number.
    pub fn for_tolerance(tolerance: f64) -> PoseResolution {
        let default = PoseResolution::default();
        let finer = (1e-3 / tolerance).sqrt().clamp(0.5, 16.0);
        PoseResolution {
            tolerance: 0.3 * tolerance,
            bearings: (default.bearings as f64 * finer).ceil() as usize,
            slices: (default.slices as f64 * finer).ceil() as usize,
            max_panels: (default.max_panels as f64 * finer).ceil() as usize,
            rule: default.rule,
        }
    }

    /// Coarse settings for a search whose winner is scored again: about 0.2 % in a third of the
    /// time.
    pub fn coarse() -> PoseResolution {
        PoseResolution {
            tolerance: 2e-3,
            bearings: 32,
            slices: 32,
            max_panels: 40,
            rule: Kronrod::Seven,
        }
    }

    /// Twice as fine.
    pub(super) fn doubled(self) -> PoseResolution {
        PoseResolution {
            tolerance: 0.5 * self.tolerance,
            bearings: 2 * self.bearings,
            slices: 2 * self.slices,
            max_panels: 2 * self.max_panels,
            rule: Kronrod::Fifteen,
        }
    }
}
