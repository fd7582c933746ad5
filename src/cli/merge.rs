//! `faultspace merge`.

use super::{Ending, cache, output, run};
use crate::study::{self, MergeReport, Study};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct MergeArguments {
    /// The study file
    #[arg(value_name = "STUDY.toml")]
    study: PathBuf,
    /// Cache folders of other runs, e.g. of `run --shard`
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    /// The folder to copy to [default: $FAULTSPACE_CACHE, else the platform's]
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// The seed of the runs, if it is not the study's
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    seed: Option<u64>,
}

pub(super) fn merge(arguments: &MergeArguments) -> Ending {
    let mut study = match Study::load(&arguments.study) {
        Ok(study) => study,
        Err(error) => return output::bad_input(&error),
    };
    study.seed = arguments.seed.unwrap_or(study.seed);
    let Some(cache) = cache::folder(arguments.cache.clone()) else {
        output::message("error: this platform names no cache folder; give one with `--cache DIR`");
        return Ending::BadInput;
    };
    match study::merge(&study, &cache, &arguments.folders) {
        Ok(report) => output::print(&describe(&report)),
        Err(error) => run::failure(&error, &arguments.study),
    }
}

fn describe(report: &MergeReport) -> String {
    let missing = match report.missing {
        0 => "none is missing".to_owned(),
        1 => "1 is still missing".to_owned(),
        n => format!("{n} are still missing"),
    };
    let (copied, all) = (report.copied, report.all);
    format!("{copied} of {all} shards copied; {missing}\n")
}
