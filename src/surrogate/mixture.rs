//! Mixture-density networks [S3 §III]: the density of fault-tolerant angles as a mixture of
//! normal distributions, and beside it the probability that there is any.
//!
//! Cells without a fault-tolerant angle contribute nothing to the likelihood [S3 eq. 7], so
//! without the second output a network knows nothing of them.

use super::cell::angle_at_share;
use crate::angle::{AngleSet, wrap};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Angles drawn from every cell's set, one in each of as many equal shares of it.
const DRAWS: usize = 4;

/// Bounds of the logarithm of a component's standard deviation, radians.
const LOG_STD_DEV: [f64; 2] = [-5.0, 2.0];

/// The outputs of a mixture-density network: logit of "the set is not empty", then for the K
/// components the logits of the weights, the means and the logarithms of the standard deviations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MixtureHead {
    /// Number K of components.
    pub components: usize,
    /// Whether components wrap around the circle; else they live on the line from −π to π.
    pub wrapped: bool,
    /// Whether the network learns which sets are empty.
    pub emptiness: bool,
}

/// One mixture.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture {
    /// Probability that the set is not empty.
    pub presence: f64,
    /// Weight, mean and standard deviation (radians) of every component.
    pub components: Vec<[f64; 3]>,
    /// Whether components wrap around the circle.
    pub wrapped: bool,
}

impl MixtureHead {
    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        1 + 3 * self.components
    }

    /// The mixture that a row of outputs stands for.
    pub fn mixture(&self, row: &[f32]) -> Mixture {
        let k = self.components;
        let largest = row[1..=k].iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let raised: Vec<f64> = row[1..=k]
            .iter()
            .map(|&logit| f64::from(logit - largest).exp())
            .collect();
        let total: f64 = raised.iter().sum();
        let component = |j: usize| {
            let mean = f64::from(row[1 + k + j]);
            let log = f64::from(row[1 + 2 * k + j]).clamp(LOG_STD_DEV[0], LOG_STD_DEV[1]);
            let mean = if self.wrapped { wrap(mean) } else { mean };
            [raised[j] / total, mean, log.exp()]
        };
        Mixture {
            presence: match self.emptiness {
                true => logistic(f64::from(row[0])),
                false => 1.0,
            },
            components: (0..k).map(component).collect(),
            wrapped: self.wrapped,
        }
    }

    /// Negative log-likelihood of a set [S3 eqs. 7, 8], by angles drawn from it, plus the
    /// cross-entropy of its being empty or not. Adds the derivatives by the outputs to `by_row`.
    pub fn loss(
        &self,
        row: &[f32],
        set: &AngleSet,
        generator: &mut ChaCha8Rng,
        by_row: &mut [f32],
    ) -> f64 {
        let present = set.measure() > 0.0;
        let mut loss = 0.0;
        if self.emptiness {
            let (value, by_logit) = cross_entropy(f64::from(row[0]), present);
            by_row[0] += by_logit as f32;
            loss += value;
        }
        if !present {
            return loss;
        }
        let mixture = self.mixture(row);
        for draw in 0..DRAWS {
            let share = (draw as f64 + generator.random::<f64>()) / DRAWS as f64;
            if let Some(angle) = angle_at_share(set, share) {
                loss += self.likelihood(row, &mixture, angle, by_row) / DRAWS as f64;
            }
        }
        loss
    }

    /// −log p(angle), by log-sum-exp.
    fn likelihood(&self, row: &[f32], mixture: &Mixture, angle: f64, by_row: &mut [f32]) -> f64 {
        let k = self.components;
        let mut terms = Vec::with_capacity(3 * k);
        for (j, &[weight, mean, std_dev]) in mixture.components.iter().enumerate() {
            for turn in mixture.turns() {
                let z = (angle + turn - mean) / std_dev;
                let log = weight.max(1e-300).ln() - std_dev.ln() - 0.5 * z * z;
                terms.push((j, log, z));
            }
        }
        let largest = terms.iter().map(|t| t.1).fold(f64::NEG_INFINITY, f64::max);
        let total: f64 = terms.iter().map(|t| (t.1 - largest).exp()).sum();
        let scale = 1.0 / DRAWS as f64;
        for (j, &[weight, _, _]) in mixture.components.iter().enumerate() {
            by_row[1 + j] += (scale * weight) as f32;
        }
        for &(j, log, z) in &terms {
            let share = scale * (log - largest).exp() / total;
            let std_dev = mixture.components[j][2];
            by_row[1 + j] -= share as f32;
            by_row[1 + k + j] -= (share * z / std_dev) as f32;
            let raw = f64::from(row[1 + 2 * k + j]);
            let by_log = share * (1.0 - z * z);
            // At its bound the deviation may only move back inside.
            let outside =
                (raw <= LOG_STD_DEV[0] && by_log > 0.0) || (raw >= LOG_STD_DEV[1] && by_log < 0.0);
            if !outside {
                by_row[1 + 2 * k + j] += by_log as f32;
            }
        }
        0.5 * TAU.ln() - largest - total.ln()
    }
}

