//! Single poses with more than one degree of redundancy, and with physical limits of joint 1:
//! against closed forms, locked arms and a brute force.

#[allow(dead_code, reason = "other tests use more of it")]
mod brute_force;

use brute_force::arm::Arm;
use brute_force::curves::{Solved, TURNS};
use faultspace::angle::{AngleSet, Arc, wrap};
use faultspace::design::{
    Convention, Geometry, Joint, JointKind, Link, PhysicalLimits, Robot, TaskSpace,
};
use faultspace::manifold::{
    PreImageSearch, SearchSettings, SurfaceSearch, physical_arcs, runs_inside,
};
use faultspace::sampling::stream;
use faultspace::workspace::planar::{PlanarArm, PlanarPosition};
use faultspace::workspace::{ArtificialLimits, FailureSet, JointLimit, PoseTolerance};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{FRAC_PI_2, PI};

fn planar(joints: usize) -> Robot {
    Robot {
        name: "planar".into(),
        source: None,
        geometry: Geometry::Planar {
            lengths: vec![1.0; joints],
        },
        physical_limits: None,
        tool: Isometry3::identity(),
    }
}

/// Rows of twist, length and offset.
fn spatial(rows: &[[f64; 3]]) -> Robot {
    let joint = |&[twist, length, offset]: &[f64; 3]| Joint {
        kind: JointKind::Revolute,
        link: Link {
            twist,
            length,
            offset,
            angle: 0.0,
        },
    };
    Robot {
        geometry: Geometry::Rows {
            convention: Convention::Standard,
            joints: rows.iter().map(joint).collect(),
        },
        ..planar(1)
    }
}

fn search(robot: &Robot, task: TaskSpace, slices: usize) -> SurfaceSearch {
    SurfaceSearch::new(robot, task, slices, SearchSettings::default()).unwrap()
}

/// With joint i ≥ 2 held at q the arm has a link of length L = 2 cos(q/2) in place of two, and
/// reaches r as long as L ≥ r − (n − 2): Θ_i is one arc about 0.
#[test]
fn ranges_of_planar_arms_have_their_exact_ends() {
    for (joints, r) in [(4, 3.0), (4, 3.5), (5, 4.0), (5, 4.6)] {
        let robot = planar(joints);
        let search = search(&robot, TaskSpace::PlanarPosition, 16);
        let mut surface = search.find(&Isometry3::translation(0.0, r, 0.0), 1);
        let free = vec![Arc::FULL; joints];
        let sets = surface.ranges(&free);
        let all: Vec<usize> = (0..joints).collect();
        let evidence = surface.evidence(&all, &sets, &free);
        assert!(
            evidence.landed > 100 && evidence.outside == 0,
            "{evidence:?}"
        );
        let end = 2.0 * (0.5 * (r - joints as f64 + 2.0)).acos();
        for (joint, set) in sets.iter().enumerate().skip(1) {
            let arcs = set.arcs();
            assert_eq!(
                arcs.len(),
                1,
                "{joints} joints, r = {r}, joint {}: {arcs:?}",
                joint + 1
            );
            let off = (arcs[0].start() + end).abs() + (arcs[0].end() - end).abs();
            assert!(
                off < 2e-6,
                "{joints} joints, r = {r}, joint {}: {off:e}",
                joint + 1
            );
        }
        assert!(sets[0].measure() > 0.0 && !sets[0].is_full());
    }
}

/// Rotation sets of planar positions are known in closed form.
#[test]
fn rotation_sets_agree_with_the_closed_form() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let mut tolerant = [0; 2];
    for (joints, cases) in [(4, 60), (5, 12)] {
        let robot = planar(joints);
        let lengths = vec![1.0; joints];
        let search = search(&robot, TaskSpace::PlanarPosition, 16);
        for case in 0..cases {
            let limit = |k: usize| {
                let [width, centre] = match k {
                    0 => [rng.random_range(0.0..1.2), 0.0],
                    _ => [rng.random_range(0.0..3.0), rng.random_range(-0.5..0.5)],
                };
                JointLimit::around(centre, width)
            };
            let limits = ArtificialLimits::new((0..joints).map(limit).collect());
            let r = rng.random_range(0.1..joints as f64);
            // Single joints as well: with all of them few cases survive.
            let failures = match case % 3 {
                0 => FailureSet::any(joints),
                1 => FailureSet::of(joints, &[1]),
                _ => FailureSet::of(joints, &[joints - 1]),
            };
            let arm = PlanarArm {
                lengths: &lengths,
                limits: &limits,
                failures: &failures,
            };
            let exact = PlanarPosition::new().rotation_set(arm, r);
            let mut surface = search.find(&Isometry3::translation(r, 0.0, 0.0), case);
            let sets = surface.ranges(&vec![Arc::FULL; joints]);
            let (found, evidence) =
                PoseTolerance::of_surface(&mut surface, &sets, &limits, &failures);
            assert_eq!(evidence.outside, 0);
            let found = found.rotation_set;
            let off = found.measure() + exact.measure() - 2.0 * found.overlap(&exact);
            assert!(
                off < 1e-4,
                "{joints} joints, case {case}, r = {r}: {found:?} {exact:?}"
            );
            tolerant[joints - 4] += usize::from(exact.measure() > 0.01 && !exact.is_full());
        }
    }
    assert!(tolerant[0] >= 10 && tolerant[1] >= 2, "{tolerant:?}");
}

