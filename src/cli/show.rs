//! `faultspace show`.

use super::joint_table::joint_table;
use super::{Ending, output};
use crate::design::{Robot, TaskSpace, read_design};
use crate::kinematics::workspace_extent;
use crate::manifold::Intolerance;
use crate::report::{Figure, RobotFigure, figure_png, figure_svg, plain, write_bytes};
use crate::study::spatial_robot;
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
    let bytes = match out.extension().and_then(|extension| extension.to_str()) {
        Some("png") => with_figure(robot, figure_png),
        Some("svg") => with_figure(robot, |figure| figure_svg(figure).map(String::into_bytes)),
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

/// Hands over the drawing of a robot: planar ones from above, all others in space.
fn with_figure<T>(robot: &Robot, write: impl FnOnce(&dyn Figure) -> T) -> T {
    let title = robot.name.clone();
    if let Ok(chain) = robot.planar_chain() {
        return write(&RobotFigure {
            title,
            links: &chain.lengths,
            unrestricted: PlanarPosition::unrestricted_radii(&chain.lengths),
        });
    }
    write(&spatial_robot(robot, title))
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
        text += &line(
            &format!("degree of redundancy, {task}:"),
            &degree.to_string(),
        );
        if let Some(verdict) = Intolerance::of(robot, task, |_| true) {
            text += &line(&format!("fault tolerance, {task}:"), &verdict.to_string());
        }
    }
    text + &extent_lines(robot)
}

/// How far the robot reaches, seen from joint 1.
fn extent_lines(robot: &Robot) -> String {
    let Some(extent) = workspace_extent(robot) else {
        return line(
            "reach from joint 1:",
            "not limited: a prismatic joint has no limits",
        );
    };
    let shown = |value: f64| format!("{} m", plain(value));
    let heights = format!("{} to {}", plain(extent.lower), shown(extent.upper));
    let mut text = line("reach from joint 1:", &shown(extent.reach));
    text += &line("radius about the axis of joint 1:", &shown(extent.radius));
    if robot.planar_chain().is_err() {
        text += &line("height along the axis of joint 1:", &heights);
    }
    text
}

fn line(label: &str, value: &str) -> String {
    format!("{label:<40} {value}\n")
}

/// A planar robot does tasks in its plane, any other one tasks in space, if it has the joints.
fn can_do(robot: &Robot, task: TaskSpace) -> bool {
    task.is_planar() == robot.planar_chain().is_ok() && robot.degree_of_redundancy(task) >= 0
}
