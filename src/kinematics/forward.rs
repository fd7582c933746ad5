//! Forward kinematics f(θ): frames of all links for a configuration.
//!
//! Lengths in metres, joint variables in radians (revolute) or metres (prismatic). A row of
//! Denavit–Hartenberg parameters moves the frame by
//! R_z(θ) T_z(d) T_x(a) R_x(α) in the standard and R_x(α) T_x(a) R_z(θ) T_z(d) in the modified
//! convention; the planar shorthand is a standard row with α = d = 0.

use super::fixed::fixed_transforms;
use crate::design::{Convention, FrameJoint, Geometry, JointKind, Link, Robot};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

/// The base frame (the identity), then the frame after each of the n joints and its link (of a
/// URDF chain: after the joint's motion); the last one includes the tip and the tool.
///
/// `theta` holds the n joint variables; missing ones count as 0 and further ones are ignored.
pub fn joint_frames(robot: &Robot, theta: &[f64]) -> Vec<Isometry3<f64>> {
    debug_assert_eq!(theta.len(), robot.joints());
    let mut frames = vec![Isometry3::identity()];
    let mut frame = Isometry3::identity();
    for joint in 0..robot.joints() {
        let variable = theta.get(joint).copied().unwrap_or(0.0);
        frame *= match &robot.geometry {
            Geometry::Frames(chain) => frame_motion(&chain.joints[joint], variable),
            _ => row_motion(robot, joint, variable),
        };
        frames.push(frame);
    }
    if let Some(last) = frames.last_mut() {
        if let Geometry::Frames(chain) = &robot.geometry {
            *last *= chain.tip;
        }
        *last *= robot.tool;
    }
    frames
}

/// The tool's frame.
pub fn tool_frame(robot: &Robot, theta: &[f64]) -> Isometry3<f64> {
    joint_frames(robot, theta).pop().unwrap_or_default()
}

/// An upper bound of the tool's distance from the base, metres: the sum of all links' lengths.
///
/// Infinite if a prismatic joint has no physical limits. See
/// [`workspace_extent`](super::workspace_extent) for the true reach.
pub fn reach_bound(robot: &Robot) -> f64 {
    let fixed = fixed_transforms(robot);
    let span = |(index, link): (usize, &Isometry3<f64>)| {
        let vector = link.translation.vector;
        match (robot.joint_kind(index), &robot.physical_limits) {
            (JointKind::Revolute, _) => vector.norm(),
            (JointKind::Prismatic, None) => f64::INFINITY,
            // The length is convex in the joint variable: an end is the worst case.
            (JointKind::Prismatic, Some(limits)) => {
                let length = |end: f64| (vector + end * Vector3::z()).norm();
                length(limits.lower[index]).max(length(limits.upper[index]))
            }
        }
    };
    let base = fixed.first().map_or(0.0, |c| c.translation.vector.norm());
    base + fixed.iter().skip(1).enumerate().map(span).sum::<f64>()
}

/// The constant part of row `joint` (from 0); a row of zeros for a URDF chain.
pub(super) fn row(robot: &Robot, joint: usize) -> Link {
    let length = match &robot.geometry {
        Geometry::Rows { joints, .. } => return joints[joint].link,
        Geometry::Planar { lengths } => lengths[joint],
        Geometry::Frames(_) => 0.0,
    };
    Link {
        twist: 0.0,
        length,
        offset: 0.0,
        angle: 0.0,
    }
}

/// R_z(angle) T_z(offset) and R_x(twist) T_x(length) of a row.
pub(super) fn row_parts(link: &Link) -> [Isometry3<f64>; 2] {
    let about_z = Isometry3::from_parts(
        Translation3::new(0.0, 0.0, link.offset),
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), link.angle),
    );
    let about_x = Isometry3::from_parts(
        Translation3::new(link.length, 0.0, 0.0),
        UnitQuaternion::from_axis_angle(&Vector3::x_axis(), link.twist),
    );
    [about_z, about_x]
}

fn row_motion(robot: &Robot, joint: usize, variable: f64) -> Isometry3<f64> {
    let mut link = row(robot, joint);
    match robot.joint_kind(joint) {
        JointKind::Revolute => link.angle += variable,
        JointKind::Prismatic => link.offset += variable,
    }
    let [about_z, about_x] = row_parts(&link);
    match &robot.geometry {
        Geometry::Rows {
            convention: Convention::Modified,
            ..
        } => about_x * about_z,
        _ => about_z * about_x,
    }
}

