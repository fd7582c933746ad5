//! Joints that stand still on every self-motion manifold, told from the Jacobian alone.
//!
//! Joint i can take part in self-motion where row i of a basis of J's null space is not zero. The
//! row is zero exactly where the arm with joint i locked has lost a rank. Joint variables enter J
//! analytically, so a row that is zero at random configurations is zero at all of them. Then the
//! locked arm has no regular configuration at all, and by Sard's theorem it reaches only a set of
//! measure zero: the arm is structurally intolerant of a failure of joint i, whatever its limits.

use crate::design::{Geometry, JointKind, Robot, TaskSpace};
use crate::kinematics::{Chain, Differential, JointScale, joint_scales, reach_bound};
use crate::sampling::stream;
use nalgebra::{DMatrix, DVector};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;
use std::fmt;

/// Configurations drawn for a verdict.
const DRAWS: usize = 300;
/// Regular ones among them without which there is no verdict.
const ENOUGH: usize = 30;
/// Configurations drawn for each offset that is tried as a cure.
const CURE_DRAWS: usize = 60;
/// A configuration is regular if its least singular value exceeds this share of the greatest, with
/// positions in units of the reach.
const REGULAR: f64 = 1e-3;
/// Components below are round-off: about 1e-16 / [`REGULAR`] is to be expected.
const NOTHING: f64 = 1e-9;
/// An offset cures if the joint then has this component in half of the configurations.
const MOVES: f64 = 1e-3;
/// Offsets that are tried, as a share of the sum of all links' lengths.
const OFFSET: f64 = 0.05;

/// How far every joint takes part in the self-motion of random configurations.
#[derive(Clone, Debug, PartialEq)]
pub struct SelfMotionShares {
    /// Number of regular configurations looked at.
    pub configurations: usize,
    /// The largest component of each joint: norm of its row in an orthonormal basis of the null
    /// space of J, between 0 and 1, with prismatic joints in internal variables.
    pub largest: Vec<f64>,
    /// The median component of each joint.
    pub median: Vec<f64>,
}

/// A joint that stands still on every self-motion manifold, with evidence and cure.
#[derive(Clone, Debug, PartialEq)]
pub struct Intolerance {
    /// Numbers (from 1) of all such joints among those that may fail, at least one.
    pub joints: Vec<usize>,
    /// The largest component of any of them (see [`SelfMotionShares::largest`]).
    pub largest_component: f64,
    /// Number of regular configurations looked at.
    pub configurations: usize,
    /// The offset that was tried as a cure, metres.
    pub offset: f64,
    /// What such an offset would let all these joints move by, most effective first; of rows
    /// and URDF chains.
    pub cures: Vec<Cure>,
}

/// A geometric parameter whose change lets a joint take part in self-motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Cure {
    /// Number (from 1) of the row, or of the URDF joint whose origin moves.
    pub joint: usize,
    /// `a` or `d` of a row; `x`, `y` or `z` of a URDF joint's origin.
    pub parameter: &'static str,
    /// Median component of the joint that stood still (of several, of the least) after the change.
    pub component: f64,
}

impl SelfMotionShares {
    /// Of `robot` for `task`, at a few hundred random configurations inside its physical limits.
    ///
    /// `None` without redundancy, or if a prismatic joint has no physical limits.
    pub fn of(robot: &Robot, task: TaskSpace) -> Option<SelfMotionShares> {
        Self::drawn(robot, task, DRAWS)
    }

    fn drawn(robot: &Robot, task: TaskSpace, draws: usize) -> Option<SelfMotionShares> {
        if robot.degree_of_redundancy(task) < 1 {
            return None;
        }
        let chain = Chain::new(robot)?;
        let ranges = ranges(robot)?;
        let reach = reach_bound(robot).max(f64::MIN_POSITIVE);
        let mut rng = stream(0, 0);
        let components = (0..draws).filter_map(|_| {
            let theta = draw(&ranges, &mut rng);
            let mut jacobian = Differential::new(&chain, task, &theta).jacobian();
            let positions = if task.is_planar() { 2 } else { 3 };
            for mut row in jacobian.row_iter_mut().take(positions) {
                row /= reach;
            }
            is_regular(&jacobian).then(|| null_components(&jacobian))
        });
        let components: Vec<Vec<f64>> = components.collect();
        let sorted = (0..robot.joints()).map(|joint| {
            let mut own: Vec<f64> = components.iter().map(|all| all[joint]).collect();
            own.sort_by(f64::total_cmp);
            own
        });
        let sorted: Vec<Vec<f64>> = sorted.collect();
        let at = |own: &Vec<f64>, index: usize| own.get(index).copied().unwrap_or(0.0);
        let count = components.len();
        Some(SelfMotionShares {
            configurations: count,
            largest: sorted.iter().map(|s| at(s, count.max(1) - 1)).collect(),
            median: sorted.iter().map(|s| at(s, count / 2)).collect(),
        })
    }

    /// Numbers (from 1) of the joints that stand still in every configuration; none if too few
    /// configurations were regular to tell.
    pub fn still_joints(&self) -> Vec<usize> {
        if self.configurations < ENOUGH {
            return Vec::new();
        }
        let still = (1..).zip(&self.largest).filter(|(_, c)| **c < NOTHING);
        still.map(|(number, _)| number).collect()
    }
}

