//! The pre-image of a task point with the evidence that nothing of it is missing.

use super::SearchSettings;
use super::any_solver::AnySolver;
use super::self_motion::{SelfMotionManifold, joint_ranges};
use super::solver::BATCH;
use crate::angle::AngleSet;
use crate::design::{Robot, TaskSpace};
use crate::kinematics::{Chain, ChainJoint, Goal};
use nalgebra::{Isometry3, Vector3};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// How sure it is that a pre-image holds every manifold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Completeness {
    /// Nothing is missing.
    Proved,
    /// Every check passed: winding vectors sum to zero, every curve is closed. The number
    /// estimates the probability that a manifold is missing: (exp(−n/16) + Σ exp(−hᵢ)) / 10 after n
    /// starts that solved the task and hᵢ hits of manifold i.
    Evidence(f64),
    /// A check failed: winding vectors do not sum to zero, a curve did not close or runs through
    /// a singular configuration, or the task point is not finite.
    Unknown,
}

/// All configurations with which the robot holds a task point.
#[derive(Clone, Debug, PartialEq)]
pub struct PreImage {
    /// Number of joints n.
    pub joints: usize,
    /// Its connected components.
    pub manifolds: Vec<SelfMotionManifold>,
    /// How sure it is that there are no others.
    pub completeness: Completeness,
    /// Random starts made.
    pub seeds: usize,
    /// Starts that solved the task.
    pub landed: usize,
}

/// Why a robot and task have no self-motion manifolds that this module can trace.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ManifoldError {
    /// n − m is not what is asked for.
    #[error(
        "{joints} joints for {dimension} task dimensions: a degree of redundancy of {degree}, where {wanted} is needed"
    )]
    Redundancy {
        /// Joints n.
        joints: usize,
        /// Task dimension m.
        dimension: usize,
        /// n − m.
        degree: isize,
        /// What is needed.
        wanted: &'static str,
    },
    /// The arm cannot move its tool in every direction of the task, wherever it stands.
    #[error(
        "the arm moves its tool in {rank} directions only, but {task} has {dimension}: choose a task that the arm can do"
    )]
    Degenerate {
        /// The task.
        task: TaskSpace,
        /// Rank of the Jacobian at random configurations.
        rank: usize,
        /// Task dimension m.
        dimension: usize,
    },
    /// Joint 1 slides, and task points are to be turned about its axis.
    #[error("joint 1 slides: no turn about its axis leaves the self-motion as it is")]
    NoSymmetry,
    /// A prismatic joint has no physical limits.
    #[error("a prismatic joint without physical limits: its self-motion would have no end")]
    Unlimited,
}

/// Finds pre-images of one robot and task with one degree of redundancy.
#[derive(Clone, Debug)]
pub struct PreImageSearch {
    chain: Chain,
    task: TaskSpace,
    solver: AnySolver,
    settings: SearchSettings,
}

impl PreImageSearch {
    /// A search for `robot`, which must have one joint more than `task` has dimensions.
    ///
    /// # Errors
    /// Another degree of redundancy, a prismatic joint without limits, or an arm that cannot do
    /// the task anywhere.
    pub fn new(
        robot: &Robot,
        task: TaskSpace,
        settings: SearchSettings,
    ) -> Result<PreImageSearch, ManifoldError> {
        let chain = Chain::new(robot).ok_or(ManifoldError::Unlimited)?;
        PreImageSearch::from_chain(chain, task, settings)
    }

    /// A search for `chain`, e.g. that of a robot with joints held still ([`Chain::locked`]).
    ///
    /// # Errors
    /// Another degree of redundancy, or an arm that cannot do the task anywhere.
    pub fn from_chain(
        chain: Chain,
        task: TaskSpace,
        settings: SearchSettings,
    ) -> Result<PreImageSearch, ManifoldError> {
        let solver = AnySolver::new(&chain, task).ok_or_else(|| ManifoldError::Redundancy {
            joints: chain.len(),
            dimension: task.dimension(),
            degree: chain.len() as isize - task.dimension() as isize,
            wanted: "1",
        })?;
        let (rank, dimension) = (solver.rank(), task.dimension());
        if rank < dimension {
            return Err(ManifoldError::Degenerate {
                task,
                rank,
                dimension,
            });
        }
        Ok(PreImageSearch {
            chain,
            task,
            solver,
            settings,
        })
    }

    /// The chain whose internal joint variables the manifolds have.
    pub fn chain(&self) -> &Chain {
        &self.chain
    }

    /// The pre-image of the tool pose `tool` (world frame; planar tasks use x, y and the angle
    /// about z, position tasks no rotation).
    pub fn find(&mut self, tool: &Isometry3<f64>, rng: &mut ChaCha8Rng) -> PreImage {
        if let Some(nothing) = self.without_search(tool) {
            return nothing;
        }
        let goal = Goal::new(&self.chain, tool);
        self.solver.solve(&goal, &self.settings, rng);
        self.found()
    }

    /// The pre-images of many tool poses, each with its own random stream: bit for bit what
    /// [`PreImageSearch::find`] gives for each, but faster, because eight searches compute their
    /// Newton steps together.
    pub fn find_all(&mut self, poses: &mut [(Isometry3<f64>, ChaCha8Rng)]) -> Vec<PreImage> {
        let mut images = Vec::with_capacity(poses.len());
        for batch in poses.chunks_mut(BATCH) {
            self.find_batch(batch, &mut images);
        }
        images
    }
}

