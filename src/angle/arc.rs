//! One closed arc of the circle.

use super::{turn, wrap};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// A closed arc, counter-clockwise from `start` through `width` radians.
///
/// A width of zero is a single angle, a width of 2π the full circle; both are ordinary values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Arc {
    start: f64,
    width: f64,
}

impl Arc {
    /// The full circle, written as [−π, π].
    pub const FULL: Arc = Arc {
        start: -PI,
        width: TAU,
    };

    /// The arc from `start` through `width` radians. A width of 2π or more is the full circle, a
    /// negative one (round-off of a caller's subtraction) a single angle.
    pub fn new(start: f64, width: f64) -> Arc {
        debug_assert!(start.is_finite() && width.is_finite());
        if width >= TAU {
            return Arc::FULL;
        }
        Arc {
            start: wrap(start),
            width: width.max(0.0),
        }
    }

    /// The arc swept by the unwrapped interval `[lower, upper]`, which may lie beyond ±π.
    pub fn from_interval(lower: f64, upper: f64) -> Arc {
        Arc::new(lower, upper - lower)
    }

    /// The single angle `angle`.
    pub fn point(angle: f64) -> Arc {
        Arc::new(angle, 0.0)
    }

    /// First angle of the arc, in [−π, π).
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Last angle of the arc, unwrapped: `start + width`, in [−π, 3π).
    pub fn end(&self) -> f64 {
        self.start + self.width
    }

    /// Width in [0, 2π].
    pub fn width(&self) -> f64 {
        self.width
    }

    /// The middle of the arc, in [−π, π).
    pub fn centre(&self) -> f64 {
        wrap(self.start + 0.5 * self.width)
    }

    /// Whether the arc is the whole circle.
    pub fn is_full(&self) -> bool {
        self.width >= TAU
    }

    /// Whether `angle` (modulo 2π) lies on the closed arc.
    pub fn contains(&self, angle: f64) -> bool {
        self.is_full() || turn(self.start, angle) <= self.width
    }

    /// As [`Arc::contains`], with the arc widened by `tolerance` radians at both ends.
    pub fn contains_within(&self, angle: f64, tolerance: f64) -> bool {
        self.width + 2.0 * tolerance >= TAU
            || turn(self.start - tolerance, angle) <= self.width + 2.0 * tolerance
    }

    /// The arc turned by `angle`.
    pub fn rotated(&self, angle: f64) -> Arc {
        if self.is_full() {
            Arc::FULL
        } else {
            Arc::new(self.start + angle, self.width)
        }
    }

    /// The mirror image { −x : x ∈ arc }.
    pub fn mirrored(&self) -> Arc {
        if self.is_full() {
            Arc::FULL
        } else {
            Arc::new(-self.end(), self.width)
        }
    }

    /// The Minkowski sum { x + y : x ∈ self, y ∈ other }.
    pub fn sum(&self, other: &Arc) -> Arc {
        Arc::new(self.start + other.start, self.width + other.width)
    }
}
