//! Covariance matrix adaptation evolution strategy, CMA-ES (N. Hansen, The CMA Evolution Strategy:
//! A Tutorial, arXiv:1604.00772, 2016), with positive weights alone.
//!
//! Asks for a generation of points and is told their order. It never sees scores, so they may be
//! noisy and may change from one generation to the next, as they do when every generation is
//! measured on fresh samples; and the points it is told may differ from those it asked for, as
//! they do when they are put back into bounds.

use nalgebra::{DMatrix, DVector};
use rand::Rng;
use rand_distr::StandardNormal;
use serde::{Deserialize, Serialize};

/// The state of a search; it goes on after a round trip through serde as if it had not been saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CmaEs {
    mean: Vec<f64>,
    sigma: f64,
    population: usize,
    /// Row by row; symmetric and positive definite.
    covariance: Vec<f64>,
    /// Evolution path of the step size.
    path_sigma: Vec<f64>,
    /// Evolution path of the covariance.
    path_c: Vec<f64>,
    generation: u64,
}

/// Constants of [Hansen 2016, table 1].
struct Constants {
    weights: Vec<f64>,
    mu_eff: f64,
    c_sigma: f64,
    d_sigma: f64,
    c_c: f64,
    c_1: f64,
    c_mu: f64,
    /// Expected length of a standard normal vector.
    chi: f64,
}

