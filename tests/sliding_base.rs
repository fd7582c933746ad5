//! Robots whose joint 1 slides: against closed forms, a brute force, and the same estimate with the
//! symmetry that they lack.

#[allow(dead_code, reason = "other tests use more of it")]
mod brute_force;

use brute_force::Interval;
use brute_force::arm::Arm;
use brute_force::grid;
use faultspace::design::TaskSpace;
use faultspace::kinematics::{JointScale, joint_scales, workspace_extent};
use faultspace::manifold::ManifoldError;
use faultspace::workspace::hybrid::{
    Atlas, AtlasRecipe, AtlasSettings, Region, Rule, SamplePlan, Sampling,
};
use faultspace::workspace::planar::{PlanarArm, PlanarPosition};
use faultspace::workspace::{ArtificialLimits, FailureSet, JointLimit, WorkspaceSizes};
use nalgebra::Vector3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::atomic::AtomicBool;

fn recipe(arm: &Arm, task: TaskSpace, sampling: Sampling) -> Result<AtlasRecipe, ManifoldError> {
    let robot = arm.robot();
    let extent = workspace_extent(&robot).unwrap();
    let height = |z: f64| if task.is_planar() { 0.0 } else { z };
    let plan = SamplePlan {
        task,
        region: Region {
            radius: extent.radius,
            lower: height(extent.lower),
            upper: height(extent.upper),
            reach: extent.reach,
        },
        sampling,
        seed: 6,
    };
    AtlasRecipe::new(&robot, plan, AtlasSettings::default())
}

fn atlas(arm: &Arm, task: TaskSpace, sampling: Sampling) -> Atlas {
    let recipe = recipe(arm, task, sampling).unwrap();
    let atlas = recipe.build(None, &AtomicBool::new(false), &|_, _| ());
    atlas.unwrap()
}

fn everywhere(samples: u32) -> Sampling {
    Sampling::Everywhere {
        samples,
        replicates: 16,
    }
}

/// Limits in the estimator's internal variables.
fn inner(arm: &Arm, box_: &[Interval]) -> ArtificialLimits {
    let scales = joint_scales(&arm.robot()).unwrap();
    let limit = |(limit, scale): (&Interval, &JointScale)| {
        JointLimit::new(scale.inner(limit[0]), scale.inner(limit[1]))
    };
    ArtificialLimits::new(box_.iter().zip(&scales).map(limit).collect())
}

fn sizes(atlas: &Atlas, arm: &Arm, box_: &[Interval], failures: &FailureSet) -> WorkspaceSizes {
    atlas.sizes(&inner(arm, box_), failures, Rule::Definition)
}

const STROKE: Interval = [-0.4, 1.1];

