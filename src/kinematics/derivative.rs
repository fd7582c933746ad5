//! The Jacobian of a configuration and its derivatives in closed form, for any chain and task.
//!
//! With z_i the axis of joint i, and p_i the vector from its origin to the tool, column i of J is
//! (z_i × p_i, z_i) for a revolute and (σ_i z_i, 0) for a prismatic joint that slides σ_i metres
//! per unit of its variable. Its derivative with respect to θ_k is [S1 eq. 14]
//!
//! | column i | joint k | k < i | k ≥ i |
//! |--|--|--|--|
//! | revolute | revolute | (z_k × (z_i × p_i), z_k × z_i) | (z_i × (z_k × p_k), 0) |
//! | revolute | prismatic | 0 | (σ_k z_i × z_k, 0) |
//! | prismatic | revolute | (σ_i z_k × z_i, 0) | 0 |
//! | prismatic | prismatic | 0 | 0 |
//!
//! The paper prints p_k in place of p_i in the last term of the case k < i.
//!
//! Rows are metres of position and radians of orientation in the base frame, columns internal
//! joint variables (see [`super::JointScale`]). This file is for whoever needs J itself; the
//! inner loop of tracing has [`super::Kernel`].

use super::Chain;
use crate::design::TaskSpace;
use nalgebra::{DMatrix, Vector3};

/// Axes and levers of a chain in one configuration.
#[derive(Clone, Debug)]
pub struct Differential {
    task: TaskSpace,
    joints: Vec<JointAxis>,
}

#[derive(Clone, Copy, Debug)]
struct JointAxis {
    /// z: the axis.
    axis: Vector3<f64>,
    /// p: from the joint's origin to the tool, metres.
    lever: Vector3<f64>,
    /// Radians of turn and metres of slide per unit of the joint's variable.
    turn: f64,
    slide: f64,
}

/// A velocity: metres and radians per unit of a joint variable.
type Twist = (Vector3<f64>, Vector3<f64>);

impl Differential {
    /// At the configuration `theta`, n internal joint variables.
    pub fn new(chain: &Chain, task: TaskSpace, theta: &[f64]) -> Differential {
        let mut frame = chain.base;
        let mut joints = Vec::with_capacity(chain.len());
        for (joint, &value) in chain.joints.iter().zip(theta) {
            joints.push(JointAxis {
                axis: frame.rotation * Vector3::z(),
                lever: frame.translation.vector,
                turn: joint.turn,
                slide: joint.slide,
            });
            frame *= joint.motion(value);
        }
        let tool = (frame * chain.end).translation.vector;
        for joint in &mut joints {
            joint.lever = tool - joint.lever;
        }
        Differential { task, joints }
    }

    /// The number of joints n.
    pub fn joints(&self) -> usize {
        self.joints.len()
    }

    /// J, m × n: metres and radians per unit of each joint variable.
    pub fn jacobian(&self) -> DMatrix<f64> {
        let column = |joint: &JointAxis| {
            let swing = joint.axis.cross(&joint.lever);
            (
                swing * joint.turn + joint.axis * joint.slide,
                joint.axis * joint.turn,
            )
        };
        self.matrix(self.joints.iter().map(column))
    }

    /// ∂J/∂θ_k, m × n, for joint `k` (from 0) [S1 eq. 14].
    pub fn derivative(&self, k: usize) -> DMatrix<f64> {
        self.matrix((0..self.joints.len()).map(|i| self.column_derivative(i, k)))
    }

    /// Σ_k v_k ∂J/∂θ_k, m × n: how J changes along the direction `v` (n numbers).
    pub fn along(&self, v: &[f64]) -> DMatrix<f64> {
        let zero = DMatrix::zeros(self.task.dimension(), self.joints.len());
        let moving = v.iter().enumerate().filter(|(_, share)| **share != 0.0);
        moving.fold(zero, |sum, (k, &share)| sum + self.derivative(k) * share)
    }

    fn column_derivative(&self, i: usize, k: usize) -> Twist {
        let (own, other) = (&self.joints[i], &self.joints[k]);
        let (z_i, z_k) = (own.axis, other.axis);
        if k < i {
            let turned = z_k * other.turn;
            let swing = z_i.cross(&own.lever) * own.turn + z_i * own.slide;
            return (turned.cross(&swing), turned.cross(&z_i) * own.turn);
        }
        let shift = z_k.cross(&other.lever) * other.turn + z_k * other.slide;
        (z_i.cross(&shift) * own.turn, Vector3::zeros())
    }

    /// The rows of the task from twists, one per column.
    fn matrix(&self, twists: impl Iterator<Item = Twist>) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(self.task.dimension(), self.joints.len());
        for (column, (v, w)) in twists.enumerate() {
            let rows = match self.task {
                TaskSpace::PlanarPosition => vec![v.x, v.y],
                TaskSpace::PlanarPose => vec![v.x, v.y, w.z],
                TaskSpace::SpatialPosition => vec![v.x, v.y, v.z],
                TaskSpace::SpatialPose => vec![v.x, v.y, v.z, w.x, w.y, w.z],
            };
            matrix.column_mut(column).copy_from_slice(&rows);
        }
        matrix
    }
}
