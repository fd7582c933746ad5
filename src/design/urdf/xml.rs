//! The XML of a URDF file: well formed, with the place of every element, and a plain copy for the
//! URDF reader.

use super::MAX_NUMBER;
use crate::diagnostic::{InputError, Problem, Source};
use nalgebra::Vector3;
use roxmltree::{Document, Node, ParsingOptions};
use std::fmt::Write;
use std::ops::Range;

/// The parts of a joint that are read, with the attributes that matter.
const PARTS: [(&str, &[&str]); 6] = [
    ("origin", &["xyz", "rpy"]),
    ("parent", &["link"]),
    ("child", &["link"]),
    ("axis", &["xyz"]),
    ("limit", &["lower", "upper"]),
    ("mimic", &["joint"]),
];

/// Most elements of a file; an arm has a few hundred.
const MAX_NODES: u32 = 1_000_000;

/// Most links or joints of a file; searches among them take quadratic time.
const MAX_PARTS: usize = 2000;

/// A URDF file as XML.
pub(super) struct Xml<'s> {
    source: &'s Source,
    document: Document<'s>,
}

impl<'s> Xml<'s> {
    /// Parses the text.
    ///
    /// # Errors
    /// It is not XML or its root is no `<robot>`.
    pub(super) fn parse(source: &'s Source) -> Result<Xml<'s>, InputError> {
        let options = ParsingOptions {
            nodes_limit: MAX_NODES,
            ..ParsingOptions::default()
        };
        let document = Document::parse_with_options(source.text(), options)
            .map_err(|error| syntax_error(source, &error))?;
        let xml = Xml { source, document };
        let root = xml.document.root_element();
        if root.tag_name().name() != "robot" {
            let found = format!("<{}>", root.tag_name().name());
            let problem = problem("not a URDF file", found, "the root element <robot>");
            return Err(xml.error(head(root), problem));
        }
        let size = xml.joints().len().max(xml.links().len());
        if size > MAX_PARTS {
            let expected = format!("at most {MAX_PARTS} links and joints");
            let problem = problem("the URDF file is too large", format!("{size}"), &expected);
            return Err(xml.error(head(root), problem));
        }
        Ok(xml)
    }

    /// The joints in file order.
    pub(super) fn joints(&self) -> Vec<Node<'_, 's>> {
        self.elements("joint")
    }

    /// The links in file order.
    pub(super) fn links(&self) -> Vec<Node<'_, 's>> {
        self.elements("link")
    }

    fn elements(&self, name: &str) -> Vec<Node<'_, 's>> {
        let children = self.document.root_element().children();
        children.filter(|node| is_element(node, name)).collect()
    }

    /// A mistake at the byte range `span`.
    pub(super) fn error(&self, span: Range<usize>, problem: Problem) -> InputError {
        InputError::at(self.source, "", span, problem)
    }

    /// `joints` as the URDF reader is to see them: with what moves them and nothing else. Meshes,
    /// masses, speeds and extensions cannot hinder it then.
    pub(super) fn plain(&self, joints: &[Node]) -> String {
        let mut text = String::from("<robot");
        let version = self.document.root_element().attribute("version");
        push_attribute(&mut text, "version", version);
        text.push('>');
        joints.iter().for_each(|joint| push_joint(&mut text, joint));
        text.push_str("</robot>");
        text
    }

    /// Three finite numbers of the attribute `name` of the part `part` of a joint; `None` if the
    /// part or the attribute is absent.
    ///
    /// # Errors
    /// Anything else is written there.
    pub(super) fn vector(
        &self,
        joint: Node,
        part: &str,
        name: &str,
    ) -> Result<Option<Vector3<f64>>, InputError> {
        let attribute = self::part(joint, part).and_then(|node| node.attribute_node(name));
        let Some(attribute) = attribute else {
            return Ok(None);
        };
        let words = attribute.value().split_whitespace();
        let numbers: Vec<Option<f64>> = words.map(number).collect();
        if let [Some(x), Some(y), Some(z)] = numbers[..] {
            return Ok(Some(Vector3::new(x, y, z)));
        }
        let message = format!(
            "`{name}` of <{part}> of joint `{}` is not three finite numbers",
            joint_name(joint)
        );
        let found = format!("\"{}\"", attribute.value());
        let expected = format!("three numbers from -{MAX_NUMBER} to {MAX_NUMBER}");
        Err(self.error(attribute.range(), problem(&message, found, &expected)))
    }
}

/// A finite number of a size that can be meant.
pub(super) fn number(word: &str) -> Option<f64> {
    let value: f64 = word.trim().parse().ok()?;
    (value.abs() <= MAX_NUMBER).then_some(value)
}

/// The first element `name` of a joint.
pub(super) fn part<'a, 's>(joint: Node<'a, 's>, name: &str) -> Option<Node<'a, 's>> {
    joint.children().find(|node| is_element(node, name))
}

/// A joint's name, empty if it has none.
pub(super) fn joint_name<'a>(joint: Node<'a, '_>) -> &'a str {
    joint.attribute("name").unwrap_or("")
}

/// The bytes of an element's first line.
pub(super) fn head(node: Node) -> Range<usize> {
    let Range { start, end } = node.range();
    let text = node.document().input_text().get(start..end).unwrap_or("");
    let line = text.lines().next().unwrap_or("");
    start..start + line.len()
}

/// A problem of a URDF file.
pub(super) fn problem(message: &str, found: impl Into<String>, expected: &str) -> Problem {
    Problem {
        message: message.to_owned(),
        found: found.into(),
        expected: expected.to_owned(),
        help: "mend the URDF file".into(),
    }
}

fn is_element(node: &Node, name: &str) -> bool {
    node.is_element() && node.tag_name().name() == name
}

fn push_joint(text: &mut String, joint: &Node) {
    text.push_str("<joint");
    push_attribute(text, "name", joint.attribute("name"));
    push_attribute(text, "type", joint.attribute("type"));
    text.push('>');
    for (name, attributes) in PARTS {
        let Some(node) = part(*joint, name) else {
            continue;
        };
        // Writing to a string cannot fail.
        let _ = write!(text, "<{name}");
        for attribute in attributes {
            push_attribute(text, attribute, node.attribute(*attribute));
        }
        // The reader insists on a speed, which nothing here needs.
        push_attribute(text, "velocity", (name == "limit").then_some("0"));
        text.push_str("/>");
    }
    text.push_str("</joint>");
}

fn push_attribute(text: &mut String, name: &str, value: Option<&str>) {
    let Some(value) = value else {
        return;
    };
    let _ = write!(text, " {name}=\"");
    push_escaped(text, value);
    text.push('"');
}

/// Appends `value` as XML has it in texts and attributes; a space for every character that XML
/// does not know.
pub(super) fn push_escaped(text: &mut String, value: &str) {
    for character in value.chars() {
        match character {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '"' => text.push_str("&quot;"),
            '\'' => text.push_str("&apos;"),
            control if control.is_control() || "\u{fffe}\u{ffff}".contains(control) => {
                text.push(' ');
            }
            plain => text.push(plain),
        }
    }
}

fn syntax_error(source: &Source, error: &roxmltree::Error) -> InputError {
    let place = error.pos();
    let mut start = 0;
    for line in source
        .text()
        .split_inclusive('\n')
        .take(place.row.saturating_sub(1) as usize)
    {
        start += line.len();
    }
    let line = source.text().get(start..).unwrap_or("");
    let columns = line.chars().take(place.col.saturating_sub(1) as usize);
    start += columns.map(char::len_utf8).sum::<usize>();
    let problem = Problem {
        message: "not well-formed XML".into(),
        found: error.to_string(),
        expected: "a URDF file without a document type".into(),
        help: "if it is a xacro file, expand it to URDF first".into(),
    };
    InputError::at(source, "", start..start, problem)
}
