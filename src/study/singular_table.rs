//! The tables `[singularities]`, `[largest-manifold]` and `[failure-experiment]`: read as written,
//! then checked against the robot.

use super::file::{MAX_DEGREES, MAX_LENGTH};
use super::singular_settings::{
    Configuration, FailureStudy, LargestSearch, NamedGoal, SingularitySearch,
};
use crate::design::{JointKind, Robot};
use crate::diagnostic::{Entry, Item, Place, Problem, Problems, Table};

/// The table `[failure-experiment]` as written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FailureTable {
    locks: Option<u64>,
    random_starts: Option<u64>,
    start: ConfigurationTable,
    goals: Vec<(Item<String>, ConfigurationTable)>,
}

/// A configuration as written: degrees and metres.
#[derive(Clone, Debug, PartialEq)]
struct ConfigurationTable {
    turns: Item<Vec<Item<f64>>>,
    slides: Option<Item<Vec<Item<f64>>>>,
}

/// Most random starts: more would take days.
const MOST_STARTS: u64 = 1_000_000;

/// Reads `[singularities]`.
pub(super) fn read_singularities(root: &Table) -> Option<Item<SingularitySearch>> {
    let table = root.table("singularities", &["starts", "max_rank_loss", "merge_deg"])?;
    let default = SingularitySearch::default();
    let whole = |key, range, default| table.integer(key, range).map_or(default, |i| i.value);
    let merge = table.number("merge_deg", 1e-6..=30.0, " degrees");
    Some(Item {
        value: SingularitySearch {
            starts: whole("starts", 1..=MOST_STARTS, default.starts),
            max_rank_loss: whole("max_rank_loss", 1..=6, default.max_rank_loss),
            merge_deg: merge.map_or(default.merge_deg, |item| item.value),
        },
        place: root.key_place("singularities")?,
    })
}

/// Reads `[largest-manifold]`.
pub(super) fn read_largest(root: &Table) -> Option<Item<LargestSearch>> {
    let keys = &["finalists", "evaluations", "pareto_rounds", "comparison"];
    let table = root.table("largest-manifold", keys)?;
    let default = LargestSearch::default();
    let whole = |key, range, default| table.integer(key, range).map_or(default, |i| i.value);
    Some(Item {
        value: LargestSearch {
            finalists: whole("finalists", 0..=100, default.finalists),
            evaluations: whole("evaluations", 1..=100_000, default.evaluations),
            pareto_rounds: whole("pareto_rounds", 0..=100, default.pareto_rounds),
            comparison: whole("comparison", 0..=100_000, default.comparison),
        },
        place: root.key_place("largest-manifold")?,
    })
}

/// Reads `[failure-experiment]`.
pub(super) fn read_failure(root: &Table) -> Option<Item<FailureTable>> {
    let keys = &["locks", "random_starts", "start_deg", "start", "goals"];
    let table = root.table("failure-experiment", keys)?;
    table.require("start_deg", "start_deg = [0, 0, 0]");
    table.require(
        "goals",
        "goals = [ { name = \"A\", theta_deg = [10, 20, 30] } ]",
    );
    let start = read_configuration(&table, "start_deg", "start");
    let goals = table.entry("goals").and_then(|entry| {
        let entries = entry.array("an array of goals, each `{ name = …, theta_deg = […] }`")?;
        if entries.is_empty() {
            let help = "name at least one goal";
            table
                .problems()
                .reject(entry.place(), "there is no goal", "at least one goal", help);
        }
        entries.iter().map(read_goal).collect::<Option<Vec<_>>>()
    });
    let locks = table.integer("locks", 2..=10_000).map(|item| item.value);
    let starts = table
        .integer("random_starts", 0..=10_000)
        .map(|item| item.value);
    Some(Item {
        value: FailureTable {
            locks,
            random_starts: starts,
            start: start?,
            goals: goals?,
        },
        place: root.key_place("failure-experiment")?,
    })
}

fn read_goal(entry: &Entry) -> Option<(Item<String>, ConfigurationTable)> {
    let table = entry.table(&["name", "theta_deg", "theta"])?;
    table.require("name", "name = \"A\"");
    table.require("theta_deg", "theta_deg = [10, 20, 30]");
    let name = table.text("name");
    let configuration = read_configuration(&table, "theta_deg", "theta");
    Some((name?, configuration?))
}

