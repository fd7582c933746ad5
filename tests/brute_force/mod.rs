//! A brute force that shares nothing with the hybrid estimator: forward kinematics from
//! Denavit–Hartenberg rows, damped Newton steps from many starts, and the definition of W_F, lock
//! by lock on a fine grid of the artificial limits.

pub mod arm;
pub mod curves;
pub mod surfaces;

/// [lower, upper], radians or metres.
pub type Interval = [f64; 2];

/// Distance of locks from each other, radians (metres for a stroke).
const LOCK_STEP: f64 = 0.02;
/// Values of a lock: a grid of [low, high] with both ends.
pub fn grid([low, high]: Interval) -> Vec<f64> {
    let steps = ((high - low) / LOCK_STEP).ceil().max(1.0) as usize;
    let value = |k: usize| low + (high - low) * k as f64 / steps as f64;
    (0..=steps).map(value).collect()
}
