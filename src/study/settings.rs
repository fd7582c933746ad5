//! A validated study: every setting typed, in range and consistent with the robot.
//!
//! Field names are the keys of the study file. Angles stay in degrees, as the file has them, so
//! that the study as run reads like the study as written; [`DegreeLimits::to_limits`] converts.

use super::hybrid_settings::Hybrid;
use super::singular_settings::{FailureStudy, LargestManifold, SingularitySearch};
use super::surrogate_settings::{SurrogateEstimator, Train, Validate};
use super::synthesis_check::SynthesisQuestion;
use crate::design::{JointKind, Robot, TaskSpace};
use crate::kinematics::{JointScale, joint_scales};
use crate::manifold::SearchSettings;
use crate::optimiser::{CoordinateAscentSettings, GeneticSettings};
use crate::workspace::{ArtificialLimits, FailureSet, JointLimit};
use serde::Serialize;
use std::path::PathBuf;

/// Relative error target of quadrature where a study names none.
pub(super) const EXACT_TOLERANCE: f64 = 1e-3;

/// One question about one robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// The stem of the study file's name; names the report folder.
    pub name: String,
    /// A heading for the report, if the file gives one.
    pub title: Option<String>,
    /// The robot and its file.
    pub design: Design,
    /// Seed of every random stream, default 1.
    pub seed: u64,
    /// What the tool is asked to reach.
    pub task: TaskSpace,
    /// The joints F that may lock, and how far beyond their limits: `margin_deg`, in radians.
    pub failures: FailureSet,
    /// How far beyond its artificial limits a joint may come to rest when it locks, degrees,
    /// default 0.
    pub margin_deg: f64,
    /// What is asked.
    pub question: Question,
    /// How workspaces are measured; a study of manifolds measures none.
    pub estimator: Estimator,
    /// What the report contains.
    pub report: ReportSettings,
}

/// A robot and the file it was read from.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Absolute path of the robot file.
    pub path: PathBuf,
    /// SHA-256 of the file's bytes, lower-case hexadecimal; if it names a URDF file, of its bytes, a
    /// zero byte and the URDF file's bytes.
    pub sha256: String,
    /// The robot.
    pub robot: Robot,
}

/// What a study asks: its `kind` and the tables that belong to it.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// How large is the workspace for these limits?
    Estimate(Estimate),
    /// Which limits make the fault-tolerant workspace largest?
    Optimise(Optimise),
    /// With which configurations does the robot hold this pose?
    Manifolds(Manifolds),
    /// What does a network learn of the workspace?
    Train(Train),
    /// How far are surrogates from the exact workspace?
    Validate(Validate),
    /// Where does the robot lose rank?
    Singularities(SingularitySearch),
    /// Where can it lose any joint, anywhere in its range, and hold the task?
    LargestManifold(LargestManifold),
    /// Does it reach these goals after a joint has locked on the way?
    FailureExperiment(FailureStudy),
    /// Which robot, with which limits, is best?
    Synthesis(SynthesisQuestion),
}

/// Settings of `kind = "estimate"`.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The artificial limits.
    pub limits: DegreeLimits,
    /// Radii, metres, at which the rotation sets are reported as well.
    pub radii: Vec<f64>,
}

/// Settings of `kind = "optimise"`.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimise {
    /// A first candidate.
    pub start: Option<DegreeLimits>,
    /// What is searched.
    pub search: Search,
    /// Who searches.
    pub optimiser: OptimiserSettings,
}

/// Settings of `kind = "manifolds"`.
#[derive(Clone, Debug, PartialEq)]
pub struct Manifolds {
    /// The pose, in the world frame.
    pub pose: Pose,
    /// Artificial limits, if the pose's tolerance of failures is asked for.
    pub limits: Option<DegreeLimits>,
    /// How the manifolds are searched.
    pub search: ManifoldSearch,
}

/// A tool pose in the world frame, with as much orientation as the task has.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pose {
    /// x, y and, in space, z; metres.
    pub position: Vec<f64>,
    /// Rotation matrix row by row, for spatial poses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation: Option<[[f64; 3]; 3]>,
    /// Direction of the tool, degrees, for planar poses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phi_deg: Option<f64>,
}

