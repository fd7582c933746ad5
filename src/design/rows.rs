//! Reads the rows of Denavit–Hartenberg parameters of a robot file.

use super::file::{MAX_LENGTH, check_joint_count};
use super::{Convention, Geometry, Joint, JointKind, Link};
use crate::diagnostic::Table;

/// Keys of one row. In the variable's column stands its offset.
const KEYS: &[&str] = &["kind", "alpha_deg", "a", "d", "theta_deg"];

/// Largest twist or angle, degrees: ten turns. Beyond, the fraction of a turn loses its digits.
const MAX_DEGREES: f64 = 3600.0;

/// Reads `convention` and `joints`.
pub(super) fn read(root: &Table) -> Option<Geometry> {
    root.require("convention", "convention = \"standard\"");
    let conventions = [
        ("standard", Convention::Standard),
        ("modified", Convention::Modified),
    ];
    let convention = root.choice("convention", &conventions);
    let joints = root.entry("joints")?;
    let rows = joints.array("an array of tables, one per joint")?;
    check_joint_count(root, &joints.item(()), rows.len());
    let read: Vec<_> = rows.iter().map(|row| read_row(&row.table(KEYS)?)).collect();
    Some(Geometry::Rows {
        convention: convention?.value,
        joints: read.into_iter().collect::<Option<_>>()?,
    })
}

fn read_row(row: &Table) -> Option<Joint> {
    let kinds = [
        ("revolute", JointKind::Revolute),
        ("prismatic", JointKind::Prismatic),
    ];
    row.require("kind", "kind = \"revolute\"");
    let kind = row.choice("kind", &kinds);
    let angle = |key| read_column(row, key, MAX_DEGREES, " degrees");
    let length = |key| read_column(row, key, MAX_LENGTH, " m");
    let link = Link {
        twist: angle("alpha_deg").to_radians(),
        length: length("a"),
        offset: length("d"),
        angle: angle("theta_deg").to_radians(),
    };
    Some(Joint {
        kind: kind?.value,
        link,
    })
}

/// A column of the row; 0 if it is left out, as most entries of a robot's table are 0.
fn read_column(row: &Table, key: &str, largest: f64, unit: &str) -> f64 {
    row.number(key, -largest..=largest, unit)
        .map_or(0.0, |item| item.value)
}
