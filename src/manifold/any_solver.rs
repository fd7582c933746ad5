//! Chooses the kernel of the right size, once.
//!
//! With one degree of redundancy the task's dimension fixes the number of joints, so three sizes
//! serve every robot; more redundant robots are cut into slices of these sizes.

use super::curve::Curve;
use super::self_motion::SelfMotionManifold;
use super::solver::{Job, SearchSettings, Solver};
use crate::design::TaskSpace;
use crate::kinematics::{Chain, Goal, Kernel};
use rand_chacha::ChaCha8Rng;

/// A solver for m = 2, 3 or 6 and n = m + 1.
#[derive(Clone, Debug)]
pub(crate) enum AnySolver {
    Two(Box<Solver<3, 2>>),
    Three(Box<Solver<4, 3>>),
    Six(Box<Solver<7, 6>>),
}

macro_rules! each {
    ($any:expr, $solver:ident => $body:expr) => {
        match $any {
            AnySolver::Two($solver) => $body,
            AnySolver::Three($solver) => $body,
            AnySolver::Six($solver) => $body,
        }
    };
}

/// Receives the curves of a task point.
pub(crate) trait CurveVisitor {
    fn visit<const N: usize>(&mut self, curve: &Curve<N>);
}

impl AnySolver {
    /// `None` unless the chain has one joint more than the task has dimensions.
    pub fn new(chain: &Chain, task: TaskSpace) -> Option<AnySolver> {
        Some(match task.dimension() {
            2 => AnySolver::Two(Box::new(Solver::new(Kernel::new(chain, task)?))),
            3 => AnySolver::Three(Box::new(Solver::new(Kernel::new(chain, task)?))),
            _ => AnySolver::Six(Box::new(Solver::new(Kernel::new(chain, task)?))),
        })
    }

    pub fn solve(&mut self, goal: &Goal<f64>, settings: &SearchSettings, rng: &mut ChaCha8Rng) {
        each!(self, solver => solver.solve(goal, settings, rng));
    }

    /// Searches many task points at once; show them with [`AnySolver::turn_to`].
    pub fn solve_all(&mut self, jobs: &mut [Job<'_>], settings: &SearchSettings) {
        each!(self, solver => solver.solve_all(jobs, settings));
    }

    /// Makes task point `index` of those last searched the one that the methods below show.
    pub fn turn_to(&mut self, index: usize) {
        each!(self, solver => solver.turn_to(index));
    }

    /// Number of joints n.
    pub fn joints(&self) -> usize {
        match self {
            AnySolver::Two(_) => 3,
            AnySolver::Three(_) => 4,
            AnySolver::Six(_) => 7,
        }
    }

    /// The manifold through the configuration `theta` (see [`Solver::trace`]).
    pub fn trace(
        &self,
        goal: &Goal<f64>,
        theta: &[f64],
        settings: &SearchSettings,
    ) -> Option<SelfMotionManifold> {
        each!(self, solver => {
            let curve = solver.trace(goal, theta.try_into().ok()?, settings)?;
            Some(SelfMotionManifold::from_curve(&curve, 0))
        })
    }

    /// Rank of the Jacobian at a random configuration; below m, the task is degenerate.
    pub fn rank(&self) -> usize {
        each!(self, solver => solver.rank())
    }

    /// Starts made, and starts that landed.
    pub fn effort(&self) -> (usize, usize) {
        each!(self, solver => (solver.findings().seeds, solver.findings().landed))
    }

    /// Whether every check of the last task point's curves passed.
    pub fn is_sound(&self) -> bool {
        each!(self, solver => solver.findings().is_sound())
    }

    pub fn visit(&self, visitor: &mut impl CurveVisitor) {
        each!(self, solver => solver.findings().curves().iter().for_each(|curve| visitor.visit(curve)));
    }

    pub fn manifolds(&self) -> Vec<SelfMotionManifold> {
        each!(self, solver => {
            let pairs = solver.findings().curves().iter().zip(solver.findings().hits());
            pairs.map(|(curve, &hits)| SelfMotionManifold::from_curve(curve, hits)).collect()
        })
    }
}
