//! Arms in the test's own words and their inverse kinematics.

use super::Interval;
use faultspace::design::{Convention, Geometry, Joint, JointKind, Link, PhysicalLimits, Robot};
use nalgebra::{Isometry3, Matrix3, Vector3};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};

/// A positioner in the test's own words.
pub struct Arm {
    pub name: &'static str,
    /// Twist, length, offset.
    pub rows: Vec<[f64; 3]>,
    /// Number of the prismatic joint.
    pub slide: Option<usize>,
    /// Physical limits, `None` for a free joint.
    pub physical: Vec<Option<Interval>>,
}

impl Arm {
    pub fn joints(&self) -> usize {
        self.rows.len()
    }

    /// The robot for the estimator. A free joint has limits a full turn apart.
    pub fn robot(&self) -> Robot {
        let joint = |(k, &[twist, length, offset]): (usize, &[f64; 3])| Joint {
            kind: match self.slide == Some(k) {
                true => JointKind::Prismatic,
                false => JointKind::Revolute,
            },
            link: Link {
                twist,
                length,
                offset,
                angle: 0.0,
            },
        };
        let limits = self.physical.iter();
        let limits: Vec<Interval> = limits.map(|l| l.unwrap_or([-4.0, 4.0])).collect();
        let is_free = self.physical.iter().all(Option::is_none);
        Robot {
            name: self.name.into(),
            source: None,
            geometry: Geometry::Rows {
                convention: Convention::Standard,
                joints: self.rows.iter().enumerate().map(joint).collect(),
            },
            physical_limits: (!is_free).then(|| PhysicalLimits {
                lower: limits.iter().map(|l| l[0]).collect(),
                upper: limits.iter().map(|l| l[1]).collect(),
            }),
            tool: Isometry3::identity(),
        }
    }

    /// Position of the tool and its derivative by every joint.
    pub fn position(&self, theta: &[f64]) -> (Vector3<f64>, Vec<Vector3<f64>>) {
        let (mut p, mut r) = (Vector3::zeros(), Matrix3::identity());
        let mut axes = Vec::with_capacity(theta.len());
        for (k, &[twist, length, offset]) in self.rows.iter().enumerate() {
            let (turn, slide) = match self.slide == Some(k) {
                true => (0.0, theta[k]),
                false => (theta[k], 0.0),
            };
            let axis: Vector3<f64> = r.column(2).into();
            axes.push((axis, p));
            let (s, c) = turn.sin_cos();
            p += r * Vector3::new(length * c, length * s, offset + slide);
            let (st, ct) = twist.sin_cos();
            r *= Matrix3::new(c, -s * ct, s * st, s, c * ct, -c * st, 0.0, st, ct);
        }
        let column = |(k, (axis, origin)): (usize, &(Vector3<f64>, Vector3<f64>))| match self.slide
            == Some(k)
        {
            true => *axis,
            false => axis.cross(&(p - origin)),
        };
        let columns = axes.iter().enumerate().map(column).collect();
        (p, columns)
    }

    /// Newton from `theta` onto position `goal`, with `locked` held still.
    pub fn solve(
        &self,
        mut theta: Vec<f64>,
        locked: Option<usize>,
        goal: &Vector3<f64>,
    ) -> Option<Vec<f64>> {
        for _ in 0..60 {
            let (p, columns) = self.position(&theta);
            let wanted = goal - p;
            let square = wanted.norm_squared();
            if square < 1e-20 {
                return Some(theta);
            }
            let mut gram = Matrix3::identity() * (1e-3 * square.min(1.0) + 1e-13);
            for (k, column) in columns.iter().enumerate() {
                if locked != Some(k) {
                    gram += column * column.transpose();
                }
            }
            let pull = gram.cholesky()?.solve(&wanted);
            for (k, column) in columns.iter().enumerate() {
                if locked != Some(k) {
                    theta[k] += column.dot(&pull).clamp(-0.7, 0.7);
                }
            }
        }
        None
    }

