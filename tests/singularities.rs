//! Singular configurations and self-motion manifolds through them [S1]: published and independent
//! values of the PA-10, closed forms of planar arms, properties, determinism.

#[allow(dead_code)]
mod arms;

use faultspace::angle::Arc;
use faultspace::design::{Robot, TaskSpace};
use faultspace::kinematics::{Chain, Differential};
use faultspace::manifold::physical_arcs;
use faultspace::sampling::stream;
use faultspace::singularity::{
    Arm, DescentSettings, DescentStatus, FailureExperiment, FailureSettings, LargestSettings,
    Location, LocationSearch, SINGULAR, SingularitySettings, descend, find_largest,
    find_singularities, random_configuration,
};
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const SPATIAL: TaskSpace = TaskSpace::SpatialPose;
/// |θ₄| of the largest location, and the range of θ₆ there.
const ELBOW: f64 = 2.690_565_841_793_530_8;
const LARGEST: f64 = 35.895_004_595_892_466;

fn cases(family: &str) -> Vec<Value> {
    let text = include_str!("reference/pa10_cases.json");
    let all: Vec<Value> = serde_json::from_str(text).expect("JSON");
    let own: Vec<Value> = all.into_iter().filter(|c| c["family"] == family).collect();
    assert!(!own.is_empty(), "{family}");
    own
}

fn numbers(value: &Value) -> Vec<f64> {
    serde_json::from_value(value.clone()).expect("numbers")
}

fn search(robot: &Robot, task: TaskSpace) -> LocationSearch {
    let chain = Chain::new(robot).expect("limits");
    LocationSearch::new(&chain, task, physical_arcs(robot)).expect("redundancy 1")
}

fn explore(search: &mut LocationSearch, theta: &[f64]) -> Location {
    let tool = search.arm().chain.tool(theta);
    search.explore(&tool, &[theta.to_vec()], &mut stream(3, 0))
}

#[test]
fn ranks_of_the_pa10() {
    let chain = Chain::new(&arms::pa10()).expect("revolute");
    let arm = Arm {
        chain: &chain,
        task: SPATIAL,
    };
    for case in cases("pa10-rank") {
        let sigma = arm.singular_values(&numbers(&case["config"]));
        let rank = sigma.iter().filter(|s| **s > SINGULAR).count();
        assert_eq!(
            rank as u64,
            case["jacobian_rank"].as_u64().expect("a rank"),
            "{}",
            case["id"]
        );
    }
}

#[test]
fn sizes_of_the_pa10() {
    let mut search = search(&arms::pa10(), SPATIAL);
    for case in cases("pa10-size").iter().chain(&cases("pa10-max")) {
        let Some(size) = case["size_all_manifolds"]
            .as_f64()
            .or(case["size"].as_f64())
        else {
            continue;
        };
        let tolerance = case["tol_all"]
            .as_f64()
            .or(case["tol"].as_f64())
            .expect("a tolerance");
        let found = explore(&mut search, &numbers(&case["config"]));
        let error = (found.size - size).abs();
        assert!(
            error <= tolerance,
            "{}: {} for {size}",
            case["id"],
            found.size
        );
        if let Some(ranges) = case.get("theta_ranges_all_1_2_3_5_6_7") {
            for (joint, range) in [0, 1, 2, 4, 5, 6].into_iter().zip(numbers(ranges)) {
                assert!(
                    (found.ranges[joint].measure() - range).abs() < 1e-3,
                    "{}",
                    case["id"]
                );
            }
        }
    }
}

