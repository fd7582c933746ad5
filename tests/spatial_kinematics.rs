//! Frames, constant transforms and extents of robots of every kind.

use faultspace::design::{
    Convention, FrameChain, FrameJoint, Geometry, Joint, JointKind, Link, PhysicalLimits, Robot,
    read_design,
};
use faultspace::kinematics::{
    Extent, display_posture, fixed_transforms, joint_frames, joint_motion, reach_bound, tool_frame,
    workspace_extent,
};
use nalgebra::{Isometry3, Unit, Vector3};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};
use std::path::Path;

fn robot(geometry: Geometry, tool: Isometry3<f64>) -> Robot {
    Robot {
        name: "test".into(),
        source: None,
        geometry,
        tool,
        physical_limits: None,
    }
}

fn shipped(name: &str) -> Robot {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("designs");
    read_design(&folder.join(format!("{name}.toml"))).unwrap()
}

fn number(stream: &mut ChaCha8Rng) -> f64 {
    stream.random_range(-3.0..3.0)
}

fn vector(stream: &mut ChaCha8Rng) -> Vector3<f64> {
    Vector3::new(number(stream), number(stream), number(stream))
}

fn transform(stream: &mut ChaCha8Rng) -> Isometry3<f64> {
    Isometry3::new(vector(stream), vector(stream))
}

fn kind(stream: &mut ChaCha8Rng) -> JointKind {
    if stream.random_bool(0.3) {
        JointKind::Prismatic
    } else {
        JointKind::Revolute
    }
}

fn random_rows(stream: &mut ChaCha8Rng, convention: Convention, joints: usize) -> Geometry {
    let row = |_| Joint {
        kind: kind(stream),
        link: Link {
            twist: number(stream),
            length: number(stream),
            offset: number(stream),
            angle: number(stream),
        },
    };
    Geometry::Rows {
        convention,
        joints: (0..joints).map(row).collect(),
    }
}

fn random_frames(stream: &mut ChaCha8Rng, joints: usize) -> Geometry {
    let joint = |number| FrameJoint {
        name: format!("j{number}"),
        kind: kind(stream),
        origin: transform(stream),
        axis: match number % 3 {
            0 => -Vector3::z_axis(),
            _ => Unit::new_normalize(vector(stream)),
        },
    };
    let joints = (0..joints).map(joint).collect();
    Geometry::Frames(FrameChain {
        joints,
        tip: transform(stream),
    })
}

/// One robot of every kind.
fn random_robots(stream: &mut ChaCha8Rng) -> [Robot; 4] {
    let joints = stream.random_range(1..8);
    let lengths = (0..joints).map(|_| number(stream).abs() + 0.1).collect();
    [
        Geometry::Planar { lengths },
        random_rows(stream, Convention::Standard, joints),
        random_rows(stream, Convention::Modified, joints),
        random_frames(stream, joints),
    ]
    .map(|geometry| robot(geometry, transform(stream)))
}

#[test]
fn constant_transforms_and_frames_give_the_same_tool() {
    let mut stream = ChaCha8Rng::seed_from_u64(1);
    for robot in (0..200)
        .flat_map(|_| random_robots(&mut stream))
        .collect::<Vec<_>>()
    {
        let theta: Vec<f64> = (0..robot.joints()).map(|_| number(&mut stream)).collect();
        let fixed = fixed_transforms(&robot);
        assert_eq!(fixed.len(), robot.joints() + 1);
        let mut tool = fixed[0];
        for (joint, variable) in theta.iter().enumerate() {
            tool *= joint_motion(robot.joint_kind(joint), *variable) * fixed[joint + 1];
        }
        let frames = joint_frames(&robot, &theta);
        assert_eq!(frames.len(), robot.joints() + 1);
        let miss = (frames[robot.joints()].to_homogeneous() - tool.to_homogeneous()).amax();
        assert!(miss < 1e-12, "{miss}: {robot:?}");
        assert_eq!(robot.check(), Ok(()));
    }
}

fn assert_extent(extent: Extent, [radius, lower, upper, reach]: [f64; 4]) {
    let found = [extent.radius, extent.lower, extent.upper, extent.reach];
    for (found, expected) in found.into_iter().zip([radius, lower, upper, reach]) {
        assert!((found - expected).abs() < 1e-9, "{extent:?}");
    }
}

#[test]
fn extents_of_planar_arms_are_sums_of_lengths() {
    let lengths = vec![1.0, 0.25, 1.5];
    let arm = robot(Geometry::Planar { lengths }, Isometry3::identity());
    assert_extent(workspace_extent(&arm).unwrap(), [2.75, 0.0, 0.0, 2.75]);
    assert_eq!(reach_bound(&arm), 2.75);
}

/// Shoulder, elbow and wrist of the PA-10 are spherical or hinges on one line: stretched, the
/// tool is 0.45 + 0.50 + 0.45 m from the shoulder, in any direction.
#[test]
fn the_pa_10_reaches_a_ball_about_its_shoulder() {
    let extent = workspace_extent(&shipped("pa10")).unwrap();
    assert_extent(extent, [1.4, -1.4, 1.4, 1.4]);
}

