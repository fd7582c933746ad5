//! An independent estimate of the fault-tolerant workspace by inverse kinematics with locked joints.
//!
//! Shares nothing with the tracing of manifolds or the hybrid estimator: task points are drawn at
//! random over the whole workspace, every azimuth included, and judged by the definition
//! [S4 eqs. 2–5]. A point belongs to S_0max if inverse kinematics reaches it with all joints free,
//! to W₀ if it does inside the artificial limits, and to W_F if, besides, it does with every joint
//! that may fail locked at every value of a grid over its limits. What random starts fail to find
//! counts as absent: shares are a little too small, the less so the more starts. From 60 to 120
//! starts, no count over 2000 reachable points of the 7R robot of [S4] changed.

mod arm;
mod judge;
mod limits;
mod solve;

use super::{ArtificialLimits, Estimate, FailureSet};
use crate::design::{Robot, TaskSpace};
use crate::kinematics::{Extent, workspace_extent};
use crate::sampling::{rotation, stream};
use arm::{Arm, Goal};
use judge::{Judge, Verdict};
use limits::Prepared;
use nalgebra::{Matrix3, Rotation3, Vector3};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// How the check is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LockedJointCheck {
    /// Reachable task points to judge.
    pub poses: u64,
    /// Largest distance between neighbouring values of a lock, radians.
    pub lock_step: f64,
    /// Random starts that must fail in a row before a configuration is held not to exist.
    pub starts: usize,
    /// By how much locks may lie outside the artificial limits, radians.
    pub margin: f64,
    /// Seed of the task points and of all starts.
    pub seed: u64,
}

impl Default for LockedJointCheck {
    fn default() -> LockedJointCheck {
        LockedJointCheck {
            poses: 3000,
            lock_step: 3f64.to_radians(),
            starts: 60,
            margin: 0.0,
            seed: 1,
        }
    }
}

/// What the check counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LockedJointEstimate {
    /// Task points drawn.
    pub drawn: u64,
    /// Those that are reached with all joints free.
    pub reachable: u64,
    /// Those of W₀.
    pub pre_failure: u64,
    /// Those of W_F.
    pub fault_tolerant: u64,
    /// Size of the region in which they were drawn, in the task's unit.
    pub region: f64,
}

/// Task points drawn between two looks at the number of reachable ones.
const BATCH: u64 = 256;
/// Task points drawn for every one wanted, at most.
const MOST_DRAWN: u64 = 200;
/// Share by which the region exceeds what the robot reaches.
const BORDER: f64 = 1e-3;

impl LockedJointCheck {
    /// Judges random task points. The result depends on the arguments only, not on threads.
    ///
    /// `limits` are in internal joint variables, as everywhere. `watch` is told how many reachable
    /// task points are done, of how many. `None` if `stop` says so, if the robot has more than 12
    /// joints, or if a prismatic joint has no physical limits.
    pub fn run(
        &self,
        robot: &Robot,
        task: TaskSpace,
        limits: &ArtificialLimits,
        failures: &FailureSet,
        watch: &(dyn Fn(u64, u64) + Sync),
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<LockedJointEstimate> {
        let region = Region::new(&workspace_extent(robot)?, task);
        let arm = Arm::new(robot, task, region.reach)?;
        let prepared = Prepared::new(&arm, limits, failures, self.margin);
        let judge = |index: u64| self.judge(&arm, &prepared, &region, index);
        let mut estimate = LockedJointEstimate::empty(region.size());
        while estimate.reachable < self.poses && estimate.drawn < MOST_DRAWN * self.poses {
            let batch = estimate.drawn..estimate.drawn + BATCH;
            let verdicts: Option<Vec<Verdict>> = batch
                .into_par_iter()
                .map(|index| (!stop()).then(|| judge(index)))
                .collect();
            for verdict in verdicts? {
                if estimate.reachable < self.poses {
                    estimate.add(verdict);
                }
            }
            watch(estimate.reachable, self.poses);
        }
        Some(estimate)
    }

    fn judge(&self, arm: &Arm, prepared: &Prepared, region: &Region, index: u64) -> Verdict {
        let mut rng = stream(self.seed, index);
        let Some(goal) = region.draw(&mut rng) else {
            return Verdict::default();
        };
        match region.task.dimension() {
            2 => self.with_rows::<2>(arm, prepared, goal, rng),
            3 => self.with_rows::<3>(arm, prepared, goal, rng),
            _ => self.with_rows::<6>(arm, prepared, goal, rng),
        }
    }

    fn with_rows<const M: usize>(
        &self,
        arm: &Arm,
        prepared: &Prepared,
        goal: Goal,
        rng: ChaCha8Rng,
    ) -> Verdict {
        let mut judge = Judge::<M> {
            arm,
            prepared,
            goal,
            spacing: self.lock_step.max(1e-4),
            starts: self.starts,
            rng,
            solved: Vec::new(),
        };
        judge.verdict()
    }
}

impl LockedJointEstimate {
    fn empty(region: f64) -> LockedJointEstimate {
        LockedJointEstimate {
            drawn: 0,
            reachable: 0,
            pre_failure: 0,
            fault_tolerant: 0,
            region,
        }
    }