/// [S1 Fig. 5]: two connected sets of equal size for θ₄ = ±2.69, rank-4 configurations on them.
#[test]
fn the_location_of_figure_5() {
    let mut search = search(&arms::pa10(), SPATIAL);
    let found = explore(
        &mut search,
        &[0.0, 0.0, FRAC_PI_2, ELBOW, FRAC_PI_2, 0.0, 0.0],
    );
    assert!((found.size - LARGEST).abs() < 1e-6);
    assert_eq!(found.sets.len(), 2);
    for set in &found.sets {
        assert!((set.size - LARGEST).abs() < 1e-6, "{}", set.size);
        assert_eq!(set.manifolds.len(), 4);
    }
    let of_loss = |loss: usize| found.nodes.iter().filter(|n| n.loss == loss).count();
    assert_eq!((of_loss(1), of_loss(2)), (8, 8));
    // The torus θ₂ = θ₆ = 0 belongs to each set.
    assert_eq!(found.surfaces.len(), 2);
    assert!(
        found
            .surfaces
            .iter()
            .all(|s| s.dimension == 2 && s.held == [1, 3, 5])
    );
}

/// The same size without rank-4 configurations; every node is a crossing of two branches.
#[test]
fn the_corrected_goal_of_table_iii() {
    let mut search = search(&arms::pa10(), SPATIAL);
    let theta = [
        0.0,
        -FRAC_PI_2,
        FRAC_PI_2,
        -ELBOW,
        1.065_208_160_386_121_4,
        FRAC_PI_2,
        0.0,
    ];
    let found = explore(&mut search, &theta);
    assert_eq!((found.sets.len(), found.manifolds.len()), (2, 16));
    assert_eq!(found.nodes.len(), 24);
    let chain = Chain::new(&arms::pa10()).expect("revolute");
    for node in &found.nodes {
        assert_eq!((node.loss, node.branches, node.manifolds.len()), (1, 2, 2));
        // Nodes hold the pose and are singular.
        let miss = chain.tool(&node.theta).translation.vector - found.tool.translation.vector;
        assert!(miss.norm() < 1e-9 && node.sigma[5] < 1e-9);
    }
    assert!((found.ranges[5].measure() - 4.0 * 0.9f64.asin()).abs() < 1e-6);
    assert!((0.0..=1e-9).contains(&found.ranges[3].measure()));
}

/// With the elbow straight the pre-image is θ₃ + θ₅ = const, along which J is singular.
#[test]
fn the_smallest_location() {
    let mut search = search(&arms::pa10(), SPATIAL);
    let found = explore(&mut search, &[0.3, 0.7, 0.4, 0.0, -1.2, 0.4, 0.1]);
    assert!((found.size - 4.0 * PI).abs() < 1e-9, "{}", found.size);
    assert!(found.surfaces.iter().all(|s| s.dimension == 1));
}

#[test]
fn every_descent_of_the_pa10_ends_well() {
    let chain = Chain::new(&arms::pa10()).expect("revolute");
    let arm = Arm {
        chain: &chain,
        task: SPATIAL,
    };
    for loss in 1..=2 {
        let mut reached = 0;
        for start in 0..60 {
            let theta = random_configuration(&arm, &[Arc::FULL; 7], 5, start);
            let end = descend(&arm, &theta, loss, &DescentSettings::default());
            let lost = end.sigma.iter().filter(|s| **s <= SINGULAR).count();
            assert_eq!(end.status == DescentStatus::Singular, lost >= loss);
            reached += usize::from(lost >= loss);
        }
        assert!(reached >= 48, "rank loss {loss}: {reached} of 60");
    }
}

/// Links of different lengths in a plane are singular exactly where they are in line: θ₂ and θ₃ are
/// multiples of π, four families that differ in nothing but θ₁.
#[test]
fn planar_arms_are_singular_in_line() {
    let chain = Chain::new(&arms::planar(&[1.0, 0.8, 0.45])).expect("revolute");
    let arm = Arm {
        chain: &chain,
        task: TaskSpace::PlanarPosition,
    };
    let found = find_singularities(&arm, &[Arc::FULL; 3], &SingularitySettings::default(), 1);
    assert_eq!(found.singularities.len(), 4);
    assert_eq!(found.families.len(), 4);
    assert_eq!(
        found.singularities.iter().map(|s| s.hits).sum::<usize>(),
        found.reached.len()
    );
    for singularity in &found.singularities {
        assert_eq!(singularity.loss, 1);
        for joint in [1, 2] {
            assert!(singularity.theta[joint].sin().abs() < 1e-9);
        }
    }
    for family in &found.families {
        assert_eq!(family.dimension, 1);
        assert_eq!(family.held.iter().map(|h| h.0).collect::<Vec<_>>(), [1, 2]);
    }
    // No configuration has rank 0.
    assert_eq!(
        found.tallies.last().map(|t| (t.loss, t.singular)),
        Some((2, 0))
    );
}

