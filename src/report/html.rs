//! `report.html`: one page that needs no other file.

use super::number::{estimate, exact_degrees, joint_symbol, percentage, rounded, unit};
use super::points::POINTS;
use super::sizes_figure::named;
use super::write::Report;
use crate::workspace::JointLimit;
use base64::{Engine, engine::general_purpose::STANDARD};
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// A picture to be put into the page.
#[derive(Clone, Debug)]
pub struct InlineFigure {
    /// Bytes of a PNG file.
    pub png: Vec<u8>,
    /// Caption and alternative text, plain.
    pub caption: String,
    /// Whether it takes all of the page's width: two columns of a paper.
    pub is_wide: bool,
}

const CSS: &str = "
body { font: 16px/1.5 system-ui, 'DejaVu Sans', sans-serif; color: #222; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin-bottom: 0; } h2 { font-size: 1.15rem; margin-top: 2rem; }
.sub { color: #666; margin-top: .2rem; } .summary { font-size: 1.1rem; }
table { border-collapse: collapse; margin: .6rem 0; } th, td { padding: .2rem .9rem .2rem 0; text-align: left; border-bottom: 1px solid #ddd; vertical-align: top; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; } tr.result td { font-weight: 600; }
.scroll { overflow-x: auto; } td.v { overflow-wrap: anywhere; }
.figures { display: flex; flex-wrap: wrap; gap: 1.5rem; align-items: flex-start; }
figure { margin: 0; flex: 1 1 24rem; max-width: 30rem; break-inside: avoid; } figure img { width: 100%; height: auto; }
figcaption { font-size: .88rem; color: #444; } pre { background: #f6f6f6; padding: .8rem; overflow-x: auto; font-size: .85rem; }
ul.notes { background: #fff7e0; padding: .6rem 1rem .6rem 2rem; }
@media print { body { margin: 0; max-width: none; font-size: 10pt; } pre { white-space: pre-wrap; } .figures { display: block; } figure { max-width: 12cm; margin-bottom: 1cm; } }
";

/// The page of a report with its figures.
pub fn page(report: &Report, figures: &[InlineFigure]) -> String {
    let body = html! {
        (heading(&report.title, &report.study, &report.robot, &report.source, report.links))
        (summary(report))
        (notes(&report.notes))
        h2 { "Artificial joint limits" }
        (limits(report))
        h2 { "Sizes" }
        (sizes(report))
        h2 { "Figures" }
        div.figures { @for figure in figures { (inlined(figure)) } }
        @if report.points.is_some() {
            p { "The shares of all cells as points for ParaView: " code { (POINTS) } "." }
        }
        (files(&report.files))
        (sources(&report.study_toml, &report.provenance, &report.result_json))
    };
    document(&report.title, &body)
}

/// Further files beside the page, by name.
pub(super) fn files(files: &[(String, String)]) -> Markup {
    html! {
        @if !files.is_empty() {
            h2 { "Files" }
            ul { @for (name, _) in files { li { a href=(name) download { (name) } } } }
        }
    }
}

/// A whole page.
pub(super) fn document(title: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(CSS)) }
            }
            body { (body) }
        }
    };
    page.into_string()
}

/// Remarks a reader must not miss.
pub(super) fn notes(notes: &[String]) -> Markup {
    html! {
        @if !notes.is_empty() {
            ul.notes { @for note in notes { li { (note) } } }
        }
    }
}

/// The end of every page: where the result comes from.
pub(super) fn sources(
    study_toml: &str,
    rows: &[(String, String)],
    result: &serde_json::Value,
) -> Markup {
    html! {
        h2 { "Study as run" }
        pre { (study_toml) }
        h2 { "Provenance" }
        (provenance(rows))
        details { summary { "result.json" } pre { (pretty(result)) } }
    }
}

