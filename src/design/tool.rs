//! Reads the table `[tool]`: the tool's frame in the frame after the last joint's link.

use super::Geometry;
use super::file::MAX_LENGTH;
use crate::diagnostic::{Entry, Problem, Table};
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// Largest angle in a file, degrees: ten turns. Beyond, the fraction of a turn loses its digits.
const MAX_DEGREES: f64 = 3600.0;

/// How far RᵀR may be from the identity and det R from 1: digits a person writes.
const ROTATION_TOLERANCE: f64 = 1e-6;

const EXPECTED_ROTATION: &str = "three rows of three numbers that form a rotation matrix";

/// Reads the table `tool`; the identity if there is none.
pub(super) fn read(root: &Table, geometry: Option<&Geometry>) -> Option<Isometry3<f64>> {
    let Some(table) = root.table("tool", &["position", "rotation", "rpy_deg"]) else {
        return Some(Isometry3::identity());
    };
    if let Some(Geometry::Planar { .. }) = geometry {
        refuse_planar(root);
    }
    table.require("position", "position = [0.0, 0.0, 0.1]");
    let position = read_vector(&table, "position", MAX_LENGTH, " m");
    let rotation = read_rotation(&table);
    Some(Isometry3::from_parts(
        Translation3::from(position?),
        rotation?,
    ))
}

fn refuse_planar(root: &Table) {
    let Some(place) = root.key_place("tool") else {
        return;
    };
    let problem = Problem {
        message: "a planar arm of `links` has no tool of its own".into(),
        found: "`[tool]` beside `links`".into(),
        expected: "`[tool]` only beside `joints` or `urdf`".into(),
        help: "add the tool's length to the last link, or describe the arm with `joints`".into(),
    };
    root.problems().report(&place, problem);
}

fn read_rotation(table: &Table) -> Option<UnitQuaternion<f64>> {
    match (table.entry("rotation"), table.entry("rpy_deg")) {
        (Some(rows), Some(_)) => {
            let help = "keep one of the two";
            table.problems().reject(
                rows.place(),
                "the tool's rotation is given twice",
                "`rotation` or `rpy_deg`",
                help,
            );
            None
        }
        (Some(rows), None) => read_matrix(table, &rows),
        (None, Some(_)) => {
            let angles = read_vector(table, "rpy_deg", MAX_DEGREES, " degrees")?;
            let [roll, pitch, yaw] = [angles.x, angles.y, angles.z].map(f64::to_radians);
            Some(UnitQuaternion::from_euler_angles(roll, pitch, yaw))
        }
        (None, None) => Some(UnitQuaternion::identity()),
    }
}

fn read_matrix(table: &Table, rows: &Entry) -> Option<UnitQuaternion<f64>> {
    let mut values = Vec::with_capacity(9);
    let lines = rows.array(EXPECTED_ROTATION)?;
    for line in &lines {
        for number in line.array("a row of three numbers")? {
            values.push(number.number(-1.1..=1.1, "")?.value);
        }
    }
    let square = lines.len() == 3 && values.len() == 9;
    let rotation = square
        .then(|| Matrix3::from_row_slice(&values))
        .and_then(|matrix| nearest_rotation(&matrix));
    if rotation.is_none() {
        let help = "each row and column has length 1, any two are at right angles, det = 1";
        table.problems().reject(
            rows.place(),
            "not a rotation matrix",
            EXPECTED_ROTATION,
            help,
        );
    }
    rotation
}

/// The rotation next to `matrix` in the Frobenius norm: U Vᵀ of its singular value decomposition;
/// `None` if `matrix` is none within the tolerance.
fn nearest_rotation(matrix: &Matrix3<f64>) -> Option<UnitQuaternion<f64>> {
    let error = (matrix.transpose() * matrix - Matrix3::identity()).amax();
    if error > ROTATION_TOLERANCE || matrix.determinant() < 0.0 {
        return None;
    }
    let parts = matrix.svd(true, true);
    let rotation = parts.u? * parts.v_t?;
    Some(UnitQuaternion::from_rotation_matrix(
        &Rotation3::from_matrix_unchecked(rotation),
    ))
}

fn read_vector(table: &Table, key: &str, most: f64, unit: &str) -> Option<Vector3<f64>> {
    let values = table.numbers(key, -most..=most, unit)?;
    let numbers: Vec<f64> = values.value.iter().map(|item| item.value).collect();
    if let [x, y, z] = numbers[..] {
        return Some(Vector3::new(x, y, z));
    }
    let expected = format!("three numbers{}", unit.replacen(' ', " in ", 1));
    table.problems().reject(
        &values.place,
        "needs three numbers",
        &expected,
        "give three numbers",
    );
    None
}

#[cfg(test)]
mod tests {
    use super::super::{Robot, parse_design};
    use crate::diagnostic::{InputError, Source};
    use nalgebra::Vector3;

    const ARM: &str = "name='r'\nconvention='standard'\n\
        joints=[{ kind='revolute', a=1 }, { kind='revolute', a=1 }]\n[tool]\n";

    fn parse(tool: &str) -> Result<Robot, InputError> {
        parse_design(&Source::new("r.toml", format!("{ARM}{tool}")))
    }

    #[test]
    fn both_ways_to_write_a_rotation_agree() {
        let rows = parse(
            "position = [0.1, 0, 0.2]\nrotation = [[0, -1, 0], [1, 0, 0.0000005], [0, 0, 1]]",
        )
        .unwrap();
        let angles = parse("position = [0.1, 0, 0.2]\nrpy_deg = [0, 0, 90]").unwrap();
        assert!(rows.tool.rotation.angle_to(&angles.tool.rotation) < 1e-6);
        assert_eq!(angles.tool.translation.vector, Vector3::new(0.1, 0.0, 0.2));
        assert_eq!(rows.check(), Ok(()));
        assert!(rows.planar_chain().is_err());
        // Roll about x first, then yaw about z: URDF's order.
        let both = parse("position = [0, 0, 0]\nrpy_deg = [90, 0, 90]").unwrap();
        let y = both.tool.rotation * Vector3::y();
        assert!((y - Vector3::z()).norm() < 1e-15);
    }

    #[test]
    fn mistakes_are_named() {
        let cases = [
            ("rpy_deg = [0, 0, 0]", "tool.position"),
            ("position = [0, 0]", "tool.position"),
            ("position = [0, 0, nan]", "tool.position"),
            ("position = [0,0,0]\nrpy_deg = [0, 0]", "tool.rpy_deg"),
            ("position = [0,0,0]\nrotation = [1]", "tool.rotation"),
            ("position = [0,0,0]\nrotation = []", "tool.rotation"),
            (
                "position=[0,0,0]\nrotation=[[1,0,0],[0,1,0],[0,0,-1]]",
                "tool.rotation",
            ),
            (
                "position=[0,0,0]\nrotation=[[1,0,0],[0,1,0],[0,0,0.9]]",
                "tool.rotation",
            ),
            (
                "position=[0,0,0]\nrpy_deg=[0,0,0]\nrotation=[[1,0,0],[0,1,0],[0,0,1]]",
                "tool.rotation",
            ),
            ("orientation = 1", "tool.orientation"),
        ];
        for (text, key) in cases {
            assert_eq!(parse(text).unwrap_err().key(), key, "{text}");
        }
        let planar = "name='r'\nlinks=[1, 1]\n[tool]\nposition=[0, 0, 0]";
        let error = parse_design(&Source::new("r.toml", planar)).unwrap_err();
        assert_eq!(error.key(), "tool");
    }
}
