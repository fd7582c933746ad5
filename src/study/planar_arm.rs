//! The planar robot of a study, and the exact measurements a study asks for.

use super::settings::{EXACT_TOLERANCE, Estimator, Optimise, Study};
use crate::angle::wrap;
use crate::design::TaskSpace;
use crate::objective::{DesignSpace, PlanarObjective, PlanarTask};
use crate::workspace::planar::{PlanarArm, PlanarPose, PlanarPosition, PoseResolution};
use crate::workspace::{ArtificialLimits, FailureSet, JointLimit, WorkspaceMap, WorkspaceSizes};

/// A planar chain with the study's task and failures.
///
/// Limits go in and out as joint variables; inside they refer to the angles between links.
#[derive(Clone, Debug)]
pub(super) struct PlanarStudy {
    pub lengths: Vec<f64>,
    offsets: Vec<f64>,
    failures: FailureSet,
    pose: Option<PoseResolution>,
}

/// Rings of a workspace picture.
const RINGS: usize = 240;

/// Cells of a share map: radii and angles.
const SHARE_CELLS: [usize; 2] = [150, 360];

impl PlanarStudy {
    /// # Errors
    /// The robot is no planar chain; validation has refused that before.
    pub fn new(study: &Study) -> Result<PlanarStudy, anyhow::Error> {
        let chain = study.design.robot.planar_chain()?;
        let tolerance = match study.estimator {
            Estimator::Exact { tolerance } => tolerance,
            Estimator::Surrogate { .. } => EXACT_TOLERANCE,
            Estimator::Hybrid { .. } => anyhow::bail!("a hybrid study for the exact estimator"),
        };
        let resolution = PoseResolution::for_tolerance(tolerance);
        Ok(PlanarStudy {
            lengths: chain.lengths,
            offsets: chain.angle_offsets,
            failures: study.failures.clone(),
            pose: (study.task == TaskSpace::PlanarPose).then_some(resolution),
        })
    }

    pub fn is_pose(&self) -> bool {
        self.pose.is_some()
    }

    pub fn failures(&self) -> &FailureSet {
        &self.failures
    }

    /// What is added to the variable of joint `k` (from 0) to give the angle between its links.
    pub fn offset(&self, k: usize) -> f64 {
        self.offsets[k]
    }

    /// Limits between links for limits of joint variables.
    pub fn to_links(&self, limits: &ArtificialLimits) -> ArtificialLimits {
        let pairs = limits.joints().iter().zip(&self.offsets);
        ArtificialLimits::new(
            pairs
                .map(|(limit, &offset)| limit.shifted(offset))
                .collect(),
        )
    }

    /// Limits of joint variables for limits between links, middles in [−π, π).
    pub fn to_joints(&self, limits: &ArtificialLimits) -> ArtificialLimits {
        let pairs = limits.joints().iter().zip(&self.offsets);
        let joint = |(limit, &offset): (&JointLimit, &f64)| {
            if limit.is_full() {
                JointLimit::FREE
            } else {
                JointLimit::around(wrap(limit.centre() - offset), limit.width())
            }
        };
        ArtificialLimits::new(pairs.map(joint).collect())
    }

    /// The same study for a chain of other lengths.
    pub fn with_lengths(&self, lengths: Vec<f64>) -> PlanarStudy {
        PlanarStudy {
            lengths,
            ..self.clone()
        }
    }

    /// What a search of this arm varies: limits between links and, if asked for, lengths.
    pub fn design_space(&self, optimise: &Optimise) -> DesignSpace {
        let links = optimise.search.links.as_ref().map(|links| {
            let pairs = links.link_lower.iter().zip(&links.link_upper);
            pairs.map(|(&lower, &upper)| [lower, upper]).collect()
        });
        let min_width = optimise.search.min_width_deg.to_radians();
        DesignSpace::new(&self.lengths, min_width, self.is_pose(), links)
    }

    /// The score to maximise: exact for position tasks, coarse for pose tasks.
    pub fn objective(&self, space: DesignSpace, normalised: bool) -> PlanarObjective {
        let task = if self.is_pose() {
            PlanarTask::Pose(PoseResolution::coarse())
        } else {
            PlanarTask::Position
        };
        PlanarObjective::new(space, task, self.failures.clone(), normalised)
    }

    fn arm<'a>(&'a self, limits: &'a ArtificialLimits) -> PlanarArm<'a> {
        PlanarArm {
            lengths: &self.lengths,
            limits,
            failures: &self.failures,
        }
    }

    /// All sizes for limits between links.
    pub fn sizes(&self, limits: &ArtificialLimits) -> WorkspaceSizes {
        match self.pose {
            None => PlanarPosition::new().sizes(self.arm(limits)),
            Some(resolution) => PlanarPose::new(resolution).sizes(self.arm(limits)),
        }
    }

    /// S_F for limits between links: exact for position tasks, for pose tasks at the coarse
    /// resolution of a search, which is good enough for a curve.
    pub fn size(&self, limits: &ArtificialLimits) -> f64 {
        if self.is_pose() {
            let mut estimator = PlanarPose::new(PoseResolution::coarse());
            estimator.fault_tolerant_size(self.arm(limits)).value
        } else {
            PlanarPosition::new().fault_tolerant_size(self.arm(limits))
        }
    }

    /// What the study reports at a radius: polar angles of W_F for position tasks; for pose
    /// tasks the measure of (β, γ) at that wrist radius.
    pub fn at_radius(&self, limits: &ArtificialLimits, r: f64) -> AtRadius {
        match self.pose {
            None => AtRadius::Angles(PlanarPosition::new().rotation_set(self.arm(limits), r)),
            Some(resolution) => {
                let mut estimator = PlanarPose::new(resolution);
                AtRadius::Measure(estimator.wrist_measure(self.arm(limits), r))
            }
        }
    }

    /// A picture of W_F.
    pub fn map(&self, limits: &ArtificialLimits) -> WorkspaceMap {
        let arm = self.arm(limits);
        match self.pose {
            None => WorkspaceMap::Rings(PlanarPosition::new().ring_map(arm, RINGS)),
            Some(resolution) => {
                let [radii, angles] = SHARE_CELLS;
                let mut estimator = PlanarPose::new(resolution);
                WorkspaceMap::Shares(estimator.share_map(arm, radii, angles))
            }
        }
    }
}

/// The fault-tolerant workspace at one radius.
pub(super) enum AtRadius {
    Angles(crate::angle::AngleSet),
    Measure(f64),
}
