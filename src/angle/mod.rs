//! Angles as points of the circle, arcs, and sets of arcs.
//!
//! Whether a task point is fault tolerant depends only on *sets of angles on the circle*. The
//! papers shorten such a set to one minimum and one maximum, which over- or under-counts
//! wherever the set has gaps; here it stays a union of arcs. All angles are in radians.

mod arc;
mod set;

pub use arc::Arc;
pub use set::{AngleSet, GAP_TOLERANCE, degree_pairs};

use std::f64::consts::{PI, TAU};

/// The representative of `angle` in [−π, π).
///
/// Exact for angles already in the interval; otherwise one floating-point reduction modulo 2π.
pub fn wrap(angle: f64) -> f64 {
    if (-PI..PI).contains(&angle) {
        return angle;
    }
    let wrapped = (angle + PI).rem_euclid(TAU) - PI;
    // rem_euclid may round up to exactly 2π for tiny negative arguments.
    if wrapped >= PI { -PI } else { wrapped }
}

/// The counter-clockwise distance from `from` to `to`, in [0, 2π).
pub fn turn(from: f64, to: f64) -> f64 {
    let turned = (to - from).rem_euclid(TAU);
    if turned >= TAU { 0.0 } else { turned }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrap_puts_pi_on_the_lower_end() {
        assert_eq!(wrap(PI), -PI);
        assert_eq!(wrap(-PI), -PI);
        assert_eq!(wrap(0.25), 0.25);
        assert!((wrap(0.25 + 3.0 * TAU) - 0.25).abs() < 1e-14);
        assert!((-PI..PI).contains(&wrap(-PI - 1e-300)));
    }

    #[test]
    fn turn_is_counter_clockwise() {
        assert!((turn(3.0, -3.0) - (TAU - 6.0)).abs() < 1e-15);
        assert_eq!(turn(1.0, 1.0), 0.0);
    }
}
