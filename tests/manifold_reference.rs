//! Self-motion manifolds of 39 task points, against an independent program that made 8000 random
//! starts for each (tests/reference/spatial_cases.json).

use faultspace::angle::{AngleSet, turn};
use faultspace::design::{Convention, Geometry, Joint, JointKind, Link, Robot, TaskSpace};
use faultspace::manifold::{Completeness, PreImage, PreImageSearch, SearchSettings};
use faultspace::sampling::stream;
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3};
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn robot(name: &str, case: &Value) -> Robot {
    let twists: Vec<f64> = match case.get("alpha_deg") {
        Some(degrees) => numbers(degrees).iter().map(|a| a.to_radians()).collect(),
        None => numbers(&case["alpha_rad"]),
    };
    let (a, d) = (numbers(&case["a"]), numbers(&case["d"]));
    let joint = |k: usize| Joint {
        kind: JointKind::Revolute,
        link: Link {
            twist: twists[k],
            length: a[k],
            offset: d[k],
            angle: 0.0,
        },
    };
    Robot {
        name: name.into(),
        source: None,
        geometry: Geometry::Rows {
            convention: Convention::Standard,
            joints: (0..a.len()).map(joint).collect(),
        },
        physical_limits: None,
        tool: nalgebra::Isometry3::identity(),
    }
}

fn tool(case: &Value) -> Isometry3<f64> {
    let p = numbers(&case["p"]);
    let rotation = match case.get("R_rows").and_then(Value::as_array) {
        Some(rows) => {
            let entries: Vec<f64> = rows.iter().flat_map(numbers).collect();
            Rotation3::from_matrix_unchecked(Matrix3::from_row_slice(&entries))
        }
        None => Rotation3::identity(),
    };
    Isometry3::from_parts(Translation3::new(p[0], p[1], p[2]), rotation.into())
}

/// Arcs as [lo, hi]; `None` for the full circle.
fn arcs(value: &Value) -> Option<Vec<[f64; 2]>> {
    let list = value.as_array()?;
    let pair = |v: &Value| {
        let ends = numbers(v);
        [ends[0], ends[1]]
    };
    Some(list.iter().map(pair).collect())
}

fn assert_same_set(found: &AngleSet, expected: &Value, what: &str) {
    let Some(pairs) = arcs(expected) else {
        assert!(found.is_full(), "{what}: {found:?} should be full");
        return;
    };
    assert_eq!(
        found.arcs().len(),
        pairs.len(),
        "{what}: {found:?} against {pairs:?}"
    );
    for [low, high] in pairs {
        let near = |a: f64, b: f64| turn(a, b).min(turn(b, a)) < 1e-4;
        let fits = |arc: &faultspace::angle::Arc| {
            near(arc.start(), low) && (arc.width() - (high - low)).abs() < 1e-4
        };
        assert!(
            found.arcs().iter().any(fits),
            "{what}: {found:?} lacks [{low}, {high}]"
        );
    }
}

fn assert_components(found: &PreImage, case: &Value, what: &str) {
    let expected = case["components"].as_array().expect("components");
    assert_eq!(found.manifolds.len(), expected.len(), "{what}");
    let mut left: Vec<_> = found.manifolds.iter().collect();
    for component in expected {
        let length = component["length"].as_f64().expect("a length");
        let winding: Vec<i32> = numbers(&component["winding_up_to_sign"])
            .iter()
            .map(|w| *w as i32)
            .collect();
        let flipped: Vec<i32> = winding.iter().map(|w| -w).collect();
        let index = left.iter().position(|m| {
            (m.length - length).abs() < 2e-4 * length
                && (m.winding == winding || m.winding == flipped)
        });
        let Some(index) = index else {
            panic!("{what}: no manifold of length {length} and winding {winding:?}")
        };
        left.remove(index);
    }
}

#[test]
fn manifolds_agree_with_an_independent_search() {
    let text = include_str!("reference/spatial_cases.json");
    let file: Value = serde_json::from_str(text).expect("JSON");
    for (index, case) in file["cases"].as_array().expect("cases").iter().enumerate() {
        let name = case["robot"].as_str().expect("a name");
        let task = match name {
            "7R" => TaskSpace::SpatialPose,
            _ => TaskSpace::SpatialPosition,
        };
        let robot = robot(name, &file["robots"][name]);
        let mut search = PreImageSearch::new(&robot, task, SearchSettings::default())
            .expect("one degree of redundancy");
        let found = search.find(&tool(case), &mut stream(1, index as u64));
        let what = format!("case {index} ({name}, {})", case["category"]);
        assert_components(&found, case, &what);
        let unions = case["joint_union_arcs"].as_array().expect("unions");
        for (joint, (set, expected)) in found.joint_ranges().iter().zip(unions).enumerate() {
            assert_same_set(set, expected, &format!("{what}, joint {}", joint + 1));
        }
        assert!(found.winding_sum().iter().all(|&sum| sum == 0), "{what}");
        assert!(
            matches!(found.completeness, Completeness::Evidence(p) if p < 0.1),
            "{what}"
        );
    }
}
