//! `report.html` of a study of one pose.

use super::html::{InlineFigure, document, heading, inlined, notes, sources, symbol};
use super::manifold_report::{
    CURVES, JointRow, ManifoldReport, ManifoldRow, PoseVerdict, SurfaceSummary,
};
use super::number::{degrees, exact_degrees, joint_symbol, plain, rounded};
use crate::angle::AngleSet;
use maud::{Markup, html};
use std::f64::consts::{PI, TAU};

/// The page of a report on one pose with its figures.
pub(super) fn manifold_page(report: &ManifoldReport, figures: &[InlineFigure]) -> String {
    let body = html! {
        (heading(&report.title, &report.study, &report.robot, &report.source, &[]))
        (summary(report))
        (notes(&report.notes))
        @if report.figure.is_some() {
            @if report.surface.is_none() {
                h2 { "Self-motion manifolds" }
                (manifolds(&report.manifolds))
            }
            h2 { "Joints" }
            (joints(report))
            h2 { "Figures" }
            div.figures { @for figure in figures { (inlined(figure)) } }
            @if let Some(view) = &report.view {
                p {
                    "The curves in the space of "
                    (listed(&view.joints.map(joint_symbol)))
                    " for ParaView: " code { (CURVES) } "."
                }
            }
        }
        h2 { "Pose of the tool" }
        (pose(&report.pose))
        (sources(&report.study_toml, &report.provenance, &report.result_json))
    };
    document(&report.title, &body)
}

fn summary(report: &ManifoldReport) -> Markup {
    let count = report.manifolds.len();
    html! {
        p.summary {
            "Task: " (report.task) ". "
            @if let (Some(surface), true) = (&report.surface, report.figure.is_some()) {
                (surface_of(surface))
            } @else { @match count {
                0 => { "No configuration of the robot holds the pose. " }
                1 => { "The robot holds the pose on " strong { "one self-motion manifold" } ". " }
                _ => {
                    "The robot holds the pose on " strong { (count) " self-motion manifolds" } ". "
                }
            } }
            "That this is all is " (report.completeness) ". "
            @if count > 0 {
                "The winding vectors sum to " (vector(&report.winding_sum)) "."
            }
        }
        @if let Some(verdict) = &report.verdict { (verdict_of(report, verdict)) }
    }
}

fn surface_of(surface: &SurfaceSummary) -> Markup {
    let held: Vec<String> = surface.held.iter().map(usize::to_string).collect();
    let joints = match held.len() {
        1 => "joint",
        _ => "joints",
    };
    html! {
        "The configurations with which the robot holds the pose form a "
        strong { "surface of dimension " (surface.dimension) }
        ". It is known by " (surface.curves) " curves on " (surface.slices)
        " slices, along which some joints are held: " (joints) " " (listed(&held)) " at "
        (surface.values) " values each. "
    }
}

fn verdict_of(report: &ManifoldReport, verdict: &PoseVerdict) -> Markup {
    let answer = |is_true: bool| if is_true { "is" } else { "is not" };
    html! {
        p.summary {
            "Failures: " (report.failures_label) ". Within the artificial limits the pose "
            (answer(verdict.is_reached)) " reached before a failure, and it "
            strong { (answer(verdict.is_fault_tolerant)) " in the fault-tolerant workspace" } " "
            (symbol("W", "F")) ". "
            (rotations(&verdict.rotation_set))
        }
    }
}

/// The rotations about joint 1 as a sentence.
fn rotations(set: &AngleSet) -> String {
    if set.arcs().is_empty() {
        return "There is no rotation about joint 1 after which it is.".into();
    }
    if set.arcs().iter().any(|arc| arc.is_full()) {
        return "So it is after any rotation about joint 1.".into();
    }
    let arcs = set.arcs().iter();
    let arcs: Vec<String> = arcs
        .map(|arc| between(&[arc.start(), arc.end()].map(degrees)))
        .collect();
    format!(
        "The rotations about joint 1 after which it is there: {}; {} in all.",
        listed(&arcs),
        degrees(set.measure())
    )
}

fn manifolds(rows: &[ManifoldRow]) -> Markup {
    let limited = rows.iter().any(|row| row.crossings.is_some());
    html! {
        div.scroll { table {
            tr {
                th { "manifold" } th { "status" } th.n { "length (rad)" } th.n { "winding" }
                th.n { "critical points" }
                @if limited { th.n { "crossings of limits" } }
                th.n { "random starts" }
            }
            @for (number, row) in (1..).zip(rows) {
                tr {
                    td { (number) }
                    td { (row.status) }
                    td.n { (rounded(row.length, -4)) }
                    td.n { (vector(&row.winding)) }
                    td.n { (row.critical_points) }
                    @if limited { td.n { (row.crossings.unwrap_or(0)) } }
                    td.n { (row.hits) }
                }
            }
        } }
    }
}

fn joints(report: &ManifoldReport) -> Markup {
    let limited = report.verdict.is_some();
    html! {
        div.scroll { table {
            tr {
                th { "joint" } th {
                    @if report.surface.is_some() { "range over the surface" }
                    @else { "range over all manifolds" }
                }
                @if limited { th { "artificial limits" } th { "a lock inside the limits" } }
            }
            @for (number, row) in (1..).zip(&report.joints) {
                tr {
                    td { (number) ", " (joint_symbol(number)) }
                    td { (ranges(row)) }
                    @if limited {
                        td { @if let Some(limits) = &row.limits { (interval(row, limits)) } }
                        td { (lock(row)) }
                    }
                }
            }
        } }
    }
}

fn ranges(row: &JointRow) -> String {
    if row.ranges.is_empty() {
        return "–".into();
    }
    let each: Vec<String> = row
        .ranges
        .iter()
        .map(|range| interval(row, range))
        .collect();
    each.join("; ")
}

/// An interval of a joint's variable in words.
fn interval(row: &JointRow, ends: &[f64; 2]) -> String {
    if row.is_prismatic {
        return format!("{} m", between(&ends.map(|end| rounded(end, -4))));
    }
    if ends[1] - ends[0] >= TAU - 1e-12 {
        return "full circle".into();
    }
    // Like limits, ranges read better from a start in [−180°, 180°).
    let turns = TAU * ((ends[0] + PI) / TAU).floor();
    between(&ends.map(|end| exact_degrees(end - turns)))
}

fn between([from, to]: &[String; 2]) -> String {
    format!("{from} to {to}")
}

fn lock(row: &JointRow) -> String {
    let told = match row.is_tolerated {
        Some(true) => "tolerated",
        Some(false) => "not tolerated",
        None => "",
    };
    match row.is_prone {
        true => told.into(),
        false => format!("{told} (not prone to failure)"),
    }
}

fn pose(rows: &[(String, String)]) -> Markup {
    html! {
        div.scroll { table {
            @for (name, value) in rows {
                tr { th { (name) } td { (value) } }
            }
        } }
    }
}

/// "(0, 1, −1)".
fn vector(numbers: &[i32]) -> String {
    let numbers: Vec<String> = numbers.iter().map(|&n| plain(f64::from(n))).collect();
    format!("({})", numbers.join(", "))
}

/// "a, b and c".
fn listed(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [only] => only.clone(),
        [head @ .., last] => format!("{} and {last}", head.join(", ")),
    }
}
