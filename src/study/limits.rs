//! Checks limits, the narrowest widths and the bounds of link lengths against the robot.

use super::file::{LimitsTable, MAX_LENGTH, StudyFile};
use super::search::SearchTable;
use super::settings::{DegreeLimits, LinkBounds, Search};
use crate::design::{JointKind, Robot};
use crate::diagnostic::{Item, Place, Problem, Problems};

/// Widths may exceed 360° by this much, degrees: the round-off of sums in other programs.
const WIDTH_TOLERANCE_DEG: f64 = 1e-9;

/// Shortest link in a search, metres, as in a robot file.
const MIN_LENGTH: f64 = 1e-6;

/// The limits, if there is one pair per joint, in order and, of revolute joints, at most 360°
/// apart.
pub(super) fn check(
    table: &LimitsTable,
    problems: &Problems,
    robot: &Robot,
) -> Option<DegreeLimits> {
    let turning = numbers(robot, JointKind::Revolute);
    let sliding = numbers(robot, JointKind::Prismatic);
    let lower = check_count(&table.lower_deg, problems, turning.len(), robot);
    let upper = check_count(&table.upper_deg, problems, turning.len(), robot);
    let slides = check_slides(table, problems, &sliding, robot);
    let (lower, upper) = (lower?, upper?);
    for (number, (lower, upper)) in turning.iter().zip(lower.iter().zip(upper)) {
        let width = upper.value - lower.value;
        if width < 0.0 {
            let message = format!("the upper limit of joint {number} is below its lower limit");
            let expected = format!("at least the lower limit {}", lower.value);
            let help = "swap the two limits; to cross ±180°, write e.g. [170, 190]";
            problems.reject(&upper.place, &message, &expected, help);
        } else if width > 360.0 + WIDTH_TOLERANCE_DEG {
            let message = format!("the limits of joint {number} are more than 360° apart");
            let expected = format!("at most {}", lower.value + 360.0);
            let help = "write the full circle as [-180, 180]";
            problems.reject(&upper.place, &message, &expected, help);
        }
    }
    let [least, most] = slides?;
    Some(DegreeLimits {
        lower_deg: values(lower),
        upper_deg: values(upper),
        lower: least,
        upper: most,
    })
}

/// Numbers of the robot's joints of one kind.
fn numbers(robot: &Robot, kind: JointKind) -> Vec<usize> {
    let joints = 1..=robot.joints();
    joints
        .filter(|number| robot.joint_kind(number - 1) == kind)
        .collect()
}

/// Limits of the prismatic joints `sliding`, metres; none for a robot without them.
fn check_slides(
    table: &LimitsTable,
    problems: &Problems,
    sliding: &[usize],
    robot: &Robot,
) -> Option<[Vec<f64>; 2]> {
    let mut ends = [Vec::new(), Vec::new()];
    let keys = ["lower", "upper"];
    for ((end, item), key) in ends.iter_mut().zip([&table.lower, &table.upper]).zip(keys) {
        match item {
            Some(item) => *end = values(check_count(item, problems, sliding.len(), robot)?),
            None if sliding.is_empty() => {}
            None => {
                let place = Place {
                    key: format!("limits.{key}"),
                    span: table.lower_deg.place.span.clone(),
                };
                let problem = Problem {
                    message: "the robot's prismatic joints need limits in metres".into(),
                    found: "nothing".into(),
                    expected: format!("the key `{key}`, one entry per prismatic joint"),
                    help: format!("add `{key} = […]`"),
                };
                problems.report_absent(&place, problem);
                return None;
            }
        }
    }
    let upper = table.upper.iter().flat_map(|item| &item.value);
    for ((number, lower), upper) in sliding.iter().zip(&ends[0]).zip(upper) {
        if upper.value < *lower {
            let message = format!("the upper limit of joint {number} is below its lower limit");
            let expected = format!("at least the lower limit {lower}");
            problems.reject(&upper.place, &message, &expected, "swap the two limits");
        }
    }
    Some(ends)
}

/// Reports the first candidate of an optimisation if it lies outside the search space.
pub(super) fn check_start(
    table: &LimitsTable,
    start: &DegreeLimits,
    problems: &Problems,
    min_width_deg: f64,
) {
    let pairs = start.lower_deg.iter().zip(&start.upper_deg);
    for (number, ((lower, upper), item)) in (1..).zip(pairs.zip(&table.upper_deg.value)) {
        if upper - lower < min_width_deg - WIDTH_TOLERANCE_DEG {
            let message = format!("the limits of joint {number} are too close for the search");
            let expected = format!(
                "at least {} (`search.min_width_deg`)",
                lower + min_width_deg
            );
            let help = "widen the limits, or lower `min_width_deg`";
            problems.reject(&item.place, &message, &expected, help);
        }
    }
}

