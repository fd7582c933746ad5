//! The hybrid estimator against a brute force that shares nothing with it: forward kinematics from
//! Denavit–Hartenberg rows, damped Newton steps from many starts, and the definition of W_F,
//! lock by lock on a fine grid of the artificial limits.

#![expect(
    clippy::approx_constant,
    reason = "published link lengths have four decimals"
)]

use faultspace::design::{
    Convention, Geometry, Joint, JointKind, Link, PhysicalLimits, Robot, TaskSpace,
};
use faultspace::kinematics::{joint_scales, workspace_extent};
use faultspace::workspace::hybrid::{
    Atlas, AtlasRecipe, AtlasSettings, Region, Rule, SamplePlan, Sampling,
};
use faultspace::workspace::{ArtificialLimits, FailureSet, JointLimit};
use nalgebra::{Isometry3, Matrix3, Vector3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};
use std::sync::atomic::AtomicBool;

/// Distance of locks from each other, radians (metres for a stroke).
const LOCK_STEP: f64 = 0.02;
/// Rotation angles tried for every sample.
const TURNS: usize = 36;
/// θ₁ values closer than this belong to one arc of solutions.
const JOINED: f64 = 0.08;

type Interval = [f64; 2];

/// A positioner in the test's own words.
struct Arm {
    name: &'static str,
    /// Twist, length, offset.
    rows: Vec<[f64; 3]>,
    /// Number of the prismatic joint.
    slide: Option<usize>,
    /// Physical limits, `None` for a free joint.
    physical: Vec<Option<Interval>>,
}

impl Arm {
    fn joints(&self) -> usize {
        self.rows.len()
    }

