//! The report of a study that trains or validates surrogates: all its files in one directory.

use super::error::ReportError;
use super::figure::{Figure, Format};
use super::figure_of::{FigureOf, stem};
use super::result_files::{write_json, write_text};
use super::surrogate_page::surrogate_page;
use super::table::Table;
use super::write::write_figures;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Everything that a report tells about surrogates.
#[derive(Clone, Debug)]
pub struct SurrogateReport<'a> {
    /// Heading of the page.
    pub title: String,
    /// Name of the study.
    pub study: String,
    /// Name of the robot.
    pub robot: String,
    /// Where the robot comes from; may be empty.
    pub source: String,
    /// The task in words, as in "position in the plane".
    pub task: String,
    /// The failures in words, as in "any single joint".
    pub failures_label: String,
    /// How the computation ended, as in "converged".
    pub status: String,
    /// Names and values: settings and headline numbers.
    pub rows: Vec<(String, String)>,
    /// Tables in order.
    pub tables: Vec<ReportTable>,
    /// Figures in order. Of figures of the same name, the second gets the name with "_2" and so on;
    /// [`FigureOf`] gives better names.
    pub figures: Vec<&'a dyn Figure>,
    /// Written as `result.json`.
    pub result_json: serde_json::Value,
    /// The study as run, written as `study.toml`.
    pub study_toml: String,
    /// Names and values: version, seed, threads, hashes.
    pub provenance: Vec<(String, String)>,
    /// Remarks a reader must not miss.
    pub notes: Vec<String>,
}

/// A table on the page, written as CSV too.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReportTable {
    /// Stem of its file, as in `surrogates` for `surrogates.csv`.
    pub name: String,
    /// A sentence that tells what is to be seen.
    pub caption: String,
    /// Column names with their units.
    pub header: Vec<String>,
    /// Rows of cells; short ones end with empty cells.
    pub rows: Vec<Vec<String>>,
}

impl ReportTable {
    /// Header and rows of the same length.
    pub(super) fn rectangular(&self) -> Table {
        let longest = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = longest.max(self.header.len());
        let padded = |row: &Vec<String>| {
            let mut row = row.clone();
            row.resize(width, String::new());
            row
        };
        Table {
            header: padded(&self.header),
            rows: self.rows.iter().map(padded).collect(),
        }
    }
}

/// Writes all figures and tables, `study.toml`, `report.html` and `result.json` into `directory`;
/// returns the files' paths. The page contains all figures whatever the `formats`.
///
/// # Errors
/// A figure could not be drawn or a file not be written.
pub fn write_surrogate_report(
    report: &SurrogateReport,
    directory: &Path,
    formats: &[Format],
) -> Result<Vec<PathBuf>, ReportError> {
    let mut taken = BTreeSet::new();
    let named = report.figures.iter().map(|figure| FigureOf {
        name: unused(figure.name(), &mut taken),
        subject: String::new(),
        figure: *figure,
    });
    let named: Vec<FigureOf> = named.collect();
    let figures = named.iter().map(|figure| figure as &dyn Figure);
    let (mut written, inline) = write_figures(figures, directory, formats)?;
    for table in report
        .tables
        .iter()
        .filter(|table| !table.header.is_empty())
    {
        let name = unused(&stem(&table.name), &mut taken);
        let path = directory.join(format!("{name}.csv"));
        write_text(&path, &table.rectangular().to_csv()?)?;
        written.push(path);
    }
    let path = |name: &str| directory.join(name);
    write_text(&path("study.toml"), &report.study_toml)?;
    write_text(&path("report.html"), &surrogate_page(report, &inline))?;
    // Last: where it is, the report is whole.
    write_json(&path("result.json"), &report.result_json)?;
    written.extend(["study.toml", "report.html", "result.json"].map(path));
    Ok(written)
}

/// The name, or the first of name_2, name_3 … that is not taken.
fn unused(name: &str, taken: &mut BTreeSet<String>) -> String {
    let numbered = (2..).map(|k: u64| format!("{name}_{k}"));
    let mut names = std::iter::once(name.to_string()).chain(numbered);
    let free = names.find(|name| !taken.contains(name));
    let free = free.unwrap_or_else(|| name.to_string());
    taken.insert(free.clone());
    free
}