impl PreImageSearch {
    fn find_batch(
        &mut self,
        poses: &mut [(Isometry3<f64>, ChaCha8Rng)],
        images: &mut Vec<PreImage>,
    ) {
        let known: Vec<Option<PreImage>> = poses
            .iter()
            .map(|(tool, _)| self.without_search(tool))
            .collect();
        let open = poses
            .iter_mut()
            .zip(&known)
            .filter(|(_, known)| known.is_none());
        let jobs = open.map(|((tool, rng), _)| (Goal::new(&self.chain, tool), rng));
        let mut jobs: Vec<_> = jobs.collect();
        self.solver.solve_all(&mut jobs, &self.settings);
        let mut searched = 0..;
        for known in known {
            images.push(known.unwrap_or_else(|| {
                self.solver.turn_to(searched.next().unwrap_or_default());
                self.found()
            }));
        }
    }

    /// The pre-image of a pose that needs no search.
    fn without_search(&self, tool: &Isometry3<f64>) -> Option<PreImage> {
        if is_beyond(&self.chain, self.task, tool) {
            return Some(self.nothing(Completeness::Proved));
        }
        (!is_finite(tool)).then(|| self.nothing(Completeness::Unknown))
    }

    /// The pre-image that the solver has found.
    fn found(&self) -> PreImage {
        let manifolds = self.solver.manifolds();
        let hits: Vec<usize> = manifolds.iter().map(|m| m.hits).collect();
        let (seeds, landed) = self.solver.effort();
        PreImage {
            joints: self.chain.len(),
            completeness: judge(&hits, self.solver.is_sound(), seeds, landed),
            manifolds,
            seeds,
            landed,
        }
    }

    /// The self-motion manifold of the tool pose `tool` through `theta`, n internal joint variables
    /// that hold it nearly; `None` if Newton steps from there do not lead to such a configuration.
    ///
    /// Like every manifold it is followed straight through singular configurations, in the
    /// direction closest to the incoming one [S1 Algorithm 2].
    pub fn trace(&self, tool: &Isometry3<f64>, theta: &[f64]) -> Option<SelfMotionManifold> {
        if !is_finite(tool) {
            return None;
        }
        let goal = Goal::new(&self.chain, tool);
        self.solver.trace(&goal, theta, &self.settings)
    }

    fn nothing(&self, completeness: Completeness) -> PreImage {
        PreImage {
            joints: self.chain.len(),
            manifolds: Vec::new(),
            completeness,
            seeds: 0,
            landed: 0,
        }
    }
}

fn is_finite(tool: &Isometry3<f64>) -> bool {
    let turn = tool.rotation.coords.iter();
    turn.chain(tool.translation.vector.iter())
        .all(|x| x.is_finite())
}

/// Whether the tool would be farther from joint 1 than all links together.
pub(super) fn is_beyond(chain: &Chain, task: TaskSpace, tool: &Isometry3<f64>) -> bool {
    let [x, y, z] = Goal::new(chain, tool).position;
    let height = if task.is_planar() { 0.0 } else { z };
    x.hypot(y).hypot(height) > reach(chain) * (1.0 + 1e-9)
}

/// No configuration brings the tool farther from the origin of joint 1, metres.
fn reach(chain: &Chain) -> f64 {
    let link = |joint: &ChainJoint| Vector3::from(joint.arm).norm() + FRAC_PI_2 * joint.slide;
    let links: f64 = chain.joints.iter().map(link).sum();
    links + chain.end.translation.vector.norm()
}

/// Starts after which the chance of a manifold rarer than all those found drops by e.
const RARE: f64 = 16.0;
/// How many hidden manifolds a pose has to every one that was found. Both constants are fitted to
/// random task points of fourteen arms; tests/completeness.rs measures how well they hold.
const HIDDEN: f64 = 0.1;

fn judge(hits: &[usize], sound: bool, seeds: usize, landed: usize) -> Completeness {
    if !sound {
        return Completeness::Unknown;
    }
    let tries = if hits.is_empty() { seeds } else { landed };
    let rarer = (-(tries as f64) / RARE).exp();
    // Another one as rare as this one would have been missed with this probability.
    let alike: f64 = hits.iter().map(|&hits| (-(hits as f64)).exp()).sum();
    Completeness::Evidence((HIDDEN * (rarer + alike)).min(1.0))
}

fn winding_sum(manifolds: &[SelfMotionManifold]) -> Vec<i32> {
    let joints = manifolds.first().map_or(0, |m| m.joints);
    let sum = |joint: usize| manifolds.iter().map(|m| m.winding[joint]).sum();
    (0..joints).map(sum).collect()
}

impl PreImage {
    /// Θ: per joint the angles it takes over all manifolds.
    pub fn joint_ranges(&self) -> Vec<AngleSet> {
        joint_ranges(self.joints, &self.manifolds)
    }

    /// Sum of the winding vectors over all manifolds: zeros, or something is missing (for robots
    /// of revolute joints at task points that are no singular values).
    pub fn winding_sum(&self) -> Vec<i32> {
        winding_sum(&self.manifolds)
    }
}
