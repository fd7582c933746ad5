//! A robot arm: a serial chain of revolute and prismatic joints.

use super::{FrameChain, TaskSpace, frames};
use nalgebra::Isometry3;
use serde::{Deserialize, Serialize};

/// A serial robot arm with its origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// Short name, e.g. `planar-3r-equal`.
    pub name: String,
    /// Where the robot comes from: a citation.
    pub source: Option<String>,
    /// Links and joints.
    pub geometry: Geometry,
    /// The tool's frame in the frame after the last link, metres; the identity if the robot has no
    /// tool of its own.
    pub tool: Isometry3<f64>,
    /// Limits that hold before and after a failure, if the robot has any.
    pub physical_limits: Option<PhysicalLimits>,
}

/// How the links follow each other.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// An arm in the plane: revolute joints about z, link k of length l_k along the x axis that
    /// joint k turns.
    Planar {
        /// Link lengths l, metres, each above 0.
        lengths: Vec<f64>,
    },
    /// Rows of Denavit–Hartenberg parameters, base first.
    Rows {
        /// In which order a row's four motions are applied.
        convention: Convention,
        /// One row per joint.
        joints: Vec<Joint>,
    },
    /// Joints with frames and axes of their own, as URDF files have them.
    Frames(FrameChain),
}

/// The order of the four motions of a Denavit–Hartenberg row (rotations R, translations T).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Convention {
    /// R_z(angle) T_z(offset) T_x(length) R_x(twist): the link follows its joint.
    Standard,
    /// R_x(twist) T_x(length) R_z(angle) T_z(offset): the link precedes its joint.
    Modified,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum JointKind {
    /// Turns about its z axis; its variable adds to [`Link::angle`].
    Revolute,
    /// Slides along its z axis; its variable adds to [`Link::offset`].
    Prismatic,
}

/// A joint and the link of its Denavit–Hartenberg row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// How the joint moves.
    pub kind: JointKind,
    /// The constant part of the row.
    pub link: Link,
}

/// The four Denavit–Hartenberg parameters of a row at joint variable 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// Twist α about x, radians.
    pub twist: f64,
    /// Length a along x, metres.
    pub length: f64,
    /// Offset d along z, metres.
    pub offset: f64,
    /// Angle θ about z, radians.
    pub angle: f64,
}

/// Limits of every joint variable, radians for revolute and metres for prismatic joints.
///
/// Limits of a revolute joint that are 2π or more apart do not limit it.
#[derive(Clone, Debug, PartialEq)]
pub struct PhysicalLimits {
    /// Lower limits, joint 1 first.
    pub lower: Vec<f64>,
    /// Upper limits, each at least the lower one.
    pub upper: Vec<f64>,
}

impl Robot {
    /// The number of joints n.
    pub fn joints(&self) -> usize {
        match &self.geometry {
            Geometry::Planar { lengths } => lengths.len(),
            Geometry::Rows { joints, .. } => joints.len(),
            Geometry::Frames(chain) => chain.joints.len(),
        }
    }

    /// How joint number `joint` (from 0) moves.
    pub fn joint_kind(&self, joint: usize) -> JointKind {
        match &self.geometry {
            Geometry::Planar { .. } => JointKind::Revolute,
            Geometry::Rows { joints, .. } => joints[joint].kind,
            Geometry::Frames(chain) => chain.joints[joint].kind,
        }
    }

    /// The degree of redundancy n − m for `task`; negative if the robot has too few joints.
    pub fn degree_of_redundancy(&self, task: TaskSpace) -> isize {
        self.joints() as isize - task.dimension() as isize
    }

    /// The laws of the type: at least one joint, finite numbers, positive planar links, unit axes,
    /// limits in order and one pair per joint.
    ///
    /// # Errors
    /// A sentence that names the broken law.
    pub fn check(&self) -> Result<(), String> {
        if self.joints() == 0 {
            return Err("a robot without joints".into());
        }
        let sound = match &self.geometry {
            Geometry::Planar { lengths } => lengths.iter().all(|l| l.is_finite() && *l > 0.0),
            Geometry::Rows { joints, .. } => joints.iter().all(|joint| joint.link.is_finite()),
            Geometry::Frames(chain) => chain.is_sound(),
        };
        if !sound || !frames::is_finite(&self.tool) {
            return Err("a link that is not finite, or not positive in the plane".into());
        }
        let ordered = |limits: &PhysicalLimits| {
            let pairs = limits.lower.iter().zip(&limits.upper);
            limits.lower.len() == self.joints()
                && limits.upper.len() == self.joints()
                && pairs.into_iter().all(|(lower, upper)| lower <= upper)
        };
        match &self.physical_limits {
            Some(limits) if !ordered(limits) => Err("physical limits out of order".into()),
            _ => Ok(()),
        }
    }
}

impl Link {
    fn is_finite(&self) -> bool {
        [self.twist, self.length, self.offset, self.angle]
            .iter()
            .all(|value| value.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn redundancy_may_be_negative() {
        let robot = Robot {
            name: "r".into(),
            source: None,
            geometry: Geometry::Planar {
                lengths: vec![1.0; 3],
            },
            tool: Isometry3::identity(),
            physical_limits: None,
        };
        assert!(robot.check().is_ok());
        let dor = TaskSpace::ALL.map(|task| robot.degree_of_redundancy(task));
        assert_eq!(dor, [1, 0, 0, -3]);
    }
}
