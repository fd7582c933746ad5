//! Task points whose pre-image holds singular configurations: curves that cross themselves or
//! each other, isolated points, surfaces. The search must end, report what it cannot resolve and
//! drop nothing silently.

#[allow(dead_code)]
mod arms;

use arms::Arm;
use faultspace::design::TaskSpace;
use faultspace::kinematics::Chain;
use faultspace::manifold::{
    Completeness, CurveStatus, ManifoldError, PreImage, PreImageSearch, SearchSettings,
};
use faultspace::sampling::stream;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};
use std::time::Instant;

fn find(
    chain: &Chain,
    task: TaskSpace,
    pose: &Isometry3<f64>,
    settings: SearchSettings,
) -> PreImage {
    let mut search =
        PreImageSearch::from_chain(chain.clone(), task, settings).expect("redundancy 1");
    let clock = Instant::now();
    let found = search.find(pose, &mut stream(7, 0));
    let seconds = clock.elapsed().as_secs_f64();
    assert!(seconds < 10.0, "{seconds} s for {pose:?}");
    assert_finite(&found);
    if std::env::var("TELL").is_ok() {
        println!(
            "{seconds:.3} s, {} seeds, {} landed, {:?}",
            found.seeds, found.landed, found.completeness
        );
        for m in &found.manifolds {
            println!(
                "    {:?} length {:.5} vertices {} hits {} crossings {:?} winding {:?}",
                m.status,
                m.length,
                m.vertices(),
                m.hits,
                m.crossings,
                m.winding
            );
        }
    }
    found
}

fn assert_finite(found: &PreImage) {
    for manifold in &found.manifolds {
        let numbers = manifold.points.iter().chain(&manifold.tangents);
        assert!(numbers.into_iter().all(|x| x.is_finite()), "{manifold:?}");
        assert!(manifold.length.is_finite());
        for joint in 0..manifold.joints {
            let [low, high] = manifold.span(joint);
            assert!(low.is_finite() && high.is_finite() && low <= high);
            manifold.critical_points(joint);
        }
    }
    let smooth = |m: &faultspace::manifold::SelfMotionManifold| {
        m.crossings.is_empty() && matches!(m.status, CurveStatus::Closed | CurveStatus::Stroke)
    };
    if !found.manifolds.iter().all(smooth) {
        assert_eq!(found.completeness, Completeness::Unknown);
    }
}

fn holds(found: &PreImage, theta: &[f64], tolerance: f64) -> bool {
    let on = |m: &faultspace::manifold::SelfMotionManifold| m.locate(theta, tolerance).is_some();
    found.manifolds.iter().any(on)
}

fn unit_3r() -> Chain {
    Chain::new(&arms::planar(&[1.0; 3])).expect("revolute")
}

fn at(x: f64, y: f64) -> Isometry3<f64> {
    Translation3::new(x, y, 0.0).into()
}

/// All configurations of the unit 3R arm at (x, 0), from θ₁ and the two solutions of the rest.
fn configurations(x: f64, steps: usize) -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for step in 0..steps {
        let first = (step as f64 + 0.37) * 2.0 * PI / steps as f64;
        let (px, py) = (x - first.cos(), -first.sin());
        let distance = px.hypot(py);
        if distance > 2.0 {
            continue;
        }
        let half = (0.5 * distance).acos();
        for sign in [1.0, -1.0] {
            let second = py.atan2(px) + sign * half;
            all.push([first, second - first, -2.0 * sign * half]);
        }
    }
    all
}

