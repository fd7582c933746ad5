//! Inverse kinematics inside bounds: Levenberg–Marquardt steps with an active set.

use super::arm::{Angles, Arm, Bounds, Goal, MOST_JOINTS};
use nalgebra::{SMatrix, SVector};

/// A goal counts as reached within this, in units of the reach and radians.
const REACHED: f64 = 1e-8;
/// Steps of one start.
const STEPS: usize = 60;
/// Steps without progress after which a start is given up.
const IDLE: usize = 8;
/// Share to which the squared error must fall to count as progress.
const PROGRESS: f64 = 0.8;
/// Largest step of a joint, radians.
const LONGEST: f64 = 0.7;
/// Damping as a share of the squared error: convergence stays quadratic, and far from the goal a
/// step never runs away (T. Sugihara, 2011).
const DAMPING: f64 = 0.5;

/// A configuration inside `bounds` that reaches `goal`, by steps from `start`. A joint whose two
/// bounds are equal is locked. `M` is the task's dimension.
pub(super) fn solve<const M: usize>(
    arm: &Arm,
    goal: &Goal,
    start: &Angles,
    bounds: &Bounds,
) -> Option<Angles> {
    let mut theta = *start;
    arm.clamp(&mut theta, bounds);
    let (mut best, mut idle) = (f64::INFINITY, 0);
    for _ in 0..STEPS {
        let linear = arm.linearise::<M>(&theta, goal);
        let square = linear.missing.norm_squared();
        if square < REACHED * REACHED {
            return Some(theta);
        }
        if square < PROGRESS * best {
            (best, idle) = (square, 0);
        } else {
            idle += 1;
            if idle > IDLE {
                return None;
            }
        }
        let step = step(
            &theta,
            bounds,
            &linear.missing,
            &linear.columns[..arm.joints()],
        )?;
        let longest = step.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
        let scale = (LONGEST / longest.max(1e-300)).min(1.0);
        for (value, step) in theta.iter_mut().zip(&step) {
            *value += scale * step;
        }
        arm.clamp(&mut theta, bounds);
    }
    None
}

/// The damped least-squares step in which no joint at a bound is pushed against it.
fn step<const M: usize>(
    theta: &Angles,
    bounds: &Bounds,
    missing: &SVector<f64, M>,
    columns: &[SVector<f64, M>],
) -> Option<Angles> {
    let mut held = [false; MOST_JOINTS];
    for (held, [low, high]) in held.iter_mut().zip(bounds) {
        *held = low == high;
    }
    let mut step = [0.0; MOST_JOINTS];
    for _ in 0..=columns.len() {
        let damping = DAMPING * missing.norm_squared() + 1e-13;
        let mut gram = SMatrix::<f64, M, M>::identity() * damping;
        for (column, _) in columns.iter().zip(&held).filter(|(_, held)| !**held) {
            gram.ger(1.0, column, column, 1.0);
        }
        let pull = gram.cholesky()?.solve(missing);
        let mut is_pushed = false;
        for (joint, column) in columns.iter().enumerate() {
            step[joint] = if held[joint] { 0.0 } else { column.dot(&pull) };
            let [low, high] = bounds[joint];
            let out = theta[joint] <= low && step[joint] < 0.0
                || theta[joint] >= high && step[joint] > 0.0;
            if out && !held[joint] {
                held[joint] = true;
                is_pushed = true;
            }
        }
        if !is_pushed {
            break;
        }
    }
    Some(step)
}
