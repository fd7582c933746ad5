//! The robot of a study as the hybrid estimator sees it: samples, atlases, limits.

use super::hybrid_settings::Hybrid;
use super::hybrid_table::MOST_SAMPLES;
use super::run::{Progress, RunError};
use super::settings::{Question, Study};
use crate::design::{JointKind, Robot, TaskSpace};
use crate::diagnostic::{InputError, Problem};
use crate::kinematics::workspace_extent;
use crate::workspace::ArtificialLimits;
use crate::workspace::hybrid::{
    Atlas, AtlasError, AtlasRecipe, AtlasStore, Prediction, Region, SamplePlan,
};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// What the seed of the independent atlas differs by. Odd, so that it differs for every seed.
const INDEPENDENT: u64 = 0x9E37_79B9_7F4A_7C15;

/// Share by which the sampled region exceeds what the robot reaches: round-off must not cut it.
const MARGIN: f64 = 1e-3;

/// Which samples an atlas has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Samples {
    /// Those of the study's seed, which a search sees.
    OfTheSeed,
    /// Others, on which a search's optimum is measured.
    Independent,
}

/// An atlas that a study needs, before it is built.
pub(super) struct Needed {
    pub recipe: AtlasRecipe,
    pub prediction: Prediction,
}

impl Needed {
    /// The atlas of `study` with the given samples.
    ///
    /// # Errors
    /// It would not fit the memory that the study allows.
    ///
    /// `limits` are the only ones that it will be scored for, if they are known: with more than
    /// one degree of redundancy the atlas is then smaller and more accurate.
    pub fn new(
        study: &Study,
        hybrid: &Hybrid,
        samples: Samples,
        limits: Option<&ArtificialLimits>,
    ) -> Result<Needed, RunError> {
        let turns = study.design.robot.joint_kind(0) == JointKind::Revolute;
        let plan = SamplePlan {
            task: study.task,
            region: region(&study.design.robot, study.task)?,
            sampling: hybrid.sampling.to_plan(turns),
            seed: match samples {
                Samples::OfTheSeed => study.seed,
                Samples::Independent => study.seed.wrapping_add(INDEPENDENT),
            },
        };
        check_count(study, &plan)?;
        let recipe = AtlasRecipe::new(&study.design.robot, plan, hybrid.atlas_settings())
            .map_err(anyhow::Error::from)?;
        let degree = study.design.robot.degree_of_redundancy(study.task);
        let recipe = match limits {
            Some(limits) if degree > 1 => recipe.focused(limits),
            _ => recipe,
        };
        let prediction = recipe.predict();
        recipe
            .check_size(&prediction)
            .map_err(|error| too_large(study, &error, &prediction))?;
        Ok(Needed { recipe, prediction })
    }

    /// The atlases that are known before `study` runs. The one on which an optimum is measured is
    /// not, where it depends on the limits found.
    ///
    /// # Errors
    /// As [`Needed::new`].
    pub fn all(study: &Study, hybrid: &Hybrid) -> Result<Vec<Needed>, RunError> {
        let robot = &study.design.robot;
        match &study.question {
            Question::Estimate(estimate) => {
                let limits = estimate.limits.to_limits(robot);
                let needed = Needed::new(study, hybrid, Samples::OfTheSeed, Some(&limits))?;
                Ok(vec![needed])
            }
            _ => {
                let mut all = vec![Needed::new(study, hybrid, Samples::OfTheSeed, None)?];
                if robot.degree_of_redundancy(study.task) == 1 {
                    all.push(Needed::new(study, hybrid, Samples::Independent, None)?);
                }
                Ok(all)
            }
        }
    }

    /// The atlas' shards below the cache folder, if there is one.
    pub fn store(&self, cache: Option<&Path>) -> Option<AtlasStore> {
        cache.map(|cache| self.recipe.store(cache))
    }

    /// Builds the atlas, or reads it from the cache.
    ///
    /// # Errors
    /// Interrupted (finished shards stay in the cache), too large after all, or the cache cannot
    /// be written to.
    pub fn build(
        &self,
        study: &Study,
        cache: Option<&Path>,
        interrupt: &AtomicBool,
        progress: &dyn Progress,
    ) -> Result<Atlas, RunError> {
        let store = self.store(cache);
        let tell = |done, total| progress.update(done, total, f64::NAN, "tracing");
        self.recipe
            .build(store.as_ref(), interrupt, &tell)
            .map_err(|error| run_error(study, error, &self.prediction, cache))
    }
}

