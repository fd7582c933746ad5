//! The report of a study of one pose: all its files in one directory.

use super::error::ReportError;
use super::figure::{Figure, Format};
use super::manifold_figure::ManifoldFigure;
use super::manifold_page::manifold_page;
use super::manifold_view::ManifoldFigure3d;
use super::points::write_curves;
use super::result_files::{write_json, write_text};
use super::table::Table;
use super::write::write_figures;
use crate::angle::AngleSet;
use std::path::{Path, PathBuf};

/// Name of a report's polylines.
pub(super) const CURVES: &str = "curves.vtk";

/// One self-motion manifold in a table.
#[derive(Clone, Debug, PartialEq)]
pub struct ManifoldRow {
    /// How tracing it ended, as in "closed".
    pub status: String,
    /// Arc length, radians.
    pub length: f64,
    /// Full turns of every joint along it.
    pub winding: Vec<i32>,
    /// Number of its critical points, of all joints.
    pub critical_points: usize,
    /// Number of its intersections with the limits, if there are limits.
    pub crossings: Option<usize>,
    /// Random starts that landed on it.
    pub hits: usize,
}

/// One joint in a table.
#[derive(Clone, Debug, PartialEq)]
pub struct JointRow {
    /// Intervals over all manifolds, in the joint's unit: radians, or metres.
    pub ranges: Vec<[f64; 2]>,
    /// Artificial limits in the same unit, if there are any.
    pub limits: Option<[f64; 2]>,
    /// Whether the joint slides: metres in place of radians.
    pub is_prismatic: bool,
    /// Whether it may fail.
    pub is_prone: bool,
    /// Whether the pose is reached wherever it locks inside its limits, if there are limits.
    pub is_tolerated: Option<bool>,
}

/// A pre-image of two or more dimensions in a sentence.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceSummary {
    /// The degree of redundancy.
    pub dimension: usize,
    /// Numbers of the joints that slices hold.
    pub held: Vec<usize>,
    /// Values at which each is held.
    pub values: usize,
    /// Slices with curves.
    pub slices: usize,
    /// The curves on them.
    pub curves: usize,
}

/// What artificial limits make of the pose.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseVerdict {
    /// Whether the pose belongs to W₀.
    pub is_reached: bool,
    /// Whether the pose belongs to W_F.
    pub is_fault_tolerant: bool,
    /// Rotations about joint 1 that bring the pose into W_F.
    pub rotation_set: AngleSet,
}

/// Everything that a report tells about one pose.
#[derive(Clone, Debug)]
pub struct ManifoldReport<'a> {
    /// Heading of the page.
    pub title: String,
    /// Name of the study.
    pub study: String,
    /// Name of the robot.
    pub robot: String,
    /// Where the robot comes from; may be empty.
    pub source: String,
    /// The task in words.
    pub task: String,
    /// The failures in words, as in "any single joint".
    pub failures_label: String,
    /// Names of the pose's coordinates and their values.
    pub pose: Vec<(String, String)>,
    /// How sure it is that no manifold is missing: the end of a sentence.
    pub completeness: String,
    /// Sum of the winding vectors.
    pub winding_sum: Vec<i32>,
    /// The manifolds in order; none where the pre-image is a surface.
    pub manifolds: Vec<ManifoldRow>,
    /// The pre-image, where it is a surface.
    pub surface: Option<SurfaceSummary>,
    /// The joints in order.
    pub joints: Vec<JointRow>,
    /// What artificial limits make of the pose, if there are any.
    pub verdict: Option<PoseVerdict>,
    /// The manifolds joint by joint; none if there is no manifold.
    pub figure: Option<ManifoldFigure<'a>>,
    /// The manifolds in the space of three joints; none if there is no manifold.
    pub view: Option<ManifoldFigure3d<'a>>,
    /// The vertices of the manifolds, written as `manifolds.csv`.
    pub vertices: Option<Table>,
    /// Written as `result.json`.
    pub result_json: serde_json::Value,
    /// The study as run, written as `study.toml`.
    pub study_toml: String,
    /// Names and values: version, seed, threads, hashes.
    pub provenance: Vec<(String, String)>,
    /// Remarks a reader must not miss.
    pub notes: Vec<String>,
}

/// Writes both figures, `manifolds.csv`, `curves.vtk` with the curves in the joints of the second
/// figure, `study.toml`, `report.html` and `result.json` into `directory`; returns the files' paths.
///
/// `manifolds.csv` holds the vertices, as it does without figures; what the figures draw, with
/// critical points and crossings, is in `manifolds_3d.csv`.
///
/// # Errors
/// A figure could not be drawn or a file not be written.
pub fn write_manifold_report(
    report: &ManifoldReport,
    directory: &Path,
    formats: &[Format],
) -> Result<Vec<PathBuf>, ReportError> {
    let path = |name: &str| directory.join(name);
    let flat = report.figure.as_ref().map(|f| f as &dyn Figure);
    let in_space = report.view.as_ref().map(|f| f as &dyn Figure);
    let figures = flat.into_iter().chain(in_space);
    let (mut written, inline) = write_figures(figures, directory, formats)?;
    if let Some(table) = &report.vertices {
        let vertices = path("manifolds.csv");
        write_text(&vertices, &table.to_csv()?)?;
        if !written.contains(&vertices) {
            written.push(vertices);
        }
    }
    if let Some(view) = &report.view {
        write_curves(view.curves, view.joints, &path(CURVES))?;
        written.push(path(CURVES));
    }
    write_text(&path("study.toml"), &report.study_toml)?;
    write_text(&path("report.html"), &manifold_page(report, &inline))?;
    // Last: where it is, the report is whole.
    write_json(&path("result.json"), &report.result_json)?;
    written.extend(["study.toml", "report.html", "result.json"].map(path));
    Ok(written)
}
