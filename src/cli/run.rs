//! `faultspace run`.

use super::{Ending, cache, output, progress, summary};
use crate::study::{self, Part, RunError, RunOptions, ShardReport, Study};
use clap::Args;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Most threads that may be asked for.
const MAX_THREADS: u64 = 1024;

#[derive(Debug, Args)]
pub(super) struct RunArguments {
    /// The study file
    #[arg(value_name = "STUDY.toml")]
    study: PathBuf,
    /// Report folder [default: reports/ and the study file's name]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Continue an interrupted run from its checkpoint
    #[arg(long, conflicts_with = "overwrite")]
    resume: bool,
    /// Replace an existing report
    #[arg(long)]
    overwrite: bool,
    /// Use this seed instead of the study's
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u64).range(1..=MAX_THREADS))]
    threads: Option<u64>,
    #[command(flatten)]
    cache: cache::CacheArguments,
    /// Only trace part I of N of the study's manifolds into the cache, e.g. on several machines
    #[arg(long, value_name = "I/N", value_parser = parse_part, conflicts_with_all = ["no_cache", "json"])]
    shard: Option<Part>,
    /// Print result.json on stdout instead of a summary
    #[arg(long)]
    json: bool,
    /// Show no progress
    #[arg(long)]
    quiet: bool,
}

pub(super) fn run(arguments: &RunArguments) -> Ending {
    let mut study = match Study::load(&arguments.study) {
        Ok(study) => study,
        Err(error) => return output::bad_input(&error),
    };
    study.seed = arguments.seed.unwrap_or(study.seed);
    let options = RunOptions {
        out: arguments.out.clone().unwrap_or_else(|| default_out(&study)),
        resume: arguments.resume,
        overwrite: arguments.overwrite,
        threads: arguments.threads.and_then(|n| usize::try_from(n).ok()),
        interrupt: interrupt_flag(),
        cache: arguments.cache.folder(),
    };
    let display = progress::display(arguments.quiet);
    if let Some(part) = arguments.shard {
        let built = study::build_part(&study, &options, part, display.as_ref());
        drop(display);
        return match built {
            Ok(report) => output::print(&describe(part, &report)),
            Err(RunError::Interrupted) => {
                output::message("interrupted; the same command goes on from the finished shards");
                Ending::Failed
            }
            Err(error) => failure(&error, &arguments.study),
        };
    }
    let result = study::run(&study, &options, Arc::clone(&display));
    // The bar goes before anything else is printed.
    drop(display);
    match result {
        Ok(result) if arguments.json => output::print(&format!("{result:#}\n")),
        Ok(result) => output::print(&summary::summary(&result, &options.out)),
        Err(error) => failure(&error, &arguments.study),
    }
}

/// Reads `I/N` with 1 ≤ I ≤ N.
fn parse_part(text: &str) -> Result<Part, String> {
    let part = text.split_once('/').and_then(|(number, of)| {
        let (number, of) = (number.parse().ok()?, of.parse().ok()?);
        Some(Part { number, of })
    });
    part.filter(|part| (1..=part.of).contains(&part.number))
        .ok_or_else(|| "expected I/N with I from 1 to N, as in 2/8".into())
}

fn describe(part: Part, report: &ShardReport) -> String {
    let folders = report.folders.iter();
    let folders: Vec<String> = folders.map(|f| f.display().to_string()).collect();
    format!(
        "part {} of {}: {} of {} shards are in {}\n\
         bring all parts together with `faultspace merge`, then run the study\n",
        part.number,
        part.of,
        report.done,
        report.all,
        folders.join(" and ")
    )
}

fn default_out(study: &Study) -> PathBuf {
    Path::new("reports").join(&study.name)
}

pub(super) fn failure(error: &RunError, study: &Path) -> Ending {
    match error {
        RunError::Input(error) => return output::bad_input(error),
        RunError::Interrupted => output::message(&format!(
            "interrupted; continue with `faultspace run {} --resume`",
            study.display()
        )),
        RunError::Failed(error) => output::message(&format!("error: {error:#}")),
    }
    Ending::Failed
}

/// A flag that Ctrl-C or SIGTERM sets; a second signal ends the process at once.
fn interrupt_flag() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let shared = Arc::clone(&flag);
    let handler = move || {
        if shared.swap(true, Ordering::SeqCst) {
            std::process::exit(1);
        }
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        output::message(&format!("warning: Ctrl-C will lose this run: {error}"));
    }
    flag
}
