//! Sets of angles as the positive part of a trigonometric polynomial.
//!
//! The network gives the coefficients of a logit z(β) = c₀ + Σ_k a_k cos kβ + b_k sin kβ, k ≤ D;
//! the set is where z > 0. Empty sets, full circles and the seam at ±π need no special care.

use super::mixture::cross_entropy;
use crate::angle::{AngleSet, Arc, wrap};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Angles per harmonic at which a polynomial is looked at.
const PER_HARMONIC: usize = 5;

/// Angles close to every end of a set, and how close, radians: their logits place the ends.
const NEAR: usize = 2;
const NEARNESS: f64 = 0.25;

/// Halvings that locate an end between two angles: to below 1e-5 rad.
const HALVINGS: usize = 14;

/// The outputs of the network: c₀, a₁, b₁, a₂, b₂, …
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ArcsHead {
    /// Highest frequency D.
    pub harmonics: usize,
}

impl ArcsHead {
    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        1 + 2 * self.harmonics
    }

    /// The logit at an angle.
    pub fn logit(&self, row: &[f32], angle: f64) -> f64 {
        let (sin, cos) = angle.sin_cos();
        let mut z = f64::from(row[0]);
        let (mut c, mut s) = (1.0, 0.0);
        for pair in row[1..].chunks_exact(2) {
            (c, s) = (c * cos - s * sin, s * cos + c * sin);
            z += f64::from(pair[0]) * c + f64::from(pair[1]) * s;
        }
        z
    }

    /// Mean cross-entropy over angles on a grid of random offset and over angles close to the ends
    /// of the set. Angles outside `matters` count `elsewhere` as much. Adds the derivatives by the
    /// outputs to `by_row`.
    pub fn loss(
        &self,
        row: &[f32],
        set: &AngleSet,
        matters: &AngleSet,
        generator: &mut ChaCha8Rng,
        by_row: &mut [f32],
    ) -> f64 {
        const ELSEWHERE: f64 = 0.1;
        let grid = PER_HARMONIC * self.harmonics;
        let offset = generator.random::<f64>();
        let mut angles: Vec<f64> = (0..grid)
            .map(|k| -PI + (k as f64 + offset) * TAU / grid as f64)
            .collect();
        for arc in set.arcs().iter().filter(|arc| !arc.is_full()) {
            for end in [arc.start(), arc.end()] {
                let near = (0..NEAR).map(|_| generator.random_range(-NEARNESS..NEARNESS));
                angles.extend(near.map(|by| wrap(end + by)));
            }
        }
        let scale = 1.0 / grid as f64;
        let mut loss = 0.0;
        for angle in angles {
            let weight = match matters.contains(angle) {
                true => scale,
                false => ELSEWHERE * scale,
            };
            let (value, by_logit) = cross_entropy(self.logit(row, angle), set.contains(angle));
            loss += weight * value;
            self.add_basis(weight * by_logit, angle, by_row);
        }
        loss
    }

    fn add_basis(&self, factor: f64, angle: f64, by_row: &mut [f32]) {
        let (sin, cos) = angle.sin_cos();
        by_row[0] += factor as f32;
        let (mut c, mut s) = (1.0, 0.0);
        for pair in by_row[1..].chunks_exact_mut(2) {
            (c, s) = (c * cos - s * sin, s * cos + c * sin);
            pair[0] += (factor * c) as f32;
            pair[1] += (factor * s) as f32;
        }
    }

    /// The set where the logit is positive.
    pub fn decode(&self, row: &[f32]) -> AngleSet {
        let count = 2 * PER_HARMONIC * self.harmonics;
        let angle = |k: usize| -PI + k as f64 * TAU / count as f64;
        positive_arcs(count, angle, |at| self.logit(row, at))
    }
}

/// The arcs on which a periodic function is positive, seen at `count` angles and refined by
/// halving where its sign changes.
pub(super) fn positive_arcs(
    count: usize,
    angle: impl Fn(usize) -> f64,
    value: impl Fn(f64) -> f64,
) -> AngleSet {
    let signs: Vec<bool> = (0..count).map(|k| value(angle(k)) > 0.0).collect();
    let step = TAU / count as f64;
    let crossing = |k: usize| {
        let (mut low, mut high) = (angle(k), angle(k) + step);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if (value(middle) > 0.0) == signs[k] {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    };
    let changes: Vec<usize> = (0..count)
        .filter(|&k| signs[k] != signs[(k + 1) % count])
        .collect();
    if changes.is_empty() {
        return match signs.first() {
            Some(true) => AngleSet::full(),
            _ => AngleSet::empty(),
        };
    }
    // Every arc begins where the sign turns positive and ends at the next change.
    let begins: Vec<usize> = (0..changes.len()).filter(|&k| !signs[changes[k]]).collect();
    AngleSet::from_arcs(begins.into_iter().map(|k| {
        let start = crossing(changes[k]);
        let end = crossing(changes[(k + 1) % changes.len()]);
        Arc::new(start, crate::angle::turn(start, end))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::stream;

    #[test]
    fn decoding_finds_the_sign_of_a_cosine() {
        let head = ArcsHead { harmonics: 2 };
        // cos(2(β − 0.3)) > 0: two arcs of a quarter turn around 0.3 and 0.3 + π.
        let row = [0.0, 0.0, 0.0, 0.6_f32.cos(), 0.6_f32.sin()];
        let set = head.decode(&row);
        assert_eq!(set.arcs().len(), 2);
        for (arc, centre) in set.arcs().iter().zip([0.3, 0.3 - PI]) {
            assert!(wrap(arc.centre() - centre).abs() < 1e-3);
            assert!((arc.width() - 0.5 * PI).abs() < 1e-3);
        }
        assert!(head.decode(&[1.0, 0.0, 0.0, 0.0, 0.0]).is_full());
        assert!(head.decode(&[-1.0, 0.0, 0.0, 0.0, 0.0]).is_empty());
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let head = ArcsHead { harmonics: 3 };
        let set = AngleSet::from_arcs([Arc::new(2.0, 2.5)]);
        let matters = AngleSet::from_arcs([Arc::new(-1.0, 4.0)]);
        let row: Vec<f32> = (0..head.outputs()).map(|k| (k as f32).sin()).collect();
        let mut by_row = vec![0.0; row.len()];
        head.loss(&row, &set, &matters, &mut stream(1, 1), &mut by_row);
        for k in 0..row.len() {
            let value = |step: f32| {
                let mut moved = row.clone();
                moved[k] += step;
                let mut ignored = vec![0.0; row.len()];
                head.loss(&moved, &set, &matters, &mut stream(1, 1), &mut ignored)
            };
            let difference = (value(1e-2) - value(-1e-2)) / 2e-2;
            assert!((difference - f64::from(by_row[k])).abs() < 1e-3, "{k}");
        }
    }
}
