//! All self-motion manifolds of one task point, for robots with one degree of redundancy.

use super::correct::correct;
use super::curve::{Curve, CurveStatus, wrapped};
use super::seeds::{Seed, Seeder};
use super::trace::{TraceSettings, trace};
use crate::kinematics::{Goal, Kernel, Lanes};
use crate::sampling::stream;
use nalgebra::{DMatrix, SMatrix};
use rand::Rng;
use rand_chacha::ChaCha8Rng;

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
            trace: TraceSettings::default(),
        }
    }
}

impl SearchSettings {
    /// For many task points at once: at least 99.5 % of them complete.
    pub fn coarse() -> SearchSettings {
        SearchSettings {
            least_seeds: 32,
            seeds_per_manifold: 8,
            least_hits: 4,
            most_seeds: 300,
            unreachable_after: 32,
            trace: TraceSettings::coarse(),
        }
    }
}

/// Manifolds with a singular end after which a search stops: the task point then has a pre-image
/// that is no set of curves, and every start would add another.
const MOST_SINGULAR: usize = 16;

/// Distance within which a solution lies on a known curve, internal radians.
const ON_CURVE: f64 = 2e-3;

/// The search for one task point, with the storage it needs; reuse it for the next point.
#[derive(Clone, Debug)]
pub(crate) struct Solver<const N: usize, const M: usize> {
    pub kernel: Kernel<N, M>,
    /// The curves found; only the first `found` are of this task point.
    curves: Vec<Curve<N>>,
    hits: Vec<usize>,
    found: usize,
    /// Starts made.
    pub seeds: usize,
    /// Starts that found the task.
    pub landed: usize,
}

impl<const N: usize, const M: usize> Solver<N, M> {
    pub fn new(kernel: Kernel<N, M>) -> Solver<N, M> {
        Solver {
            kernel,
            curves: Vec::new(),
            hits: Vec::new(),
            found: 0,
            seeds: 0,
            landed: 0,
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

    /// The curves of the last task point.
    pub fn curves(&self) -> &[Curve<N>] {
        &self.curves[..self.found]
    }

    /// How often random starts landed on each curve.
    pub fn hits(&self) -> &[usize] {
        &self.hits[..self.found]
    }

    /// Finds all curves of `goal`.
    pub fn solve(&mut self, goal: &Goal<f64>, settings: &SearchSettings, rng: &mut ChaCha8Rng) {
        self.found = 0;
        self.landed = 0;
        self.seeds = 0;
        let lanes: Goal<Lanes> = goal.splat();
        let mut seeder = Seeder::new(&self.kernel, rng);
        let mut landed: Vec<[f64; N]> = Vec::with_capacity(8);
        while !self.is_done(settings) {
            landed.clear();
            seeder.next(&self.kernel, &lanes, rng, |seed| {
                if let Seed::Found(point) = seed {
                    landed.push(point);
                }
            });
            self.seeds = seeder.tried;
            for point in &landed {
                self.landed += 1;
                self.assign(goal, point, settings);
            }
        }
    }

    /// The curve through `theta`, which is first moved onto the pre-image; `None` if Newton steps
    /// do not lead there, as next to singular configurations.
    pub fn trace(
        &self,
        goal: &Goal<f64>,
        theta: &[f64; N],
        settings: &SearchSettings,
    ) -> Option<Curve<N>> {
        let (point, _) = correct(&self.kernel, goal, theta)?;
        let mut curve = Curve::new();
        trace(
            &self.kernel,
            goal,
            &wrapped(&point),
            &settings.trace,
            &mut curve,
        );
        Some(curve)
    }

    fn is_done(&self, settings: &SearchSettings) -> bool {
        if self.seeds >= settings.most_seeds {
            return true;
        }
        if self.landed == 0 {
            return self.seeds >= settings.unreachable_after;
        }
        let singular = |curve: &&Curve<N>| !curve.is_smooth();
        self.seeds >= settings.least_seeds + settings.seeds_per_manifold * self.found
            && self.hits().iter().all(|&hits| hits >= settings.least_hits)
            && !self.is_unbalanced()
            || self.curves().iter().filter(singular).count() >= MOST_SINGULAR
    }

    /// Whether the winding vectors prove that something is missing or wrong. They prove nothing
    /// if curves end at strokes, lie outside them, or run through singular configurations.
    fn is_unbalanced(&self) -> bool {
        let closed = |curve: &Curve<N>| curve.is_smooth() && curve.status == CurveStatus::Closed;
        (0..N).all(|joint| self.kernel.is_revolute(joint))
            && self.curves().iter().all(closed)
            && self.winding_sum() != [0; N]
    }

    /// Sum of the winding vectors of all closed curves, which run along the cofactor field.
    pub fn winding_sum(&self) -> [i32; N] {
        std::array::from_fn(|k| self.curves().iter().map(|curve| curve.winding[k]).sum())
    }

    /// Whether every curve closed smoothly (or ends at a stroke) and the winding vectors sum to
    /// zero.
    pub fn is_sound(&self) -> bool {
        self.curves().iter().all(Curve::is_smooth) && !self.is_unbalanced()
    }

    /// Counts `seed` for the curve it lies on, or traces its own.
    fn assign(&mut self, goal: &Goal<f64>, seed: &[f64; N], settings: &SearchSettings) {
        // Newton steps fail only next to singular configurations.
        let corrected = correct(&self.kernel, goal, seed);
        let near = if corrected.is_some() {
            ON_CURVE
        } else {
            5.0 * ON_CURVE
        };
        let point = corrected.map_or(*seed, |(point, _)| point);
        let tangent = corrected.map(|(_, newton)| newton.tangent);
        let located = |curve: &Curve<N>| curve.locate(&point, tangent.as_ref(), near).is_some();
        if let Some(index) = self.curves().iter().position(located) {
            self.hits[index] += 1;
            return;
        }
        if self.curves.len() == self.found {
            self.curves.push(Curve::new());
            self.hits.push(0);
        }
        let start = wrapped(&point);
        let (old, new) = self.curves.split_at_mut(self.found);
        let curve = &mut new[0];
        trace(&self.kernel, goal, &start, &settings.trace, curve);
        // A point may miss its own curve between two long steps.
        match old.iter().position(|old| is_same(old, curve)) {
            Some(index) => self.hits[index] += 1,
            None => {
                self.hits[self.found] = 1;
                self.found += 1;
            }
        }
    }
}

/// Whether two traces follow the same curve: samples of the new one lie on the old one.
fn is_same<const N: usize>(old: &Curve<N>, new: &Curve<N>) -> bool {
    if old.status != new.status || (old.length - new.length).abs() > 0.01 * old.length + 1e-3 {
        return false;
    }
    let step = new.points.len().div_ceil(8);
    let smooth = old.is_smooth() && new.is_smooth();
    (0..new.points.len()).step_by(step).all(|index| {
        let tangent = smooth.then_some(&new.tangents[index]);
        old.locate(&new.points[index], tangent, 2.0 * ON_CURVE)
            .is_some()
    })
}
