//! The hybrid estimator against a brute force, on the same samples.

mod brute_force;

use brute_force::Interval;
use brute_force::arm::Arm;
use brute_force::curves::{Solved, TURNS};
use brute_force::surfaces::Surface;
use faultspace::design::{Robot, TaskSpace};
use faultspace::kinematics::{joint_scales, workspace_extent};
use faultspace::workspace::hybrid::{
    Atlas, AtlasRecipe, AtlasSettings, Region, Rule, SamplePlan, Sampling,
};
use faultspace::workspace::{ArtificialLimits, FailureSet, JointLimit};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};
use std::sync::atomic::AtomicBool;

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
        let allowed = 0.005 * wanted + 0.1 * largest * TAU;
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
            [quarter, 1.414, 0.0],
            [-quarter, 1.414, 1.0],
            [quarter, 1.414, -1.0],
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
            [quarter, 1.414, 0.0],
            [-quarter, 1.414, 1.0],
            [quarter, 1.414, -1.0],
            [-quarter, 1.414, 1.0],
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
#[ignore = "about 10 minutes"]
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
}

#[test]
#[ignore = "about 10 minutes"]
fn surfaces_in_space_at_length() {
    let turn = |low: f64, high: f64| Some([low.to_radians(), high.to_radians()]);
    let (wide, half) = (turn(-170.0, 170.0), turn(-80.0, 140.0));
    for failures in [&[][..], &[3]] {
        compare_surfaces(&spatial_5r([None; 5]), failures, 40, 1);
        compare_surfaces(&spatial_5r([None, wide, None, half, wide]), failures, 40, 1);
    }
}

#[test]
fn planar_arms_with_physical_limits() {
    let turn = |low: f64, high: f64| Some([low.to_radians(), high.to_radians()]);
    let (wide, half) = (turn(-170.0, 170.0), turn(-80.0, 140.0));
    compare(&planar_3r([wide, None, None]), &[], 60, 1);
    compare(&planar_3r([half, wide, turn(-150.0, 120.0)]), &[2], 60, 1);
    compare_surfaces(
        &planar_4r([None, None, turn(20.0, 60.0), None]),
        &[3],
        12,
        1,
    );
}

#[test]
#[ignore = "about 5 minutes"]
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

fn spatial_arms(failures: &[usize]) {
    let turn = |low: f64, high: f64| Some([low.to_radians(), high.to_radians()]);
    let (wide, half) = (turn(-170.0, 170.0), turn(-100.0, 140.0));
    compare(&spatial_4r([None; 4]), failures, 200, 2);
    compare(&spatial_4r([half, None, None, None]), failures, 200, 2);
    compare(&spatial_4r([None, wide, half, wide]), failures, 200, 2);
    compare(&spatial_4r([half, wide, wide, half]), failures, 200, 2);
}

#[test]
#[ignore = "about 5 minutes"]
fn spatial_arms_with_any_failure_at_length() {
    spatial_arms(&[]);
}

#[test]
#[ignore = "about 5 minutes"]
fn spatial_arms_with_some_failures_at_length() {
    spatial_arms(&[4]);
    spatial_arms(&[1, 3]);
    spatial_arms(&[2]);
}

#[test]
#[ignore = "about 2 minutes"]
fn strokes_at_length() {
    for failures in [&[2][..], &[3], &[1, 4]] {
        compare(&rprr(), failures, 200, 2);
    }
}
