//! The import rule of `src/lib.rs`: data flows one way, and a module imports only from modules
//! before it. Read from the sources, so that a forbidden `use` fails here by name.

use std::fs;
use std::path::{Path, PathBuf};

/// Every module with all it may import from, in order: a module may only name earlier ones.
const MODULES: [(&str, &[&str]); 15] = [
    ("angle", &[]),
    ("sampling", &[]),
    ("diagnostic", &[]),
    ("design", &["angle", "sampling", "diagnostic"]),
    ("kinematics", &["design"]),
    ("manifold", &["angle", "sampling", "design", "kinematics"]),
    (
        "singularity",
        &["angle", "sampling", "design", "kinematics", "manifold"],
    ),
    (
        "workspace",
        &["angle", "sampling", "design", "kinematics", "manifold"],
    ),
    (
        "objective",
        &[
            "angle",
            "sampling",
            "diagnostic",
            "design",
            "kinematics",
            "workspace",
        ],
    ),
    (
        "surrogate",
        &["angle", "sampling", "design", "workspace", "objective"],
    ),
    ("optimiser", &["sampling", "objective"]),
    (
        "synthesis",
        &[
            "angle",
            "sampling",
            "design",
            "kinematics",
            "manifold",
            "workspace",
            "objective",
            "optimiser",
        ],
    ),
    ("report", &["angle", "workspace"]),
    (
        "study",
        &[
            "angle",
            "sampling",
            "diagnostic",
            "design",
            "kinematics",
            "manifold",
            "singularity",
            "workspace",
            "objective",
            "surrogate",
            "optimiser",
            "synthesis",
            "report",
        ],
    ),
    (
        "cli",
        &[
            "angle",
            "sampling",
            "diagnostic",
            "design",
            "kinematics",
            "manifold",
            "workspace",
            "objective",
            "optimiser",
            "report",
            "study",
        ],
    ),
];

/// No source file may be longer.
const MOST_LINES: usize = 500;

/// A source file below `src/`.
struct SourceFile {
    path: PathBuf,
    text: String,
}

impl SourceFile {
    /// The top-level module the file belongs to; `lib` and `main` for the roots.
    fn module(&self) -> String {
        let first = self.path.components().next().expect("a path");
        let name = first.as_os_str().to_string_lossy();
        name.trim_end_matches(".rs").to_owned()
    }

    /// How many `super::` lead from the file's own module to the crate root.
    fn depth(&self) -> usize {
        let parts = self.path.components().count();
        if self.path.ends_with("mod.rs") {
            parts - 1
        } else {
            parts
        }
    }

    /// The text without comments and string literals. Enough of a lexer for this crate.
    fn code(&self) -> String {
        let mut code = String::new();
        for line in self.text.lines() {
            let mut quoted = false;
            let mut previous = ' ';
            for (at, letter) in line.char_indices() {
                if !quoted && line[at..].starts_with("//") {
                    break;
                }
                if letter == '"' && previous != '\\' && previous != '\'' {
                    quoted = !quoted;
                } else if !quoted {
                    code.push(letter);
                }
                previous = letter;
            }
            code.push('\n');
        }
        code
    }

    /// Top-level modules named by `crate::x` or `crate::{x::…, y}`.
    fn imports(&self) -> Vec<String> {
        let code = self.code();
        let mut found = Vec::new();
        for (at, root) in code.match_indices("crate::") {
            // `$crate::` and other_crate:: are no paths of this crate's.
            if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
                continue;
            }
            let rest = &code[at + root.len()..];
            match rest.strip_prefix('{') {
                None => found.push(identifier(rest)),
                Some(group) => found.extend(group_heads(group)),
            }
        }
        found
    }
}

fn identifier(text: &str) -> String {
    let text = text.trim_start();
    text.chars()
        .take_while(|c| c.is_alphanumeric() || *c == '_')
        .collect()
}

/// First names of the items of `{…}`, whose opening brace is already gone.
fn group_heads(group: &str) -> Vec<String> {
    let mut heads = vec![identifier(group)];
    let mut depth = 1;
    for (at, letter) in group.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 1 => heads.push(identifier(&group[at + 1..])),
            _ => {}
        }
        if depth == 0 {
            break;
        }
    }
    heads.retain(|head| !head.is_empty());
    heads
}

fn collect(folder: &Path, root: &Path, files: &mut Vec<SourceFile>) {
    for entry in fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, root, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(SourceFile {
                text: fs::read_to_string(&path).unwrap(),
                path: path.strip_prefix(root).unwrap().to_owned(),
            });
        }
    }
}

