//! `faultspace list`.

use super::{Ending, output};
use crate::design::read_design;
use crate::diagnostic::InputError;
use crate::study::Study;
use std::path::{Path, PathBuf};

/// Prints one line for each file in `designs/` and `studies/` under the current folder.
pub(super) fn list() -> Ending {
    let designs = lines("designs", |path| read_design(path).map(|robot| robot.name));
    let studies = lines("studies", |path| {
        Study::load(path).map(|study| title(&study))
    });
    if designs.is_empty() && studies.is_empty() {
        output::message("there is no robot in designs/ and no study in studies/ here");
    }
    output::print(&(designs + &studies))
}

fn title(study: &Study) -> String {
    let kind = study.question.kind();
    let robot = &study.design.robot.name;
    let title = study.title.clone();
    title.unwrap_or_else(|| format!("{kind} {robot}, {}", study.task))
}

fn lines(folder: &str, describe: impl Fn(&Path) -> Result<String, InputError>) -> String {
    let line = |path: PathBuf| {
        let what = match describe(&path) {
            Ok(what) => what,
            Err(error) => format!("(bad: {error})"),
        };
        format!("{:<40} {what}\n", path.display().to_string())
    };
    files(folder).into_iter().map(line).collect()
}

/// The TOML files of `folder`, sorted; none if there is no such folder.
fn files(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> = entries
        .map(|entry| entry.path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .collect();
    files.sort();
    files
}