/// Every end of a range is one: an arm with that joint held just inside holds the pose, just
/// outside it does not.
fn check_ends(robot: &Robot, task: TaskSpace, tool: &Isometry3<f64>, bounds: &[Arc]) -> usize {
    const OFF: f64 = 2e-3;
    let search = search(robot, task, 24);
    let mut surface = search.find(tool, 5);
    let sets = surface.ranges(bounds);
    let mut ends = 0;
    for (joint, set) in sets.iter().enumerate() {
        let is_held = |value: f64| {
            let held = search.chain().locked(joint, value);
            let mut locked =
                PreImageSearch::from_chain(held, task, SearchSettings::default()).unwrap();
            let found = locked.find(tool, &mut stream(9, joint as u64));
            let mut rest = bounds.to_vec();
            rest.remove(joint);
            let inside = |theta: &[f64]| {
                theta
                    .iter()
                    .zip(&rest)
                    .all(|(angle, arc)| arc.contains(*angle))
            };
            let mut curves = found.manifolds.iter();
            // Close to an end in a corner of the box next to nothing of a curve is inside.
            curves.any(|curve| !runs_inside(curve, 2000, &inside).is_empty())
        };
        for arc in set
            .arcs()
            .iter()
            .filter(|arc| !arc.is_full() && arc.width() > 4.0 * OFF)
        {
            for (end, outward) in [(arc.start(), -OFF), (arc.end(), OFF)] {
                assert!(is_held(end - outward), "joint {}: {end}", joint + 1);
                let beyond = end + outward;
                // At an end of its own bound, or where the next arc begins at once.
                if bounds[joint].contains(beyond) && !set.contains(beyond) {
                    assert!(!is_held(beyond), "joint {}: {end}", joint + 1);
                    ends += 1;
                }
            }
        }
    }
    ends
}

fn spatial_8r() -> Robot {
    let quarter = FRAC_PI_2;
    spatial(&[
        [-quarter, 0.3, 0.2],
        [quarter, 0.6, 0.1],
        [-quarter, 0.5, -0.2],
        [1.2, 0.4, 0.15],
        [-quarter, 0.45, 0.1],
        [quarter, 0.3, -0.1],
        [-1.1, 0.2, 0.2],
        [0.3, 0.15, 0.1],
    ])
}

/// A pose that the robot reaches.
fn pose(search: &SurfaceSearch, number: u64) -> Isometry3<f64> {
    let mut rng = stream(77, number);
    let joints = search.chain().len();
    let theta: Vec<f64> = (0..joints).map(|_| rng.random_range(-PI..PI)).collect();
    search.chain().tool(&theta)
}

#[test]
fn ranges_of_spatial_arms_end_where_locked_arms_stop() {
    let quarter = FRAC_PI_2;
    let five = spatial(&[
        [quarter, 1.414, 0.0],
        [-quarter, 1.414, 1.0],
        [quarter, 1.414, -1.0],
        [-quarter, 1.414, 1.0],
        [0.0, 1.2247, -0.5],
    ]);
    let eight = spatial_8r();
    let mut ends = 0;
    for (robot, task, poses) in [
        (&five, TaskSpace::SpatialPosition, 6),
        (&eight, TaskSpace::SpatialPose, 3),
    ] {
        let search = search(robot, task, 24);
        let free = vec![Arc::FULL; robot.joints()];
        let mut limited = free.clone();
        limited[1] = Arc::new(-1.5, 2.6);
        limited[robot.joints() - 2] = Arc::new(-2.0, 3.4);
        for number in 0..poses {
            let tool = pose(&search, number);
            ends += check_ends(robot, task, &tool, &free);
            ends += check_ends(robot, task, &tool, &limited);
        }
    }
    assert!(ends > 20, "{ends}");
}

