//! Two robots beside each other, and their workspaces.

mod figure_laws;

use faultspace::design::{JointKind, Robot, read_design};
use faultspace::kinematics::{JointPlace, display_posture, joint_places, tool_frame};
use faultspace::report::{
    Figure, JointMark, PairedRobot, RobotFigure, RobotPairFigure, SectionOf, SectionPairFigure,
    SpatialRobotFigure,
};
use faultspace::workspace::SpatialShareMap;
use figure_laws::draw;
use std::path::Path;

fn shipped(name: &str) -> Robot {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("designs");
    read_design(&folder.join(name)).unwrap()
}

fn spatial(name: &str, title: &str) -> PairedRobot<'static> {
    let robot = shipped(name);
    let theta = display_posture(&robot);
    let places = joint_places(&robot, &theta).into_iter().enumerate();
    let mark = |(joint, place): (usize, JointPlace)| JointMark {
        slides: robot.joint_kind(joint) == JointKind::Prismatic,
        frame: place.frame,
        entry: place.entry,
        foot: place.foot,
    };
    PairedRobot::Spatial(SpatialRobotFigure {
        title: title.into(),
        joints: places.map(mark).collect(),
        tool: tool_frame(&robot, &theta),
    })
}

fn planar<'a>(links: &'a [f64], title: &str) -> PairedRobot<'a> {
    PairedRobot::Planar(RobotFigure {
        title: title.into(),
        links,
        unrestricted: [0.0, links.iter().sum()],
    })
}

#[test]
fn robots_stand_beside_each_other() {
    let pair = RobotPairFigure {
        robots: [
            planar(&[1.0, 1.0, 1.0], "equal links: 12.6 %"),
            planar(&[1.38, 1.31, 0.31], "found: 26.4 %"),
        ],
    };
    let svg = draw(&pair);
    assert!(svg.contains("equal links: 12.6 %") && svg.contains("found: 26.4 %"));
    assert_eq!(pair.table().rows.len(), 6);
    assert!(pair.caption().contains("from above"));
    let pair = RobotPairFigure {
        robots: [
            spatial("spatial_7r.toml", "published 7R: 5.7 %"),
            spatial("kinova_gen3.toml", "found_7r: 18.7 %"),
        ],
    };
    let svg = draw(&pair);
    assert!(svg.contains("published 7R: 5.7 %") && svg.contains("found-7r: 18.7 %"));
    assert!(svg.contains("revolute joint") && !svg.contains("prismatic"));
    assert_eq!(svg.matches("z (m)").count(), 2);
    let table = pair.table();
    assert_eq!((table.rows.len(), table.header[0].as_str()), (14, "robot"));
}

#[test]
fn odd_pairs_are_drawn() {
    let nothing = PairedRobot::Spatial(SpatialRobotFigure {
        title: "a very long title ".repeat(30),
        joints: vec![],
        tool: nalgebra::Isometry3::identity(),
    });
    for other in [planar(&[], ""), planar(&[2.0], "one"), nothing.clone()] {
        let pair = RobotPairFigure {
            robots: [nothing.clone(), other],
        };
        draw(&pair);
    }
}

/// A torus of fault-tolerant positions of the given radius and height.
fn torus(radius: f64, height: f64, most: f64) -> SpatialShareMap {
    let mut map = SpatialShareMap {
        radius_edges: (0..=40).map(|k| 0.05 * radius * f64::from(k)).collect(),
        height_edges: (0..=60)
            .map(|k| height + 0.05 * radius * f64::from(k - 30))
            .collect(),
        azimuths: 6,
        orientations: true,
        ..SpatialShareMap::default()
    };
    for ir in 0..map.radii() {
        for iz in 0..map.heights() {
            let (r, z) = (map.radius(ir) / radius, (map.height(iz) - height) / radius);
            let is_reachable = (0.3..1.7).contains(&r.hypot(z));
            map.unrestricted.push(if is_reachable { 0.8 } else { 0.0 });
            let share = most * (1.0 - ((r - 0.9).hypot(z) / 0.5).powi(2)).max(0.0);
            let share = if is_reachable { share } else { 0.0 };
            map.share.extend([share as f32; 6]);
        }
    }
    map
}

#[test]
fn sections_are_in_units_of_the_reach() {
    let maps = [torus(4.0, 0.5, 0.12), torus(0.7, 0.1, 0.46)];
    let section = |k: usize, title: &str, reach: f64| SectionOf {
        title: title.into(),
        map: &maps[k],
        reach,
    };
    let figure = SectionPairFigure {
        robots: [
            section(0, "published 7R: 5.7 %", 6.8),
            section(1, "found: 18.7 %", 1.19),
        ],
    };
    let svg = draw(&figure);
    for text in [
        "r / R",
        "z / R",
        "(a) published 7R",
        "(b) found",
        "orientations (%)",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    // One scale for both: two panels and a bar.
    assert_eq!(svg.matches("<image").count(), 3);
    let table = figure.table();
    let largest = |title: &str| {
        let rows = table.rows.iter().filter(|row| row[0].starts_with(title));
        rows.map(|row| row[2].parse::<f64>().unwrap())
            .fold(0.0, f64::max)
    };
    assert!((largest("published") - 1.0).abs() < 0.05 && (largest("found") - 1.0).abs() < 0.05);
    let empty = SpatialShareMap::default();
    for (map, reach) in [
        (&empty, 1.0),
        (&maps[0], 0.0),
        (&maps[0], f64::NAN),
        (&maps[1], 1e-9),
    ] {
        let odd = SectionOf {
            title: "a very long title ".repeat(30),
            map,
            reach,
        };
        for robots in [[odd.clone(), section(0, "", 6.8)], [odd.clone(), odd]] {
            draw(&SectionPairFigure { robots });
        }
    }
}
