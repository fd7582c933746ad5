//! One message about one mistake in the input.

use super::Source;
use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};
use std::fmt;
use std::ops::Range;

/// What is wrong, apart from where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The broken rule in one sentence without a full stop.
    pub message: String,
    /// What stands there, as in "found …".
    pub found: String,
    /// What may stand there, as in "expected …".
    pub expected: String,
    /// How to mend it.
    pub help: String,
}

/// A mistake in an input file or on the command line; leads to exit code 2.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputError {
    // Boxed, because it travels in every `Result` of the readers.
    details: Box<Details>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Details {
    problem: Problem,
    file: String,
    key: String,
    excerpt: Option<Excerpt>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Excerpt {
    text: String,
    span: Range<usize>,
    line: usize,
}

impl InputError {
    /// A mistake at the byte range `span` of `source`; `key` is the dotted path of the key, empty
    /// if none is meant. A span outside the text is moved into it.
    pub fn at(source: &Source, key: &str, span: Range<usize>, problem: Problem) -> InputError {
        let text = source.text().to_owned();
        let start = text.floor_char_boundary(span.start);
        let end = text.ceil_char_boundary(span.end.max(start));
        let line = 1 + text[..start].bytes().filter(|&byte| byte == b'\n').count();
        let excerpt = Excerpt {
            text,
            span: start..end,
            line,
        };
        InputError::build(source.file(), key, Some(excerpt), problem)
    }

    /// A mistake about a file or folder as a whole.
    pub fn in_file(file: &str, problem: Problem) -> InputError {
        InputError::build(file, "", None, problem)
    }

    fn build(file: &str, key: &str, excerpt: Option<Excerpt>, problem: Problem) -> InputError {
        let details = Details {
            problem,
            file: file.to_owned(),
            key: key.to_owned(),
            excerpt,
        };
        InputError {
            details: Box::new(details),
        }
    }

    /// The file or folder the mistake is in, as the user named it.
    pub fn file(&self) -> &str {
        &self.details.file
    }

    /// The line of the mistake, from 1; `None` if it is about the file as a whole.
    pub fn line(&self) -> Option<usize> {
        self.details.excerpt.as_ref().map(|excerpt| excerpt.line)
    }

    /// The dotted path of the key, e.g. `limits.lower_deg`; empty if no key is meant.
    pub fn key(&self) -> &str {
        &self.details.key
    }

    /// What is wrong.
    pub fn problem(&self) -> &Problem {
        &self.details.problem
    }

    /// The message as rustc would print it, with colours if `styled`; no final line break.
    pub fn render(&self, styled: bool) -> String {
        let renderer = if styled {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        let (title, label) = (self.title(), self.label());
        let (file, help) = (printable(self.file()), printable(&self.problem().help));
        let group = Level::ERROR.primary_title(title);
        let group = match &self.details.excerpt {
            Some(excerpt) => {
                let mark = AnnotationKind::Primary.span(excerpt.span.clone());
                let snippet = Snippet::source(&excerpt.text).path(file);
                group.element(snippet.annotation(mark.label(label)))
            }
            None => group
                .element(Origin::path(file))
                .element(Level::NOTE.message(label)),
        };
        renderer.render(&[group.element(Level::HELP.message(help))])
    }

    fn title(&self) -> String {
        let message = printable(&self.problem().message);
        match self.key() {
            "" => message,
            key => format!("`{}`: {message}", printable(key)),
        }
    }

    fn label(&self) -> String {
        let problem = self.problem();
        printable(&format!(
            "found {}, expected {}",
            problem.found, problem.expected
        ))
    }
}

/// One line: `file:line: title: found …, expected …`.
impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", printable(self.file()))?;
        if let Some(line) = self.line() {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}: {}", self.title(), self.label())
    }
}

impl std::error::Error for InputError {}

/// `text` with control characters written out: a file must not steer the terminal.
fn printable(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        if character.is_control() {
            out.extend(character.escape_default());
        } else {
            out.push(character);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem() -> Problem {
        Problem {
            message: "must be positive".into(),
            found: "-1".into(),
            expected: "a length above 0".into(),
            help: "give the length in metres".into(),
        }
    }

    #[test]
    fn looks_like_rustc() {
        let source = Source::new("designs/x.toml", "name = \"x\"\nlinks = [1, -1]\n");
        let error = InputError::at(&source, "links", 23..25, problem());
        let expected = "\
error: `links`: must be positive
 --> designs/x.toml:2:13
  |
2 | links = [1, -1]
  |             ^^ found -1, expected a length above 0
  |
  = help: give the length in metres";
        assert_eq!(error.render(false), expected);
        assert_eq!(error.line(), Some(2));
    }

    #[test]
    fn any_span_of_any_text_can_be_rendered() {
        for text in ["", "\n", "é", "a\r\nb", "\u{feff}x = 1", "tab\t= \"\0\""] {
            for start in 0..text.len() + 2 {
                for end in 0..text.len() + 3 {
                    let source = Source::new("f", text);
                    let error = InputError::at(&source, "k", start..end, problem());
                    assert!(error.render(false).contains("must be positive"));
                    assert!(error.line().is_some_and(|line| line <= 3));
                }
            }
        }
    }

    #[test]
    fn without_an_excerpt_the_file_is_named() {
        let text = InputError::in_file("reports/x", problem()).render(false);
        assert!(text.contains("--> reports/x") && text.contains("help: give"));
    }
}
