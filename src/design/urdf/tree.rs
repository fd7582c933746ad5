//! The tree of links of a URDF file, and the way from a base link to a tip link.

use super::Fault;
use super::xml::{Xml, head, joint_name, part, problem};
use crate::diagnostic::{InputError, Problem, nearest};
use roxmltree::Node;

/// Links by name, each with the joint that carries it.
pub(super) struct Tree<'a> {
    file: &'a str,
    links: Vec<&'a str>,
    /// Per link: its joint's index, if it hangs on one.
    carrier: Vec<Option<usize>>,
    /// Per joint: indices of its parent and its child link.
    ends: Vec<[usize; 2]>,
}

impl<'a> Tree<'a> {
    /// Reads which joint connects which links. `file` is the URDF file's name for messages.
    ///
    /// # Errors
    /// A link has no name, the name of another one or two parents, or a joint's end is missing.
    pub(super) fn read(
        xml: &'a Xml,
        joints: &[Node<'a, '_>],
        file: &'a str,
    ) -> Result<Tree<'a>, InputError> {
        let links = link_names(xml)?;
        let mut tree = Tree {
            file,
            carrier: vec![None; links.len()],
            ends: Vec::with_capacity(joints.len()),
            links,
        };
        for (index, joint) in joints.iter().enumerate() {
            let ends = [
                tree.end(xml, *joint, "parent")?,
                tree.end(xml, *joint, "child")?,
            ];
            if let Some(other) = tree.carrier[ends[1]].replace(index) {
                let link = tree.links[ends[1]];
                let message = format!("link `{link}` has two parents: the chain is a closed loop");
                let found = format!(
                    "joints `{}` and `{}` above it",
                    joint_name(joints[other]),
                    joint_name(*joint)
                );
                let expected = "a tree, in which one joint carries each link";
                return Err(xml.error(head(*joint), problem(&message, found, expected)));
            }
            tree.ends.push(ends);
        }
        Ok(tree)
    }

    /// The link at the end `which` ("parent" or "child") of a joint.
    fn end(&self, xml: &Xml, joint: Node, which: &str) -> Result<usize, InputError> {
        let name = joint_name(joint);
        let node = part(joint, which);
        let written = node.and_then(|node| node.attribute("link"));
        let Some(link) = written else {
            let message = format!("joint `{name}` has no {which} link");
            let expected = format!("<{which} link=\"…\"/>");
            return Err(xml.error(head(joint), problem(&message, "nothing", &expected)));
        };
        if let Some(index) = self.position(link) {
            return Ok(index);
        }
        let message = format!("joint `{name}` names a {which} link that is not in the file");
        let mut problem = problem(&message, format!("`{link}`"), "the name of a link");
        problem.help = self.meant(link);
        Err(xml.error(head(node.unwrap_or(joint)), problem))
    }

    fn position(&self, link: &str) -> Option<usize> {
        self.links.iter().position(|name| *name == link)
    }

    fn meant(&self, link: &str) -> String {
        match nearest(link, &self.links) {
            Some(meant) => format!("did you mean `{meant}`?"),
            None => "the file has no link".into(),
        }
    }

    /// The joints between the link `base` (default: the only root) and the link `tip` (default:
    /// the only leaf below `base`), base first.
    ///
    /// # Errors
    /// There is no such link, several would do, or the tip is not below the base.
    pub(super) fn chain(&self, base: Option<&str>, tip: Option<&str>) -> Result<Vec<usize>, Fault> {
        let base = match base {
            Some(name) => self.named("base", name)?,
            None => self.only_root()?,
        };
        let tip = match tip {
            Some(name) => self.named("tip", name)?,
            None => self.only_leaf(base)?,
        };
        self.climb(base, tip)
    }

    fn named(&self, key: &'static str, name: &str) -> Result<usize, Fault> {
        self.position(name).ok_or_else(|| {
            let problem = Problem {
                message: format!("the URDF file `{}` has no such link", self.file),
                found: format!("`{name}`"),
                expected: "the name of a link".into(),
                help: self.meant(name),
            };
            Fault::Key(key, problem)
        })
    }

    fn only_root(&self) -> Result<usize, Fault> {
        let roots = |link: &usize| self.carrier[*link].is_none();
        let roots: Vec<usize> = (0..self.links.len()).filter(roots).collect();
        match roots[..] {
            [root] => Ok(root),
            [] if self.links.is_empty() => {
                Err(self.ambiguous("no link at all", "base", "links", None))
            }
            [] => Err(self.ambiguous(
                "a closed loop of joints without a root",
                "base",
                "a tree",
                None,
            )),
            _ => {
                let found = format!("{} root links: {}", roots.len(), self.list(&roots));
                Err(self.ambiguous(&found, "base", "one root link", roots.first()))
            }
        }
    }

    fn only_leaf(&self, base: usize) -> Result<usize, Fault> {
        let mut below = vec![false; self.links.len()];
        let mut open = vec![base];
        let mut leaves = Vec::new();
        while let Some(link) = open.pop() {
            if std::mem::replace(&mut below[link], true) {
                continue;
            }
            let children: Vec<usize> = self
                .ends
                .iter()
                .filter(|e| e[0] == link)
                .map(|e| e[1])
                .collect();
            if children.is_empty() {
                leaves.push(link);
            }
            open.extend(children);
        }
        leaves.sort_unstable();
        match leaves[..] {
            [leaf] => Ok(leaf),
            [] => Err(self.ambiguous(
                "a closed loop of joints without an end",
                "tip",
                "a tree",
                None,
            )),
            _ => {
                let found = format!("{} ends: {}", leaves.len(), self.list(&leaves));
                Err(self.ambiguous(&found, "tip", "one link without a child", leaves.first()))
            }
        }
    }

    fn ambiguous(
        &self,
        found: &str,
        key: &'static str,
        expected: &str,
        example: Option<&usize>,
    ) -> Fault {
        let example = example.map_or("link8", |&link| self.links[link]);
        let problem = Problem {
            message: format!("the URDF file `{}` does not tell the {key} link", self.file),
            found: found.to_owned(),
            expected: expected.to_owned(),
            help: format!("name the link, e.g. `{key} = \"{example}\"`"),
        };
        Fault::Key("urdf", problem)
    }

    fn climb(&self, base: usize, tip: usize) -> Result<Vec<usize>, Fault> {
        let (mut link, mut joints) = (tip, Vec::new());
        while link != base {
            let Some(joint) = self.carrier[link] else {
                let found = format!(
                    "the root `{}` above it, without `{}`",
                    self.links[link], self.links[base]
                );
                return Err(self.detached(base, tip, &found));
            };
            if joints.contains(&joint) {
                return Err(self.detached(base, tip, "a closed loop of joints above it"));
            }
            joints.push(joint);
            link = self.ends[joint][0];
        }
        joints.reverse();
        Ok(joints)
    }

    fn detached(&self, base: usize, tip: usize, found: &str) -> Fault {
        let (base, tip) = (self.links[base], self.links[tip]);
        let problem = Problem {
            message: format!(
                "in `{}` the tip `{tip}` is not below the base `{base}`",
                self.file
            ),
            found: found.to_owned(),
            expected: "a tip that the base carries over joints".into(),
            help: "name other links as `base` or `tip`; perhaps the two are swapped".into(),
        };
        Fault::Key("tip", problem)
    }

    /// Names of links, cut after the tenth.
    fn list(&self, links: &[usize]) -> String {
        let names = links
            .iter()
            .take(10)
            .map(|&link| format!("`{}`", self.links[link]));
        let names: Vec<String> = names.collect();
        let more = if links.len() > 10 { ", …" } else { "" };
        format!("{}{more}", names.join(", "))
    }
}

fn link_names<'a>(xml: &'a Xml) -> Result<Vec<&'a str>, InputError> {
    let mut names: Vec<&str> = Vec::new();
    for link in xml.links() {
        let name = link.attribute("name").unwrap_or("");
        let message = match name {
            "" => "a link has no name".to_owned(),
            _ if names.contains(&name) => format!("two links have the name `{name}`"),
            _ => {
                names.push(name);
                continue;
            }
        };
        let problem = problem(
            &message,
            format!("\"{name}\""),
            "a name of its own per link",
        );
        return Err(xml.error(head(link), problem));
    }
    Ok(names)
}