fn sources() -> Vec<SourceFile> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    collect(&root, &root, &mut files);
    assert!(files.len() > 50, "only {} sources found", files.len());
    files
}

fn source(path: &str, text: &str) -> SourceFile {
    SourceFile {
        path: PathBuf::from(path),
        text: text.to_owned(),
    }
}

#[test]
fn the_table_itself_points_backwards() {
    for (place, (module, allowed)) in MODULES.iter().enumerate() {
        let earlier: Vec<&str> = MODULES[..place].iter().map(|(name, _)| *name).collect();
        for name in *allowed {
            assert!(earlier.contains(name), "{module} may not import {name}");
        }
    }
}

#[test]
fn modules_import_only_from_those_before_them() {
    let mut broken = Vec::new();
    let mut seen = Vec::new();
    for file in sources() {
        let module = file.module();
        if module == "lib" || module == "main" {
            continue;
        }
        let Some((_, allowed)) = MODULES.iter().find(|(name, _)| *name == module) else {
            panic!(
                "{} is in no module that this test knows",
                file.path.display()
            );
        };
        for import in file.imports() {
            if import != module && !allowed.contains(&import.as_str()) {
                broken.push(format!("{}: crate::{import}", file.path.display()));
            }
            seen.push(import);
        }
    }
    assert!(
        broken.is_empty(),
        "forbidden imports:\n{}",
        broken.join("\n")
    );
    // Were the scan blind, nothing would be forbidden.
    for module in ["angle", "workspace", "objective", "report"] {
        assert!(seen.iter().any(|name| name == module), "no import seen");
    }
}

/// `super::super::` must not be a way around the rule: no chain of `super` reaches the root.
/// Inline modules (tests) lie one level deeper, so a chain as long as the depth of the file's own
/// module is the first one that could leave it.
#[test]
fn no_super_chain_leaves_a_module() {
    for file in sources() {
        let code = file.code();
        let depth = file.depth();
        if file.module() == "lib" || file.module() == "main" {
            continue;
        }
        let chain = "super::".repeat(depth);
        // In `src/x.rs` or `src/x/mod.rs` a single `super` is at home in inline test modules only.
        let outside_tests = match code.find("#[cfg(test)]") {
            Some(end) => &code[..end],
            None => &code,
        };
        assert!(
            !outside_tests.contains(&chain),
            "{} leaves its module through super",
            file.path.display()
        );
        assert!(!code.contains(&format!("super::{chain}")));
    }
}

#[test]
fn optimisers_know_nothing_of_robots_or_workspaces() {
    let is_part_of_a_word = |c: char| c.is_alphanumeric() || c == '_';
    for file in sources() {
        if file.module() != "optimiser" {
            continue;
        }
        let code = file.code();
        let mut words = code.split(|c: char| !is_part_of_a_word(c));
        let word = words.find(|word| ["workspace", "design", "angle"].contains(word));
        assert_eq!(word, None, "in {}", file.path.display());
    }
}

#[test]
fn lib_declares_exactly_the_modules_of_the_table() {
    let files = sources();
    let lib = files.iter().find(|file| file.module() == "lib").unwrap();
    let code = lib.code();
    let mut declared: Vec<&str> = code
        .lines()
        .filter_map(|line| line.trim().strip_prefix("pub mod "))
        .map(|rest| rest.trim_end_matches(';'))
        .collect();
    let mut known: Vec<&str> = MODULES.iter().map(|(name, _)| *name).collect();
    declared.sort_unstable();
    known.sort_unstable();
    assert_eq!(declared, known);
}

#[test]
fn files_stay_short() {
    for file in sources() {
        let lines = file.text.lines().count();
        assert!(
            lines <= MOST_LINES,
            "{} has {lines} lines",
            file.path.display()
        );
    }
}

/// The scan itself: comments and strings do not count, groups and bare paths do.
#[test]
fn imports_are_found_however_they_are_written() {
    let file = source(
        "angle/set.rs",
        "//! See [`crate::cli`].\n\
         use crate::{\n    design::{Robot, Link},\n    study,\n};\n\
         fn f() -> crate::workspace::Estimate { panic!(\"crate::report\") } // crate::cli\n\
         use crate::objective::{\n    Objective,\n};\n",
    );
    let found = file.imports();
    assert_eq!(found, ["design", "study", "workspace", "objective"]);
    assert_eq!(file.depth(), 2);
    assert_eq!(source("angle/mod.rs", "").depth(), 1);
    assert_eq!(source("sampling.rs", "").depth(), 1);
    assert_eq!(source("sampling.rs", "").module(), "sampling");
}
