//! What the report of a study of one pose shows.

use super::manifold_result::{ManifoldFinding, curves};
use super::report_parts::{failures_label, provenance_rows};
use super::settings::{Pose, Study};
use crate::angle::{AngleSet, Arc};
use crate::design::{JointKind, Robot};
use crate::kinematics::joint_scales;
use crate::manifold::{Completeness, CurveStatus, SelfMotionManifold};
use crate::report::{
    CriticalPoint, JointRow, ManifoldCurve, ManifoldFigure, ManifoldFigure3d, ManifoldReport,
    ManifoldRow, PoseVerdict,
};
use crate::workspace::{ArtificialLimits, PoseTolerance};
use serde_json::Value;
use std::f64::consts::{PI, TAU};

/// Parts of a segment between two vertices when drawn: segments are up to 0.4 rad long, the cubic
/// between their ends is not straight.
const PARTS: usize = 8;

/// What the figures of manifolds show, in internal joint variables.
pub(super) struct Picture {
    curves: Vec<ManifoldCurve>,
    joint_ranges: Vec<AngleSet>,
    limits: Option<ArtificialLimits>,
    critical_points: Vec<CriticalPoint>,
    crossings: Vec<Vec<f64>>,
    joints: [usize; 3],
}

impl Picture {
    pub fn of(finding: &ManifoldFinding) -> Picture {
        let manifolds = &finding.pre_image.manifolds;
        let limits = finding.manifolds.limits.as_ref();
        let limits = limits.map(|limits| limits.to_limits(&finding.study.design.robot));
        let critical = |manifold: &SelfMotionManifold| -> Vec<CriticalPoint> {
            let joints = 0..manifold.joints;
            let points = joints.flat_map(|joint| manifold.critical_points(joint));
            let point = |p: crate::manifold::CriticalPoint| CriticalPoint {
                joint: p.joint + 1,
                configuration: p.theta,
            };
            points.map(point).collect()
        };
        Picture {
            curves: manifolds.iter().map(drawn).collect(),
            joint_ranges: finding.ranges(manifolds),
            critical_points: manifolds.iter().flat_map(critical).collect(),
            crossings: finding.crossings.concat(),
            joints: axes(manifolds, finding.physical.len(), limits.as_ref()),
            limits,
        }
    }

    fn figure(&self, title: &str) -> ManifoldFigure<'_> {
        ManifoldFigure {
            curves: &self.curves,
            joint_ranges: &self.joint_ranges,
            limits: self.limits.as_ref(),
            critical_points: &self.critical_points,
            crossings: &self.crossings,
            are_slices: false,
            title: title.to_owned(),
        }
    }

    fn view(&self, title: &str) -> ManifoldFigure3d<'_> {
        ManifoldFigure3d {
            curves: &self.curves,
            joint_count: self.joint_ranges.len(),
            joints: self.joints,
            limits: self.limits.as_ref(),
            critical_points: &self.critical_points,
            crossings: &self.crossings,
            title: title.to_owned(),
        }
    }
}

/// The report of `finding`, whose `result.json` is `result`.
pub(super) fn manifold_report<'p>(
    finding: &ManifoldFinding,
    picture: &'p Picture,
    result: &Value,
    study_toml: &str,
) -> ManifoldReport<'p> {
    let study = finding.study;
    let robot = &study.design.robot;
    let found = !finding.pre_image.manifolds.is_empty();
    ManifoldReport {
        title: study.title.clone().unwrap_or_else(|| study.name.clone()),
        study: study.name.clone(),
        robot: robot.name.clone(),
        source: robot.source.clone().unwrap_or_default(),
        task: study.task.to_string(),
        failures_label: failures_label(study),
        pose: pose_rows(&finding.manifolds.pose),
        completeness: completeness(finding.pre_image.completeness),
        winding_sum: finding.pre_image.winding_sum(),
        manifolds: manifold_rows(finding),
        joints: joint_rows(
            study,
            &picture.joint_ranges,
            picture.limits.as_ref(),
            finding.tolerance,
        ),
        verdict: finding.tolerance.map(verdict),
        figure: found.then(|| picture.figure(&robot.name)),
        view: found.then(|| picture.view(&robot.name)),
        surface: None,
        vertices: Some(curves(finding.pre_image, robot)),
        result_json: result.clone(),
        study_toml: study_toml.to_owned(),
        provenance: provenance_rows(study, finding.threads),
        notes: finding.notes(),
    }
}

/// A manifold as a line of short straight parts.
pub(super) fn drawn(manifold: &SelfMotionManifold) -> ManifoldCurve {
    line_of(manifold, PARTS)
}

/// A curve as a line, `parts` straight parts for every segment.
pub(super) fn line_of(manifold: &SelfMotionManifold, parts: usize) -> ManifoldCurve {
    let mut points = vec![manifold.point(0).to_vec()];
    for index in 0..manifold.vertices().saturating_sub(1) {
        let at = |part: usize| manifold.at(index, part as f64 / parts as f64);
        points.extend((1..=parts).map(at));
    }
    let closed = manifold.status == CurveStatus::Closed;
    if closed {
        // The last vertex is the first one again.
        points.pop();
    }
    ManifoldCurve { points, closed }
}

