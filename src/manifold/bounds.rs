//! Physical limits of joints as arcs of internal joint variables.

use crate::angle::Arc;
use crate::design::{JointKind, Robot};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Physical limits of every joint, internal radians: a stroke is half a turn, and limits a full
/// turn or more apart do not limit a revolute joint.
pub fn physical_arcs(robot: &Robot) -> Vec<Arc> {
    let arc = |joint: usize| match (robot.joint_kind(joint), &robot.physical_limits) {
        (JointKind::Prismatic, _) => Arc::from_interval(-FRAC_PI_2, FRAC_PI_2),
        (JointKind::Revolute, Some(limits)) => {
            let width = limits.upper[joint] - limits.lower[joint];
            if width >= TAU - 1e-9 {
                Arc::FULL
            } else {
                Arc::new(limits.lower[joint], width)
            }
        }
        (JointKind::Revolute, None) => Arc::FULL,
    };
    (0..robot.joints()).map(arc).collect()
}
