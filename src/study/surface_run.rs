//! Runs a study of one pose whose pre-image is a surface: cuts it into curves, takes joint ranges
//! and tolerance of failures from them, and writes the report.

use super::manifold_report::line_of;
use super::manifold_run::{residual, settings, tool};
use super::report_parts::formats;
use super::run::{Ready, RunError, RunOptions};
use super::settings::{Manifolds, Study};
use super::surface_result::SurfaceFinding;
use crate::manifold::{SelfMotionManifold, Surface, SurfaceSearch};
use crate::report::{self, ManifoldCurve, write_manifold_report};
use crate::workspace::PoseTolerance;
use serde_json::{Value, json};
use std::time::Instant;

/// Most curves that a figure shows: more would be a blot.
const DRAWN: usize = 160;

/// Parts of a segment between two vertices when drawn.
const PARTS: usize = 4;

/// Runs `study` and returns the content of `result.json`.
///
/// # Errors
/// A file could not be written.
pub(super) fn run(
    study: &Study,
    manifolds: &Manifolds,
    options: &RunOptions,
    ready: Ready,
) -> Result<Value, RunError> {
    ready.begin(options)?;
    let progress = &ready.session.progress;
    progress.update(0, 1, f64::NAN, "tracing slices");
    let started = Instant::now();
    let robot = &study.design.robot;
    let values = manifolds.search.slices.unwrap_or_default() as usize;
    let search = SurfaceSearch::new(robot, study.task, values, settings(&manifolds.search))
        .map_err(anyhow::Error::from)?;
    let pose = tool(&manifolds.pose);
    let mut surface = search.find(&pose, study.seed);
    let physical = surface.physical();
    let joint_ranges = surface.ranges(physical);
    let all: Vec<usize> = (0..joint_ranges.len()).collect();
    let mut evidence = vec![surface.evidence(&all, &joint_ranges, physical)];
    let limits = manifolds.limits.as_ref().map(|l| l.to_limits(robot));
    let tolerance = limits.as_ref().map(|limits| {
        let (tolerance, image) =
            PoseTolerance::of_surface(&mut surface, &joint_ranges, limits, &study.failures);
        evidence.push(image);
        tolerance
    });
    let curves = surface.slices.iter().flat_map(|slice| &slice.curves);
    let finding = SurfaceFinding {
        study,
        manifolds,
        surface: &surface,
        held: search.held_joints(),
        values,
        joint_ranges: &joint_ranges,
        evidence,
        tolerance: tolerance.as_ref(),
        limits: limits.as_ref(),
        residual: residual(search.chain(), curves, &pose, study.task),
        seconds: json!({
            "total": ready.session.store.seconds(),
            "search": started.elapsed().as_secs_f64(),
        }),
        threads: rayon::current_num_threads(),
    };
    let result = finding.to_json();
    progress.update(0, 1, f64::NAN, "writing the report");
    if study.report.figures {
        let drawn = some_curves(&surface);
        let report = finding.report(&drawn, &result, &ready.study_toml);
        write_manifold_report(&report, &options.out, &formats(study))
            .map_err(anyhow::Error::from)?;
    } else {
        let path = options.out.join("result.json");
        report::write_json(&path, &result).map_err(anyhow::Error::from)?;
    }
    ready.session.store.remove();
    Ok(result)
}

/// Curves of slices spread evenly over all of them.
fn some_curves(surface: &Surface) -> Vec<ManifoldCurve> {
    let all: Vec<&SelfMotionManifold> = surface
        .slices
        .iter()
        .flat_map(|slice| &slice.curves)
        .collect();
    let shown = all.len().min(DRAWN);
    let pick = |k: usize| line_of(all[k * all.len() / shown], PARTS);
    (0..shown).map(pick).collect()
}
