//! Rotation sets of one sample for given artificial limits: the definition, by interval
//! arithmetic on the packed pre-image.
//!
//! With A the limits, Θ the ranges and M the pre-image of the sample x at azimuth 0 [S4 §III.C]:
//! - joint i ≥ 2 locked: A_i ⊂ Θ_i, whatever β;
//! - joint 1 locked: B₁ = { β : A₁ − β ⊂ Θ₁ };
//! - a margin m enlarges the A_i of these two conditions alone: a joint may lock that far beyond;
//! - before a failure: B₀ = A₁ − T with T the θ₁-image of M inside A₂ × … × A_n;
//! - B = B₀ ∩ B₁ if every i ≥ 2 passes.
//!
//! Where joint 1 slides there is no β: a sample stands for itself, joint 1 is a joint like the others,
//! and B is everything or nothing.
//!
//! The papers take one minimum and maximum of θ₁ per manifold for T, which over-counts where a
//! manifold leaves the box and returns; [`Rule::Paper`] does so for comparison.

use super::block::{BlockView, PoseRecord};
use super::clip::Box16;
use super::first_joint::survives_any_lock;
use super::runs::{Runs, arc, image};
use super::turn16::{Arc16, angle_set};
use crate::angle::{AngleSet, Arc};
use crate::workspace::{ArtificialLimits, FailureSet};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// How T is formed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rule {
    /// The set itself: the union of segments.
    #[default]
    Definition,
    /// One interval of θ₁ per manifold [S4 eqs. 16, 17].
    Paper,
}

/// Artificial limits prepared for scoring.
#[derive(Clone, Debug)]
pub(super) struct Limits16 {
    /// Where every joint may lock: its limits, enlarged by the margin.
    pub locks: Vec<Arc16>,
    /// A₁, exactly.
    pub first: Arc,
    /// Where joint 1 may lock, exactly.
    pub first_lock: Arc,
    /// Margin beyond the limits, radians.
    pub margin: f64,
    /// The box of the other joints; of all, where a sample stands for itself.
    pub rest: Box16,
    /// Whether a sample stands for its circle about joint 1's axis.
    turns: bool,
    /// Which joints may lock.
    pub prone: Vec<bool>,
    pub rule: Rule,
    /// Physical limits of joint 1, if it has any.
    physical: Option<Physical>,
}

/// Physical limits of joint 1 with what their test needs.
#[derive(Clone, Debug)]
struct Physical {
    allowed: Arc,
    /// Everything else.
    gap: Arc,
    slabs: Vec<f64>,
}

impl Limits16 {
    /// `slabs` is half the distance between slices along every joint: a slice stands for that
    /// much to either side, so the box is widened by it. `physical` holds the physical limits of
    /// every joint, inside which `limits` lie. `turns` tells that a sample stands for its circle.
    pub fn new(
        limits: &ArtificialLimits,
        failures: &FailureSet,
        rule: Rule,
        (slabs, physical): (&[f64], &[Arc]),
        turns: bool,
    ) -> Limits16 {
        let margin = failures.margin();
        let locks = limits.joints().iter().zip(physical);
        let locks: Vec<Arc> = locks
            .map(|(limit, physical)| limit.enlarged_within(margin, physical).arc())
            .collect();
        let first = limits
            .joints()
            .first()
            .map_or(Arc::FULL, |limit| limit.arc());
        let widened = limits.joints().iter().zip(slabs).map(|(limit, slab)| {
            let arc = limit.arc();
            Arc16::nearest(&Arc::new(arc.start() - slab, arc.width() + 2.0 * slab))
        });
        let rest = Box16::new(widened.enumerate().skip(usize::from(turns)));
        Limits16 {
            prone: (1..=locks.len())
                .map(|joint| failures.contains(joint))
                .collect(),
            first_lock: locks.first().copied().unwrap_or(Arc::FULL),
            locks: locks.iter().map(Arc16::nearest).collect(),
            first,
            margin,
            rest,
            turns,
            rule,
            physical: physical
                .first()
                .filter(|arc| turns && !arc.is_full())
                .map(|&arc| Physical {
                    allowed: arc,
                    gap: Arc::new(arc.end(), TAU - arc.width()),
                    slabs: slabs.to_vec(),
                }),
        }
    }

    /// Rotation angles at which the sample is reached with all joints inside their physical
    /// limits; `range` is Θ₁.
    pub fn unrestricted(&self, range: &[Arc16]) -> AngleSet {
        match &self.physical {
            None => AngleSet::full(),
            Some(physical) => angle_set(range).mirrored().sum(&physical.allowed),
        }
    }

    /// Rotation angles at which a lock of `joint` ≥ 2 (from 0) is survived, A ⊂ Θ being known.
    pub fn lock_of(&self, view: &BlockView, pose: &PoseRecord, joint: usize) -> AngleSet {
        match &self.physical {
            None => AngleSet::full(),
            Some(physical) => survives_any_lock(
                view,
                pose,
                joint,
                self.locks[joint],
                &physical.gap,
                physical.slabs[joint],
            ),
        }
    }

    /// The part of `set` that also survives physical limits of joint 1.
    fn with_physical(&self, set: AngleSet, view: &BlockView, pose: &PoseRecord) -> AngleSet {
        if self.physical.is_none() {
            return set;
        }
        let joints = (1..self.locks.len()).filter(|&joint| self.prone[joint]);
        joints.fold(set, |set, joint| {
            if set.is_empty() {
                set
            } else {
                set.intersection(&self.lock_of(view, pose, joint))
            }
        })
    }

