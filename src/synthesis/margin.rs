//! How far joints may overshoot their limits before a robot loses its fault tolerance.

use super::arm::Arm;
use super::assessment::DesignProblem;
use super::measures::Measures;
use crate::workspace::hybrid::{Atlas, Rule};
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

/// Widest margin that is looked at, radians.
pub const WIDEST_MARGIN: f64 = FRAC_PI_6;

/// What is left of S_F at the margin that a robot is rated by.
const LEFT: f64 = 0.9;

/// Halvings of the interval in which the tenth is lost: to 0.01°.
const HALVINGS: usize = 12;

/// Half the interval over which the slope of S_F is taken, radians.
const SLOPE: f64 = 0.01;

impl DesignProblem {
    /// The share of `arm` over `atlas` for several margins (radians) instead of the problem's own.
    pub fn margin_curve(
        &self,
        arm: &Arm,
        atlas: &Atlas,
        limits: &ArtificialLimits,
        margins: &[f64],
    ) -> Vec<AtMargin> {
        let at = |&margin: &f64| {
            let failures = self.failures.clone().with_margin(margin);
            let sizes = atlas.sizes(limits, &failures, Rule::Definition);
            let (reach, task) = (arm.extent.reach, self.task());
            AtMargin {
                margin,
                share: Measures::new(&sizes, arm.length, reach, task).share,
            }
        };
        margins.iter().map(at).collect()
    }

    /// The margin at which a tenth of the S_F without one is lost, radians, on the samples of
    /// `atlas`: 0 where there is nothing to lose, [`WIDEST_MARGIN`] where it lies beyond.
    pub fn margin(&self, atlas: &Atlas, limits: &ArtificialLimits) -> Estimate {
        let at = |margin: f64| self.failures.clone().with_margin(margin);
        let size = |margin: f64| atlas.fault_tolerant_size(limits, &at(margin));
        let wanted = LEFT * size(0.0);
        let exactly = |value| Estimate { value, error: 0.0 };
        if wanted <= 0.0 {
            return exactly(0.0);
        }
        if size(WIDEST_MARGIN) >= wanted {
            return exactly(WIDEST_MARGIN);
        }
        let (mut low, mut high) = (0.0, WIDEST_MARGIN);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match size(middle) < wanted {
                true => high = middle,
                false => low = middle,
            }
        }
        let margin = 0.5 * (low + high);
        // The same samples are lost and kept: what is uncertain is their difference.
        let off = atlas.fault_tolerant_difference(limits, [&at(0.0), &at(margin)], [LEFT, 1.0]);
        let [from, to] = [(margin - SLOPE).max(0.0), margin + SLOPE];
        let slope = (size(from) - size(to)) / (to - from);
        Estimate {
            value: margin,
            error: match slope > 0.0 {
                true => (off.error / slope).min(WIDEST_MARGIN),
                false => WIDEST_MARGIN,
            },
        }
    }
}
