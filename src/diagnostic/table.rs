//! Typed access to the values of a TOML table.
//!
//! Every getter returns `None` both for an absent key and for a bad value; the bad value has then
//! been reported, and the document's `finish` refuses the whole. Defaults can therefore be filled
//! in with `unwrap_or` without hiding a mistake.

use super::{Item, Place, Problem, Problems, nearest};
use std::ops::{Range, RangeInclusive};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A TOML table whose keys are all known.
pub struct Table<'d> {
    problems: &'d Problems<'d>,
    table: &'d DeTable<'d>,
    header: Place,
}

/// One value of a table or an array.
#[derive(Clone)]
pub struct Entry<'d> {
    problems: &'d Problems<'d>,
    value: &'d DeValue<'d>,
    place: Place,
}

impl<'d> Table<'d> {
    /// Wraps a parsed table and reports every key that is not in `known`.
    pub(super) fn open(
        problems: &'d Problems<'d>,
        table: &'d DeTable<'d>,
        header: Place,
        known: &[&str],
    ) -> Table<'d> {
        let opened = Table {
            problems,
            table,
            header,
        };
        for (key, _) in table.iter() {
            if !known.contains(&key.get_ref().as_ref()) {
                opened.report_unknown(key.get_ref(), key.span(), known);
            }
        }
        opened
    }

    /// Where the table's header stands.
    pub fn place(&self) -> &Place {
        &self.header
    }

    /// Where problems of this table go.
    pub fn problems(&self) -> &'d Problems<'d> {
        self.problems
    }

    /// The value of `key`, of any type.
    pub fn entry(&self, key: &str) -> Option<Entry<'d>> {
        let value = self.table.get(key)?;
        Some(Entry {
            problems: self.problems,
            value: value.get_ref(),
            place: Place {
                key: self.path(key),
                span: value.span(),
            },
        })
    }

    /// Where `key` itself stands, if the table has it.
    pub fn key_place(&self, key: &str) -> Option<Place> {
        let (written, _) = self.table.get_key_value(key)?;
        Some(Place {
            key: self.path(key),
            span: written.span(),
        })
    }

    /// Reports `key` if it is absent; `example` is a line that would do, e.g. `links = [1.0]`.
    pub fn require(&self, key: &str, example: &str) {
        if self.table.contains_key(key) {
            return;
        }
        let place = Place {
            key: self.path(key),
            span: self.header.span.clone(),
        };
        let problem = Problem {
            message: "this key is missing".into(),
            found: "nothing".into(),
            expected: format!("the key `{key}`"),
            help: format!("add `{example}`"),
        };
        self.problems.report_absent(&place, problem);
    }

    /// A sub-table with the given known keys.
    pub fn table(&self, key: &str, known: &[&str]) -> Option<Table<'d>> {
        self.entry(key)?.table(known)
    }

    /// A string.
    pub fn text(&self, key: &str) -> Option<Item<String>> {
        self.entry(key)?.text()
    }

    /// A string out of `choices`, as the value it stands for.
    pub fn choice<T: Clone>(&self, key: &str, choices: &[(&str, T)]) -> Option<Item<T>> {
        self.entry(key)?.choice(choices)
    }

    /// `true` or `false`.
    pub fn boolean(&self, key: &str) -> Option<Item<bool>> {
        self.entry(key)?.boolean()
    }

    /// A whole number in `range`.
    pub fn integer(&self, key: &str, range: RangeInclusive<u64>) -> Option<Item<u64>> {
        self.entry(key)?.integer(range)
    }

    /// A finite number in `range`; `unit` follows the bounds in the message, e.g. " m" or "".
    pub fn number(&self, key: &str, range: RangeInclusive<f64>, unit: &str) -> Option<Item<f64>> {
        self.entry(key)?.number(range, unit)
    }

    /// An array of finite numbers in `range`.
    pub fn numbers(
        &self,
        key: &str,
        range: RangeInclusive<f64>,
        unit: &str,
    ) -> Option<Item<Vec<Item<f64>>>> {
        let entry = self.entry(key)?;
        let entries = entry.array("an array of numbers")?;
        let read: Vec<_> = entries
            .iter()
            .map(|e| e.number(range.clone(), unit))
            .collect();
        let values = read.into_iter().collect::<Option<Vec<_>>>()?;
        Some(entry.item(values))
    }

    fn path(&self, key: &str) -> String {
        match self.header.key.as_str() {
            "" => key.to_owned(),
            parent => format!("{parent}.{key}"),
        }
    }

    fn report_unknown(&self, key: &str, span: Range<usize>, known: &[&str]) {
        let place = Place {
            key: self.path(key),
            span,
        };
        let help = match nearest(key, known) {
            Some(meant) => format!("did you mean `{meant}`?"),
            None => "remove it".into(),
        };
        let problem = Problem {
            message: "unknown key".into(),
            found: format!("`{key}`"),
            expected: format!("one of `{}`", known.join("`, `")),
            help,
        };
        self.problems.report(&place, problem);
    }
}

