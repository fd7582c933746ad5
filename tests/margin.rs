//! A margin beyond artificial limits: W_F = W₀(A) ∩ ⋂ W_i(A_i enlarged), from the definitions and
//! by every estimator.

use faultspace::design::{Geometry, PhysicalLimits, Robot, TaskSpace};
use faultspace::sampling::stream;
use faultspace::workspace::hybrid::{
    Atlas, AtlasRecipe, AtlasSettings, Region, Rule, SamplePlan, Sampling,
};
use faultspace::workspace::planar::{PlanarArm, PlanarPose, PlanarPosition, PoseResolution};
use faultspace::workspace::{ArtificialLimits, FailureSet, JointLimit};
use nalgebra::{Complex, Isometry3};
use rand::Rng;
use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

const LENGTHS: [f64; 3] = [1.0, 0.8, 1.2];

fn limits_3r() -> ArtificialLimits {
    ArtificialLimits::from_degrees(&[[-14.0, 14.0], [-105.0, 105.0], [-100.0, 95.0]])
}

fn limits_4r() -> ArtificialLimits {
    ArtificialLimits::from_degrees(&[
        [-20.0, 20.0],
        [-100.0, 100.0],
        [-100.0, 80.0],
        [-30.0, 30.0],
    ])
}

fn any(joints: usize, margin_deg: f64) -> FailureSet {
    FailureSet::any(joints).with_margin(margin_deg.to_radians())
}

fn arm<'a>(
    lengths: &'a [f64],
    limits: &'a ArtificialLimits,
    failures: &'a FailureSet,
) -> PlanarArm<'a> {
    PlanarArm {
        lengths,
        limits,
        failures,
    }
}

fn size_3r(limits: &ArtificialLimits, failures: &FailureSet) -> f64 {
    PlanarPosition::new().fault_tolerant_size(arm(&LENGTHS, limits, failures))
}

fn size_4r(limits: &ArtificialLimits, failures: &FailureSet) -> f64 {
    let mut pose = PlanarPose::new(PoseResolution::for_tolerance(2e-4));
    pose.fault_tolerant_size(arm(&[1.0; 4], limits, failures))
        .value
}

/// Whether the 3R arm reaches `point` with joint `joint` (from 1) locked at `angle`.
fn reaches_locked(point: Complex<f64>, joint: usize, angle: f64) -> bool {
    let [a, b, c] = LENGTHS;
    let turned = |length: f64| Complex::from_polar(length, angle);
    let (distance, two) = match joint {
        1 => ((point - turned(a)).norm(), [b, c]),
        2 => (point.norm(), [(a + turned(b)).norm(), c]),
        _ => (point.norm(), [a, (b + turned(c)).norm()]),
    };
    (two[0] - two[1]).abs() <= distance && distance <= two[0] + two[1]
}

/// W_F point by point: W₀ of the limits, and every lock inside the enlarged ones.
#[test]
fn joints_lock_inside_enlarged_limits() {
    let limits = limits_3r();
    let mut generator = stream(1, 0);
    let mut inside = 0;
    for margin in [0.0f64, 1.0, 4.0] {
        let failures = any(3, margin);
        for _ in 0..1500 {
            let (r, beta): (f64, f64) = (
                generator.random_range(0.0..3.0),
                generator.random_range(-PI..PI),
            );
            let view = arm(&LENGTHS, &limits, &failures);
            let found = PlanarPosition::new().rotation_set(view, r).contains(beta);
            let reached = PlanarPosition::new().pre_failure_sets(view, &[r])[0].contains(beta);
            let point = Complex::from_polar(r, beta);
            let locks = (1..).zip(limits.joints()).all(|(joint, limit)| {
                let from = limit.lower - margin.to_radians();
                let width = limit.width() + 2.0 * margin.to_radians();
                let straight = [0.0].into_iter().filter(|_| joint > 1);
                let even = (0..=800).map(|k| from + width * f64::from(k) / 800.0);
                even.chain(straight)
                    .all(|angle| reaches_locked(point, joint, angle))
            });
            assert_eq!(found, reached && locks, "margin {margin}, r {r}, β {beta}");
            inside += usize::from(found);
        }
    }
    assert!(inside > 300, "{inside}");
}

