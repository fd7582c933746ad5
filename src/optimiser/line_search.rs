//! Maximisation along one line of the box, for scores with kinks, jumps and plateaus.

use crate::objective::Objective;
use rayon::prelude::*;

/// A point, its score, and a direction to move along.
pub(super) struct Line<'a> {
    pub objective: &'a dyn Objective,
    pub x: &'a [f64],
    pub score: f64,
    pub direction: &'a [f64],
    /// Range of t that stays in the box.
    pub range: [f64; 2],
}

/// The best t found and its score, with the step that the next search along the same direction
/// should start from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub t: f64,
    pub score: f64,
    pub step: f64,
    pub evaluations: u64,
}

/// Points of each pass over a line whose scores come all at once: first over all of it, then
/// around the best.
const PASSES: [usize; 2] = [73, 25];

/// The same for a part of the line.
const NEAR_PASSES: [usize; 2] = [17, 17];

/// Golden-section refinements after a scan: the bracket shrinks by 0.618 each.
const REFINEMENTS: usize = 8;

impl Line<'_> {
    fn at(&self, t: f64) -> f64 {
        let space = self.objective.space();
        self.objective
            .score(&space.along(self.x, self.direction, t))
    }

    /// Scans the whole range with `samples` points, both ends among them, and refines around the
    /// best by golden section.
    pub fn scan(&self, samples: usize) -> Found {
        let [low, high] = self.range;
        let spacing = (high - low) / (samples - 1) as f64;
        let ts: Vec<f64> = (0..samples)
            .map(|k| (low + k as f64 * spacing).min(high))
            .collect();
        let scores: Vec<f64> = ts.par_iter().with_min_len(8).map(|&t| self.at(t)).collect();
        let mut best = Found {
            t: 0.0,
            score: self.score,
            step: 0.25 * spacing,
            evaluations: samples as u64,
        };
        for (&t, &score) in ts.iter().zip(&scores) {
            best.offer(t, score);
        }
        let mut bracket = [(best.t - spacing).max(low), (best.t + spacing).min(high)];
        for _ in 0..REFINEMENTS {
            let below = best.t - bracket[0];
            let above = bracket[1] - best.t;
            let into_upper = above > below;
            let t = if into_upper {
                best.t + 0.381_966 * above
            } else {
                best.t - 0.381_966 * below
            };
            let before = best.t;
            best.evaluations += 1;
            let better = best.offer(t, self.at(t));
            match (better, into_upper) {
                (true, true) => bracket[0] = before,
                (true, false) => bracket[1] = before,
                (false, true) => bracket[1] = t,
                (false, false) => bracket[0] = t,
            }
        }
        best
    }

    /// The maximum over the whole line, if the objective gives all scores of a line at once. The
    /// next search of the line may start with steps of `step`.
    pub fn exact(&self, step: f64) -> Option<Found> {
        let best = self.passes(self.range, &PASSES)?;
        Some(Found { step, ..best })
    }

    /// The maximum within two steps, if the objective gives all scores of a line at once. The step
    /// for the next search follows the move.
    pub fn exact_near(&self, step: f64) -> Option<Found> {
        let reach = 2.0 * step;
        let range = [(-reach).max(self.range[0]), reach.min(self.range[1])];
        let best = self.passes(range, &NEAR_PASSES)?;
        let step = best.t.abs().clamp(0.25 * step, 2.0 * step);
        Some(Found { step, ..best })
    }

    /// Scores over `range` and then around the best, with the given numbers of points.
    fn passes(&self, mut range: [f64; 2], passes: &[usize]) -> Option<Found> {
        let [low, high] = range;
        let mut best = Found {
            t: 0.0,
            score: self.score,
            step: 0.0,
            evaluations: 0,
        };
        for &points in passes {
            let spacing = (range[1] - range[0]) / (points - 1) as f64;
            let ts: Vec<f64> = (0..points).map(|k| range[0] + k as f64 * spacing).collect();
            let scores = self.objective.scores_along(self.x, self.direction, &ts)?;
            best.evaluations += points as u64;
            for (&t, &score) in ts.iter().zip(&scores) {
                best.offer(t, score);
            }
            range = [(best.t - spacing).max(low), (best.t + spacing).min(high)];
        }
        Some(best)
    }

    /// Steps by `step` to the better side, doubling while it pays; if neither side is better, tries
    /// the top of the parabola through the three scores and shortens the step.
    pub fn step(&self, step: f64) -> Found {
        let mut best = Found {
            t: 0.0,
            score: self.score,
            step,
            evaluations: 0,
        };
        let [low, high] = self.range;
        let ends = [step.min(high), (-step).max(low)];
        let mut probed = [f64::NAN; 2];
        for (k, &end) in ends.iter().enumerate() {
            if end == 0.0 {
                continue;
            }
            best.evaluations += 1;
            probed[k] = self.at(end);
            if best.offer(end, probed[k]) {
                self.stride(&mut best);
                best.step = best.t.abs().clamp(0.5 * step, 4.0 * step);
                return best;
            }
        }
        let curvature = probed[0] - 2.0 * self.score + probed[1];
        let top = 0.5 * step * (probed[1] - probed[0]) / curvature;
        if curvature < 0.0 && top.abs() < step && top != 0.0 {
            best.evaluations += 1;
            best.offer(top.clamp(low, high), self.at(top.clamp(low, high)));
        }
        best.step = 0.35 * step;
        best
    }

    fn stride(&self, best: &mut Found) {
        let [low, high] = self.range;
        for _ in 0..6 {
            let next = (2.0 * best.t).clamp(low, high);
            if next == best.t {
                break;
            }
            best.evaluations += 1;
            if !best.offer(next, self.at(next)) {
                break;
            }
        }
    }
}

impl Found {
    fn offer(&mut self, t: f64, score: f64) -> bool {
        let better = score > self.score;
        if better {
            self.t = t;
            self.score = score;
        }
        better
    }
}
