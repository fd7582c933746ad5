//! The failure experiment of [S1 §IV.D]: a joint locks on the way to a goal, and the others try to
//! reach it.
//!
//! The robot moves from its start straight in joint space to a goal configuration. At a number of
//! points on the way each joint that may fail locks where it stands; the goal is then reached if
//! inverse kinematics with the other joints finds it inside the physical limits. Whether a
//! solution exists at all is known beforehand: the locked angle must belong to the joint's range
//! Θ_i over all self-motion manifolds of the goal. Both answers are given and compared. Where the
//! goal is out of reach, the nearest pose is the one with the right orientation whose position is
//! least off, as in [S1 Fig. 8].

use super::location::{Location, LocationSearch, apart};
use super::stratum::Arm;
use crate::angle::{AngleSet, Arc, turn};
use crate::design::TaskSpace;
use crate::kinematics::Chain;
use crate::manifold::SelfMotionManifold;
use crate::sampling::stream;
use nalgebra::{DMatrix, DVector, Isometry3};
use rand::Rng;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// How locks are tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FailureSettings {
    /// Points on the way at which joints lock, both ends among them; at least 2.
    pub locks: usize,
    /// Random starts of inverse kinematics after the informed ones.
    pub random_starts: usize,
}

impl Default for FailureSettings {
    fn default() -> FailureSettings {
        FailureSettings {
            locks: 25,
            random_starts: 6,
        }
    }
}

/// One lock.
#[derive(Clone, Debug, PartialEq)]
pub struct Lock {
    /// The joint, from 0.
    pub joint: usize,
    /// Share of the way at which it locked, 0 to 1.
    pub share: f64,
    /// Its variable there, internal.
    pub angle: f64,
    /// Whether the angle belongs to the joint's range over the goal's manifolds.
    pub exists: bool,
    /// Whether inverse kinematics reached the goal.
    pub reached: bool,
    /// Distance from the goal, metres, of the nearest pose found.
    pub position_error: f64,
    /// Its difference in orientation, radians; 0 for tasks without one.
    pub orientation_error: f64,
    /// The difference in position, metres: reached minus wanted.
    pub offset: [f64; 3],
    /// The configuration of that pose, n internal joint variables.
    pub theta: Vec<f64>,
}

/// What the locks of one joint come to.
#[derive(Clone, Debug, PartialEq)]
pub struct JointOutcome {
    /// The joint, from 0.
    pub joint: usize,
    /// Locks tried, and locks after which the goal was reached.
    pub tried: usize,
    /// See `tried`.
    pub reached: usize,
    /// Share of the angles the joint sweeps on its way that belong to its range: exact. 1 or 0 for
    /// a joint that does not move.
    pub share: f64,
    /// Worst errors over the locks, metres and radians.
    pub worst_position_error: f64,
    /// See `worst_position_error`.
    pub worst_orientation_error: f64,
}

/// The experiment with one goal.
#[derive(Clone, Debug, PartialEq)]
pub struct FailureExperiment {
    /// The goal with all its manifolds.
    pub location: Location,
    /// All locks: joints in order, each along the way.
    pub locks: Vec<Lock>,
    /// Per joint that may fail.
    pub joints: Vec<JointOutcome>,
}

/// A goal counts as reached within this, metres and radians.
pub const REACHED: f64 = 1e-6;
/// Slack of the joint ranges, radians: above the error of traced ends.
const SLACK: f64 = 2e-6;
/// Iterations of inverse kinematics.
const STEPS: usize = 80;
/// Weight of an orientation error where the goal is out of reach.
const ORIENTATION_FIRST: f64 = 300.0;

impl FailureExperiment {
    /// Runs the experiment from the configuration `start` to `goal` (n internal joint variables
    /// each) with locks of the joints `failing` (from 0).
    pub fn run(
        search: &LocationSearch,
        (start, goal): (&[f64], &[f64]),
        failing: &[usize],
        settings: &FailureSettings,
        seed: u64,
    ) -> FailureExperiment {
        let mut own = search.clone();
        let tool = search.arm().chain.tool(goal);
        let known = known_singularity(&search.arm(), goal);
        let location = own.explore(&tool, &known, &mut stream(seed, 0));
        let tries: Vec<(usize, usize)> = failing
            .iter()
            .flat_map(|&joint| (0..settings.locks).map(move |k| (joint, k)))
            .collect();
        let trial = |&(joint, k): &(usize, usize)| {
            let share = k as f64 / (settings.locks.max(2) - 1) as f64;
            let way = start.iter().zip(goal);
            let theta: Vec<f64> = way.map(|(a, b)| a + share * (b - a)).collect();
            let item = 1 + (joint * settings.locks + k) as u64;
            let trial = Trial {
                search,
                location: &location,
                joint,
                theta,
                settings,
            };
            trial.run(share, seed, item)
        };
        let locks: Vec<Lock> = tries.par_iter().map(trial).collect();
        let outcome = |&joint: &usize| {
            let range = &location.ranges[joint];
            outcome(joint, &locks, swept(start[joint], goal[joint], range))
        };
        let joints = failing.iter().map(outcome).collect();
        FailureExperiment {
            joints,
            locks,
            location,
        }
    }

