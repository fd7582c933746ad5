//! A robot as it is drawn.

use crate::design::{JointKind, Robot};
use crate::kinematics::{JointPlace, display_posture, joint_places, tool_frame};
use crate::report::{JointMark, SpatialRobotFigure};

/// A robot in space in a posture in which its joints can be told apart.
pub fn spatial_robot(robot: &Robot, title: String) -> SpatialRobotFigure {
    let theta = display_posture(robot);
    let mark = |(joint, place): (usize, JointPlace)| JointMark {
        slides: robot.joint_kind(joint) == JointKind::Prismatic,
        frame: place.frame,
        entry: place.entry,
        foot: place.foot,
    };
    let places = joint_places(robot, &theta);
    SpatialRobotFigure {
        title,
        joints: places.into_iter().enumerate().map(mark).collect(),
        tool: tool_frame(robot, &theta),
    }
}