impl<'d> Entry<'d> {
    /// Where the value stands.
    pub fn place(&self) -> &Place {
        &self.place
    }

    /// Whether the value is a string.
    pub fn is_text(&self) -> bool {
        self.value.is_str()
    }

    /// Whether the value is an array.
    pub fn is_array(&self) -> bool {
        self.value.is_array()
    }

    /// Whether the value is a table.
    pub fn is_table(&self) -> bool {
        self.value.is_table()
    }

    /// The value as a table with the given known keys.
    pub fn table(&self, known: &[&str]) -> Option<Table<'d>> {
        match self.value {
            DeValue::Table(table) => {
                Some(Table::open(self.problems, table, self.place.clone(), known))
            }
            _ => self.wrong_type("a table of keys and values"),
        }
    }

    /// The entries of an array.
    pub fn array(&self, expected: &str) -> Option<Vec<Entry<'d>>> {
        let element = |value: &'d Spanned<DeValue<'d>>| Entry {
            problems: self.problems,
            value: value.get_ref(),
            place: Place {
                key: self.place.key.clone(),
                span: value.span(),
            },
        };
        match self.value {
            DeValue::Array(array) => Some(array.iter().map(element).collect()),
            _ => self.wrong_type(expected),
        }
    }

    /// The value as a string without control characters: it may end up on a terminal.
    pub fn text(&self) -> Option<Item<String>> {
        let DeValue::String(text) = self.value else {
            return self.wrong_type("a string in quotes");
        };
        if text.chars().any(char::is_control) {
            let help = "remove line breaks, tabs and escapes";
            return self.reject("not plain text", "one line of plain text", help);
        }
        Some(self.item(text.clone().into_owned()))
    }

    /// The value as a string out of `choices`.
    pub fn choice<T: Clone>(&self, choices: &[(&str, T)]) -> Option<Item<T>> {
        let text = self.text()?;
        let chosen = choices.iter().find(|(name, _)| *name == text.value);
        if let Some((_, value)) = chosen {
            return Some(self.item(value.clone()));
        }
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        let help = match nearest(&text.value, &names) {
            Some(meant) => format!("did you mean \"{meant}\"?"),
            None => "remove it".into(),
        };
        let expected = format!("one of \"{}\"", names.join("\", \""));
        self.problems
            .reject(&self.place, "unknown choice", &expected, &help);
        None
    }

    /// The value as `true` or `false`.
    pub fn boolean(&self) -> Option<Item<bool>> {
        match self.value {
            DeValue::Boolean(value) => Some(self.item(*value)),
            _ => self.wrong_type("`true` or `false`"),
        }
    }

    /// The value as a whole number in `range`.
    pub fn integer(&self, range: RangeInclusive<u64>) -> Option<Item<u64>> {
        let expected = match *range.end() {
            u64::MAX => format!("a whole number of at least {}", range.start()),
            end => format!("a whole number from {} to {end}", range.start()),
        };
        let DeValue::Integer(digits) = self.value else {
            return self.wrong_type(&expected);
        };
        let value = u64::from_str_radix(digits.as_str(), digits.radix()).ok();
        match value.filter(|value| range.contains(value)) {
            Some(value) => Some(self.item(value)),
            None => self.out_of_range(&expected),
        }
    }

    /// The value, integer or float, as a finite number in `range`.
    pub fn number(&self, range: RangeInclusive<f64>, unit: &str) -> Option<Item<f64>> {
        let expected = describe(&range, unit);
        let value = match self.value {
            DeValue::Float(digits) => digits.as_str().parse::<f64>().ok(),
            DeValue::Integer(digits) => i128::from_str_radix(digits.as_str(), digits.radix())
                .map(|value| value as f64)
                .ok(),
            _ => return self.wrong_type(&expected),
        };
        match value {
            Some(value) if range.contains(&value) => Some(self.item(value)),
            Some(value) if !value.is_finite() => {
                self.reject("not a finite number", &expected, "write a finite number")
            }
            _ => self.out_of_range(&expected),
        }
    }

    /// `value` with this entry's place.
    pub fn item<T>(&self, value: T) -> Item<T> {
        Item {
            value,
            place: self.place.clone(),
        }
    }

    fn out_of_range<T>(&self, expected: &str) -> Option<T> {
        self.reject("out of range", expected, &format!("give {expected}"))
    }

    fn wrong_type<T>(&self, expected: &str) -> Option<T> {
        let problem = Problem {
            message: "wrong type".into(),
            found: match self.value {
                DeValue::Table(_) => "a table".into(),
                value => format!(
                    "the {} {}",
                    value.type_str(),
                    self.problems.quote(&self.place.span)
                ),
            },
            expected: expected.to_owned(),
            help: format!("give {expected}"),
        };
        self.problems.report(&self.place, problem);
        None
    }

    fn reject<T>(&self, message: &str, expected: &str, help: &str) -> Option<T> {
        self.problems.reject(&self.place, message, expected, help);
        None
    }
}

