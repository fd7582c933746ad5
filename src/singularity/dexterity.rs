//! Local measures of a configuration, and the best of them over a location.
//!
//! The condition number σ₁/σ_m, the manipulability √det(JJᵀ) = ∏ σ [S1 ref. 22], and the worst-case
//! fault-tolerant manipulability: the least manipulability that is left when one joint locks. For
//! n = m + 1 that of joint i is ∏ σ · |n_i| with n the unit null vector. A joint that stands still
//! on all manifolds of a location has n_i = 0 everywhere and would make the measure 0 for good, as
//! joint 4 of the PA-10 does; it is left out, as [S1] does without saying so.

use super::decomposition::Decomposition;
use super::stratum::Arm;
use crate::manifold::SelfMotionManifold;

/// Joints whose range over a location is narrower, radians, stand still.
pub(super) const STILL: f64 = 1e-3;

/// The best local measures over the configurations of a location.
#[derive(Clone, Debug, PartialEq)]
pub struct Dexterity {
    /// Least condition number σ₁/σ_m; metres and radians mixed, as in [S1].
    pub condition: f64,
    /// Where the condition number is least, n internal joint variables.
    pub theta: Vec<f64>,
    /// Greatest manipulability.
    pub manipulability: f64,
    /// Greatest worst-case fault-tolerant manipulability over the joints that move.
    pub fault_tolerant: f64,
}

/// The measures of one configuration: condition number, manipulability and worst-case
/// fault-tolerant manipulability over the joints for which `moves` holds.
pub fn measures(arm: &Arm, theta: &[f64], moves: &[bool]) -> [f64; 3] {
    let Decomposition { sigma, v, .. } = arm.parts(theta);
    let product: f64 = sigma.iter().product();
    let last = sigma[sigma.len() - 1];
    let condition = match last > 0.0 {
        true => sigma[0] / last,
        false => f64::INFINITY,
    };
    let null = v.column(v.ncols() - 1);
    let parts = (0..theta.len())
        .filter(|&k| moves[k])
        .map(|k| null[k].abs());
    let worst = parts.fold(f64::INFINITY, f64::min);
    let worst = if worst.is_finite() {
        product * worst
    } else {
        0.0
    };
    [condition, product, worst]
}

impl Dexterity {
    /// Over the vertices of `manifolds` for which `inside` holds, at most `most` of them; `None`
    /// if there is none.
    pub fn of(
        arm: &Arm,
        manifolds: &[SelfMotionManifold],
        moves: &[bool],
        most: usize,
        inside: impl Fn(&[f64]) -> bool,
    ) -> Option<Dexterity> {
        let all: usize = manifolds.iter().map(SelfMotionManifold::vertices).sum();
        let stride = all.div_ceil(most.max(1)).max(1);
        let mut best: Option<Dexterity> = None;
        for manifold in manifolds {
            for k in (0..manifold.vertices()).step_by(stride) {
                let theta = manifold.point(k);
                if !inside(theta) {
                    continue;
                }
                let [condition, manipulability, fault_tolerant] = measures(arm, theta, moves);
                let best = best.get_or_insert(Dexterity {
                    condition: f64::INFINITY,
                    theta: theta.to_vec(),
                    manipulability: 0.0,
                    fault_tolerant: 0.0,
                });
                if condition < best.condition {
                    best.condition = condition;
                    best.theta = theta.to_vec();
                }
                best.manipulability = best.manipulability.max(manipulability);
                best.fault_tolerant = best.fault_tolerant.max(fault_tolerant);
            }
        }
        best
    }
}