    fn add(&mut self, verdict: Verdict) {
        self.drawn += 1;
        self.reachable += u64::from(verdict.is_reachable);
        self.pre_failure += u64::from(verdict.is_inside);
        self.fault_tolerant += u64::from(verdict.is_tolerant);
    }

    /// S_F / S_0max with its standard error.
    pub fn fault_tolerant_share(&self) -> Estimate {
        share(self.fault_tolerant, self.reachable)
    }

    /// Size of W₀ as a share of S_0max, with its standard error.
    pub fn pre_failure_share(&self) -> Estimate {
        share(self.pre_failure, self.reachable)
    }

    /// S_F with its standard error, in the task's unit.
    pub fn fault_tolerant_size(&self) -> Estimate {
        self.size(self.fault_tolerant)
    }

    /// S_0max with its standard error, in the task's unit.
    pub fn unrestricted_size(&self) -> Estimate {
        self.size(self.reachable)
    }

    fn size(&self, count: u64) -> Estimate {
        let share = share(count, self.drawn);
        Estimate {
            value: share.value * self.region,
            error: share.error * self.region,
        }
    }
}

/// A share and its binomial standard error, which is above 0 even if nothing or all was counted:
/// it is taken at (count + ½) / (of + 1).
fn share(count: u64, of: u64) -> Estimate {
    if of == 0 {
        return Estimate::default();
    }
    let (count, of) = (count as f64, of as f64);
    let near = (count + 0.5) / (of + 1.0);
    Estimate {
        value: count / of,
        error: (near * (1.0 - near) / of).sqrt(),
    }
}

/// Where task points are drawn: a cylinder about joint 1's axis, in units of the reach.
struct Region {
    task: TaskSpace,
    /// Metres.
    reach: f64,
    radius: f64,
    lower: f64,
    upper: f64,
}

impl Region {
    fn new(extent: &Extent, task: TaskSpace) -> Region {
        let reach = extent.reach.max(1e-12);
        Region {
            task,
            reach,
            radius: extent.radius / reach + BORDER,
            lower: extent.lower / reach - BORDER,
            upper: extent.upper / reach + BORDER,
        }
    }

    /// Volume of positions times that of orientations (2π in the plane, π² in space).
    fn size(&self) -> f64 {
        let radius = self.radius * self.reach;
        let disc = PI * radius * radius;
        let height = (self.upper - self.lower) * self.reach;
        match self.task {
            TaskSpace::PlanarPosition => disc,
            TaskSpace::PlanarPose => disc * TAU,
            TaskSpace::SpatialPosition => disc * height,
            TaskSpace::SpatialPose => disc * height * PI * PI,
        }
    }

    /// A uniform task point; `None` where the robot cannot reach whatever the orientation.
    fn draw(&self, rng: &mut impl Rng) -> Option<Goal> {
        let u: [f64; 6] = std::array::from_fn(|_| rng.random());
        let (sin, cos) = (TAU * u[0]).sin_cos();
        let r = self.radius * u[1].sqrt();
        let z = match self.task.is_planar() {
            true => 0.0,
            false => self.lower + (self.upper - self.lower) * u[2],
        };
        let position = Vector3::new(r * cos, r * sin, z);
        let rotation = match self.task {
            TaskSpace::SpatialPose => *rotation([u[3], u[4], u[5]]).to_rotation_matrix().matrix(),
            TaskSpace::PlanarPose => {
                *Rotation3::from_axis_angle(&Vector3::z_axis(), TAU * u[3]).matrix()
            }
            _ => Matrix3::identity(),
        };
        (position.norm() < 1.0 + BORDER).then_some(Goal { position, rotation })
    }
}
