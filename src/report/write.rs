//! A whole report: all its files in one directory.

use super::convergence::Convergence;
use super::error::ReportError;
use super::figure::{Drawn, Figure, Format, write_drawn};
use super::html::{InlineFigure, page};
use super::limits_figure::LimitsFigure;
use super::points::{POINTS, write_points};
use super::result_files::{write_json, write_text};
use super::sensitivity::Sensitivity;
use super::sizes_figure::SizesFigure;
use super::style::COLUMN;
use super::workspace_figure::WorkspaceFigure;
use crate::workspace::{ArtificialLimits, FailureSet, SpatialShareMap, WorkspaceSizes};
use rayon::prelude::*;
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
    /// Sizes of all workspaces; one that is not known is not a number. Without joints after a
    /// failure, `post_failure` may be empty.
    pub sizes: &'a WorkspaceSizes,
    /// Unit of the sizes, as in "m^2 rad" or "m^3".
    pub unit: String,
    /// Artificial limits, radians.
    pub limits: &'a ArtificialLimits,
    /// Lengths of a planar robot's links, metres; empty for other robots.
    pub links: &'a [f64],
    /// The workspace from above, where there is such a picture.
    pub workspace: Option<WorkspaceFigure<'a>>,
    /// Other figures, shown after that one and before all others.
    pub figures: Vec<&'a dyn Figure>,
    /// A spatial workspace, written as `points.vtk`.
    pub points: Option<&'a SpatialShareMap>,
    /// The course of the search, if there was one.
    pub convergence: Option<Convergence>,
    /// Scores around the optimum, if they were computed.
    pub sensitivity: Option<Sensitivity>,
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

impl Report<'_> {
    /// The sizes as a figure; none where one of them is not known.
    fn sizes_figure(&self) -> Option<SizesFigure<'_>> {
        let sizes = self.sizes;
        let rest = [
            &sizes.unrestricted,
            &sizes.pre_failure,
            &sizes.fault_tolerant,
        ];
        let mut all = sizes.post_failure.iter().chain(rest);
        let figure = SizesFigure {
            sizes,
            failures: self.failures,
            unit: &self.unit,
        };
        all.all(|size| size.value.is_finite()).then_some(figure)
    }

    /// The limits as a figure.
    fn limits_figure(&self) -> LimitsFigure<'_> {
        LimitsFigure {
            limits: self.limits,
            is_planar: self.workspace.is_some() || !self.links.is_empty(),
        }
    }

    /// All figures in the order of the page.
    fn all_figures<'f>(
        &'f self,
        limits: &'f LimitsFigure,
        sizes: Option<&'f SizesFigure>,
    ) -> Vec<&'f dyn Figure> {
        let mut figures: Vec<&dyn Figure> = Vec::new();
        figures.extend(self.workspace.as_ref().map(|f| f as &dyn Figure));
        figures.extend(self.figures.iter().map(|f| *f as &dyn Figure));
        figures.push(limits);
        figures.extend(sizes.map(|f| f as &dyn Figure));
        figures.extend(self.convergence.as_ref().map(|f| f as &dyn Figure));
        figures.extend(self.sensitivity.as_ref().map(|f| f as &dyn Figure));
        figures
    }
}

/// Writes figures with their tables; returns the files' paths, and all figures for the page.
pub(super) fn write_figures<'f>(
    figures: impl Iterator<Item = &'f dyn Figure>,
    directory: &Path,
    formats: &[Format],
) -> Result<(Vec<PathBuf>, Vec<InlineFigure>), ReportError> {
    let write = |figure: &&dyn Figure| {
        let drawn = Drawn::new(*figure)?;
        let written = write_drawn(*figure, &drawn, directory, formats)?;
        let inline = InlineFigure {
            png: drawn.png,
            caption: figure.caption(),
            is_wide: figure.size().width > COLUMN,
        };
        Ok((written, inline))
    };
    let figures: Vec<&dyn Figure> = figures.collect();
    let done: Result<Vec<_>, ReportError> = figures.par_iter().map(write).collect();
    let (written, inline): (Vec<Vec<PathBuf>>, Vec<InlineFigure>) = done?.into_iter().unzip();
    Ok((written.concat(), inline))
}

/// Writes all figures with their tables, the further files, `result.json`, `study.toml`, `report.html` and, if there
/// are any, `points.vtk` into `directory`; returns the files' paths. The page contains all figures whatever the `formats`.
pub fn write_report(
    report: &Report,
    directory: &Path,
    formats: &[Format],
) -> Result<Vec<PathBuf>, ReportError> {
    let (sizes, limits) = (report.sizes_figure(), report.limits_figure());
    let figures = report.all_figures(&limits, sizes.as_ref());
    let (mut written, inline) = write_figures(figures.into_iter(), directory, formats)?;
    let path = |name: &str| directory.join(name);
    if let Some(map) = report.points {
        write_points(map, &path(POINTS))?;
        written.push(path(POINTS));
    }
    for (name, text) in &report.files {
        write_text(&path(name), text)?;
        written.push(path(name));
    }
    write_text(&path("study.toml"), &report.study_toml)?;
    write_text(&path("report.html"), &page(report, &inline))?;
    // Last: where it is, the report is whole.
    write_json(&path("result.json"), &report.result_json)?;
    written.extend(["study.toml", "result.json", "report.html"].map(path));
    Ok(written)
}
