//! `report.html` of a study that trains or validates surrogates.

use super::html::{InlineFigure, document, heading, inlined, notes, sources};
use super::surrogate_report::{ReportTable, SurrogateReport};
use maud::{Markup, html};

/// The page of a report on surrogates with its figures.
pub(super) fn surrogate_page(report: &SurrogateReport, figures: &[InlineFigure]) -> String {
    let body = html! {
        (heading(&report.title, &report.study, &report.robot, &report.source, &[]))
        p.summary {
            "Task: " (report.task) ". Failures: " (report.failures_label) ". "
            "Status: " strong { (report.status) } "."
        }
        (notes(&report.notes))
        @if !report.rows.is_empty() {
            h2 { "Settings and results" }
            (pairs(&report.rows))
        }
        @if !report.tables.is_empty() {
            h2 { "Tables" }
            @for one in &report.tables { (table(one)) }
        }
        @if !figures.is_empty() {
            h2 { "Figures" }
            div.figures { @for figure in figures { (inlined(figure)) } }
        }
        (sources(&report.study_toml, &report.provenance, &report.result_json))
    };
    document(&report.title, &body)
}

fn pairs(rows: &[(String, String)]) -> Markup {
    html! {
        div.scroll { table {
            @for (name, value) in rows {
                tr { th { (name) } td { (value) } }
            }
        } }
    }
}

fn table(table: &ReportTable) -> Markup {
    let cells = table.rectangular();
    // A column of numbers is right-aligned with its header.
    let columns = 0..cells.header.len();
    let is_numeric = |column: usize| {
        let mut texts = cells.rows.iter().map(|row| row[column].as_str());
        texts.all(is_number) && cells.rows.iter().any(|row| !row[column].is_empty())
    };
    let classes: Vec<Option<&str>> = columns.map(|k| is_numeric(k).then_some("n")).collect();
    html! {
        @if !table.caption.is_empty() { p { (table.caption) } }
        div.scroll { table {
            tr { @for (name, class) in cells.header.iter().zip(&classes) {
                th class=[*class] { (name) }
            } }
            @for row in &cells.rows {
                tr { @for (text, class) in row.iter().zip(&classes) {
                    td class=[*class] { (text) }
                } }
            }
        } }
    }
}

/// Whether a cell starts like a number, or stands for a missing one.
fn is_number(text: &str) -> bool {
    let digits = text.trim_start_matches(['−', '-', '+', '<', '≤', '>', '≥', '(', ' ']);
    let is_missing = ["", "–", "-", "−"].contains(&text.trim());
    is_missing || digits.starts_with(|c: char| c.is_ascii_digit())
}
