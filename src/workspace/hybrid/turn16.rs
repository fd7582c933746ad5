//! Angles as 16-bit fractions of a turn.
//!
//! Differences of such numbers wrap around by themselves, so whether an angle lies in an arc is
//! one subtraction and one comparison. The resolution is 2π/65536 ≈ 9.6e-5 rad; rounding to the
//! nearest step moves an angle by at most 4.8e-5 rad.

use crate::angle::{AngleSet, Arc};
use std::f64::consts::TAU;

/// Radians per step.
pub(super) const STEP: f64 = TAU / 65536.0;

/// The nearest step of an angle, modulo a turn.
pub(super) fn quantise(angle: f64) -> u16 {
    // Unwrapped angles span few turns: the cast to i64 cannot overflow.
    ((angle / STEP).round() as i64) as u16
}

/// The angle of a step, in [0, 2π).
pub(super) fn angle(step: u16) -> f64 {
    f64::from(step) * STEP
}

/// A closed arc: start and width in steps. A width of 65535 stands for the full circle.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    zerocopy::FromBytes,
    zerocopy::IntoBytes,
    zerocopy::Immutable,
    zerocopy::KnownLayout,
)]
#[repr(C)]
pub struct Arc16 {
    pub start: u16,
    pub width: u16,
}

/// Width of the full circle.
const FULL: u16 = u16::MAX;

impl Arc16 {
    pub fn full() -> Arc16 {
        Arc16 {
            start: 0,
            width: FULL,
        }
    }

    /// The arc between the steps nearest to both ends, so that a joint standing at an end of its
    /// limits is inside; never full unless the given one is.
    pub fn nearest(arc: &Arc) -> Arc16 {
        if arc.is_full() {
            return Arc16::full();
        }
        let nearest = |angle: f64| (angle / STEP).round() as i64;
        let width = nearest(arc.end()) - nearest(arc.start());
        Arc16 {
            start: quantise(arc.start()),
            width: width.clamp(0, i64::from(FULL) - 1) as u16,
        }
    }

    pub fn is_full(self) -> bool {
        self.width == FULL
    }

    #[inline(always)]
    pub fn contains(self, step: u16) -> bool {
        step.wrapping_sub(self.start) <= self.width
    }

    /// Whether the whole of `other` lies inside.
    #[inline(always)]
    pub fn covers(self, other: Arc16) -> bool {
        let lead = u32::from(other.start.wrapping_sub(self.start));
        self.is_full() || lead + u32::from(other.width) <= u32::from(self.width)
    }

    pub fn arc(self) -> Arc {
        if self.is_full() {
            Arc::FULL
        } else {
            Arc::new(angle(self.start), f64::from(self.width) * STEP)
        }
    }
}

/// The set with every arc rounded.
pub(super) fn arcs16(set: &AngleSet) -> impl Iterator<Item = Arc16> + '_ {
    set.arcs().iter().map(Arc16::nearest)
}

/// The set of rounded arcs.
pub(super) fn angle_set(arcs: &[Arc16]) -> AngleSet {
    AngleSet::from_arcs(arcs.iter().map(|arc| arc.arc()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wraps_and_rounds() {
        assert_eq!(quantise(-STEP), u16::MAX);
        assert_eq!(quantise(TAU + 2.0 * STEP), 2);
        assert_eq!(quantise(-3.0 * TAU + 0.4 * STEP), 0);
    }

    /// Faces of a box lie in the box.
    #[test]
    fn both_ends_are_inside() {
        for k in 0..2000 {
            let (lower, upper) = (0.1 * f64::from(k) - 100.0, 0.101 * f64::from(k) - 97.0);
            if upper - lower < TAU {
                let arc = Arc16::nearest(&Arc::from_interval(lower, upper));
                assert!(
                    arc.contains(quantise(lower)) && arc.contains(quantise(upper)),
                    "{k}"
                );
            }
        }
    }

    #[test]
    fn covers_across_the_cut() {
        let arc = Arc16::nearest(&Arc::from_interval(3.0, 4.0));
        assert!(arc.covers(Arc16::nearest(&Arc::from_interval(3.1, 3.9))));
        assert!(!arc.covers(Arc16::nearest(&Arc::from_interval(3.1, 4.1))));
        assert!(!arc.covers(Arc16::full()) && Arc16::full().covers(arc));
        assert!(arc.contains(quantise(3.5 - TAU)) && !arc.contains(quantise(2.9)));
    }
}
