//! Singular configurations of all ranks from many starts [S1 Algorithm 1], each once.
//!
//! Turning joint 1 moves the whole arm and changes no rank; for tasks with an orientation the last
//! joint turns the tool alone and changes none either. These joints do not tell configurations
//! apart. Singular configurations come in families, smooth sets with a dimension: those of a
//! spherical wrist in line fill one of dimension n − 1. Members of one family found from two starts
//! are different configurations as a rule; families have the counts that a reader wants.

use super::descent::{Descent, DescentSettings, DescentStatus, descend};
use super::stratum::{Arm, SINGULAR};
use crate::angle::{Arc, wrap};
use crate::design::TaskSpace;
use crate::kinematics::ChainJoint;
use crate::sampling::stream;
use rand::Rng;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

/// How singular configurations are searched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingularitySettings {
    /// Random starts N.
    pub starts: usize,
    /// Greatest rank loss that is looked for; the search ends earlier where no start reaches one.
    pub max_loss: usize,
    /// Configurations nearer to each other than this are one, radians (the root of the sum of
    /// squares over joints that tell configurations apart).
    pub merge: f64,
    /// How each descent runs.
    pub descent: DescentSettings,
}

impl Default for SingularitySettings {
    fn default() -> SingularitySettings {
        SingularitySettings {
            starts: 200,
            max_loss: 3,
            merge: 1e-3,
            descent: DescentSettings::default(),
        }
    }
}

/// A singular configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Singularity {
    /// n internal joint variables, revolute ones in [−π, π).
    pub theta: Vec<f64>,
    /// By how much J falls short of rank m there.
    pub loss: usize,
    /// Singular values, greatest first.
    pub sigma: Vec<f64>,
    /// Starts that ended there.
    pub hits: usize,
    /// Index of its family.
    pub family: usize,
}

/// Singular configurations that can be moved into each other without leaving the rank.
#[derive(Clone, Debug, PartialEq)]
pub struct SingularFamily {
    /// By how much J falls short of rank m.
    pub loss: usize,
    /// In how many directions a member can be moved, symmetries among them.
    pub dimension: usize,
    /// Joints (from 0) that stand still throughout, with their values in [−π, π); a joint's value
    /// π stands for −π.
    pub held: Vec<(usize, f64)>,
    /// Starts that ended in it.
    pub hits: usize,
    /// Different members found.
    pub members: usize,
}

/// How the descents to one rank ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RankTally {
    /// The rank loss aimed at.
    pub loss: usize,
    /// Descents that reached it, or more.
    pub singular: usize,
    /// Those that ended in a local minimum of the singular value.
    pub local_minimum: usize,
    /// Those that were given up.
    pub too_many_steps: usize,
}

/// What the descents found.
#[derive(Clone, Debug, PartialEq)]
pub struct Catalogue {
    /// Different singular configurations, least rank loss first, in the order of their starts.
    pub singularities: Vec<Singularity>,
    /// Their families, least rank loss first, the most frequent first.
    pub families: Vec<SingularFamily>,
    /// How the descents ended, one entry for each rank loss tried.
    pub tallies: Vec<RankTally>,
    /// Every descent that reached a singular configuration: start, rank loss aimed at, and
    /// configuration.
    pub reached: Vec<(usize, usize, Vec<f64>)>,
}

/// Which joints do not tell singular configurations apart.
pub(super) fn symmetric_joints(arm: &Arm) -> Vec<usize> {
    let joints = &arm.chain.joints;
    let turns = |joint: usize| joints[joint].turn != 0.0;
    let oriented = matches!(arm.task, TaskSpace::PlanarPose | TaskSpace::SpatialPose);
    let last = joints.len() - 1;
    let mut symmetric = Vec::new();
    symmetric.extend(Some(0).filter(|&j| turns(j)));
    symmetric.extend(Some(last).filter(|&j| oriented && last > 0 && turns(j)));
    symmetric
}

/// The configuration of start number `start`: uniform on circles and strokes, and within
/// `physical` limits (arcs of internal variables, one per joint).
pub fn random_configuration(arm: &Arm, physical: &[Arc], seed: u64, start: usize) -> Vec<f64> {
    let mut rng = stream(seed, start as u64);
    let joints = arm.chain.joints.iter().zip(physical);
    let draw = |(joint, arc): (&ChainJoint, &Arc)| {
        let half = if joint.turn == 0.0 { FRAC_PI_2 } else { PI };
        let angle = rng.random_range(-half..half);
        match joint.turn == 0.0 || arc.is_full() {
            true => angle,
            false => arc.start() + arc.width() * (0.5 + 0.5 * angle / PI),
        }
    };
    joints.map(draw).collect()
}