    /// The robot for the estimator. A free joint has limits a full turn apart.
    fn robot(&self) -> Robot {
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
    fn position(&self, theta: &[f64]) -> (Vector3<f64>, Vec<Vector3<f64>>) {
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
    fn solve(
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
    fn solve_inside(
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
    fn inside(&self, k: usize, value: f64, limits: Option<Interval>) -> bool {
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
    fn allowed(&self, theta: &[f64]) -> bool {
        (1..self.joints()).all(|k| self.inside(k, theta[k], self.physical[k]))
    }

    fn distance(&self, k: usize, a: f64, b: f64) -> f64 {
        match self.slide == Some(k) {
            true => (a - b).abs(),
            false => ((a - b + PI).rem_euclid(TAU) - PI).abs(),
        }
    }

    /// Many configurations that reach `goal`, from random starts.
    fn cloud(&self, goal: &Vector3<f64>, starts: usize, rng: &mut ChaCha8Rng) -> Vec<Vec<f64>> {
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
    fn at_lock(
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

/// Values of a lock: a grid of [low, high] with both ends.
fn grid([low, high]: Interval) -> Vec<f64> {
    let steps = ((high - low) / LOCK_STEP).ceil().max(1.0) as usize;
    let value = |k: usize| low + (high - low) * k as f64 / steps as f64;
    (0..=steps).map(value).collect()
}

/// One sample: everything that does not depend on the rotation.
struct Solved<'a> {
    arm: &'a Arm,
    goal: Vector3<f64>,
    cloud: Vec<Vec<f64>>,
    /// For joints from 2 on, the solutions at every lock.
    locks: Vec<Vec<Vec<Vec<f64>>>>,
}

impl Solved<'_> {
    fn new<'a>(
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
    fn image(&self, box_: &[Interval]) -> Vec<Interval> {
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
    fn measure(&self, box_: &[Interval], failures: &FailureSet, rng: &mut ChaCha8Rng) -> f64 {
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
    fn survives(&self, k: usize, beta: f64) -> bool {
        let arm = self.arm;
        let fits = |theta: &Vec<f64>| arm.inside(0, theta[0] + beta, arm.physical[0]);
        self.locks[k - 1].iter().all(|found| found.iter().any(fits))
    }

    fn survives_first(&self, limits: Interval, beta: f64) -> bool {
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

/// The estimator's side of the comparison.
struct Estimator {
    atlas: Atlas,
}

impl Estimator {
    fn new(arm: &Arm, samples: u32, focus: Option<&[Interval]>) -> Estimator {
        let robot = arm.robot();
        let extent = workspace_extent(&robot).unwrap();
        let is_planar = arm.rows.iter().all(|row| row[0] == 0.0 && row[2] == 0.0);
        let plan = SamplePlan {
            task: match is_planar {
                true => TaskSpace::PlanarPosition,
                false => TaskSpace::SpatialPosition,
            },
            region: Region {
                radius: extent.radius,
                lower: if is_planar { 0.0 } else { extent.lower },
                upper: if is_planar { 0.0 } else { extent.upper },
                reach: extent.reach,
            },
            sampling: Sampling::Lattice {
                samples,
                replicates: 4,
            },
            seed: 3,
        };
        let mut recipe = AtlasRecipe::new(&robot, plan, AtlasSettings::default()).unwrap();
        if let Some(limits) = focus {
            recipe = recipe.focused(&inner(&robot, limits));
        }
        let atlas = recipe.build(None, &AtomicBool::new(false), &|_, _| ());
        Estimator {
            atlas: atlas.unwrap(),
        }
    }

    fn size(&self, robot: &Robot, box_: &[Interval], failures: &FailureSet) -> f64 {
        let sizes = self
            .atlas
            .sizes(&inner(robot, box_), failures, Rule::Definition);
        sizes.fault_tolerant.value
    }
}

/// Limits in the estimator's internal variables.
fn inner(robot: &Robot, box_: &[Interval]) -> ArtificialLimits {
    let scales = joint_scales(robot).unwrap();
    let limit = |(limit, scale): (&Interval, &faultspace::kinematics::JointScale)| {
        JointLimit::new(scale.inner(limit[0]), scale.inner(limit[1]))
    };
    ArtificialLimits::new(box_.iter().zip(&scales).map(limit).collect())
}

/// Random limits within the physical ones; some of width zero.
fn random_box(arm: &Arm, rng: &mut ChaCha8Rng) -> Vec<Interval> {
    let limit = |(k, physical): (usize, &Option<Interval>)| {
        let mut draw = |low: f64, high: f64| low + (high - low) * rng.random::<f64>();
        let [low, high] = physical.unwrap_or([-PI, PI]);
        let share = if draw(0.0, 1.0) < 0.15 && k > 0 {
            0.0
        } else {
            draw(0.03, 0.4)
        };
        let width = (high - low) * share;
        let start = draw(low, high - width);
        [start, start + width]
    };
    arm.physical.iter().enumerate().map(limit).collect()
}

/// Compares both on `boxes` random boxes that hold a fault-tolerant workspace.
fn compare(arm: &Arm, failures: &[usize], samples: u32, boxes: usize) {
    let robot = arm.robot();
    let failures = match failures {
        [] => FailureSet::any(arm.joints()),
        some => FailureSet::of(arm.joints(), some),
    };
    let estimator = Estimator::new(arm, samples, None);
    let free = estimator.atlas.sizes(
        &inner(
            &robot,
            &arm.physical
                .iter()
                .map(|l| l.unwrap_or([-PI, PI]))
                .collect::<Vec<_>>(),
        ),
        &failures,
        Rule::Definition,
    );
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    for _ in 0..boxes {
        // The best of many: most random boxes hold nothing.
        let tries = (0..1500).map(|_| random_box(arm, &mut rng));
        let sized = tries.map(|box_| (estimator.size(&robot, &box_, &failures), box_));
        let best = sized.reduce(|a, b| if b.0 > a.0 { b } else { a });
        let (found, box_) = best.expect("boxes");
        assert!(found > 0.003 * free.unrestricted.value, "{}", arm.name);
        let (wanted, scatter) = brute(arm, &box_, &failures, estimator.atlas.plan());
        let focused = Estimator::new(arm, samples, Some(&box_)).size(&robot, &box_, &failures);
        println!(
            "{:24} {:?} S_F {found:8.4} ({:+.2} %) focused {focused:8.4} ({:+.2} %) brute {wanted:8.4} (allowed {:.2} %)",
            arm.name,
            failures.numbers().collect::<Vec<_>>(),
            100.0 * (found / wanted - 1.0),
            100.0 * (focused / wanted - 1.0),
            100.0 * (0.01 + scatter / wanted)
        );
        for found in [found, focused] {
            let allowed = 0.01 * wanted + scatter;
            assert!((found - wanted).abs() < allowed, "{} {box_:?}", arm.name);
        }
    }
}

/// Two degrees of redundancy: membership by searches inside boxes.
struct Surface<'a> {
    arm: &'a Arm,
    goal: Vector3<f64>,
    cloud: Vec<Vec<f64>>,
}

impl Surface<'_> {
    /// Whether some configuration with joint `k` at `q` and joints from 2 on in `box_` reaches the
    /// goal.
    fn exists(&self, k: usize, q: f64, box_: &[Option<Interval>]) -> bool {
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
    fn first(&self, box_: &[Option<Interval>]) -> Vec<Interval> {
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
    fn measure(&self, box_: &[Interval], failures: &FailureSet) -> f64 {
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

/// Compares both for an arm with two degrees of redundancy.
fn compare_surfaces(arm: &Arm, failures: &[usize], samples: u32, boxes: usize) {
    let robot = arm.robot();
    let failures = match failures {
        [] => FailureSet::any(arm.joints()),
        some => FailureSet::of(arm.joints(), some),
    };
    let estimator = Estimator::new(arm, samples, None);
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    for _ in 0..boxes {
        let tries = (0..300).map(|_| random_box(arm, &mut rng));
        let sized = tries.map(|box_| (estimator.size(&robot, &box_, &failures), box_));
        let best = sized.reduce(|a, b| if b.0 > a.0 { b } else { a });
        let (found, box_) = best.expect("boxes");
        let focused = Estimator::new(arm, samples, Some(&box_)).size(&robot, &box_, &failures);
        let plan = estimator.atlas.plan();
        let (mut wanted, mut largest) = (0.0, 0.0f64);
        for index in 0..plan.len() {
            let sample = plan.sample(index);
            let mut rng = ChaCha8Rng::seed_from_u64(2000 + index);
            let goal = sample.tool.translation.vector;
            let cloud = arm.cloud(&goal, 600, &mut rng);
            largest = largest.max(sample.weight);
            if !cloud.is_empty() {
                wanted += sample.weight * Surface { arm, goal, cloud }.measure(&box_, &failures);
            }
        }
        println!(
            "{:24} {:?} S_F {found:8.4} ({:+.2} %) focused {focused:8.4} ({:+.2} %) brute {wanted:8.4}, one sample {:.2} %",
            arm.name,
            failures.numbers().collect::<Vec<_>>(),
            100.0 * (found / wanted - 1.0),
            100.0 * (focused / wanted - 1.0),
            100.0 * TAU * largest / wanted,
        );
        let allowed = 0.01 * wanted + 0.5 * largest * TAU;
        assert!((focused - wanted).abs() < allowed, "{} {box_:?}", arm.name);
        assert!(wanted > 0.0, "{} {box_:?}", arm.name);
    }
}

/// Σ w |B| by brute force, and the error that the β drawn may leave.
fn brute(arm: &Arm, box_: &[Interval], failures: &FailureSet, plan: &SamplePlan) -> (f64, f64) {
    let (mut sum, mut largest) = (0.0, 0.0f64);
    for index in 0..plan.len() {
        let sample = plan.sample(index);
        let mut rng = ChaCha8Rng::seed_from_u64(1000 + index);
        let goal = sample.tool.translation.vector;
        let cloud = arm.cloud(&goal, 160, &mut rng);
        if cloud.is_empty() {
            continue;
        }
        let measure = Solved::new(arm, goal, box_, &cloud).measure(box_, failures, &mut rng);
        sum += sample.weight * measure;
        largest = largest.max(sample.weight);
    }
    // Both boundaries of B at random between two β: a variance of (2π/TURNS)²/6 a sample; and one
    // sample that decides by a hair.
    let steps = (plan.len() as f64 / 6.0).sqrt() * largest * TAU / TURNS as f64;
    (sum, 3.0 * steps + 0.2 * largest * TAU)
}

fn planar_3r(physical: [Option<Interval>; 3]) -> Arm {
    Arm {
        name: "planar 3R",
        rows: vec![[0.0, 1.0, 0.0]; 3],
        slide: None,
        physical: physical.to_vec(),
    }
}

fn spatial_4r(physical: [Option<Interval>; 4]) -> Arm {
    let quarter = 0.5 * PI;
    Arm {
        name: "spatial 4R",
        rows: vec![
            [quarter, 1.4142, 0.0],
            [-quarter, 1.4142, 1.0],
            [quarter, 1.4142, -1.0],
            [0.0, 1.2247, 0.5],
        ],
        slide: None,
        physical: physical.to_vec(),
    }
}

fn planar_4r(physical: [Option<Interval>; 4]) -> Arm {
    Arm {
        name: "planar 4R",
        rows: vec![[0.0, 1.0, 0.0]; 4],
        slide: None,
        physical: physical.to_vec(),
    }
}

/// designs/spatial_5r.toml.
fn spatial_5r(physical: [Option<Interval>; 5]) -> Arm {
    let quarter = 0.5 * PI;
    Arm {
        name: "spatial 5R",
        rows: vec![
            [quarter, 1.4142, 0.0],
            [-quarter, 1.4142, 1.0],
            [quarter, 1.4142, -1.0],
            [-quarter, 1.4142, 1.0],
            [0.0, 1.2247, -0.5],
        ],
        slide: None,
        physical: physical.to_vec(),
    }
}

fn rprr() -> Arm {
    let quarter = 0.5 * PI;
    Arm {
        name: "R-P-R-R",
        rows: vec![
            [quarter, 0.3, 0.2],
            [quarter, 0.5, 0.3],
            [-quarter, 1.0, 0.2],
            [0.0, 0.8, 0.1],
        ],
        slide: Some(1),
        physical: vec![None, Some([-0.8, 0.9]), None, None],
    }
}

#[test]
#[ignore = "minutes"]
fn surfaces_at_length() {
    let turn = |low: f64, high: f64| Some([low.to_radians(), high.to_radians()]);
    let (wide, half) = (turn(-170.0, 170.0), turn(-80.0, 140.0));
    for failures in [&[][..], &[2], &[3], &[1, 4]] {
        compare_surfaces(&planar_4r([None; 4]), failures, 100, 2);
        compare_surfaces(
            &planar_4r([None, wide, half, turn(-150.0, 120.0)]),
            failures,
            100,
            2,
        );
        compare_surfaces(
            &planar_4r([None, None, turn(20.0, 60.0), None]),
            failures,
            100,
            2,
        );
    }
    for failures in [&[][..], &[3]] {
        compare_surfaces(&spatial_5r([None; 5]), failures, 100, 2);
        compare_surfaces(
            &spatial_5r([None, wide, None, half, wide]),
            failures,
            100,
            2,
        );
    }
}

#[test]
fn planar_arms_with_physical_limits() {
    let turn = |low: f64, high: f64| Some([low.to_radians(), high.to_radians()]);
    let (wide, half) = (turn(-170.0, 170.0), turn(-80.0, 140.0));
    compare(&planar_3r([None, None, None]), &[], 60, 2);
    compare(&planar_3r([wide, None, None]), &[], 60, 2);
    compare(&planar_3r([half, wide, turn(-150.0, 120.0)]), &[2], 60, 2);
}

#[test]
#[ignore = "minutes"]
fn planar_arms_at_length() {
    let turn = |low: f64, high: f64| Some([low.to_radians(), high.to_radians()]);
    let (wide, half) = (turn(-170.0, 170.0), turn(-80.0, 140.0));
    for failures in [&[][..], &[1], &[2], &[3], &[1, 3], &[2, 3]] {
        compare(&planar_3r([None, None, None]), failures, 300, 3);
        compare(&planar_3r([wide, None, None]), failures, 300, 3);
        compare(&planar_3r([half, None, None]), failures, 300, 3);
        compare(
            &planar_3r([None, wide, turn(-150.0, 120.0)]),
            failures,
            300,
            3,
        );
        compare(
            &planar_3r([half, wide, turn(-150.0, 120.0)]),
            failures,
            300,
            3,
        );
    }
}

#[test]
#[ignore = "minutes"]
fn spatial_arms_at_length() {
    let turn = |low: f64, high: f64| Some([low.to_radians(), high.to_radians()]);
    let (wide, half) = (turn(-170.0, 170.0), turn(-100.0, 140.0));
    for failures in [&[][..], &[2], &[1, 3], &[4]] {
        compare(&spatial_4r([None; 4]), failures, 200, 2);
        compare(&spatial_4r([half, None, None, None]), failures, 200, 2);
        compare(&spatial_4r([None, wide, half, wide]), failures, 200, 2);
        compare(&spatial_4r([half, wide, wide, half]), failures, 200, 2);
    }
    for failures in [&[2][..], &[3], &[1, 4]] {
        compare(&rprr(), failures, 200, 2);
    }
}
