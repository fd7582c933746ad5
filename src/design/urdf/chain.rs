//! From the joints of a URDF file to a chain of frames and its physical limits.

use super::xml::{Xml, head, joint_name, number, part, problem};
use crate::design::{FrameChain, FrameJoint, JointKind, PhysicalLimits};
use crate::diagnostic::{InputError, Problem};
use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3};
use roxmltree::Node;
use std::f64::consts::{PI, TAU};
use urdf_rs::{Joint, JointType};

/// Shortest axis as written; shorter ones have no direction worth the name.
const MIN_AXIS: f64 = 1e-9;

/// A joint as XML and as the URDF reader understands it.
pub(super) type Read<'a, 's> = (Node<'a, 's>, &'a Joint);

/// The chain of `joints`, base first; fixed joints are folded into their neighbours.
///
/// # Errors
/// A joint is of a kind that is no single revolute or prismatic joint, mimics another one, or
/// holds numbers that make no sense.
pub(super) fn frames(xml: &Xml, joints: &[Read]) -> Result<FrameChain, InputError> {
    let mut chain = FrameChain {
        joints: Vec::new(),
        tip: Isometry3::identity(),
    };
    // What fixed joints have piled up since the last joint that moves.
    let mut origin = Isometry3::identity();
    for (node, joint) in joints {
        origin *= read_origin(xml, *node)?;
        if joint.joint_type == JointType::Fixed {
            continue;
        }
        let kind = read_kind(xml, *node, joint)?;
        let axis = read_axis(xml, *node)?;
        chain.joints.push(FrameJoint {
            name: joint.name.clone(),
            kind,
            origin: std::mem::replace(&mut origin, Isometry3::identity()),
            axis,
        });
    }
    chain.tip = origin;
    Ok(chain)
}

fn read_kind(xml: &Xml, node: Node, joint: &Joint) -> Result<JointKind, InputError> {
    let refuse = |word: &str| {
        let message = format!("joint `{}` of the chain {word}", joint_name(node));
        let expected = "revolute, continuous, prismatic or fixed joints without `mimic`";
        let found = format!("type=\"{}\"", node.attribute("type").unwrap_or(""));
        let mut problem = problem(&message, found, expected);
        problem.help = "choose another `base` or `tip`, or describe the arm with `joints`".into();
        Err(xml.error(head(node), problem))
    };
    if joint.mimic.is_some() {
        return refuse("mimics another joint and has no variable of its own");
    }
    match joint.joint_type {
        JointType::Revolute | JointType::Continuous => Ok(JointKind::Revolute),
        JointType::Prismatic => Ok(JointKind::Prismatic),
        JointType::Floating => refuse("is floating"),
        JointType::Planar => refuse("is planar: it has two or three variables"),
        JointType::Spherical => refuse("is spherical: it has three variables"),
        JointType::Fixed => refuse("is fixed"),
    }
}

fn read_origin(xml: &Xml, joint: Node) -> Result<Isometry3<f64>, InputError> {
    let quaternion = part(joint, "origin").and_then(|node| node.attribute_node("quat_xyzw"));
    if let Some(attribute) = quaternion {
        let name = joint_name(joint);
        let message = format!("the origin of joint `{name}` is given as a quaternion");
        let problem = problem(&message, "`quat_xyzw`", "`rpy`");
        return Err(xml.error(attribute.range(), problem));
    }
    let xyz = xml.vector(joint, "origin", "xyz")?.unwrap_or_default();
    let rpy = xml.vector(joint, "origin", "rpy")?.unwrap_or_default();
    Ok(Isometry3::from_parts(
        Translation3::from(xyz),
        UnitQuaternion::from_euler_angles(rpy.x, rpy.y, rpy.z),
    ))
}

/// The axis; x if none is written, as URDF has it.
fn read_axis(xml: &Xml, joint: Node) -> Result<Unit<Vector3<f64>>, InputError> {
    let written = xml.vector(joint, "axis", "xyz")?;
    let axis = written.unwrap_or_else(Vector3::x);
    Unit::try_new(axis, MIN_AXIS).ok_or_else(|| {
        let message = format!("the axis of joint `{}` has no direction", joint_name(joint));
        let found = format!("\"{} {} {}\"", axis.x, axis.y, axis.z);
        let place = head(part(joint, "axis").unwrap_or(joint));
        xml.error(place, problem(&message, found, "a vector that is not 0"))
    })
}

/// The physical limits of those `joints` that move.
///
/// # Errors
/// A revolute or prismatic joint has no limits, or they leave it nowhere to go.
pub(super) fn limits(xml: &Xml, joints: &[Read]) -> Result<PhysicalLimits, InputError> {
    let mut limits = PhysicalLimits {
        lower: Vec::new(),
        upper: Vec::new(),
    };
    let moving = joints
        .iter()
        .filter(|(_, j)| j.joint_type != JointType::Fixed);
    for (node, joint) in moving {
        let [lower, upper] = match joint.joint_type {
            JointType::Continuous => [-PI, PI],
            _ => read_limit(xml, *node, joint)?,
        };
        limits.lower.push(lower);
        limits.upper.push(upper);
    }
    Ok(limits)
}

fn read_limit(xml: &Xml, node: Node, joint: &Joint) -> Result<[f64; 2], InputError> {
    let refuse = |message: &str, found: String, place: Node| {
        let message = format!("joint `{}` {message}", joint_name(node));
        let problem = Problem {
            help: "mend the file, give `[physical_limits]`, or write `use_urdf_limits = false`"
                .into(),
            ..problem(&message, found, "<limit lower=\"…\" upper=\"…\"/> in order")
        };
        Err(xml.error(head(place), problem))
    };
    let Some(place) = part(node, "limit") else {
        return refuse("has no limits", "nothing".into(), node);
    };
    for name in ["lower", "upper"] {
        let written = place.attribute(name);
        if let Some(word) = written.filter(|word| number(word).is_none()) {
            let found = format!("{name}=\"{word}\"");
            return refuse("has a limit that is not a finite number", found, place);
        }
    }
    // Absent limits are 0 or, from URDF 1.2 on, infinite; the reader knows which.
    let (lower, upper) = (joint.limit.lower, joint.limit.upper);
    let is_revolute = joint.joint_type == JointType::Revolute;
    if is_revolute && upper - lower >= TAU && !(upper - lower).is_finite() {
        return Ok([-PI, PI]);
    }
    let found = format!("{lower} to {upper}");
    match upper - lower {
        width if !width.is_finite() => refuse("has no limits", found, place),
        width if width <= 0.0 => refuse("has limits that let it go nowhere", found, place),
        _ => Ok([lower, upper]),
    }
}
