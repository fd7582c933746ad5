//! The atlases of a study in parts: built on several machines, brought together by a merge.

use super::hybrid_arm::{Needed, check_cache, file_of, run_error};
use super::hybrid_settings::Hybrid;
use super::run::{Progress, RunError, RunOptions, pool};
use super::settings::{Estimator, Question, Study};
use crate::diagnostic::{InputError, Problem};
use crate::workspace::hybrid::AtlasStore;
use std::path::{Path, PathBuf};

/// One of several equal parts of the work, as in `2/8`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Which part, from 1 to `of`.
    pub number: u64,
    /// How many parts there are.
    pub of: u64,
}

/// What a part of the atlases came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShardReport {
    /// Shards of this part, all of which are in the cache now.
    pub done: u64,
    /// Shards of the whole study.
    pub all: u64,
    /// The folders that hold them.
    pub folders: Vec<PathBuf>,
}

/// What a merge came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MergeReport {
    /// Shards copied.
    pub copied: u64,
    /// Shards of the whole study.
    pub all: u64,
    /// Shards that are still missing.
    pub missing: u64,
    /// The folders that hold them.
    pub folders: Vec<PathBuf>,
}

/// Builds one part of the atlases that `study` needs into the cache of `options`; the report
/// folder is left alone.
///
/// # Errors
/// The study needs no atlas or a too large one, there is no cache, or the run was interrupted.
pub fn build_part(
    study: &Study,
    options: &RunOptions,
    part: Part,
    progress: &dyn Progress,
) -> Result<ShardReport, RunError> {
    let hybrid = hybrid_of(study)?;
    let cache = options.cache.as_deref().ok_or_else(|| no_cache(study))?;
    check_cache(Some(cache))?;
    pool(options)?.install(|| {
        let mut report = ShardReport {
            done: 0,
            all: 0,
            folders: Vec::new(),
        };
        for needed in Needed::all(study, hybrid)? {
            let all = needed.recipe.shards();
            let own: Vec<u64> = (0..all)
                .filter(|s| s % part.of == part.number - 1)
                .collect();
            let store = needed.recipe.store(cache);
            let tell = |done, total| progress.update(done, total, f64::NAN, "tracing");
            needed
                .recipe
                .build_part(&own, &store, &options.interrupt, &tell)
                .map_err(|error| run_error(study, error, &needed.prediction, Some(cache)))?;
            report.done += own.len() as u64;
            report.all += all;
            report.folders.push(store.folder().to_owned());
        }
        Ok(report)
    })
}

/// Copies the sound shards of `study` out of the folders `others` into `cache`.
///
/// # Errors
/// The study needs no atlas, a folder does not exist, or the cache cannot be written to.
pub fn merge(study: &Study, cache: &Path, others: &[PathBuf]) -> Result<MergeReport, RunError> {
    let hybrid = hybrid_of(study)?;
    for other in others {
        if !other.is_dir() {
            return Err(no_folder(other).into());
        }
    }
    check_cache(Some(cache))?;
    let mut report = MergeReport {
        copied: 0,
        all: 0,
        missing: 0,
        folders: Vec::new(),
    };
    for needed in Needed::all(study, hybrid)? {
        let (store, all) = (needed.recipe.store(cache), needed.recipe.shards());
        for other in others {
            report.copied += copy(&store, other, all)?;
        }
        report.all += all;
        report.missing += store.missing(all);
        report.folders.push(store.folder().to_owned());
    }
    Ok(report)
}

fn copy(store: &AtlasStore, other: &Path, shards: u64) -> Result<u64, RunError> {
    let copied = store.merge(other, shards);
    Ok(copied.map_err(anyhow::Error::from)?)
}

fn hybrid_of(study: &Study) -> Result<&Hybrid, InputError> {
    match (&study.question, &study.estimator) {
        (Question::Estimate(_) | Question::Optimise(_), Estimator::Hybrid { hybrid }) => Ok(hybrid),
        _ => {
            let problem = Problem {
                message: "this study has no atlas that could be built in parts".into(),
                found: format!("`kind = \"{}\"` without an atlas", study.question.kind()),
                expected: "an estimate or an optimisation with the estimator \"hybrid\"".into(),
                help: "run it as a whole, without `--shard`".into(),
            };
            Err(InputError::in_file(&file_of(study), problem))
        }
    }
}

fn no_cache(study: &Study) -> InputError {
    let problem = Problem {
        message: "a part of an atlas must be kept in a folder".into(),
        found: "no cache folder".into(),
        expected: "a folder for the shards".into(),
        help: "give one with `--cache DIR`".into(),
    };
    InputError::in_file(&file_of(study), problem)
}

fn no_folder(path: &Path) -> InputError {
    let problem = Problem {
        message: "there is no such cache folder".into(),
        found: "nothing".into(),
        expected: "the `--cache` folder of another run".into(),
        help: "check the path".into(),
    };
    InputError::in_file(&path.display().to_string(), problem)
}
