//! Adam with decoupled weight decay (Loshchilov & Hutter 2019), whose state can be stored.

use serde::{Deserialize, Serialize};

const BETA_1: f32 = 0.9;
const BETA_2: f32 = 0.999;
const EPSILON: f32 = 1e-8;

/// Moments of the gradient.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AdamW {
    first: Vec<f32>,
    second: Vec<f32>,
    step: i32,
}

impl AdamW {
    /// No history.
    pub fn new(weights: usize) -> AdamW {
        AdamW {
            first: vec![0.0; weights],
            second: vec![0.0; weights],
            step: 0,
        }
    }

    /// One step against `gradient`.
    pub fn step(&mut self, weights: &mut [f32], gradient: &[f32], rate: f32, decay: f32) {
        self.step += 1;
        let unbiased_1 = 1.0 / (1.0 - BETA_1.powi(self.step));
        let unbiased_2 = 1.0 / (1.0 - BETA_2.powi(self.step));
        let moments = self.first.iter_mut().zip(&mut self.second);
        for ((weight, &g), (m, v)) in weights.iter_mut().zip(gradient).zip(moments) {
            *m = BETA_1 * *m + (1.0 - BETA_1) * g;
            *v = BETA_2 * *v + (1.0 - BETA_2) * g * g;
            let direction = *m * unbiased_1 / ((*v * unbiased_2).sqrt() + EPSILON);
            *weight -= rate * (direction + decay * *weight);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first step goes by `rate` against the sign of the gradient, whatever its size.
    #[test]
    fn the_first_step_is_the_sign() {
        let mut weights = [1.0, -2.0, 3.0];
        AdamW::new(3).step(&mut weights, &[5.0, -0.01, 0.0], 0.1, 0.0);
        for (weight, expected) in weights.iter().zip([0.9, -1.9, 3.0]) {
            assert!((weight - expected).abs() < 1e-5, "{weight}");
        }
    }

    #[test]
    fn decay_shrinks_weights_without_gradient() {
        let mut weights = [2.0];
        AdamW::new(1).step(&mut weights, &[0.0], 0.1, 0.5);
        assert!((weights[0] - 1.9).abs() < 1e-6);
    }
}