/// W_i alone is W_F with all other joints free and only joint i prone to failure.
#[test]
fn the_workspace_is_an_intersection() {
    let limits = limits_3r();
    let margin = 3f64.to_radians();
    let failures = FailureSet::any(3).with_margin(margin);
    let radii: Vec<f64> = (0..120).map(|k| 0.025 * f64::from(k)).collect();
    let view = arm(&LENGTHS, &limits, &failures);
    let mut wanted = PlanarPosition::new().pre_failure_sets(view, &radii);
    for joint in 1..=3 {
        let mut alone = vec![JointLimit::FREE; 3];
        let limit = limits.joints()[joint - 1];
        alone[joint - 1] = JointLimit::new(limit.lower - margin, limit.upper + margin);
        let (alone, only) = (ArtificialLimits::new(alone), FailureSet::of(3, &[joint]));
        let sets = PlanarPosition::new().rotation_sets(arm(&LENGTHS, &alone, &only), &radii);
        for (set, other) in wanted.iter_mut().zip(&sets) {
            *set = set.intersection(other);
        }
    }
    let found = PlanarPosition::new().rotation_sets(view, &radii);
    let total: f64 = found.iter().map(|set| set.measure()).sum();
    assert!(total > 5.0);
    for ((found, wanted), r) in found.iter().zip(&wanted).zip(&radii) {
        let (a, b) = (found.measure(), wanted.measure());
        assert!((a - b).abs() < 1e-9, "r {r}: {a} for {b}");
    }
    // The closed form of the area sees the same set.
    let sizes = PlanarPosition::new().sizes(view);
    let exact = sizes.fault_tolerant;
    assert!(exact.error < 1e-9 && exact.value == size_3r(&limits, &failures));
    let mut position = PlanarPosition::new();
    let rings = position.ring_map(view, 4000).rings;
    let sum = |ring: &faultspace::workspace::Ring| {
        0.5 * (ring.outer * ring.outer - ring.inner * ring.inner) * ring.rotation_set.measure()
    };
    let rings: f64 = rings.iter().map(sum).sum();
    assert!(
        (rings - exact.value).abs() < 1e-4 * exact.value,
        "{rings} {exact:?}"
    );
}

#[test]
fn sizes_fall_with_the_margin() {
    let (three, four) = (limits_3r(), limits_4r());
    let mut last = [f64::INFINITY; 2];
    for margin in [0.0, 0.5, 1.0, 2.0, 5.0, 20.0, 90.0] {
        let sizes = [
            size_3r(&three, &any(3, margin)),
            size_4r(&four, &any(4, margin)),
        ];
        for (size, before) in sizes.iter().zip(last) {
            assert!(*size <= before + 1e-3, "{margin}: {sizes:?} after {last:?}");
        }
        last = sizes;
    }
    assert_eq!(last, [0.0, 0.0]);
    for (limits, joints) in [(three, 3), (four, 4)] {
        let size = |failures: FailureSet| match joints {
            3 => size_3r(&limits, &failures),
            _ => size_4r(&limits, &failures),
        };
        assert!(size(any(joints, 2.0)) < size(any(joints, 0.0)));
        assert!(size(any(joints, 2.0)) > 0.0);
        assert_eq!(size(any(joints, 0.0)), size(FailureSet::any(joints)));
    }
}

/// Limits that span the circle with their margin are the full circle, and stay what they are
/// where they were it.
#[test]
fn the_full_circle_stays_full() {
    let limits = ArtificialLimits::from_degrees(&[[-180.0, 180.0], [60.0, 100.0], [60.0, 100.0]]);
    let only = |joint: usize| FailureSet::of(3, &[joint]);
    let size = |failures: FailureSet| size_3r(&limits, &failures);
    assert_eq!(size(only(1).with_margin(0.3)), size(only(1)));
    let nearly = ArtificialLimits::from_degrees(&[[-178.0, 178.0], [60.0, 100.0], [60.0, 100.0]]);
    let mut full = nearly.joints().to_vec();
    full[0] = JointLimit::FREE;
    let full = ArtificialLimits::new(full);
    let margin = only(1).with_margin(3f64.to_radians());
    let (a, b) = (size_3r(&nearly, &margin), size_3r(&full, &only(1)));
    assert!((a - b).abs() < 0.02 * b && a <= b + 1e-12, "{a} {b}");
}

