//! The locked-joint check against exact sizes, the hybrid estimator and a robot without tolerance.

use faultspace::design::{Geometry, PhysicalLimits, Robot, TaskSpace, read_design};
use faultspace::kinematics::workspace_extent;
use faultspace::workspace::hybrid::{
    AtlasRecipe, AtlasSettings, Region, Rule, SamplePlan, Sampling,
};
use faultspace::workspace::planar::{PlanarArm, PlanarPose, PlanarPosition, PoseResolution};
use faultspace::workspace::{
    ArtificialLimits, Estimate, FailureSet, LockedJointCheck, LockedJointEstimate, WorkspaceSizes,
};
use nalgebra::Isometry3;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const FULL: [f64; 2] = [-180.0, 180.0];
/// The limits of [S4] for its 7R robot.
const PUBLISHED_7R: [[f64; 2]; 7] = [
    [-74.0, 74.0],
    FULL,
    FULL,
    [-113.0, 86.0],
    [-165.0, 146.0],
    [-64.0, 98.0],
    FULL,
];

fn planar(joints: usize) -> Robot {
    Robot {
        name: "planar".into(),
        source: None,
        geometry: Geometry::Planar {
            lengths: vec![1.0; joints],
        },
        tool: Isometry3::identity(),
        physical_limits: None,
    }
}

fn design(name: &str) -> Robot {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("designs");
    read_design(&folder.join(name)).unwrap()
}

fn check(poses: u64) -> LockedJointCheck {
    LockedJointCheck {
        poses,
        ..LockedJointCheck::default()
    }
}

fn run(
    check: &LockedJointCheck,
    robot: &Robot,
    task: TaskSpace,
    limits: &[[f64; 2]],
) -> LockedJointEstimate {
    let limits = ArtificialLimits::from_degrees(limits);
    let failures = FailureSet::any(robot.joints());
    let found = check.run(robot, task, &limits, &failures, &|_, _| (), &|| false);
    found.unwrap()
}

/// `found` lies within three standard errors of `wanted`.
fn assert_near(what: &str, found: Estimate, wanted: Estimate) {
    let allowed = 3.0 * found.error.hypot(wanted.error);
    println!(
        "{what}: {:.5} ± {:.5}, wanted {:.5} ± {:.5}",
        found.value, found.error, wanted.value, wanted.error
    );
    assert!((found.value - wanted.value).abs() < allowed, "{what}");
}

/// Shares and sizes against known sizes.
fn compare(found: &LockedJointEstimate, wanted: &WorkspaceSizes) {
    let whole = wanted.unrestricted.value;
    let share = |part: Estimate| Estimate {
        value: part.value / whole,
        error: part.error / whole,
    };
    let tolerant = share(wanted.fault_tolerant);
    assert!(tolerant.value > 0.01, "a comparison of nothing");
    assert_near("S_F share", found.fault_tolerant_share(), tolerant);
    assert_near(
        "W_0 share",
        found.pre_failure_share(),
        share(wanted.pre_failure),
    );
    assert_near("S_F", found.fault_tolerant_size(), wanted.fault_tolerant);
    assert_near("S_0max", found.unrestricted_size(), wanted.unrestricted);
}

#[test]
fn agrees_with_the_exact_sizes_of_planar_positions() {
    let limits = [[-18.21, 18.21], [-111.322, 111.322], [-111.322, 111.322]];
    let exact = PlanarPosition::new().sizes(PlanarArm {
        lengths: &[1.0; 3],
        limits: &ArtificialLimits::from_degrees(&limits),
        failures: &FailureSet::any(3),
    });
    let found = run(&check(1500), &planar(3), TaskSpace::PlanarPosition, &limits);
    compare(&found, &exact);
}

#[test]
fn agrees_with_the_exact_sizes_of_planar_poses() {
    let limits = [[-120.0, 100.0], [90.0, 142.0], [90.0, 142.0], FULL];
    let exact = PlanarPose::new(PoseResolution::coarse()).sizes(PlanarArm {
        lengths: &[1.0; 4],
        limits: &ArtificialLimits::from_degrees(&limits),
        failures: &FailureSet::any(4),
    });
    let found = run(&check(1200), &planar(4), TaskSpace::PlanarPose, &limits);
    compare(&found, &exact);
}

