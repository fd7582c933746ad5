//! `faultspace check`.

use super::{Ending, output};
use crate::design::parse_design;
use crate::diagnostic::{InputError, Source};
use crate::study::{Study, is_study};
use std::path::{Path, PathBuf};

/// Checks every file, also those after a bad one.
pub(super) fn check(files: &[PathBuf]) -> Ending {
    let mut ending = Ending::Done;
    for file in files {
        let checked = match describe(file) {
            Ok(what) => output::print(&format!("ok: {} ({what})\n", file.display())),
            Err(error) => output::bad_input(&error),
        };
        if checked != Ending::Done {
            ending = checked;
        }
    }
    ending
}

fn describe(file: &Path) -> Result<String, InputError> {
    let source = Source::read(file)?;
    if is_study(&source) {
        let study = Study::load(file)?;
        let (kind, robot) = (study.question.kind(), &study.design.robot.name);
        return Ok(format!("study: {kind} {robot}, {}", study.task));
    }
    let robot = parse_design(&source)?;
    Ok(format!("design: {}, {} joints", robot.name, robot.joints()))
}