impl Constants {
    fn new(dimension: usize, population: usize) -> Constants {
        let n = dimension as f64;
        let parents = (population / 2).max(1);
        let half = (population as f64 + 1.0) / 2.0;
        let raw: Vec<f64> = (1..=parents).map(|k| (half / k as f64).ln()).collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|w| w / sum).collect();
        let mu_eff = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
        let c_sigma = (mu_eff + 2.0) / (n + mu_eff + 5.0);
        let c_1 = 2.0 / ((n + 1.3).powi(2) + mu_eff);
        let c_mu = 2.0 * (mu_eff - 2.0 + 1.0 / mu_eff) / ((n + 2.0).powi(2) + mu_eff);
        Constants {
            d_sigma: 1.0 + 2.0 * (((mu_eff - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma,
            c_c: (4.0 + mu_eff / n) / (n + 4.0 + 2.0 * mu_eff / n),
            c_mu: c_mu.min(1.0 - c_1),
            chi: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
            weights,
            mu_eff,
            c_sigma,
            c_1,
        }
    }
}

impl CmaEs {
    /// Starts at `mean` with steps of standard deviation `sigma` in every coordinate and
    /// `population` ≥ 4 points a generation.
    pub fn new(mean: Vec<f64>, sigma: f64, population: usize) -> CmaEs {
        let n = mean.len();
        CmaEs {
            sigma,
            population: population.max(4),
            covariance: DMatrix::<f64>::identity(n, n).as_slice().to_vec(),
            path_sigma: vec![0.0; n],
            path_c: vec![0.0; n],
            generation: 0,
            mean,
        }
    }

    /// The usual number of points a generation for `dimension` coordinates: 4 + ⌊3 ln n⌋.
    pub fn usual_population(dimension: usize) -> usize {
        4 + (3.0 * (dimension.max(1) as f64).ln()) as usize
    }

    /// The centre of the distribution, the best guess once generations have passed.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Moves the centre; what has been learnt of shape and size of the steps stays.
    pub fn set_mean(&mut self, mean: Vec<f64>) {
        debug_assert_eq!(mean.len(), self.mean.len());
        self.mean = mean;
    }

    /// Overall size of the steps.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Generations told so far.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The points of the next generation.
    pub fn ask(&self, rng: &mut impl Rng) -> Vec<Vec<f64>> {
        let n = self.mean.len();
        let (axes, lengths) = self.axes();
        let mut point = || {
            let z = DVector::from_fn(n, |k, _| lengths[k] * rng.sample::<f64, _>(StandardNormal));
            let step = &axes * z;
            let moved = self.mean.iter().zip(step.iter());
            moved.map(|(m, s)| m + self.sigma * s).collect()
        };
        (0..self.population).map(|_| point()).collect()
    }

    /// Learns from a generation, best point first. Of fewer points than were asked for only the
    /// better half counts all the same.
    pub fn tell(&mut self, best_first: &[&[f64]]) {
        let n = self.mean.len();
        if n == 0 {
            // Nothing to learn: all points are the one there is.
            self.generation += 1;
            return;
        }
        let c = Constants::new(n, self.population);
        let parents: Vec<(f64, DVector<f64>)> = c
            .weights
            .iter()
            .zip(best_first)
            .map(|(w, x)| {
                let step = |k: usize, _| (x[k] - self.mean[k]) / self.sigma;
                (*w, DVector::from_fn(n, step))
            })
            .collect();
        let mut step = DVector::zeros(n);
        for (weight, y) in &parents {
            step.axpy(*weight, y, 1.0);
        }
        for (m, s) in self.mean.iter_mut().zip(step.iter()) {
            *m += self.sigma * s;
        }
        self.generation += 1;
        let steady = self.adapt_size(&c, &step);
        self.adapt_shape(&c, &step, &parents, steady);
    }

    /// Cumulative step-size adaptation; whether the path is short enough to learn a direction.
    fn adapt_size(&mut self, c: &Constants, step: &DVector<f64>) -> bool {
        let (axes, lengths) = self.axes();
        let local = axes.tr_mul(step);
        let whitened = DVector::from_fn(local.len(), |k, _| local[k] / lengths[k]);
        let isotropic = axes * whitened;
        let gain = (c.c_sigma * (2.0 - c.c_sigma) * c.mu_eff).sqrt();
        for (p, s) in self.path_sigma.iter_mut().zip(isotropic.iter()) {
            *p = (1.0 - c.c_sigma) * *p + gain * s;
        }
        let length = self.path_sigma.iter().map(|p| p * p).sum::<f64>().sqrt();
        let change = c.c_sigma / c.d_sigma * (length / c.chi - 1.0);
        self.sigma *= change.min(1.0).exp();
        let settled = 1.0 - (1.0 - c.c_sigma).powi(2 * self.generation.min(1000) as i32);
        let n = self.mean.len() as f64;
        length / settled.sqrt() < (1.4 + 2.0 / (n + 1.0)) * c.chi
    }

    /// Rank-one and rank-μ update of the covariance.
    fn adapt_shape(
        &mut self,
        c: &Constants,
        step: &DVector<f64>,
        parents: &[(f64, DVector<f64>)],
        steady: bool,
    ) {
        let n = self.mean.len();
        let gain = match steady {
            true => (c.c_c * (2.0 - c.c_c) * c.mu_eff).sqrt(),
            false => 0.0,
        };
        for (p, s) in self.path_c.iter_mut().zip(step.iter()) {
            *p = (1.0 - c.c_c) * *p + gain * s;
        }
        let lost = if steady { 0.0 } else { c.c_c * (2.0 - c.c_c) };
        let kept = 1.0 - c.c_1 - c.c_mu + c.c_1 * lost;
        let path = DVector::from_column_slice(&self.path_c);
        let mut covariance = DMatrix::from_row_slice(n, n, &self.covariance) * kept;
        covariance.ger(c.c_1, &path, &path, 1.0);
        for (weight, y) in parents {
            covariance.ger(c.c_mu * weight, y, y, 1.0);
        }
        // Symmetric to the last bit, so that its rows may serve as columns.
        let symmetric = 0.5 * (&covariance + covariance.transpose());
        self.covariance = symmetric.as_slice().to_vec();
    }

    /// Principal axes of the covariance as columns, and the standard deviations along them.
    fn axes(&self) -> (DMatrix<f64>, Vec<f64>) {
        let n = self.mean.len();
        if n == 0 {
            return (DMatrix::zeros(0, 0), Vec::new());
        }
        let eigen = DMatrix::from_row_slice(n, n, &self.covariance).symmetric_eigen();
        // Directions in which nothing was learnt must not die out altogether.
        let floor = 1e-14 * eigen.eigenvalues.max().max(f64::MIN_POSITIVE);
        let lengths = eigen.eigenvalues.iter().map(|v| v.max(floor).sqrt());
        (eigen.eigenvectors, lengths.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::stream;

    fn minimise(f: impl Fn(&[f64]) -> f64, start: Vec<f64>, generations: u64) -> CmaEs {
        let population = CmaEs::usual_population(start.len());
        let mut search = CmaEs::new(start, 0.5, population);
        for generation in 0..generations {
            let points = search.ask(&mut stream(1, generation));
            let mut order: Vec<&[f64]> = points.iter().map(Vec::as_slice).collect();
            order.sort_by(|a, b| f(a).total_cmp(&f(b)));
            search.tell(&order);
        }
        search
    }

    /// An ellipsoid a thousand times longer than wide, turned: only a search that learns the
    /// covariance gets to the bottom in so few generations.
    #[test]
    fn a_long_valley_is_learnt() {
        let valley = |x: &[f64]| {
            let sum: f64 = x.iter().sum::<f64>();
            let square: f64 = x.iter().map(|v| v * v).sum();
            1e6 * (square - sum * sum / x.len() as f64) + sum * sum
        };
        let found = minimise(valley, vec![1.0, 2.0, -1.0, 0.5, 1.0], 350);
        assert!(valley(found.mean()) < 1e-9, "{}", valley(found.mean()));
    }

    /// Rosenbrock's function in four dimensions: a bent valley.
    #[test]
    fn a_bent_valley_is_followed() {
        let banana = |x: &[f64]| {
            let pair = |w: &[f64]| 100.0 * (w[1] - w[0] * w[0]).powi(2) + (1.0 - w[0]).powi(2);
            x.windows(2).map(pair).sum::<f64>()
        };
        let found = minimise(banana, vec![-0.5; 4], 500);
        assert!(banana(found.mean()) < 1e-8);
    }

    /// A single coordinate, and none at all: a space of one point.
    #[test]
    fn few_coordinates() {
        let found = minimise(|x| (x[0] - 2.0).powi(2), vec![0.0], 100);
        assert!((found.mean()[0] - 2.0).abs() < 1e-6);
        let found = minimise(|_| 0.0, Vec::new(), 3);
        assert_eq!((found.generation(), found.mean()), (3, &[][..]));
        assert_eq!(found.ask(&mut stream(1, 0)), vec![Vec::<f64>::new(); 4]);
    }

    #[test]
    fn a_saved_search_goes_on_as_if_nothing_had_happened() {
        let sphere = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>();
        let half = minimise(sphere, vec![3.0; 3], 10);
        let bytes = postcard::to_stdvec(&half).unwrap();
        let loaded: CmaEs = postcard::from_bytes(&bytes).unwrap();
        assert_eq!(loaded, half);
        assert_eq!(loaded.ask(&mut stream(1, 10)), half.ask(&mut stream(1, 10)));
    }
}
