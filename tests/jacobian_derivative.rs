//! ∂J/∂θ in closed form [S1 eq. 14], against finite differences and published-code values.

#[allow(dead_code)]
mod arms;

use faultspace::design::{Convention, JointKind, PhysicalLimits, Robot, TaskSpace};
use faultspace::kinematics::{Chain, Differential};
use faultspace::sampling::stream;
use nalgebra::{DMatrix, Translation3};
use rand::Rng;
use serde_json::Value;
use std::f64::consts::PI;

/// An arm of `joints` random rows, some of them prismatic, with a tool of its own.
fn random_robot(item: u64, joints: usize) -> Robot {
    let mut rng = stream(11, item);
    let mut row = |_| {
        [
            rng.random_range(-180.0..180.0),
            rng.random_range(-1.0..1.0),
            rng.random_range(-1.0..1.0),
        ]
    };
    let table: Vec<[f64; 3]> = (0..joints).map(&mut row).collect();
    let convention = match item % 2 {
        0 => Convention::Standard,
        _ => Convention::Modified,
    };
    let mut robot = arms::rows(convention, &table);
    robot.tool = Translation3::new(0.1, -0.2, 0.3).into();
    let mut limits = PhysicalLimits {
        lower: vec![-PI; joints],
        upper: vec![PI; joints],
    };
    if let faultspace::design::Geometry::Rows { joints, .. } = &mut robot.geometry {
        for (index, joint) in joints.iter_mut().enumerate() {
            if rng.random_bool(0.35) {
                joint.kind = JointKind::Prismatic;
                limits.lower[index] = rng.random_range(-0.5..0.2);
                limits.upper[index] = limits.lower[index] + rng.random_range(0.3..1.5);
            }
        }
    }
    robot.physical_limits = Some(limits);
    robot
}

/// The tool's velocity by differences of poses of fourth order: metres and radians.
fn jacobian_by_differences(chain: &Chain, theta: &[f64]) -> DMatrix<f64> {
    let h = 1e-3;
    let mut jacobian = DMatrix::zeros(6, theta.len());
    for k in 0..theta.len() {
        let at = |steps: f64| {
            let mut moved = theta.to_vec();
            moved[k] += steps * h;
            chain.tool(&moved)
        };
        let here = at(0.0);
        for (steps, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
            let there = at(steps);
            let share = weight / (12.0 * h);
            let v = there.translation.vector - here.translation.vector;
            let w = (there.rotation * here.rotation.inverse()).scaled_axis();
            for row in 0..3 {
                jacobian[(row, k)] += share * v[row];
                jacobian[(row + 3, k)] += share * w[row];
            }
        }
    }
    jacobian
}

#[test]
fn agrees_with_finite_differences_on_random_robots() {
    let task = TaskSpace::SpatialPose;
    for item in 0..40 {
        let joints = 4 + (item % 6) as usize;
        let chain = Chain::new(&random_robot(item, joints)).expect("limits");
        let mut rng = stream(12, item);
        let theta: Vec<f64> = (0..joints).map(|_| rng.random_range(-1.5..1.5)).collect();
        let here = Differential::new(&chain, task, &theta);
        let error = here.jacobian() - jacobian_by_differences(&chain, &theta);
        assert!(error.amax() < 1e-8, "J of robot {item}: {}", error.amax());
        for k in 0..joints {
            let at = |step: f64| {
                let mut moved = theta.clone();
                moved[k] += step;
                Differential::new(&chain, task, &moved).jacobian()
            };
            let h = 1e-3;
            let slope = (at(h) - at(-h)) * (8.0 / (12.0 * h))
                - (at(2.0 * h) - at(-2.0 * h)) * (1.0 / (12.0 * h));
            let error = (here.derivative(k) - slope).amax();
            assert!(error < 1e-8, "robot {item}, joint {}: {error}", k + 1);
        }
    }
}

#[test]
fn rows_belong_to_the_task() {
    let chain = Chain::new(&arms::planar(&[1.0, 0.8, 0.5, 0.3])).expect("revolute");
    let theta = [0.3, -0.7, 1.1, 0.2];
    let all = Differential::new(&chain, TaskSpace::SpatialPose, &theta);
    for (task, rows) in [
        (TaskSpace::PlanarPosition, vec![0, 1]),
        (TaskSpace::PlanarPose, vec![0, 1, 5]),
        (TaskSpace::SpatialPosition, vec![0, 1, 2]),
    ] {
        let own = Differential::new(&chain, task, &theta);
        assert_eq!(own.jacobian(), all.jacobian().select_rows(&rows));
        assert_eq!(own.derivative(1), all.derivative(1).select_rows(&rows));
    }
}

#[test]
fn pa10_agrees_with_reference_values() {
    let text = include_str!("reference/pa10_cases.json");
    let cases: Vec<Value> = serde_json::from_str(text).expect("JSON");
    let chain = Chain::new(&arms::pa10()).expect("revolute");
    let mut checked = 0;
    for case in cases.iter().filter(|case| case["family"] == "pa10-djac") {
        let theta: Vec<f64> = serde_json::from_value(case["config"].clone()).expect("angles");
        let rows: Vec<Vec<f64>> = serde_json::from_value(case["dJ"].clone()).expect("rows");
        let k = case["k_1based"].as_u64().expect("a joint") as usize - 1;
        let found = Differential::new(&chain, TaskSpace::SpatialPose, &theta).derivative(k);
        for (row, entries) in rows.iter().enumerate() {
            for (column, entry) in entries.iter().enumerate() {
                assert!(
                    (found[(row, column)] - entry).abs() < 1e-8,
                    "{}",
                    case["id"]
                );
            }
        }
        checked += 1;
    }
    assert!(checked >= 2);
}
