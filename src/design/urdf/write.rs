//! Writes a robot as a URDF file for simulators and viewers.

use super::shape::{base_shape, link_shapes, tool_shape};
use super::xml::push_escaped;
use crate::design::decimal::decimal;
use crate::design::roll_pitch_yaw::roll_pitch_yaw;
use crate::design::{Convention, Geometry, JointKind, Link, Robot};
use nalgebra::{Isometry3, Vector3};
use std::f64::consts::TAU;
use std::fmt::Write;

/// Torque (N m) or force (N) and speed (rad/s or m/s) of joints: URDF asks for them and a robot
/// has none here.
const EFFORT: f64 = 100.0;
const VELOCITY: f64 = 2.0;

/// What the file says about itself.
const REMARK: &str = "Lengths in metres, angles in radians. The shapes only show where joints and \
    links are; effort and velocity are placeholders.";

/// Where a body stands in its parent's frame, as URDF writes it.
pub(super) struct Origin {
    pub xyz: [f64; 3],
    /// Roll, pitch and yaw, radians.
    pub rpy: [f64; 3],
}

/// The text of a URDF file of `robot`: links `base`, `link_1` … `link_n` and `tool`, joints that
/// move by the robot's own joint variables (`joint_1` … `joint_n`, or the names of the URDF file
/// the robot comes from), and a fixed joint to `tool`, whose frame is the robot's tool frame.
///
/// Revolute joints are `continuous` where no physical limits hold them and `revolute` where some
/// do. URDF knows no prismatic joint without limits: such a joint may move by the sum of all
/// lengths both ways. Cylinders, boxes and spheres along the links are for viewers to show.
pub fn robot_to_urdf(robot: &Robot) -> String {
    let (origins, axes) = frames(robot);
    let size = size(&origins);
    let mut text = String::from("<?xml version=\"1.0\"?>\n<robot name=\"");
    push_escaped(&mut text, &robot.name);
    text.push_str("\">\n");
    // Two hyphens end a comment.
    let source = robot.source.as_deref().unwrap_or_default();
    for line in [source, REMARK].map(|line| plain(line).replace("--", "–")) {
        if !line.trim().is_empty() {
            let _ = writeln!(text, "  <!-- {} -->", line.trim().trim_end_matches('-'));
        }
    }
    push_link(&mut text, "base", &base_shape(&origins[0], size));
    for (joint, axis) in axes.iter().enumerate() {
        let link = format!("link_{}", joint + 1);
        push_joint(&mut text, robot, joint, &origins[joint], axis, size);
        let ahead = Vector3::from(origins[joint + 1].xyz);
        let shapes = link_shapes(robot.joint_kind(joint), axis, &ahead, size);
        push_link(&mut text, &link, &shapes);
    }
    push_tool(&mut text, robot, &origins[axes.len()]);
    push_link(&mut text, "tool", &tool_shape(size));
    text + "</robot>\n"
}

/// Without characters that XML does not know.
fn plain(text: &str) -> String {
    text.replace(char::is_control, " ")
}

/// The origins of joints 1 … n and of the tool, each in the frame before it, and the joints' axes.
fn frames(robot: &Robot) -> (Vec<Origin>, Vec<Vector3<f64>>) {
    if let Geometry::Frames(chain) = &robot.geometry {
        let origins = chain.joints.iter().map(|joint| Origin::of(&joint.origin));
        let tip = Origin::of(&(chain.tip * robot.tool));
        let axes = chain.joints.iter().map(|joint| *joint.axis).collect();
        return (origins.chain([tip]).collect(), axes);
    }
    let rows = rows(robot);
    let none = Link {
        twist: 0.0,
        length: 0.0,
        offset: 0.0,
        angle: 0.0,
    };
    // Between two joint variables lie the turn and slide about z of one row and those about x of
    // the same row (standard) or of the next (modified).
    let is_modified = matches!(
        &robot.geometry,
        Geometry::Rows {
            convention: Convention::Modified,
            ..
        }
    );
    let about_z = std::iter::once(&none).chain(&rows);
    let about_x: Vec<&Link> = match is_modified {
        true => rows.iter().chain([&none]).collect(),
        false => std::iter::once(&none).chain(&rows).collect(),
    };
    let mut origins: Vec<Origin> = about_z
        .zip(about_x)
        .map(|(z, x)| Origin::row(z, x))
        .collect();
    if let (Some(last), true) = (origins.last_mut(), robot.tool != Isometry3::identity()) {
        *last = Origin::of(&(last.isometry() * robot.tool));
    }
    let axes = vec![Vector3::z(); rows.len()];
    (origins, axes)
}

fn rows(robot: &Robot) -> Vec<Link> {
    let planar = |length: &f64| Link {
        twist: 0.0,
        length: *length,
        offset: 0.0,
        angle: 0.0,
    };
    match &robot.geometry {
        Geometry::Planar { lengths } => lengths.iter().map(planar).collect(),
        Geometry::Rows { joints, .. } => joints.iter().map(|joint| joint.link).collect(),
        Geometry::Frames(_) => Vec::new(),
    }
}

