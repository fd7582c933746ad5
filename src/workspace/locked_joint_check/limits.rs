//! Artificial limits within the physical ones, and the values at which joints are locked.

use super::arm::{Angles, Arm, Bounds, MOST_JOINTS};
use crate::angle::{AngleSet, Arc};
use crate::workspace::{ArtificialLimits, FailureSet, JointLimit};
use rand::Rng;
use std::f64::consts::TAU;

/// What a configuration may be before a failure, and where joints may lock.
pub(super) struct Prepared {
    /// The artificial limits within the physical ones.
    pub inside: Bounds,
    /// Joints that may lock, from 0, each with the values [low, high] at which it may; two infinite
    /// ones for the full circle.
    pub locks: Vec<(usize, [f64; 2])>,
}

impl Prepared {
    pub fn new(
        arm: &Arm,
        limits: &ArtificialLimits,
        failures: &FailureSet,
        margin: f64,
    ) -> Prepared {
        let mut inside = [[f64::NEG_INFINITY, f64::INFINITY]; MOST_JOINTS];
        let mut locks = Vec::new();
        for (joint, limit) in limits.joints().iter().enumerate().take(arm.joints()) {
            inside[joint] = within(arm, joint, limit);
            let wider = JointLimit {
                lower: limit.lower - margin,
                upper: limit.upper + margin,
            };
            if failures.contains(joint + 1) {
                locks.push((joint, within(arm, joint, &wider)));
            }
        }
        Prepared { inside, locks }
    }
}

/// The limits of a joint cut to its physical ones; where two pieces are left, the longer one.
fn within(arm: &Arm, joint: usize, limit: &JointLimit) -> [f64; 2] {
    let [low, high] = arm.physical[joint];
    let is_full = limit.is_full();
    match (high.is_finite(), is_full) {
        (false, true) => [low, high],
        (false, false) => [limit.lower, limit.upper],
        (true, true) => [low, high],
        (true, false) if !arm.turns(joint) => {
            [limit.lower.clamp(low, high), limit.upper.clamp(low, high)]
        }
        (true, false) => {
            let allowed = AngleSet::from(Arc::from_interval(low, high));
            let both = AngleSet::from(limit.arc()).intersection(&allowed);
            let longer = |a: Arc, b: &Arc| if b.width() > a.width() { *b } else { a };
            let first = both.arcs().first().copied();
            let piece = first.map(|first| both.arcs().iter().fold(first, longer));
            // With nothing left the joint stands at a physical limit.
            piece.map_or([low, low], |arc| [arc.start(), arc.end()])
        }
    }
}

/// One lock to be tried.
#[derive(Clone, Copy)]
pub(super) struct Lock {
    pub joint: usize,
    pub value: f64,
}

/// All locks at most `spacing` apart, in the order that meets a gap early: the ends of all joints
/// first, then all joints from coarse to fine. Between the ends the grid has a random offset.
pub(super) fn lock_order(prepared: &Prepared, spacing: f64, rng: &mut impl Rng) -> Vec<Lock> {
    let mut ranked = Vec::new();
    for &(joint, [low, high]) in &prepared.locks {
        let offset: f64 = rng.random();
        let (from, width) = if high.is_finite() {
            ranked.push((0, Lock { joint, value: low }));
            ranked.push((0, Lock { joint, value: high }));
            (low, high - low)
        } else {
            (0.0, TAU)
        };
        let count = (width / spacing).ceil() as usize;
        for (rank, place) in coarse_to_fine(count).enumerate() {
            let value = from + (place as f64 + offset) * width / count as f64;
            ranked.push((1 + rank, Lock { joint, value }));
        }
    }
    ranked.sort_by_key(|(rank, _)| *rank);
    ranked.into_iter().map(|(_, lock)| lock).collect()
}

/// The numbers below `count` with their bits reversed: each splits the widest gap left.
fn coarse_to_fine(count: usize) -> impl Iterator<Item = usize> {
    let bits = usize::BITS - count.next_power_of_two().leading_zeros() - 1;
    (0..count.next_power_of_two())
        .map(move |k| match bits {
            0 => 0,
            _ => k.reverse_bits() >> (usize::BITS - bits),
        })
        .filter(move |k| *k < count)
}

/// A configuration uniform within `bounds`.
pub(super) fn random_start(arm: &Arm, bounds: &Bounds, rng: &mut impl Rng) -> Angles {
    let mut theta = [0.0; MOST_JOINTS];
    for (value, [low, high]) in theta.iter_mut().zip(bounds).take(arm.joints()) {
        let u: f64 = rng.random();
        *value = match high.is_finite() {
            true => low + (high - low) * u,
            false => TAU * u,
        };
    }
    theta
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_comes_once_and_coarse_ones_first() {
        for count in [0, 1, 2, 5, 8, 120] {
            let mut order: Vec<usize> = coarse_to_fine(count).collect();
            assert!(order.len() < 3 || order[1] >= count / 2, "{order:?}");
            order.sort_unstable();
            assert_eq!(order, (0..count).collect::<Vec<_>>());
        }
    }
}