/// A base 0.4 m high, two links of 0.7 and 0.5 m and limits of the shoulder from −30° to 60°.
#[test]
fn limits_bound_the_extent() {
    let row = |twist, length, offset| Joint {
        kind: JointKind::Revolute,
        link: Link {
            twist,
            length,
            offset,
            angle: 0.0,
        },
    };
    let joints = vec![
        row(FRAC_PI_2, 0.0, 0.4),
        row(0.0, 0.7, 0.0),
        row(0.0, 0.5, 0.0),
    ];
    let rows = Geometry::Rows {
        convention: Convention::Standard,
        joints,
    };
    let mut arm = robot(rows, Isometry3::identity());
    assert_extent(workspace_extent(&arm).unwrap(), [1.2, -0.8, 1.6, 1.6]);
    arm.physical_limits = Some(PhysicalLimits {
        lower: vec![0.0, -PI / 6.0, -PI],
        upper: vec![0.1, PI / 3.0, PI],
    });
    let sine = (PI / 3.0).sin();
    let straight = (0.4 + 1.2 * sine).hypot(0.6);
    let low = 0.4 - 0.35 - 0.5;
    // The elbow is free: from a shoulder at 60° the forearm points up, or away from the base.
    let elbow = (0.4 + 0.7 * sine).hypot(0.35);
    let expected = [1.2, low, 0.9 + 0.7 * sine, elbow + 0.5];
    assert!(elbow + 0.5 > straight);
    assert_extent(workspace_extent(&arm).unwrap(), expected);
}

#[test]
fn slides_need_limits() {
    let slide = Joint {
        kind: JointKind::Prismatic,
        link: Link {
            twist: 0.0,
            length: 0.3,
            offset: 0.2,
            angle: 0.0,
        },
    };
    let turn = Joint {
        kind: JointKind::Revolute,
        link: Link {
            length: 0.4,
            ..slide.link
        },
    };
    let rows = Geometry::Rows {
        convention: Convention::Standard,
        joints: vec![turn, slide],
    };
    let mut arm = robot(rows, Isometry3::identity());
    assert_eq!(workspace_extent(&arm), None);
    assert_eq!(reach_bound(&arm), f64::INFINITY);
    arm.physical_limits = Some(PhysicalLimits {
        lower: vec![-PI, -1.0],
        upper: vec![PI, 0.5],
    });
    let reach = 0.7f64.hypot(0.9);
    assert_extent(workspace_extent(&arm).unwrap(), [0.7, -0.6, 0.9, reach]);
}

#[test]
fn no_configuration_is_outside_the_extent() {
    let names = [
        "spatial_4r",
        "spatial_5r",
        "spatial_7r",
        "spatial_7r_wrist",
        "spatial_8r",
        "pa10",
    ];
    let mut stream = ChaCha8Rng::seed_from_u64(7);
    let mut robots: Vec<Robot> = names.into_iter().map(shipped).collect();
    // Random frames too, with limits on every other joint.
    let mut random = robot(random_frames(&mut stream, 6), Isometry3::identity());
    random.physical_limits = Some(PhysicalLimits {
        lower: vec![-4.0, -1.0, -4.0, 0.5, -4.0, -1.5],
        upper: vec![4.0, 1.0, 4.0, 1.5, 4.0, -0.5],
    });
    robots.push(random);
    for robot in robots {
        let extent = workspace_extent(&robot).unwrap();
        let to_joint_1 = fixed_transforms(&robot)[0].inverse();
        let mut nearest = f64::INFINITY;
        for _ in 0..20_000 {
            let draw = |joint: usize, stream: &mut ChaCha8Rng| match &robot.physical_limits {
                Some(limits) => stream.random_range(limits.lower[joint]..limits.upper[joint]),
                None => stream.random_range(-PI..PI),
            };
            let theta: Vec<f64> = (0..robot.joints()).map(|j| draw(j, &mut stream)).collect();
            let at = (to_joint_1 * tool_frame(&robot, &theta)).translation.vector;
            assert!(at.norm() <= extent.reach + 1e-9);
            assert!(at.x.hypot(at.y) <= extent.radius + 1e-9);
            assert!((extent.lower - 1e-9..=extent.upper + 1e-9).contains(&at.z));
            nearest = nearest.min(extent.reach - at.norm());
        }
        assert!(extent.reach <= reach_bound(&robot) + 1e-12);
        assert!(nearest < 0.3 * extent.reach, "{}: {nearest}", robot.name);
    }
}

/// Four links of √2, √2, √2 and √1.5 m with unit offsets: the published table, rounded.
#[test]
fn shipped_tables_are_as_published() {
    let robot = shipped("spatial_4r");
    let Geometry::Rows { joints, .. } = &robot.geometry else {
        panic!("rows expected");
    };
    assert!((joints[0].link.length - SQRT_2).abs() < 1e-4);
    assert!((joints[3].link.length - 1.5f64.sqrt()).abs() < 1e-4);
    assert_eq!(shipped("spatial_8r").joints(), 8);
    // The two 7R tables differ in the last link alone, but for the digits of the twists.
    let [long, short] = ["spatial_7r", "spatial_7r_wrist"].map(|name| reach_bound(&shipped(name)));
    assert!((long - short - (1f64.hypot(0.95) - 0.95)).abs() < 1e-12);
}

#[test]
fn postures_to_show_keep_the_limits() {
    let mut robot = shipped("spatial_7r");
    let free = display_posture(&robot);
    assert_eq!((free.len(), display_posture(&robot)), (7, free));
    robot.physical_limits = Some(PhysicalLimits {
        lower: vec![0.1; 7],
        upper: vec![0.2; 7],
    });
    let posture = display_posture(&robot);
    assert!(posture.iter().all(|angle| (0.1..=0.2).contains(angle)));
}
