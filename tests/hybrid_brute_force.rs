//! The hybrid estimator against a brute force that shares nothing with it: forward kinematics from
//! Denavit–Hartenberg rows, damped Newton steps from many starts, and the definition of W_F,
//! lock by lock on a fine grid of the artificial limits.

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
        let starts = before.iter().chain(near.iter().take(16).map(|pair| pair.1));
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
    let mut done = 0;
    for _ in 0..3000 {
        let box_ = random_box(arm, &mut rng);
        let found = estimator.size(&robot, &box_, &failures);
        if found < 0.04 * free.unrestricted.value {
            continue;
        }
        let (wanted, scatter) = brute(arm, &box_, &failures, estimator.atlas.plan());
        let focused = Estimator::new(arm, samples, Some(&box_)).size(&robot, &box_, &failures);
        println!(
            "{:24} {:?} S_F {found:8.4} focused {focused:8.4} brute {wanted:8.4} ({:+.2} %, one sample {:.2} %)",
            arm.name,
            failures.numbers().collect::<Vec<_>>(),
            100.0 * (found / wanted - 1.0),
            100.0 * scatter / wanted
        );
        for found in [found, focused] {
            let allowed = 0.01 * wanted + 3.0 * scatter;
            assert!((found - wanted).abs() < allowed, "{} {box_:?}", arm.name);
        }
        done += 1;
        if done == boxes {
            return;
        }
    }
    panic!("{}: too few boxes with a workspace", arm.name);
}

/// Σ w |B| by brute force, and what the β drawn let expect of its error.
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
    // One boundary of B each at random between two β: a variance of (2π/TURNS)²/6 a sample with a
    // part of the circle; one lost sample more for what decides by a hair.
    let steps = (plan.len() as f64 / 6.0).sqrt() * largest * TAU / TURNS as f64;
    (sum, steps.max(0.5 * largest * TAU))
}

fn planar_3r(physical: [Option<Interval>; 3]) -> Arm {
    Arm {
        name: "planar 3R",
        rows: vec![[0.0, 1.0, 0.0]; 3],
        slide: None,
        physical: physical.to_vec(),
    }
}

#[expect(
    clippy::approx_constant,
    reason = "the published link lengths have four decimals"
)]
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
