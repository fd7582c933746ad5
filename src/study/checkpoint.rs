//! Checkpoints of a search: written whole or not at all, refused for another study.

use super::run::RunError;
use super::settings::Study;
use crate::diagnostic::{InputError, Problem};
use crate::optimiser::{CoordinateAscent, Genetic, HistoryPoint, Snapshot};
use crate::report::write_bytes;
use crate::surrogate::Training;
use crate::synthesis::{ParetoSearch, Synthesis};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Version of the file's layout.
const LAYOUT: u32 = 3;

/// Shortest time between two checkpoints: what a killed run loses at most, beside the iteration
/// it was in.
const INTERVAL: Duration = Duration::from_millis(200);

/// Where a search stands.
#[derive(Clone, Serialize, Deserialize)]
pub(super) enum Stage {
    Ascent(Box<Snapshot<CoordinateAscent>>),
    Genetic(Box<Snapshot<Genetic>>),
    Training(Box<Training>),
    Synthesis(Box<Synthesis>),
    Pareto(Box<ParetoSearch>),
    /// A local stage, with the records of those before it.
    Local {
        before: Vec<Record>,
        snapshot: Box<Snapshot<CoordinateAscent>>,
    },
}

/// What is kept of a search that has ended.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Record {
    /// The stage's name.
    pub stage: String,
    /// Samples behind its scores, if they are estimates.
    pub samples: Option<u64>,
    pub best_score: f64,
    pub evaluations: u64,
    pub history: Vec<HistoryPoint>,
    pub converged: bool,
    /// Exact score of the best of the last candidates, where a surrogate has scored them.
    pub rescored: Option<f64>,
}

#[derive(Serialize, Deserialize)]
struct File {
    layout: u32,
    key: String,
    seconds: f64,
    stage: Stage,
}

/// The checkpoint of one run.
pub(super) struct Store {
    path: PathBuf,
    key: String,
    started: Instant,
    earlier: f64,
    last: Mutex<Instant>,
}

impl Store {
    /// The store in `folder` for `study`.
    pub fn new(folder: &Path, study: &Study) -> Store {
        Store {
            path: folder.join("checkpoint").join("search.bin"),
            key: key(study),
            started: Instant::now(),
            earlier: 0.0,
            last: Mutex::new(Instant::now()),
        }
    }

    /// Seconds of computation so far, those before an interruption included.
    pub fn seconds(&self) -> f64 {
        self.earlier + self.started.elapsed().as_secs_f64()
    }

    /// The stage to continue from, if there is a checkpoint.
    ///
    /// # Errors
    /// The checkpoint is damaged or belongs to another study, seed or version.
    pub fn load(&mut self) -> Result<Option<Stage>, RunError> {
        let Ok(bytes) = std::fs::read(&self.path) else {
            return Ok(None);
        };
        let file: File = postcard::from_bytes(&bytes)
            .map_err(|_| self.refuse("a file that is no checkpoint of this version"))?;
        if file.layout != LAYOUT || file.key != self.key {
            let found = "a checkpoint of another study, robot, seed or version";
            return Err(self.refuse(found).into());
        }
        self.earlier = file.seconds;
        Ok(Some(file.stage))
    }

    /// Saves the stage that `stage` makes if the last checkpoint is old enough.
    pub fn save_if_due(&self, stage: impl FnOnce() -> Stage) -> Result<(), anyhow::Error> {
        let due = match self.last.lock() {
            Ok(mut last) if last.elapsed() >= INTERVAL => {
                *last = Instant::now();
                true
            }
            _ => false,
        };
        if due { self.save(stage()) } else { Ok(()) }
    }

    /// Saves a stage now.
    pub fn save(&self, stage: Stage) -> Result<(), anyhow::Error> {
        let file = File {
            layout: LAYOUT,
            key: self.key.clone(),
            seconds: self.seconds(),
            stage,
        };
        let bytes = postcard::to_stdvec(&file)?;
        if let Some(folder) = self.path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        Ok(write_bytes(&self.path, &bytes)?)
    }

    /// Removes the checkpoint of a run that has ended.
    pub fn remove(&self) {
        if let Some(folder) = self.path.parent() {
            // A checkpoint left behind does no harm: its run has a result.
            let _ = std::fs::remove_dir_all(folder);
        }
    }

    fn refuse(&self, found: &str) -> InputError {
        let problem = Problem {
            message: "the run cannot be resumed".into(),
            found: found.into(),
            expected: "the checkpoint of this study".into(),
            help: "start again with `--overwrite`, or restore the study as it was".into(),
        };
        InputError::in_file(&self.path.display().to_string(), problem)
    }
}

/// What must be equal for two runs to have the same result.
fn key(study: &Study) -> String {
    let text = study.to_toml(Path::new("/")).unwrap_or_default();
    // The robot counts by its content, not by where its file lies.
    let settings = text.lines().filter(|line| !line.starts_with("design = "));
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    hash.update(&study.design.sha256);
    settings.for_each(|line| hash.update(line));
    format!("{:x}", hash.finalize())
}
