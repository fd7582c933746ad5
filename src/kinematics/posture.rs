//! Postures of a robot that are evenly spread, and one in which its joints can be told apart.

use super::fixed::{fixed_transforms, joint_motion};
use crate::design::{JointKind, Robot};
use nalgebra::{Isometry3, Vector3};
use std::f64::consts::PI;

/// Postures that are compared for a picture.
const CANDIDATES: usize = 4000;

/// Where a joint of a robot in some posture is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointPlace {
    /// The frame in which the joint moves: about or along its z axis.
    pub frame: Isometry3<f64>,
    /// The point of the axis that is nearest to the foot before (or the base): there the link
    /// comes in, metres.
    pub entry: Vector3<f64>,
    /// The point of the axis from which the link leaves it at a right angle, metres. A prismatic
    /// joint carries it along.
    pub foot: Vector3<f64>,
}

/// The places of all joints, base first, in the base frame.
///
/// Straight lines over the base, each joint's entry and foot, and the tool are the robot's
/// skeleton. `theta` holds the n joint variables; missing ones count as 0.
pub fn joint_places(robot: &Robot, theta: &[f64]) -> Vec<JointPlace> {
    let kinds: Vec<JointKind> = (0..robot.joints()).map(|j| robot.joint_kind(j)).collect();
    places(&fixed_transforms(robot), &kinds, theta).0
}

/// The places of the joints and the tool's frame.
fn places(
    fixed: &[Isometry3<f64>],
    kinds: &[JointKind],
    theta: &[f64],
) -> (Vec<JointPlace>, Isometry3<f64>) {
    let mut frame = fixed.first().copied().unwrap_or_default();
    let mut places = Vec::with_capacity(kinds.len());
    let mut before = Vector3::zeros();
    for (joint, (kind, link)) in kinds.iter().zip(fixed.iter().skip(1)).enumerate() {
        let moved = frame * joint_motion(*kind, theta.get(joint).copied().unwrap_or(0.0));
        let along = moved.rotation * Vector3::new(0.0, 0.0, link.translation.z);
        let axis = frame.rotation * Vector3::z();
        let origin = frame.translation.vector;
        let entry = origin + (before - origin).dot(&axis) * axis;
        before = moved.translation.vector + along;
        places.push(JointPlace {
            frame,
            entry,
            foot: before,
        });
        frame = moved * link;
    }
    (places, frame)
}

/// Posture number `number` of an evenly spread sequence (Kronecker's, of the golden ratio's
/// generalisation to n dimensions) in the given ranges of the joint variables.
pub(super) fn spread(number: usize, ranges: &[[f64; 2]]) -> Vec<f64> {
    let base = golden(ranges.len());
    let place = |(index, [low, high]): (usize, &[f64; 2])| {
        let share = (0.5 + (number + 1) as f64 * base.powi(-(index as i32 + 1))).fract();
        low + share * (high - low)
    };
    ranges.iter().enumerate().map(place).collect()
}

/// The root above 1 of x^(n+1) = x + 1.
fn golden(dimensions: usize) -> f64 {
    let power = 1.0 / (dimensions as f64 + 1.0);
    (0..64).fold(1.5f64, |x, _| (1.0 + x).powf(power))
}

/// A posture for pictures: the joints are apart from each other, neighbouring links form angles,
/// and the arm is above its base, as far as physical limits allow. Radians and metres.
pub fn display_posture(robot: &Robot) -> Vec<f64> {
    let fixed = fixed_transforms(robot);
    let kinds: Vec<JointKind> = (0..robot.joints()).map(|j| robot.joint_kind(j)).collect();
    let lengths = fixed.iter().map(|c| c.translation.vector.norm());
    let size = lengths.sum::<f64>().max(1e-9);
    let ranges = ranges(robot, size);
    let mut best = (f64::NEG_INFINITY, Vec::new());
    for number in 0..CANDIDATES {
        let theta = spread(number, &ranges);
        let (places, tool) = places(&fixed, &kinds, &theta);
        let score = clarity(&skeleton(&places, &tool, 0.03 * size), size);
        if score > best.0 || best.1.is_empty() {
            best = (score, theta);
        }
    }
    best.1
}

fn ranges(robot: &Robot, size: f64) -> Vec<[f64; 2]> {
    let range = |joint| {
        let limits = robot.physical_limits.as_ref();
        let limits = limits.map(|limits| [limits.lower[joint], limits.upper[joint]]);
        match (robot.joint_kind(joint), limits) {
            (JointKind::Revolute, None) => [-PI, PI],
            (JointKind::Revolute, Some([low, high])) => {
                [low.max(-PI).min(high), high.min(PI).max(low)]
            }
            (JointKind::Prismatic, None) => [0.15 * size, 0.3 * size],
            // Drawn out, so that it is seen to slide.
            (JointKind::Prismatic, Some([low, high])) => [0.4 * low + 0.6 * high, high],
        }
    };
    (0..robot.joints()).map(range).collect()
}

/// The corners of the skeleton; of corners nearer to each other than `apart` metres the first.
fn skeleton(places: &[JointPlace], tool: &Isometry3<f64>, apart: f64) -> Vec<Vector3<f64>> {
    let ends = places.iter().flat_map(|p| [p.entry, p.foot]);
    let mut points = vec![Vector3::zeros()];
    points.extend(ends.chain([tool.translation.vector]));
    points.dedup_by(|a, b| (*a - *b).norm() < apart);
    points
}

/// How well the corners of a skeleton can be told apart: means of logarithms, so that near pairs
/// and flat corners count most.
fn clarity(points: &[Vector3<f64>], size: f64) -> f64 {
    let (mut apart, mut below, mut bent) = (Mean::default(), 0.0, Mean::default());
    for (index, a) in points.iter().enumerate() {
        for b in &points[..index] {
            apart.add(((a - b).norm_squared() / (size * size) + 1e-3).ln());
        }
        // Below the base is the floor.
        below += (-a.z / size).max(0.0);
    }
    for corner in points.windows(3) {
        let (before, after) = (corner[1] - corner[0], corner[2] - corner[1]);
        let sine = before.cross(&after).norm() / (before.norm() * after.norm()).max(1e-12);
        // Links that fold back onto each other hide each other.
        let folded = if before.dot(&after) < 0.0 { 0.4 } else { 1.0 };
        bent.add((folded * sine + 0.05).ln());
    }
    apart.value() + 1.5 * bent.value() - 10.0 * below
}

/// A mean of numbers; 0 without any.
#[derive(Default)]
struct Mean {
    sum: f64,
    count: usize,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    fn value(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}
