//! The command line: parses arguments, calls a study or a reader, prints, and picks the exit code.
//!
//! Results go to stdout, progress and messages to stderr. Exit codes: 0 done, 1 the study failed
//! or was interrupted, 2 bad input.

mod cache;
mod check;
mod joint_table;
mod list;
mod merge;
mod output;
mod progress;
mod run;
mod show;
mod summary;

use clap::{CommandFactory, Parser, Subcommand};
use clap_complete::Shell;
use std::path::PathBuf;
use std::process::ExitCode;

/// Designs redundant robot arms whose workspace survives a locked joint.
#[derive(Debug, Parser)]
#[command(name = "faultspace", version, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a study and write its report
    Run(run::RunArguments),
    /// Validate design and study files without running anything
    Check {
        /// Robot or study files
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// Show what a robot file describes
    Show {
        /// A robot file
        #[arg(value_name = "DESIGN")]
        design: PathBuf,
        /// Draw the robot as well, as PNG or SVG (planar robots)
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
    /// Bring together manifolds that were traced in parts with `run --shard`
    Merge(merge::MergeArguments),
    /// List the designs and studies under the current folder
    List,
    /// Print a completion script for a shell
    Completions {
        /// The shell
        shell: Shell,
    },
}

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ending {
    Done,
    Failed,
    BadInput,
}

impl From<Ending> for ExitCode {
    fn from(ending: Ending) -> ExitCode {
        ExitCode::from(match ending {
            Ending::Done => 0,
            Ending::Failed => 1,
            Ending::BadInput => 2,
        })
    }
}

/// Runs the command that the process was called with.
pub fn main() -> ExitCode {
    let ending = match Arguments::parse().command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Check { files } => check::check(&files),
        Command::Show { design, out } => show::show(&design, out.as_deref()),
        Command::Merge(arguments) => merge::merge(&arguments),
        Command::List => list::list(),
        Command::Completions { shell } => completions(shell),
    };
    ending.into()
}

fn completions(shell: Shell) -> Ending {
    // Through a buffer, because the generator panics if stdout is closed.
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "faultspace", &mut script);
    output::print(&String::from_utf8_lossy(&script))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_definition_is_sound() {
        Arguments::command().debug_assert();
    }
}