fn read_configuration(table: &Table, turns: &str, slides: &str) -> Option<ConfigurationTable> {
    let turns = table.numbers(turns, -MAX_DEGREES..=MAX_DEGREES, " degrees");
    let slides = table.numbers(slides, -MAX_LENGTH..=MAX_LENGTH, " m");
    Some(ConfigurationTable {
        turns: turns?,
        slides,
    })
}

/// The experiment, if its configurations fit the robot and its physical limits.
pub(super) fn failure(
    table: &FailureTable,
    robot: &Robot,
    problems: &Problems,
) -> Option<FailureStudy> {
    let start = configuration(&table.start, robot, problems)?;
    let mut goals: Vec<NamedGoal> = Vec::new();
    for (name, written) in &table.goals {
        if goals.iter().any(|goal| goal.name == name.value) {
            let help = "give each goal a name of its own";
            problems.reject(
                &name.place,
                "two goals have one name",
                "different names",
                help,
            );
        }
        goals.push(NamedGoal {
            name: name.value.clone(),
            configuration: configuration(written, robot, problems)?,
        });
    }
    Some(FailureStudy {
        locks: table.locks.unwrap_or(25),
        random_starts: table.random_starts.unwrap_or(6),
        start_deg: start.theta_deg,
        start: start.theta,
        goals,
    })
}

fn configuration(
    written: &ConfigurationTable,
    robot: &Robot,
    problems: &Problems,
) -> Option<Configuration> {
    let turning = joints_of(robot, JointKind::Revolute);
    let sliding = joints_of(robot, JointKind::Prismatic);
    let fits = check_count(&written.turns, &turning, "revolute", problems);
    let slides = match (&written.slides, sliding.is_empty()) {
        (Some(slides), _) => check_count(slides, &sliding, "prismatic", problems).then_some(slides),
        (None, true) => None,
        (None, false) => {
            report_missing_slides(&written.turns.place, sliding.len(), problems);
            return None;
        }
    };
    if !fits || (written.slides.is_some() && slides.is_none()) {
        return None;
    }
    check_limits(
        &written.turns,
        &turning,
        180.0 / std::f64::consts::PI,
        robot,
        problems,
    );
    if let Some(slides) = slides {
        check_limits(slides, &sliding, 1.0, robot, problems);
    }
    let values = |item: &Item<Vec<Item<f64>>>| item.value.iter().map(|i| i.value).collect();
    Some(Configuration {
        theta_deg: values(&written.turns),
        theta: slides.map(values).unwrap_or_default(),
    })
}

fn joints_of(robot: &Robot, kind: JointKind) -> Vec<usize> {
    (0..robot.joints())
        .filter(|&k| robot.joint_kind(k) == kind)
        .collect()
}

fn check_count(
    written: &Item<Vec<Item<f64>>>,
    joints: &[usize],
    word: &str,
    problems: &Problems,
) -> bool {
    if written.value.len() == joints.len() {
        return true;
    }
    let problem = Problem {
        message: format!("a configuration needs one entry per {word} joint"),
        found: format!("{} entries", written.value.len()),
        expected: format!("{} entries", joints.len()),
        help: "degrees for revolute joints; metres for prismatic ones, in a key of their own"
            .into(),
    };
    problems.report(&written.place, problem);
    false
}

fn report_missing_slides(place: &Place, count: usize, problems: &Problems) {
    let problem = Problem {
        message: "the robot has prismatic joints".into(),
        found: "angles alone".into(),
        expected: format!("positions of {count} prismatic joints, metres"),
        help: "add `start = […]` or, in a goal, `theta = […]`".into(),
    };
    problems.report(place, problem);
}

/// Reports joints outside the physical limits, `unit` file units per radian or metre.
fn check_limits(
    written: &Item<Vec<Item<f64>>>,
    joints: &[usize],
    unit: f64,
    robot: &Robot,
    problems: &Problems,
) {
    let Some(limits) = &robot.physical_limits else {
        return;
    };
    for (item, &joint) in written.value.iter().zip(joints) {
        let [low, high] = [limits.lower[joint], limits.upper[joint]].map(|end| end * unit);
        let free = unit > 1.0 && high - low >= 360.0 - 1e-6;
        if !free && !(low - 1e-9..=high + 1e-9).contains(&item.value) {
            problems.reject(
                &item.place,
                &format!("joint {} is outside its physical limits", joint + 1),
                &format!("{low:.4} to {high:.4}"),
                "choose a configuration that the robot can take",
            );
        }
    }
}