fn atlas(
    robot: &Robot,
    task: TaskSpace,
    radius: f64,
    samples: u32,
    focus: Option<&ArtificialLimits>,
) -> Atlas {
    let plan = SamplePlan {
        task,
        region: Region {
            radius,
            lower: 0.0,
            upper: 0.0,
            reach: radius,
        },
        sampling: Sampling::Lattice {
            samples,
            replicates: 16,
        },
        seed: 3,
    };
    let mut recipe = AtlasRecipe::new(robot, plan, AtlasSettings::default()).unwrap();
    if let Some(limits) = focus {
        recipe = recipe.focused(limits);
    }
    recipe
        .build(None, &AtomicBool::new(false), &|_, _| ())
        .unwrap()
}

fn planar(lengths: &[f64]) -> Robot {
    Robot {
        name: "arm".into(),
        source: None,
        geometry: Geometry::Planar {
            lengths: lengths.to_vec(),
        },
        physical_limits: None,
        tool: Isometry3::identity(),
    }
}

#[test]
fn the_hybrid_estimator_agrees_with_the_exact_one() {
    let (three, four) = (limits_3r(), limits_4r());
    let robot = planar(&LENGTHS);
    let whole = atlas(&robot, TaskSpace::PlanarPosition, 3.0, 4000, None);
    let focused = atlas(&robot, TaskSpace::PlanarPosition, 3.0, 4000, Some(&three));
    let poses = atlas(&planar(&[1.0; 4]), TaskSpace::PlanarPose, 4.0, 6000, None);
    for margin in [0.0, 1.5, 4.0] {
        let failures = any(3, margin);
        let exact = PlanarPosition::new().sizes(arm(&LENGTHS, &three, &failures));
        for atlas in [&whole, &focused] {
            let sizes = atlas.sizes(&three, &failures, Rule::Definition);
            let found = sizes.fault_tolerant;
            let off = (found.value - exact.fault_tolerant.value).abs();
            let allowed = 4.0 * found.error + 2e-3 * found.value;
            assert!(off <= allowed, "{margin}: {found:?} for {exact:?}");
            assert!(found.value > 0.0);
            let fast = atlas.fault_tolerant_size(&three, &failures);
            assert!((fast - found.value).abs() < 1e-9 * fast);
            for (found, exact) in sizes.post_failure.iter().zip(&exact.post_failure) {
                let off = (found.value - exact.value).abs();
                assert!(
                    off <= 4.0 * found.error + 2e-3 * exact.value,
                    "{margin}: {sizes:?}"
                );
            }
        }
        let failures = any(4, margin);
        let exact = size_4r(&four, &failures);
        let found = poses
            .sizes(&four, &failures, Rule::Definition)
            .fault_tolerant;
        let off = (found.value - exact).abs();
        assert!(
            off <= 4.0 * found.error + 5e-3 * exact,
            "{margin}: {found:?} for {exact}"
        );
        assert!(exact > 0.0);
    }
}

/// A joint at its mechanical stop rests there, whatever the margin; elsewhere it goes beyond its
/// artificial limits.
#[test]
fn a_margin_ends_at_physical_limits() {
    let mut robot = planar(&LENGTHS);
    let stops = [PI, 100f64.to_radians(), 100f64.to_radians()];
    robot.physical_limits = Some(PhysicalLimits {
        lower: stops.map(|x| -x).to_vec(),
        upper: stops.to_vec(),
    });
    let atlas = atlas(&robot, TaskSpace::PlanarPosition, 3.0, 800, None);
    let size = |limits: &[[f64; 2]], failures: &FailureSet| {
        atlas.fault_tolerant_size(&ArtificialLimits::from_degrees(limits), failures)
    };
    let at_stops = [[-10.0, 10.0], [-180.0, 180.0], [-100.0, 100.0]];
    let prone = FailureSet::of(3, &[2, 3]);
    let wide = prone.clone().with_margin(0.2);
    assert!(size(&at_stops, &prone) > 0.0);
    assert_eq!(size(&at_stops, &wide), size(&at_stops, &prone));
    let inside = [[-10.0, 10.0], [-60.0, 60.0], [-60.0, 60.0]];
    assert!(size(&inside, &wide) <= size(&inside, &prone));
    let all = FailureSet::any(3);
    assert!(size(&at_stops, &all.clone().with_margin(0.1)) < size(&at_stops, &all));
}
