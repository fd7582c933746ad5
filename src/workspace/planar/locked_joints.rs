//! What a planar arm reaches after any one joint locked: W₁ ∩ … ∩ W_n, in closed form.

use super::position::PlanarArm;
use super::post_failure::{LockedJoint1, annulus, radial_gate};
use super::wrist::Wrist;
use crate::angle::AngleSet;
use std::f64::consts::PI;

/// W₁ ∩ … ∩ W_n of the joints that may fail: an annulus, cut by two erosions of arcs.
///
/// A position task has radii and polar angles β. A pose task has the wrist's radius and polar
/// angle β, and the direction γ of the last link against the line to the wrist.
#[derive(Clone, Debug)]
pub struct LockedJoints {
    reach: [f64; 2],
    radii: [f64; 2],
    joint_1: LockedJoint1,
    joint_1_fails: bool,
    joint_n: Option<LockedJoint1>,
    joint_n_fails: bool,
}

impl LockedJoints {
    /// For position tasks.
    pub fn of_position(arm: PlanarArm<'_>) -> LockedJoints {
        let limit = arm.failures.lock_range(arm.limits.joints()[0]);
        LockedJoints {
            reach: annulus(arm.lengths),
            radii: radial_gate(arm.lengths, arm.limits, arm.failures),
            joint_1: LockedJoint1::new(arm.lengths, limit),
            joint_1_fails: arm.failures.contains(1),
            joint_n: None,
            joint_n_fails: false,
        }
    }

    /// For pose tasks of four or five joints.
    pub fn of_pose(arm: PlanarArm<'_>) -> LockedJoints {
        let wrist = Wrist::new(arm);
        let (first, n) = (wrist.limits.joints()[0], arm.lengths.len());
        let [first, last] = [first, wrist.last].map(|limit| arm.failures.lock_range(limit));
        LockedJoints {
            reach: annulus(&wrist.lengths),
            radii: radial_gate(&wrist.lengths, &wrist.limits, &wrist.failures),
            joint_1: LockedJoint1::new(&wrist.lengths, first),
            joint_1_fails: arm.failures.contains(1),
            joint_n: Some(LockedJoint1::new(&wrist.reversed_lengths, last)),
            joint_n_fails: arm.failures.contains(n),
        }
    }

    /// Radii [inner, outer] within reach of the arm without limits, metres.
    pub fn reach(&self) -> [f64; 2] {
        self.reach
    }

    /// Radii [inner, outer] common to W₂ … W_n, metres; empty if inner ≥ outer.
    pub fn radii(&self) -> [f64; 2] {
        self.radii
    }

    /// β that W₁ allows at radius `r` inside [`LockedJoints::radii`].
    pub fn bearings(&self, r: f64) -> AngleSet {
        match self.joint_1_fails {
            true => self.joint_1.rotation_set(r),
            false => AngleSet::full(),
        }
    }

    /// γ that W_n of a pose task allows at wrist radius `r`; the full circle for position tasks.
    pub fn directions(&self, r: f64) -> AngleSet {
        match self.joint_n.filter(|_| self.joint_n_fails) {
            Some(joint_n) => joint_n.rotation_set(r),
            None => AngleSet::full(),
        }
    }

    /// Half-angles [hole, out], radians, of the bearings that links 2 … n reach relative to link 1
    /// at radius `r`, and for pose tasks those seen from joint n; else [0, π].
    pub fn half_angles(&self, r: f64) -> [[f64; 2]; 2] {
        let last = self.joint_n.map_or([0.0, PI], |chain| chain.half_angles(r));
        [self.joint_1.half_angles(r), last]
    }
}
