//! The report of a study as sections of text and tables, figures and files.

use super::error::ReportError;
use super::figure::{Drawn, Figure, Format, write_drawn};
use super::html::{InlineFigure, document, files, inlined, notes, sources};
use super::result_files::{write_json, write_text};
use super::style::COLUMN;
use super::table::Table;
use maud::{Markup, html};
use std::path::{Path, PathBuf};

/// A heading with a paragraph and a table, either of which may be empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Its heading.
    pub heading: String,
    /// What the table shows.
    pub text: String,
    /// Its header names columns as they are printed; numbers stand to the right.
    pub table: Table,
}

/// Everything that a report tells.
#[derive(Debug)]
pub struct FindingReport<'a> {
    /// Heading of the page.
    pub title: String,
    /// Name of the study.
    pub study: String,
    /// Name of the robot.
    pub robot: String,
    /// Where the robot comes from; may be empty.
    pub source: String,
    /// The answer in sentences.
    pub summary: Vec<String>,
    /// Sections in order.
    pub sections: Vec<Section>,
    /// Figures in order; none if no figures are wanted, and then there is no page either.
    pub figures: Vec<&'a dyn Figure>,
    /// Further tables with the names of their files.
    pub tables: Vec<(&'static str, Table)>,
    /// Further files to be used elsewhere, such as a robot's: name and text.
    pub files: Vec<(String, String)>,
    /// Written as `result.json`.
    pub result_json: serde_json::Value,
    /// The study as run, written as `study.toml`.
    pub study_toml: String,
    /// Names and values: version, seed, threads, hashes.
    pub provenance: Vec<(String, String)>,
    /// Remarks a reader must not miss.
    pub notes: Vec<String>,
}

/// Writes all figures with their tables, the further tables and files, `study.toml`, `report.html` and
/// `result.json` into `directory`; returns the files' paths. With `page` false only the tables,
/// the files and `result.json`.
///
/// # Errors
/// A figure could not be drawn or a file not be written.
pub fn write_finding_report(
    report: &FindingReport,
    directory: &Path,
    formats: &[Format],
    page: bool,
) -> Result<Vec<PathBuf>, ReportError> {
    let path = |name: &str| directory.join(name);
    let mut written = Vec::new();
    for (name, table) in &report.tables {
        write_text(&path(name), &table.to_csv()?)?;
        written.push(path(name));
    }
    for (name, text) in &report.files {
        write_text(&path(name), text)?;
        written.push(path(name));
    }
    if page {
        let mut inline = Vec::new();
        for figure in &report.figures {
            let drawn = Drawn::new(*figure)?;
            written.extend(write_drawn(*figure, &drawn, directory, formats)?);
            inline.push(InlineFigure {
                png: drawn.png,
                caption: figure.caption(),
                is_wide: figure.size().width > COLUMN,
            });
        }
        write_text(&path("study.toml"), &report.study_toml)?;
        write_text(&path("report.html"), &page_of(report, &inline))?;
        written.extend(["study.toml", "report.html"].map(path));
    }
    // Last: where it is, the report is whole.
    write_json(&path("result.json"), &report.result_json)?;
    written.push(path("result.json"));
    Ok(written)
}

fn page_of(report: &FindingReport, figures: &[InlineFigure]) -> String {
    let body = html! {
        h1 { (report.title) }
        p.sub {
            "Study " strong { (report.study) } ", robot " strong { (report.robot) }
            @if !report.source.is_empty() { " (" (report.source) ")" }
        }
        @for paragraph in &report.summary { p.summary { (paragraph) } }
        (notes(&report.notes))
        @for section in &report.sections { (section_of(section)) }
        @if !figures.is_empty() {
            h2 { "Figures" }
            div.figures { @for figure in figures { (inlined(figure)) } }
        }
        (files(&report.files))
        (sources(&report.study_toml, &report.provenance, &report.result_json))
    };
    document(&report.title, &body)
}

fn section_of(section: &Section) -> Markup {
    let is_number = |text: &str| {
        let start = text.trim_start_matches(['−', '-']);
        start.starts_with(|c: char| c.is_ascii_digit())
    };
    let columns = section.table.header.len();
    let right: Vec<bool> = (0..columns)
        .map(|column| {
            let mut cells = section.table.rows.iter().filter_map(|row| row.get(column));
            cells.all(|cell| cell.is_empty() || is_number(cell))
        })
        .collect();
    html! {
        h2 { (section.heading) }
        @if !section.text.is_empty() { p { (section.text) } }
        @if !section.table.rows.is_empty() {
            div.scroll { table {
                tr {
                    @for (name, right) in section.table.header.iter().zip(&right) {
                        th class=[right.then_some("n")] { (name) }
                    }
                }
                @for row in &section.table.rows {
                    tr {
                        @for (cell, right) in row.iter().zip(&right) {
                            td class=[right.then_some("n")] { (cell) }
                        }
                    }
                }
            } }
        }
    }
}
