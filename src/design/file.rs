//! Reads a robot from its TOML file.

use super::rows;
use super::urdf::UrdfArm;
use super::{Geometry, PhysicalLimits, Robot, physical_limits, tool, urdf};
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
    "use_urdf_limits",
    "tool",
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

/// Reads a robot from the text of its file. A URDF file that it names is found relative to
/// `source`'s own name.
///
/// # Errors
/// The text does not describe a robot: the first mistake in file order.
pub fn parse_design(source: &Source) -> Result<Robot, InputError> {
    Ok(parse_design_files(source)?.robot)
}

/// A robot and what was read for it beside its own file.
#[derive(Clone, Debug, PartialEq)]
pub struct ParsedDesign {
    /// The robot.
    pub robot: Robot,
    /// The URDF file that the robot file names, if it names one.
    pub urdf: Option<Source>,
}

/// As [`parse_design`], with the text of the URDF file that was read.
///
/// # Errors
/// The text does not describe a robot: the first mistake in file order.
pub fn parse_design_files(source: &Source) -> Result<ParsedDesign, InputError> {
    let document = Document::parse(source)?;
    let design = read_robot(&document.root(KEYS), source.file());
    document.finish(design)
}

fn read_robot(root: &Table, file: &str) -> Option<ParsedDesign> {
    root.require("name", "name = \"my-robot\"");
    let name = root.text("name");
    if let Some(empty) = name.as_ref().filter(|name| name.value.trim().is_empty()) {
        let help = "name the robot, e.g. `name = \"my-robot\"`";
        root.problems()
            .reject(&empty.place, "the name is empty", "a name", help);
    }
    let source = root.text("source").map(|item| item.value);
    let description = read_description(root, file);
    let geometry = description.as_ref().map(|described| &described.geometry);
    let tool = tool::read(root, geometry);
    let limits = geometry.and_then(|geometry| physical_limits::read(root, geometry));
    let description = description?;
    let robot = Robot {
        name: name?.value,
        source,
        geometry: description.geometry,
        tool: tool?,
        physical_limits: limits.or(description.limits),
    };
    Some(ParsedDesign {
        robot,
        urdf: description.urdf,
    })
}

/// Links and joints, and what comes with them from a URDF file.
struct Description {
    geometry: Geometry,
    limits: Option<PhysicalLimits>,
    urdf: Option<Source>,
}

impl From<Geometry> for Description {
    fn from(geometry: Geometry) -> Description {
        Description {
            geometry,
            limits: None,
            urdf: None,
        }
    }
}

impl From<UrdfArm> for Description {
    fn from(arm: UrdfArm) -> Description {
        Description {
            geometry: Geometry::Frames(arm.chain),
            limits: arm.limits,
            urdf: Some(arm.source),
        }
    }
}

/// Exactly one of the three descriptions.
fn read_description(root: &Table, file: &str) -> Option<Description> {
    let given: Vec<&str> = ["links", "joints", "urdf"]
        .into_iter()
        .filter(|key| root.entry(key).is_some())
        .collect();
    if !given.contains(&"urdf") {
        for key in ["base", "tip", "use_urdf_limits"] {
            refuse_beside(root, key, "urdf");
        }
    }
    if !given.contains(&"joints") {
        refuse_beside(root, "convention", "joints");
    }
    match given[..] {
        ["links"] => read_links(root).map(Description::from),
        ["joints"] => rows::read(root).map(Description::from),
        [_] => urdf::read(root, file).map(Description::from),
        [] => {
            root.require("links", "links = [1.0, 1.0, 1.0]");
            None
        }
        [first, .., last] => {
            refuse_two(root, first, last);
            None
        }
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
        let urdf = error("name = 'r'\nurdf = 'no/such.urdf'\nbase = 'a'\ntip = 'b'");
        assert_eq!((urdf.line(), urdf.key()), (Some(2), "urdf"));
        assert_eq!(error("name='r'\nlinks=[1, 1]\nbase='a'").key(), "base");
        let limits = error("name='r'\nlinks=[1, 1]\nuse_urdf_limits=true");
        assert_eq!(limits.key(), "use_urdf_limits");
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
