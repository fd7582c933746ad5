//! The canonical form of a serial chain, which the fast kernels evaluate.
//!
//! Every chain of joints about or along arbitrary axes is a product
//!
//! T(θ) = B · ∏ᵢ [ R_z(θᵢ + φᵢ) · T_z(σᵢ θᵢ) · T(pᵢ) · R_x(αᵢ) ] · E
//!
//! with constant base B and end E: the rotation between two axes is split into Euler angles
//! z-x-z, and the two rotations about z commute with the joints they touch. Unlike
//! Denavit–Hartenberg rows, whose common normal runs away when axes are nearly parallel, all
//! constants stay as small as the robot's links.

use super::fixed_transforms;
use crate::design::{JointKind, Robot};
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use std::f64::consts::PI;

/// A serial chain in canonical form.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Where joint 1's axis stands: B.
    pub base: Isometry3<f64>,
    /// The joints, joint 1 first.
    pub joints: Vec<ChainJoint>,
    /// From the last canonical frame to the tool: E.
    pub end: Isometry3<f64>,
}

/// One joint of a [`Chain`] with the link behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainJoint {
    /// φ: angle of the joint about z at joint variable 0, radians.
    pub offset: f64,
    /// Turn per unit of the joint variable: 1 for revolute, 0 for prismatic joints.
    pub turn: f64,
    /// σ: slide along z per unit of the joint variable, metres; 0 for revolute joints.
    pub slide: f64,
    /// p: the link, metres, in the frame that has turned with the joint.
    pub arm: [f64; 3],
    /// cos α and sin α of the twist behind the link.
    pub twist: [f64; 2],
}

/// The variable of a prismatic joint, in internal units: its stroke is half a turn.
///
/// Self-motion manifolds are curves in the space of all joints; with metres and radians mixed,
/// their lengths and steps would have no meaning. A stroke [lower, upper] is therefore mapped to
/// [−π/2, π/2], and sets of its positions are sets of angles like any other joint's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointScale {
    /// Joint variable at internal 0: metres for prismatic joints, 0 for revolute ones.
    pub centre: f64,
    /// Metres per internal radian; 1 for revolute joints.
    pub per_radian: f64,
}

impl JointScale {
    /// A revolute joint: internal and outer variable are the same angle.
    pub const REVOLUTE: JointScale = JointScale {
        centre: 0.0,
        per_radian: 1.0,
    };

    /// A prismatic joint that moves from `lower` to `upper` (metres).
    pub fn stroke(lower: f64, upper: f64) -> JointScale {
        JointScale {
            centre: 0.5 * (lower + upper),
            per_radian: (upper - lower).max(1e-9) / PI,
        }
    }

    /// Internal variable of a joint variable.
    pub fn inner(&self, variable: f64) -> f64 {
        (variable - self.centre) / self.per_radian
    }

    /// Joint variable of an internal one.
    pub fn outer(&self, inner: f64) -> f64 {
        self.centre + inner * self.per_radian
    }
}

/// How each joint's variable is scaled; `None` if a prismatic joint has no physical limits, whose
/// stroke would set the scale.
pub fn joint_scales(robot: &Robot) -> Option<Vec<JointScale>> {
    let scale = |joint: usize| match (robot.joint_kind(joint), &robot.physical_limits) {
        (JointKind::Revolute, _) => Some(JointScale::REVOLUTE),
        (JointKind::Prismatic, Some(limits)) => {
            Some(JointScale::stroke(limits.lower[joint], limits.upper[joint]))
        }
        (JointKind::Prismatic, None) => None,
    };
    (0..robot.joints()).map(scale).collect()
}

impl Chain {
    /// The chain of `robot` in internal joint variables (see [`JointScale`]); `None` if a
    /// prismatic joint has no physical limits.
    pub fn new(robot: &Robot) -> Option<Chain> {
        let scales = joint_scales(robot)?;
        let fixed = fixed_transforms(robot);
        let kinds: Vec<_> = (0..robot.joints()).map(|j| robot.joint_kind(j)).collect();
        Some(Chain::from_transforms(&fixed, &kinds, &scales))
    }

