//! A TOML text with the place of every key and value.

use super::{InputError, Problem, Source, Table};
use std::cell::RefCell;
use std::ops::Range;
use toml::Spanned;
use toml::de::DeTable;

/// Where a key or value stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Dotted path of the key, e.g. `limits.lower_deg`.
    pub key: String,
    /// Byte range in the text.
    pub span: Range<usize>,
}

/// A value and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Item<T> {
    /// The value.
    pub value: T,
    /// Where it stands.
    pub place: Place,
}

/// Collects problems of one text and keeps the first in file order.
///
/// A reader reports what it finds and goes on, so that the message is about the first mistake
/// in the file, not about the first one the reader happened to look for.
#[derive(Debug)]
pub struct Problems<'s> {
    source: &'s Source,
    /// The first problem and its rank: whether it is about something absent, then its offset.
    first: RefCell<Option<(Rank, InputError)>>,
}

type Rank = (bool, usize);

impl<'s> Problems<'s> {
    /// No problems yet.
    pub fn new(source: &'s Source) -> Problems<'s> {
        Problems {
            source,
            first: RefCell::new(None),
        }
    }

    /// The text the problems are in.
    pub fn source(&self) -> &'s Source {
        self.source
    }

    /// Notes a problem at `place`.
    pub fn report(&self, place: &Place, problem: Problem) {
        self.keep_first((false, place.span.start), place, problem);
    }

    /// Notes that something is missing from the table or file at `place`.
    ///
    /// Anything else that is wrong comes first, wherever it stands: a misspelt key makes the right
    /// one absent, and the misspelling is the mistake.
    pub fn report_absent(&self, place: &Place, problem: Problem) {
        self.keep_first((true, place.span.start), place, problem);
    }

    /// Notes a mistake in another file, which the value at `place` names.
    pub fn pass_on(&self, place: &Place, error: InputError) {
        self.keep((false, place.span.start), || error);
    }

    fn keep_first(&self, rank: Rank, place: &Place, problem: Problem) {
        self.keep(rank, || {
            InputError::at(self.source, &place.key, place.span.clone(), problem)
        });
    }

    fn keep(&self, rank: Rank, error: impl FnOnce() -> InputError) {
        let mut first = self.first.borrow_mut();
        if first.as_ref().is_none_or(|(kept, _)| rank < *kept) {
            *first = Some((rank, error()));
        }
    }

    /// As [`Problems::report`], with "found" quoted from the text.
    pub fn reject(&self, place: &Place, message: &str, expected: &str, help: &str) {
        let problem = Problem {
            message: message.to_owned(),
            found: self.quote(&place.span),
            expected: expected.to_owned(),
            help: help.to_owned(),
        };
        self.report(place, problem);
    }

    /// `value` if nothing was reported.
    ///
    /// # Errors
    /// The first problem in file order.
    pub fn finish<T>(self, value: Option<T>) -> Result<T, InputError> {
        match (self.first.into_inner(), value) {
            (Some((_, error)), _) => Err(error),
            (None, Some(value)) => Ok(value),
            // Readers return nothing only after a report; should one forget, say so and not panic.
            (None, None) => Err(InputError::in_file(
                self.source.file(),
                Problem {
                    message: "the file cannot be read".into(),
                    found: "something this version does not understand".into(),
                    expected: "a robot or a study".into(),
                    help: "compare with the files that `faultspace list` shows".into(),
                },
            )),
        }
    }

    /// The text of `span`, shortened.
    pub(super) fn quote(&self, span: &Range<usize>) -> String {
        const LONGEST: usize = 40;
        let text = self.source.text().get(span.clone()).unwrap_or("");
        let line = text.lines().next().unwrap_or("");
        if line.is_empty() {
            return "nothing".into();
        }
        if line.len() == text.len() && line.chars().count() <= LONGEST {
            return line.to_owned();
        }
        let head: String = line.chars().take(LONGEST).collect();
        format!("{head}…")
    }
}

/// A parsed TOML text. Integers, floats and strings are decoded when a [`Table`] hands them out.
pub struct Document<'s> {
    root: Spanned<DeTable<'s>>,
    problems: Problems<'s>,
}

impl<'s> Document<'s> {
    /// Parses `source`.
    ///
    /// # Errors
    /// The text is not TOML.
    pub fn parse(source: &'s Source) -> Result<Document<'s>, InputError> {
        let root = DeTable::parse(source.text()).map_err(|error| syntax_error(source, &error))?;
        Ok(Document {
            root,
            problems: Problems::new(source),
        })
    }

    /// The table of all top-level keys, of which only `known` ones are allowed.
    pub fn root(&self, known: &'static [&'static str]) -> Table<'_> {
        let start = Place {
            key: String::new(),
            span: 0..0,
        };
        Table::open(&self.problems, self.root.get_ref(), start, known)
    }

    /// Whether the text has the top-level key `key`.
    pub fn has(&self, key: &str) -> bool {
        self.root.get_ref().contains_key(key)
    }

    /// `value` if nothing was reported.
    ///
    /// # Errors
    /// The first problem in file order.
    pub fn finish<T>(self, value: Option<T>) -> Result<T, InputError> {
        self.problems.finish(value)
    }
}

fn syntax_error(source: &Source, error: &toml::de::Error) -> InputError {
    let span = error.span().unwrap_or(0..0);
    let message = error.message().lines().next().unwrap_or("");
    let problem = Problem {
        message: format!("not TOML: {message}"),
        found: Problems::new(source).quote(&span),
        expected: "a line like `key = value` or `[table]`".into(),
        help: "see https://toml.io for the format".into(),
    };
    InputError::at(
        source,
        &key_of_line(source.text(), span.start),
        span,
        problem,
    )
}

/// The bare key at the start of the line of byte `offset`, if there is one: a syntax error in a
/// value is easier to find by its key.
fn key_of_line(text: &str, offset: usize) -> String {
    let offset = text.floor_char_boundary(offset);
    let start = text[..offset].rfind('\n').map_or(0, |at| at + 1);
    let line = text[start..].lines().next().unwrap_or("");
    let key = line.split_once('=').map_or("", |(key, _)| key.trim());
    let bare = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
    if key.chars().all(bare) {
        key.to_owned()
    } else {
        String::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn syntax_errors_point_at_the_line_and_name_the_key() {
        let source = Source::new("s.toml", "kind = \"estimate\"\nseed = = 3\n");
        let error = Document::parse(&source).err().unwrap();
        assert_eq!((error.line(), error.key()), (Some(2), "seed"));
    }

    #[test]
    fn the_first_problem_in_file_order_is_kept() {
        let source = Source::new("s.toml", "aa = 1\nbb = 2\n");
        let problems = Problems::new(&source);
        for (key, span) in [("bb", 12..13), ("aa", 5..6), ("bb", 7..9)] {
            let place = Place {
                key: key.into(),
                span,
            };
            problems.reject(&place, "wrong", "right", "mend");
        }
        let error = problems.finish(Some(())).unwrap_err();
        assert_eq!((error.key(), error.problem().found.as_str()), ("aa", "1"));
    }
}
