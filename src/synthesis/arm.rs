//! A robot as it is measured: without the constants that change no size, with its reach and the
//! length of its links.

use super::link_space::{Column, LinkSpace, Links, total_length};
use crate::design::{Convention, Geometry, Robot, TaskSpace};
use crate::kinematics::{Extent, rough_extent, workspace_extent};
use nalgebra::Isometry3;

/// A robot with its proportions.
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    /// The robot.
    pub robot: Robot,
    /// How far it reaches, metres.
    pub extent: Extent,
    /// L = Σ(|a_i| + |d_i|), metres; for a chain of frames the distances between the origins of
    /// successive joints.
    pub length: f64,
}

impl Arm {
    /// The robot of `links` at reach 1, one of many: its extent is a rough one. `None` for a robot
    /// that reaches nothing.
    pub fn of_links(space: &LinkSpace, links: &Links) -> Option<Arm> {
        let robot = space.robot(links, 1.0, "candidate");
        let extent = rough_extent(&robot)?;
        Arm::new(robot, extent, total_length(links))
    }

    /// `robot` without the constants that change no size of `task`: what stands before joint 1,
    /// and for poses what follows the last joint. Then its reach is that of the wrist, and can be
    /// compared with that of other robots.
    pub fn of_robot(robot: &Robot, task: TaskSpace) -> Option<Arm> {
        let mut robot = robot.clone();
        if task == TaskSpace::SpatialPose {
            robot.tool = Isometry3::identity();
        }
        let n = robot.joints();
        let mut length = 0.0;
        match &mut robot.geometry {
            Geometry::Planar { lengths } => length = lengths.iter().sum(),
            Geometry::Rows { convention, joints } => {
                for (row, column) in idle(*convention, n, task) {
                    let link = &mut joints[row].link;
                    match column {
                        Column::Twist => link.twist = 0.0,
                        Column::Length => link.length = 0.0,
                        Column::Offset => link.offset = 0.0,
                    }
                }
                for joint in joints {
                    length += joint.link.length.abs() + joint.link.offset.abs();
                }
            }
            Geometry::Frames(chain) => {
                for joint in chain.joints.iter().skip(1) {
                    length += joint.origin.translation.vector.norm();
                }
                if task == TaskSpace::SpatialPose {
                    chain.tip = Isometry3::identity();
                } else {
                    length += chain.tip.translation.vector.norm();
                }
            }
        }
        let extent = workspace_extent(&robot)?;
        Arm::new(robot, extent, length)
    }

    fn new(robot: Robot, extent: Extent, length: f64) -> Option<Arm> {
        (extent.reach > 0.0 && length > 0.0).then_some(Arm {
            robot,
            extent,
            length,
        })
    }
}

/// Constants that change no size, for either convention. In modified rows a link comes before its
/// joint.
fn idle(convention: Convention, n: usize, task: TaskSpace) -> Vec<(usize, Column)> {
    match convention {
        Convention::Standard => LinkSpace::idle(n, task),
        Convention::Modified => {
            let first = [Column::Twist, Column::Length, Column::Offset];
            let mut idle: Vec<(usize, Column)> = first.map(|column| (0, column)).to_vec();
            if task == TaskSpace::SpatialPose {
                idle.push((n - 1, Column::Offset));
            }
            idle
        }
    }
}