/// How manifolds of one pose are searched.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ManifoldSearch {
    /// Least number of random starts, default 64.
    pub seeds: u64,
    /// Residual of the vertices, share of the robot's size, default 1e-6.
    pub residual: f64,
    /// With more than one degree of redundancy: values of every joint that slices hold, default 32.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slices: Option<u64>,
}

/// Artificial limits as files have them: lower ≤ upper, joint 1 first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DegreeLimits {
    /// Lower limits of revolute joints, degrees.
    pub lower_deg: Vec<f64>,
    /// Upper limits of revolute joints, degrees, at most 360 above the lower ones.
    pub upper_deg: Vec<f64>,
    /// Lower limits of prismatic joints, metres.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lower: Vec<f64>,
    /// Upper limits of prismatic joints, metres.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub upper: Vec<f64>,
}

/// The search space.
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    /// Narrowest allowed limits of a joint, degrees in [0, 360], default 0.
    pub min_width_deg: f64,
    /// Bounds of the link lengths if these are searched too, at fixed total length; the score is
    /// then S_F / S_0max.
    pub links: Option<LinkBounds>,
}

/// Bounds of the link lengths, metres, joint 1 first.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkBounds {
    /// Shortest lengths, above 0.
    pub link_lower: Vec<f64>,
    /// Longest lengths.
    pub link_upper: Vec<f64>,
}

/// Settings of the optimiser that `[optimiser] method` names.
#[derive(Clone, Debug, PartialEq)]
pub enum OptimiserSettings {
    /// `coordinate-ascent`, the default.
    CoordinateAscent(CoordinateAscent),
    /// `genetic`.
    Genetic(Genetic),
}

/// Coordinate ascent with random restarts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CoordinateAscent {
    /// Number of starts, default 32.
    pub restarts: u64,
    /// Samples along a line before it is refined, default 24.
    pub line_samples: u64,
    /// First sweeps, which scan the whole box, for all starts, default 2.
    pub scout_sweeps: u64,
    /// Starts that go on after the first sweeps, default 6.
    pub finalists: u64,
    /// Sweeps over all coordinates after which a start is given up, default 100.
    pub max_sweeps: u64,
    /// Relative gain of a sweep below which a start has converged, default 1e-9.
    pub tolerance: f64,
}

/// Genetic algorithm.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Genetic {
    /// Candidates per generation, default 100.
    pub population: u64,
    /// Most generations, default 200.
    pub generations: u64,
    /// Best candidates that survive unchanged, default 2, fewer than the population.
    pub elite: u64,
    /// Candidates of which the best becomes a parent, default 3.
    pub tournament: u64,
    /// Probability of crossover in [0, 1], default 0.9.
    pub crossover_rate: f64,
    /// Probability of mutation in [0, 1], default 0.3.
    pub mutation_rate: f64,
    /// Generations without improvement after which the search ends, default 50.
    pub patience: u64,
    /// Whether the best candidate is refined by coordinate ascent at the end, default true.
    pub polish: bool,
}

/// How workspaces are measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "method", rename_all = "kebab-case")]
pub enum Estimator {
    /// Closed-form rotation sets of planar robots.
    Exact {
        /// Relative error target of quadrature for pose tasks, default 1e-3.
        tolerance: f64,
    },
    /// Pre-images of sampled task points, for any serial robot.
    Hybrid {
        /// How points are sampled and pre-images traced.
        hybrid: Hybrid,
    },
    /// A trained surrogate for the search, the exact estimator for its result.
    #[serde(skip)]
    Surrogate {
        /// The surrogate and what follows the search.
        surrogate: SurrogateEstimator,
    },
}

/// The estimators of this version.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EstimatorMethod {
    /// `exact`.
    Exact,
    /// `hybrid`.
    Hybrid,
    /// `surrogate`.
    Surrogate,
}

/// What the report contains.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReportSettings {
    /// File formats of figures, default both.
    pub formats: Vec<FigureFormat>,
    /// Whether figures are drawn, default true.
    pub figures: bool,
}

/// A file format of figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FigureFormat {
    /// Portable Network Graphics.
    Png,
    /// Scalable Vector Graphics.
    Svg,
}

