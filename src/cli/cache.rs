//! Where traced manifolds are kept between runs.

use clap::Args;
use std::path::PathBuf;

/// Names the cache folder if no option does.
const VARIABLE: &str = "FAULTSPACE_CACHE";

/// The options about the cache folder of `run`.
#[derive(Debug, Args)]
pub(super) struct CacheArguments {
    /// Keep traced manifolds in this folder [default: $FAULTSPACE_CACHE, else the platform's]
    #[arg(long, value_name = "DIR", conflicts_with = "no_cache")]
    cache: Option<PathBuf>,
    /// Keep traced manifolds in memory only
    #[arg(long)]
    no_cache: bool,
}

impl CacheArguments {
    /// The folder, if there is to be one.
    pub fn folder(&self) -> Option<PathBuf> {
        match self.no_cache {
            true => None,
            false => folder(self.cache.clone()),
        }
    }
}

/// `given`, or the folder that the environment or the platform names.
pub(super) fn folder(given: Option<PathBuf>) -> Option<PathBuf> {
    let named = || {
        let value = std::env::var_os(VARIABLE)?;
        (!value.is_empty()).then(|| PathBuf::from(value))
    };
    let platform = || Some(dirs::cache_dir()?.join("faultspace"));
    given.or_else(named).or_else(platform)
}
