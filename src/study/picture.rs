//! What the figures of a planar study show: the arm, and the score along each limit.

use super::planar_arm::PlanarStudy;
use crate::angle::turn;
use crate::report::{LimitSide, Sensitivity, SensitivityCurve};
use crate::sampling;
use crate::workspace::{ArtificialLimits, JointLimit, WorkspaceMap};
use nalgebra::Complex;
use rand::Rng;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Configurations tried for the arm of the picture.
const POSTURES: usize = 4000;

/// Points of a sensitivity curve besides the optimum.
pub(super) const CURVE_POINTS: usize = 60;

/// A sensitivity curve moves a limit this far to either side (radians).
pub(super) const CURVE_RANGE: f64 = PI / 2.0;

/// Joint angles (between links) inside the limits with the end point in the fault-tolerant
/// workspace, as far from its limits and as stretched out as a random search finds; the middle of
/// the limits if no configuration ends there.
pub(super) fn posture(
    arm: &PlanarStudy,
    limits: &ArtificialLimits,
    map: &WorkspaceMap,
) -> Vec<f64> {
    let joints = limits.joints();
    let middle: Vec<f64> = joints.iter().map(JointLimit::centre).collect();
    let mut generator = sampling::stream(0, 0);
    let mut best = (f64::NEG_INFINITY, middle);
    for _ in 0..POSTURES {
        // Shares of the limits, kept off the ends so that the picture shows some room.
        let shares: Vec<f64> = joints
            .iter()
            .map(|_| generator.random_range(0.08..0.92))
            .collect();
        let each = joints.iter().zip(&shares);
        let angles: Vec<f64> = each.map(|(l, share)| l.lower + share * l.width()).collect();
        let merit = merit(arm, &angles, map);
        if merit > best.0 {
            best = (merit, angles);
        }
    }
    best.1
}

/// Smallest distance between parts of the arm that are not neighbours, if the end point is in the
/// workspace: pictures of folded arms are hard to read.
fn merit(arm: &PlanarStudy, angles: &[f64], map: &WorkspaceMap) -> f64 {
    let points = points(&arm.lengths, angles);
    let end = points[points.len() - 1];
    if !contains(map, end) {
        return f64::NEG_INFINITY;
    }
    let mut closest = f64::INFINITY;
    for (k, p) in points.iter().enumerate() {
        for q in &points[..k] {
            closest = closest.min((p - q).norm());
        }
    }
    closest
}

fn points(lengths: &[f64], angles: &[f64]) -> Vec<Complex<f64>> {
    let mut points = vec![Complex::new(0.0, 0.0)];
    let (mut end, mut heading) = (points[0], 0.0);
    for (&length, &angle) in lengths.iter().zip(angles) {
        heading += angle;
        end += Complex::from_polar(length, heading);
        points.push(end);
    }
    points
}

fn contains(map: &WorkspaceMap, point: Complex<f64>) -> bool {
    let (r, angle) = (point.norm(), point.arg());
    match map {
        WorkspaceMap::Rings(map) => {
            let ring = map
                .rings
                .iter()
                .find(|ring| ring.inner <= r && r < ring.outer);
            ring.is_some_and(|ring| ring.rotation_set.contains(angle))
        }
        WorkspaceMap::Shares(map) => {
            let row = map.radius_edges.partition_point(|&edge| edge <= r);
            let column = (turn(-PI, angle) / TAU * map.angles as f64) as usize;
            let cell = row.checked_sub(1).map(|row| row * map.angles + column);
            let share = cell.and_then(|cell| map.share.get(cell));
            share.is_some_and(|&share| share > 0.0)
        }
    }
}

/// S_F along every limit through `limits` (between links), all other limits fixed. The limits of
/// the first joint, and for pose tasks of the last, move symmetrically.
pub(super) fn sensitivity(
    arm: &PlanarStudy,
    limits: &ArtificialLimits,
    unit: &str,
    mark: &str,
) -> Sensitivity {
    let joints = limits.joints();
    let mut curves = Vec::new();
    for k in 0..joints.len() {
        let symmetric = k == 0 || (arm.is_pose() && k + 1 == joints.len());
        let sides: &[LimitSide] = if symmetric {
            &[LimitSide::HalfWidth]
        } else {
            &[LimitSide::Lower, LimitSide::Upper]
        };
        curves.extend(sides.iter().map(|&side| (k, side)));
    }
    let curves = curves
        .into_par_iter()
        .map(|(k, side)| curve(arm, limits, k, side))
        .collect();
    Sensitivity {
        score_label: "S_F".into(),
        unit: unit.into(),
        mark: mark.into(),
        curves,
    }
}

fn curve(
    arm: &PlanarStudy,
    limits: &ArtificialLimits,
    joint: usize,
    side: LimitSide,
) -> SensitivityCurve {
    let own = limits.joints()[joint];
    let (optimum, low, high) = match side {
        LimitSide::Lower => (own.lower, own.upper - TAU, own.upper),
        LimitSide::Upper => (own.upper, own.lower, own.lower + TAU),
        LimitSide::HalfWidth => (0.5 * own.width(), 0.0, PI),
    };
    let (from, to) = (
        (optimum - CURVE_RANGE).max(low),
        (optimum + CURVE_RANGE).min(high),
    );
    let step = (to - from) / CURVE_POINTS as f64;
    let mut at: Vec<f64> = (0..=CURVE_POINTS).map(|k| from + k as f64 * step).collect();
    at.push(optimum);
    at.sort_by(f64::total_cmp);
    at.dedup();
    let score = |&value: &f64| {
        let moved = match side {
            LimitSide::Lower => JointLimit::new(value.min(own.upper), own.upper),
            LimitSide::Upper => JointLimit::new(own.lower, value.max(own.lower)),
            LimitSide::HalfWidth => JointLimit::around(own.centre(), 2.0 * value),
        };
        let mut all = limits.joints().to_vec();
        all[joint] = moved;
        arm.size(&ArtificialLimits::new(all))
    };
    // Figures and tables speak of joint variables; a half-width has no zero to shift.
    let shift = match side {
        LimitSide::HalfWidth => 0.0,
        _ => arm.offset(joint),
    };
    let values = at.par_iter().map(|value| (value - shift, score(value)));
    SensitivityCurve {
        joint: joint + 1,
        side,
        values: values.collect(),
        optimum: (optimum - shift, arm.size(limits)),
    }
}