/// A 9R robot is an 8R robot once a joint is held: its ranges contain those of every such robot,
/// and a joint that cannot matter (the last one about the tool's axis, of a position) is free.
#[test]
fn nine_joints_range_farther_than_eight() {
    let rows: Vec<[f64; 3]> = vec![
        [-FRAC_PI_2, 0.3, 0.2],
        [FRAC_PI_2, 0.6, 0.1],
        [-FRAC_PI_2, 0.5, -0.2],
        [1.2, 0.4, 0.15],
        [-FRAC_PI_2, 0.45, 0.1],
        [FRAC_PI_2, 0.3, -0.1],
        [-1.1, 0.2, 0.2],
        [0.7, 0.2, 0.1],
        [0.3, 0.15, 0.1],
    ];
    let nine = spatial(&rows);
    let search = search(&nine, TaskSpace::SpatialPose, 10);
    // Far out, where ranges are narrow.
    let theta = [0.2, -0.3, 0.25, 0.1, -0.2, 0.3, 0.2, -0.1, 0.4];
    let tool = search.chain().tool(&theta);
    let free = vec![Arc::FULL; 9];
    let mut surface = search.find(&tool, 2);
    let sets = surface.ranges(&free);
    let all: Vec<usize> = (0..9).collect();
    assert_eq!(surface.evidence(&all, &sets, &free).outside, 0);
    let mut narrow = 0;
    for held in [2, 6] {
        let mut rng = stream(3, held as u64);
        let chain = search.chain().locked(held, theta[held]);
        let held_again = usize::from(held < 4) * 3 + 1;
        for _ in 0..6 {
            let value = theta[if held_again >= held {
                held_again + 1
            } else {
                held_again
            }];
            let seven = chain.locked(held_again, value + rng.random_range(-0.3..0.3));
            let mut locked = PreImageSearch::from_chain(
                seven,
                TaskSpace::SpatialPose,
                SearchSettings::default(),
            )
            .unwrap();
            for curve in locked.find(&tool, &mut rng).manifolds {
                let left: Vec<usize> = (0..9).filter(|&k| k != held).collect();
                let left: Vec<usize> = (0..8)
                    .filter(|&k| k != held_again)
                    .map(|k| left[k])
                    .collect();
                for (k, &joint) in left.iter().enumerate() {
                    let arc = curve.joint_range(k);
                    let wide = sets[joint].sum(&Arc::new(-1e-3, 2e-3));
                    assert!(
                        wide.contains_arc(&arc),
                        "joint {}: {arc:?} {wide:?}",
                        joint + 1
                    );
                    narrow += usize::from(!sets[joint].is_full());
                }
            }
        }
    }
    assert!(narrow > 0);
}

fn with_limits(arm: &Arm) -> (Robot, Vec<Arc>) {
    let robot = arm.robot();
    let physical = physical_arcs(&robot);
    (robot, physical)
}

