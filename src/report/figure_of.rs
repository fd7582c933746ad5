//! A figure of one of several subjects: its own file name and caption.

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::table::Table;

/// A figure under another name, where a report shows the same for several surrogates.
#[derive(Clone, Debug)]
pub struct FigureOf<'a> {
    /// Stem of its files.
    pub name: String,
    /// What the figure is about: put before its caption, if not empty.
    pub subject: String,
    /// The figure.
    pub figure: &'a dyn Figure,
}

impl<'a> FigureOf<'a> {
    /// `figure` about `subject`: ("mdn, wrapped", calibration) has files `calibration_mdn_wrapped.*`.
    pub fn new(subject: &str, figure: &'a dyn Figure) -> FigureOf<'a> {
        FigureOf {
            name: stem(&format!("{} {subject}", figure.name())),
            subject: subject.to_string(),
            figure,
        }
    }
}

impl Figure for FigureOf<'_> {
    fn name(&self) -> &str {
        &self.name
    }

    fn caption(&self) -> String {
        let caption = self.figure.caption();
        match self.subject.is_empty() {
            true => caption,
            false => format!("{}: {caption}", self.subject),
        }
    }

    fn size(&self) -> Size {
        self.figure.size()
    }

    fn draw(&self, canvas: &mut Canvas) {
        self.figure.draw(canvas);
    }

    fn table(&self) -> Table {
        self.figure.table()
    }
}

/// A file's stem from any text: letters and digits of ASCII in lower case, the rest as "_".
pub(super) fn stem(text: &str) -> String {
    let letters = text.to_ascii_lowercase();
    let words = letters.split(|c: char| !c.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    match words.is_empty() {
        true => "unnamed".into(),
        false => words.join("_"),
    }
}
