//! Runs `kind = "largest-manifold"`: the location with the largest self-motion manifolds.

use super::largest_result::{LargestFinding, sections, summary};
use super::location_result::{Projections, arm_pose, location_search};
use super::report_parts::{formats, provenance_rows};
use super::run::{Ready, RunError, RunOptions};
use super::settings::Study;
use super::singular_settings::LargestManifold;
use crate::report::{
    ArmPose, ArmPosesFigure, DistributionFigure, Figure, FindingReport, JointRangesFigure,
    ParetoFigure, ParetoPoint, ReportError, SizeSample, write_finding_report,
};
use crate::singularity::{Candidate, Comparison, LocationSearch, Origin, compare, find_largest};
use nalgebra::Vector3;
use serde_json::{Value, json};
use std::sync::atomic::Ordering;
use std::time::Instant;

/// Joints whose range is narrower stand still, radians.
const STILL: f64 = 1e-3;
/// Configurations on the largest manifold that are drawn, besides the most dexterous one.
const DRAWN: usize = 3;

/// Runs `study` and returns the content of `result.json`.
///
/// # Errors
/// A file could not be written, the run was interrupted, or the robot cannot do the task.
pub(super) fn run(
    study: &Study,
    asked: &LargestManifold,
    options: &RunOptions,
    ready: Ready,
) -> Result<Value, RunError> {
    ready.begin(options)?;
    let progress = &ready.session.progress;
    let search = location_search(study)?;
    let started = Instant::now();
    let watch = |stage: &str, done: usize, all: usize| {
        progress.update(done as u64, all as u64 + 2, f64::NAN, stage);
    };
    let interrupt = &ready.session.interrupt;
    let stop = || interrupt.load(Ordering::SeqCst);
    let found = find_largest(&search, &asked.settings(), study.seed, &watch, &stop);
    let Some(found) = found else {
        return Err(match stop() {
            true => RunError::Interrupted,
            false => anyhow::anyhow!(
                "no random start holds a configuration inside the physical limits: raise `starts`"
            )
            .into(),
        });
    };
    let searched = started.elapsed().as_secs_f64();
    progress.update(4, 6, found.best.size, "comparing distributions of sizes");
    let moves: Vec<bool> = found
        .largest
        .ranges
        .iter()
        .map(|r| r.measure() > STILL)
        .collect();
    let count = asked.largest.comparison as usize;
    let comparison = (count > 0).then(|| compare(&search, count, &moves, study.seed));
    let finding = LargestFinding {
        study,
        asked,
        physical: search.physical(),
        found: &found,
        comparison: comparison.as_ref(),
        seconds: json!({ "total": ready.session.store.seconds(), "search": searched }),
    };
    let result = finding.to_json();
    progress.update(5, 6, found.best.size, "writing the report");
    write(&finding, &search, &result, options, &ready.study_toml).map_err(anyhow::Error::from)?;
    ready.session.store.remove();
    Ok(result)
}

fn write(
    finding: &LargestFinding,
    search: &LocationSearch,
    result: &Value,
    options: &RunOptions,
    study_toml: &str,
) -> Result<(), ReportError> {
    let (study, found) = (finding.study, finding.found);
    let robot = &study.design.robot;
    let title = robot.name.clone();
    let projections = Projections::of(&found.largest, study, finding.physical);
    let projections = projections.as_ref().map(|p| p.figure(&title));
    let ranges = JointRangesFigure {
        ranges: &found.largest.ranges,
        title: title.clone(),
    };
    let arms = arms_figure(finding, search);
    let pareto = pareto_figure(finding);
    let distribution = finding.comparison.map(|c| distribution_figure(finding, c));
    let mut figures: Vec<&dyn Figure> = Vec::new();
    figures.extend(projections.as_ref().map(|f| f as &dyn Figure));
    figures.push(&ranges);
    if !study.task.is_planar() {
        figures.push(&arms);
    }
    figures.push(&pareto);
    figures.extend(distribution.as_ref().map(|f| f as &dyn Figure));
    let report = FindingReport {
        title: study.title.clone().unwrap_or_else(|| study.name.clone()),
        study: study.name.clone(),
        robot: title,
        source: robot.source.clone().unwrap_or_default(),
        summary: summary(finding),
        sections: sections(finding),
        figures,
        files: Vec::new(),
        tables: Vec::new(),
        result_json: result.clone(),
        study_toml: study_toml.to_owned(),
        provenance: provenance_rows(study, rayon::current_num_threads()),
        notes: finding.notes(),
    };
    write_finding_report(&report, &options.out, &formats(study), study.report.figures)?;
    Ok(())
}

