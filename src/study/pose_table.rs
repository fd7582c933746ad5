//! The tables `[pose]` and `[manifolds]` of a study of one pose: read as written, then checked
//! against the task.

use super::file::{MAX_DEGREES, MAX_LENGTH};
use super::settings::{ManifoldSearch, Pose};
use crate::design::TaskSpace;
use crate::diagnostic::{Item, Place, Problem, Problems, Table};
use nalgebra::Matrix3;

/// How far the rows of a rotation may be from unit vectors at right angles.
const ORTHONORMAL: f64 = 1e-6;

/// Most random starts.
const MOST_SEEDS: u64 = 10_000_000;

/// Most values of a joint that slices hold, and what a study takes by default.
const MOST_SLICES: u64 = 256;
const SLICES: u64 = 32;

/// The table `[pose]` as written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PoseTable {
    position: Item<Vec<Item<f64>>>,
    rotation: Option<Item<Vec<Vec<f64>>>>,
    phi_deg: Option<Item<f64>>,
}

/// The table `[manifolds]` as written.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ManifoldsTable {
    seeds: Option<u64>,
    residual: Option<f64>,
    slices: Option<Item<u64>>,
}

/// Reads `[pose]`.
pub(super) fn read_pose(root: &Table) -> Option<Item<PoseTable>> {
    let table = root.table("pose", &["position", "rotation", "phi_deg"])?;
    table.require("position", "position = [1.0, 0.5, 0.2]");
    let rotation = table.entry("rotation").and_then(|entry| {
        let rows = entry.array("an array of three rows")?;
        let rows = rows.iter().map(|row| {
            let entries = row.array("a row of three numbers")?;
            let numbers = entries.iter().map(|e| e.number(-2.0..=2.0, ""));
            numbers.map(|item| Some(item?.value)).collect()
        });
        Some(entry.item(rows.collect::<Option<Vec<Vec<f64>>>>()?))
    });
    let phi_deg = table.number("phi_deg", -MAX_DEGREES..=MAX_DEGREES, " degrees");
    let position = table.numbers("position", -MAX_LENGTH..=MAX_LENGTH, " m");
    Some(Item {
        value: PoseTable {
            position: position?,
            rotation,
            phi_deg,
        },
        place: root.key_place("pose")?,
    })
}

/// Reads `[manifolds]`.
pub(super) fn read_manifolds(root: &Table) -> Option<Item<ManifoldsTable>> {
    let table = root.table("manifolds", &["seeds", "residual", "slices"])?;
    Some(Item {
        value: ManifoldsTable {
            seeds: table
                .integer("seeds", 1..=MOST_SEEDS)
                .map(|item| item.value),
            residual: table
                .number("residual", 1e-9..=1e-3, "")
                .map(|item| item.value),
            slices: table.integer("slices", 4..=MOST_SLICES),
        },
        place: root.key_place("manifolds")?,
    })
}

/// The settings of the search for a robot with `degree` degrees of redundancy.
pub(super) fn search(
    table: Option<&ManifoldsTable>,
    degree: isize,
    problems: &Problems,
) -> ManifoldSearch {
    let default = ManifoldSearch::default();
    let table = table.cloned().unwrap_or_default();
    if let (Some(slices), true) = (&table.slices, degree < 2) {
        let problem = Problem {
            message: "this key has no meaning with one degree of redundancy".into(),
            found: "`slices`".into(),
            expected: "a robot whose pre-images are surfaces, which are cut into slices".into(),
            help: "remove the key".into(),
        };
        problems.report(&slices.place, problem);
    }
    let slices = table.slices.map_or(SLICES, |item| item.value);
    ManifoldSearch {
        seeds: table.seeds.unwrap_or(default.seeds),
        residual: table.residual.unwrap_or(default.residual),
        slices: (degree > 1).then_some(slices),
    }
}

