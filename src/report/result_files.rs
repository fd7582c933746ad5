//! Result files appear whole or not at all.

use super::error::ReportError;
use std::io::Write;
use std::path::Path;

/// Writes `bytes` to `path`: first to a temporary file in the same directory, then renamed, so
/// that an interrupted run leaves the old file. Missing directories are created.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), ReportError> {
    let fail = |source| ReportError::Write {
        path: path.to_path_buf(),
        source,
    };
    let directory = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    std::fs::create_dir_all(directory).map_err(fail)?;
    let mut file = temporary(directory).map_err(fail)?;
    file.write_all(bytes).map_err(fail)?;
    file.as_file().sync_all().map_err(fail)?;
    file.persist(path).map_err(|error| fail(error.error))?;
    Ok(())
}

/// [`write_bytes`] of a text.
pub fn write_text(path: &Path, text: &str) -> Result<(), ReportError> {
    write_bytes(path, text.as_bytes())
}

/// Writes indented JSON with a final line break.
pub fn write_json(path: &Path, value: &serde_json::Value) -> Result<(), ReportError> {
    let mut text = serde_json::to_string_pretty(value)?;
    text.push('\n');
    write_text(path, &text)
}

/// How the names of temporary files begin and end.
const TEMPORARY: [&str; 2] = [".faultspace-", ".tmp"];

/// Whether `name` is that of a temporary file: a run that is killed while it writes leaves one.
pub fn is_unfinished(name: &std::ffi::OsStr) -> bool {
    let name = name.to_string_lossy();
    name.starts_with(TEMPORARY[0]) && name.ends_with(TEMPORARY[1])
}

/// Removes what a killed run left half-written in `folder`. What cannot be removed does no harm.
pub fn remove_unfinished(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        if is_unfinished(&entry.file_name()) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// A temporary file with the permissions of an ordinary one (tempfile's default is private).
fn temporary(directory: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY[0]).suffix(TEMPORARY[1]);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(directory)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_a_file_and_leaves_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("new").join("result.json");
        write_text(&path, "old").unwrap();
        write_json(&path, &serde_json::json!({ "b": 1, "a": 2.5 })).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text, "{\n  \"b\": 1,\n  \"a\": 2.5\n}\n");
        assert_eq!(
            std::fs::read_dir(path.parent().unwrap()).unwrap().count(),
            1
        );
    }

    #[test]
    fn a_refusal_names_the_file() {
        let directory = tempfile::tempdir().unwrap();
        let error = write_text(directory.path(), "over a directory").unwrap_err();
        assert!(error.to_string().contains("cannot write"), "{error}");
    }
}
