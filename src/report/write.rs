//! A whole report: all its files in one directory.

use super::convergence::Convergence;
use super::error::ReportError;
use super::figure::{Figure, Format, figure_png, write_rendered};
use super::html::{InlineFigure, page};
use super::limits_figure::LimitsFigure;
use super::result_files::{write_json, write_text};
use super::sensitivity::Sensitivity;
use super::sizes_figure::SizesFigure;
use super::workspace_figure::WorkspaceFigure;
use crate::workspace::{ArtificialLimits, FailureSet, WorkspaceSizes};
use std::path::{Path, PathBuf};

/// Everything that a report tells about one design.
#[derive(Clone, Debug)]
pub struct Report<'a> {
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
    /// Joints prone to failure.
    pub failures: &'a FailureSet,
    /// Sizes of all workspaces.
    pub sizes: &'a WorkspaceSizes,
    /// Unit of the sizes, "m^2" or "m^2 rad".
    pub unit: String,
    /// Artificial limits, radians.
    pub limits: &'a ArtificialLimits,
    /// Lengths of a planar robot's links, metres; empty for other robots.
    pub links: &'a [f64],
    /// The workspace from above, where there is such a picture.
    pub workspace: Option<WorkspaceFigure<'a>>,
    /// The course of the search, if there was one.
    pub convergence: Option<Convergence>,
    /// Scores around the optimum, if they were computed.
    pub sensitivity: Option<Sensitivity>,
    /// Written as `result.json`.
    pub result_json: serde_json::Value,
    /// The study as run, written as `study.toml`.
    pub study_toml: String,
    /// Names and values: version, seed, threads, hashes.
    pub provenance: Vec<(String, String)>,
    /// Remarks a reader must not miss.
    pub notes: Vec<String>,
}

impl Report<'_> {
    /// The sizes as a figure.
    fn sizes_figure(&self) -> SizesFigure<'_> {
        SizesFigure {
            sizes: self.sizes,
            failures: self.failures,
            unit: &self.unit,
        }
    }

    /// The limits as a figure.
    fn limits_figure(&self) -> LimitsFigure<'_> {
        LimitsFigure {
            limits: self.limits,
        }
    }
}

/// Writes all figures with their tables, `result.json`, `study.toml` and `report.html` into
/// `directory`; returns the files' paths. The page contains all figures whatever the `formats`.
pub fn write_report(
    report: &Report,
    directory: &Path,
    formats: &[Format],
) -> Result<Vec<PathBuf>, ReportError> {
    let (sizes, limits) = (report.sizes_figure(), report.limits_figure());
    let mut figures: Vec<&dyn Figure> = vec![&limits, &sizes];
    if let Some(workspace) = &report.workspace {
        figures.insert(0, workspace);
    }
    figures.extend(report.convergence.as_ref().map(|f| f as &dyn Figure));
    figures.extend(report.sensitivity.as_ref().map(|f| f as &dyn Figure));

    let (mut written, mut inline) = (Vec::new(), Vec::new());
    for figure in figures {
        let png = figure_png(figure)?;
        written.extend(write_rendered(figure, &png, directory, formats)?);
        inline.push(InlineFigure {
            png,
            caption: figure.caption(),
        });
    }
    let path = |name: &str| directory.join(name);
    write_text(&path("study.toml"), &report.study_toml)?;
    write_text(&path("report.html"), &page(report, &inline))?;
    // Last: where it is, the report is whole.
    write_json(&path("result.json"), &report.result_json)?;
    written.extend(["study.toml", "result.json", "report.html"].map(path));
    Ok(written)
}
