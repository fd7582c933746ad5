//! Runs a study of one pose: traces its self-motion manifolds, judges its tolerance of failures and
//! writes the report.

use super::manifold_report::{Picture, manifold_report};
use super::manifold_result::{ManifoldFinding, curves};
use super::report_parts::formats;
use super::run::{Ready, RunError, RunOptions};
use super::settings::{ManifoldSearch, Manifolds, Pose, Study};
use super::surface_run;
use crate::design::TaskSpace;
use crate::kinematics::Chain;
use crate::manifold::{PreImageSearch, SearchSettings, SelfMotionManifold, physical_arcs};
use crate::report::{self, ReportError, write_manifold_report};
use crate::sampling;
use crate::workspace::{PoseTolerance, limit_crossings};
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use serde_json::{Value, json};
use std::time::Instant;

/// Residual above which one Newton step per vertex is enough.
const ONE_STEP: f64 = 1e-6;

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
    if study.design.robot.degree_of_redundancy(study.task) > 1 {
        return surface_run::run(study, manifolds, options, ready);
    }
    ready.begin(options)?;
    let progress = &ready.session.progress;
    progress.update(0, 1, f64::NAN, "tracing");
    let started = Instant::now();
    let robot = &study.design.robot;
    let mut search = PreImageSearch::new(robot, study.task, settings(&manifolds.search))
        .map_err(anyhow::Error::from)?;
    let pose = tool(&manifolds.pose);
    let pre_image = search.find(&pose, &mut sampling::stream(study.seed, 0));
    let physical = physical_arcs(robot);
    let limits = manifolds.limits.as_ref().map(|l| l.to_limits(robot));
    let judge = |l| PoseTolerance::of(&pre_image, &physical, l, &study.failures);
    let tolerance = limits.as_ref().map(judge);
    let crossings = |manifold: &SelfMotionManifold| match &limits {
        Some(limits) => limit_crossings(manifold, limits),
        None => Vec::new(),
    };
    let crossings: Vec<_> = pre_image.manifolds.iter().map(crossings).collect();
    let finding = ManifoldFinding {
        study,
        manifolds,
        pre_image: &pre_image,
        physical: &physical,
        tolerance: tolerance.as_ref(),
        crossings: &crossings,
        residual: residual(search.chain(), &pre_image.manifolds, &pose, study.task),
        seconds: json!({
            "total": ready.session.store.seconds(),
            "search": started.elapsed().as_secs_f64(),
        }),
        threads: rayon::current_num_threads(),
    };
    let result = finding.to_json();
    progress.update(0, 1, f64::NAN, "writing the report");
    write(&finding, &result, options, &ready.study_toml).map_err(anyhow::Error::from)?;
    ready.session.store.remove();
    Ok(result)
}

/// Writes the report, or without figures its numbers alone.
fn write(
    finding: &ManifoldFinding,
    result: &Value,
    options: &RunOptions,
    study_toml: &str,
) -> Result<(), ReportError> {
    let (study, out) = (finding.study, &options.out);
    if study.report.figures {
        let picture = Picture::of(finding);
        let report = manifold_report(finding, &picture, result, study_toml);
        write_manifold_report(&report, out, &formats(study))?;
        return Ok(());
    }
    let csv = curves(finding.pre_image, &study.design.robot).to_csv()?;
    report::write_text(&out.join("manifolds.csv"), &csv)?;
    report::write_json(&out.join("result.json"), result)
}

pub(super) fn settings(search: &ManifoldSearch) -> SearchSettings {
    let mut settings = SearchSettings::default();
    settings.least_seeds = search.seeds as usize;
    settings.most_seeds = settings.most_seeds.max(settings.least_seeds);
    settings.unreachable_after = settings.unreachable_after.max(settings.least_seeds);
    if search.residual < ONE_STEP {
        settings.trace.polish += 1;
    }
    settings
}

/// The pose of the tool in the world frame.
pub(super) fn tool(pose: &Pose) -> Isometry3<f64> {
    let coordinate = |k: usize| pose.position.get(k).copied().unwrap_or(0.0);
    let rotation = match (&pose.rotation, pose.phi_deg) {
        (Some(rows), _) => {
            let matrix = Matrix3::from_fn(|r, c| rows[r][c]);
            // The rows are orthonormal to 1e-6 only; the unit quaternion is so to round-off.
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix))
        }
        (None, Some(phi)) => UnitQuaternion::from_axis_angle(&Vector3::z_axis(), phi.to_radians()),
        (None, None) => UnitQuaternion::identity(),
    };
    let position = Translation3::new(coordinate(0), coordinate(1), coordinate(2));
    Isometry3::from_parts(position, rotation)
}

/// Largest distance of a vertex' pose from the wanted one: metres, and radians of orientation.
pub(super) fn residual<'m>(
    chain: &Chain,
    curves: impl IntoIterator<Item = &'m SelfMotionManifold>,
    pose: &Isometry3<f64>,
    task: TaskSpace,
) -> [f64; 2] {
    let mut worst = [0.0f64; 2];
    for curve in curves {
        for index in 0..curve.vertices() {
            let tool = chain.tool(curve.point(index));
            let mut off = tool.translation.vector - pose.translation.vector;
            if task.is_planar() {
                off.z = 0.0;
            }
            worst[0] = worst[0].max(off.norm());
            worst[1] = worst[1].max(tool.rotation.angle_to(&pose.rotation));
        }
    }
    worst
}
