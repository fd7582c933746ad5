//! Newton steps to where one joint's angle is stationary on a pre-image of two or more dimensions.
//!
//! With B an orthonormal basis of the null space of J, g = Bᵀ e_j the slope of the angle and H its
//! derivative along B, the next point is B·(−H⁻¹ g) away, settled onto the pre-image. Uphill steps
//! alone ([`super::ascent`]) go from side to side of a ridge and come to rest before its top.

use super::ascent::{Aim, settle, uphill};
use crate::kinematics::{Goal, Kernel, dot};
use nalgebra::{DMatrix, DVector};

/// Steps after which the search ends: it converges in a few or not at all.
const MOST_STEPS: usize = 20;

/// Slope below which the angle is stationary, radians per radian: to its square.
const FLAT: f64 = 1e-8;

/// Distance of the slopes that H is taken from, radians.
const SPREAD: f64 = 1e-4;

/// Longest step, radians.
const LONGEST: f64 = 0.1;

/// Times that a step is halved until it rises.
const HALVINGS: usize = 8;

/// The point to which Newton steps lead from `start` without leaving where `aim` may go; `start`
/// itself where they do not rise.
pub(super) fn to_summit<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    start: [f64; N],
    aim: &Aim<'_>,
) -> [f64; N] {
    let mut point = start;
    for _ in 0..MOST_STEPS {
        let slope = uphill(kernel, goal, &point, aim.joint, aim.sign);
        if dot(&slope, &slope).sqrt() < FLAT {
            break;
        }
        let Some(step) = newton_step(kernel, goal, &point, &slope, aim) else {
            break;
        };
        let height = |theta: &[f64; N]| aim.sign * theta[aim.joint];
        let rising = (0..HALVINGS).find_map(|k| {
            let share = 0.5f64.powi(k as i32);
            let guess = std::array::from_fn(|k| point[k] + share * step[k]);
            let next = settle(kernel, goal, guess)?;
            (height(&next) > height(&point) && (aim.inside)(&next)).then_some(next)
        });
        match rising {
            Some(next) => point = next,
            None => break,
        }
    }
    point
}

/// −B H⁻¹ g, or a step along the slope where the surface does not fall off to all sides.
fn newton_step<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    point: &[f64; N],
    slope: &[f64; N],
    aim: &Aim<'_>,
) -> Option<[f64; N]> {
    let basis = null_space(kernel, goal, point);
    let size = basis.len();
    let mut bend = DMatrix::zeros(size, size);
    for (k, direction) in basis.iter().enumerate() {
        let aside = std::array::from_fn(|joint| point[joint] + SPREAD * direction[joint]);
        let aside = settle(kernel, goal, aside)?;
        let there = uphill(kernel, goal, &aside, aim.joint, aim.sign);
        for (row, other) in basis.iter().enumerate() {
            bend[(row, k)] = (dot(other, slope) - dot(other, &there)) / SPREAD;
        }
    }
    let bend = 0.5 * (&bend + bend.transpose());
    let along = DVector::from_fn(size, |k, _| dot(&basis[k], slope));
    let way = match bend.cholesky() {
        Some(factors) => factors.solve(&along),
        None => along.clone() * (LONGEST / along.norm().max(1e-300)),
    };
    let way = &way * (LONGEST / way.norm().max(LONGEST));
    Some(std::array::from_fn(|joint| {
        basis
            .iter()
            .zip(way.iter())
            .map(|(b, w)| w * b[joint])
            .sum()
    }))
}

/// An orthonormal basis of the null space of J: axes projected onto it, the longest first.
fn null_space<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    point: &[f64; N],
) -> Vec<[f64; N]> {
    let mut left: Vec<[f64; N]> = (0..N)
        .map(|joint| uphill(kernel, goal, point, joint, 1.0))
        .collect();
    let mut basis = Vec::with_capacity(N - M);
    for _ in 0..N - M {
        let longest = left
            .iter()
            .copied()
            .max_by(|a, b| dot(a, a).total_cmp(&dot(b, b)));
        let Some(longest) = longest else { break };
        let norm = dot(&longest, &longest).sqrt().max(1e-300);
        let unit = longest.map(|x| x / norm);
        for vector in &mut left {
            let share = dot(vector, &unit);
            for (x, u) in vector.iter_mut().zip(unit) {
                *x -= share * u;
            }
        }
        basis.push(unit);
    }
    basis
}