fn describe(range: &RangeInclusive<f64>, unit: &str) -> String {
    match (*range.start(), *range.end()) {
        (f64::MIN, f64::MAX) => "a finite number".into(),
        (start, f64::MAX) => format!("a finite number of at least {start}{unit}"),
        (start, end) => format!("a number from {start} to {end}{unit}"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Document, InputError, Source};
    use super::*;

    fn read<T>(text: &str, read: impl Fn(&Table) -> Option<T>) -> Result<T, InputError> {
        let source = Source::new("t.toml", text);
        let document = Document::parse(&source)?;
        let value = read(&document.root(&["a", "b", "length"]));
        document.finish(value)
    }

    #[test]
    fn numbers_may_be_written_as_integers() {
        let values = read("a = [1, 2.5, 0x10, 1_0]", |t| {
            t.numbers("a", f64::MIN..=f64::MAX, "")
        });
        let values: Vec<f64> = values.unwrap().value.iter().map(|i| i.value).collect();
        assert_eq!(values, [1.0, 2.5, 16.0, 10.0]);
    }

    #[test]
    fn nan_infinity_and_overflow_are_refused() {
        for text in [
            "nan",
            "inf",
            "-inf",
            "1e999",
            "-1",
            "1e308",
            &"9".repeat(60),
        ] {
            let error = read(&format!("\na = {text}"), |t| {
                t.number("a", 0.0..=10.0, " m")
            });
            let error = error.unwrap_err();
            assert_eq!((error.line(), error.key()), (Some(2), "a"));
            assert!(error.render(false).contains("from 0 to 10 m"));
        }
    }

    #[test]
    fn an_unknown_key_names_the_nearest() {
        let error = read("lenght = 1", |t| t.number("length", 0.0..=1.0, "")).unwrap_err();
        assert_eq!(error.key(), "lenght");
        assert_eq!(error.problem().help, "did you mean `length`?");
    }

    #[test]
    fn wrong_types_say_what_was_found() {
        let error = read("a = 'x'", |t| t.integer("a", 0..=u64::MAX)).unwrap_err();
        assert_eq!(error.problem().found, "the string 'x'");
        let error = read("a = -1", |t| t.integer("a", 0..=u64::MAX)).unwrap_err();
        assert_eq!(error.problem().found, "-1");
        assert!(read("[a]", |t| t.text("a")).is_err());
        assert!(read("a = 1979-05-27", |t| t.boolean("a")).is_err());
    }

    #[test]
    fn a_misspelling_hides_the_absence_it_causes() {
        let error = read("# comment\nlengt = 1", |t| {
            t.require("length", "length = 1");
            t.number("length", 0.0..=1.0, "")
        });
        assert_eq!(error.unwrap_err().key(), "lengt");
    }

    #[test]
    fn a_missing_key_comes_with_an_example() {
        let error = read("b = 1", |t| {
            t.require("a", "a = 1");
            t.number("a", 0.0..=1.0, "")
        });
        assert_eq!(error.unwrap_err().problem().help, "add `a = 1`");
    }
}