/// At |x| = 1 the curve runs through three configurations with all links in line; every
/// configuration on all six arcs between these nodes must be found.
#[test]
fn curves_run_through_nodes() {
    for settings in [SearchSettings::default(), SearchSettings::coarse()] {
        for off in [0.0, 1e-15, -1e-14, 1e-12, -1e-10, 1e-8, -1e-6, 1e-4] {
            let x = 1.0 + off;
            let found = find(&unit_3r(), TaskSpace::PlanarPosition, &at(x, 0.0), settings);
            for theta in configurations(x, 400) {
                assert!(
                    holds(&found, &theta, 5e-3),
                    "1 {off:+e}: {theta:?} is not found"
                );
            }
            if off.abs() >= 1e-12 {
                let closed = found
                    .manifolds
                    .iter()
                    .all(|m| m.status == CurveStatus::Closed);
                assert!(closed, "1 {off:+e}: {:?}", found.completeness);
            }
            if off == 0.0 {
                assert!(found.manifolds.iter().any(|m| !m.crossings.is_empty()));
                assert_eq!(found.completeness, Completeness::Unknown);
            }
        }
    }
}

/// At the outer boundary the pre-image is one configuration; just inside, a tiny loop.
#[test]
fn the_outer_boundary_is_reported() {
    for settings in [SearchSettings::default(), SearchSettings::coarse()] {
        let search = |x| find(&unit_3r(), TaskSpace::PlanarPosition, &at(x, 0.0), settings);
        let found = search(3.0);
        assert_eq!(found.completeness, Completeness::Unknown);
        assert!(holds(&found, &[0.0; 3], 1e-2));
        for off in [1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2] {
            let found = search(3.0 - off);
            assert!(!found.manifolds.is_empty(), "{off:e}");
            if off >= 1e-6 {
                assert_eq!(found.manifolds.len(), 1, "{off:e}");
                assert_eq!(found.manifolds[0].status, CurveStatus::Closed, "{off:e}");
            }
        }
        assert_eq!(search(3.0 + 1e-6).completeness, Completeness::Proved);
        assert!(search(3.0 + 1e-6).manifolds.is_empty());
    }
}

/// Folded at the base: the pre-image of the planar equal-link arm's centre.
#[test]
fn the_base_of_an_arm_with_equal_links() {
    let found = find(
        &unit_3r(),
        TaskSpace::PlanarPosition,
        &at(0.0, 0.0),
        SearchSettings::default(),
    );
    // An equilateral triangle, either way round, turned about the base.
    assert_eq!(found.manifolds.len(), 2);
    for manifold in &found.manifolds {
        assert_eq!(manifold.status, CurveStatus::Closed);
        assert!((manifold.length - 2.0 * PI).abs() < 1e-6);
        assert_eq!(
            manifold.winding.iter().map(|w| w.abs()).collect::<Vec<_>>(),
            [1, 0, 0]
        );
    }
}

fn wrists() -> Vec<Arm> {
    let task = TaskSpace::SpatialPose;
    let names = ["PA-10", "iiwa 14", "Panda", "Gen3"];
    let robots = [arms::pa10(), arms::iiwa(), arms::panda(), arms::gen3()];
    let arm = |(name, robot)| Arm {
        name,
        chain: Chain::new(&robot).expect("revolute"),
        task,
    };
    names.into_iter().zip(robots).map(arm).collect()
}

/// Singular configurations of shoulder-elbow-wrist arms, of rank 5 and 4, and stretched arms.
#[test]
fn wrists_and_shoulders_in_line() {
    let elbow = (-0.9f64).acos();
    let quarter = FRAC_PI_2;
    let special = [
        [0.0, 0.0, quarter, elbow, quarter, 0.0, 0.0],
        [0.0, 0.0, -quarter, elbow, quarter, 0.0, 0.0],
        [0.0, 0.0, quarter, 1.2, -quarter, 0.0, 0.0],
        [0.3, 0.0, quarter, 0.7, 0.4, -0.8, 1.1],
        [0.3, 0.0, -1.1, 0.7, 0.4, -0.8, 1.1],
        [0.3, 0.6, -1.1, 0.7, quarter, 0.0, 1.1],
        [0.3, 0.6, -1.1, 0.0, 0.4, -0.8, 1.1],
        [0.0, 0.6, 0.0, 0.0, 0.0, -0.8, 0.0],
        [0.0; 7],
    ];
    for arm in wrists() {
        for theta in special {
            for settings in [SearchSettings::default(), SearchSettings::coarse()] {
                if std::env::var("TELL").is_ok() {
                    println!("{} {theta:?}", arm.name);
                }
                let pose = arm.chain.tool(&theta);
                let found = find(&arm.chain, arm.task, &pose, settings);
                let reported = found.completeness == Completeness::Unknown;
                assert!(
                    reported || holds(&found, &theta, 1e-2),
                    "{} {theta:?}",
                    arm.name
                );
            }
        }
    }
}

