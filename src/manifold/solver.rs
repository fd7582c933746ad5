//! All self-motion manifolds of one task point, for robots with one degree of redundancy.

use super::correct::correct;
use super::curve::{Curve, wrapped};
use super::desk::Desk;
use super::findings::Findings;
use super::prober::{Alone, at_once};
use super::trace::{TraceSettings, trace};
use crate::kinematics::{Goal, Kernel};
use crate::sampling::stream;
use nalgebra::{DMatrix, SMatrix};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::cell::RefCell;

/// How long manifolds are looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchSettings {
    /// Starts that are always made.
    pub least_seeds: usize,
    /// Starts more for every manifold found: where there are many, each is hit less often.
    pub seeds_per_manifold: usize,
    /// Hits every manifold must have before the search ends: one that was found but once or
    /// twice suggests that others were missed.
    pub least_hits: usize,
    /// Starts after which the search ends in any case.
    pub most_seeds: usize,
    /// Starts without any solution after which the task point counts as out of reach.
    pub unreachable_after: usize,
    /// Vertices traced for one task point after which its search ends, incomplete: what keeps
    /// robots whose pre-images are singular throughout from taking hours.
    pub most_vertices: usize,
    /// How curves are traced.
    pub trace: TraceSettings,
}

impl Default for SearchSettings {
    /// For single task points: misses a manifold at one in 10⁴.
    fn default() -> SearchSettings {
        SearchSettings {
            least_seeds: 128,
            seeds_per_manifold: 8,
            least_hits: 6,
            most_seeds: 1000,
            unreachable_after: 128,
            most_vertices: 1_000_000,
            trace: TraceSettings::default(),
        }
    }
}

impl SearchSettings {
    /// For scores that are compared while searching, with half the starts of
    /// [`SearchSettings::coarse`]: more task points are incomplete than with these.
    pub fn sparse() -> SearchSettings {
        SearchSettings {
            least_seeds: 16,
            seeds_per_manifold: 4,
            least_hits: 2,
            unreachable_after: 24,
            ..SearchSettings::coarse()
        }
    }

    /// For many task points at once: at least 99.5 % of them complete.
    pub fn coarse() -> SearchSettings {
        SearchSettings {
            least_seeds: 32,
            seeds_per_manifold: 8,
            least_hits: 4,
            most_seeds: 300,
            unreachable_after: 32,
            most_vertices: 20_000,
            trace: TraceSettings::coarse(),
        }
    }
}

/// Task points that are best searched at once: enough that the searches that end last, without
/// neighbours, hardly count.
pub(crate) const BATCH: usize = 64;

/// A task point to search, with its own random stream.
pub(crate) type Job<'a> = (Goal<f64>, &'a mut ChaCha8Rng);

/// The search for task points, with the storage it needs; reuse it for the next ones.
#[derive(Clone, Debug)]
pub(crate) struct Solver<const N: usize, const M: usize> {
    pub kernel: Kernel<N, M>,
    /// One for every task point of a batch.
    findings: Vec<Findings<N>>,
    /// The one that is looked at.
    current: usize,
}

impl<const N: usize, const M: usize> Solver<N, M> {
    pub fn new(kernel: Kernel<N, M>) -> Solver<N, M> {
        Solver {
            kernel,
            findings: vec![Findings::new()],
            current: 0,
        }
    }

    /// The greatest rank of the Jacobian over a few random configurations: the rank almost
    /// everywhere.
    pub fn rank(&self) -> usize {
        let mut rng = stream(0, 0);
        let goal = Goal {
            position: [0.0; 3],
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        };
        let mut rank = |_| {
            let theta: [f64; N] = std::array::from_fn(|_| rng.random_range(-1.5..1.5));
            let rows = self.kernel.linearise(&theta, &goal).jacobian;
            let jacobian = SMatrix::<f64, M, N>::from_fn(|i, j| rows[i][j]);
            let gram: SMatrix<f64, M, M> = jacobian * jacobian.transpose();
            // Squares of the singular values; their round-off is 1e-16 of the largest.
            let squares = DMatrix::from_fn(M, M, |i, j| gram[(i, j)]).symmetric_eigenvalues();
            let least = 1e-13 * squares.max();
            squares.iter().filter(|&&square| square > least).count()
        };
        (0..4).map(&mut rank).max().unwrap_or(0)
    }

    /// What was found for the last task point.
    pub fn findings(&self) -> &Findings<N> {
        &self.findings[self.current]
    }

    /// Finds all curves of `goal`.
    pub fn solve(&mut self, goal: &Goal<f64>, settings: &SearchSettings, rng: &mut ChaCha8Rng) {
        self.current = 0;
        let prober = Alone {
            kernel: &self.kernel,
            goal,
        };
        at_once(self.findings[0].search(&prober, goal, settings, rng));
    }

    /// The curve through `theta`, which is first moved onto the pre-image; `None` if Newton steps
    /// do not lead there, as next to singular configurations.
    pub fn trace(
        &self,
        goal: &Goal<f64>,
        theta: &[f64; N],
        settings: &SearchSettings,
    ) -> Option<Curve<N>> {
        let prober = Alone {
            kernel: &self.kernel,
            goal,
        };
        let (point, _) = at_once(correct(&prober, theta))?;
        let mut curve = Curve::new();
        at_once(trace(
            &prober,
            &wrapped(&point),
            &settings.trace,
            &mut curve,
        ));
        Some(curve)
    }

    /// Finds all curves of many goals, each with its own random stream, as [`Solver::solve`] would;
    /// see [`Solver::turn_to`].
    pub fn solve_all(&mut self, jobs: &mut [Job<'_>], settings: &SearchSettings) {
        if let [(goal, rng)] = jobs {
            // A single search would wait for no one, but pay for eight.
            return self.solve(goal, settings, rng);
        }
        if self.findings.len() < jobs.len() {
            self.findings.resize_with(jobs.len(), Findings::new);
        }
        let desk = Desk::new(&self.kernel);
        let queue = RefCell::new(jobs.iter_mut().zip(&mut self.findings));
        // A search that has ended makes room for the next one.
        desk.run(async |seat| {
            loop {
                let next = queue.borrow_mut().next();
                let Some(((goal, rng), findings)) = next else {
                    return;
                };
                seat.aim(goal);
                findings.search(&seat, goal, settings, rng).await;
            }
        });
        self.current = 0;
    }

    /// Makes the task point `index` of the last batch the one that is looked at.
    pub fn turn_to(&mut self, index: usize) {
        self.current = index;
    }
}
