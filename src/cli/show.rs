//! `faultspace show`.

use super::{Ending, output};
use crate::design::{Convention, Geometry, Joint, JointKind, Robot, TaskSpace, read_design};
use crate::kinematics::reach_bound;
use crate::report::{RobotFigure, figure_png, figure_svg, write_bytes};
use crate::workspace::planar::PlanarPosition;
use std::fmt::Write;
use std::path::Path;

/// Prints a summary of the robot at `path` and draws it to `out`, if given.
pub(super) fn show(path: &Path, out: Option<&Path>) -> Ending {
    let robot = match read_design(path) {
        Ok(robot) => robot,
        Err(error) => return output::bad_input(&error),
    };
    if let Some(out) = out
        && let Err(ending) = draw(&robot, out)
    {
        return ending;
    }
    output::print(&describe(&robot))
}

fn draw(robot: &Robot, out: &Path) -> Result<(), Ending> {
    let refuse = |message: String| {
        output::message(&format!("error: {message}"));
        Ending::BadInput
    };
    let chain = robot
        .planar_chain()
        .map_err(|reason| refuse(format!("only planar robots are drawn: {reason}")))?;
    let figure = RobotFigure {
        title: robot.name.clone(),
        links: &chain.lengths,
        unrestricted: PlanarPosition::unrestricted_radii(&chain.lengths),
    };
    let bytes = match out.extension().and_then(|extension| extension.to_str()) {
        Some("png") => figure_png(&figure),
        Some("svg") => figure_svg(&figure).map(String::into_bytes),
        _ => {
            return Err(refuse(
                "`--out` needs a name that ends in .png or .svg".into(),
            ));
        }
    };
    bytes
        .and_then(|bytes| write_bytes(out, &bytes))
        .map_err(|error| refuse(error.to_string()))
}

fn describe(robot: &Robot) -> String {
    let mut text = format!("{}\n", robot.name);
    // Writing to a string cannot fail.
    if let Some(source) = &robot.source {
        let _ = writeln!(text, "source: {source}");
    }
    let _ = writeln!(text, "\n{}", joint_table(robot));
    for task in TaskSpace::ALL.into_iter().filter(|t| can_do(robot, *t)) {
        let degree = robot.degree_of_redundancy(task);
        let label = format!("degree of redundancy, {task}:");
        let _ = writeln!(text, "{label:<40} {degree}");
    }
    let _ = match reach_bound(robot) {
        reach if reach.is_finite() => writeln!(text, "{:<40} {reach} m", "reach at most:"),
        _ => writeln!(text, "{:<40} not limited", "reach at most:"),
    };
    text
}

/// A planar robot does tasks in its plane, any other one tasks in space, if it has the joints.
fn can_do(robot: &Robot, task: TaskSpace) -> bool {
    task.is_planar() == robot.planar_chain().is_ok() && robot.degree_of_redundancy(task) >= 0
}

fn joint_table(robot: &Robot) -> String {
    match &robot.geometry {
        Geometry::Planar { lengths } => link_table(robot, lengths),
        Geometry::Rows { convention, joints } => row_table(robot, *convention, joints),
        Geometry::Frames(_) => String::new(),
    }
}

fn link_table(robot: &Robot, lengths: &[f64]) -> String {
    let mut text = format!("joint  kind       length_m{}\n", limit_header(robot));
    for (joint, length) in lengths.iter().enumerate() {
        let (number, limits) = (joint + 1, limits(robot, joint));
        let _ = writeln!(text, "{number:>5}  revolute   {length:>8}{limits}");
    }
    text
}

fn row_table(robot: &Robot, convention: Convention, joints: &[Joint]) -> String {
    let mut text = format!(
        "joint  kind       alpha_deg         a         d  theta_deg{}  ({})\n",
        limit_header(robot),
        convention_name(convention),
    );
    for (index, joint) in joints.iter().enumerate() {
        let link = joint.link;
        let _ = writeln!(
            text,
            "{:>5}  {:<9}  {:>9.3} {:>9.4} {:>9.4}  {:>9.3}{}",
            index + 1,
            kind_name(joint.kind),
            link.twist.to_degrees(),
            link.length,
            link.offset,
            link.angle.to_degrees(),
            limits(robot, index),
        );
    }
    text
}

fn convention_name(convention: Convention) -> &'static str {
    match convention {
        Convention::Standard => "standard convention",
        Convention::Modified => "modified convention",
    }
}

fn kind_name(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
    }
}

fn limit_header(robot: &Robot) -> &'static str {
    match robot.physical_limits {
        Some(_) => "  physical limits",
        None => "",
    }
}

fn limits(robot: &Robot, joint: usize) -> String {
    let Some(limits) = &robot.physical_limits else {
        return String::new();
    };
    let (lower, upper) = (limits.lower[joint], limits.upper[joint]);
    match robot.joint_kind(joint) {
        JointKind::Revolute => {
            format!("  {:.3}° to {:.3}°", lower.to_degrees(), upper.to_degrees())
        }
        JointKind::Prismatic => format!("  {lower} m to {upper} m"),
    }
}