/// The arm in the most dexterous configuration and in others that look different.
fn arms_figure(finding: &LargestFinding, search: &LocationSearch) -> ArmPosesFigure {
    let (robot, found) = (&finding.study.design.robot, finding.found);
    let best = arm_pose(
        robot,
        &found.best.dexterity.theta,
        format!("condition number {:.1}", found.best.dexterity.condition),
    );
    let mut poses: Vec<ArmPose> = vec![best];
    for (number, theta) in (1..).zip(spread_out(finding, search)) {
        poses.push(arm_pose(robot, &theta, format!("configuration {number}")));
    }
    ArmPosesFigure {
        name: "arm",
        poses,
        caption: "The arm in several configurations that hold the location with the largest \
                  self-motion manifolds: the one with the least condition number, and others far \
                  away from it and from each other, with their shadows on the floor."
            .into(),
        title: robot.name.clone(),
    }
}

/// Configurations on the manifolds, inside the physical limits, whose joints are far apart in
/// space from each other and from the most dexterous one.
fn spread_out(finding: &LargestFinding, search: &LocationSearch) -> Vec<Vec<f64>> {
    let robot = &finding.study.design.robot;
    let inside = |theta: &[f64]| {
        let mut pairs = theta.iter().zip(search.physical());
        pairs.all(|(&angle, arc)| arc.contains(angle))
    };
    let manifolds = finding.found.largest.manifolds.iter();
    let points = manifolds.flat_map(|m| (0..m.vertices()).step_by(4).map(|k| m.point(k).to_vec()));
    let choice: Vec<Vec<f64>> = points.filter(|theta| inside(theta)).collect();
    let places = |theta: &Vec<f64>| arm_pose(robot, theta, String::new()).places;
    let skeletons: Vec<_> = choice.iter().map(places).collect();
    let mut chosen = vec![places(&finding.found.best.dexterity.theta)];
    let mut found = Vec::new();
    for _ in 0..DRAWN {
        let gap = |k: usize| {
            let distance = |other: &Vec<Vector3<f64>>| -> f64 {
                let pairs = skeletons[k].iter().zip(other);
                pairs.map(|(a, b)| (a - b).norm_squared()).sum()
            };
            chosen.iter().map(distance).fold(f64::INFINITY, f64::min)
        };
        let gaps: Vec<f64> = (0..choice.len()).map(gap).collect();
        let Some(far) = (0..gaps.len()).max_by(|&a, &b| gaps[a].total_cmp(&gaps[b])) else {
            break;
        };
        if gaps[far] > 1e-6 {
            chosen.push(skeletons[far].clone());
            found.push(choice[far].clone());
        }
    }
    found
}

fn pareto_figure(finding: &LargestFinding) -> ParetoFigure {
    let found = finding.found;
    let point = |candidate: &Candidate| ParetoPoint {
        size: candidate.size,
        measures: [
            candidate.dexterity.condition,
            candidate.dexterity.manipulability,
            candidate.dexterity.fault_tolerant,
        ],
        origin: match candidate.origin {
            Origin::Random => "random",
            Origin::Singular => "singular",
            Origin::Refined => "refined",
            Origin::Varied => "varied",
        }
        .into(),
    };
    let all = found.random.iter().chain(&found.singular);
    let all = all.chain(&found.refined).filter(|c| c.is_whole);
    ParetoFigure {
        points: all.map(point).collect(),
        fronts: found
            .pareto
            .each_ref()
            .map(|front| front.iter().map(point).collect()),
        title: finding.study.design.robot.name.clone(),
    }
}

fn distribution_figure(finding: &LargestFinding, comparison: &Comparison) -> DistributionFigure {
    let found = finding.found;
    let sample = |name: [&str; 2], sizes: &[f64]| SizeSample {
        name: name.map(String::from).to_vec(),
        sizes: sizes.to_vec(),
    };
    let singular = found.singular.iter().filter(|c| c.is_whole);
    let singular: Vec<f64> = singular.map(|c| c.size).collect();
    DistributionFigure {
        samples: vec![
            sample(["random", "configurations"], &comparison.random),
            sample(["best", "manipulability"], &comparison.manipulability),
            sample(
                ["best fault-tol.", "manipulability"],
                &comparison.fault_tolerant,
            ),
            sample(["singular", "configurations"], &singular),
        ],
        extremes: [found.largest.size, found.smallest.0.size],
        title: finding.study.design.robot.name.clone(),
    }
}
