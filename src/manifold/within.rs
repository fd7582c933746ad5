//! The parts of a self-motion manifold inside a set of configurations, such as a box of limits.

use super::self_motion::SelfMotionManifold;
use crate::angle::{Arc, wrap};

/// Halvings that locate where a curve leaves a box, far below a part's length.
const HALVINGS: usize = 40;

/// Slack of a box, radians, above the error of locating a crossing.
const CLOSED: f64 = 1e-9;

/// A connected part of a curve inside a box.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Least and greatest variable of every joint.
    pub spans: Vec<[f64; 2]>,
    /// The configurations at which every joint's variable is least and greatest.
    pub extremes: Vec<[Vec<f64>; 2]>,
    /// Where the curve enters and leaves the box; not the ends of the curve itself.
    pub ends: Vec<Vec<f64>>,
}

/// The connected parts of a manifold at whose configurations (internal joint variables) `is_inside`
/// holds, in the order of the curve; the two ends of a closed curve are not joined.
///
/// A curve is looked at between `parts` parts of every segment, which is at most 0.4 rad long:
/// what leaves and comes back within a part is overlooked.
pub fn runs_inside(
    manifold: &SelfMotionManifold,
    parts: usize,
    is_inside: &impl Fn(&[f64]) -> bool,
) -> Vec<Run> {
    runs(manifold, parts, is_inside, &|_, _, _| Vec::new())
}

/// The connected parts of a manifold inside a box of arcs, one for every joint. As
/// [`runs_inside`], but a joint that passes the whole of its arc within a part is seen, however
/// narrow the arc: limits of width 0 are met in a point.
pub fn runs_in_box(manifold: &SelfMotionManifold, parts: usize, bounds: &[Arc]) -> Vec<Run> {
    let is_inside = |theta: &[f64]| {
        let mut joints = theta.iter().zip(bounds);
        joints.all(|(&angle, arc)| arc.contains_within(angle, CLOSED))
    };
    let passed = |index: usize, ends: [f64; 2], [a, b]: [&[f64]; 2]| {
        let off = |joint: usize, theta: &[f64]| wrap(theta[joint] - bounds[joint].centre());
        let mut stops = Vec::new();
        for (joint, arc) in bounds.iter().enumerate().filter(|(_, arc)| !arc.is_full()) {
            let (from, to) = (off(joint, a), off(joint, b));
            let narrow = from.abs().min(to.abs()) > 0.5 * arc.width();
            if from * to < 0.0 && (to - from).abs() < 1.0 && narrow {
                let ahead = |theta: &[f64]| off(joint, theta) * from >= 0.0;
                stops.push(switch(manifold, index, ends, true, &ahead));
            }
        }
        stops.sort_by(f64::total_cmp);
        stops
    };
    runs(manifold, parts, &is_inside, &passed)
}

/// The parts of a curve at which `is_inside` holds; `stops` gives further parameters at which to
/// look at a part of a segment, from those of its ends and the configurations there.
fn runs(
    manifold: &SelfMotionManifold,
    parts: usize,
    is_inside: &impl Fn(&[f64]) -> bool,
    stops: &impl Fn(usize, [f64; 2], [&[f64]; 2]) -> Vec<f64>,
) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let first = manifold.point(0);
    let mut was_inside = is_inside(first);
    if was_inside {
        runs.push(Run::at(first));
    }
    let mut last = first.to_vec();
    for index in 0..manifold.vertices().saturating_sub(1) {
        for part in 1..=parts {
            let [mut from, end] = [part - 1, part].map(|k| k as f64 / parts as f64);
            let goal = manifold.at(index, end);
            for to in stops(index, [from, end], [&last, &goal])
                .into_iter()
                .chain([end])
            {
                let next = manifold.at(index, to);
                let now = is_inside(&next);
                if now != was_inside {
                    let edge = switch(manifold, index, [from, to], was_inside, is_inside);
                    let edge = manifold.at(index, edge);
                    if now {
                        runs.push(Run::at(&edge));
                    }
                    if let Some(run) = runs.last_mut() {
                        run.widen(&edge);
                        run.ends.push(edge);
                    }
                }
                if now && let Some(run) = runs.last_mut() {
                    run.widen(&next);
                }
                (was_inside, from) = (now, to);
            }
            last = goal;
        }
    }
    runs
}

impl Run {
    fn at(theta: &[f64]) -> Run {
        Run {
            spans: theta.iter().map(|&value| [value, value]).collect(),
            extremes: vec![[theta.to_vec(), theta.to_vec()]; theta.len()],
            ends: Vec::new(),
        }
    }

    fn widen(&mut self, theta: &[f64]) {
        let joints = self.spans.iter_mut().zip(&mut self.extremes);
        for ((span, [low, high]), &value) in joints.zip(theta) {
            if value < span[0] {
                span[0] = value;
                low.copy_from_slice(theta);
            }
            if value > span[1] {
                span[1] = value;
                high.copy_from_slice(theta);
            }
        }
    }
}

/// The last parameter inside, between two parameters of a segment of which one is inside.
fn switch(
    manifold: &SelfMotionManifold,
    index: usize,
    ends: [f64; 2],
    first_is_inside: bool,
    is_inside: &impl Fn(&[f64]) -> bool,
) -> f64 {
    let [mut inside, mut outside] = match first_is_inside {
        true => ends,
        false => [ends[1], ends[0]],
    };
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        match is_inside(&manifold.at(index, middle)) {
            true => inside = middle,
            false => outside = middle,
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::CurveStatus;

    /// A straight way along which the first joint passes 0.05 in the middle of a part.
    #[test]
    fn narrow_boxes_are_not_passed_over() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let line = SelfMotionManifold {
            joints: 2,
            status: CurveStatus::TooLong,
            length: 0.2 / half,
            winding: vec![0; 2],
            points: vec![0.0, 1.0, 0.2, 1.2],
            tangents: vec![half; 4],
            crossings: Vec::new(),
            hits: 1,
        };
        for width in [0.0, 1e-7, 1e-3, 0.1] {
            let bounds = [Arc::new(0.05 - 0.5 * width, width), Arc::FULL];
            let runs = runs_in_box(&line, 2, &bounds);
            assert_eq!(runs.len(), 1, "{width}");
            assert!((runs[0].spans[1][0] - (1.05 - 0.5 * width)).abs() < 1e-8);
            assert!((runs[0].spans[1][1] - (1.05 + 0.5 * width)).abs() < 1e-8);
            assert_eq!(runs[0].ends.len(), if width < 0.1 { 2 } else { 1 });
            let elsewhere = [bounds[0], Arc::new(1.06, 1.0)];
            assert_eq!(
                runs_in_box(&line, 2, &elsewhere).len(),
                usize::from(width > 0.05)
            );
        }
    }
}