impl Intolerance {
    /// The joints of `robot` that may fail, `prone` by their number from 1, and whose failure
    /// leaves a fault-tolerant workspace of size 0 for all limits; `None` if there is none.
    pub fn of(
        robot: &Robot,
        task: TaskSpace,
        prone: impl Fn(usize) -> bool,
    ) -> Option<Intolerance> {
        let shares = SelfMotionShares::of(robot, task)?;
        let mut joints = shares.still_joints();
        joints.retain(|&number| prone(number));
        let components = joints.iter().map(|&number| shares.largest[number - 1]);
        let largest_component = components.reduce(f64::max)?;
        let offset = OFFSET * reach_bound(robot);
        Some(Intolerance {
            largest_component,
            configurations: shares.configurations,
            offset,
            cures: cures(robot, task, &joints, offset),
            joints,
        })
    }
}

/// `structurally intolerant: joint 4`, evidence and cure: one line, no full stop.
impl fmt::Display for Intolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let numbers: Vec<String> = self.joints.iter().map(|j| j.to_string()).collect();
        let (joints, verb) = match self.joints.len() {
            1 => ("joint", "stands"),
            _ => ("joints", "stand"),
        };
        write!(
            f,
            "structurally intolerant: {joints} {} {verb} still in every self-motion (largest \
             component {:.0e} in {} random regular configurations); ",
            numbers.join(" and "),
            self.largest_component,
            self.configurations
        )?;
        if self.cures.is_empty() {
            return f.write_str("no single offset was found that lets it move");
        }
        let names: Vec<String> = self.cures.iter().map(Cure::to_string).collect();
        write!(
            f,
            "an offset of {:.3} m would let it move in {}",
            self.offset,
            names.join(", ")
        )
    }
}

impl fmt::Display for Cure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}_{}", self.parameter, self.joint)
    }
}

/// The ends between which internal joint variables are drawn.
fn ranges(robot: &Robot) -> Option<Vec<[f64; 2]>> {
    let scales = joint_scales(robot)?;
    let range = |(joint, scale): (usize, &JointScale)| match (
        robot.joint_kind(joint),
        &robot.physical_limits,
    ) {
        (JointKind::Revolute, None) => [-PI, PI],
        (_, Some(limits)) => {
            let (lower, upper) = (limits.lower[joint], limits.upper[joint]);
            let free = upper - lower >= 2.0 * PI;
            match robot.joint_kind(joint) {
                JointKind::Revolute if free => [-PI, PI],
                _ => [scale.inner(lower), scale.inner(upper)],
            }
        }
        (JointKind::Prismatic, None) => [0.0, 0.0],
    };
    Some(scales.iter().enumerate().map(range).collect())
}

fn draw(ranges: &[[f64; 2]], rng: &mut ChaCha8Rng) -> Vec<f64> {
    let mut at = |range: &[f64; 2]| range[0] + rng.random::<f64>() * (range[1] - range[0]);
    ranges.iter().map(&mut at).collect()
}

fn is_regular(jacobian: &DMatrix<f64>) -> bool {
    // Squares of the singular values; their round-off is 1e-16 of the greatest.
    let squares = (jacobian * jacobian.transpose()).symmetric_eigenvalues();
    squares.min() > REGULAR * REGULAR * squares.max()
}

/// Norm of each joint's row in an orthonormal basis of the null space, for J of full rank: what is
/// left of the joint's unit vector outside the row space of J.
fn null_components(jacobian: &DMatrix<f64>) -> Vec<f64> {
    let mut basis: Vec<DVector<f64>> = Vec::with_capacity(jacobian.nrows());
    for row in jacobian.row_iter() {
        basis.push(outside(&basis, row.transpose()).normalize());
    }
    let n = jacobian.ncols();
    let unit = |joint| DVector::from_fn(n, |k, _| if k == joint { 1.0 } else { 0.0 });
    (0..n)
        .map(|joint| outside(&basis, unit(joint)).norm())
        .collect()
}

/// The part of `v` that is orthogonal to an orthonormal `basis`.
fn outside(basis: &[DVector<f64>], mut v: DVector<f64>) -> DVector<f64> {
    // Twice is enough for working precision.
    for _ in 0..2 {
        for q in basis {
            let part = q.dot(&v);
            v.axpy(-part, q, 1.0);
        }
    }
    v
}

/// Every single parameter whose growth by `offset` metres lets all of `joints` move.
fn cures(robot: &Robot, task: TaskSpace, joints: &[usize], offset: f64) -> Vec<Cure> {
    let parameters: &[&'static str] = match &robot.geometry {
        Geometry::Planar { .. } => &[],
        Geometry::Rows { .. } => &["a", "d"],
        Geometry::Frames(_) => &["x", "y", "z"],
    };
    let mut cures = Vec::new();
    for joint in 1..=robot.joints() {
        for (index, parameter) in parameters.iter().enumerate() {
            let changed = with_offset(robot, joint - 1, index, offset);
            let Some(shares) = SelfMotionShares::drawn(&changed, task, CURE_DRAWS) else {
                continue;
            };
            let components = joints.iter().map(|&number| shares.median[number - 1]);
            let component = components.fold(f64::INFINITY, f64::min);
            if component > MOVES {
                cures.push(Cure {
                    joint,
                    parameter,
                    component,
                });
            }
        }
    }
    cures.sort_by(|a, b| b.component.total_cmp(&a.component));
    cures
}

/// `robot` with parameter `index` of joint `joint` (both from 0) grown by `offset` metres.
fn with_offset(robot: &Robot, joint: usize, index: usize, offset: f64) -> Robot {
    let mut robot = robot.clone();
    match &mut robot.geometry {
        Geometry::Planar { .. } => {}
        Geometry::Rows { joints, .. } => match index {
            0 => joints[joint].link.length += offset,
            _ => joints[joint].link.offset += offset,
        },
        Geometry::Frames(chain) => {
            chain.joints[joint].origin.translation.vector[index] += offset;
        }
    }
    robot
}
