//! Reads a robot from its TOML file.

use super::rows::{self, ROW_EXAMPLE};
use super::{Geometry, Robot, physical_limits};
use crate::diagnostic::{Document, InputError, Item, Problem, Source, Table};
use std::path::Path;

/// Keys of a robot file.
const KEYS: &[&str] = &[
    "name",
    "source",
    "links",
    "convention",
    "joints",
    "urdf",
    "base",
    "tip",
    "physical_limits",
];

/// Longest length in a file, metres; far above any arm, far below where squares overflow.
pub(super) const MAX_LENGTH: f64 = 1e6;

/// Shortest planar link, metres: shorter ones are mistakes, and their squares vanish beside the
/// others'.
const MIN_LENGTH: f64 = 1e-6;

/// Most joints of a robot: more are a mistake, and every method here grows at least as fast as
/// the number of joints.
pub(super) const MAX_JOINTS: usize = 32;

/// Reads the robot file at `path`.
///
/// # Errors
/// The file cannot be read or does not describe a robot.
pub fn read_design(path: &Path) -> Result<Robot, InputError> {
    parse_design(&Source::read(path)?)
}

/// Reads a robot from the text of its file.
///
/// # Errors
/// The text does not describe a robot: the first mistake in file order.
pub fn parse_design(source: &Source) -> Result<Robot, InputError> {
    let document = Document::parse(source)?;
    let robot = read_robot(&document.root(KEYS));
    document.finish(robot)
}

fn read_robot(root: &Table) -> Option<Robot> {
    root.require("name", "name = \"my-robot\"");
    let name = root.text("name");
    if let Some(empty) = name.as_ref().filter(|name| name.value.trim().is_empty()) {
        let help = "name the robot, e.g. `name = \"my-robot\"`";
        root.problems()
            .reject(&empty.place, "the name is empty", "a name", help);
    }
    let source = root.text("source").map(|item| item.value);
    let geometry = read_geometry(root);
    let limits = geometry
        .as_ref()
        .and_then(|geometry| physical_limits::read(root, geometry));
    Some(Robot {
        name: name?.value,
        source,
        geometry: geometry?,
        physical_limits: limits,
    })
}

/// Exactly one of the three descriptions.
fn read_geometry(root: &Table) -> Option<Geometry> {
    let given: Vec<&str> = ["links", "joints", "urdf"]
        .into_iter()
        .filter(|key| root.entry(key).is_some())
        .collect();
    if let ["urdf"] = given[..] {
        return refuse_urdf(root);
    }
    for key in ["base", "tip"] {
        refuse_beside(root, key, "urdf");
    }
    match given[..] {
        ["links"] => {
            refuse_beside(root, "convention", "joints");
            read_links(root)
        }
        ["joints"] => rows::read(root),
        [] => {
            root.require("links", "links = [1.0, 1.0, 1.0]");
            None
        }
        [first, .., last] => {
            refuse_two(root, first, last);
            None
        }
        _ => None,
    }
}

fn read_links(root: &Table) -> Option<Geometry> {
    let links = root.numbers("links", -MAX_LENGTH..=MAX_LENGTH, " m")?;
    check_joint_count(root, &links, links.value.len());
    for (number, link) in (1..).zip(&links.value) {
        if link.value < MIN_LENGTH {
            root.problems().reject(
                &link.place,
                &format!("link {number} needs a positive length"),
                &format!("a length from {MIN_LENGTH} to {MAX_LENGTH} m"),
                "give the length in metres; to point a link backwards, shift its joint by 180°",
            );
        }
    }
    let lengths = links.value.iter().map(|link| link.value).collect();
    Some(Geometry::Planar { lengths })
}

/// Reports an array of fewer than 2 or more than [`MAX_JOINTS`] joints.
pub(super) fn check_joint_count<T>(root: &Table, array: &Item<T>, joints: usize) {
    if (2..=MAX_JOINTS).contains(&joints) {
        return;
    }
    let problem = Problem {
        message: "wrong number of joints".into(),
        found: format!("{joints}"),
        expected: format!("from 2 to {MAX_JOINTS} joints"),
        help: "give one entry per joint, base first".into(),
    };
    root.problems().report(&array.place, problem);
}

fn refuse_urdf(root: &Table) -> Option<Geometry> {
    let place = root.key_place("urdf")?;
    let problem = Problem {
        message: "URDF import is not available in this version".into(),
        found: "`urdf`".into(),
        expected: "`links` or `joints`".into(),
        help: format!(
            "describe the arm with `links = [1.0, 1.0, 1.0]` (planar) or `{ROW_EXAMPLE}`"
        ),
    };
    root.problems().report(&place, problem);
    None
}

