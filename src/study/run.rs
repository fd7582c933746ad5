//! Runs a validated study.

use super::checkpoint::{Stage, Store};
use super::optimise::Session;
use super::settings::{Estimator, Question, Study};
use super::{
    check_folder, failure_run, hybrid_run, largest_run, manifold_run, planar_run, singularity_run,
    synthesis_run, train_run, validate_run,
};
use crate::diagnostic::{InputError, Problem};
use crate::report;
use serde_json::Value;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Where and how a study runs; nothing here changes its result.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// The report folder.
    pub out: PathBuf,
    /// Continue from the folder's checkpoint, if there is one.
    pub resume: bool,
    /// Replace a report that is already there.
    pub overwrite: bool,
    /// Number of threads; one per core if none is given.
    pub threads: Option<usize>,
    /// Set from outside to stop at the next checkpoint.
    pub interrupt: Arc<AtomicBool>,
    /// Folder in which atlases are kept for other runs; without it they live in memory.
    pub cache: Option<PathBuf>,
}

/// Watches a run.
pub trait Progress: Send + Sync {
    /// `done` of `total` steps are done and the best score so far is `best` (not finite if there
    /// is none); `message` says what is going on.
    fn update(&self, done: u64, total: u64, best: f64, message: &str);
}

/// Why a run has no result.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The input or the report folder is at fault.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The interrupt flag was set; a checkpoint is in the report folder.
    #[error("interrupted")]
    Interrupted,
    /// Something else went wrong.
    #[error(transparent)]
    Failed(#[from] anyhow::Error),
}

/// Runs `study` and returns the content of `result.json`.
///
/// # Errors
/// The report folder is at fault, the run was interrupted, or it failed.
pub fn run(
    study: &Study,
    options: &RunOptions,
    progress: Arc<dyn Progress>,
) -> Result<Value, RunError> {
    check_folder(options)?;
    report::remove_unfinished(&options.out);
    pool(options)?.install(|| run_in_pool(study, options, progress))
}

/// As many threads as the options ask for.
pub(super) fn pool(options: &RunOptions) -> Result<rayon::ThreadPool, RunError> {
    let cores = || std::thread::available_parallelism().map_or(1, |cores| cores.get());
    let threads = options.threads.unwrap_or_else(cores);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(anyhow::Error::from)?;
    Ok(pool)
}

fn run_in_pool(
    study: &Study,
    options: &RunOptions,
    progress: Arc<dyn Progress>,
) -> Result<Value, RunError> {
    let mut store = Store::new(&options.out, study);
    let saved = if options.resume { store.load()? } else { None };
    let study_toml = study.to_toml(&options.out).map_err(anyhow::Error::from)?;
    if saved.is_none() {
        if options.resume
            && let Some(result) = finished(study, options, &study_toml)?
        {
            return Ok(result);
        }
        store.remove();
    }
    let ready = Ready {
        session: Session {
            store: Arc::new(store),
            progress,
            interrupt: options.interrupt.clone(),
        },
        saved,
        study_toml,
    };
    match (&study.question, &study.estimator) {
        (Question::Manifolds(manifolds), _) => manifold_run::run(study, manifolds, options, ready),
        (Question::Train(train), _) => train_run::run(study, train, options, ready),
        (Question::Validate(validate), _) => validate_run::run(study, validate, options, ready),
        (Question::Singularities(search), _) => singularity_run::run(study, search, options, ready),
        (Question::LargestManifold(largest), _) => largest_run::run(study, largest, options, ready),
        (Question::FailureExperiment(failure), _) => {
            failure_run::run(study, failure, options, ready)
        }
        (Question::Synthesis(question), _) => synthesis_run::run(study, question, options, ready),
        (_, Estimator::Exact { .. } | Estimator::Surrogate { .. }) => {
            planar_run::run(study, options, ready)
        }
        (_, Estimator::Hybrid { hybrid }) => hybrid_run::run(study, hybrid, options, ready),
    }
}

/// A run that may begin: its folder is checked, and what was saved of it is read.
pub(super) struct Ready {
    pub session: Session,
    /// Where an interrupted search stood.
    pub saved: Option<Stage>,
    /// The study as run.
    pub study_toml: String,
}

impl Ready {
    /// Writes the study as run: from here on the report folder holds this run.
    ///
    /// # Errors
    /// The folder cannot be written to.
    pub fn begin(&self, options: &RunOptions) -> Result<(), RunError> {
        let path = options.out.join("study.toml");
        Ok(report::write_text(&path, &self.study_toml).map_err(anyhow::Error::from)?)
    }
}

/// The result of a run that needs no resuming, because it has ended.
fn finished(
    study: &Study,
    options: &RunOptions,
    study_toml: &str,
) -> Result<Option<Value>, RunError> {
    let read = |name: &str| std::fs::read_to_string(options.out.join(name)).ok();
    let Some(text) = read("result.json") else {
        return Ok(None);
    };
    let result: Value = serde_json::from_str(&text).unwrap_or_default();
    let same_robot = result["provenance"]["design_sha256"] == study.design.sha256.as_str();
    if !same_robot || read("study.toml").as_deref() != Some(study_toml) {
        let problem = Problem {
            message: "the run cannot be resumed".into(),
            found: "the finished report of another study, robot or seed".into(),
            expected: "the checkpoint of this study".into(),
            help: "add `--overwrite` to replace it, or choose another `--out`".into(),
        };
        return Err(InputError::in_file(&options.out.display().to_string(), problem).into());
    }
    Ok(Some(result))
}