    /// Share of all locks after which the goal was reached.
    pub fn success(&self) -> f64 {
        let reached = self.locks.iter().filter(|lock| lock.reached).count();
        reached as f64 / self.locks.len().max(1) as f64
    }
}

fn known_singularity(arm: &Arm, theta: &[f64]) -> Vec<Vec<f64>> {
    let singular = arm.parts(theta).loss(super::SINGULAR) > 0;
    singular.then(|| theta.to_vec()).into_iter().collect()
}

/// Share of the angles between `from` and `to` that belong to `range`.
fn swept(from: f64, to: f64, range: &AngleSet) -> f64 {
    let width = (to - from).abs();
    if width < 1e-9 {
        return f64::from(u8::from(contains(range, from)));
    }
    let arc = Arc::from_interval(from.min(to), from.max(to));
    let wide = range.arcs().iter();
    let wide = wide.map(|a| Arc::new(a.start() - SLACK, a.width() + 2.0 * SLACK));
    AngleSet::from_arcs(wide).overlap(&AngleSet::from(arc)) / width.min(TAU)
}

fn contains(range: &AngleSet, angle: f64) -> bool {
    let mut arcs = range.arcs().iter();
    arcs.any(|arc| arc.contains_within(angle, SLACK))
}

fn outcome(joint: usize, locks: &[Lock], share: f64) -> JointOutcome {
    let own = || locks.iter().filter(|lock| lock.joint == joint);
    let worst = |error: fn(&Lock) -> f64| own().map(error).fold(0.0, f64::max);
    JointOutcome {
        joint,
        tried: own().count(),
        reached: own().filter(|lock| lock.reached).count(),
        share,
        worst_position_error: worst(|lock| lock.position_error),
        worst_orientation_error: worst(|lock| lock.orientation_error),
    }
}

/// One lock while it is tried.
struct Trial<'a> {
    search: &'a LocationSearch,
    location: &'a Location,
    joint: usize,
    theta: Vec<f64>,
    settings: &'a FailureSettings,
}

impl Trial<'_> {
    fn run(&self, share: f64, seed: u64, item: u64) -> Lock {
        let angle = self.theta[self.joint];
        let exists = contains(&self.location.ranges[self.joint], angle);
        let starts = self.starts(seed, item);
        let arm = self.search.arm();
        let ik = Ik {
            arm: &arm,
            tool: &self.location.tool,
            physical: self.search.physical(),
            locked: self.joint,
        };
        // Where no start reaches the goal, the orientation comes first.
        let mut best = None;
        for weight in [1.0, ORIENTATION_FIRST] {
            best = ik.best(&starts, weight);
            if ik.is_reached(&best) {
                break;
            }
        }
        let theta = best.map_or(self.theta.clone(), |(_, theta)| theta);
        let [offset, orientation_error] = ik.errors(&theta);
        let position_error = norm(offset);
        Lock {
            joint: self.joint,
            share,
            angle,
            exists,
            reached: position_error < REACHED && orientation_error[0] < REACHED,
            position_error,
            orientation_error: orientation_error[0],
            offset,
            theta,
        }
    }

    /// Starts of inverse kinematics: where the joint locked, near every manifold of the goal, random.
    fn starts(&self, seed: u64, item: u64) -> Vec<Vec<f64>> {
        let mut starts = vec![self.theta.clone()];
        starts.extend(self.nearest_on_manifolds());
        let mut rng = stream(seed, item);
        for _ in 0..self.settings.random_starts {
            let physical = self.search.physical().iter();
            let draw = physical.map(|arc| arc.start() + arc.width() * rng.random::<f64>());
            let mut theta: Vec<f64> = draw.collect();
            theta[self.joint] = self.theta[self.joint];
            starts.push(theta);
        }
        starts
    }

    /// The configurations of the goal whose locked joint is nearest to where it locked, one for
    /// every manifold, moved to that angle.
    fn nearest_on_manifolds(&self) -> Vec<Vec<f64>> {
        let angle = self.theta[self.joint];
        let gap = |theta: &[f64]| {
            let ahead = turn(angle, theta[self.joint]);
            ahead.min(TAU - ahead)
        };
        let nearest = |manifold: &SelfMotionManifold| {
            let vertices = (0..manifold.vertices()).map(|k| manifold.point(k));
            let mut theta = vertices.min_by(|a, b| gap(a).total_cmp(&gap(b)))?.to_vec();
            theta[self.joint] = angle;
            Some(theta)
        };
        let mut found: Vec<Vec<f64>> = self.location.manifolds.iter().filter_map(nearest).collect();
        // The nearest to the place of the failure first.
        found.sort_by(|a, b| apart(a, &self.theta).total_cmp(&apart(b, &self.theta)));
        found
    }
}

