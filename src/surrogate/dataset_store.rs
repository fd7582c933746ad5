//! Labelled designs on disk: one file for some units, written whole or not at all.
//!
//! A file that is damaged, of other data or of another version counts as missing and is built
//! again. The folder's name is the hash of all that the content depends on.

use super::arm::SurrogateArm;
use super::dataset::{Dataset, Recipe, largest_known};
use rayon::prelude::*;
use sha2::{Digest, Sha256};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Raise this when labels or their layout change.
const FORMAT: u32 = 1;

/// Units of a file: what a killed build loses at most, per thread.
const FILE_UNITS: u64 = 16;

/// What a dataset's content depends on, hashed: lower-case hexadecimal.
pub fn data_hash(arm: &SurrogateArm, recipe: &Recipe) -> String {
    let content = postcard::to_stdvec(&(FORMAT, arm, recipe)).unwrap_or_default();
    format!("{:x}", Sha256::digest(content))
}

/// A build that was stopped from outside or could not write.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// The interrupt flag was set.
    #[error("interrupted")]
    Interrupted,
    /// A file could not be written.
    #[error("the labelled designs cannot be stored: {0}")]
    Io(#[from] io::Error),
}

/// Where and how to build; nothing here changes the data.
pub struct BuildOptions<'a> {
    /// Folder in which datasets are kept; none to build in memory.
    pub cache: Option<&'a Path>,
    /// Stops the build when set.
    pub interrupt: &'a AtomicBool,
    /// Hears how many of all units are there.
    pub on_progress: &'a (dyn Fn(u64, u64) + Sync),
}

/// The units of a recipe that `keep` names, from the cache as far as they are there.
///
/// # Errors
/// The build was interrupted, or the cache cannot be written to.
pub fn load_or_build(
    arm: &SurrogateArm,
    recipe: &Recipe,
    options: &BuildOptions,
) -> Result<Parts, BuildError> {
    let hash = data_hash(arm, recipe);
    let folder = options
        .cache
        .map(|cache| cache.join(format!("designs-{}", &hash[..16])));
    let largest = if recipe.walk_units > 0 {
        largest_known(arm, recipe.seed)
    } else {
        0.0
    };
    let done = AtomicU64::new(0);
    let build = |file: u64| -> Result<Vec<(u64, Dataset)>, BuildError> {
        let first = file * FILE_UNITS;
        let units = first..(first + FILE_UNITS).min(recipe.units());
        let path = folder.as_ref().map(|f| f.join(format!("{file:05}.bin")));
        let stored = path.as_ref().and_then(|path| load(path, &hash, file));
        let complete = stored.filter(|found| {
            found.len() as u64 == units.end - units.start
                && found.iter().all(|d| d.is_consistent(arm.joints()))
        });
        let datasets = match complete {
            Some(datasets) => datasets,
            None => {
                if options.interrupt.load(Ordering::Relaxed) {
                    return Err(BuildError::Interrupted);
                }
                let built: Vec<Dataset> = units
                    .clone()
                    .map(|unit| recipe.build_unit(arm, largest, unit))
                    .collect();
                if let Some(path) = &path {
                    save(path, &hash, file, &built)?;
                }
                built
            }
        };
        let count = units.end - units.start;
        let so_far = done.fetch_add(count, Ordering::Relaxed) + count;
        (options.on_progress)(so_far, recipe.units());
        Ok(units.zip(datasets).collect())
    };
    let files = recipe.units().div_ceil(FILE_UNITS);
    let built: Result<Vec<_>, BuildError> = (0..files).into_par_iter().map(build).collect();
    let mut parts = Parts::default();
    for (unit, dataset) in built?.into_iter().flatten() {
        match recipe.is_kept_back(unit) {
            true => parts.kept_back.append(dataset),
            false => parts.training.append(dataset),
        }
    }
    Ok(parts)
}

/// A dataset split by units, so that no walk is on both sides.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parts {
    /// To learn from: nine units in ten.
    pub training: Dataset,
    /// To stop training and to fit decoders: one unit in ten.
    pub kept_back: Dataset,
}

impl Parts {
    /// All designs.
    pub fn all(mut self) -> Dataset {
        self.training.append(self.kept_back);
        self.training
    }
}

fn header(hash: &str, file: u64, body: &[u8]) -> Vec<u8> {
    format!(
        "faultspace designs {FORMAT} {hash} {file} {:08x}\n",
        crc32fast::hash(body)
    )
    .into_bytes()
}

fn load(path: &PathBuf, hash: &str, file: u64) -> Option<Vec<Dataset>> {
    let bytes = std::fs::read(path).ok()?;
    let end = bytes.iter().position(|&byte| byte == b'\n')? + 1;
    let (head, body) = bytes.split_at(end);
    (head == header(hash, file, body)).then_some(())?;
    postcard::from_bytes(body).ok()
}

fn save(path: &Path, hash: &str, file: u64, datasets: &[Dataset]) -> io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder)?;
    let body = postcard::to_stdvec(datasets).map_err(io::Error::other)?;
    let mut temporary = tempfile::NamedTempFile::new_in(folder)?;
    temporary.write_all(&header(hash, file, &body))?;
    temporary.write_all(&body)?;
    temporary.persist(path)?;
    Ok(())
}
