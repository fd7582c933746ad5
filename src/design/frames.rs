//! A chain of joints whose frames and axes are given one by one, as URDF files have them.

use super::JointKind;
use nalgebra::{Isometry3, Unit, Vector3};

/// A serial chain T(θ) = O₁ · M₁(θ₁) · O₂ · M₂(θ₂) ⋯ O_n · M_n(θ_n) · tip, where M_i turns about or
/// slides along the axis of joint i.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameChain {
    /// The joints that move, base first.
    pub joints: Vec<FrameJoint>,
    /// From the frame that the last joint moves to the tip, metres.
    pub tip: Isometry3<f64>,
}

/// A joint of a [`FrameChain`].
#[derive(Clone, Debug, PartialEq)]
pub struct FrameJoint {
    /// The joint's name in its file.
    pub name: String,
    /// How the joint moves.
    pub kind: JointKind,
    /// O: from the frame that the previous joint moves (or the base) to this joint's frame at
    /// joint variable 0, metres.
    pub origin: Isometry3<f64>,
    /// The axis it turns about or slides along, in its own frame.
    pub axis: Unit<Vector3<f64>>,
}

/// Whether all numbers of a transform are finite.
pub(super) fn is_finite(transform: &Isometry3<f64>) -> bool {
    let matrix = transform.to_homogeneous();
    matrix.iter().all(|value| value.is_finite())
}

impl FrameChain {
    /// Whether all numbers are finite and all axes have length 1.
    pub(super) fn is_sound(&self) -> bool {
        let sound =
            |joint: &FrameJoint| is_finite(&joint.origin) && (joint.axis.norm() - 1.0).abs() < 1e-9;
        is_finite(&self.tip) && self.joints.iter().all(sound)
    }
}