    /// Whether the sample survives a lock of any joint i ≥ 2 that may lock.
    #[inline]
    pub fn survives_locks<'r>(&self, mut ranges: impl Iterator<Item = &'r [Arc16]>) -> bool {
        let first = ranges.next().unwrap_or_default();
        if !self.first_fits(first) {
            return false;
        }
        self.locks[1..]
            .iter()
            .zip(&self.prone[1..])
            .zip(ranges)
            .all(|((limit, prone), range)| !prone || covers(range, *limit))
    }

    /// Whether some β lets all angles at which joint 1 may lock lie in Θ₁, or joint 1 does not lock.
    #[inline]
    pub fn first_fits(&self, range: &[Arc16]) -> bool {
        !self.prone[0]
            || match self.turns {
                true => fits_somewhere(self.locks[0], range),
                false => covers(range, self.locks[0]),
            }
    }

    /// T: the θ₁ values of the pre-image inside the limits of the other joints.
    pub fn image(&self, view: &BlockView, pose: &PoseRecord) -> AngleSet {
        match self.rule {
            Rule::Definition => image(&self.rest, view.strands(pose)),
            Rule::Paper => AngleSet::from_arcs(view.pieces(pose).filter_map(|piece| {
                let runs = Runs::of(&self.rest, piece, view.joints);
                around(&runs.all).map(|run| arc(&run))
            })),
        }
    }

    /// B₁ if joint 1 may lock, else all angles.
    fn after_lock_of_1(&self, range: &[Arc16]) -> AngleSet {
        if self.prone[0] {
            self.lock_of_1(range)
        } else {
            AngleSet::full()
        }
    }

    /// B₁, with Θ₁ the range of joint 1.
    pub fn lock_of_1(&self, range: &[Arc16]) -> AngleSet {
        if !self.turns {
            return all_or_nothing(covers(range, self.locks[0]));
        }
        // β passes if A₁ − β ⊂ Θ₁: the mirror image of the erosion of Θ₁ by A₁.
        angle_set(range).erosion(&self.first_lock).mirrored()
    }

    /// B₀, with T the image.
    pub fn before_failure(&self, image: &AngleSet) -> AngleSet {
        if !self.turns {
            return all_or_nothing(!image.is_empty());
        }
        image.mirrored().sum(&self.first)
    }

    /// B of pose `index`.
    pub fn rotation_set(&self, view: &BlockView, index: usize) -> AngleSet {
        if !self.survives_locks(view.ranges(index)) {
            return AngleSet::empty();
        }
        let pose = &view.poses[index];
        if self.is_free_of_joint_1() {
            return all_or_nothing(self.is_ever_inside(view, pose));
        }
        let before = self.before_failure(&self.image(view, pose));
        let after = self.after_lock_of_1(view.ranges(index).next().unwrap_or_default());
        self.with_physical(before.intersection(&after), view, pose)
    }

    /// |B| of pose `index`.
    pub fn measure(&self, view: &BlockView, index: usize) -> f64 {
        if self.physical.is_some() {
            return self.rotation_set(view, index).measure();
        }
        if !self.survives_locks(view.ranges(index)) {
            return 0.0;
        }
        let pose = &view.poses[index];
        if self.is_free_of_joint_1() {
            return if self.is_ever_inside(view, pose) {
                TAU
            } else {
                0.0
            };
        }
        let before = self.before_failure(&self.image(view, pose));
        let after = self.after_lock_of_1(view.ranges(index).next().unwrap_or_default());
        before.overlap(&after)
    }

    /// Whether B is all or nothing: joint 1 may turn freely (if it may lock, the test of
    /// [`Limits16::survives_locks`] has found Θ₁ full), or there is nothing to turn.
    pub fn is_free_of_joint_1(&self) -> bool {
        !self.turns || self.first.is_full()
    }

    /// Whether any part of the pre-image lies in the box of the joints from 2 on.
    pub fn is_ever_inside(&self, view: &BlockView, pose: &PoseRecord) -> bool {
        self.rest.is_everything() && pose.pieces > 0
            || view.strands(pose).any(|strand| self.rest.meets(strand))
    }
}

fn all_or_nothing(all: bool) -> AngleSet {
    match all {
        true => AngleSet::full(),
        false => AngleSet::empty(),
    }
}

/// Whether one of the arcs holds all of `limit`.
#[inline]
pub(super) fn covers(range: &[Arc16], limit: Arc16) -> bool {
    range.iter().any(|arc| arc.covers(limit))
}

/// Whether one of the arcs is as wide as `limit`, wherever that lies.
#[inline]
fn fits_somewhere(limit: Arc16, range: &[Arc16]) -> bool {
    range
        .iter()
        .any(|arc| arc.is_full() || arc.width >= limit.width && !limit.is_full())
}

/// One interval around all parts of a manifold, as the papers have it.
///
/// The papers unwrap θ₁ along the manifold; parts are given modulo a turn, so they are laid out
/// next to the first one.
fn around(runs: &[[f64; 2]]) -> Option<[f64; 2]> {
    const TURN: f64 = 65_536.0;
    let first = *runs.first()?;
    let mut around = first;
    for run in &runs[1..] {
        let shift = ((first[0] - run[0]) / TURN).round() * TURN;
        around = [around[0].min(run[0] + shift), around[1].max(run[1] + shift)];
    }
    Some(around)
}
