//! How much of a robot's merit is lost where it is not built as drawn.
//!
//! Every constant and every end of the limits is moved by a tolerance either way and the merit
//! measured again on the same task points, so that the difference is known far better than the
//! merit. A few independent sets of points give its standard error.

use super::arm::Arm;
use super::assessment::{DesignProblem, Draft, Look};
use super::link_space::{Column, Constants, LinkSpace, Links};
use super::seeds::{Purpose, sample_seed};
use crate::workspace::{ArtificialLimits, Estimate, JointLimit};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// What is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Perturbed {
    /// A constant of a row (from 0).
    Link(usize, Column),
    /// The lower limit of a joint (from 0).
    Lower(usize),
    /// The upper limit of a joint (from 0).
    Upper(usize),
}

/// Change of the merit when one number is off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterSensitivity {
    /// What is moved.
    pub what: Perturbed,
    /// By how much, radians or reaches.
    pub tolerance: f64,
    /// Change of the merit for a value too small and one too large.
    pub change: [Estimate; 2],
}

/// Tolerances of a workshop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Of lengths and offsets, in reaches.
    pub length: f64,
    /// Of twists and limits, radians.
    pub angle: f64,
}

/// Independent sets of task points.
const SETS: u32 = 4;

impl DesignProblem {
    /// The change of the merit for every constant and limit of `draft`, from `samples` task points.
    pub fn sensitivity(
        &self,
        draft: &Draft,
        tolerances: Tolerances,
        samples: u32,
        seed: u64,
    ) -> Vec<ParameterSensitivity> {
        let jobs = self.jobs(draft, tolerances);
        let look = |set: u32| Look {
            samples: (samples / SETS).max(64),
            seed: sample_seed(seed, Purpose::Sensitivity, u64::from(set)),
            replicates: 1,
        };
        let merit = |links: &Links, limits: &ArtificialLimits, set: u32| {
            let measured = self.measured_as_built(links, limits, look(set));
            measured.map_or(0.0, |measures| measures.merit(self.merit).value)
        };
        let base: Vec<f64> = (0..SETS)
            .map(|set| merit(&draft.links, &draft.limits, set))
            .collect();
        let change = |(links, limits): &(Links, ArtificialLimits)| {
            let each = (0..SETS).map(|set| merit(links, limits, set) - base[set as usize]);
            mean(&each.collect::<Vec<f64>>())
        };
        jobs.par_iter()
            .map(|(what, tolerance, pair)| ParameterSensitivity {
                what: *what,
                tolerance: *tolerance,
                change: pair.each_ref().map(change),
            })
            .collect()
    }

    /// Merits of a robot that need not keep to the bounds.
    fn measured_as_built(
        &self,
        links: &Links,
        limits: &ArtificialLimits,
        look: Look,
    ) -> Option<super::Measures> {
        let arm = Arm::of_links(&self.links, links)?;
        let atlas = self.atlas(&arm, look, Some(limits))?;
        Some(self.measures(&arm, &atlas, limits))
    }

    fn jobs(&self, draft: &Draft, tolerances: Tolerances) -> Vec<Job> {
        let mut jobs = Vec::new();
        let idle = LinkSpace::idle(draft.links.len(), self.task());
        for row in 0..draft.links.len() {
            for column in [Column::Twist, Column::Length, Column::Offset] {
                if idle.contains(&(row, column)) {
                    continue;
                }
                let tolerance = match column {
                    Column::Twist => tolerances.angle,
                    _ => tolerances.length,
                };
                let built = [-tolerance, tolerance].map(|off| {
                    let mut links = draft.links.clone();
                    let constants: &mut Constants = &mut links[row];
                    *constants.get_mut(column) += off;
                    (links, draft.limits.clone())
                });
                jobs.push((Perturbed::Link(row, column), tolerance, built));
            }
        }
        for (joint, limit) in draft.limits.joints().iter().enumerate() {
            if limit.is_full() {
                continue;
            }
            for upper in [false, true] {
                let built = [-tolerances.angle, tolerances.angle].map(|off| {
                    (
                        draft.links.clone(),
                        with_end(&draft.limits, joint, upper, off),
                    )
                });
                let what = match upper {
                    false => Perturbed::Lower(joint),
                    true => Perturbed::Upper(joint),
                };
                jobs.push((what, tolerances.angle, built));
            }
        }
        jobs
    }
}

type Job = (Perturbed, f64, [(Links, ArtificialLimits); 2]);

/// `limits` with one end of one joint's moved; widths stay at least 0.
fn with_end(limits: &ArtificialLimits, joint: usize, upper: bool, off: f64) -> ArtificialLimits {
    let mut joints: Vec<JointLimit> = limits.joints().to_vec();
    let [mut low, mut high] = [joints[joint].lower, joints[joint].upper];
    match upper {
        false => low = (low + off).min(high),
        true => high = (high + off).max(low),
    }
    joints[joint] = JointLimit::new(low, high);
    ArtificialLimits::new(joints)
}

fn mean(values: &[f64]) -> Estimate {
    let count = values.len() as f64;
    let value = values.iter().sum::<f64>() / count;
    let square: f64 = values.iter().map(|v| (v - value).powi(2)).sum();
    Estimate {
        value,
        error: (square / (count * (count - 1.0).max(1.0))).sqrt(),
    }
}