/// With unit links three of the four families lie at |x| = 1, on one curve: they are one singularity.
#[test]
fn self_motion_joins_singular_configurations() {
    let mut search = search(&arms::planar(&[1.0; 3]), TaskSpace::PlanarPosition);
    let settings = SingularitySettings::default();
    let mut found = find_singularities(&search.arm(), &[Arc::FULL; 3], &settings, 1);
    assert_eq!(found.singularities.len(), 4);
    let hits: usize = found.singularities.iter().map(|s| s.hits).sum();
    found.merge_self_motion(&mut search, 1);
    assert_eq!((found.singularities.len(), found.families.len()), (2, 2));
    assert_eq!(
        found.singularities.iter().map(|s| s.hits).sum::<usize>(),
        hits
    );
    for singularity in &found.singularities {
        assert!(singularity.family < 2);
    }
}

/// At |x| = 1 the curve of the arm with unit links meets itself in three nodes, all configurations
/// with the links in line.
#[test]
fn a_planar_curve_with_three_nodes() {
    let mut search = search(&arms::planar(&[1.0; 3]), TaskSpace::PlanarPosition);
    let found = explore(&mut search, &[0.0, 0.0, PI]);
    assert_eq!((found.nodes.len(), found.sets.len()), (3, 1));
    for node in &found.nodes {
        assert_eq!((node.loss, node.branches), (1, 2));
        assert!(node.theta[1].sin().abs() < 1e-9 && node.theta[2].sin().abs() < 1e-9);
    }
    assert!((found.size - 3.0 * TAU).abs() < 1e-9);
}

/// Regular poses have no nodes, and their sets are their manifolds.
#[test]
fn regular_locations_are_as_before() {
    for arm in arms::all().into_iter().filter(|arm| arm.chain.len() == 7) {
        let physical = vec![Arc::FULL; 7];
        let mut search = LocationSearch::new(&arm.chain, arm.task, physical).expect("7 joints");
        let pose = arm.random_pose(&mut stream(8, 1));
        let found = search.explore(&pose, &[], &mut stream(8, 2));
        assert!(
            found.nodes.is_empty() && found.surfaces.is_empty(),
            "{}",
            arm.name
        );
        assert_eq!(found.sets.len(), found.manifolds.len());
        let most = found.sets.iter().map(|set| set.size).fold(0.0, f64::max);
        assert!(found.size >= most - 1e-9);
    }
}

/// Few starts suffice, because refinement goes on from where they end.
#[test]
fn the_largest_location_from_few_starts() {
    let search = search(&arms::pa10(), SPATIAL);
    let mut settings = LargestSettings::default();
    settings.singularities.starts = 16;
    settings.singularities.max_loss = 2;
    settings.finalists = 1;
    settings.pareto_rounds = 1;
    settings.refine.evaluations = 120;
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| find_largest(&search, &settings, 2, &|_, _, _| {}, &|| false))
            .expect("not stopped")
    };
    let found = run(2);
    assert!(
        (found.largest.size - LARGEST).abs() < 1e-4,
        "{}",
        found.largest.size
    );
    assert!((found.best.theta[3].abs() - ELBOW).abs() < 1e-4 || found.best.theta[3].abs() > PI);
    assert!((found.largest.ranges[5].measure() - 4.479_078_1).abs() < 1e-3);
    // Fronts rise: the larger the location, the worse its best condition number.
    for pair in found.pareto[0].windows(2) {
        assert!(pair[0].size > pair[1].size);
        assert!(pair[0].dexterity.condition > pair[1].dexterity.condition);
    }
    for pair in found.pareto[1].windows(2) {
        assert!(pair[0].size > pair[1].size);
        assert!(pair[0].dexterity.manipulability < pair[1].dexterity.manipulability);
    }
    assert_eq!(found, run(1), "the result depends on the number of threads");
    assert!(find_largest(&search, &settings, 2, &|_, _, _| {}, &|| true).is_none());
}

