//! Plain shapes along a robot's links, so that viewers of URDF files show something.

use super::write::{Origin, numbers};
use crate::design::JointKind;
use crate::design::decimal::decimal;
use nalgebra::Vector3;
use std::fmt::Write;

/// Radii of links and joints and half the height of a joint, in the robot's size.
const LINK: f64 = 0.008;
const JOINT: f64 = 0.016;
const HALF_HEIGHT: f64 = 0.018;

/// Names and colours (red, green, blue, alpha) of links, joints and the tool.
const GREY: (&str, &str) = ("link", "0.75 0.75 0.78 1");
const BLUE: (&str, &str) = ("revolute", "0.34 0.71 0.91 1");
const ORANGE: (&str, &str) = ("prismatic", "0.90 0.62 0 1");
const RED: (&str, &str) = ("tool", "0.84 0.37 0 1");

/// A foot below the base and a rod to joint 1, whose frame is at `origin`; `size` metres is the
/// sum of all links.
pub(super) fn base_shape(origin: &Origin, size: f64) -> String {
    let mut text = String::new();
    let half = HALF_HEIGHT * size;
    let side = 4.0 * JOINT * size;
    let foot = format!(
        "<box size=\"{}\"/>",
        numbers(&[side, side, half].map(round))
    );
    let below = Vector3::new(0.0, 0.0, -1.5 * half);
    push_visual(&mut text, &below, &Vector3::z(), &foot, GREY);
    push_rod(
        &mut text,
        &Vector3::zeros(),
        &Vector3::from(origin.xyz),
        size,
    );
    text
}

/// The joint at the link's origin, then its link: along the joint's axis and across to the next
/// joint `ahead`.
pub(super) fn link_shapes(
    kind: JointKind,
    axis: &Vector3<f64>,
    ahead: &Vector3<f64>,
    size: f64,
) -> String {
    let mut text = String::new();
    let (radius, height) = (JOINT * size, 2.0 * HALF_HEIGHT * size);
    let (shape, colour) = match kind {
        JointKind::Revolute => (cylinder(radius, height), BLUE),
        JointKind::Prismatic => {
            let sides = [2.0 * radius, 2.0 * radius, 1.5 * height].map(round);
            (format!("<box size=\"{}\"/>", numbers(&sides)), ORANGE)
        }
    };
    push_visual(&mut text, &Vector3::zeros(), axis, &shape, colour);
    let corner = axis * axis.dot(ahead);
    push_rod(&mut text, &Vector3::zeros(), &corner, size);
    push_rod(&mut text, &corner, ahead, size);
    text
}

/// A small ball.
pub(super) fn tool_shape(size: f64) -> String {
    let mut text = String::new();
    let ball = sphere(0.7 * JOINT * size);
    push_visual(&mut text, &Vector3::zeros(), &Vector3::z(), &ball, RED);
    text
}

/// A rod with a ball at its far end; nothing where it has no length.
fn push_rod(text: &mut String, from: &Vector3<f64>, to: &Vector3<f64>, size: f64) {
    let along = to - from;
    if along.norm() < 1e-3 * LINK * size {
        return;
    }
    let rod = cylinder(LINK * size, along.norm());
    push_visual(text, &(0.5 * (from + to)), &along, &rod, GREY);
    push_visual(text, to, &Vector3::z(), &sphere(LINK * size), GREY);
}

fn cylinder(radius: f64, length: f64) -> String {
    let [radius, length] = [radius, length].map(|value| decimal(round(value)));
    format!("<cylinder radius=\"{radius}\" length=\"{length}\"/>")
}

fn sphere(radius: f64) -> String {
    format!("<sphere radius=\"{}\"/>", decimal(round(radius)))
}

/// Four significant digits: nobody measures a picture.
fn round(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// A shape about z, turned to `direction`, with its middle at `centre`.
fn push_visual(
    text: &mut String,
    centre: &Vector3<f64>,
    direction: &Vector3<f64>,
    shape: &str,
    (name, colour): (&str, &str),
) {
    let pitch = direction.x.hypot(direction.y).atan2(direction.z);
    let is_upright = direction.x == 0.0 && direction.y == 0.0;
    let yaw = if is_upright {
        0.0
    } else {
        direction.y.atan2(direction.x)
    };
    let origin = Origin {
        xyz: [centre.x, centre.y, centre.z].map(round),
        rpy: [0.0, pitch, yaw],
    };
    text.push_str("    <visual>");
    origin.push(text);
    let _ = writeln!(
        text,
        "<geometry>{shape}</geometry><material name=\"{name}\"><color rgba=\"{colour}\"/></material></visual>"
    );
}
