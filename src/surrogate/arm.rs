//! The planar arm that a surrogate stands for, and its exact workspaces: the labels.

use super::cell::Cell;
use crate::angle::AngleSet;
use crate::objective::Design;
use crate::workspace::planar::{
    LockedJoints, PlanarArm, PlanarPose, PlanarPosition, PoseResolution,
};
use crate::workspace::{ArtificialLimits, FailureSet};
use serde::{Deserialize, Serialize};
use std::cell::RefCell;

/// A planar arm with its task and failures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurrogateArm {
    /// Link lengths, metres, joint 1's first; where lengths vary, only their sum counts.
    pub lengths: Vec<f64>,
    /// Bounds of each link length, metres, if the surrogate is to know all of them.
    pub link_bounds: Option<Vec<[f64; 2]>>,
    /// Whether the task is a pose (four or five joints) rather than a position.
    pub pose: bool,
    /// Joints prone to failure.
    pub failures: FailureSet,
}

thread_local! {
    // Buffers only: a result never depends on what the thread computed before.
    static POSITION: RefCell<PlanarPosition> = RefCell::new(PlanarPosition::new());
    static POSE: RefCell<PlanarPose> = RefCell::new(PlanarPose::new(PoseResolution::coarse()));
}

impl SurrogateArm {
    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.lengths.len()
    }

    /// Whether the size depends on joint k's limits (k from 0) through their width alone: joint 1,
    /// and joint n of a pose task.
    pub fn is_centred(&self, k: usize) -> bool {
        k == 0 || (self.pose && k + 1 == self.joints())
    }

    /// The arm of fixed lengths with the given limits.
    pub fn design(&self, limits: ArtificialLimits) -> Design {
        Design {
            limits,
            lengths: self.lengths.clone(),
        }
    }

    fn view<'a>(&'a self, design: &'a Design) -> PlanarArm<'a> {
        PlanarArm {
            lengths: &design.lengths,
            limits: &design.limits,
            failures: &self.failures,
        }
    }

    /// S_F: exact for positions (m²), at the coarse resolution of a search for poses (m² rad).
    pub fn size(&self, design: &Design) -> f64 {
        let arm = self.view(design);
        let size = match self.pose {
            false => POSITION.with_borrow_mut(|p| p.fault_tolerant_size(arm)),
            true => POSE.with_borrow_mut(|p| p.fault_tolerant_size(arm).value),
        };
        if size.is_finite() { size } else { 0.0 }
    }

    /// S_0max of an arm with the given lengths.
    pub fn unrestricted_size(&self, lengths: &[f64]) -> f64 {
        match self.pose {
            false => PlanarPosition::unrestricted_size(lengths),
            true => PlanarPose::unrestricted_size(lengths),
        }
    }

    /// W₁ ∩ … ∩ W_n in closed form.
    pub fn locked_joints(&self, design: &Design) -> LockedJoints {
        match self.pose {
            false => LockedJoints::of_position(self.view(design)),
            true => LockedJoints::of_pose(self.view(design)),
        }
    }

    /// The exact pre-failure set of every cell: β of W₀ for positions, γ of W₀ for poses.
    pub fn pre_failure_sets(&self, design: &Design, cells: &[Cell]) -> Vec<AngleSet> {
        let arm = self.view(design);
        if !self.pose {
            let radii: Vec<f64> = cells.iter().map(|cell| cell.radius).collect();
            return POSITION.with_borrow_mut(|p| p.pre_failure_sets(arm, &radii));
        }
        let mut sets = Vec::with_capacity(cells.len());
        for row in cells.chunk_by(|a, b| a.radius == b.radius) {
            let bearings: Vec<f64> = row.iter().map(|cell| cell.bearing).collect();
            let of = |p: &mut PlanarPose| p.pre_failure_directions(arm, row[0].radius, &bearings);
            sets.extend(POSE.with_borrow_mut(of));
        }
        sets
    }

    /// What W₁ … W_n leave of a cell in closed form; empty outside their common radii.
    pub fn post_failure_set(&self, locked: &LockedJoints, cell: &Cell) -> AngleSet {
        let [inner, outer] = locked.radii();
        if cell.radius < inner || cell.radius > outer {
            return AngleSet::empty();
        }
        match self.pose {
            false => locked.bearings(cell.radius),
            true if !locked.bearings(cell.radius).contains(cell.bearing) => AngleSet::empty(),
            true => locked.directions(cell.radius),
        }
    }

    /// The exact fault-tolerant sets of cells.
    pub fn fault_tolerant_sets(&self, design: &Design, cells: &[Cell]) -> Vec<AngleSet> {
        let locked = self.locked_joints(design);
        let pre_failure = self.pre_failure_sets(design, cells);
        let pairs = pre_failure.iter().zip(cells);
        pairs
            .map(|(set, cell)| {
                let post = self.post_failure_set(&locked, cell);
                set.intersection(&post).without_narrow_arcs(0.0)
            })
            .collect()
    }
}