/// Finds singular configurations from random starts within `physical` limits, one stream of `seed`
/// each. Descents may leave the limits.
pub fn find_singularities(
    arm: &Arm,
    physical: &[Arc],
    settings: &SingularitySettings,
    seed: u64,
) -> Catalogue {
    let mut catalogue = Catalogue {
        singularities: Vec::new(),
        families: Vec::new(),
        tallies: Vec::new(),
        reached: Vec::new(),
    };
    for loss in 1..=settings.max_loss.min(arm.task.dimension()) {
        let run = |start: usize| {
            let theta = random_configuration(arm, physical, seed, start);
            descend(arm, &theta, loss, &settings.descent)
        };
        let ends: Vec<Descent> = (0..settings.starts).into_par_iter().map(run).collect();
        let mut tally = RankTally {
            loss,
            ..RankTally::default()
        };
        for (start, end) in ends.into_iter().enumerate() {
            match end.status {
                DescentStatus::Singular => {
                    tally.singular += 1;
                    catalogue.reached.push((start, loss, end.theta.clone()));
                    catalogue.add(arm, end.theta, settings.merge);
                }
                DescentStatus::LocalMinimum => tally.local_minimum += 1,
                DescentStatus::TooManySteps => tally.too_many_steps += 1,
            }
        }
        catalogue.tallies.push(tally);
        if tally.singular == 0 {
            break;
        }
    }
    catalogue.sort();
    catalogue
}

/// Held joints with equal values within this are the same, radians.
const SAME: f64 = 1e-5;

impl Catalogue {
    fn add(&mut self, arm: &Arm, theta: Vec<f64>, merge: f64) {
        let turns = |joint: usize| arm.chain.joints[joint].turn != 0.0;
        let wrapped = |(joint, value): (usize, &f64)| match turns(joint) {
            true => tidy(*value),
            false => *value,
        };
        let theta: Vec<f64> = theta.iter().enumerate().map(wrapped).collect();
        let sigma = arm.singular_values(&theta);
        let loss = sigma.iter().filter(|value| **value <= SINGULAR).count();
        let apart = telling_joints(arm);
        let is_same = |other: &&mut Singularity| {
            let square = |&joint: &usize| wrap(other.theta[joint] - theta[joint]).powi(2);
            other.loss == loss && apart.iter().map(square).sum::<f64>().sqrt() < merge
        };
        if let Some(known) = self.singularities.iter_mut().find(is_same) {
            known.hits += 1;
            self.families[known.family].hits += 1;
            return;
        }
        let family = self.family_of(arm, &theta, loss);
        self.families[family].hits += 1;
        self.families[family].members += 1;
        self.singularities.push(Singularity {
            theta,
            loss,
            sigma,
            hits: 1,
            family,
        });
    }

    /// The family of a configuration, a new one if need be.
    fn family_of(&mut self, arm: &Arm, theta: &[f64], loss: usize) -> usize {
        let free = arm.tangent_space(theta, loss);
        let still = |joint: &usize| free.row(*joint).norm() < 1e-4;
        let held: Vec<(usize, f64)> = (0..theta.len())
            .filter(still)
            .map(|joint| (joint, theta[joint]))
            .collect();
        let dimension = free.ncols();
        let known = |family: &SingularFamily| {
            let pairs = family.held.iter().zip(&held);
            let same =
                |(a, b): (&(usize, f64), &(usize, f64))| a.0 == b.0 && wrap(a.1 - b.1).abs() < SAME;
            family.loss == loss
                && family.dimension == dimension
                && family.held.len() == held.len()
                && pairs.into_iter().all(same)
        };
        if let Some(index) = self.families.iter().position(known) {
            return index;
        }
        self.families.push(SingularFamily {
            loss,
            dimension,
            held,
            hits: 0,
            members: 0,
        });
        self.families.len() - 1
    }

    fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.families.len()).collect();
        let key = |k: &usize| {
            let family = &self.families[*k];
            (family.loss, std::cmp::Reverse(family.hits))
        };
        order.sort_by_key(key);
        let mut place = vec![0; order.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old] = new;
        }
        self.families = order.iter().map(|&k| self.families[k].clone()).collect();
        for singularity in &mut self.singularities {
            singularity.family = place[singularity.family];
        }
        self.singularities
            .sort_by_key(|singularity| singularity.loss);
    }
}

/// Joints that tell singular configurations apart.
pub(super) fn telling_joints(arm: &Arm) -> Vec<usize> {
    let symmetric = symmetric_joints(arm);
    let all = 0..arm.chain.len();
    all.filter(|joint| !symmetric.contains(joint)).collect()
}

/// In [−π, π), without the round-off that puts one half turn on either side.
fn tidy(angle: f64) -> f64 {
    let wrapped = wrap(angle);
    if PI - wrapped < 1e-9 { -PI } else { wrapped }
}
