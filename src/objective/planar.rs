//! The size of a planar fault-tolerant workspace as a score.

use super::design_vector::DesignSpace;
use super::space::SearchSpace;
use super::{Design, Objective};
use crate::workspace::FailureSet;
use crate::workspace::planar::{PlanarArm, PlanarPose, PlanarPosition, PoseResolution};
use std::cell::RefCell;

/// Planar tasks with an exact estimator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlanarTask {
    /// Position (x, y).
    Position,
    /// Position and orientation, computed at a resolution.
    Pose(PoseResolution),
}

/// S_F of a planar arm, or S_F/S_0max where link lengths are searched.
#[derive(Clone, Debug)]
pub struct PlanarObjective {
    design: DesignSpace,
    task: PlanarTask,
    failures: FailureSet,
    normalised: bool,
}

thread_local! {
    // Buffers only: a result never depends on what the thread computed before.
    static POSITION: RefCell<PlanarPosition> = RefCell::new(PlanarPosition::new());
}

impl PlanarObjective {
    /// S_F over `design`, divided by S_0max if `normalised`.
    pub fn new(
        design: DesignSpace,
        task: PlanarTask,
        failures: FailureSet,
        normalised: bool,
    ) -> PlanarObjective {
        PlanarObjective {
            design,
            task,
            failures,
            normalised,
        }
    }

    /// The mapping between points and designs.
    pub fn design_space(&self) -> &DesignSpace {
        &self.design
    }

    /// The score of a design.
    pub fn score_of(&self, design: &Design) -> f64 {
        let arm = PlanarArm {
            lengths: &design.lengths,
            limits: &design.limits,
            failures: &self.failures,
        };
        let (size, largest) = match self.task {
            PlanarTask::Position => (
                POSITION.with_borrow_mut(|estimator| estimator.fault_tolerant_size(arm)),
                PlanarPosition::unrestricted_size(&design.lengths),
            ),
            PlanarTask::Pose(resolution) => (
                PlanarPose::new(resolution).fault_tolerant_size(arm).value,
                PlanarPose::unrestricted_size(&design.lengths),
            ),
        };
        let score = if self.normalised {
            size / largest
        } else {
            size
        };
        if score.is_finite() { score } else { 0.0 }
    }
}

impl Objective for PlanarObjective {
    fn space(&self) -> &SearchSpace {
        self.design.space()
    }

    fn score(&self, x: &[f64]) -> f64 {
        self.score_of(&self.design.design(x))
    }
}
