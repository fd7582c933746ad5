//! Which estimator serves which robot and task.

use super::file::StudyFile;
use super::settings::EstimatorMethod;
use crate::design::{JointKind, Robot, TaskSpace};
use crate::diagnostic::{Place, Problem, Problems};
use crate::kinematics::joint_scales;
use crate::manifold::MOST_REDUNDANT;

/// Names the estimator for everything "exact" cannot serve.
const HYBRID: &str = "use `method = \"hybrid\"`, which serves this";

/// What is wrong wherever pre-images are needed and cannot be had.
const CANNOT_TRACE: &str = "this version cannot trace the self-motion of this robot and task";

/// Most joints of a planar pose task that is measured exactly.
const MAX_POSE_JOINTS: usize = 5;

/// Highest degree of redundancy n − m whose pre-images can be traced.
const MAX_REDUNDANCY: isize = MOST_REDUNDANT as isize;

/// Degree of redundancy whose pre-images are curves, which can be listed.
const CURVES: isize = 1;

/// The estimator that measures the study's workspaces. What it cannot serve is reported.
pub(super) fn choose(file: &StudyFile, problems: &Problems, robot: &Robot) -> EstimatorMethod {
    let given = file.estimator.method.as_ref();
    let exact = exact_refusal(file, robot);
    let method = match given {
        Some(item) => item.value,
        // Whoever writes the table means it.
        None if file.estimator.hybrid.is_some() => EstimatorMethod::Hybrid,
        None if file.estimator.surrogate.is_some() => EstimatorMethod::Surrogate,
        None if exact.is_none() => EstimatorMethod::Exact,
        None => EstimatorMethod::Hybrid,
    };
    if robot.degree_of_redundancy(file.space.value) < 1 {
        report_no_redundancy(file, problems, robot);
        return method;
    }
    let refusal = match method {
        EstimatorMethod::Exact | EstimatorMethod::Surrogate => exact,
        EstimatorMethod::Hybrid => {
            refuse_exact_only(file, problems);
            if let (JointKind::Prismatic, Some(table)) =
                (robot.joint_kind(0), &file.estimator.hybrid)
            {
                table.refuse_turns(problems);
            }
            hybrid_refusal(file, robot)
        }
    };
    if let Some(Refusal { place, problem }) = refusal {
        problems.report(given.map_or(place, |item| &item.place), problem);
    }
    method
}

/// Reports why the configurations that hold a pose cannot be found.
pub(super) fn check_manifolds(file: &StudyFile, problems: &Problems, robot: &Robot) {
    check_redundancy(file, problems, robot, MAX_REDUNDANCY);
}

/// Reports why self-motion manifolds cannot be traced as curves.
pub(super) fn check_curves(file: &StudyFile, problems: &Problems, robot: &Robot) {
    check_redundancy(file, problems, robot, CURVES);
}

fn check_redundancy(file: &StudyFile, problems: &Problems, robot: &Robot, most: isize) {
    if robot.degree_of_redundancy(file.space.value) < 1 {
        report_no_redundancy(file, problems, robot);
    } else if let Some(Refusal { place, problem }) = manifold_refusal(file, robot, most) {
        problems.report(place, problem);
    }
}

/// Reports why surrogates cannot stand for this robot and task: they learn exact workspaces.
pub(super) fn check_surrogate(file: &StudyFile, problems: &Problems, robot: &Robot) {
    if robot.degree_of_redundancy(file.space.value) < 1 {
        report_no_redundancy(file, problems, robot);
    } else if let Some(Refusal { place, mut problem }) = exact_refusal(file, robot) {
        problem.message = "surrogates learn from exact workspaces, which this has not".into();
        problem.help = "choose a planar robot and task".into();
        problems.report(place, problem);
    }
}

