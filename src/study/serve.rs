//! Which estimator can serve which robot and task.

use super::file::StudyFile;
use crate::design::{Robot, TaskSpace};
use crate::diagnostic::{Place, Problem, Problems};

/// Names the estimator for everything "exact" cannot serve.
const HYBRID: &str = "\"hybrid\" is the estimator for this, but this version does not have it";

/// Most joints of a planar pose task that is measured exactly.
const MAX_POSE_JOINTS: usize = 5;

/// Reports the first reason why the study's estimator cannot measure the robot's workspace.
pub(super) fn check(file: &StudyFile, problems: &Problems, robot: &Robot) {
    let task = file.space.value;
    if robot.degree_of_redundancy(task) < 1 {
        report_no_redundancy(file, problems, robot);
        return;
    }
    let method = file.estimator.method.as_ref().map(|item| &item.place);
    let at = |place| method.unwrap_or(place);
    if !task.is_planar() {
        let found = format!("the task \"{task}\"");
        let expected = "\"planar-position\" or \"planar-pose\"";
        refuse(problems, at(&file.space.place), found, expected);
    } else if let Err(not_planar) = robot.planar_chain() {
        let found = format!("the robot `{}`: {}", robot.name, not_planar.reason);
        let expected = "a planar chain of revolute joints";
        refuse(problems, at(&file.design.place), found, expected);
    } else if robot.physical_limits.is_some() {
        let found = format!("the robot `{}` with physical limits", robot.name);
        let expected = "a robot without `[physical_limits]`";
        refuse(problems, at(&file.design.place), found, expected);
    } else if task == TaskSpace::PlanarPose && robot.joints() > MAX_POSE_JOINTS {
        let found = format!("{} joints for the task \"{task}\"", robot.joints());
        let expected = format!("4 to {MAX_POSE_JOINTS} joints");
        refuse(problems, at(&file.space.place), found, &expected);
    }
}

fn refuse(problems: &Problems, place: &Place, found: String, expected: &str) {
    let problem = Problem {
        message: "the estimator \"exact\" cannot serve this robot and task".into(),
        found,
        expected: expected.to_owned(),
        help: HYBRID.into(),
    };
    problems.report(place, problem);
}

fn report_no_redundancy(file: &StudyFile, problems: &Problems, robot: &Robot) {
    let task = file.space.value;
    let (n, m) = (robot.joints(), task.dimension());
    let problem = Problem {
        message: "the robot needs more joints than the task has dimensions".into(),
        found: format!("{n} joints (`{}`) for {m} dimensions", robot.name),
        expected: format!("at least {} joints", m + 1),
        help: "choose a task of fewer dimensions or a robot with more joints".into(),
    };
    problems.report(&file.space.place, problem);
}