/// The random column of [S1 Table II] lies within what independent code finds, 5 to 95 %.
#[test]
fn random_locations() {
    let mut search = search(&arms::pa10(), SPATIAL);
    let sizes: Vec<f64> = (0..1000)
        .map(|start| {
            let theta = random_configuration(&search.arm(), &[Arc::FULL; 7], 6, start);
            let tool = search.arm().chain.tool(&theta);
            search.screen(&tool, false, &mut stream(7, start as u64)).1
        })
        .collect();
    let most = |n: usize| sizes[..n].iter().copied().fold(0.0, f64::max);
    for (n, [low, high]) in [
        (10, [27.6, 33.8]),
        (100, [32.8, 34.8]),
        (1000, [34.3, 35.4]),
    ] {
        assert!((low..=high).contains(&most(n)), "{n}: {}", most(n));
    }
    let mut sorted = sizes.clone();
    sorted.sort_by(f64::total_cmp);
    let reference = &cases("pa10-random")[0]["n30000"];
    for (share, key) in [(0.25, "q25"), (0.5, "median"), (0.75, "q75")] {
        let quantile = sorted[(999.0 * share) as usize];
        let wanted = reference[key].as_f64().expect("a quantile");
        assert!(
            (quantile - wanted).abs() < 1.0,
            "{key}: {quantile} for {wanted}"
        );
    }
    assert!(sorted[0] > 4.0 * PI - 1e-3);
}

/// [S1 §IV.D]: the corrected goal is reached after every lock, those chosen by manipulability are
/// not, among others with joint 6 locked at its start.
#[test]
fn the_failure_experiment() {
    let search = search(&arms::pa10(), SPATIAL);
    let quarter = FRAC_PI_2;
    let start = [0.0, 0.0, quarter, quarter, quarter, 0.0, 0.0];
    let run = |goal: &[f64]| {
        let settings = FailureSettings {
            locks: 7,
            ..FailureSettings::default()
        };
        FailureExperiment::run(&search, (&start, goal), &[0, 1, 2, 4, 5, 6], &settings, 1)
    };
    let largest = [
        0.0,
        -quarter,
        quarter,
        -ELBOW,
        1.065_208_160_386_121_4,
        quarter,
        0.0,
    ];
    let found = run(&largest);
    assert_eq!(found.success(), 1.0);
    assert!(found.joints.iter().all(|joint| joint.share > 1.0 - 1e-9));
    for goal in [
        [0.0, -1.8, -2.8, -1.3, -2.3, 1.5, 0.0],
        [0.0, -0.8, 3.0, 1.2, -2.9, 1.6, 0.0],
    ] {
        let found = run(&goal);
        let first = found
            .locks
            .iter()
            .find(|lock| lock.joint == 5)
            .expect("joint 6");
        assert!(first.angle == 0.0 && !first.reached && first.position_error > 0.1);
        assert!(first.orientation_error < 1e-4);
        for lock in &found.locks {
            assert_eq!(
                lock.reached, lock.exists,
                "joint {} at {}",
                lock.joint, lock.angle
            );
            if lock.reached {
                assert!((lock.theta[lock.joint] - lock.angle).abs() < 1e-12);
            }
        }
    }
}