/// Reports why singular configurations cannot be searched: any degree of redundancy will do.
pub(super) fn check_singularities(file: &StudyFile, problems: &Problems, robot: &Robot) {
    if robot.degree_of_redundancy(file.space.value) < 0 {
        report_no_redundancy(file, problems, robot);
        return;
    }
    if let Some(Refusal { place, problem }) = manifold_refusal(file, robot, isize::MAX / 2) {
        problems.report(place, problem);
    }
}

/// Reports why the workspaces of this robot and task cannot be sampled.
pub(super) fn check_atlas(file: &StudyFile, problems: &Problems, robot: &Robot) {
    if robot.degree_of_redundancy(file.space.value) < 1 {
        report_no_redundancy(file, problems, robot);
    } else if let Some(Refusal { place, problem }) = manifold_refusal(file, robot, MAX_REDUNDANCY) {
        problems.report(place, problem);
    }
}

/// Why a study cannot be served, and where that is to be mended.
struct Refusal<'f> {
    place: &'f Place,
    problem: Problem,
}

fn exact_refusal<'f>(file: &'f StudyFile, robot: &Robot) -> Option<Refusal<'f>> {
    let task = file.space.value;
    let (place, found, expected) = if !task.is_planar() {
        let expected = "\"planar-position\" or \"planar-pose\"";
        let found = format!("the task \"{task}\"");
        (&file.space.place, found, expected.to_owned())
    } else if let Err(not_planar) = robot.planar_chain() {
        let found = format!("the robot `{}`: {}", robot.name, not_planar.reason);
        let expected = "a planar chain of revolute joints";
        (&file.design.place, found, expected.to_owned())
    } else if robot.physical_limits.is_some() {
        let found = format!("the robot `{}` with physical limits", robot.name);
        let expected = "a robot without `[physical_limits]`";
        (&file.design.place, found, expected.to_owned())
    } else if task == TaskSpace::PlanarPose && robot.joints() > MAX_POSE_JOINTS {
        let found = format!("{} joints for the task \"{task}\"", robot.joints());
        let expected = format!("4 to {MAX_POSE_JOINTS} joints");
        (&file.space.place, found, expected)
    } else {
        return None;
    };
    let message = "the estimator \"exact\" cannot serve this robot and task";
    // Where "hybrid" has its own reason to refuse, that is the better hint.
    let help = match hybrid_refusal(file, robot) {
        None => HYBRID.to_owned(),
        Some(other) => format!(
            "\"hybrid\" cannot either: it expects {}",
            other.problem.expected
        ),
    };
    refusal(place, message, found, expected, help)
}

/// The atlas holds pre-images of up to [`MAX_REDUNDANCY`] degrees of redundancy; of curves alone
/// where joint 1 slides, whose stroke would be a wall of every surface.
fn hybrid_refusal<'f>(file: &'f StudyFile, robot: &Robot) -> Option<Refusal<'f>> {
    if robot.joint_kind(0) == JointKind::Revolute {
        return manifold_refusal(file, robot, MAX_REDUNDANCY);
    }
    let degree = robot.degree_of_redundancy(file.space.value);
    if degree > CURVES {
        let found = format!(
            "the robot `{}`, whose joint 1 is prismatic, with a degree of redundancy of {degree}",
            robot.name
        );
        let expected = "one joint more than the task has dimensions where joint 1 slides";
        let help = "choose a task of more dimensions, or a robot whose joint 1 turns";
        return refusal(&file.design.place, CANNOT_TRACE, found, expected, help);
    }
    chain_refusal(file, robot, CURVES).or_else(|| stroke_refusal(file, robot))
}

/// Pre-images are traced for at most `most` degrees of redundancy, about a revolute joint 1.
fn manifold_refusal<'f>(file: &'f StudyFile, robot: &Robot, most: isize) -> Option<Refusal<'f>> {
    let turning = || first_joint_refusal(file, robot);
    let refused = chain_refusal(file, robot, most).or_else(turning);
    refused.or_else(|| stroke_refusal(file, robot))
}