fn refuse_two(root: &Table, first: &str, second: &str) {
    let places = [root.key_place(first), root.key_place(second)];
    let Some(later) = places.into_iter().flatten().max_by_key(|p| p.span.start) else {
        return;
    };
    let problem = Problem {
        message: "the robot is described twice".into(),
        found: format!("`{first}` and `{second}`"),
        expected: "exactly one of `links`, `joints`, `urdf`".into(),
        help: "remove all descriptions but one".into(),
    };
    root.problems().report(&later, problem);
}

/// Reports `key`, which only means something beside `partner`.
fn refuse_beside(root: &Table, key: &str, partner: &str) {
    if let Some(place) = root.key_place(key) {
        let problem = Problem {
            message: "this key means nothing here".into(),
            found: format!("`{key}` without `{partner}`"),
            expected: format!("`{key}` only beside `{partner}`"),
            help: "remove it".into(),
        };
        root.problems().report(&place, problem);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Convention, JointKind};
    use super::*;

    fn parse(text: &str) -> Result<Robot, InputError> {
        let robot = parse_design(&Source::new("r.toml", text))?;
        robot.check().unwrap();
        Ok(robot)
    }

    fn error(text: &str) -> InputError {
        parse(text).unwrap_err()
    }

    #[test]
    fn reads_the_planar_shorthand() {
        let robot = parse("name = 'r'\nsource = 'here'\nlinks = [1, 0.5]").unwrap();
        let lengths = vec![1.0, 0.5];
        assert_eq!(robot.geometry, Geometry::Planar { lengths });
        assert_eq!(robot.source.as_deref(), Some("here"));
    }

    #[test]
    fn reads_rows_with_offsets_in_the_variables_columns() {
        let text = "name = 'rp'\nconvention = 'modified'\njoints = [\n\
            { kind = 'revolute', alpha_deg = -90, a = 0.1, d = 0.2, theta_deg = 45 },\n\
            { kind = 'prismatic', d = 0.3 },\n]\n\
            [physical_limits]\nlower_deg = [-170]\nupper_deg = [170]\n\
            lower = [-0.1]\nupper = [0.4]\n";
        let robot = parse(text).unwrap();
        let Geometry::Rows { convention, joints } = &robot.geometry else {
            panic!("rows expected");
        };
        assert_eq!(*convention, Convention::Modified);
        assert_eq!(joints[0].link.twist, (-90f64).to_radians());
        assert_eq!(joints[1].kind, JointKind::Prismatic);
        assert_eq!((joints[1].link.offset, joints[1].link.length), (0.3, 0.0));
        let limits = robot.physical_limits.unwrap();
        assert_eq!(limits.lower, [(-170f64).to_radians(), -0.1]);
        assert_eq!(limits.upper, [170f64.to_radians(), 0.4]);
    }

    #[test]
    fn lengths_must_be_positive_and_finite() {
        for bad in ["-1.0", "0", "nan", "inf", "1e308", "'1'"] {
            let error = error(&format!("name = 'r'\nlinks = [\n 1.0,\n {bad}]"));
            assert_eq!((error.line(), error.key()), (Some(4), "links"));
        }
    }

    #[test]
    fn exactly_one_description() {
        assert_eq!(error("name = 'r'").key(), "links");
        let twice = error("name = 'r'\nlinks = [1, 1]\njoints = []");
        assert_eq!((twice.line(), twice.key()), (Some(3), "joints"));
        let urdf = error("name = 'r'\nurdf = 'arm.urdf'\nbase = 'a'\ntip = 'b'");
        assert!(urdf.problem().message.contains("not available"));
        assert_eq!(error("name='r'\nlinks=[1, 1]\nbase='a'").key(), "base");
        let convention = error("name='r'\nlinks=[1, 1]\nconvention='standard'");
        assert_eq!(convention.key(), "convention");
    }

    #[test]
    fn counts_and_orders_are_checked() {
        assert_eq!(error("name = 'r'\nlinks = [1]").problem().found, "1");
        let links = "name = 'r'\nlinks = [1, 1]\n[physical_limits]\n";
        let short = error(&format!("{links}lower_deg = [0]\nupper_deg = [1, 1]"));
        assert_eq!(short.key(), "physical_limits.lower_deg");
        let swapped = error(&format!("{links}lower_deg = [0, 9]\nupper_deg = [1, 1]"));
        assert_eq!(swapped.key(), "physical_limits.upper_deg");
        let metres = error(&format!(
            "{links}lower = [0, 0]\nlower_deg = [0, 0]\nupper_deg = [1, 1]"
        ));
        assert_eq!(metres.key(), "physical_limits.lower");
        assert_eq!(error(links).key(), "physical_limits.lower_deg");
        assert_eq!(error("links = [1, 1]").key(), "name");
        assert_eq!(error("name = ' '\nlinks = [1, 1]").key(), "name");
    }

    #[test]
    fn misspelt_keys_name_the_nearest() {
        let problem = error("name = 'r'\nlink = [1, 1]").problem().clone();
        assert_eq!(problem.help, "did you mean `links`?");
    }
}
