//! Forward kinematics f(θ): frames of all links for a configuration.
//!
//! Lengths in metres, joint variables in radians (revolute) or metres (prismatic). A row of
//! Denavit–Hartenberg parameters moves the frame by
//! R_z(θ) T_z(d) T_x(a) R_x(α) in the standard and R_x(α) T_x(a) R_z(θ) T_z(d) in the modified
//! convention; the planar shorthand is a standard row with α = d = 0.

use crate::design::{Convention, Geometry, JointKind, Link, Robot};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

/// The base frame (the identity), then the frame after each of the n rows; the last one is the
/// tool's.
///
/// `theta` holds the n joint variables; missing ones count as 0 and further ones are ignored.
pub fn joint_frames(robot: &Robot, theta: &[f64]) -> Vec<Isometry3<f64>> {
    debug_assert_eq!(theta.len(), robot.joints());
    let mut frames = vec![Isometry3::identity()];
    let mut frame = Isometry3::identity();
    for joint in 0..robot.joints() {
        let variable = theta.get(joint).copied().unwrap_or(0.0);
        frame *= row_motion(robot, joint, variable);
        frames.push(frame);
    }
    frames
}

/// The tool's frame.
pub fn tool_frame(robot: &Robot, theta: &[f64]) -> Isometry3<f64> {
    joint_frames(robot, theta).pop().unwrap_or_default()
}

/// An upper bound of the tool's distance from the base, metres: the sum of all links' lengths.
///
/// Infinite if a prismatic joint has no physical limits.
pub fn reach(robot: &Robot) -> f64 {
    let Geometry::Rows { joints, .. } = &robot.geometry else {
        return (0..robot.joints()).map(|k| row(robot, k).length).sum();
    };
    let span = |(index, joint): (usize, &crate::design::Joint)| {
        let offset = match (joint.kind, &robot.physical_limits) {
            (JointKind::Revolute, _) => joint.link.offset.abs(),
            (JointKind::Prismatic, None) => f64::INFINITY,
            (JointKind::Prismatic, Some(limits)) => {
                let ends = [limits.lower[index], limits.upper[index]];
                let far = |end: f64| (joint.link.offset + end).abs();
                far(ends[0]).max(far(ends[1]))
            }
        };
        joint.link.length.hypot(offset)
    };
    joints.iter().enumerate().map(span).sum()
}

/// The n + 1 constant transforms C around the joints: T(θ) = C₀ M₁ C₁ ⋯ M_n C_n, where M turns
/// about or slides along its z axis by the joint variable.
pub fn fixed_transforms(robot: &Robot) -> Vec<Isometry3<f64>> {
    let mut fixed = vec![Isometry3::identity()];
    for joint in 0..robot.joints() {
        let row = row_motion(robot, joint, 0.0);
        if let Geometry::Rows {
            convention: Convention::Modified,
            joints,
        } = &robot.geometry
        {
            let link = joints[joint].link;
            let about_x = Isometry3::from_parts(
                Translation3::new(link.length, 0.0, 0.0),
                UnitQuaternion::from_axis_angle(&Vector3::x_axis(), link.twist),
            );
            fixed[joint] *= about_x;
            fixed.push(about_x.inverse() * row);
        } else {
            fixed.push(row);
        }
    }
    fixed
}

/// The constant part of row `joint` (from 0).
fn row(robot: &Robot, joint: usize) -> Link {
    match &robot.geometry {
        Geometry::Planar { lengths } => Link {
            twist: 0.0,
            length: lengths[joint],
            offset: 0.0,
            angle: 0.0,
        },
        Geometry::Rows { joints, .. } => joints[joint].link,
    }
}

fn row_motion(robot: &Robot, joint: usize, variable: f64) -> Isometry3<f64> {
    let mut link = row(robot, joint);
    match robot.joint_kind(joint) {
        JointKind::Revolute => link.angle += variable,
        JointKind::Prismatic => link.offset += variable,
    }
    let about_z = Isometry3::from_parts(
        Translation3::new(0.0, 0.0, link.offset),
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), link.angle),
    );
    let about_x = Isometry3::from_parts(
        Translation3::new(link.length, 0.0, 0.0),
        UnitQuaternion::from_axis_angle(&Vector3::x_axis(), link.twist),
    );
    match &robot.geometry {
        Geometry::Rows {
            convention: Convention::Modified,
            ..
        } => about_x * about_z,
        _ => about_z * about_x,
    }
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
        assert_eq!(reach(&arm), 1.75);
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
        assert!((reach(&standard) - 1.6).abs() < 1e-15);
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
        assert_eq!(reach(&arm), f64::INFINITY);
        arm.physical_limits = Some(PhysicalLimits {
            lower: vec![-PI, -1.5],
            upper: vec![PI, 0.5],
        });
        assert!((reach(&arm) - 1.2).abs() < 1e-15);
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
