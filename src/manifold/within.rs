//! The parts of a self-motion manifold inside a set of configurations, such as a box of limits.

use super::self_motion::SelfMotionManifold;

/// Halvings that locate where a curve leaves a box, far below a part's length.
const HALVINGS: usize = 40;

/// A connected part of a curve inside a box.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Least and greatest variable of every joint.
    pub spans: Vec<[f64; 2]>,
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
    let mut runs: Vec<Run> = Vec::new();
    let first = manifold.point(0);
    let mut was_inside = is_inside(first);
    if was_inside {
        runs.push(Run::at(first));
    }
    for index in 0..manifold.vertices().saturating_sub(1) {
        for part in 1..=parts {
            let [from, to] = [part - 1, part].map(|k| k as f64 / parts as f64);
            let next = manifold.at(index, to);
            let now = is_inside(&next);
            if now != was_inside {
                let edge = crossing(manifold, index, [from, to], was_inside, is_inside);
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
            was_inside = now;
        }
    }
    runs
}

impl Run {
    fn at(theta: &[f64]) -> Run {
        Run {
            spans: theta.iter().map(|&value| [value, value]).collect(),
            ends: Vec::new(),
        }
    }

    fn widen(&mut self, theta: &[f64]) {
        for (span, &value) in self.spans.iter_mut().zip(theta) {
            *span = [span[0].min(value), span[1].max(value)];
        }
    }
}

/// The last configuration inside, between two parameters of a segment of which one is inside.
fn crossing(
    manifold: &SelfMotionManifold,
    index: usize,
    ends: [f64; 2],
    first_is_inside: bool,
    is_inside: &impl Fn(&[f64]) -> bool,
) -> Vec<f64> {
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
    manifold.at(index, inside)
}
