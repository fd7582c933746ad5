//! Writes the text of a robot file: what [`parse_design`] reads back to the same robot.

use super::decimal::{decimal, degrees};
use super::roll_pitch_yaw::roll_pitch_yaw;
use super::{Convention, Geometry, Joint, JointKind, PhysicalLimits, Robot, parse_design};
use crate::diagnostic::Source;
use nalgebra::{Isometry3, UnitQuaternion};

/// The text of a robot file (`designs/*.toml`) that [`parse_design`] reads back to `robot`, with
/// `comment_lines` at its head.
///
/// Numbers are the shortest decimals that give the same `f64`. Angles are written in degrees: the
/// shortest decimal whose radians are the robot's, or the nearest where no number of degrees gives
/// exactly these radians. A tool's rotation is the same to round-off.
///
/// # Errors
/// A sentence that tells why no file describes the robot: it comes from a URDF file, and its
/// frames have no Denavit–Hartenberg rows (write [`robot_to_urdf`](super::robot_to_urdf) instead),
/// or a number or the name is none that a robot file may hold.
pub fn robot_to_toml(robot: &Robot, comment_lines: &[String]) -> Result<String, String> {
    let mut text = String::new();
    for line in comment_lines {
        text += format!("# {}", line.replace(char::is_control, " ")).trim_end();
        text.push('\n');
    }
    text += &format!("name = {}\n", quoted(&robot.name));
    if let Some(source) = &robot.source {
        text += &format!("source = {}\n", quoted(source));
    }
    text += &match &robot.geometry {
        Geometry::Planar { lengths } => format!("links = {}  # metres\n", array(lengths, decimal)),
        Geometry::Rows { convention, joints } => rows(*convention, joints),
        Geometry::Frames(_) => {
            return Err("the robot comes from a URDF file and has no rows to write".into());
        }
    };
    if robot.tool != Isometry3::identity() {
        text += &tool(&robot.tool);
    }
    if let Some(limits) = &robot.physical_limits {
        text += &physical_limits(robot, limits);
    }
    match parse_design(&Source::new("the robot", text.as_str())) {
        Ok(_) => Ok(text),
        Err(error) => {
            let problem = error.problem();
            Err(format!("{}: {}", problem.message, problem.found))
        }
    }
}

/// A string as TOML has it.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

fn array(values: &[f64], number: fn(f64) -> String) -> String {
    let values: Vec<String> = values.iter().map(|value| number(*value)).collect();
    format!("[{}]", values.join(", "))
}

/// `convention` and `joints`, one row a line, numbers below each other. The column of angles is
/// left out where all are 0.
fn rows(convention: Convention, joints: &[Joint]) -> String {
    let columns: [(&str, Vec<String>); 4] = [
        ("alpha_deg", column(joints, |j| degrees(j.link.twist))),
        ("a", column(joints, |j| decimal(j.link.length))),
        ("d", column(joints, |j| decimal(j.link.offset))),
        ("theta_deg", column(joints, |j| degrees(j.link.angle))),
    ];
    let has_angles = joints.iter().any(|joint| joint.link.angle != 0.0);
    let shown = if has_angles { 4 } else { 3 };
    let convention = match convention {
        Convention::Standard => "standard",
        Convention::Modified => "modified",
    };
    let is_mixed = joints.iter().any(|joint| joint.kind != joints[0].kind);
    let mut text = format!("convention = \"{convention}\"\njoints = [\n");
    for (row, joint) in joints.iter().enumerate() {
        let kind = match joint.kind {
            JointKind::Revolute if is_mixed => "\"revolute\", ",
            JointKind::Revolute => "\"revolute\",",
            JointKind::Prismatic => "\"prismatic\",",
        };
        let cells = columns[..shown].iter();
        let cells: String = cells
            .map(|(key, cells)| format!("{key} = {} ", cells[row]))
            .collect();
        let cells = cells.trim_end().trim_end_matches(',');
        text += &format!("    {{ kind = {kind} {cells} }},\n");
    }
    text + "]  # metres\n"
}

/// The numbers of a column with a comma behind each, their points below each other and padded to
/// one width.
fn column(joints: &[Joint], number: impl Fn(&Joint) -> String) -> Vec<String> {
    let mut cells: Vec<String> = joints.iter().map(number).collect();
    let before = |cell: &String| cell.find('.').unwrap_or(cell.len());
    let left = cells.iter().map(before).max().unwrap_or(0);
    for cell in &mut cells {
        *cell = format!("{}{cell},", " ".repeat(left - before(cell)));
    }
    let width = cells.iter().map(String::len).max().unwrap_or(0);
    let cells = cells.iter();
    cells.map(|cell| format!("{cell:<width$}")).collect()
}

fn tool(tool: &Isometry3<f64>) -> String {
    let position: Vec<f64> = tool.translation.vector.iter().copied().collect();
    let mut text = format!(
        "\n[tool]\nposition = {}  # metres\n",
        array(&position, decimal)
    );
    if tool.rotation != UnitQuaternion::identity() {
        text += &format!(
            "rpy_deg = {}\n",
            array(&tool_angles(&tool.rotation), decimal)
        );
    }
    text
}

/// Roll, pitch and yaw in degrees with as few decimals as give the same rotation.
fn tool_angles(rotation: &UnitQuaternion<f64>) -> [f64; 3] {
    let exact = roll_pitch_yaw(rotation).map(f64::to_degrees);
    let rounded = |decimals: i32| {
        let unit = 10f64.powi(decimals);
        exact.map(|angle| (angle * unit).round() / unit + 0.0)
    };
    let gives_it = |angles: &[f64; 3]| {
        let [roll, pitch, yaw] = angles.map(f64::to_radians);
        UnitQuaternion::from_euler_angles(roll, pitch, yaw) == *rotation
    };
    let mut candidates = (0..14).map(rounded);
    candidates.find(gives_it).unwrap_or(exact)
}