/// With joint 2 straight, joints 1 and 3 turn against each other about one axis: a line of
/// configurations that sweeping the elbow alone does not find. It crosses the elbow's curve.
#[test]
fn pole_lines_are_found() {
    for arm in wrists().iter().take(2) {
        for settings in [SearchSettings::default(), SearchSettings::coarse()] {
            let theta = [0.3, 0.0, -1.1, 0.7, 0.4, -0.8, 1.1];
            let found = find(&arm.chain, arm.task, &arm.chain.tool(&theta), settings);
            assert!(found.manifolds.iter().any(|m| !m.crossings.is_empty()));
            for step in 0..200 {
                let mut other = theta;
                let turn = 0.0314 * step as f64;
                other[0] += turn;
                other[2] -= turn;
                assert!(holds(&found, &other, 5e-3), "{} {other:?}", arm.name);
            }
        }
    }
}

/// Near such poses: whatever is claimed holds.
#[test]
fn close_to_singular_poses() {
    for arm in wrists() {
        for (index, off) in [1e-3, 1e-5, 1e-7, 1e-9, 1e-11].into_iter().enumerate() {
            let theta = [0.3, off, FRAC_PI_2, 0.7, 0.4, -0.8 * off, 1.1];
            let pose = arm.chain.tool(&theta);
            let settings = SearchSettings::default();
            if std::env::var("TELL").is_ok() {
                println!("{} off {off:e}", arm.name);
            }
            let found = find(&arm.chain, arm.task, &pose, settings);
            let reported = found.completeness == Completeness::Unknown;
            assert!(
                reported || holds(&found, &theta, 1e-2),
                "{} {off:e} {index}",
                arm.name
            );
        }
    }
}

#[test]
fn poses_that_are_none() {
    for arm in arms::all() {
        let mut search =
            PreImageSearch::from_chain(arm.chain.clone(), arm.task, SearchSettings::coarse())
                .expect("redundancy 1");
        for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
            let pose = Isometry3::from_parts(
                Translation3::new(bad, 0.1, 0.2),
                UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.3),
            );
            let found = search.find(&pose, &mut stream(1, 1));
            assert!(found.manifolds.is_empty());
            assert!(!bad.is_nan() || found.completeness == Completeness::Unknown);
        }
        let found = search.find(&at(1e300, 0.0), &mut stream(1, 1));
        assert_eq!(found.completeness, Completeness::Proved);
    }
}

/// A planar arm moves its tool in two directions of space, or three with its angle.
#[test]
fn degenerate_tasks_are_refused() {
    let rank_of = |lengths: &[f64], task| match PreImageSearch::new(
        &arms::planar(lengths),
        task,
        SearchSettings::default(),
    ) {
        Err(ManifoldError::Degenerate { rank, .. }) => rank,
        other => panic!("{other:?}"),
    };
    assert_eq!(rank_of(&[1.0; 4], TaskSpace::SpatialPosition), 2);
    assert_eq!(rank_of(&[1.0; 7], TaskSpace::SpatialPose), 3);
    let error = PreImageSearch::new(
        &arms::planar(&[1.0; 4]),
        TaskSpace::SpatialPosition,
        SearchSettings::default(),
    )
    .expect_err("degenerate");
    assert_eq!(
        error.to_string(),
        "the arm moves its tool in 2 directions only, but spatial-position has 3: choose a task \
         that the arm can do"
    );
}
