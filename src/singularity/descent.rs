//! From one configuration downhill to a singular one: the inner loop of [S1 Algorithm 1].

use super::decomposition::Decomposition;
use super::gradient::gradient;
use super::stratum::{Arm, SINGULAR};
use crate::kinematics::Differential;
use serde::{Deserialize, Serialize};

/// When a descent ends. Lengths in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DescentSettings {
    /// Longest step. Larger: nearer singular configurations may be stepped over.
    pub max_step: f64,
    /// Steps after which a start is given up.
    pub max_steps: usize,
    /// Singular values within this share of each other count as nearly equal, and are lowered
    /// together.
    pub nearly_equal: f64,
}

impl Default for DescentSettings {
    fn default() -> DescentSettings {
        DescentSettings {
            max_step: 0.4,
            max_steps: 120,
            nearly_equal: 0.1,
        }
    }
}

/// How a descent ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DescentStatus {
    /// At a singular configuration of the wanted rank loss, or of more.
    Singular,
    /// Where no direction lowers the singular value, or none by as much as a tenth in a dozen
    /// steps; it is above 0.
    LocalMinimum,
    /// After the most steps allowed.
    TooManySteps,
}

/// The end of a descent.
#[derive(Clone, Debug, PartialEq)]
pub struct Descent {
    /// How it ended.
    pub status: DescentStatus,
    /// Where: n internal joint variables.
    pub theta: Vec<f64>,
    /// Singular values there, greatest first.
    pub sigma: Vec<f64>,
    /// Steps made.
    pub steps: usize,
}

/// Newton steps are tried when the singular value is below this share of the greatest.
const NEAR: f64 = 0.05;
/// A descent must gain a tenth within this many steps.
const PATIENCE: usize = 12;
/// Shortest step, radians.
const SHORTEST: f64 = 1e-9;

/// Lowers σ_{m−loss+1} from `start` until J has lost rank `loss` (from 1) [S1 eq. 16].
pub fn descend(arm: &Arm, start: &[f64], loss: usize, settings: &DescentSettings) -> Descent {
    let mut theta = start.to_vec();
    let index = arm.task.dimension() - loss;
    let end = |status, theta: Vec<f64>, steps| Descent {
        status,
        sigma: arm.singular_values(&theta),
        theta,
        steps,
    };
    let mut mark = f64::INFINITY;
    for step in 0..settings.max_steps {
        let here = arm.at(&theta);
        let parts = Decomposition::new(&here.jacobian());
        if parts.sigma[index] < NEAR * parts.sigma[0]
            && let Some(settled) = settled(arm, &theta, loss)
        {
            return end(DescentStatus::Singular, settled, step);
        }
        if step % PATIENCE == 0 {
            if parts.sigma[index] > 0.9 * mark {
                return end(DescentStatus::LocalMinimum, theta, step);
            }
            mark = parts.sigma[index];
        }
        match lower(arm, (&here, &parts), &theta, index, settings) {
            Some(next) => theta = next,
            None => return end(DescentStatus::LocalMinimum, theta, step),
        }
    }
    end(DescentStatus::TooManySteps, theta, settings.max_steps)
}

/// The singular configuration next to `theta`, if Newton steps lead to one.
fn settled(arm: &Arm, theta: &[f64], loss: usize) -> Option<Vec<f64>> {
    let settled = arm.settle(theta, loss, None)?;
    let lost = arm.parts(&settled).loss(SINGULAR);
    let away = settled.iter().zip(theta).map(|(a, b)| (a - b).abs());
    (lost >= loss && away.fold(0.0, f64::max) < 1.0).then_some(settled)
}

/// One step along the group's gradient with an adaptive length; `None` if no step lowers
/// σ_index.
fn lower(
    arm: &Arm,
    (here, parts): (&Differential, &Decomposition),
    theta: &[f64],
    index: usize,
    settings: &DescentSettings,
) -> Option<Vec<f64>> {
    let sigma = parts.sigma[index];
    // A wider group where a narrower one brings nothing.
    let mut before = 0;
    for share in [settings.nearly_equal, 0.3, 1.0] {
        let near = |value: &&f64| **value >= (1.0 - share) * sigma;
        let count = parts.sigma[index..].iter().take_while(near).count().max(1);
        if count == before {
            continue;
        }
        before = count;
        let g = gradient(here, parts, index..index + count);
        let norm = g.norm();
        if norm < 1e-7 * parts.sigma[0] {
            continue;
        }
        // Where σ falls evenly it reaches 0 after σ / |g|.
        let mut length = (sigma / norm).min(settings.max_step);
        while length > SHORTEST {
            let share = length / norm;
            let next: Vec<f64> = theta
                .iter()
                .zip(g.iter())
                .map(|(a, g)| a - share * g)
                .collect();
            if arm.singular_values(&next)[index] < sigma - 0.05 * length * norm {
                return Some(next);
            }
            length *= 0.4;
        }
    }
    None
}
