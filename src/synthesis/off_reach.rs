//! Robots that the bounds keep from the reach at which robots are compared.
//!
//! A length that is fixed or comes from a list does not scale with the others, and one at its bound
//! scales one way only, so that some robots cannot be brought to the reach 1. They are left out of
//! a search; that many were is worth knowing.

use super::link_space::{LinkSpace, Links};
use super::seeds::{Purpose, sample_seed};
use crate::sampling::stream;

/// Robots whose reach is off by more than this are of another size.
const NEAR: f64 = 0.01;

/// Whether a reach counts as the reach 1.
pub(super) fn is_one(reach: f64) -> bool {
    (reach - 1.0).abs() <= NEAR
}

impl LinkSpace {
    /// Whether settled `links` have the reach 1.
    pub fn has_reach(&self, links: &Links) -> bool {
        is_one(self.reach(links))
    }

    /// The random robot with this number in a search with `seed`, settled.
    pub fn numbered(&self, seed: u64, number: u32) -> Links {
        let seed = sample_seed(seed, Purpose::Robot, u64::from(number));
        self.random(&mut stream(seed, 0))
    }

    /// How many of the random robots with these numbers miss the reach.
    pub fn off_reach(&self, seed: u64, numbers: std::ops::Range<u32>) -> u32 {
        let misses = |number: &u32| !self.has_reach(&self.numbered(seed, *number));
        numbers.filter(misses).count() as u32
    }
}