/// A vertical axis that carries a planar 3R: the workspace is the plane's times an interval.
fn lift() -> Arm {
    Arm {
        name: "lift with a planar 3R",
        rows: vec![
            [0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ],
        slide: Some(0),
        physical: vec![Some(STROKE), None, None, None],
    }
}

/// A rail with a bent arm on it.
fn rail() -> Arm {
    Arm {
        name: "rail with a 3R",
        rows: vec![
            [FRAC_PI_2, 0.3, 0.2],
            [FRAC_PI_2, 0.5, 0.3],
            [-FRAC_PI_2, 1.0, 0.2],
            [0.0, 0.8, 0.1],
        ],
        slide: Some(0),
        physical: vec![Some([-0.8, 0.9]), None, Some([-2.6, 2.4]), None],
    }
}

/// S_F of the lift is that of the planar 3R times the width of joint 1's limits.
#[test]
fn a_lift_multiplies_the_exact_workspace_of_the_plane() {
    let arm = lift();
    let atlas = atlas(&arm, TaskSpace::SpatialPosition, everywhere(16_000));
    let degrees = [[-18.0, 18.0], [-111.0, 111.0], [-111.0, 111.0]];
    let planar_limits = ArtificialLimits::from_degrees(&degrees);
    for (failures, planar_failures) in [(&[2, 3, 4][..], &[1, 2, 3][..]), (&[3], &[2])] {
        let exact = PlanarPosition::new().sizes(PlanarArm {
            lengths: &[1.0; 3],
            limits: &planar_limits,
            failures: &FailureSet::of(3, planar_failures),
        });
        for first in [STROKE, [0.1, 0.6], [0.7, 1.1]] {
            let turning = degrees.map(|pair| pair.map(f64::to_radians));
            let box_ = [&[first][..], &turning].concat();
            let found = sizes(&atlas, &arm, &box_, &FailureSet::of(4, failures));
            let width = first[1] - first[0];
            let tall = STROKE[1] - STROKE[0];
            for (found, wanted) in [
                (found.fault_tolerant, exact.fault_tolerant.value * width),
                (found.pre_failure, exact.pre_failure.value * width),
                (found.unrestricted, exact.unrestricted.value * tall),
                (found.post_failure[2], exact.post_failure[1].value * tall),
            ] {
                let off = (found.value - wanted).abs();
                println!("{} ± {}, {wanted}", found.value, found.error);
                assert!(
                    off < 4.0 * found.error + 2e-3 * wanted,
                    "{found:?} {wanted}"
                );
                assert!(found.error < 0.06 * wanted, "{found:?} {wanted}");
            }
        }
    }
    // No self-motion moves joint 1: whatever lies anywhere else than it locks is lost.
    let turning = degrees.map(|pair| pair.map(f64::to_radians));
    let box_ = [&[[0.1, 0.6]][..], &turning].concat();
    let found = sizes(&atlas, &arm, &box_, &FailureSet::any(4));
    assert_eq!(found.fault_tolerant.value, 0.0);
    assert_eq!(found.post_failure[0].value, 0.0);
}

/// Whether `goal` belongs to W₀, to W_1 … W_n: all joints alike, at rest.
fn member(arm: &Arm, goal: Vector3<f64>, box_: &[Interval], rng: &mut ChaCha8Rng) -> Vec<bool> {
    let cloud = arm.cloud(&goal, 240, rng);
    let mut found = vec![false; 1 + arm.joints()];
    if cloud.is_empty() {
        return found;
    }
    let in_stroke = |theta: &&Vec<f64>| arm.inside(0, theta[0], arm.physical[0]);
    for k in 0..arm.joints() {
        let (mut before, mut all) = (Vec::new(), true);
        for q in grid(box_[k]) {
            before = arm.at_lock(k, q, &goal, &cloud, &before);
            all &= before.iter().any(|theta| in_stroke(&theta));
            let inside = |theta: &Vec<f64>| {
                (0..arm.joints()).all(|j| arm.inside(j, theta[j], Some(box_[j])))
            };
            found[0] |= before.iter().any(inside);
        }
        found[k + 1] = all;
    }
    found
}

fn compare(arm: &Arm, samples: u32, boxes: usize) {
    let atlas = atlas(arm, TaskSpace::SpatialPosition, everywhere(samples));
    let plan = atlas.plan();
    let mut rng = ChaCha8Rng::seed_from_u64(31);
    let mut tolerant = 0;
    let random_box = |rng: &mut ChaCha8Rng| -> Vec<Interval> {
        let limits = arm.physical.iter();
        limits
            .map(|physical| {
                let [low, high] = physical.unwrap_or([-PI, PI]);
                let width = (high - low) * rng.random_range(0.05..0.4);
                let start = rng.random_range(low..high - width);
                [start, start + width]
            })
            .collect()
    };
    for number in 0..boxes {
        let failures = match number % 2 {
            0 => FailureSet::any(arm.joints()),
            _ => FailureSet::of(arm.joints(), &[1, 3]),
        };
        // The best of many: most random boxes hold nothing.
        let tries = (0..1500).map(|_| random_box(&mut rng));
        let sized = tries.map(|box_| {
            let size = atlas.fault_tolerant_size(&inner(arm, &box_), &failures);
            (size, box_)
        });
        let (_, box_) = sized.reduce(|a, b| if b.0 > a.0 { b } else { a }).unwrap();
        let found = sizes(&atlas, arm, &box_, &failures);
        let mut counts = vec![0; 2 + arm.joints()];
        for index in 0..plan.len() {
            let goal = plan.sample(index).tool.translation.vector;
            let mut rng = ChaCha8Rng::seed_from_u64(500 + index);
            let member = member(arm, goal, &box_, &mut rng);
            let survived = (1..=arm.joints()).all(|k| member[k] || !failures.contains(k));
            counts[0] += i32::from(member[0] && survived);
            for (count, is) in counts[1..].iter_mut().zip(member) {
                *count += i32::from(is);
            }
        }
        let each = plan.sample(0).weight * TAU;
        let post = found.post_failure.iter();
        let found: Vec<f64> = [found.fault_tolerant, found.pre_failure]
            .iter()
            .chain(post)
            .map(|size| size.value / each)
            .collect();
        println!("{}: {found:?} {counts:?}", arm.name);
        for (found, count) in found.iter().zip(&counts) {
            // Samples that decide by a hair.
            assert!(
                (found - f64::from(*count)).abs() < 2.5,
                "{found} {count} {box_:?}"
            );
        }
        tolerant += counts[0];
    }
    assert!(tolerant > 2, "{tolerant}");
}

#[test]
fn a_rail_agrees_with_a_brute_force() {
    compare(&rail(), 320, 1);
}

#[test]
#[ignore = "about 5 minutes"]
fn a_rail_agrees_with_a_brute_force_at_length() {
    compare(&rail(), 2000, 8);
}

/// A robot whose joint 1 turns has the same sizes with and without its symmetry.
#[test]
fn samples_everywhere_change_no_size_of_a_robot_that_turns() {
    let turning = |physical: Vec<Option<Interval>>| Arm {
        name: "planar 3R",
        rows: vec![[0.0, 1.0, 0.0]; 3],
        slide: None,
        physical,
    };
    let radians = |pairs: [[f64; 2]; 3]| pairs.map(|pair| pair.map(f64::to_radians));
    let box_ = radians([[-18.0, 18.0], [-111.0, 111.0], [-111.0, 111.0]]);
    for physical in [
        vec![None; 3],
        vec![Some([-1.9, 2.6]), None, Some([-2.4, 2.2])],
    ] {
        let arm = turning(physical);
        let task = TaskSpace::PlanarPosition;
        let turned = atlas(
            &arm,
            task,
            Sampling::Lattice {
                samples: 4000,
                replicates: 16,
            },
        );
        let all = atlas(&arm, task, everywhere(16_000));
        for failures in [FailureSet::any(3), FailureSet::of(3, &[2])] {
            let [a, b] = [&turned, &all].map(|atlas| sizes(atlas, &arm, &box_, &failures));
            let pairs = [
                (a.fault_tolerant, b.fault_tolerant),
                (a.pre_failure, b.pre_failure),
                (a.unrestricted, b.unrestricted),
            ];
            let post = a
                .post_failure
                .iter()
                .copied()
                .zip(b.post_failure.iter().copied());
            for (a, b) in pairs.into_iter().chain(post) {
                let error = a.error.hypot(b.error);
                assert!(
                    (a.value - b.value).abs() < 4.0 * error + 2e-3 * a.value,
                    "{a:?} {b:?}"
                );
            }
            assert!(a.fault_tolerant.value > 0.1);
        }
    }
}

/// Without turns a half-plane says nothing, and surfaces are not served.
#[test]
fn samplings_that_would_be_wrong_are_refused() {
    let half_plane = Sampling::Lattice {
        samples: 100,
        replicates: 4,
    };
    let position = TaskSpace::SpatialPosition;
    assert_eq!(
        recipe(&rail(), position, half_plane).unwrap_err(),
        ManifoldError::NoSymmetry
    );
    let mut longer = rail();
    longer.rows.push([0.3, 0.4, 0.1]);
    longer.physical.push(None);
    let refused = recipe(&longer, position, everywhere(100)).unwrap_err();
    assert!(matches!(refused, ManifoldError::Redundancy { .. }));
}
