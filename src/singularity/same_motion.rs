//! Singular configurations that self-motion leads into each other are one.
//!
//! Two members of a family with free directions, found from two starts, share a location with
//! probability 0. Members of families without any, such as planar arms with their links in line,
//! can: turned about joint 1 (or the tool) they may lie on one connected set of manifolds.

use super::catalogue::{Catalogue, symmetric_joints};
use super::location::{ConnectedSet, Location, LocationSearch, apart};
use super::stratum::Arm;
use crate::sampling::stream;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// More isolated configurations than this are left as they are: pairs would take too long.
const MOST: usize = 60;
/// Starts of the alignment, per joint that may turn.
const STARTS: usize = 6;
/// Poses nearer than this are one, metres and radians.
const SAME: f64 = 1e-8;

impl Catalogue {
    /// Joins singular configurations that lie on one connected set of self-motion manifolds once
    /// joint 1, and for poses the last joint, are turned.
    pub fn merge_self_motion(&mut self, search: &mut LocationSearch, seed: u64) {
        let symmetric = symmetric_joints(&search.arm());
        let isolated = |index: &usize| {
            let family = &self.families[self.singularities[*index].family];
            family.dimension <= symmetric.len()
        };
        let own: Vec<usize> = (0..self.singularities.len()).filter(isolated).collect();
        if own.len() > MOST {
            return;
        }
        let mut gone: Vec<usize> = Vec::new();
        for (place, &first) in own.iter().enumerate() {
            if gone.contains(&first) {
                continue;
            }
            let mut location: Option<Location> = None;
            for &second in &own[place + 1..] {
                let (a, b) = (&self.singularities[first], &self.singularities[second]);
                if gone.contains(&second) || a.loss != b.loss {
                    continue;
                }
                let Some(turned) = aligned(&search.arm(), &symmetric, &b.theta, &a.theta) else {
                    continue;
                };
                let known = [a.theta.clone(), turned.clone()];
                let tool = search.arm().chain.tool(&a.theta);
                let location = location
                    .get_or_insert_with(|| search.explore(&tool, &known, &mut stream(seed, 9)));
                let joined = |set: &ConnectedSet| {
                    holds(location, set, &a.theta) && holds(location, set, &turned)
                };
                if location.sets.iter().any(joined) {
                    gone.push(second);
                    let hits = self.singularities[second].hits;
                    self.singularities[first].hits += hits;
                }
            }
        }
        self.drop(&gone);
    }

    /// Leaves out some singular configurations, and families that have none left.
    fn drop(&mut self, gone: &[usize]) {
        let mut kept = Vec::new();
        for (index, singularity) in std::mem::take(&mut self.singularities)
            .into_iter()
            .enumerate()
        {
            if !gone.contains(&index) {
                kept.push(singularity);
            }
        }
        let families = std::mem::take(&mut self.families);
        for (old, mut family) in families.into_iter().enumerate() {
            let members = kept.iter().filter(|s| s.family == old);
            let (count, hits) = members.fold((0, 0), |(n, hits), s| (n + 1, hits + s.hits));
            if count == 0 {
                continue;
            }
            (family.members, family.hits) = (count, hits);
            let new = self.families.len();
            self.families.push(family);
            for singularity in kept.iter_mut().filter(|s| s.family == old) {
                singularity.family = new;
            }
        }
        self.singularities = kept;
    }
}

/// Whether a configuration lies on a connected set: at one of its nodes, or on a surface.
fn holds(location: &Location, set: &ConnectedSet, theta: &[f64]) -> bool {
    let near = |k: &usize| apart(&location.nodes[*k].theta, theta) < 5e-3;
    let on = |k: &usize| location.surfaces[*k].holds(theta);
    set.nodes.iter().any(near) || set.surfaces.iter().any(on)
}

/// `theta` with the joints `free` turned such that the tool is where `goal` has it; `None` if no
/// turn does that.
fn aligned(arm: &Arm, free: &[usize], theta: &[f64], goal: &[f64]) -> Option<Vec<f64>> {
    let tool = arm.chain.tool(goal);
    let starts = STARTS.pow(free.len() as u32);
    (0..starts).find_map(|start| {
        let mut turned = theta.to_vec();
        let mut rest = start;
        for &joint in free {
            turned[joint] += TAU * (rest % STARTS) as f64 / STARTS as f64;
            rest /= STARTS;
        }
        for _ in 0..12 {
            let miss = arm.difference(&tool, &arm.chain.tool(&turned));
            let miss = DVector::from_vec(miss);
            if miss.norm() < SAME {
                return Some(turned);
            }
            let columns = arm.at(&turned).jacobian().select_columns(free);
            let gram = columns.tr_mul(&columns) + DMatrix::identity(free.len(), free.len()) * 1e-12;
            let step = gram.cholesky()?.solve(&columns.tr_mul(&miss));
            for (&joint, change) in free.iter().zip(step.iter()) {
                turned[joint] -= change.clamp(-0.8, 0.8);
            }
        }
        None
    })
}