    /// From the n + 1 constant transforms C₀ … C_n around the joints:
    /// T = C₀ M₁ C₁ ⋯ M_n C_n with every M about or along its z axis.
    pub fn from_transforms(
        fixed: &[Isometry3<f64>],
        kinds: &[JointKind],
        scales: &[JointScale],
    ) -> Chain {
        let mut joints = Vec::with_capacity(kinds.len());
        // Rotation about z left over from the link before.
        let mut carried = 0.0;
        for (k, (kind, scale)) in kinds.iter().zip(scales).enumerate() {
            let mut link = fixed[k + 1];
            let (turn, slide) = match kind {
                JointKind::Revolute => (1.0, 0.0),
                JointKind::Prismatic => {
                    link = Translation3::new(0.0, 0.0, scale.centre) * link;
                    (0.0, scale.per_radian)
                }
            };
            let (before, twist, after) = euler_zxz(&link.rotation);
            let arm = about_z(-before) * link.translation.vector;
            joints.push(ChainJoint {
                offset: carried + before,
                turn,
                slide,
                arm: [arm.x, arm.y, arm.z],
                twist,
            });
            carried = after;
        }
        Chain {
            base: fixed[0],
            joints,
            end: Isometry3::from_parts(Translation3::identity(), about_z(carried).into()),
        }
    }

    /// The number of joints n.
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// Whether the chain has no joint.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// The same arm with joint `joint` (from 0) locked at the internal variable `value`.
    ///
    /// The remaining joints keep their order and their variables.
    pub fn locked(&self, joint: usize, value: f64) -> Chain {
        let mut chain = self.clone();
        let lock = chain.joints.remove(joint);
        let motion = lock.motion(value);
        if joint == 0 {
            chain.base *= motion;
            return chain;
        }
        // The joint before now carries both links.
        let before = &mut chain.joints[joint - 1];
        let link = before.link() * motion;
        let (turned, twist, after) = euler_zxz(&link.rotation);
        let arm = about_z(-turned) * link.translation.vector;
        before.offset += turned;
        before.arm = [arm.x, arm.y, arm.z];
        before.twist = twist;
        match chain.joints.get_mut(joint) {
            Some(next) => next.offset += after,
            None => {
                chain.end = Isometry3::from_parts(Translation3::identity(), about_z(after).into())
                    * chain.end
            }
        }
        chain
    }

    /// Pose of the tool for internal joint variables.
    pub fn tool(&self, theta: &[f64]) -> Isometry3<f64> {
        let motions = self.joints.iter().zip(theta);
        let product = motions.fold(self.base, |frame, (joint, &value)| {
            frame * joint.motion(value)
        });
        product * self.end
    }

    /// A typical link length, metres, above 0: the mean over the links that have one.
    pub fn mean_link(&self) -> f64 {
        let lengths = self
            .joints
            .iter()
            .map(|joint| Vector3::from(joint.arm).norm() + 0.5 * PI * joint.slide);
        let (sum, count) = lengths
            .filter(|length| *length > 0.0)
            .fold((0.0, 0.0), |(sum, count), length| {
                (sum + length, count + 1.0)
            });
        if count > 0.0 { sum / count } else { 1.0 }
    }
}

impl ChainJoint {
    /// T(p) R_x(α).
    fn link(&self) -> Isometry3<f64> {
        let twist = self.twist[1].atan2(self.twist[0]);
        Isometry3::from_parts(
            Translation3::from(Vector3::from(self.arm)),
            UnitQuaternion::from_axis_angle(&Vector3::x_axis(), twist),
        )
    }

    /// The joint's motion at the internal variable `value`, with the link behind it.
    pub(super) fn motion(&self, value: f64) -> Isometry3<f64> {
        let turn = about_z(self.offset + self.turn * value);
        let slide = Translation3::new(0.0, 0.0, self.slide * value);
        Isometry3::from_parts(slide, turn.into()) * self.link()
    }
}

fn about_z(angle: f64) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::z_axis(), angle)
}

/// Angles φ, ψ and (cos α, sin α) with R = R_z(φ) R_x(α) R_z(ψ); ψ = 0 where the axes are
/// parallel to working precision and the split is arbitrary.
fn euler_zxz(rotation: &UnitQuaternion<f64>) -> (f64, [f64; 2], f64) {
    let r: Matrix3<f64> = *rotation.to_rotation_matrix().matrix();
    let sine = r[(0, 2)].hypot(r[(1, 2)]);
    if sine < 1e-14 {
        let cosine = r[(2, 2)].signum();
        // R_z(φ) R_x(0 or π): the first column is (cos φ, sin φ, 0) either way.
        return (r[(1, 0)].atan2(r[(0, 0)]), [cosine, 0.0], 0.0);
    }
    let before = r[(0, 2)].atan2(-r[(1, 2)]);
    let after = r[(2, 0)].atan2(r[(2, 1)]);
    let scale = sine.hypot(r[(2, 2)]);
    (before, [r[(2, 2)] / scale, sine / scale], after)
}
