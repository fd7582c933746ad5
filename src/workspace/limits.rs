//! Artificial joint limits and the joints prone to failure.

use crate::angle::Arc;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Artificial limits [a̲, ā] of one joint, radians, possibly written beyond ±π.
///
/// A width of zero holds the joint still (it may still fail, at that angle); a width of 2π is the
/// full circle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointLimit {
    /// Lower limit a̲, radians.
    pub lower: f64,
    /// Upper limit ā ≥ a̲, radians.
    pub upper: f64,
}

impl JointLimit {
    /// No restriction.
    pub const FREE: JointLimit = JointLimit {
        lower: -std::f64::consts::PI,
        upper: std::f64::consts::PI,
    };

    /// Limits from `lower` to `upper`, radians.
    pub fn new(lower: f64, upper: f64) -> JointLimit {
        debug_assert!(lower <= upper);
        JointLimit { lower, upper }
    }

    /// Limits of the given width around `centre`, radians.
    pub fn around(centre: f64, width: f64) -> JointLimit {
        JointLimit {
            lower: centre - 0.5 * width,
            upper: centre + 0.5 * width,
        }
    }

    /// Width in [0, 2π].
    pub fn width(&self) -> f64 {
        (self.upper - self.lower).clamp(0.0, TAU)
    }

    /// Middle of the interval, not wrapped.
    pub fn centre(&self) -> f64 {
        0.5 * (self.lower + self.upper)
    }

    /// Whether the limits leave the joint the full circle. Widths within 1e-12 rad of 2π count:
    /// 360° does not survive the conversion to radians and back to the last bit.
    pub fn is_full(&self) -> bool {
        self.upper - self.lower >= TAU - 1e-12
    }

    /// The allowed angles.
    pub fn arc(&self) -> Arc {
        if self.is_full() {
            Arc::FULL
        } else {
            Arc::from_interval(self.lower, self.upper)
        }
    }

    /// The same limits shifted by `angle`.
    pub fn shifted(&self, angle: f64) -> JointLimit {
        JointLimit {
            lower: self.lower + angle,
            upper: self.upper + angle,
        }
    }
}

/// Artificial limits A₁ × … × A_n of every joint, which hold before a failure and are released
/// after it [S4 §II.A].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArtificialLimits {
    joints: Vec<JointLimit>,
}

impl ArtificialLimits {
    /// Limits per joint, joint 1 first.
    pub fn new(joints: Vec<JointLimit>) -> ArtificialLimits {
        ArtificialLimits { joints }
    }

    /// Every joint free: the box of S_0max.
    pub fn free(joints: usize) -> ArtificialLimits {
        ArtificialLimits::new(vec![JointLimit::FREE; joints])
    }

    /// From limits in degrees.
    pub fn from_degrees(pairs: &[[f64; 2]]) -> ArtificialLimits {
        let joint = |p: &[f64; 2]| JointLimit::new(p[0].to_radians(), p[1].to_radians());
        ArtificialLimits::new(pairs.iter().map(joint).collect())
    }

    /// Limits of each joint, joint 1 first.
    pub fn joints(&self) -> &[JointLimit] {
        &self.joints
    }

    /// The box C′_A: the same limits with joint 1 released [S4 §III.B].
    pub fn with_joint_1_released(&self) -> ArtificialLimits {
        let mut released = self.clone();
        released.joints[0] = JointLimit::FREE;
        released
    }
}

/// The joints F that may lock, at most one at a time.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FailureSet {
    prone: Vec<bool>,
}

impl FailureSet {
    /// Any single joint of `joints` may fail.
    pub fn any(joints: usize) -> FailureSet {
        FailureSet {
            prone: vec![true; joints],
        }
    }

    /// Only the listed joints may fail; `numbers` count from 1 and lie in 1..=`joints`.
    pub fn of(joints: usize, numbers: &[usize]) -> FailureSet {
        let prone = (1..=joints).map(|j| numbers.contains(&j)).collect();
        FailureSet { prone }
    }

    /// Whether joint number `joint` (from 1) may fail.
    pub fn contains(&self, joint: usize) -> bool {
        self.prone[joint - 1]
    }

    /// The numbers (from 1) of the joints that may fail.
    pub fn numbers(&self) -> impl Iterator<Item = usize> + '_ {
        (1..=self.prone.len()).filter(|&j| self.contains(j))
    }
}