/// The start of every page; without `lengths`, the links' lengths in metres are not told.
pub(super) fn heading(
    title: &str,
    study: &str,
    robot: &str,
    source: &str,
    lengths: &[f64],
) -> Markup {
    html! {
        h1 { (title) }
        p.sub {
            "Study " strong { (study) } ", robot " strong { (robot) }
            @if !source.is_empty() { " (" (source) ")" }
            @if !lengths.is_empty() { ", links " (links(lengths)) " m" }
        }
    }
}

fn summary(report: &Report) -> Markup {
    let sizes = report.sizes;
    let unit = unit(&report.unit);
    html! {
        p.summary {
            "Task: " (report.task) ". Failures: " (report.failures_label) ". "
            "The fault-tolerant workspace has the size "
            strong { (symbol("S", "F")) " = " (measured(&estimate(&sizes.fault_tolerant), &unit)) }
            ", which is " strong { (percentage(&sizes.fault_tolerant, &sizes.unrestricted)) }
            " of the unrestricted workspace, "
            (symbol("S", "0max")) " = " (measured(&estimate(&sizes.unrestricted), &unit)) ". "
            "Status: " strong { (report.status) } "."
        }
    }
}

/// "(3.56 ± 0.02) m²", with the brackets only where there is an error.
fn measured(number: &str, unit: &str) -> String {
    if number.contains('±') && !number.starts_with('(') {
        format!("({number}) {unit}")
    } else {
        format!("{number} {unit}")
    }
}

pub(super) fn symbol(letter: &str, index: &str) -> Markup {
    html! { i { (letter) } sub { (index) } }
}

fn limits(report: &Report) -> Markup {
    let width = |limit: &JointLimit| {
        if limit.is_full() {
            "360° (free)".into()
        } else {
            exact_degrees(limit.width())
        }
    };
    html! {
        div.scroll { table {
            tr { th { "joint" } th.n { "lower" } th.n { "upper" } th.n { "width" } }
            @for (k, limit) in report.limits.joints().iter().enumerate() {
                tr {
                    td { (k + 1) ", " (joint_symbol(k + 1)) }
                    td.n { (exact_degrees(limit.lower)) }
                    td.n { (exact_degrees(limit.upper)) }
                    td.n { (width(limit)) }
                }
            }
        } }
    }
}

fn sizes(report: &Report) -> Markup {
    let all = named(report.sizes, report.failures);
    html! {
        div.scroll { table {
            tr {
                th { "workspace" } th { }
                th.n { "size (" (unit(&report.unit)) ")" } th.n { "share of the unrestricted" }
            }
            @for (k, size) in all.iter().enumerate() {
                tr class=[(k + 1 == all.len()).then_some("result")] {
                    td { (size.name) @if !size.counts { " (not prone to failure)" } }
                    td { @match size.symbol.split_once('_') {
                        Some((letter, index)) => (symbol(letter, index)),
                        None => (size.symbol),
                    } }
                    td.n { (estimate(&size.size)) }
                    td.n { (percentage(&size.size, &report.sizes.unrestricted)) }
                }
            }
        } }
    }
}

pub(super) fn inlined(figure: &InlineFigure) -> Markup {
    let data = STANDARD.encode(&figure.png);
    html! {
        figure style=[figure.is_wide.then_some("flex-basis:100%;max-width:none")] {
            img src={ "data:image/png;base64," (data) } alt=(figure.caption);
            figcaption { (figure.caption) }
        }
    }
}

fn provenance(rows: &[(String, String)]) -> Markup {
    html! {
        div.scroll { table {
            @for (name, value) in rows {
                tr { th { (name) } td.v { (value) } }
            }
        } }
    }
}

fn links(links: &[f64]) -> String {
    let lengths: Vec<String> = links.iter().map(|link| rounded(*link, -3)).collect();
    lengths.join(", ")
}

fn pretty(value: &serde_json::Value) -> String {
    serde_json::to_string_pretty(value).unwrap_or_default()
}
