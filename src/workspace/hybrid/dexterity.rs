//! How far from singular the robot can be inside W_F, where it holds each pose as well as its
//! artificial limits allow.
//!
//! Two measures of a configuration. The least entry of the unit null vector of J, in magnitude: the
//! share of the manipulability that is left when the worst joint locks. With more than one degree of redundancy, the least row norm of an orthonormal basis
//! of the null space takes its place. And 1/cond J, with positions in units of the reach. Both are
//! the same at every azimuth.

use super::atlas::Atlas;
use super::block::{BlockView, PoseRecord};
use super::score::{Limits16, Rule};
use super::turn16::{STEP, angle};
use crate::angle::AngleSet;
use crate::design::{Robot, TaskSpace};
use crate::kinematics::{Chain, Differential, workspace_extent};
use crate::workspace::{ArtificialLimits, Estimate, FailureSet};
use nalgebra::Isometry3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Means over W_F of the best that any configuration inside the limits offers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dexterity {
    /// Fault-tolerant samples they rest on.
    pub poses: u64,
    /// Mean of the greatest min_j |n_j|, n the unit null vector; at most 1/√n.
    pub null_component: Estimate,
    /// Mean of the greatest 1/cond J, in [0, 1].
    pub inverse_condition: Estimate,
}

/// Distance of configurations looked at along a manifold, radians.
const SPACING: f64 = 0.1;
/// Rotation angles looked at for every sample, where joint 1 is restricted.
const TURNS: usize = 8;
/// Share of the largest eigenvalue of J Jᵀ below which a configuration is singular.
const SINGULAR: f64 = 1e-12;

/// A configuration: θ₁ and the two measures.
type Candidate = (f64, [f64; 2]);

impl Atlas {
    /// The dexterity inside W_F, from at most `most_poses` fault-tolerant samples spread evenly.
    ///
    /// `robot` is the one of the atlas. The two maxima are taken separately, over the stored
    /// polylines: with the default tolerance of 0.01 rad both are good to about 0.01. `None` if the
    /// atlas is focused and thus holds no configurations, or if no sample is fault tolerant.
    pub fn dexterity(
        &self,
        robot: &Robot,
        limits: &ArtificialLimits,
        failures: &FailureSet,
        most_poses: u64,
    ) -> Option<Dexterity> {
        if self.is_focused {
            return None;
        }
        let arm = Arm::new(robot, self.plan().task)?;
        let limits = self.limits(limits, failures, Rule::Definition);
        let tolerant = self.tolerant(&limits);
        let every = (tolerant.len() as u64).div_ceil(most_poses.max(1)).max(1);
        let picked: Vec<_> = tolerant.into_iter().step_by(every as usize).collect();
        let best: Vec<(f64, [f64; 2])> = picked
            .par_iter()
            .filter_map(|(shard, index, set)| {
                let view = BlockView::new(self.shards[*shard].block())?;
                let pose = &view.poses[*index];
                let best = best_of(&limits, set, &candidates(&arm, &limits, &view, pose))?;
                Some((pose.weight * set.measure(), best))
            })
            .collect();
        let mean = |k: usize| mean(best.iter().map(|(weight, best)| (*weight, best[k])));
        (!best.is_empty()).then(|| Dexterity {
            poses: best.len() as u64,
            null_component: mean(0),
            inverse_condition: mean(1),
        })
    }

    /// All fault-tolerant samples: shard, place in it, rotation set.
    fn tolerant(&self, limits: &Limits16) -> Vec<(usize, usize, AngleSet)> {
        let shards: Vec<Vec<_>> = self
            .views()
            .enumerate()
            .map(|(shard, view)| {
                let sets = (0..view.poses.len()).map(|k| (shard, k, limits.rotation_set(&view, k)));
                sets.filter(|(_, _, set)| set.measure() > 0.0).collect()
            })
            .collect();
        shards.into_iter().flatten().collect()
    }
}