/// An atlas' error as a run's.
pub(super) fn run_error(
    study: &Study,
    error: AtlasError,
    prediction: &Prediction,
    cache: Option<&Path>,
) -> RunError {
    match error {
        AtlasError::Interrupted => RunError::Interrupted,
        AtlasError::TooLarge { .. } => too_large(study, &error, prediction).into(),
        AtlasError::Write(cause) => unwritable(cache.unwrap_or(Path::new("")), &cause).into(),
        AtlasError::Manifold(_) => RunError::Failed(error.into()),
    }
}

/// Checks, without leaving a file, that the cache folder can be written to.
///
/// # Errors
/// It cannot.
pub(super) fn check_cache(cache: Option<&Path>) -> Result<(), InputError> {
    let Some(cache) = cache else {
        return Ok(());
    };
    let tried = std::fs::create_dir_all(cache).and_then(|()| tempfile::tempfile_in(cache));
    tried.map(drop).map_err(|cause| unwritable(cache, &cause))
}

fn unwritable(cache: &Path, cause: &std::io::Error) -> InputError {
    let problem = Problem {
        message: "the cache folder cannot be written to".into(),
        found: cause.to_string(),
        expected: "a folder with room for the traced manifolds".into(),
        help: "choose another with `--cache DIR`, or keep them in memory with `--no-cache`".into(),
    };
    InputError::in_file(&cache.display().to_string(), problem)
}

/// A grid's cells are known only with the robot's reach; a lattice never has more.
fn check_count(study: &Study, plan: &SamplePlan) -> Result<(), InputError> {
    let samples = plan.len();
    if samples <= MOST_SAMPLES {
        return Ok(());
    }
    let problem = Problem {
        message: "there are too many samples".into(),
        found: format!("{samples}"),
        expected: format!("at most {MOST_SAMPLES}"),
        help: "in `[estimator.hybrid]`, take a larger `cell` or fewer `orientations`".into(),
    };
    Err(InputError::in_file(&file_of(study), problem))
}

/// The study file as a message names it.
pub(super) fn file_of(study: &Study) -> String {
    format!("{}.toml", study.name)
}

fn too_large(study: &Study, error: &AtlasError, prediction: &Prediction) -> InputError {
    let seconds = prediction.core_seconds;
    let time = match seconds {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 6000.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.0} h", s / 3600.0),
    };
    let megabytes = (prediction.bytes >> 20).max(1);
    let (found, expected) = match error {
        AtlasError::TooLarge {
            predicted_mb,
            limit_mb,
        } => (
            format!(
                "about {} MB, {time} of one core",
                predicted_mb.max(&megabytes)
            ),
            format!("at most {limit_mb} MB (`estimator.hybrid.memory_limit_mb`)"),
        ),
        _ => (format!("about {megabytes} MB"), "less".into()),
    };
    let problem = Problem {
        message: "the manifolds of all samples would not fit the memory that is allowed".into(),
        found,
        expected,
        help: "in `[estimator.hybrid]`, take fewer samples (a larger `cell`, fewer \
               `orientations`), raise `tolerance_rad`, or raise `memory_limit_mb`"
            .into(),
    };
    InputError::in_file(&file_of(study), problem)
}

/// Where the robot's workspace lies in the frame of joint 1.
///
/// # Errors
/// A prismatic joint without limits; validation has refused that before.
fn region(robot: &Robot, task: TaskSpace) -> Result<Region, anyhow::Error> {
    let extent = workspace_extent(robot)
        .ok_or_else(|| anyhow::anyhow!("a prismatic joint without physical limits"))?;
    let margin = MARGIN * extent.reach;
    let is_planar = task.is_planar();
    Ok(Region {
        radius: extent.radius + margin,
        lower: if is_planar {
            0.0
        } else {
            extent.lower - margin
        },
        upper: if is_planar {
            0.0
        } else {
            extent.upper + margin
        },
        reach: extent.reach + margin,
    })
}