impl Origin {
    /// R_z(angle) T_z(offset) of one row, then T_x(length) R_x(twist) of another: its yaw and roll
    /// are the rows' own angles.
    fn row(z: &Link, x: &Link) -> Origin {
        let (sine, cosine) = z.angle.sin_cos();
        // The round-off of quarter turns is no length.
        let part = |share: f64| match share.abs() < 1e-15 {
            true => 0.0,
            false => x.length * share,
        };
        Origin {
            xyz: [part(cosine), part(sine), z.offset],
            rpy: [x.twist, 0.0, z.angle],
        }
    }

    fn of(isometry: &Isometry3<f64>) -> Origin {
        Origin {
            xyz: isometry.translation.vector.into(),
            rpy: roll_pitch_yaw(&isometry.rotation),
        }
    }

    fn isometry(&self) -> Isometry3<f64> {
        let [roll, pitch, yaw] = self.rpy;
        Isometry3::from_parts(
            Vector3::from(self.xyz).into(),
            nalgebra::UnitQuaternion::from_euler_angles(roll, pitch, yaw),
        )
    }

    /// The element, with what is not zero.
    pub(super) fn push(&self, text: &mut String) {
        text.push_str("<origin");
        for (name, values) in [("xyz", self.xyz), ("rpy", self.rpy)] {
            if name == "xyz" || values != [0.0; 3] {
                let _ = write!(text, " {name}=\"{}\"", numbers(&values));
            }
        }
        text.push_str("/>");
    }
}

pub(super) fn numbers(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| decimal(*value)).collect();
    values.join(" ")
}

/// Sum of the distances from joint to joint, metres; 1 where there are none.
fn size(origins: &[Origin]) -> f64 {
    let lengths = origins
        .iter()
        .map(|origin| Vector3::from(origin.xyz).norm());
    match lengths.sum::<f64>() {
        sum if sum > 0.0 && sum.is_finite() => sum,
        _ => 1.0,
    }
}

fn push_link(text: &mut String, name: &str, shapes: &str) {
    match shapes.is_empty() {
        true => *text += &format!("  <link name=\"{name}\"/>\n"),
        false => *text += &format!("  <link name=\"{name}\">\n{shapes}  </link>\n"),
    }
}

fn link_name(number: usize) -> String {
    match number {
        0 => "base".into(),
        number => format!("link_{number}"),
    }
}

fn joint_name(robot: &Robot, joint: usize) -> String {
    match &robot.geometry {
        Geometry::Frames(chain) => chain.joints[joint].name.clone(),
        _ => format!("joint_{}", joint + 1),
    }
}

fn push_joint(
    text: &mut String,
    robot: &Robot,
    joint: usize,
    origin: &Origin,
    axis: &Vector3<f64>,
    size: f64,
) {
    let limits = robot.physical_limits.as_ref();
    let limits = limits.and_then(|l| Some([*l.lower.get(joint)?, *l.upper.get(joint)?]));
    let (kind, limits) = match (robot.joint_kind(joint), limits) {
        (JointKind::Prismatic, limits) => ("prismatic", limits.or(Some([-size, size]))),
        // Limits a turn or more apart hold nothing.
        (JointKind::Revolute, Some([lower, upper])) if upper - lower < TAU => {
            ("revolute", Some([lower, upper]))
        }
        (JointKind::Revolute, _) => ("continuous", None),
    };
    text.push_str("  <joint name=\"");
    push_escaped(text, &joint_name(robot, joint));
    let _ = writeln!(text, "\" type=\"{kind}\">");
    push_ends(text, &link_name(joint), &link_name(joint + 1), origin);
    let axis = [axis.x, axis.y, axis.z];
    let _ = writeln!(text, "    <axis xyz=\"{}\"/>", numbers(&axis));
    text.push_str("    <limit");
    if let Some([lower, upper]) = limits {
        let (lower, upper) = (decimal(lower), decimal(upper));
        let _ = write!(text, " lower=\"{lower}\" upper=\"{upper}\"");
    }
    let _ = writeln!(text, " effort=\"{EFFORT}\" velocity=\"{VELOCITY}\"/>");
    text.push_str("  </joint>\n");
}

fn push_ends(text: &mut String, parent: &str, child: &str, origin: &Origin) {
    let _ = writeln!(text, "    <parent link=\"{parent}\"/>");
    let _ = writeln!(text, "    <child link=\"{child}\"/>");
    text.push_str("    ");
    origin.push(text);
    text.push('\n');
}

fn push_tool(text: &mut String, robot: &Robot, origin: &Origin) {
    let mut name = String::from("to_tool");
    let is_taken = |name: &str| (0..robot.joints()).any(|joint| joint_name(robot, joint) == name);
    while is_taken(&name) {
        name.push('_');
    }
    let _ = writeln!(text, "  <joint name=\"{name}\" type=\"fixed\">");
    push_ends(text, &link_name(robot.joints()), "tool", origin);
    text.push_str("  </joint>\n");
}