impl Mixture {
    fn turns(&self) -> &'static [f64] {
        match self.wrapped {
            true => &[-TAU, 0.0, TAU],
            false => &[0.0],
        }
    }

    /// Density at an angle in [−π, π], per radian.
    pub fn density(&self, angle: f64) -> f64 {
        let mut density = 0.0;
        for &[weight, mean, std_dev] in &self.components {
            for turn in self.turns() {
                let z = (angle + turn - mean) / std_dev;
                density += weight / (std_dev * TAU.sqrt()) * (-0.5 * z * z).exp();
            }
        }
        density
    }

    /// Random angles in [−π, π) [S3 eq. 5]; without wrapping, draws beyond ±π are drawn again, at
    /// most 16 times.
    pub fn draw(&self, count: usize, generator: &mut ChaCha8Rng) -> Vec<f64> {
        let mut angles = Vec::with_capacity(count);
        for _ in 0..count {
            let mut tries = 0;
            let angle = loop {
                let angle = self.draw_one(generator);
                tries += 1;
                if self.wrapped || angle.abs() <= PI || tries == 16 {
                    break angle;
                }
            };
            angles.push(wrap(angle));
        }
        angles
    }

    fn draw_one(&self, generator: &mut ChaCha8Rng) -> f64 {
        let mut rest = generator.random::<f64>();
        let last = self.components.len() - 1;
        for (j, &[weight, mean, std_dev]) in self.components.iter().enumerate() {
            if rest < weight || j == last {
                return mean + std_dev * normal(generator);
            }
            rest -= weight;
        }
        0.0
    }
}

/// A standard normal number (Box & Muller 1958).
fn normal(generator: &mut ChaCha8Rng) -> f64 {
    let radius = (-2.0 * (1.0 - generator.random::<f64>()).ln()).sqrt();
    radius * (TAU * generator.random::<f64>()).cos()
}

/// 1/(1 + e^−x).
pub(super) fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

/// Cross-entropy of a logit and its derivative, stable for any logit.
pub(super) fn cross_entropy(logit: f64, truth: bool) -> (f64, f64) {
    let target = if truth { 1.0 } else { 0.0 };
    let value = logit.max(0.0) - logit * target + (-logit.abs()).exp().ln_1p();
    (value, logistic(logit) - target)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angle::Arc;
    use crate::sampling::stream;

    fn heads() -> [MixtureHead; 2] {
        [true, false].map(|wrapped| MixtureHead {
            components: 3,
            wrapped,
            emptiness: true,
        })
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let set = AngleSet::from_arcs([Arc::new(-2.0, 0.7), Arc::new(2.8, 0.9)]);
        for head in heads() {
            let mut generator = stream(5, 0);
            let row: Vec<f32> = (0..head.outputs())
                .map(|_| generator.random_range(-1.0..1.0))
                .collect();
            let value = |row: &[f32]| {
                let mut ignored = vec![0.0; row.len()];
                head.loss(row, &set, &mut stream(6, 0), &mut ignored)
            };
            let mut by_row = vec![0.0; row.len()];
            head.loss(&row, &set, &mut stream(6, 0), &mut by_row);
            for k in 0..row.len() {
                let mut moved = row.clone();
                moved[k] += 1e-2;
                let up = value(&moved);
                moved[k] -= 2e-2;
                let difference = (up - value(&moved)) / 2e-2;
                let error = (difference - f64::from(by_row[k])).abs();
                assert!(error < 3e-3 * (1.0 + difference.abs()), "{k}: {error}");
            }
        }
    }

    #[test]
    fn a_wrapped_density_has_measure_one_and_no_seam() {
        let [head, _] = heads();
        let row: Vec<f32> = (0..head.outputs()).map(|k| (k as f32).sin()).collect();
        let mixture = head.mixture(&row);
        let steps = 4000;
        let at = |k: usize| mixture.density(-PI + (k as f64 + 0.5) * TAU / steps as f64);
        let total: f64 = (0..steps).map(at).sum::<f64>() * TAU / steps as f64;
        assert!((total - 1.0).abs() < 0.01, "{total}");
        assert!((mixture.density(PI) - mixture.density(-PI)).abs() < 0.01);
    }

    #[test]
    fn draws_follow_the_density() {
        let [head, _] = heads();
        let row: Vec<f32> = (0..head.outputs())
            .map(|k| (2.0 * k as f32).cos())
            .collect();
        let mixture = head.mixture(&row);
        let angles = mixture.draw(20_000, &mut stream(3, 1));
        let share = angles.iter().filter(|&&a| (0.0..1.0).contains(&a)).count() as f64 / 20_000.0;
        let at = |k: usize| mixture.density((k as f64 + 0.5) / 500.0) / 500.0;
        let expected: f64 = (0..500).map(at).sum();
        // Four standard deviations of a binomial share.
        assert!(
            (share - expected).abs() < 4.0 * (0.25_f64 / 20_000.0).sqrt(),
            "{share} {expected}"
        );
    }
}
