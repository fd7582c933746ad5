//! The robots that move in a plane, reduced to link lengths and angle offsets.

use super::{Convention, Geometry, Joint, JointKind, Robot};
use nalgebra::Isometry3;
use std::f64::consts::{PI, TAU};
use std::fmt;

/// Twists up to this (radians) from a multiple of 2π count as parallel axes: the round-off of
/// 360° written in degrees, not a tilt anyone could build.
const TWIST_TOLERANCE: f64 = 1e-12;

/// A planar chain of revolute joints.
///
/// The world angle of link k is Σ_{j≤k} (θ_j + offset_j), and the tool is at the end of the last
/// link. The tool's orientation may differ from the last link's angle by a constant, which moves
/// no size of any workspace.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanarChain {
    /// Link lengths l, metres, each above 0.
    pub lengths: Vec<f64>,
    /// What is added to each joint variable, radians.
    pub angle_offsets: Vec<f64>,
}

/// Why a robot is not a planar chain of revolute joints.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotPlanar {
    /// The reason as a clause, e.g. "joint 2 is prismatic".
    pub reason: String,
}

impl fmt::Display for NotPlanar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "not a planar chain of revolute joints: {}", self.reason)
    }
}

impl std::error::Error for NotPlanar {}

impl PlanarChain {
    /// Number of joints n.
    pub fn joints(&self) -> usize {
        self.lengths.len()
    }

    /// Sum of the link lengths, metres.
    pub fn total_length(&self) -> f64 {
        self.lengths.iter().sum()
    }
}

impl Robot {
    /// The robot as a planar chain, if it is one.
    ///
    /// Constant offsets along the parallel axes are dropped: they only lift the plane.
    ///
    /// # Errors
    /// A joint is prismatic, an axis is tilted, or a link has no length (in the modified
    /// convention that is always so for the last one, whose tool sits on the last axis), the robot
    /// has a tool of its own, or it comes from a URDF file.
    pub fn planar_chain(&self) -> Result<PlanarChain, NotPlanar> {
        if self.tool != Isometry3::identity() {
            return refuse("it has a tool of its own".into());
        }
        match &self.geometry {
            Geometry::Planar { lengths } => Ok(PlanarChain {
                lengths: lengths.clone(),
                angle_offsets: vec![0.0; lengths.len()],
            }),
            Geometry::Rows { convention, joints } => {
                check_parallel(joints)?;
                let links = signed_links(*convention, joints)?;
                chain(&links, joints)
            }
            Geometry::Frames(_) => refuse("it comes from a URDF file".into()),
        }
    }
}

fn check_parallel(joints: &[Joint]) -> Result<(), NotPlanar> {
    for (number, joint) in (1..).zip(joints) {
        if joint.kind == JointKind::Prismatic {
            return refuse(format!("joint {number} is prismatic"));
        }
        let tilt = joint.link.twist.rem_euclid(TAU);
        if tilt.min(TAU - tilt) > TWIST_TOLERANCE {
            return refuse(format!("the twist of row {number} is not 0"));
        }
    }
    Ok(())
}

/// Signed length of the link that follows each joint.
fn signed_links(convention: Convention, joints: &[Joint]) -> Result<Vec<f64>, NotPlanar> {
    let lengths = joints.iter().map(|joint| joint.link.length);
    match convention {
        Convention::Standard => Ok(lengths.collect()),
        // Row i's length precedes joint i: the first shifts the base, the last joint has none.
        Convention::Modified if joints.first().is_some_and(|j| j.link.length != 0.0) => {
            refuse("the length of row 1 moves joint 1 away from the base".into())
        }
        Convention::Modified => Ok(lengths.skip(1).chain([0.0]).collect()),
    }
}

/// A negative length points backwards: the link turns by π, and the next joint turns back.
fn chain(links: &[f64], joints: &[Joint]) -> Result<PlanarChain, NotPlanar> {
    let mut turned = 0.0;
    let mut angle_offsets = Vec::with_capacity(links.len());
    for (number, (&length, joint)) in (1..).zip(links.iter().zip(joints)) {
        if length == 0.0 {
            return refuse(format!(
                "link {number}, after joint {number}, has no length"
            ));
        }
        let turn = if length < 0.0 { PI } else { 0.0 };
        angle_offsets.push(joint.link.angle + turn - turned);
        turned = turn;
    }
    Ok(PlanarChain {
        lengths: links.iter().map(|length| length.abs()).collect(),
        angle_offsets,
    })
}

fn refuse<T>(reason: String) -> Result<T, NotPlanar> {
    Err(NotPlanar { reason })
}

#[cfg(test)]
mod tests {
    use super::super::Link;
    use super::*;

    fn rows(convention: Convention, lengths: &[f64], twist: f64) -> Robot {
        let joint = |&length: &f64| Joint {
            kind: JointKind::Revolute,
            link: Link {
                twist,
                length,
                offset: 0.1,
                angle: 0.3,
            },
        };
        Robot {
            name: "rows".into(),
            source: None,
            geometry: Geometry::Rows {
                convention,
                joints: lengths.iter().map(joint).collect(),
            },
            tool: Isometry3::identity(),
            physical_limits: None,
        }
    }

    #[test]
    fn negative_lengths_turn_the_link_round() {
        let chain = rows(Convention::Standard, &[1.0, -2.0, 3.0], TAU)
            .planar_chain()
            .unwrap();
        assert_eq!(chain.lengths, [1.0, 2.0, 3.0]);
        assert_eq!(chain.angle_offsets, [0.3, 0.3 + PI, 0.3 - PI]);
        assert_eq!((chain.joints(), chain.total_length()), (3, 6.0));
    }

    #[test]
    fn tilted_and_zero_links_are_refused_with_a_reason() {
        let reason = |robot: Robot| robot.planar_chain().unwrap_err().reason;
        let tilted = rows(Convention::Standard, &[1.0, 1.0], PI);
        assert!(reason(tilted).contains("twist of row 1"));
        let zero = rows(Convention::Standard, &[1.0, 0.0], 0.0);
        assert!(reason(zero).contains("link 2"));
        let modified = rows(Convention::Modified, &[0.0, 1.0], 0.0);
        assert!(reason(modified).contains("link 2"));
        let shifted = rows(Convention::Modified, &[1.0, 1.0], 0.0);
        assert!(reason(shifted).contains("row 1"));
    }
}