impl Question {
    /// The study's `kind`.
    pub fn kind(&self) -> &'static str {
        match self {
            Question::Estimate(_) => "estimate",
            Question::Optimise(_) => "optimise",
            Question::Manifolds(_) => "manifolds",
            Question::Train(_) => "train",
            Question::Validate(_) => "validate",
            Question::Singularities(_) => "singularities",
            Question::LargestManifold(_) => "largest-manifold",
            Question::FailureExperiment(_) => "failure-experiment",
            Question::Synthesis(_) => "synthesis",
        }
    }
}

impl OptimiserSettings {
    /// The optimiser's `method`.
    pub fn method(&self) -> &'static str {
        match self {
            OptimiserSettings::CoordinateAscent(_) => "coordinate-ascent",
            OptimiserSettings::Genetic(_) => "genetic",
        }
    }
}

impl DegreeLimits {
    /// The limits in internal joint variables of `robot`, which has as many joints of each kind:
    /// radians for revolute joints (see [`JointScale`] for the others).
    pub fn to_limits(&self, robot: &Robot) -> ArtificialLimits {
        let scales = joint_scales(robot).unwrap_or_default();
        let mut turns = self.lower_deg.iter().zip(&self.upper_deg);
        let mut slides = self.lower.iter().zip(&self.upper);
        let joint = |index: usize| {
            let scale = scales.get(index).unwrap_or(&JointScale::REVOLUTE);
            let pair = match robot.joint_kind(index) {
                JointKind::Revolute => turns.next().map(|(l, u)| [l, u].map(|x| x.to_radians())),
                JointKind::Prismatic => slides.next().map(|(l, u)| [l, u].map(|x| scale.inner(*x))),
            };
            pair.map_or(JointLimit::FREE, |[lower, upper]| {
                JointLimit::new(lower, upper)
            })
        };
        ArtificialLimits::new((0..robot.joints()).map(joint).collect())
    }

    /// Limits in internal joint variables of `robot` as files have them.
    pub fn from_limits(limits: &ArtificialLimits, robot: &Robot) -> DegreeLimits {
        let scales = joint_scales(robot).unwrap_or_default();
        let mut written = DegreeLimits {
            lower_deg: Vec::new(),
            upper_deg: Vec::new(),
            lower: Vec::new(),
            upper: Vec::new(),
        };
        for (index, limit) in limits.joints().iter().enumerate() {
            let scale = scales.get(index).unwrap_or(&JointScale::REVOLUTE);
            match robot.joint_kind(index) {
                JointKind::Revolute => {
                    written.lower_deg.push(limit.lower.to_degrees());
                    written.upper_deg.push(limit.upper.to_degrees());
                }
                JointKind::Prismatic => {
                    written.lower.push(scale.outer(limit.lower));
                    written.upper.push(scale.outer(limit.upper));
                }
            }
        }
        written
    }
}

impl Default for ManifoldSearch {
    fn default() -> ManifoldSearch {
        ManifoldSearch {
            seeds: SearchSettings::default().least_seeds as u64,
            residual: 1e-6,
            slices: None,
        }
    }
}

impl Default for CoordinateAscent {
    fn default() -> CoordinateAscent {
        let default = CoordinateAscentSettings::default();
        CoordinateAscent {
            restarts: default.restarts as u64,
            line_samples: default.line_samples as u64,
            scout_sweeps: default.scout_sweeps as u64,
            finalists: default.finalists as u64,
            max_sweeps: default.max_sweeps as u64,
            tolerance: default.tolerance,
        }
    }
}

impl Default for Genetic {
    fn default() -> Genetic {
        let default = GeneticSettings::default();
        Genetic {
            population: default.population as u64,
            generations: default.generations as u64,
            elite: default.elite as u64,
            tournament: default.tournament as u64,
            crossover_rate: default.crossover_rate,
            mutation_rate: default.mutation_rate,
            patience: default.patience as u64,
            polish: true,
        }
    }
}

impl Default for Estimator {
    fn default() -> Estimator {
        Estimator::Exact {
            tolerance: EXACT_TOLERANCE,
        }
    }
}

impl Default for ReportSettings {
    fn default() -> ReportSettings {
        ReportSettings {
            formats: vec![FigureFormat::Png, FigureFormat::Svg],
            figures: true,
        }
    }
}
