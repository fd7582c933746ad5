//! A robot as constant transforms between motions about or along z: the form in which all kinds
//! of robots are alike.

use super::forward::{row, row_parts};
use crate::design::{Convention, FrameChain, Geometry, JointKind, Robot};
use nalgebra::{Isometry3, Quaternion, Translation3, Unit, UnitQuaternion, Vector3};

/// The n + 1 constant transforms C of T(θ) = C₀ · M₁(θ₁) · C₁ · M₂(θ₂) ⋯ M_n(θ_n) · C_n, where M_i
/// turns about z by θ_i (revolute) or slides along z by θ_i (prismatic), see [`joint_motion`].
///
/// Offsets of rows, the tip and the tool are part of them. Lengths in metres.
pub fn fixed_transforms(robot: &Robot) -> Vec<Isometry3<f64>> {
    let mut fixed = match &robot.geometry {
        Geometry::Frames(chain) => of_frames(chain),
        Geometry::Rows {
            convention: Convention::Modified,
            ..
        } => of_modified_rows(robot),
        _ => of_standard_rows(robot),
    };
    if let Some(last) = fixed.last_mut() {
        *last *= robot.tool;
    }
    fixed
}

/// M(θ): a turn by `variable` (radians) about z, or a slide by `variable` (metres) along z.
pub fn joint_motion(kind: JointKind, variable: f64) -> Isometry3<f64> {
    match kind {
        JointKind::Revolute => Isometry3::rotation(Vector3::z() * variable),
        JointKind::Prismatic => Translation3::new(0.0, 0.0, variable).into(),
    }
}

/// The joint variable's motion comes first in a row.
fn of_standard_rows(robot: &Robot) -> Vec<Isometry3<f64>> {
    let link = |joint| {
        let [about_z, about_x] = row_parts(&row(robot, joint));
        about_z * about_x
    };
    let links = (0..robot.joints()).map(link);
    std::iter::once(Isometry3::identity())
        .chain(links)
        .collect()
}

/// Between two variables lie the end of one row and the beginning of the next.
fn of_modified_rows(robot: &Robot) -> Vec<Isometry3<f64>> {
    let mut fixed = Vec::with_capacity(robot.joints() + 1);
    let mut before = Isometry3::identity();
    for joint in 0..robot.joints() {
        let [about_z, about_x] = row_parts(&row(robot, joint));
        fixed.push(before * about_x);
        before = about_z;
    }
    fixed.push(before);
    fixed
}

/// A turn that takes z to the joint's axis goes before its motion, and back after it.
fn of_frames(chain: &FrameChain) -> Vec<Isometry3<f64>> {
    let mut fixed = Vec::with_capacity(chain.joints.len() + 1);
    let mut back = UnitQuaternion::identity();
    for joint in &chain.joints {
        let turn = from_z(&joint.axis);
        fixed.push(back * joint.origin * turn);
        back = turn.inverse();
    }
    fixed.push(back * chain.tip);
    fixed
}

/// A rotation that takes z to `axis`, exact also next to −z, where the shortest turn has no plane.
fn from_z(axis: &Unit<Vector3<f64>>) -> UnitQuaternion<f64> {
    if axis.z < 0.0 {
        let half_turn = UnitQuaternion::from_quaternion(Quaternion::new(0.0, 1.0, 0.0, 0.0));
        return from_z(&-*axis) * half_turn;
    }
    UnitQuaternion::from_quaternion(Quaternion::new(1.0 + axis.z, -axis.y, axis.x, 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn z_is_taken_to_any_axis() {
        for axis in [
            Vector3::z(),
            -Vector3::z(),
            Vector3::x(),
            Vector3::new(1e-9, 0.0, -1.0),
            Vector3::new(-0.3, 0.5, 0.2),
        ] {
            let axis = Unit::new_normalize(axis);
            assert!((from_z(&axis) * Vector3::z() - *axis).norm() < 1e-15);
        }
        assert_eq!(from_z(&Vector3::z_axis()), UnitQuaternion::identity());
    }
}