/// The search space.
pub(super) fn search(file: &StudyFile, problems: &Problems, robot: &Robot) -> Search {
    let table = file.search.as_ref();
    let min_width = table.and_then(|table| table.value.min_width_deg.as_ref());
    Search {
        min_width_deg: min_width.map_or(0.0, |item| item.value),
        links: table.and_then(|table| link_bounds(table, problems, robot)),
    }
}

fn link_bounds(
    table: &Item<SearchTable>,
    problems: &Problems,
    robot: &Robot,
) -> Option<LinkBounds> {
    let table = &table.value;
    bounds(&table.link_lower, &table.link_upper, problems, robot)
}

/// Bounds of link lengths whose sum can be the robot's.
pub(super) fn bounds(
    lower: &Option<Item<Vec<Item<f64>>>>,
    upper: &Option<Item<Vec<Item<f64>>>>,
    problems: &Problems,
    robot: &Robot,
) -> Option<LinkBounds> {
    let (lower, upper) = match (lower, upper) {
        (Some(lower), Some(upper)) => (lower, upper),
        (None, None) => return None,
        (Some(given), None) => return report_lone(problems, &given.place, "link_upper"),
        (None, Some(given)) => return report_lone(problems, &given.place, "link_lower"),
    };
    let joints = robot.joints();
    let (low, high) = (
        check_count(lower, problems, joints, robot),
        check_count(upper, problems, joints, robot),
    );
    let (low, high) = (low?, high?);
    for (number, (low, high)) in (1..).zip(low.iter().zip(high)) {
        if low.value < MIN_LENGTH {
            let message = format!("link {number} needs a positive length");
            let expected = format!("a length from {MIN_LENGTH} to {MAX_LENGTH} m");
            problems.reject(&low.place, &message, &expected, "give the length in metres");
        }
        if high.value < low.value {
            let message = format!("the longest link {number} is shorter than the shortest");
            let expected = format!("at least {} m", low.value);
            problems.reject(&high.place, &message, &expected, "swap the two lengths");
        }
    }
    let bounds = LinkBounds {
        link_lower: values(low),
        link_upper: values(high),
    };
    check_total(&bounds, [&lower.place, &upper.place], problems, robot);
    Some(bounds)
}

/// Reports bounds that leave no way to share out the robot's total length.
fn check_total(bounds: &LinkBounds, places: [&Place; 2], problems: &Problems, robot: &Robot) {
    // A robot that is no planar chain is refused elsewhere.
    let Ok(chain) = robot.planar_chain() else {
        return;
    };
    let total = chain.total_length();
    let slack = 1e-12 * total;
    let least: f64 = bounds.link_lower.iter().sum();
    let most: f64 = bounds.link_upper.iter().sum();
    let report = |place: &Place, sum: f64, expected: String| {
        let problem = Problem {
            message: "the total length of the robot cannot be kept".into(),
            found: format!("lengths that sum to {sum} m"),
            expected: format!("{expected} the robot's total of {total} m"),
            help: "the search keeps the total length; change the bounds".into(),
        };
        problems.report(place, problem);
    };
    if least > total + slack {
        report(places[0], least, "at most".into());
    }
    if most < total - slack {
        report(places[1], most, "at least".into());
    }
}

fn report_lone(problems: &Problems, place: &Place, missing: &str) -> Option<LinkBounds> {
    let problem = Problem {
        message: "bounds of link lengths need both ends".into(),
        found: format!("`{}` alone", place.key),
        expected: format!("`{missing}` beside it"),
        help: format!("add `{missing} = […]`, or remove `{}`", place.key),
    };
    problems.report(place, problem);
    None
}

/// The entries, if there are `count`: one per joint of the kind they are for.
fn check_count<'i>(
    items: &'i Item<Vec<Item<f64>>>,
    problems: &Problems,
    count: usize,
    robot: &Robot,
) -> Option<&'i [Item<f64>]> {
    if items.value.len() == count {
        return Some(&items.value);
    }
    let mixed = count != robot.joints();
    let problem = Problem {
        message: "needs one entry per joint".into(),
        found: format!("{} entries", items.value.len()),
        expected: match mixed {
            false => format!("{count} entries, one for each joint of the robot"),
            true => format!("{count} entries, one for each joint of this kind"),
        },
        help: match mixed {
            false => "give one entry per joint, base first".into(),
            true => "degrees (`lower_deg`, `upper_deg`) for revolute joints, metres (`lower`, \
                     `upper`) for prismatic ones, base first"
                .into(),
        },
    };
    problems.report(&items.place, problem);
    None
}

fn values(items: &[Item<f64>]) -> Vec<f64> {
    items.iter().map(|item| item.value).collect()
}