/// With physical limits of joint 1 every lock depends on the rotation: against a brute force.
#[test]
fn physical_limits_of_joint_1_agree_with_a_brute_force() {
    let turn = |low: f64, high: f64| Some([low.to_radians(), high.to_radians()]);
    let arm = Arm {
        name: "planar 3R",
        rows: vec![[0.0, 1.0, 0.0]; 3],
        slide: None,
        physical: vec![turn(-40.0, 50.0), turn(-170.0, 170.0), turn(-150.0, 120.0)],
    };
    let (robot, physical) = with_limits(&arm);
    let mut search =
        PreImageSearch::new(&robot, TaskSpace::PlanarPosition, SearchSettings::default()).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let mut partly = 0;
    for case in 0..40 {
        let r = rng.random_range(0.6..2.6);
        let pre_image = search.find(&Isometry3::translation(r, 0.0, 0.0), &mut stream(2, case));
        // Limits about a configuration that holds the pose.
        let curve = &pre_image.manifolds[case as usize % pre_image.manifolds.len()];
        let theta = curve.point(rng.random_range(0..curve.vertices()));
        let mut around = |joint: usize| {
            let [low, high] = arm.physical[joint].unwrap();
            let centre = wrap(theta[joint]).clamp(low + 0.1, high - 0.1);
            let mut end = |most: f64| rng.random_range(0.05..0.7f64).min(most);
            [centre - end(centre - low), centre + end(high - centre)]
        };
        let box_ = [[-0.5, 0.6], around(1), around(2)];
        let limits = box_.iter().map(|&[low, high]| JointLimit::new(low, high));
        let limits = ArtificialLimits::new(limits.collect());
        let failures = match case % 3 {
            0 => FailureSet::of(3, &[2]),
            1 => FailureSet::of(3, &[3]),
            _ => FailureSet::any(3),
        };
        let found = PoseTolerance::of(&pre_image, &physical, &limits, &failures);
        let goal = Vector3::new(r, 0.0, 0.0);
        let cloud = arm.cloud(&goal, 160, &mut rng);
        let solved = Solved::new(&arm, goal, &box_, &cloud);
        let wanted = solved.measure(&box_, &failures, &mut rng);
        let measure = found.rotation_set.measure();
        // Four ends of arcs between two rotations each.
        let allowed = 4.0 * 2.0 * PI / TURNS as f64;
        assert!(
            (measure - wanted).abs() < allowed,
            "case {case}: {measure} {wanted}"
        );
        // The turned pose is what its rotation set says, at rest.
        for beta in [-1.0, -0.4, 0.5, 1.3] {
            let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), beta) * goal;
            let tool = Isometry3::translation(turned.x, turned.y, 0.0);
            let image = search.find(&tool, &mut stream(3, case));
            let there = PoseTolerance::of(&image, &physical, &limits, &failures);
            let near = |angle: f64| found.rotation_set.contains(angle);
            // Not within the step of examined locks of an end.
            if near(beta - 0.02) == near(beta + 0.02) {
                let own = there.rotation_set.contains(0.0);
                assert_eq!(own, near(beta), "case {case}, β = {beta}");
                let locks = (0..3).filter(|&k| failures.contains(k + 1));
                let all = locks.into_iter().all(|k| there.survives[k]);
                assert_eq!(
                    own,
                    all && there.before_failure.contains(0.0),
                    "case {case}"
                );
            }
        }
        let whole = PoseTolerance::of(
            &pre_image,
            &[Arc::FULL, physical[1], physical[2]],
            &limits,
            &failures,
        );
        partly += usize::from(measure > 0.01 && measure < whole.rotation_set.measure() - 0.01);
    }
    assert!(partly >= 5, "{partly}");
}

/// The same for a surface: a planar 4R whose last joint may hardly move is nearly a 3R.
#[test]
fn surfaces_know_physical_limits_of_joint_1() {
    let mut robot = planar(4);
    let narrow = 1e-4;
    robot.physical_limits = Some(PhysicalLimits {
        lower: vec![-0.7, -3.0, -2.6, -narrow],
        upper: vec![0.9, 3.0, 2.1, narrow],
    });
    let mut three = planar(3);
    three.geometry = Geometry::Planar {
        lengths: vec![1.0, 1.0, 2.0],
    };
    three.physical_limits = Some(PhysicalLimits {
        lower: vec![-0.7, -3.0, -2.6],
        upper: vec![0.9, 3.0, 2.1],
    });
    let surfaces = search(&robot, TaskSpace::PlanarPosition, 8);
    let settings = SearchSettings::default();
    let mut curves = PreImageSearch::new(&three, TaskSpace::PlanarPosition, settings).unwrap();
    let box_ = [[-0.6, 0.7], [0.7, 1.2], [0.4, 0.8]];
    let limits = |count: usize| {
        let inner = box_.iter().map(|&[low, high]| JointLimit::new(low, high));
        let last = JointLimit::new(-narrow, narrow);
        ArtificialLimits::new(inner.chain([last]).take(count).collect())
    };
    let mut between = 0;
    for (number, r) in [2.7, 2.9, 3.1, 3.3].into_iter().enumerate() {
        for failures in [&[2][..], &[3], &[1, 2]] {
            let tool = Isometry3::translation(r, 0.0, 0.0);
            let image = curves.find(&tool, &mut stream(1, number as u64));
            let wanted = PoseTolerance::of(
                &image,
                &physical_arcs(&three),
                &limits(3),
                &FailureSet::of(3, failures),
            );
            let mut surface = surfaces.find(&tool, 1);
            let sets = surface.ranges(surface.physical());
            let failures = FailureSet::of(4, failures);
            let (found, _) = PoseTolerance::of_surface(&mut surface, &sets, &limits(4), &failures);
            let (a, b) = (&found.rotation_set, &wanted.rotation_set);
            let off = a.measure() + b.measure() - 2.0 * a.overlap(b);
            assert!(off < 0.05, "r = {r}: {a:?} {b:?}");
            between += usize::from(*b != AngleSet::full() && !b.is_empty());
        }
    }
    assert!(between > 3, "{between}");
}