fn frame_motion(joint: &FrameJoint, variable: f64) -> Isometry3<f64> {
    let motion = match joint.kind {
        JointKind::Revolute => Isometry3::rotation(joint.axis.scale(variable)),
        JointKind::Prismatic => Isometry3::from(Translation3::from(joint.axis.scale(variable))),
    };
    joint.origin * motion
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Joint, PhysicalLimits};
    use std::f64::consts::{FRAC_PI_2, PI};

    fn robot(convention: Convention, rows: &[(JointKind, [f64; 4])]) -> Robot {
        let joint = |&(kind, [twist, length, offset, angle]): &(JointKind, [f64; 4])| Joint {
            kind,
            link: Link {
                twist,
                length,
                offset,
                angle,
            },
        };
        Robot {
            name: "rows".into(),
            source: None,
            geometry: Geometry::Rows {
                convention,
                joints: rows.iter().map(joint).collect(),
            },
            tool: Isometry3::identity(),
            physical_limits: None,
        }
    }

    fn assert_at(frame: &Isometry3<f64>, x: f64, y: f64, z: f64) {
        let miss = (frame.translation.vector - Vector3::new(x, y, z)).norm();
        assert!(miss < 1e-14, "{frame:?} is {miss} off ({x}, {y}, {z})");
    }

    #[test]
    fn planar_shorthand_follows_the_textbook() {
        let lengths = vec![1.0, 0.5, 0.25];
        let arm = Robot {
            name: "planar".into(),
            source: None,
            geometry: Geometry::Planar { lengths },
            tool: Isometry3::identity(),
            physical_limits: None,
        };
        let (a, b, c): (f64, f64, f64) = (0.3, 0.3 - 1.1, 0.3 - 1.1 + 2.0);
        let frames = joint_frames(&arm, &[0.3, -1.1, 2.0]);
        assert_eq!(frames.len(), 4);
        assert_at(&frames[1], a.cos(), a.sin(), 0.0);
        let x = a.cos() + 0.5 * b.cos() + 0.25 * c.cos();
        let y = a.sin() + 0.5 * b.sin() + 0.25 * c.sin();
        assert_at(&frames[3], x, y, 0.0);
        assert!((frames[3].rotation.euler_angles().2 - c).abs() < 1e-14);
        assert_eq!(reach_bound(&arm), 1.75);
    }

    /// A base rotation, a shoulder and an elbow, with one closed form for both conventions.
    #[test]
    fn both_conventions_describe_an_articulated_arm() {
        use JointKind::Revolute;
        let standard = robot(
            Convention::Standard,
            &[
                (Revolute, [FRAC_PI_2, 0.0, 0.4, 0.0]),
                (Revolute, [0.0, 0.7, 0.0, 0.0]),
                (Revolute, [0.0, 0.5, 0.0, 0.0]),
            ],
        );
        let modified = robot(
            Convention::Modified,
            &[
                (Revolute, [0.0, 0.0, 0.4, 0.0]),
                (Revolute, [FRAC_PI_2, 0.0, 0.0, 0.0]),
                (Revolute, [0.0, 0.7, 0.0, 0.0]),
            ],
        );
        let (t1, t2, t3) = (0.4f64, -0.9f64, 1.7f64);
        let elbow = 0.7 * t2.cos();
        let out = elbow + 0.5 * (t2 + t3).cos();
        let up = 0.4 + 0.7 * t2.sin() + 0.5 * (t2 + t3).sin();
        let tool = tool_frame(&standard, &[t1, t2, t3]);
        assert_at(&tool, out * t1.cos(), out * t1.sin(), up);
        // The modified rows end at the elbow joint, whose x axis points to the tool.
        let at_elbow = tool_frame(&modified, &[t1, t2, t3]);
        let end = 0.4 + 0.7 * t2.sin();
        assert_at(&at_elbow, elbow * t1.cos(), elbow * t1.sin(), end);
        let tip = at_elbow * Translation3::new(0.5, 0.0, 0.0);
        assert_at(&tip, out * t1.cos(), out * t1.sin(), up);
        assert!((reach_bound(&standard) - 1.6).abs() < 1e-15);
    }

    #[test]
    fn a_prismatic_variable_adds_to_the_offset() {
        use JointKind::{Prismatic, Revolute};
        let mut arm = robot(
            Convention::Standard,
            &[
                (Revolute, [-FRAC_PI_2, 0.0, 0.0, 0.2]),
                (Prismatic, [0.0, 0.0, 0.3, PI]),
            ],
        );
        let tool = tool_frame(&arm, &[0.5, 0.6]);
        assert_at(&tool, -0.9 * 0.7f64.sin(), 0.9 * 0.7f64.cos(), 0.0);
        assert_eq!(reach_bound(&arm), f64::INFINITY);
        arm.physical_limits = Some(PhysicalLimits {
            lower: vec![-PI, -1.5],
            upper: vec![PI, 0.5],
        });
        assert!((reach_bound(&arm) - 1.2).abs() < 1e-15);
    }

    #[test]
    fn planar_chains_agree_with_the_frames() {
        use JointKind::Revolute;
        let arm = robot(
            Convention::Standard,
            &[
                (Revolute, [0.0, 1.0, 0.1, 0.3]),
                (Revolute, [2.0 * PI, -0.8, 0.0, -1.0]),
                (Revolute, [0.0, -0.6, 0.2, 0.0]),
                (Revolute, [0.0, 0.4, 0.0, 2.0]),
            ],
        );
        let chain = arm.planar_chain().unwrap();
        let theta = [0.7, -2.0, 0.1, 1.3];
        let (mut x, mut y, mut angle) = (0.0, 0.0, 0.0f64);
        for (k, joint) in theta.iter().enumerate() {
            angle += joint + chain.angle_offsets[k];
            x += chain.lengths[k] * angle.cos();
            y += chain.lengths[k] * angle.sin();
        }
        let tool = tool_frame(&arm, &theta).translation;
        assert!((tool.x - x).hypot(tool.y - y) < 1e-14);
    }
}
