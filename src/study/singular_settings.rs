//! Settings of the studies about singular configurations. Field names are keys of the study file.

use crate::design::{JointKind, Robot};
use crate::kinematics::joint_scales;
use crate::singularity::{
    DescentSettings, FailureSettings, LargestSettings, RefineSettings, SingularitySettings,
};
use serde::Serialize;

/// The table `[singularities]`: how singular configurations are searched.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SingularitySearch {
    /// Random starts N, default 200.
    pub starts: u64,
    /// Greatest rank loss looked for, default 3.
    pub max_rank_loss: u64,
    /// Configurations nearer to each other than this are one, degrees, default 0.05.
    pub merge_deg: f64,
}

/// The table `[largest-manifold]`: how candidates are refined and compared.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LargestSearch {
    /// Candidates of every rank loss that are refined, default 2.
    pub finalists: u64,
    /// Most locations computed for each, default 250.
    pub evaluations: u64,
    /// Rounds in which the Pareto fronts are varied, default 3.
    pub pareto_rounds: u64,
    /// Configurations per distribution of sizes, default 300; 0 for none.
    pub comparison: u64,
}

/// Settings of `kind = "largest-manifold"`.
#[derive(Clone, Debug, PartialEq)]
pub struct LargestManifold {
    /// How singular configurations are searched.
    pub singularities: SingularitySearch,
    /// How candidates are refined and compared.
    pub largest: LargestSearch,
}

/// A configuration as files have it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Configuration {
    /// Revolute joints, degrees.
    pub theta_deg: Vec<f64>,
    /// Prismatic joints, metres.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub theta: Vec<f64>,
}

/// A goal of the failure experiment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedGoal {
    /// Its name in the report.
    pub name: String,
    /// A configuration that holds it.
    #[serde(flatten)]
    pub configuration: Configuration,
}

/// Settings of `kind = "failure-experiment"`: its table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FailureStudy {
    /// Points on the way at which joints lock, default 25.
    pub locks: u64,
    /// Random starts of inverse kinematics after the informed ones, default 6.
    pub random_starts: u64,
    /// Where the robot starts: revolute joints, degrees.
    pub start_deg: Vec<f64>,
    /// Prismatic joints, metres.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub start: Vec<f64>,
    /// Where it goes, one goal after the other.
    pub goals: Vec<NamedGoal>,
}

impl Default for SingularitySearch {
    fn default() -> SingularitySearch {
        let default = SingularitySettings::default();
        SingularitySearch {
            starts: default.starts as u64,
            max_rank_loss: default.max_loss as u64,
            merge_deg: 0.05,
        }
    }
}

impl Default for LargestSearch {
    fn default() -> LargestSearch {
        let default = LargestSettings::default();
        LargestSearch {
            finalists: default.finalists as u64,
            evaluations: default.refine.evaluations as u64,
            pareto_rounds: default.pareto_rounds as u64,
            comparison: 300,
        }
    }
}

impl SingularitySearch {
    pub(super) fn settings(&self) -> SingularitySettings {
        SingularitySettings {
            starts: self.starts as usize,
            max_loss: self.max_rank_loss as usize,
            merge: self.merge_deg.to_radians(),
            descent: DescentSettings::default(),
        }
    }
}

impl LargestManifold {
    pub(super) fn settings(&self) -> LargestSettings {
        LargestSettings {
            singularities: self.singularities.settings(),
            finalists: self.largest.finalists as usize,
            refine: RefineSettings {
                evaluations: self.largest.evaluations as usize,
                ..RefineSettings::default()
            },
            pareto_rounds: self.largest.pareto_rounds as usize,
        }
    }
}

impl FailureStudy {
    pub(super) fn settings(&self) -> FailureSettings {
        FailureSettings {
            locks: self.locks as usize,
            random_starts: self.random_starts as usize,
        }
    }

    pub(super) fn start(&self) -> Configuration {
        Configuration {
            theta_deg: self.start_deg.clone(),
            theta: self.start.clone(),
        }
    }
}

impl Configuration {
    /// Internal joint variables of `robot`, which has as many joints of each kind.
    pub(super) fn inner(&self, robot: &Robot) -> Vec<f64> {
        let scales = joint_scales(robot).unwrap_or_default();
        let (mut turns, mut slides) = (self.theta_deg.iter(), self.theta.iter());
        let joint = |index: usize| match robot.joint_kind(index) {
            JointKind::Revolute => turns.next().map_or(0.0, |angle| angle.to_radians()),
            JointKind::Prismatic => {
                let value = slides.next().copied().unwrap_or(0.0);
                scales.get(index).map_or(value, |scale| scale.inner(value))
            }
        };
        (0..robot.joints()).map(joint).collect()
    }
}
