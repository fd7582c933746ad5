//! The text of one input file.

use super::{InputError, Problem};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Longest file that is read, bytes. Inputs are a few kilobytes; the limit keeps a device file or
/// a mistaken data file from filling the memory.
const MAX_BYTES: u64 = 4 << 20;

/// A file's name, as the user gave it, and its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    file: String,
    text: String,
}

impl Source {
    /// A text under the name errors give it.
    pub fn new(file: impl Into<String>, text: impl Into<String>) -> Source {
        Source {
            file: file.into(),
            text: text.into(),
        }
    }

    /// Reads the file at `path`.
    ///
    /// # Errors
    /// The file is missing, unreadable, longer than 4 MiB or not UTF-8.
    pub fn read(path: &Path) -> Result<Source, InputError> {
        let file = path.display().to_string();
        match read_bytes(path) {
            Ok(bytes) if bytes.len() as u64 > MAX_BYTES => Err(too_long(&file)),
            Ok(bytes) => decode(file, bytes),
            Err(error) => Err(unreadable(&file, &error)),
        }
    }

    /// The file's name as the user gave it.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The whole text, byte for byte as in the file.
    pub fn text(&self) -> &str {
        &self.text
    }
}

fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?
        .take(MAX_BYTES + 1)
        .read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn decode(file: String, bytes: Vec<u8>) -> Result<Source, InputError> {
    String::from_utf8(bytes)
        .map(|text| Source::new(file.as_str(), text))
        .map_err(|error| {
            let bad = error.utf8_error().valid_up_to();
            // Everything before the first bad byte stays as it is, so its line is right.
            let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
            let problem = Problem {
                message: "the file is not UTF-8 text".into(),
                found: "a byte that is not UTF-8".into(),
                expected: "text in UTF-8".into(),
                help: "save the file with the encoding UTF-8".into(),
            };
            InputError::at(&Source::new(file.as_str(), text), "", bad..bad + 1, problem)
        })
}

fn too_long(file: &str) -> InputError {
    let problem = Problem {
        message: "the file is too long".into(),
        found: format!("more than {MAX_BYTES} bytes"),
        expected: "an input file of some kilobytes".into(),
        help: "check that this is the file you meant".into(),
    };
    InputError::in_file(file, problem)
}

fn unreadable(file: &str, error: &io::Error) -> InputError {
    let problem = Problem {
        message: format!("cannot read `{file}`"),
        found: error.to_string(),
        expected: "a readable TOML file".into(),
        help: "check the path; `faultspace list` shows the designs and studies here".into(),
    };
    InputError::in_file(file, problem)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn says_where_the_text_stops_being_utf_8() {
        let error = decode("x.toml".into(), b"a = 1\nb = \"\xff\"\n".to_vec()).unwrap_err();
        assert_eq!(error.line(), Some(2));
        assert!(error.render(false).contains("x.toml:2"));
    }

    #[test]
    fn names_the_missing_file() {
        let error = Source::read(Path::new("no/such/file.toml")).unwrap_err();
        assert!(error.render(false).contains("no/such/file.toml"));
        assert_eq!(error.line(), None);
    }
}
