//! Reads the limits that hold before and after a failure.
//!
//! Limits of revolute joints come in degrees (`lower_deg`, `upper_deg`), those of prismatic
//! joints in metres (`lower`, `upper`); each array has one entry per joint of its kind, in order.

use super::file::MAX_LENGTH;
use super::{Geometry, JointKind, PhysicalLimits};
use crate::diagnostic::{Item, Problem, Table};

/// Reads the table `physical_limits`, if there is one.
pub(super) fn read(root: &Table, geometry: &Geometry) -> Option<PhysicalLimits> {
    let keys = &["lower_deg", "upper_deg", "lower", "upper"];
    let table = root.table("physical_limits", keys)?;
    let kinds = kinds(geometry);
    let revolute = read_pairs(
        &table,
        ["lower_deg", "upper_deg"],
        &kinds,
        JointKind::Revolute,
    );
    let prismatic = read_pairs(&table, ["lower", "upper"], &kinds, JointKind::Prismatic);
    let (mut revolute, mut prismatic) = (revolute?.into_iter(), prismatic?.into_iter());
    let mut limits = PhysicalLimits {
        lower: Vec::new(),
        upper: Vec::new(),
    };
    for kind in kinds {
        let [lower, upper] = match kind {
            JointKind::Revolute => revolute.next()?.map(f64::to_radians),
            JointKind::Prismatic => prismatic.next()?,
        };
        limits.lower.push(lower);
        limits.upper.push(upper);
    }
    Some(limits)
}

fn kinds(geometry: &Geometry) -> Vec<JointKind> {
    match geometry {
        Geometry::Planar { lengths } => vec![JointKind::Revolute; lengths.len()],
        Geometry::Rows { joints, .. } => joints.iter().map(|joint| joint.kind).collect(),
        Geometry::Frames(chain) => chain.joints.iter().map(|joint| joint.kind).collect(),
    }
}

/// The limits of all joints of one kind as [lower, upper], in the file's unit.
fn read_pairs(
    table: &Table,
    keys: [&str; 2],
    kinds: &[JointKind],
    kind: JointKind,
) -> Option<Vec<[f64; 2]>> {
    let joints: Vec<usize> = (1..)
        .zip(kinds)
        .filter(|(_, k)| **k == kind)
        .map(|(number, _)| number)
        .collect();
    let (word, unit) = match kind {
        JointKind::Revolute => ("revolute", " degrees"),
        JointKind::Prismatic => ("prismatic", " m"),
    };
    let read = keys.map(|key| {
        if !joints.is_empty() {
            table.require(key, &format!("{key} = […]"));
        }
        let values = table.numbers(key, -MAX_LENGTH..=MAX_LENGTH, unit)?;
        check_length(table, &values, joints.len(), word);
        Some(values.value)
    });
    if joints.is_empty() {
        return Some(Vec::new());
    }
    let [lower, upper] = read;
    let (lower, upper) = (lower?, upper?);
    check_order(table, &lower, &upper, &joints);
    let pair = |(lower, upper): (&Item<f64>, &Item<f64>)| [lower.value, upper.value];
    Some(lower.iter().zip(&upper).map(pair).collect())
}

fn check_order(table: &Table, lower: &[Item<f64>], upper: &[Item<f64>], joints: &[usize]) {
    for ((lower, upper), number) in lower.iter().zip(upper).zip(joints) {
        if lower.value > upper.value {
            table.problems().reject(
                &upper.place,
                &format!("the upper limit of joint {number} is below its lower limit"),
                &format!("at least {}", lower.value),
                "swap the two limits",
            );
        }
    }
}

fn check_length(table: &Table, values: &Item<Vec<Item<f64>>>, expected: usize, word: &str) {
    if values.value.len() == expected {
        return;
    }
    let problem = Problem {
        message: format!("needs one entry per {word} joint"),
        found: format!("{} entries", values.value.len()),
        expected: format!("{expected} entries"),
        help: "degrees for revolute joints, metres (`lower`, `upper`) for prismatic ones".into(),
    };
    table.problems().report(&values.place, problem);
}
