//! The wrist chain of a planar pose task.

use super::chain::HELD_WIDTH;
use super::position::PlanarArm;
use crate::workspace::{ArtificialLimits, FailureSet, JointLimit};
use nalgebra::Complex;

/// Angle (radians) by which a joint that holds two equal links folded is opened; it moves sizes by
/// as much, relative to the reach.
const UNFOLDED: f64 = 1e-5;

/// The wrist chain seen from joint 1 and, mirrored, from joint n.
pub(super) struct Wrist {
    pub lengths: Vec<f64>,
    pub limits: ArtificialLimits,
    pub failures: FailureSet,
    pub reversed_lengths: Vec<f64>,
    pub reversed_limits: ArtificialLimits,
    pub last: JointLimit,
}

impl Wrist {
    pub fn new(arm: PlanarArm<'_>) -> Wrist {
        let n = arm.lengths.len();
        debug_assert!((4..=5).contains(&n));
        let lengths = arm.lengths[..n - 1].to_vec();
        let joints = unfolded(arm.lengths, arm.limits.joints());
        let numbers: Vec<usize> = arm.failures.numbers().filter(|&j| j < n).collect();
        let reversed = std::iter::once(joints[n - 1])
            .chain(joints[1..n - 1].iter().rev().copied())
            .collect();
        Wrist {
            reversed_lengths: lengths.iter().rev().copied().collect(),
            lengths,
            limits: ArtificialLimits::new(joints[..n - 1].to_vec()),
            failures: FailureSet::of(n - 1, &numbers).with_margin(arm.failures.margin()),
            reversed_limits: ArtificialLimits::new(reversed),
            last: joints[n - 1],
        }
    }
}

/// The limits with joints of the wrist chain that are held folded on two equal links opened by
/// [`UNFOLDED`]: a rigid link of length zero would leave the chain behind it without a bearing.
fn unfolded(lengths: &[f64], limits: &[JointLimit]) -> Vec<JointLimit> {
    let mut opened = limits.to_vec();
    for j in 1..limits.len() - 1 {
        let limit = limits[j];
        let (a, b) = (lengths[j - 1], lengths[j]);
        let rigid = (a + Complex::from_polar(b, limit.centre())).norm();
        if limit.upper - limit.lower <= HELD_WIDTH && rigid < UNFOLDED * a {
            opened[j] = limit.shifted(UNFOLDED);
        }
    }
    opened
}