/// The configurations of a sample inside the limits of the joints from 2 on.
fn candidates(arm: &Arm, limits: &Limits16, view: &BlockView, pose: &PoseRecord) -> Vec<Candidate> {
    let mut found = Vec::new();
    let mut theta = vec![0.0; view.joints];
    for piece in view.pieces(pose) {
        limits.rest.walk(piece, view.joints, |_, part, from, to| {
            let way = |k: usize| f64::from(to[k].wrapping_sub(from[k]) as i16) * STEP;
            let length: f64 = (0..theta.len()).map(|k| way(k) * way(k)).sum();
            let steps = ((part[1] - part[0]) * length.sqrt() / SPACING).ceil() as usize;
            for step in 0..=steps {
                let u = part[0] + (part[1] - part[0]) * step as f64 / steps.max(1) as f64;
                for (k, value) in theta.iter_mut().enumerate() {
                    *value = angle(from[k]) + u * way(k);
                }
                found.push((theta[0], arm.measures(&theta)));
            }
        });
    }
    found
}

/// The greatest measures over the configurations that joint 1 allows, mean over the rotations.
fn best_of(limits: &Limits16, set: &AngleSet, candidates: &[Candidate]) -> Option<[f64; 2]> {
    let turns = match limits.is_free_of_joint_1() {
        true => vec![0.0],
        false => spread(set),
    };
    let best_at = |turn: f64| {
        let allowed = candidates.iter().filter(|(first, _)| {
            // The 16-bit angles at an end of A₁ lie up to a step beyond it.
            limits.first.contains_within(first + turn, STEP)
        });
        allowed
            .map(|(_, measures)| *measures)
            .reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])])
    };
    let found: Vec<[f64; 2]> = turns.into_iter().filter_map(best_at).collect();
    let mean = |k: usize| found.iter().map(|best| best[k]).sum::<f64>() / found.len() as f64;
    (!found.is_empty()).then(|| [mean(0), mean(1)])
}

/// Angles spread evenly over a set.
fn spread(set: &AngleSet) -> Vec<f64> {
    let each = set.measure() / TURNS as f64;
    let mut next = 0.5 * each;
    let mut angles = Vec::with_capacity(TURNS);
    for arc in set.arcs() {
        while next <= arc.width() {
            angles.push(arc.start() + next);
            next += each;
        }
        next -= arc.width();
    }
    angles
}

/// Weighted mean with its standard error.
fn mean(values: impl Iterator<Item = (f64, f64)> + Clone) -> Estimate {
    let count = values.clone().count() as f64;
    let total: f64 = values.clone().map(|(weight, _)| weight).sum();
    let value = values.clone().map(|(weight, x)| weight * x).sum::<f64>() / total;
    let square: f64 = values.map(|(w, x)| (w * (x - value)).powi(2)).sum();
    let widened = count / (count - 1.0).max(1.0);
    Estimate {
        value,
        error: (widened * square).sqrt() / total,
    }
}

/// The robot with its base at joint 1 and lengths made comparable to angles.
struct Arm {
    chain: Chain,
    task: TaskSpace,
    reach: f64,
}

impl Arm {
    fn new(robot: &Robot, task: TaskSpace) -> Option<Arm> {
        let mut chain = Chain::new(robot)?;
        chain.base = Isometry3::identity();
        let reach = workspace_extent(robot)?.reach.max(1e-12);
        Some(Arm { chain, task, reach })
    }

    /// The least row norm of a null-space basis and 1/cond J; 0 where J loses rank.
    fn measures(&self, theta: &[f64]) -> [f64; 2] {
        let mut jacobian = Differential::new(&self.chain, self.task, theta).jacobian();
        let positions = if self.task.is_planar() { 2 } else { 3 };
        for row in 0..positions {
            jacobian.row_mut(row).unscale_mut(self.reach);
        }
        let eigen = (&jacobian * jacobian.transpose()).symmetric_eigen();
        let (least, most) = (eigen.eigenvalues.min(), eigen.eigenvalues.max());
        if least <= SINGULAR * most {
            return [0.0; 2];
        }
        // Row norms of the null space are what the row space leaves of unit vectors:
        // 1 − Σ (u_k · J_j)² / λ_k.
        let along = eigen.eigenvectors.tr_mul(&jacobian);
        let left = |joint: usize| {
            let column = along.column(joint);
            let terms = column.iter().zip(eigen.eigenvalues.iter());
            1.0 - terms.map(|(c, lambda)| c * c / lambda).sum::<f64>()
        };
        let weakest = (0..theta.len()).map(left).fold(1.0, f64::min);
        [weakest.max(0.0).sqrt(), (least / most).sqrt()]
    }
}