    /// As [`Arm::solve`] with joint `k` locked and all others kept in `box_`, but joint 1: a joint
    /// pushed against a limit stays there for the step.
    pub fn solve_inside(
        &self,
        mut theta: Vec<f64>,
        k: usize,
        goal: &Vector3<f64>,
        box_: &[Option<Interval>],
    ) -> bool {
        let clamp = |theta: &mut Vec<f64>| {
            for j in 1..self.joints() {
                if let (Some([low, high]), true) = (box_[j], j != k) {
                    let turns = match self.slide == Some(j) {
                        true => 0.0,
                        false => ((0.5 * (low + high) - theta[j]) / TAU).round() * TAU,
                    };
                    theta[j] = (theta[j] + turns).clamp(low, high);
                }
            }
        };
        clamp(&mut theta);
        for _ in 0..60 {
            let (p, columns) = self.position(&theta);
            let wanted = goal - p;
            let square = wanted.norm_squared();
            if square < 1e-18 {
                return true;
            }
            let mut held: Vec<bool> = (0..self.joints()).map(|j| j == k).collect();
            let mut step = vec![0.0; self.joints()];
            for _ in 0..self.joints() {
                let mut gram = Matrix3::identity() * (1e-3 * square.min(1.0) + 1e-13);
                for (column, held) in columns.iter().zip(&held) {
                    if !held {
                        gram += column * column.transpose();
                    }
                }
                let Some(factors) = gram.cholesky() else {
                    return false;
                };
                let pull = factors.solve(&wanted);
                let mut pushed = false;
                for j in 0..self.joints() {
                    step[j] = if held[j] {
                        0.0
                    } else {
                        columns[j].dot(&pull).clamp(-0.7, 0.7)
                    };
                    if let (Some([low, high]), true) = (box_[j], j > 0 && !held[j]) {
                        let out =
                            theta[j] <= low && step[j] < 0.0 || theta[j] >= high && step[j] > 0.0;
                        held[j] |= out;
                        pushed |= out;
                    }
                }
                if !pushed {
                    break;
                }
            }
            for (angle, step) in theta.iter_mut().zip(&step) {
                *angle += step;
            }
            clamp(&mut theta);
        }
        false
    }

    /// Whether `value` of joint `k` lies in `limits`.
    pub fn inside(&self, k: usize, value: f64, limits: Option<Interval>) -> bool {
        const SLACK: f64 = 1e-7;
        let Some([low, high]) = limits else {
            return true;
        };
        if self.slide == Some(k) {
            return value > low - SLACK && value < high + SLACK;
        }
        (value - low + SLACK).rem_euclid(TAU) <= high - low + 2.0 * SLACK
    }

    /// Inside all physical limits but those of joint 1, which depend on the rotation.
    pub fn allowed(&self, theta: &[f64]) -> bool {
        (1..self.joints()).all(|k| self.inside(k, theta[k], self.physical[k]))
    }

    pub fn distance(&self, k: usize, a: f64, b: f64) -> f64 {
        match self.slide == Some(k) {
            true => (a - b).abs(),
            false => ((a - b + PI).rem_euclid(TAU) - PI).abs(),
        }
    }

    /// Many configurations that reach `goal`, from random starts.
    pub fn cloud(&self, goal: &Vector3<f64>, starts: usize, rng: &mut ChaCha8Rng) -> Vec<Vec<f64>> {
        let mut cloud = Vec::new();
        for start in 0..starts {
            if start == 40 && cloud.is_empty() {
                break;
            }
            let draw = |k: usize| match (self.slide == Some(k), self.physical[k]) {
                (true, Some([low, high])) => rng.random_range(low..high),
                _ => rng.random_range(-PI..PI),
            };
            let theta: Vec<f64> = (0..self.joints()).map(draw).collect();
            cloud.extend(self.solve(theta, None, goal));
        }
        cloud
    }

    /// All solutions with joint `k` at `q` inside the physical limits (but joint 1's), from the
    /// members of the cloud with nearly this angle and from the solutions of the lock before.
    pub fn at_lock(
        &self,
        k: usize,
        q: f64,
        goal: &Vector3<f64>,
        cloud: &[Vec<f64>],
        before: &[Vec<f64>],
    ) -> Vec<Vec<f64>> {
        let mut near: Vec<(f64, &Vec<f64>)> = cloud
            .iter()
            .map(|theta| (self.distance(k, theta[k], q), theta))
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Near ones lead there in a step or two; far ones may lie on another branch.
        let far = near.iter().skip(24).step_by(6);
        let chosen = near.iter().take(24).chain(far).map(|pair| pair.1);
        let starts = before.iter().chain(chosen);
        let mut found: Vec<Vec<f64>> = Vec::new();
        for start in starts {
            let mut start = start.clone();
            start[k] = q;
            let Some(theta) = self.solve(start, Some(k), goal) else {
                continue;
            };
            let known = |other: &Vec<f64>| {
                (0..self.joints()).all(|j| self.distance(j, theta[j], other[j]) < 1e-4)
            };
            if self.allowed(&theta) && !found.iter().any(known) {
                found.push(theta);
            }
        }
        found
    }
}
