//! From the path of a study file to a validated study.

use super::settings::{Design, Study};
use super::{StudyFile, validate};
use crate::design::parse_design_files;
use crate::diagnostic::{Document, InputError, Problem, Problems, Source};
use sha2::{Digest, Sha256};
use std::fmt::Write;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

impl Study {
    /// Reads and validates the study file at `path` and the robot file it names.
    ///
    /// # Errors
    /// The first mistake found: in the study file itself, in the robot file, or between the two.
    pub fn load(path: &Path) -> Result<Study, InputError> {
        let source = Source::read(path)?;
        let file = StudyFile::parse(&source)?;
        let design = load_design(&source, &file, path.parent().unwrap_or(Path::new("")))?;
        let stem = path.file_stem().unwrap_or_default();
        Study::validate(&stem.to_string_lossy(), &file, &source, design)
    }

    /// Checks what a study file says against the robot and fills in defaults. `source` is the
    /// text `file` was parsed from.
    ///
    /// # Errors
    /// The first mistake in file order.
    pub fn validate(
        name: &str,
        file: &StudyFile,
        source: &Source,
        design: Design,
    ) -> Result<Study, InputError> {
        let problems = Problems::new(source);
        let study = validate::study(name, file, &problems, design);
        problems.finish(study)
    }
}

impl Design {
    /// Reads a robot from the text of its file; `path` is where the file is.
    ///
    /// # Errors
    /// The text does not describe a robot.
    pub fn parse(path: PathBuf, source: &Source) -> Result<Design, InputError> {
        let design = parse_design_files(source)?;
        let mut bytes = source.text().as_bytes().to_vec();
        if let Some(urdf) = &design.urdf {
            // A zero byte is in neither text: no two pairs of files run together to the same bytes.
            bytes.push(0);
            bytes.extend(urdf.text().as_bytes());
        }
        Ok(Design {
            path,
            sha256: sha256(&bytes),
            robot: design.robot,
        })
    }
}

/// Whether `source` is meant to be a study rather than a robot: it has a key only studies have.
pub fn is_study(source: &Source) -> bool {
    let own = ["kind", "design", "task"];
    Document::parse(source).is_ok_and(|document| own.iter().any(|key| document.has(key)))
}

fn load_design(source: &Source, file: &StudyFile, folder: &Path) -> Result<Design, InputError> {
    let path = folder.join(file.design());
    // A path that cannot be resolved cannot be read either; the study's key is where to mend it.
    match resolve_file(&path) {
        Ok(resolved) => Design::parse(resolved, &Source::read(&path)?),
        Err(error) => {
            let problem = Problem {
                message: "cannot read the robot file".into(),
                found: format!("`{}`: {error}", path.display()),
                expected: "a robot file; its path is relative to the study file".into(),
                help: "mend the path; `faultspace list` shows the designs here".into(),
            };
            let place = &file.design.place;
            let span = place.span.clone();
            Err(InputError::at(source, &place.key, span, problem))
        }
    }
}

/// The absolute path of a file that can be opened.
fn resolve_file(path: &Path) -> io::Result<PathBuf> {
    let resolved = path.canonicalize()?;
    if resolved.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    File::open(&resolved).map(|_| resolved)
}

fn sha256(bytes: &[u8]) -> String {
    let mut hex = String::with_capacity(64);
    for byte in Sha256::digest(bytes) {
        // Writing to a string cannot fail.
        let _ = write!(hex, "{byte:02x}");
    }
    hex
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_the_standard_one() {
        let empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
        assert_eq!(sha256(b""), empty);
    }

    #[test]
    fn studies_are_told_from_robots() {
        assert!(is_study(&Source::new("s", "kind = 1")));
        assert!(!is_study(&Source::new("r", "name = 'r'\nlinks = [1, 1]")));
        assert!(!is_study(&Source::new("x", "= =")));
    }
}
