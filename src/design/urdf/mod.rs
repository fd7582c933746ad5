//! Reads a robot from a URDF file, the chain of joints from a base link to a tip link, and writes
//! one.
//!
//! The file is first read as XML, which tells where everything stands; a plain copy of its
//! joints then goes to the URDF reader. Meshes, masses, branches and extensions are ignored.

mod chain;
mod shape;
mod tree;
mod write;
mod xml;

use super::file::{MAX_LENGTH, check_joint_count};
use super::{FrameChain, PhysicalLimits};
use crate::diagnostic::{InputError, Item, Problem, Source, Table};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use tree::Tree;
pub use write::robot_to_urdf;
use xml::{Xml, head, joint_name, problem};

/// Largest length (metres) or angle (radians) in a URDF file.
const MAX_NUMBER: f64 = MAX_LENGTH;

/// What is read from a URDF file.
pub(super) struct UrdfArm {
    /// The chain from base to tip.
    pub chain: FrameChain,
    /// The limits of its joints, if the robot file does not switch them off.
    pub limits: Option<PhysicalLimits>,
    /// The file itself.
    pub source: Source,
}

/// A mistake in the URDF file, or in a key of the robot file seen beside it.
enum Fault {
    File(InputError),
    Key(&'static str, Problem),
}

impl From<InputError> for Fault {
    fn from(error: InputError) -> Fault {
        Fault::File(error)
    }
}

/// Reads `urdf`, `base`, `tip` and `use_urdf_limits`. `file` is the robot file's name: the URDF
/// file is found relative to it.
pub(super) fn read(root: &Table, file: &str) -> Option<UrdfArm> {
    let path = root.text("urdf");
    let [base, tip] = ["base", "tip"].map(|key| root.text(key));
    let wants_limits = root
        .boolean("use_urdf_limits")
        .is_none_or(|item| item.value)
        && root.entry("physical_limits").is_none();
    let path = path?;
    let source = open(root, file, &path)?;
    let name = |item: Option<Item<String>>| item.map(|item| item.value);
    let (base, tip) = (name(base), name(tip));
    let read = parse(&source, base.as_deref(), tip.as_deref(), wants_limits);
    match read {
        Ok((chain, limits)) => {
            check_joint_count(root, &path, chain.joints.len());
            Some(UrdfArm {
                chain,
                limits,
                source,
            })
        }
        Err(Fault::File(error)) => {
            root.problems().pass_on(&path.place, error);
            None
        }
        Err(Fault::Key(key, problem)) => {
            let place = root.entry(key).map(|entry| entry.place().clone());
            root.problems()
                .report(&place.unwrap_or(path.place), problem);
            None
        }
    }
}

fn open(root: &Table, file: &str, path: &Item<String>) -> Option<Source> {
    let folder = Path::new(file).parent().unwrap_or(Path::new(""));
    let found = folder.join(&path.value);
    match Source::read(&found) {
        Ok(source) => Some(source),
        Err(error) if error.line().is_some() => {
            root.problems().pass_on(&path.place, error);
            None
        }
        Err(error) => {
            let problem = Problem {
                message: "cannot read the URDF file".into(),
                found: format!("`{}`: {}", found.display(), error.problem().found),
                expected: "a URDF file; its path is relative to the robot file".into(),
                help: "mend the path".into(),
            };
            root.problems().report(&path.place, problem);
            None
        }
    }
}

type Arm = (FrameChain, Option<PhysicalLimits>);

fn parse(
    source: &Source,
    base: Option<&str>,
    tip: Option<&str>,
    wants_limits: bool,
) -> Result<Arm, Fault> {
    let xml = Xml::parse(source)?;
    let nodes = xml.joints();
    let tree = Tree::read(&xml, &nodes, source.file())?;
    let joints = understand(&xml, &nodes)?;
    let chosen = tree.chain(base, tip)?;
    let read: Vec<chain::Read> = chosen.iter().map(|&k| (nodes[k], &joints[k])).collect();
    let frames = chain::frames(&xml, &read)?;
    if frames.joints.is_empty() {
        let problem = Problem {
            message: format!("the URDF file `{}` has no joint that moves", source.file()),
            found: format!("{} fixed joints between base and tip", read.len()),
            expected: "revolute, continuous or prismatic joints".into(),
            help: "choose another `base` or `tip`".into(),
        };
        return Err(Fault::Key("tip", problem));
    }
    let limits = match wants_limits {
        true => Some(chain::limits(&xml, &read)?),
        false => None,
    };
    Ok((frames, limits))
}

/// The joints as the URDF reader understands them, in the order of `nodes`.
fn understand(xml: &Xml, nodes: &[roxmltree::Node]) -> Result<Vec<urdf_rs::Joint>, InputError> {
    match read_plain(&xml.plain(nodes)) {
        Ok(joints) if joints.len() == nodes.len() => return Ok(joints),
        _ => {}
    }
    // Something is wrong with one of them: read them one by one to tell which.
    for node in nodes {
        if let Err(reason) = read_plain(&xml.plain(&[*node])) {
            let message = format!("joint `{}` is not as URDF has joints", joint_name(*node));
            let expected = "a joint with name, type, parent and child";
            return Err(xml.error(head(*node), problem(&message, reason, expected)));
        }
    }
    let found = "links and joints that the URDF reader refuses";
    Err(xml.error(0..0, problem("not a URDF file", found, "links and joints")))
}

fn read_plain(text: &str) -> Result<Vec<urdf_rs::Joint>, String> {
    // The copy leaves the reader nothing that is known to make it panic; should it all the same,
    // the user is to see a message.
    match catch_unwind(AssertUnwindSafe(|| urdf_rs::read_from_string(text))) {
        Ok(Ok(robot)) => Ok(robot.joints),
        Ok(Err(error)) => {
            let reason = error.to_string();
            Err(reason.trim_start_matches("custom: ").to_owned())
        }
        Err(_) => Err("something the reader does not understand".into()),
    }
}
