//! How far joints may overshoot their limits before a robot loses its fault tolerance.

use super::arm::Arm;
use super::assessment::DesignProblem;
use crate::workspace::hybrid::Atlas;
use crate::workspace::{ArtificialLimits, Estimate};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_6;

/// S_F / S_0max at one margin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AtMargin {
    /// How far beyond its limits a joint may lock, radians.
    pub margin: f64,
    /// S_F / S_0max.
    pub share: Estimate,
}

/// The share for several margins, and the one that costs a tenth of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MarginCurve {
    /// In the order asked for.
    pub points: Vec<AtMargin>,
    /// The margin at which the share has dropped by 10 % of its value without one, radians;
    /// `None` if it lies beyond [`WIDEST`] or there is nothing to lose.
    pub ten_percent: Option<f64>,
}

/// Widest margin that is looked at, radians.
pub const WIDEST: f64 = FRAC_PI_6;

/// Halvings of the interval in which the tenth is lost: to 0.01°.
const HALVINGS: usize = 12;

impl DesignProblem {
    /// The share of `arm` over `atlas` for several margins (radians) instead of the problem's own.
    pub fn margin_curve(
        &self,
        arm: &Arm,
        atlas: &Atlas,
        limits: &ArtificialLimits,
        margins: &[f64],
    ) -> MarginCurve {
        let share = |margin: f64| {
            let problem = DesignProblem {
                failures: self.failures.clone().with_margin(margin),
                ..self.clone()
            };
            problem.measures(arm, atlas, limits).share
        };
        let points = margins.iter().map(|&margin| AtMargin {
            margin,
            share: share(margin),
        });
        let wanted = 0.9 * share(0.0).value;
        let (mut low, mut high) = (0.0, WIDEST);
        let exists = wanted > 0.0 && share(high).value < wanted;
        for _ in 0..if exists { HALVINGS } else { 0 } {
            let middle = 0.5 * (low + high);
            if share(middle).value < wanted {
                high = middle;
            } else {
                low = middle;
            }
        }
        MarginCurve {
            points: points.collect(),
            ten_percent: exists.then_some(0.5 * (low + high)),
        }
    }
}
