//! Forward kinematics and the geometric Jacobian in plain matrices, joint by joint.
//!
//! Positions are in units of the reach, so that an error of position and one of orientation weigh
//! alike. Everything is seen from the frame of joint 1.

use crate::design::{JointKind, Robot, TaskSpace};
use crate::kinematics::{fixed_transforms, joint_scales};
use nalgebra::{Isometry3, Matrix3, SVector, Vector3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Most joints of a robot that can be checked: configurations live on the stack.
pub(super) const MOST_JOINTS: usize = 12;

/// A configuration in internal joint variables; entries beyond the last joint are 0.
pub(super) type Angles = [f64; MOST_JOINTS];

/// [low, high] of every joint; infinite for a joint that turns freely.
pub(super) type Bounds = [[f64; 2]; MOST_JOINTS];

/// A joint with the link behind it.
struct Link {
    /// Slide along z at variable 0 and per unit of it; `None` for a revolute joint.
    slide: Option<[f64; 2]>,
    rotation: Matrix3<f64>,
    translation: Vector3<f64>,
}

/// The robot for the check.
pub(super) struct Arm {
    links: Vec<Link>,
    rows: &'static [usize],
    /// Physical limits.
    pub physical: Bounds,
}

/// A task point, positions in units of the reach.
pub(super) struct Goal {
    pub position: Vector3<f64>,
    pub rotation: Matrix3<f64>,
}

/// What is missing to the goal, and what every joint adds to it, M rows each.
pub(super) struct Linear<const M: usize> {
    pub missing: SVector<f64, M>,
    pub columns: [SVector<f64, M>; MOST_JOINTS],
}

/// The rows of (position, rotation) that a task prescribes.
fn rows(task: TaskSpace) -> &'static [usize] {
    match task {
        TaskSpace::PlanarPosition => &[0, 1],
        TaskSpace::PlanarPose => &[0, 1, 5],
        TaskSpace::SpatialPosition => &[0, 1, 2],
        TaskSpace::SpatialPose => &[0, 1, 2, 3, 4, 5],
    }
}

impl Arm {
    /// `None` if there are too many joints or a prismatic one has no physical limits.
    pub fn new(robot: &Robot, task: TaskSpace, reach: f64) -> Option<Arm> {
        let scales = joint_scales(robot)?;
        if scales.len() > MOST_JOINTS {
            return None;
        }
        let fixed = fixed_transforms(robot);
        let link = |(k, behind): (usize, &Isometry3<f64>)| Link {
            slide: (robot.joint_kind(k) == JointKind::Prismatic)
                .then(|| [scales[k].centre / reach, scales[k].per_radian / reach]),
            rotation: *behind.rotation.to_rotation_matrix().matrix(),
            translation: behind.translation.vector / reach,
        };
        Some(Arm {
            links: fixed.iter().skip(1).enumerate().map(link).collect(),
            rows: rows(task),
            physical: physical(robot),
        })
    }

    pub fn joints(&self) -> usize {
        self.links.len()
    }

    pub fn turns(&self, joint: usize) -> bool {
        self.links[joint].slide.is_none()
    }

    /// The way from `theta` to the goal, and the Jacobian.
    pub fn linearise<const M: usize>(&self, theta: &Angles, goal: &Goal) -> Linear<M> {
        let mut axes = [[Vector3::zeros(); 2]; MOST_JOINTS];
        let (mut p, mut r) = (Vector3::zeros(), Matrix3::identity());
        for ((link, &value), place) in self.links.iter().zip(theta).zip(&mut axes) {
            let axis: Vector3<f64> = r.column(2).into();
            *place = [axis, p];
            match link.slide {
                Some([at_zero, each]) => p += axis * (at_zero + each * value),
                None => {
                    let (s, c) = value.sin_cos();
                    let (x, y) = (
                        r.column(0) * c + r.column(1) * s,
                        r.column(1) * c - r.column(0) * s,
                    );
                    r.set_column(0, &x);
                    r.set_column(1, &y);
                }
            }
            p += r * link.translation;
            r *= link.rotation;
        }
        let turn = rotation_vector(&(goal.rotation * r.transpose()));
        let missing = self.pick(goal.position - p, turn);
        let mut columns = [SVector::zeros(); MOST_JOINTS];
        for ((column, link), [axis, origin]) in columns.iter_mut().zip(&self.links).zip(axes) {
            *column = match link.slide {
                Some([_, each]) => self.pick(axis * each, Vector3::zeros()),
                None => self.pick(axis.cross(&(p - origin)), axis),
            };
        }
        Linear { missing, columns }
    }

    fn pick<const M: usize>(&self, linear: Vector3<f64>, angular: Vector3<f64>) -> SVector<f64, M> {
        SVector::from_fn(|row, _| match self.rows[row] {
            k @ 0..=2 => linear[k],
            k => angular[k - 3],
        })
    }

    /// The same configuration with every bounded joint on the turn next to its bounds, clamped.
    pub fn clamp(&self, theta: &mut Angles, bounds: &Bounds) {
        for (joint, (value, [low, high])) in theta.iter_mut().zip(bounds).enumerate() {
            if joint >= self.joints() || *high == f64::INFINITY {
                continue;
            }
            if self.turns(joint) {
                *value += ((0.5 * (low + high) - *value) / TAU).round() * TAU;
            }
            *value = value.clamp(*low, *high);
        }
    }
}

/// Physical limits in internal variables: a stroke is half a turn.
fn physical(robot: &Robot) -> Bounds {
    let mut bounds = [[f64::NEG_INFINITY, f64::INFINITY]; MOST_JOINTS];
    for (joint, bound) in bounds.iter_mut().enumerate().take(robot.joints()) {
        match (robot.joint_kind(joint), &robot.physical_limits) {
            (JointKind::Prismatic, _) => *bound = [-FRAC_PI_2, FRAC_PI_2],
            (JointKind::Revolute, Some(limits)) => {
                let (low, high) = (limits.lower[joint], limits.upper[joint]);
                if high - low < TAU - 1e-9 {
                    *bound = [low, high];
                }
            }
            (JointKind::Revolute, None) => (),
        }
    }
    bounds
}

/// The rotation vector of a rotation matrix, of length at most π.
fn rotation_vector(r: &Matrix3<f64>) -> Vector3<f64> {
    let twice_sine = Vector3::new(
        r[(2, 1)] - r[(1, 2)],
        r[(0, 2)] - r[(2, 0)],
        r[(1, 0)] - r[(0, 1)],
    );
    let sine = 0.5 * twice_sine.norm();
    // At half a turn the axis is lost; that the vector then vanishes costs a start at most.
    let angle = sine.atan2(0.5 * (r.trace() - 1.0));
    if sine < 1e-9 {
        return 0.5 * twice_sine;
    }
    twice_sine * (0.5 * angle / sine)
}