/// The limits of revolute joints in degrees, of prismatic joints in metres.
fn physical_limits(robot: &Robot, limits: &PhysicalLimits) -> String {
    let mut text = String::from("\n[physical_limits]\n");
    let kinds = [
        (JointKind::Revolute, "_deg", degrees as fn(f64) -> String),
        (JointKind::Prismatic, "", decimal),
    ];
    for (kind, unit, number) in kinds {
        for (key, values) in [("lower", &limits.lower), ("upper", &limits.upper)] {
            let own = values.iter().enumerate();
            let own: Vec<f64> = own
                .filter(|(joint, _)| *joint < robot.joints() && robot.joint_kind(*joint) == kind)
                .map(|(_, value)| *value)
                .collect();
            if !own.is_empty() {
                text += &format!("{key}{unit} = {}\n", array(&own, number));
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::Link;
    use super::*;
    use nalgebra::Translation3;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn read(text: &str) -> Robot {
        parse_design(&Source::new("r.toml", text)).unwrap_or_else(|e| panic!("{e:?}\n{text}"))
    }

    fn joint(kind: JointKind, [alpha, a, d, theta]: [f64; 4]) -> Joint {
        let link = Link {
            twist: alpha.to_radians(),
            length: a,
            offset: d,
            angle: theta.to_radians(),
        };
        Joint { kind, link }
    }

    fn robot(geometry: Geometry) -> Robot {
        Robot {
            name: "r".into(),
            source: None,
            geometry,
            tool: Isometry3::identity(),
            physical_limits: None,
        }
    }

    fn rows_of(joints: Vec<Joint>) -> Robot {
        let convention = Convention::Standard;
        robot(Geometry::Rows { convention, joints })
    }

    #[test]
    fn rows_stand_below_each_other() {
        let joints = [[-98.0, 0.17, 0.0, 0.0], [90.0, 1.4, -12.5, 0.0]];
        let joints = joints.map(|row| joint(JointKind::Revolute, row)).to_vec();
        let text = robot_to_toml(&rows_of(joints), &["A line.".into(), String::new()]).unwrap();
        let expected = "# A line.\n#\nname = \"r\"\nconvention = \"standard\"\njoints = [\n    \
            { kind = \"revolute\", alpha_deg = -98.0, a = 0.17, d =   0.0 },\n    \
            { kind = \"revolute\", alpha_deg =  90.0, a = 1.4,  d = -12.5 },\n]  # metres\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn everything_is_read_back() {
        let joints = vec![
            joint(JointKind::Revolute, [-90.0, 0.1, 0.0, 45.0]),
            joint(JointKind::Prismatic, [0.1 + 0.2, 1e-9, -1e5 / 3.0, 0.0]),
            joint(JointKind::Revolute, [180.0, -0.0, 0.3, -0.5]),
        ];
        let convention = Convention::Modified;
        let mut robot = robot(Geometry::Rows { convention, joints });
        robot.name = "a \"quoted\" name \\ é".into();
        robot.source = Some("'''a\"\"\" b".into());
        robot.tool = Isometry3::from_parts(
            Translation3::new(0.1, 0.0, -0.25),
            UnitQuaternion::from_euler_angles(PI, 12.5f64.to_radians(), -PI / 2.0),
        );
        robot.physical_limits = Some(PhysicalLimits {
            lower: vec![(-170f64).to_radians(), -0.1, -2.0 * PI],
            upper: vec![120.5f64.to_radians(), 0.4, 2.0 * PI],
        });
        let text = robot_to_toml(&robot, &["name = 'x'\nname = 'y'".into()]).unwrap();
        assert_eq!(read(&text), robot, "{text}");
        assert!(text.contains("rpy_deg = [180.0, 12.5, -90.0]"), "{text}");
    }

    #[test]
    fn planar_arms_are_short() {
        let lengths = vec![1.0, 0.1 + 0.2];
        let text = robot_to_toml(&robot(Geometry::Planar { lengths }), &[]).unwrap();
        assert_eq!(
            text,
            "name = \"r\"\nlinks = [1.0, 0.30000000000000004]  # metres\n"
        );
    }

    #[test]
    fn what_no_file_can_hold_is_refused() {
        let lengths = vec![1.0, 2e6];
        let reason = robot_to_toml(&robot(Geometry::Planar { lengths }), &[]).unwrap_err();
        assert!(reason.contains("2000000"), "{reason}");
        let mut nameless = robot(Geometry::Planar {
            lengths: vec![1.0; 2],
        });
        nameless.name = " ".into();
        assert!(robot_to_toml(&nameless, &[]).is_err());
        nameless.name = "r".into();
        nameless.tool = Translation3::new(1.0, 0.0, 0.0).into();
        assert!(robot_to_toml(&nameless, &[]).unwrap_err().contains("tool"));
        assert!(robot_to_toml(&rows_of(vec![]), &[]).is_err());
    }

    proptest! {
        #[test]
        fn any_rows_are_read_back(values in prop::collection::vec([-200.0..200.0f64, -3.0..3.0, -3.0..3.0, -4.0..4.0], 2..9)) {
            let joints: Vec<Joint> = values.iter().map(|v| joint(JointKind::Revolute, *v)).collect();
            let robot = rows_of(joints);
            prop_assert_eq!(read(&robot_to_toml(&robot, &[]).unwrap()), robot);
        }
    }
}
