//! Membership for arms with one degree of redundancy: a locked arm has finitely many solutions.

use super::arm::Arm;
use super::{Interval, grid};
use faultspace::workspace::FailureSet;
use nalgebra::Vector3;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// Rotation angles tried for every sample.
pub const TURNS: usize = 144;
/// θ₁ values closer than this belong to one arc of solutions.
const JOINED: f64 = 0.08;

/// One sample: everything that does not depend on the rotation.
pub struct Solved<'a> {
    pub arm: &'a Arm,
    pub goal: Vector3<f64>,
    pub cloud: Vec<Vec<f64>>,
    /// For joints from 2 on, the solutions at every lock.
    pub locks: Vec<Vec<Vec<Vec<f64>>>>,
}

impl Solved<'_> {
    pub fn new<'a>(
        arm: &'a Arm,
        goal: Vector3<f64>,
        box_: &[Interval],
        cloud: &[Vec<f64>],
    ) -> Solved<'a> {
        let locks = |k: usize| {
            let mut before = Vec::new();
            let mut all = Vec::new();
            for q in grid(box_[k]) {
                before = arm.at_lock(k, q, &goal, cloud, &before);
                all.push(before.clone());
            }
            all
        };
        Solved {
            arm,
            goal,
            cloud: cloud.to_vec(),
            locks: (1..arm.joints()).map(locks).collect(),
        }
    }

    /// θ₁ at β = 0 of all configurations inside the box of joints from 2 on, as arcs.
    pub fn image(&self, box_: &[Interval]) -> Vec<Interval> {
        let inside = |theta: &&Vec<f64>| {
            (1..self.arm.joints()).all(|k| self.arm.inside(k, theta[k], Some(box_[k])))
        };
        let all = self.locks.iter().flatten().flatten().filter(inside);
        let mut values: Vec<f64> = all.map(|theta| theta[0].rem_euclid(TAU)).collect();
        values.sort_by(f64::total_cmp);
        let mut arcs: Vec<Interval> = Vec::new();
        for value in values {
            match arcs.last_mut() {
                Some(arc) if value - arc[1] < JOINED => arc[1] = value,
                _ => arcs.push([value, value]),
            }
        }
        arcs
    }

    /// The measure of the β at which the turned sample belongs to W_F, from evenly spaced β.
    pub fn measure(&self, box_: &[Interval], failures: &FailureSet, rng: &mut ChaCha8Rng) -> f64 {
        let prone = |k: usize| failures.contains(k + 1);
        let lost = |k: usize| prone(k) && self.locks[k - 1].iter().any(Vec::is_empty);
        if (1..self.arm.joints()).any(lost) {
            return 0.0;
        }
        let image = self.image(box_);
        let offset: f64 = rng.random();
        let inside = (0..TURNS).filter(|&turn| {
            let beta = (turn as f64 + offset) / TURNS as f64 * TAU;
            // Before the failure: an arc of θ₁ + β meets A₁.
            let [low, high] = box_[0];
            let meets = |arc: &Interval| {
                (arc[0] + beta - low).rem_euclid(TAU) <= high - low
                    || (low - arc[0] - beta).rem_euclid(TAU) <= arc[1] - arc[0]
            };
            image.iter().any(meets)
                && (1..self.arm.joints()).all(|k| !prone(k) || self.survives(k, beta))
                && (!prone(0) || self.survives_first(box_[0], beta))
        });
        inside.count() as f64 * TAU / TURNS as f64
    }

    /// Every lock of joint `k` leaves joint 1 somewhere within its physical limits.
    pub fn survives(&self, k: usize, beta: f64) -> bool {
        let arm = self.arm;
        let fits = |theta: &Vec<f64>| arm.inside(0, theta[0] + beta, arm.physical[0]);
        self.locks[k - 1].iter().all(|found| found.iter().any(fits))
    }

    pub fn survives_first(&self, limits: Interval, beta: f64) -> bool {
        let mut before = Vec::new();
        // The ends first: they fail most often.
        let mut values = grid(limits);
        let last = values.len() - 1;
        values.swap(1.min(last), last);
        values.iter().all(|q| {
            before = self
                .arm
                .at_lock(0, q - beta, &self.goal, &self.cloud, &before);
            !before.is_empty()
        })
    }
}
