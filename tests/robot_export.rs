//! Robots written to files and read again: the same robot, the same tool poses.

use faultspace::design::{
    Convention, Geometry, Joint, JointKind, Link, PhysicalLimits, Robot, parse_design, read_design,
    robot_to_toml, robot_to_urdf,
};
use faultspace::diagnostic::Source;
use faultspace::kinematics::tool_frame;
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fs;
use std::path::Path;

/// What the project's own reader makes of the URDF text of `robot`.
fn through_urdf(robot: &Robot) -> Robot {
    let folder = tempfile::tempdir().unwrap();
    let text = robot_to_urdf(robot);
    fs::write(folder.path().join("r.urdf"), &text).unwrap();
    let file = folder.path().join("r.toml");
    let keys = "name = 'r'\nurdf = 'r.urdf'\nbase = 'base'\ntip = 'tool'\n";
    fs::write(&file, keys).unwrap();
    read_design(&file).unwrap_or_else(|error| panic!("{}\n{text}", error.render(false)))
}

/// Configurations spread over all joints, from golden ratios.
fn configurations(joints: usize) -> impl Iterator<Item = Vec<f64>> {
    let angle = move |k: usize, j: usize| {
        let turn = (k as f64 + 1.0) * (0.618_033_988_75 + 0.137 * j as f64);
        (2.0 * turn.fract() - 1.0) * PI
    };
    (0..40).map(move |k| (0..joints).map(|j| angle(k, j)).collect())
}

fn assert_same(robot: &Robot, back: &Robot) {
    assert_eq!(robot.joints(), back.joints());
    let limits = back.physical_limits.as_ref().unwrap();
    for joint in 0..robot.joints() {
        assert_eq!(robot.joint_kind(joint), back.joint_kind(joint));
        if let Some(own) = &robot.physical_limits {
            let expected = match own.upper[joint] - own.lower[joint] {
                width if width >= 2.0 * PI => [-PI, PI],
                _ => [own.lower[joint], own.upper[joint]],
            };
            assert_eq!([limits.lower[joint], limits.upper[joint]], expected);
        }
    }
    for theta in configurations(robot.joints()) {
        let [a, b] = [robot, back].map(|robot| tool_frame(robot, &theta).to_homogeneous());
        let miss = (a - b).amax();
        assert!(miss < 1e-9, "{miss:e} at {theta:?}");
    }
}

fn rows(convention: Convention, rows: &[(JointKind, [f64; 4])]) -> Robot {
    let joint = |&(kind, [alpha, a, d, theta]): &(JointKind, [f64; 4])| Joint {
        kind,
        link: Link {
            twist: alpha.to_radians(),
            length: a,
            offset: d,
            angle: theta.to_radians(),
        },
    };
    Robot {
        name: "a <robot> & its \"name\"".into(),
        source: Some("from -- somewhere -".into()),
        geometry: Geometry::Rows {
            convention,
            joints: rows.iter().map(joint).collect(),
        },
        tool: Isometry3::identity(),
        physical_limits: None,
    }
}

/// Twists and angles of 0°, ±90°, 180° and others in all orders.
fn right_angles(convention: Convention) -> Robot {
    use JointKind::{Prismatic, Revolute};
    rows(
        convention,
        &[
            (Revolute, [90.0, 0.17, 0.4, 90.0]),
            (Prismatic, [-90.0, 0.0, 0.2, -90.0]),
            (Revolute, [90.0, -1.2, 0.0, 180.0]),
            (Revolute, [180.0, 0.3, -0.7, 0.0]),
            (Prismatic, [-90.0, 0.6, 0.0, 90.0]),
            (Revolute, [33.0, 0.2, 0.1, -12.5]),
            (Revolute, [0.0, 0.0, 0.2, 45.0]),
        ],
    )
}