/// The pose, if it has what `task` asks for and nothing else.
pub(super) fn pose(item: &Item<PoseTable>, task: TaskSpace, problems: &Problems) -> Option<Pose> {
    let table = &item.value;
    check_position(&table.position, task, problems);
    let rotation = table.rotation.as_ref();
    let phi = table.phi_deg.as_ref();
    let turned = task == TaskSpace::SpatialPose;
    let directed = task == TaskSpace::PlanarPose;
    present(
        problems,
        rotation.map(|i| &i.place),
        item,
        "rotation",
        turned,
        task,
    );
    present(
        problems,
        phi.map(|i| &i.place),
        item,
        "phi_deg",
        directed,
        task,
    );
    let rotation = match rotation.filter(|_| turned) {
        Some(rows) => Some(rotation_matrix(rows, problems)?),
        None => None,
    };
    Some(Pose {
        position: table.position.value.iter().map(|item| item.value).collect(),
        rotation,
        phi_deg: phi.filter(|_| directed).map(|item| item.value),
    })
}

/// Reports a position of the wrong dimension.
fn check_position(position: &Item<Vec<Item<f64>>>, task: TaskSpace, problems: &Problems) {
    let wanted = if task.is_planar() { 2 } else { 3 };
    if position.value.len() != wanted {
        let problem = Problem {
            message: format!("the task \"{task}\" needs a position of {wanted} numbers"),
            found: format!("{} entries", position.value.len()),
            expected: format!("{wanted} entries, metres"),
            help: if task.is_planar() {
                "write `position = [x, y]`".into()
            } else {
                "write `position = [x, y, z]`".into()
            },
        };
        problems.report(&position.place, problem);
    }
}

/// Reports a key that is missing or that the task has no use for.
fn present(
    problems: &Problems,
    found: Option<&Place>,
    pose: &Item<PoseTable>,
    key: &str,
    wanted: bool,
    task: TaskSpace,
) {
    let example = match key {
        "rotation" => "rotation = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
        _ => "phi_deg = 0.0",
    };
    match found {
        Some(place) if !wanted => {
            let problem = Problem {
                message: format!("this key has no meaning for the task \"{task}\""),
                found: format!("`{key}`"),
                expected: "a position alone, or the orientation the task has".into(),
                help: "remove the key, or choose another `[task] space`".into(),
            };
            problems.report(place, problem);
        }
        None if wanted => {
            let place = Place {
                key: format!("pose.{key}"),
                span: pose.place.span.clone(),
            };
            let problem = Problem {
                message: format!("the task \"{task}\" needs an orientation"),
                found: "nothing".into(),
                expected: format!("the key `{key}`"),
                help: format!("add `{example}`"),
            };
            problems.report_absent(&place, problem);
        }
        _ => {}
    }
}

/// The rows as a rotation, if they are one to within [`ORTHONORMAL`].
fn rotation_matrix(item: &Item<Vec<Vec<f64>>>, problems: &Problems) -> Option<[[f64; 3]; 3]> {
    let report = |found: String, help: &str| {
        let problem = Problem {
            message: "this is no rotation".into(),
            found,
            expected: "three rows of three numbers: unit vectors at right angles".into(),
            help: help.into(),
        };
        problems.report(&item.place, problem);
        None
    };
    let rows: Option<Vec<[f64; 3]>> = item
        .value
        .iter()
        .map(|row| row.as_slice().try_into().ok())
        .collect();
    let rows: [[f64; 3]; 3] = match rows.map(TryInto::try_into) {
        Some(Ok(rows)) => rows,
        _ => {
            let shape: Vec<String> = item.value.iter().map(|r| r.len().to_string()).collect();
            let found = format!("rows of [{}] numbers", shape.join(", "));
            return report(found, "give the rotation matrix row by row");
        }
    };
    let matrix = Matrix3::from_fn(|r, c| rows[r][c]);
    let error = (matrix * matrix.transpose() - Matrix3::identity()).amax();
    if error > ORTHONORMAL {
        let found = format!("rows whose products are off by {error:.1e}");
        return report(found, "give all digits of the matrix");
    }
    if matrix.determinant() < 0.0 {
        let help = "turn the sign of one row or column";
        return report("a reflection (determinant -1)".into(), help);
    }
    Some(rows)
}
