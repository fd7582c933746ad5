//! A planar chain inside its artificial limits, with the joints that are held still merged away.

use crate::workspace::{ArtificialLimits, JointLimit};
use nalgebra::Complex;
use smallvec::SmallVec;

/// Widths up to this (radians) hold a joint still: the joint's two links act as one rigid link.
///
/// A joint of such a width moves the end point by less than a picometre per metre of arm.
pub(super) const HELD_WIDTH: f64 = 1e-12;

/// A link that this share of the reach cannot tell from zero.
const ZERO_LENGTH: f64 = 1e-12;

/// Links l₁ … l_k with limits of joints 1 … k, every joint after the first of positive width and
/// every link of positive length.
///
/// Held joints and links of length zero are merged: the reduced chain reaches the same points at
/// the same polar angles inside its limits. Only the pre-failure workspace W₀ may be computed
/// from it; a joint that locks does so in the chain as designed.
#[derive(Clone, Debug, Default)]
pub(super) struct MovingChain {
    pub lengths: SmallVec<[f64; 8]>,
    pub limits: SmallVec<[JointLimit; 8]>,
}

impl MovingChain {
    pub fn new(lengths: &[f64], limits: &ArtificialLimits) -> MovingChain {
        let mut chain = MovingChain::default();
        chain.lengths.extend_from_slice(lengths);
        chain.limits.extend_from_slice(limits.joints());
        let tolerance = ZERO_LENGTH * lengths.iter().sum::<f64>();
        while let Some(joint) = chain.first_held() {
            chain.merge_held(joint, tolerance);
        }
        chain
    }

    /// Index (from 0) of a held joint after the first.
    fn first_held(&self) -> Option<usize> {
        let held = |limit: &JointLimit| limit.upper - limit.lower <= HELD_WIDTH;
        (1..self.limits.len()).find(|&j| held(&self.limits[j]))
    }

    /// Replaces links j−1 and j, rigid at joint j's angle a, by the one link
    /// l_{j−1} + e^{ia}·l_j = L·e^{iδ}.
    fn merge_held(&mut self, j: usize, tolerance: f64) {
        let angle = self.limits[j].centre();
        let rigid = self.lengths[j - 1] + Complex::from_polar(self.lengths[j], angle);
        let length = rigid.norm();
        let bend = if length > tolerance { rigid.arg() } else { 0.0 };
        self.lengths.remove(j);
        self.limits.remove(j);
        self.lengths[j - 1] = length;
        self.limits[j - 1] = self.limits[j - 1].shifted(bend);
        if let Some(next) = self.limits.get_mut(j) {
            *next = next.shifted(angle - bend);
        }
        if length <= tolerance {
            self.remove_zero_link(j - 1);
        }
    }

    /// A link of length zero puts its two joints on one axis: their limits add. Behind the last
    /// joint it makes that joint idle.
    fn remove_zero_link(&mut self, k: usize) {
        if k + 1 < self.limits.len() {
            let next = self.limits[k + 1];
            let own = self.limits[k];
            self.limits[k] = JointLimit::new(own.lower + next.lower, own.upper + next.upper);
            self.limits.remove(k + 1);
            self.lengths.remove(k);
        } else if k > 0 {
            self.limits.remove(k);
            self.lengths.remove(k);
        } else {
            self.lengths[0] = 0.0;
        }
    }
}
