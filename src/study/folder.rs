//! The report folder: may the run write there?

use super::run::RunOptions;
use crate::diagnostic::{InputError, Problem};
use crate::report::is_unfinished;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Files and folders that tell a report from anything else.
const MARKS: [&str; 3] = ["result.json", "study.toml", "checkpoint"];

/// Checks, without leaving a trace, that the report folder may be made or written to.
///
/// An existing empty folder is as good as none. With `overwrite` a folder that holds something
/// else than a report is still refused, because overwriting a report may remove what is there.
///
/// # Errors
/// The folder holds a report and neither `resume` nor `overwrite` is set; it holds something
/// else; it is no folder; or it cannot be written to.
pub fn check_folder(options: &RunOptions) -> Result<(), InputError> {
    let out = &options.out;
    if out.exists() && !out.is_dir() {
        let found = "something that is not a folder";
        return Err(error(
            out,
            "the report needs a folder",
            found,
            "choose another `--out`",
        ));
    }
    if has_entries(out).map_err(|cause| unwritable(out, &cause))? {
        check_content(options)?;
    }
    let ground = existing_ancestor(out);
    match tempfile::tempfile_in(&ground) {
        Ok(_) => Ok(()),
        Err(cause) => Err(unwritable(out, &cause)),
    }
}

fn check_content(options: &RunOptions) -> Result<(), InputError> {
    let out = &options.out;
    let is_report = MARKS.iter().any(|mark| out.join(mark).exists());
    if !is_report {
        let message = "the folder holds something that is not a report";
        let found = "a folder with other files";
        return Err(error(out, message, found, "choose another `--out`"));
    }
    if options.resume || options.overwrite {
        return Ok(());
    }
    let help =
        "add `--overwrite` to replace it, `--resume` to continue it, or choose another `--out`";
    let found = "an existing report";
    Err(error(out, "the report folder already exists", found, help))
}

/// Whether there is anything but what a killed run left half-written.
fn has_entries(folder: &Path) -> io::Result<bool> {
    let counts = |entry: &io::Result<fs::DirEntry>| match entry {
        Ok(entry) => !is_unfinished(&entry.file_name()),
        Err(_) => true,
    };
    match fs::read_dir(folder) {
        Ok(entries) => Ok(entries.into_iter().any(|entry| counts(&entry))),
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(cause) => Err(cause),
    }
}

/// The nearest folder above `path`, or `path` itself, that exists.
fn existing_ancestor(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let found = absolute.ancestors().find(|ancestor| ancestor.exists());
    found.unwrap_or(Path::new(".")).to_owned()
}

/// `path` made absolute, with symbolic links resolved as far as it exists.
pub(super) fn resolve(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let ground = existing_ancestor(&absolute);
    match (ground.canonicalize(), absolute.strip_prefix(&ground)) {
        (Ok(resolved), Ok(rest)) => resolved.join(rest),
        _ => absolute,
    }
}

fn unwritable(out: &Path, cause: &io::Error) -> InputError {
    let message = "the report folder cannot be written to";
    error(out, message, &cause.to_string(), "choose another `--out`")
}

fn error(out: &Path, message: &str, found: &str, help: &str) -> InputError {
    let problem = Problem {
        message: message.to_owned(),
        found: found.to_owned(),
        expected: "a new or empty folder that can be written to".into(),
        help: help.to_owned(),
    };
    InputError::in_file(&out.display().to_string(), problem)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(out: PathBuf) -> RunOptions {
        RunOptions {
            out,
            resume: false,
            overwrite: false,
            threads: None,
            interrupt: Default::default(),
            cache: None,
        }
    }

    #[test]
    fn a_new_or_empty_folder_is_fine_and_stays_untouched() {
        let dir = tempfile::tempdir().unwrap();
        check_folder(&options(dir.path().join("a/b"))).unwrap();
        check_folder(&options(dir.path().to_owned())).unwrap();
        assert!(!has_entries(dir.path()).unwrap());
    }

    /// A run that is killed before its first file is whole must not stand in the way of the next.
    #[test]
    fn half_written_files_do_not_count() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join(".faultspace-x1.tmp"), "half").unwrap();
        check_folder(&options(dir.path().to_owned())).unwrap();
        crate::report::remove_unfinished(dir.path());
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_report_is_only_replaced_on_request() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("result.json"), "{}").unwrap();
        let mut options = options(dir.path().to_owned());
        let error = check_folder(&options).unwrap_err();
        assert!(error.problem().help.contains("--overwrite"));
        options.overwrite = true;
        check_folder(&options).unwrap();
    }

    #[test]
    fn other_files_are_never_overwritten() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("thesis.tex"), "").unwrap();
        let mut options = options(dir.path().to_owned());
        options.overwrite = true;
        assert!(check_folder(&options).is_err());
        options.out = dir.path().join("thesis.tex");
        assert!(check_folder(&options).is_err());
        options.out = dir.path().join("thesis.tex/report");
        assert!(check_folder(&options).is_err());
    }
}