#[test]
fn shipped_robots_survive_both_files() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("designs");
    let mut seen = [0, 0];
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let robot = read_design(&path).unwrap();
        assert_same(&robot, &through_urdf(&robot));
        match robot_to_toml(&robot, &["A comment.".into()]) {
            Ok(text) => {
                seen[0] += 1;
                let read = parse_design(&Source::new("r.toml", text.as_str())).unwrap();
                assert_eq!(read, robot, "{text}");
            }
            Err(reason) => {
                seen[1] += 1;
                assert!(reason.contains("URDF"), "{reason}");
            }
        }
    }
    assert!(seen[0] >= 12 && seen[1] >= 1, "{seen:?}");
}

#[test]
fn prismatic_joints_and_right_angles_keep_their_poses() {
    for convention in [Convention::Standard, Convention::Modified] {
        let mut robot = right_angles(convention);
        let free = through_urdf(&robot);
        assert_same(&robot, &free);
        // URDF knows no endless slide: one as long as the robot stands in.
        assert!(free.physical_limits.unwrap().upper[1] > 1.0);
        robot.physical_limits = Some(PhysicalLimits {
            lower: vec![-3.0, -0.1, -PI, -7.0, 0.0, -1.0, -PI],
            upper: vec![2.0, 0.4, 1.5 * PI, 7.0, 0.5, 1.0, PI],
        });
        assert_same(&robot, &through_urdf(&robot));
        let text = robot_to_urdf(&robot);
        assert_eq!(text.matches("type=\"continuous\"").count(), 3);
        assert_eq!(text.matches("type=\"revolute\"").count(), 2);
        assert_eq!(text.matches("type=\"prismatic\"").count(), 2);
    }
}

#[test]
fn tools_keep_their_frames_at_gimbal_lock() {
    let turns = [-FRAC_PI_2, 0.0, FRAC_PI_2, PI, 0.4];
    for convention in [Convention::Standard, Convention::Modified] {
        let mut robot = right_angles(convention);
        for roll in turns {
            for pitch in turns {
                for yaw in turns {
                    robot.tool = Isometry3::from_parts(
                        Translation3::new(0.1, -0.2, 0.3),
                        UnitQuaternion::from_euler_angles(roll, pitch, yaw),
                    );
                    assert_same(&robot, &through_urdf(&robot));
                }
            }
        }
    }
}

#[test]
fn names_are_escaped_and_shapes_are_whole() {
    let text = robot_to_urdf(&right_angles(Convention::Standard));
    assert!(text.contains("a &lt;robot&gt; &amp; its &quot;name&quot;"));
    let document = roxmltree::Document::parse(&text).unwrap();
    let links = document.root_element().children();
    let links: Vec<_> = links.filter(|node| node.has_tag_name("link")).collect();
    assert_eq!(links.len(), 9);
    assert!(links.iter().all(|link| link.has_children()));
    // A reader that knows all of URDF takes it.
    let robot = urdf_rs::read_from_string(&text).unwrap();
    assert_eq!((robot.joints.len(), robot.links.len()), (8, 9));
    assert!(robot.links.iter().all(|link| !link.visual.is_empty()));
    assert!(robot.joints.iter().all(|joint| !joint.name.is_empty()));
}

#[test]
fn a_robot_from_urdf_keeps_its_names_and_axes() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("designs/kuka_iiwa_14_limits.toml");
    let robot = read_design(&file).unwrap();
    let back = through_urdf(&robot);
    let (Geometry::Frames(own), Geometry::Frames(read)) = (&robot.geometry, &back.geometry) else {
        panic!("chains of frames expected");
    };
    for (own, read) in own.joints.iter().zip(&read.joints) {
        assert_eq!((&own.name, own.axis), (&read.name, read.axis));
    }
    assert_eq!(robot.physical_limits, back.physical_limits);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_rows_keep_their_poses(
        values in prop::collection::vec([-200.0..200.0f64, -3.0..3.0, -3.0..3.0, -400.0..400.0], 2..9),
        modified in any::<bool>(),
    ) {
        let convention = if modified { Convention::Modified } else { Convention::Standard };
        let values: Vec<_> = values.into_iter().map(|row| (JointKind::Revolute, row)).collect();
        let robot = rows(convention, &values);
        assert_same(&robot, &through_urdf(&robot));
    }
}
