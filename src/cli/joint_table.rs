//! The table of a robot's joints that `faultspace show` prints.

use crate::design::{Convention, FrameChain, FrameJoint, Geometry, Joint, JointKind, Robot};
use nalgebra::Isometry3;
use std::f64::consts::TAU;
use std::fmt::Write;

/// One line per joint under a header, and the tool if the robot has one.
pub(super) fn joint_table(robot: &Robot) -> String {
    let mut text = match &robot.geometry {
        Geometry::Planar { lengths } => link_table(robot, lengths),
        Geometry::Rows { convention, joints } => row_table(robot, *convention, joints),
        Geometry::Frames(chain) => frame_table(robot, chain),
    };
    if robot.tool != Isometry3::identity() {
        let _ = writeln!(text, "tool   {}", pose(&robot.tool));
    }
    text
}

// Writing to a string cannot fail.

fn link_table(robot: &Robot, lengths: &[f64]) -> String {
    let mut text = format!("joint  kind       length_m{}\n", limit_header(robot));
    for (joint, length) in lengths.iter().enumerate() {
        let (number, limits) = (joint + 1, limits(robot, joint));
        let _ = writeln!(text, "{number:>5}  revolute   {length:>8}{limits}");
    }
    text
}

fn row_table(robot: &Robot, convention: Convention, joints: &[Joint]) -> String {
    let mut text = format!(
        "joint  kind       alpha_deg         a         d  theta_deg{}  ({})\n",
        limit_header(robot),
        convention_name(convention),
    );
    for (index, joint) in joints.iter().enumerate() {
        let link = joint.link;
        let _ = writeln!(
            text,
            "{:>5}  {:<9}  {:>9.3} {:>9.4} {:>9.4}  {:>9.3}{}",
            index + 1,
            kind_name(joint.kind),
            link.twist.to_degrees(),
            link.length,
            link.offset,
            link.angle.to_degrees(),
            limits(robot, index),
        );
    }
    text
}

/// Names, axes and origins, each in the frame of the joint before (or the base).
fn frame_table(robot: &Robot, chain: &FrameChain) -> String {
    let name = |joint: &FrameJoint| joint.name.chars().count();
    let widest = chain.joints.iter().map(name).max().unwrap_or(0).max(4);
    let mut text = format!(
        "joint  {:<widest$}  kind       {:<25}  {:<28}{}\n",
        "name",
        "axis (own frame)",
        "origin_m (frame before)",
        limit_header(robot)
    );
    for (index, joint) in chain.joints.iter().enumerate() {
        let at = joint.origin.translation;
        let _ = writeln!(
            text,
            "{:>5}  {:<widest$}  {:<9}  {}  {}{}",
            index + 1,
            joint.name,
            kind_name(joint.kind),
            triple([joint.axis.x, joint.axis.y, joint.axis.z], 8),
            triple([at.x, at.y, at.z], 9),
            limits(robot, index),
        );
    }
    let _ = writeln!(text, "tip    {}", pose(&chain.tip));
    text
}

fn triple(values: [f64; 3], width: usize) -> String {
    // The sum makes −0 a 0, also one that only rounding makes.
    let shown = values.map(|v| format!("{:>width$.4}", (v * 1e4).round() / 1e4 + 0.0));
    shown.join(" ")
}

fn pose(frame: &Isometry3<f64>) -> String {
    let at = frame.translation;
    let (roll, pitch, yaw) = frame.rotation.euler_angles();
    let angles = [roll, pitch, yaw].map(f64::to_degrees);
    format!(
        "at {} m, roll pitch yaw {} degrees",
        triple([at.x, at.y, at.z], 0),
        triple(angles, 0)
    )
}

fn convention_name(convention: Convention) -> &'static str {
    match convention {
        Convention::Standard => "standard convention",
        Convention::Modified => "modified convention",
    }
}

fn kind_name(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
    }
}

fn limit_header(robot: &Robot) -> &'static str {
    match robot.physical_limits {
        Some(_) => "  physical limits",
        None => "",
    }
}

fn limits(robot: &Robot, joint: usize) -> String {
    let Some(limits) = &robot.physical_limits else {
        return String::new();
    };
    let (lower, upper) = (limits.lower[joint], limits.upper[joint]);
    match robot.joint_kind(joint) {
        JointKind::Revolute if upper - lower >= TAU => "  none".into(),
        JointKind::Revolute => {
            format!("  {:.3}° to {:.3}°", lower.to_degrees(), upper.to_degrees())
        }
        JointKind::Prismatic => format!("  {lower} m to {upper} m"),
    }
}
