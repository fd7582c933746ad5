//! Every shipped robot and study is valid, and robots say where they come from.

use faultspace::design::read_design;
use faultspace::study::Study;
use std::path::{Path, PathBuf};

fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .collect()
}

#[test]
fn robots() {
    let files = files("designs");
    assert!(files.len() >= 5);
    for path in files {
        let robot = read_design(&path).unwrap_or_else(|error| panic!("{}", error.render(false)));
        let stem = path.file_stem().unwrap().to_string_lossy();
        assert_eq!(robot.name, stem.replace('_', "-"));
        assert!(robot.source.is_some(), "{} cites nothing", robot.name);
        assert_eq!(robot.check(), Ok(()));
    }
}

#[test]
fn studies() {
    for path in files("studies") {
        Study::load(&path).unwrap_or_else(|error| panic!("{}", error.render(false)));
    }
}