fn norm([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// Inverse kinematics with one joint locked and physical limits.
struct Ik<'a> {
    arm: &'a Arm<'a>,
    tool: &'a Isometry3<f64>,
    physical: &'a [Arc],
    locked: usize,
}

impl Ik<'_> {
    /// Position offset (reached minus wanted, metres) and orientation error (radians, first entry).
    fn errors(&self, theta: &[f64]) -> [[f64; 3]; 2] {
        let reached: &Chain = self.arm.chain;
        let tool = reached.tool(theta);
        let mut p = tool.translation.vector - self.tool.translation.vector;
        if self.arm.task.is_planar() {
            p.z = 0.0;
        }
        let angle = match self.arm.task {
            TaskSpace::PlanarPose | TaskSpace::SpatialPose => {
                tool.rotation.angle_to(&self.tool.rotation)
            }
            _ => 0.0,
        };
        [[p.x, p.y, p.z], [angle, 0.0, 0.0]]
    }

    /// The end with the least error over all starts, the first that reaches the goal.
    fn best(&self, starts: &[Vec<f64>], weight: f64) -> Option<(f64, Vec<f64>)> {
        let mut best: Option<(f64, Vec<f64>)> = None;
        for start in starts {
            let (score, theta) = self.solve(start, weight);
            if best.as_ref().is_none_or(|(least, _)| score < *least) {
                best = Some((score, theta));
            }
            if self.is_reached(&best) {
                break;
            }
        }
        best
    }

    fn is_reached(&self, best: &Option<(f64, Vec<f64>)>) -> bool {
        best.as_ref().is_some_and(|(_, theta)| {
            let [offset, angle] = self.errors(theta);
            norm(offset) < REACHED && angle[0] < REACHED
        })
    }

    /// Levenberg–Marquardt steps, clamped to the limits; the score is the weighted squared error.
    fn solve(&self, start: &[f64], weight: f64) -> (f64, Vec<f64>) {
        let mut theta = start.to_vec();
        let mut damping = 1e-3;
        let mut residual = self.residual(&theta, weight);
        for _ in 0..STEPS {
            let score = residual.norm_squared();
            if score < 1e-22 {
                break;
            }
            let mut jacobian: DMatrix<f64> = self.arm.at(&theta).jacobian();
            for row in 3..jacobian.nrows() {
                jacobian.row_mut(row).scale_mut(weight);
            }
            if self.arm.task == TaskSpace::PlanarPose {
                jacobian.row_mut(2).scale_mut(weight);
            }
            jacobian.column_mut(self.locked).fill(0.0);
            let gram = jacobian.tr_mul(&jacobian);
            let slope = jacobian.tr_mul(&residual);
            let mut done = true;
            for _ in 0..8 {
                let n = theta.len();
                let damped = &gram + DMatrix::identity(n, n) * (damping * gram.trace().max(1e-9));
                let Some(factor) = damped.cholesky() else {
                    break;
                };
                let next = self.clamped(&theta, &factor.solve(&slope));
                let trial = self.residual(&next, weight);
                if trial.norm_squared() < score {
                    done = trial.norm_squared() > score * (1.0 - 1e-7) && score > 1e-12;
                    theta = next;
                    residual = trial;
                    damping = (0.2 * damping).max(1e-12);
                    break;
                }
                damping = (8.0 * damping).min(1e6);
            }
            if done {
                break;
            }
        }
        (residual.norm_squared(), theta)
    }

    fn residual(&self, theta: &[f64], weight: f64) -> DVector<f64> {
        let tool = self.arm.chain.tool(theta);
        let mut difference = self.arm.difference(self.tool, &tool);
        let first = if self.arm.task == TaskSpace::PlanarPose {
            2
        } else {
            3
        };
        for entry in difference.iter_mut().skip(first) {
            *entry *= weight;
        }
        DVector::from_vec(difference)
    }

    /// One step down, at most 0.6 rad a joint, inside the physical limits.
    fn clamped(&self, theta: &[f64], step: &DVector<f64>) -> Vec<f64> {
        let scale = (0.6 / step.amax().max(1e-12)).min(1.0);
        let joint = |k: usize| {
            let value = theta[k] - scale * step[k];
            let arc = &self.physical[k];
            if k == self.locked || arc.is_full() || arc.contains(value) {
                return value;
            }
            let (to_start, to_end) = (turn(value, arc.start()), turn(arc.end(), value));
            if to_start < to_end {
                value + to_start
            } else {
                value - to_end
            }
        };
        (0..theta.len()).map(joint).collect()
    }
}