/// Physical limits hold after a failure.
#[test]
fn limits_hold_after_a_failure() {
    let mut robot = arms::iiwa();
    let limits = [170.0, 120.0, 170.0, 120.0, 170.0, 120.0, 175.0f64].map(f64::to_radians);
    robot.physical_limits = Some(faultspace::design::PhysicalLimits {
        lower: limits.iter().map(|l| -l).collect(),
        upper: limits.to_vec(),
    });
    let search = search(&robot, SPATIAL);
    let start = [0.0, 0.5, 0.0, -1.2, 0.0, 0.8, 0.0];
    let goal = [0.6, 0.9, -0.5, -1.6, 0.7, 0.5, 0.4];
    let settings = FailureSettings {
        locks: 5,
        ..FailureSettings::default()
    };
    let found = FailureExperiment::run(&search, (&start, &goal), &[0, 1, 2, 4, 5, 6], &settings, 1);
    assert!(found.locks.iter().any(|lock| lock.reached));
    for lock in &found.locks {
        for (angle, limit) in lock.theta.iter().zip(limits) {
            assert!(faultspace::angle::wrap(*angle).abs() <= limit + 1e-9);
        }
        assert!(!lock.reached || lock.exists);
    }
    // Ranges inside the limits are smaller.
    let free = explore(&mut super_search(), &goal);
    assert!(found.location.size < free.size - 0.1);
}

fn super_search() -> LocationSearch {
    search(&arms::iiwa(), SPATIAL)
}

/// The null space at a node holds the branches: each satisfies the second-order condition.
#[test]
fn branches_keep_the_tool_still_to_second_order() {
    let mut search = search(&arms::pa10(), SPATIAL);
    let theta = [0.0, 0.0, FRAC_PI_2, 1.0, FRAC_PI_2, 0.8, 0.0];
    let found = explore(&mut search, &theta);
    let node = &found.nodes[0];
    let chain = Chain::new(&arms::pa10()).expect("revolute");
    for &index in &node.manifolds {
        let manifold = &found.manifolds[index];
        let (segment, u) = manifold
            .locate(&node.theta, 1e-2)
            .expect("through the node");
        let tangent: Vec<f64> = (0..7)
            .map(|k| {
                (1.0 - u) * manifold.tangent(segment)[k] + u * manifold.tangent(segment + 1)[k]
            })
            .collect();
        let here = Differential::new(&chain, SPATIAL, &node.theta);
        let t = nalgebra::DVector::from_vec(tangent);
        assert!((here.jacobian() * &t).norm() < 2e-2);
    }
}

/// [S1 Table II] at N = 10,000, 5 to 95 % of what independent code finds. Takes half a minute.
#[test]
#[ignore = "slow"]
fn ten_thousand_random_locations() {
    use rayon::prelude::*;
    let search = search(&arms::pa10(), SPATIAL);
    let size = |own: &mut LocationSearch, start: usize| {
        let theta = random_configuration(&own.arm(), &[Arc::FULL; 7], 6, start);
        let tool = own.arm().chain.tool(&theta);
        own.screen(&tool, false, &mut stream(7, start as u64)).1
    };
    let sizes: Vec<f64> = (0..10_000)
        .into_par_iter()
        .map_init(|| search.clone(), size)
        .collect();
    let most = sizes.iter().copied().fold(0.0, f64::max);
    assert!((34.9..=35.6).contains(&most), "{most}");
}

/// The acceptance of the search: 200 starts for each of ten seeds, and few starts, against the
/// proposed column of [S1 Table II]. Takes minutes.
#[test]
#[ignore = "slow"]
fn the_largest_location_for_many_seeds() {
    let search = search(&arms::pa10(), SPATIAL);
    let published = [(10, 28.36), (20, 34.09), (100, 34.43), (200, 34.78)];
    for seed in 1..=10 {
        for (starts, least) in published {
            let mut settings = LargestSettings::default();
            settings.singularities.starts = starts;
            settings.pareto_rounds = 0;
            let found = find_largest(&search, &settings, seed, &|_, _, _| {}, &|| false);
            let found = found.expect("not stopped");
            let size = found.largest.size;
            println!(
                "seed {seed}, {starts} starts: {size:.7}, smallest {:.7}",
                found.smallest.0.size
            );
            assert!(size >= least, "seed {seed}, {starts} starts: {size}");
            if starts == 200 {
                assert!((size - LARGEST).abs() < 1e-4, "seed {seed}: {size}");
                assert!((found.smallest.0.size - 4.0 * PI).abs() < 1e-6);
                assert!(found.catalogue.singularities.iter().any(|s| s.loss == 2));
            }
        }
    }
}