/// The robot is of the right kind for the task, with at most `most` degrees of redundancy.
fn chain_refusal<'f>(file: &'f StudyFile, robot: &Robot, most: isize) -> Option<Refusal<'f>> {
    let task = file.space.value;
    let design = &file.design.place;
    let name = &robot.name;
    let degree = robot.degree_of_redundancy(task);
    let message = CANNOT_TRACE;
    if degree > most {
        let found = format!(
            "{} joints: a degree of redundancy of {degree}",
            robot.joints()
        );
        let most = task.dimension() as isize + most;
        let expected = format!("at most {most} joints for \"{task}\"");
        let help = "choose a task of more dimensions or a robot with fewer joints";
        return refusal(&file.space.place, message, found, expected, help);
    }
    if let (true, Err(not_planar)) = (task.is_planar(), robot.planar_chain()) {
        let found = format!("the robot `{name}`: {}", not_planar.reason);
        let expected = "a planar chain of revolute joints, because the task is planar";
        let help = "choose a spatial task, or a planar robot";
        return refusal(design, message, found, expected, help);
    }
    if !task.is_planar() && robot.planar_chain().is_ok() {
        let found = format!("the robot `{name}`, which moves in a plane");
        let expected = "a robot whose axes are not all parallel, because the task is spatial";
        let help = "choose a planar task";
        return refusal(design, message, found, expected, help);
    }
    None
}

/// Joint 1 turns.
fn first_joint_refusal<'f>(file: &'f StudyFile, robot: &Robot) -> Option<Refusal<'f>> {
    if robot.joint_kind(0) == JointKind::Revolute {
        return None;
    }
    let found = format!("the robot `{}`, whose joint 1 is prismatic", robot.name);
    let expected = "a revolute joint 1, about which the workspace is turned";
    let help = "choose a robot whose joint 1 turns; the estimator \"hybrid\" serves the others";
    refusal(&file.design.place, CANNOT_TRACE, found, expected, help)
}

/// A stroke sets the scale of every prismatic joint.
fn stroke_refusal<'f>(file: &'f StudyFile, robot: &Robot) -> Option<Refusal<'f>> {
    if joint_scales(robot).is_some() {
        return None;
    }
    let prismatic = |index: &usize| robot.joint_kind(*index) == JointKind::Prismatic;
    let number = (0..robot.joints()).find(prismatic).map_or(0, |k| k + 1);
    let found = format!(
        "joint {number} of `{}`, which slides without end",
        robot.name
    );
    let expected = "physical limits of every prismatic joint";
    let help = "add `lower` and `upper` to `[physical_limits]` of the robot file";
    refusal(&file.design.place, CANNOT_TRACE, found, expected, help)
}

/// Link lengths are searched with the exact estimator alone, radii likewise.
fn refuse_exact_only(file: &StudyFile, problems: &Problems) {
    let search = file.search.as_ref().map(|item| &item.value);
    let bounds = search.and_then(|s| s.link_lower.as_ref().or(s.link_upper.as_ref()));
    if let Some(bounds) = bounds {
        problems.reject(
            &bounds.place,
            "link lengths cannot be searched with the estimator \"hybrid\" in this version",
            "a search for limits alone",
            "remove `link_lower` and `link_upper`, or use `method = \"exact\"`",
        );
    }
    let estimate = file.estimate.as_ref().map(|item| &item.value);
    let radii = estimate.and_then(|estimate| estimate.radii.as_ref());
    if let Some(radii) = radii.filter(|radii| !radii.value.is_empty()) {
        problems.reject(
            &radii.place,
            "the estimator \"hybrid\" reports no rotation sets at radii",
            "no `radii`",
            "remove `radii`; `kind = \"manifolds\"` gives the rotation set of one pose",
        );
    }
}

fn refusal<'f>(
    place: &'f Place,
    message: &str,
    found: String,
    expected: impl Into<String>,
    help: impl Into<String>,
) -> Option<Refusal<'f>> {
    let problem = Problem {
        message: message.to_owned(),
        found,
        expected: expected.into(),
        help: help.into(),
    };
    Some(Refusal { place, problem })
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
