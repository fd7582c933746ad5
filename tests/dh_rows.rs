//! A planar arm written as Denavit–Hartenberg rows, with offsets and a backward link, gives the
//! numbers of the shorthand once limits are shifted accordingly.

use faultspace::study::{Progress, RunOptions, Study, run};
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;

struct Quiet;

impl Progress for Quiet {
    fn update(&self, _: u64, _: u64, _: f64, _: &str) {}
}

fn result(folder: &Path, robot: &str, lower: &str, upper: &str) -> Value {
    std::fs::write(folder.join("arm.toml"), robot).unwrap();
    let study = format!(
        "kind = \"estimate\"\ndesign = \"arm.toml\"\n[task]\nspace = \"planar-position\"\n\
         [limits]\nlower_deg = {lower}\nupper_deg = {upper}\n\
         [estimate]\nradii = [1.2, 1.5]\n[report]\nfigures = false\n"
    );
    std::fs::write(folder.join("study.toml"), study).unwrap();
    let options = RunOptions {
        out: folder.join("out"),
        resume: false,
        overwrite: false,
        threads: Some(1),
        interrupt: Arc::default(),
        cache: None,
    };
    let study = Study::load(&folder.join("study.toml")).unwrap();
    run(&study, &options, Arc::new(Quiet)).unwrap()
}

#[test]
fn offsets_and_backward_links_change_no_size() {
    let shorthand = tempfile::tempdir().unwrap();
    let plain = result(
        shorthand.path(),
        "name = \"plain\"\nlinks = [1.0, 0.9, 1.1]",
        "[-20, -100, -115]",
        "[25, 105, 110]",
    );
    // Joint 1 is offset by 30°, link 2 points backwards: joint 2 and joint 3 are turned by 180°.
    let rows = tempfile::tempdir().unwrap();
    let robot = "name = \"rows\"\nconvention = \"standard\"\njoints = [\n\
        { kind = \"revolute\", a = 1.0, theta_deg = 30 },\n\
        { kind = \"revolute\", a = -0.9, d = 0.2 },\n\
        { kind = \"revolute\", a = 1.1 },\n]";
    let turned = result(rows.path(), robot, "[-50, -280, 65]", "[-5, -75, 290]");
    let size = |result: &Value| result["size"]["fault_tolerant"].as_f64().unwrap();
    assert!(size(&plain) > 1.0);
    assert!((size(&plain) - size(&turned)).abs() < 1e-9 * size(&plain));
    for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let end = |result: &Value| result["rotation_sets"][a]["beta_deg"][0][b].as_f64();
        let (plain, turned) = (end(&plain).unwrap(), end(&turned).unwrap());
        assert!((plain - turned).abs() < 1e-9, "{plain} {turned}");
    }
    assert_eq!(turned["limits_deg"]["lower"][1].as_f64(), Some(-280.0));
}
