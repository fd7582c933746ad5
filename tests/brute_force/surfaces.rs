//! Membership for arms with two degrees of redundancy: searches inside boxes.

use super::arm::Arm;
use super::{Interval, grid};
use faultspace::workspace::FailureSet;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// One sample with many configurations that reach it.
pub struct Surface<'a> {
    pub arm: &'a Arm,
    pub goal: Vector3<f64>,
    pub cloud: Vec<Vec<f64>>,
}

impl Surface<'_> {
    /// Whether some configuration with joint `k` at `q` and joints from 2 on in `box_` reaches the
    /// goal.
    pub fn exists(&self, k: usize, q: f64, box_: &[Option<Interval>]) -> bool {
        let arm = self.arm;
        let mut near: Vec<(f64, &Vec<f64>)> = self
            .cloud
            .iter()
            .map(|theta| {
                let outside = |j: usize| match box_[j] {
                    Some([low, high]) if j != k && j > 0 => {
                        (arm.distance(j, theta[j], 0.5 * (low + high)) - 0.5 * (high - low))
                            .max(0.0)
                    }
                    _ => 0.0,
                };
                let sum: f64 = (0..arm.joints()).map(outside).sum();
                (sum + arm.distance(k, theta[k], q), theta)
            })
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let starts = near.iter().take(60).chain(near.iter().skip(60).step_by(40));
        starts.into_iter().any(|(_, theta)| {
            let mut start = (*theta).clone();
            start[k] = q;
            arm.solve_inside(start, k, &self.goal, box_)
        })
    }

    /// The θ₁ at which joints from 2 on may stand in `box_`, as arcs with ends to 1e-3 rad.
    pub fn first(&self, box_: &[Option<Interval>]) -> Vec<Interval> {
        const STEPS: usize = 90;
        let step = TAU / STEPS as f64;
        let on: Vec<bool> = (0..STEPS)
            .map(|k| self.exists(0, k as f64 * step, box_))
            .collect();
        let end = |inside: f64, outside: f64| {
            let (mut inside, mut outside) = (inside, outside);
            while (inside - outside).abs() > 1e-3 {
                let middle = 0.5 * (inside + outside);
                match self.exists(0, middle, box_) {
                    true => inside = middle,
                    false => outside = middle,
                }
            }
            inside
        };
        if on.iter().all(|&on| on) {
            return vec![[0.0, TAU]];
        }
        let begins = (0..STEPS).filter(|&k| on[k] && !on[(k + STEPS - 1) % STEPS]);
        let arc = |k: usize| {
            let length = (0..STEPS).take_while(|j| on[(k + j) % STEPS]).count();
            let (low, last) = (k as f64 * step, (k + length - 1) as f64 * step);
            [end(low, low - step), end(last, last + step)]
        };
        begins.map(arc).collect()
    }

    /// |B|.
    pub fn measure(&self, box_: &[Interval], failures: &FailureSet) -> f64 {
        let inside: Vec<_> = box_.iter().map(|&limit| Some(limit)).collect();
        let image = self.first(&inside);
        if image.is_empty() {
            return 0.0;
        }
        let physical = &self.arm.physical;
        for k in (1..self.arm.joints()).filter(|&k| failures.contains(k + 1)) {
            // The ends first: they fail most often.
            let mut locks = grid(box_[k]);
            let last = locks.len() - 1;
            locks.swap(1.min(last), last);
            if !locks.iter().all(|&q| self.exists(k, q, physical)) {
                return 0.0;
            }
        }
        let first = match failures.contains(1) {
            true => self.first(physical),
            false => vec![[0.0, TAU]],
        };
        let [low, high] = box_[0];
        const TURNS: usize = 2000;
        let inside = (0..TURNS).filter(|&turn| {
            let beta = turn as f64 / TURNS as f64 * TAU;
            let meets = |arc: &Interval| {
                (arc[0] + beta - low).rem_euclid(TAU) <= high - low
                    || (low - arc[0] - beta).rem_euclid(TAU) <= arc[1] - arc[0]
            };
            let holds = |arc: &Interval| {
                arc[1] - arc[0] >= TAU
                    || (low - beta - arc[0]).rem_euclid(TAU) + high - low <= arc[1] - arc[0]
            };
            image.iter().any(meets) && first.iter().any(holds)
        });
        inside.count() as f64 * TAU / TURNS as f64
    }
}
