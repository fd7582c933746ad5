//! The pre-failure workspace of a planar chain: W₀(r) = A₁ ⊕ E(r) for every radius.

use super::chain::MovingChain;
use super::region::{Carrier, Region};
use crate::angle::AngleSet;
use crate::workspace::{ArtificialLimits, JointLimit};

/// W₀ in polar form. Reusable: rebuilding keeps the buffers.
#[derive(Clone, Debug, Default)]
pub(super) struct PreFailure {
    chain: MovingChain,
    /// Tails from the last moving joint inwards; the one of T₁ is `tails[depth − 1]`.
    tails: Vec<Region>,
    depth: usize,
}

impl PreFailure {
    /// Builds E(r) for radii in `range`.
    pub fn rebuild(&mut self, lengths: &[f64], limits: &ArtificialLimits, range: [f64; 2]) {
        self.chain = MovingChain::new(lengths, limits);
        let (links, joints) = (&self.chain.lengths, &self.chain.limits);
        self.depth = joints.len() - 1;
        if self.tails.len() < self.depth {
            self.tails.resize_with(self.depth, Region::default);
        }
        for level in 0..self.depth {
            let (done, rest) = self.tails.split_at_mut(level);
            let joint = self.depth - level;
            let (length, limit) = (links[joint - 1], joints[joint]);
            match done.last() {
                None => rest[0].rebuild_arc(length, limit, links[joint]),
                Some(tail) => {
                    let carrier = Carrier {
                        length,
                        limit,
                        tail,
                    };
                    let all = [0.0, f64::INFINITY];
                    let is_top = level + 1 == self.depth;
                    rest[0].rebuild(carrier, if is_top { range } else { all });
                }
            }
        }
    }

    /// Limits of joint 1, with those of held joints behind it merged in; free before the first
    /// rebuild.
    pub fn joint_1(&self) -> JointLimit {
        let first = self.chain.limits.first();
        first.copied().unwrap_or(JointLimit::FREE)
    }

    /// E(r) by panels, or None if all joints behind joint 1 are held: then W₀ is one circle.
    pub fn tail(&self) -> Option<&Region> {
        self.depth.checked_sub(1).map(|top| &self.tails[top])
    }

    /// W₀(r) at one radius from the panels.
    pub fn set_at(&self, r: f64) -> AngleSet {
        self.tail_at(r).sum(&self.joint_1().arc())
    }

    /// E(r) at one radius from the panels.
    pub fn tail_at(&self, r: f64) -> AngleSet {
        let tail = self.tail().map(|tail| tail.set_at(r));
        tail.unwrap_or_default()
    }

    /// W₀(r) at one radius by direct classification, independent of the panels.
    pub fn rotation_set(&self, scratch: &mut Region, r: f64) -> AngleSet {
        let joint_1 = self.joint_1().arc();
        self.tail_set(scratch, r).sum(&joint_1)
    }

    /// E(r) at one radius by direct classification.
    pub fn tail_set(&self, scratch: &mut Region, r: f64) -> AngleSet {
        match self.depth {
            0 => AngleSet::empty(),
            1 => self.tails[0].set_at(r),
            depth => {
                let carrier = Carrier {
                    length: self.chain.lengths[0],
                    limit: self.chain.limits[1],
                    tail: &self.tails[depth - 2],
                };
                carrier.set_at(scratch, r)
            }
        }
    }
}