/// Numbers of the joints of the view in space: with limits the three with the narrowest from
/// joint 2 on, whose box cuts the curves; else those whose angles pass ±180° least often, so that
/// curves stay whole, and of these the ones that move most.
fn axes(
    manifolds: &[SelfMotionManifold],
    joints: usize,
    limits: Option<&ArtificialLimits>,
) -> [usize; 3] {
    let merit = |joint: usize| match limits {
        Some(limits) if joint > 0 => TAU - limits.joints()[joint].width(),
        Some(_) => -1.0,
        None => shape(manifolds, joint),
    };
    let mut order: Vec<(usize, f64)> = (0..joints).map(|joint| (joint, merit(joint))).collect();
    // Stable: of equal joints the first.
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut chosen: Vec<usize> = order.iter().take(3).map(|(joint, _)| joint + 1).collect();
    chosen.sort_unstable();
    chosen.try_into().unwrap_or([1, 2, 3])
}

/// How well `joint` shows the curves: large if it moves and its angle does not pass ±180°.
fn shape(manifolds: &[SelfMotionManifold], joint: usize) -> f64 {
    let (mut travel, mut cuts) = (0.0, 0.0);
    for manifold in manifolds {
        for k in 0..manifold.vertices().saturating_sub(1) {
            let ends = [k, k + 1].map(|k| manifold.point(k)[joint]);
            travel += (ends[1] - ends[0]).abs();
            let [from, to] = ends.map(|end| ((end + PI) / TAU).floor());
            cuts += (to - from).abs();
        }
    }
    // No joint travels as far; one that stands still shows nothing.
    const CUT: f64 = 1e4;
    if travel < 1e-3 {
        f64::NEG_INFINITY
    } else {
        travel - CUT * cuts
    }
}

fn completeness(completeness: Completeness) -> String {
    match completeness {
        Completeness::Proved => "proved".into(),
        Completeness::Evidence(missed) => format!(
            "supported by evidence: every curve was traced to its end, the winding vectors sum to \
             zero as they must, and from the hits of random starts the probability that a \
             manifold is missing is estimated at {missed:.0e}"
        ),
        Completeness::Unknown => "not certain: a check failed (see the notes)".into(),
    }
}

pub(super) fn pose_rows(pose: &Pose) -> Vec<(String, String)> {
    let row = |numbers: &[f64]| {
        let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
        format!("({})", numbers.join(", "))
    };
    let mut rows = vec![("position (m)".to_owned(), row(&pose.position))];
    let turned = pose.rotation.iter().flatten().enumerate();
    rows.extend(turned.map(|(k, entries)| (format!("rotation, row {}", k + 1), row(entries))));
    rows.extend(
        pose.phi_deg
            .map(|phi| ("direction of the tool".to_owned(), format!("{phi}°"))),
    );
    rows
}

fn manifold_rows(finding: &ManifoldFinding) -> Vec<ManifoldRow> {
    let limited = finding.manifolds.limits.is_some();
    let row = |(manifold, crossings): (&SelfMotionManifold, &Vec<Vec<f64>>)| {
        let points = (0..manifold.joints).map(|joint| manifold.critical_points(joint).len());
        ManifoldRow {
            status: match manifold.status {
                CurveStatus::Closed => "closed",
                CurveStatus::Stroke => "ends where a stroke ends",
                CurveStatus::Singular => "ends at a singular configuration",
                CurveStatus::TooLong => "not traced to its end",
            }
            .into(),
            length: manifold.length,
            winding: manifold.winding.clone(),
            critical_points: points.sum(),
            crossings: limited.then_some(crossings.len()),
            hits: manifold.hits,
        }
    };
    let manifolds = finding.pre_image.manifolds.iter();
    manifolds.zip(finding.crossings).map(row).collect()
}

pub(super) fn verdict(tolerance: &PoseTolerance) -> PoseVerdict {
    PoseVerdict {
        is_reached: tolerance.before_failure.contains(0.0),
        is_fault_tolerant: tolerance.rotation_set.contains(0.0),
        rotation_set: tolerance.rotation_set.clone(),
    }
}

pub(super) fn joint_rows(
    study: &Study,
    ranges: &[AngleSet],
    limits: Option<&ArtificialLimits>,
    tolerance: Option<&PoseTolerance>,
) -> Vec<JointRow> {
    let robot: &Robot = &study.design.robot;
    let scales = joint_scales(robot).unwrap_or_default();
    let row = |(joint, range): (usize, &AngleSet)| {
        let is_prismatic = robot.joint_kind(joint) == JointKind::Prismatic;
        let outer = |ends: [f64; 2]| match (is_prismatic, scales.get(joint)) {
            (true, Some(scale)) => ends.map(|end| scale.outer(end)),
            _ => ends,
        };
        let ends = |arc: &Arc| outer([arc.start(), arc.end()]);
        let limit = limits.map(|l| l.joints()[joint]);
        JointRow {
            ranges: range.arcs().iter().map(ends).collect(),
            limits: limit.map(|limit| outer([limit.lower, limit.upper])),
            is_prismatic,
            is_prone: study.failures.contains(joint + 1),
            is_tolerated: tolerance.map(|t| t.survives[joint]),
        }
    };
    ranges.iter().enumerate().map(row).collect()
}
