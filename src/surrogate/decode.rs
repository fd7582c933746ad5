//! From a mixture to a set of angles.

use super::arcs::positive_arcs;
use super::difference_filter::DifferenceFilter;
use super::mixture::Mixture;
use crate::angle::AngleSet;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Angles at which a density is looked at.
const GRID: usize = 180;

/// How a mixture becomes a set.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Decoder {
    /// The angles whose density exceeds `share` of ∫ p², which is the height of a uniform
    /// density. Deterministic.
    Level {
        /// Share of that height.
        share: f64,
    },
    /// Random draws, filtered and grouped [S3 §III.A].
    Sampling(DifferenceFilter),
}

impl Decoder {
    /// The set of a mixture, empty if the network holds the empty set for likelier.
    pub fn decode(&self, mixture: &Mixture, generator: &mut ChaCha8Rng) -> AngleSet {
        if mixture.presence < 0.5 {
            return AngleSet::empty();
        }
        match self {
            Decoder::Level { share } => above_level(mixture, *share),
            Decoder::Sampling(filter) => {
                let draws = mixture.draw(filter.draws, generator);
                filter.set(draws, mixture.wrapped)
            }
        }
    }
}

fn above_level(mixture: &Mixture, share: f64) -> AngleSet {
    let step = TAU / GRID as f64;
    let angle = |k: usize| -PI + k as f64 * step;
    let square: f64 = (0..GRID).map(|k| mixture.density(angle(k)).powi(2)).sum();
    let level = share * square * step;
    positive_arcs(GRID, angle, |at| mixture.density(at) - level)
}
