//! What a search has found of one task point's pre-image, and when it is enough.

use super::correct::correct;
use super::curve::{Curve, CurveStatus, wrapped};
use super::prober::Prober;
use super::seeds::{Seed, Seeder};
use super::solver::SearchSettings;
use super::trace::trace;
use crate::kinematics::{Goal, Lanes, NewtonStep};
use rand_chacha::ChaCha8Rng;

/// Manifolds with a singular end after which a search stops: the task point then has a pre-image
/// that is no set of curves, and every start would add another.
const MOST_SINGULAR: usize = 16;

/// Distance within which a solution lies on a known curve, internal radians.
const ON_CURVE: f64 = 2e-3;

/// The curves of one task point, with storage for those of the next.
#[derive(Clone, Debug)]
pub(crate) struct Findings<const N: usize> {
    /// The curves found; only the first `found` are of this task point.
    curves: Vec<Curve<N>>,
    hits: Vec<usize>,
    found: usize,
    /// Starts made.
    pub seeds: usize,
    /// Starts that found the task.
    pub landed: usize,
    /// Vertices traced, known curves included.
    vertices: usize,
    /// Whether the search ended because it had traced too many.
    gave_up: bool,
    /// Whether all joints turn.
    revolute: bool,
}

impl<const N: usize> Findings<N> {
    pub fn new() -> Findings<N> {
        Findings {
            curves: Vec::new(),
            hits: Vec::new(),
            found: 0,
            seeds: 0,
            landed: 0,
            vertices: 0,
            gave_up: false,
            revolute: true,
        }
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
    pub async fn search<const M: usize>(
        &mut self,
        prober: &impl Prober<N, M>,
        goal: &Goal<f64>,
        settings: &SearchSettings,
        rng: &mut ChaCha8Rng,
    ) {
        let kernel = prober.kernel();
        self.revolute = (0..N).all(|joint| kernel.is_revolute(joint));
        self.found = 0;
        self.landed = 0;
        self.seeds = 0;
        self.vertices = 0;
        self.gave_up = false;
        let lanes: Goal<Lanes> = goal.splat();
        let mut seeder = Seeder::new(kernel, rng);
        let mut landed: Vec<[f64; N]> = Vec::with_capacity(8);
        while !self.is_done(settings) {
            landed.clear();
            seeder.next(kernel, &lanes, rng, |seed| {
                if let Seed::Found(point) = seed {
                    landed.push(point);
                }
            });
            self.seeds = seeder.tried;
            for seed in &landed {
                self.landed += 1;
                // Newton steps fail only next to singular configurations.
                let corrected = correct(prober, seed).await;
                if !self.recognise(seed, corrected.as_ref()) {
                    let start = corrected.map_or(*seed, |(point, _)| point);
                    self.trace(prober, &wrapped(&start), settings).await;
                }
                self.gave_up = self.vertices >= settings.most_vertices;
                if self.gave_up {
                    return;
                }
            }
        }
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
        self.revolute && self.curves().iter().all(closed) && self.winding_sum() != [0; N]
    }

    /// Sum of the winding vectors of all closed curves, which run along the cofactor field.
    pub fn winding_sum(&self) -> [i32; N] {
        std::array::from_fn(|k| self.curves().iter().map(|curve| curve.winding[k]).sum())
    }

    /// Whether every curve closed smoothly (or ends at a stroke) and the winding vectors sum to
    /// zero, and the search was not cut short.
    pub fn is_sound(&self) -> bool {
        self.curves().iter().all(Curve::is_smooth) && !self.is_unbalanced() && !self.gave_up
    }

    /// Counts `seed` for the curve it lies on, if that is known already.
    fn recognise(
        &mut self,
        seed: &[f64; N],
        corrected: Option<&([f64; N], NewtonStep<N>)>,
    ) -> bool {
        let (point, tangent, near) = match corrected {
            Some((point, newton)) => (point, Some(&newton.tangent), ON_CURVE),
            None => (seed, None, 5.0 * ON_CURVE),
        };
        let located = |curve: &Curve<N>| curve.locate(point, tangent, near).is_some();
        let index = self.curves().iter().position(located);
        if let Some(index) = index {
            self.hits[index] += 1;
        }
        index.is_some()
    }

    /// Traces the curve through `start`.
    async fn trace<const M: usize>(
        &mut self,
        prober: &impl Prober<N, M>,
        start: &[f64; N],
        settings: &SearchSettings,
    ) {
        if self.curves.len() == self.found {
            self.curves.push(Curve::new());
            self.hits.push(0);
        }
        let (old, new) = self.curves.split_at_mut(self.found);
        let curve = &mut new[0];
        trace(prober, start, &settings.trace, curve).await;
        self.vertices += curve.points.len();
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
