//! To which workspaces one task point belongs, by the definition.

use super::arm::{Angles, Arm, Bounds, Goal};
use super::limits::{Lock, Prepared, lock_order, random_start};
use super::solve::solve;
use crate::angle::wrap;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// Halvings of the distance between two locks that no branch of solutions joins.
const HALVINGS: u32 = 4;
/// Largest change of a joint, radians, between two neighbouring locks on one branch, beyond the
/// change of the locked joint.
const BRANCH: f64 = 0.3;

/// The workspaces that a task point belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Verdict {
    /// S_0max.
    pub is_reachable: bool,
    /// W₀.
    pub is_inside: bool,
    /// W_F.
    pub is_tolerant: bool,
}

/// A solved lock.
type Solved = (Lock, Angles);

/// One task point while it is judged.
pub(super) struct Judge<'a, const M: usize> {
    pub arm: &'a Arm,
    pub prepared: &'a Prepared,
    pub goal: Goal,
    pub spacing: f64,
    /// Failures in a row after which a configuration is held not to exist.
    pub starts: usize,
    pub rng: ChaCha8Rng,
    /// Locks solved so far: the nearest of them are the first starts of the next.
    pub solved: Vec<Solved>,
}

impl<const M: usize> Judge<'_, M> {
    pub fn verdict(&mut self) -> Verdict {
        let mut verdict = Verdict::default();
        let Some(free) = self.search(&self.arm.physical.clone()) else {
            return verdict;
        };
        verdict.is_reachable = true;
        let prepared = self.prepared;
        let from_free = self.solve(&free, &prepared.inside);
        verdict.is_inside = from_free
            .or_else(|| self.search(&prepared.inside))
            .is_some();
        if verdict.is_inside {
            verdict.is_tolerant = self.survives_all_locks();
        }
        verdict
    }

    fn solve(&self, start: &Angles, bounds: &Bounds) -> Option<Angles> {
        solve::<M>(self.arm, &self.goal, start, bounds)
    }

    /// From random starts within `bounds`.
    fn search(&mut self, bounds: &Bounds) -> Option<Angles> {
        for _ in 0..self.starts {
            let start = random_start(self.arm, bounds, &mut self.rng);
            let found = self.solve(&start, bounds);
            if found.is_some() {
                return found;
            }
        }
        None
    }

    fn survives_all_locks(&mut self) -> bool {
        let order = lock_order(self.prepared, self.spacing, &mut self.rng);
        order.iter().all(|lock| self.lock(*lock).is_some()) && self.has_no_gaps()
    }

    /// A configuration with the joint locked: from near solved locks, then from random starts.
    fn lock(&mut self, lock: Lock) -> Option<Angles> {
        let mut bounds = self.arm.physical;
        bounds[lock.joint] = [lock.value; 2];
        let near = self.nearest(lock);
        let continued = near.iter().find_map(|start| self.solve(start, &bounds));
        let found = continued.or_else(|| self.search(&bounds))?;
        self.solved.push((lock, found));
        Some(found)
    }

    /// For every joint the solution of one of its locks that is nearest to `lock`, nearest first.
    fn nearest(&self, lock: Lock) -> Vec<Angles> {
        let mut nearest = vec![(f64::INFINITY, 0); self.arm.joints()];
        for (index, (other, theta)) in self.solved.iter().enumerate() {
            let distance = self.distance(lock.joint, theta[lock.joint], lock.value);
            if distance < nearest[other.joint].0 {
                nearest[other.joint] = (distance, index);
            }
        }
        nearest.retain(|(distance, _)| distance.is_finite());
        nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
        nearest
            .iter()
            .map(|(_, index)| self.solved[*index].1)
            .collect()
    }

    fn distance(&self, joint: usize, a: f64, b: f64) -> f64 {
        match self.arm.turns(joint) {
            true => wrap(a - b).abs(),
            false => (a - b).abs(),
        }
    }

    /// Looks closer between neighbouring locks whose solutions lie on different branches: where one
    /// ends before the other begins, the joint's range has a gap.
    fn has_no_gaps(&mut self) -> bool {
        let prepared = self.prepared;
        prepared.locks.iter().all(|&(joint, [_, high])| {
            let own = self.solved.iter().filter(|(lock, _)| lock.joint == joint);
            let mut own: Vec<Solved> = own.copied().collect();
            own.sort_by(|a, b| a.0.value.total_cmp(&b.0.value));
            if let (false, Some((lock, theta))) = (high.is_finite(), own.first().copied()) {
                let value = lock.value + TAU;
                own.push((Lock { joint, value }, theta));
            }
            own.windows(2)
                .all(|pair| self.is_bridged(&pair[0], &pair[1], HALVINGS))
        })
    }

    fn is_bridged(&mut self, a: &Solved, b: &Solved, halvings: u32) -> bool {
        if halvings == 0 || self.leads(a, b.0) || self.leads(b, a.0) {
            return true;
        }
        let middle = Lock {
            joint: a.0.joint,
            value: 0.5 * (a.0.value + b.0.value),
        };
        let Some(theta) = self.lock(middle) else {
            return false;
        };
        let middle = (middle, theta);
        self.is_bridged(a, &middle, halvings - 1) && self.is_bridged(&middle, b, halvings - 1)
    }

    /// Whether the branch of a solved lock goes on to another lock.
    fn leads(&self, from: &Solved, to: Lock) -> bool {
        let mut bounds = self.arm.physical;
        bounds[to.joint] = [to.value; 2];
        let allowed = BRANCH + (to.value - from.0.value).abs();
        self.solve(&from.1, &bounds).is_some_and(|theta| {
            let joints = 0..self.arm.joints();
            joints
                .map(|j| self.distance(j, theta[j], from.1[j]))
                .all(|moved| moved <= allowed)
        })
    }
}