/// The sizes that the hybrid estimator finds.
fn hybrid(robot: &Robot, task: TaskSpace, limits: &[[f64; 2]], samples: u32) -> WorkspaceSizes {
    let extent = workspace_extent(robot).unwrap();
    let plan = SamplePlan {
        task,
        region: Region {
            radius: extent.radius,
            lower: if task.is_planar() { 0.0 } else { extent.lower },
            upper: if task.is_planar() { 0.0 } else { extent.upper },
            reach: extent.reach,
        },
        sampling: Sampling::Lattice {
            samples,
            replicates: 8,
        },
        seed: 5,
    };
    let recipe = AtlasRecipe::new(robot, plan, AtlasSettings::default()).unwrap();
    let atlas = recipe.build(None, &AtomicBool::new(false), &|_, _| ());
    let limits = ArtificialLimits::from_degrees(limits);
    let failures = FailureSet::any(robot.joints());
    atlas.unwrap().sizes(&limits, &failures, Rule::Definition)
}

/// Physical limits hold before and after a failure; those of joint 1 spoil the symmetry.
#[test]
fn keeps_physical_limits() {
    let mut robot = planar(3);
    robot.physical_limits = Some(PhysicalLimits {
        lower: vec![-2.4, -2.3, -2.5],
        upper: vec![2.5, 2.6, 2.2],
    });
    let limits = [[-18.0, 18.0], [-100.0, 111.0], [-111.0, 111.0]];
    let task = TaskSpace::PlanarPosition;
    let wanted = hybrid(&robot, task, &limits, 8000);
    compare(&run(&check(1500), &robot, task, &limits), &wanted);
}

#[test]
fn agrees_with_the_hybrid_estimator_in_space() {
    let robot = design("spatial_7r.toml");
    let found = run(&check(300), &robot, TaskSpace::SpatialPose, &PUBLISHED_7R);
    let wanted = Estimate {
        value: 0.0419,
        error: 0.0007,
    };
    assert_near("S_F share", found.fault_tolerant_share(), wanted);
}

/// The elbow angle of a shoulder–elbow–wrist arm is the same on the whole pre-image: no width of
/// its limits survives.
#[test]
fn finds_nothing_on_a_robot_without_tolerance() {
    let limits = [
        FULL,
        [-90.0, 90.0],
        FULL,
        [20.0, 120.0],
        FULL,
        [-90.0, 90.0],
        FULL,
    ];
    let found = run(
        &check(100),
        &design("pa10.toml"),
        TaskSpace::SpatialPose,
        &limits,
    );
    assert_eq!((found.reachable, found.fault_tolerant), (100, 0));
    assert!(found.pre_failure > 20);
    assert!(found.fault_tolerant_share().error > 0.0);
}

#[test]
fn a_margin_costs_and_threads_change_nothing() {
    let limits = [[-18.21, 18.21], [-100.0, 100.0], [-100.0, 100.0]];
    let counts = |threads: usize, margin: f64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let check = LockedJointCheck {
            margin,
            ..check(300)
        };
        let task = TaskSpace::PlanarPosition;
        let pool = pool.build().unwrap();
        pool.install(|| run(&check, &planar(3), task, &limits))
    };
    let found = counts(1, 0.0);
    assert_eq!(found, counts(3, 0.0));
    let wider = counts(2, 0.1);
    assert_eq!(found.pre_failure, wider.pre_failure);
    assert!(wider.fault_tolerant < found.fault_tolerant);
}

#[test]
fn stops_when_told() {
    let limits = ArtificialLimits::free(3);
    let failures = FailureSet::any(3);
    let task = TaskSpace::PlanarPosition;
    let found = check(100).run(&planar(3), task, &limits, &failures, &|_, _| (), &|| true);
    assert_eq!(found, None);
}

/// More starts find nothing that 60 missed.
#[test]
#[ignore = "half a minute on two cores; the quick version runs 300 poses"]
fn agrees_with_the_hybrid_estimator_to_three_thousandths() {
    let robot = design("spatial_7r.toml");
    let task = TaskSpace::SpatialPose;
    let found = run(&check(5000), &robot, task, &PUBLISHED_7R);
    compare(&found, &hybrid(&robot, task, &PUBLISHED_7R, 40_000));
    let thorough = LockedJointCheck {
        starts: 120,
        ..check(2000)
    };
    let more = run(&thorough, &robot, task, &PUBLISHED_7R);
    let fewer = run(&check(2000), &robot, task, &PUBLISHED_7R);
    assert!(more.fault_tolerant - fewer.fault_tolerant <= 1);
}
