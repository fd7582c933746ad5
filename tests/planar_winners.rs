//! What a search of planar links leaves behind: a robot that can be used, beside the design.

use assert_cmd::Command;
use faultspace::design::read_design;
use faultspace::kinematics::tool_frame;
use faultspace::study::{Progress, RunOptions, Study, run};
use faultspace::workspace::planar::{PlanarArm, PlanarPosition};
use faultspace::workspace::{ArtificialLimits, FailureSet};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

struct Silent;

impl Progress for Silent {
    fn update(&self, _: u64, _: u64, _: f64, _: &str) {}
}

fn options(out: &Path, threads: usize) -> RunOptions {
    RunOptions {
        out: out.to_owned(),
        resume: false,
        overwrite: true,
        threads: Some(threads),
        interrupt: Arc::new(AtomicBool::new(false)),
        cache: None,
    }
}

fn run_file(study: &Path, out: &Path, threads: usize) -> Value {
    let study = Study::load(study).unwrap();
    run(&study, &options(out, threads), Arc::new(Silent)).unwrap()
}

fn numbers(json: &Value) -> Vec<f64> {
    let all = json.as_array().unwrap();
    all.iter().map(|value| value.as_f64().unwrap()).collect()
}

fn normalised(json: &Value) -> f64 {
    json["size"]["normalised"].as_f64().unwrap()
}

const SEARCH: &str = "[search]\nmin_width_deg = 20\nlink_lower = [0.05, 0.05, 0.05]\n\
    link_upper = [2.9, 2.9, 2.9]\n[optimiser.coordinate-ascent]\nrestarts = 64\nfinalists = 12\n";

/// A study of `design` in `folder`.
fn study(folder: &Path, design: &str, task: &str) -> std::path::PathBuf {
    fs::write(folder.join("design.toml"), design).unwrap();
    let text = format!(
        "kind = \"optimise\"\ndesign = \"design.toml\"\n[task]\nspace = \"planar-position\"\n\
         {task}\n{SEARCH}"
    );
    let path = folder.join("links.toml");
    fs::write(&path, text).unwrap();
    path
}

/// The shipped study: files that `check` accepts and that measure the same robot, the design with
/// the best limits for it, both drawn.
#[test]
fn the_robot_found_can_be_used() {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let out = folder.path().join("out");
    let result = run_file(&root.join("studies/design_3r_20deg.toml"), &out, 2);
    let found = normalised(&result);
    assert!((found - 0.26406).abs() < 1e-4, "{found}");
    let reference = &result["reference"];
    assert_eq!(numbers(&reference["lengths"]), [1.0; 3]);
    assert_eq!(reference["limits_given"], false);
    // Equal links: 12.6 %, whose limits are wider than 20°.
    assert!((normalised(reference) - 0.126).abs() < 1e-3, "{reference}");
    for file in [
        "robots.png",
        "robots.csv",
        "link-sensitivity.png",
        "workspace.png",
    ] {
        assert!(out.join(file).exists(), "{file}");
    }
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    for file in ["robot.toml", "robot.urdf", "robot_study.toml"] {
        assert!(page.contains(&format!("href=\"{file}\"")), "{file}");
        assert!(out.join(file).exists(), "{file}");
    }

    let mut check = Command::cargo_bin("faultspace").unwrap();
    let files = ["robot.toml", "robot_study.toml"].map(|file| out.join(file));
    check.arg("check").args(&files).assert().success();
    let again = run_file(&files[1], &folder.path().join("again"), 2);
    assert!((normalised(&again) - found).abs() < 1e-7, "{again}");

    let urdf = folder.path().join("urdf.toml");
    let text = format!("name = \"urdf\"\nurdf = {:?}\n", out.join("robot.urdf"));
    fs::write(&urdf, text).unwrap();
    let [robot, urdf] = [&files[0], &urdf].map(|path| read_design(path).unwrap());
    let theta = [0.3, -1.1, 0.7];
    let off = tool_frame(&robot, &theta).inverse() * tool_frame(&urdf, &theta);
    assert!(off.translation.vector.norm() + off.rotation.angle() < 1e-9);
}

/// Joint offsets of the design, some joints prone, a margin, limits of the design: the files mean
/// the same. And the same on one thread.
#[test]
fn offsets_failures_and_margins_are_carried_over() {
    let folder = tempfile::tempdir().unwrap();
    let rows = "name = \"rows\"\nconvention = \"standard\"\njoints = [\n\
         { kind = \"revolute\", a = 1.0, theta_deg = 20.0 },\n\
         { kind = \"revolute\", a = 1.0, theta_deg = 90.0 },\n\
         { kind = \"revolute\", a = 1.0, theta_deg = -35.0 },\n]\n";
    let task = "failures = [1, 3]\nmargin_deg = 2\n[limits]\nlower_deg = [-38, -201, -76]\n\
         upper_deg = [-2, 21, 146]";
    let path = study(folder.path(), rows, task);
    let out = folder.path().join("out");
    let result = run_file(&path, &out, 2);
    let again = run_file(
        &out.join("robot_study.toml"),
        &folder.path().join("again"),
        2,
    );
    assert!(normalised(&result) > 0.05);
    assert!((normalised(&again) - normalised(&result)).abs() < 1e-7);
    for (key, width) in [("pre_failure", "size"), ("unrestricted", "size")] {
        let [a, b] = [&result, &again].map(|r| r["workspaces"][key][width].as_f64().unwrap());
        assert!((a - b).abs() < 1e-6 * a, "{key}");
    }
    let reference = &result["reference"];
    assert_eq!(reference["limits_given"], true);
    let lower = numbers(&reference["limits_deg"]["lower"]);
    for (found, given) in lower.iter().zip([-38.0, -201.0, -76.0]) {
        let turns = (found - given) / 360.0;
        assert!((turns - turns.round()).abs() < 1e-9, "{lower:?}");
    }
    let mut alone = run_file(&path, &folder.path().join("alone"), 1);
    let mut result = result;
    for result in [&mut alone, &mut result] {
        result["seconds"] = Value::Null;
        result["provenance"] = Value::Null;
    }
    assert_eq!(alone, result);
}

/// Changes for lengths and limits that are off, computed once more from the numbers reported.
#[test]
fn tolerances_are_differences_of_shares() {
    let folder = tempfile::tempdir().unwrap();
    let path = study(folder.path(), "name = \"arm\"\nlinks = [1, 1, 1]\n", "");
    let result = run_file(&path, &folder.path().join("out"), 2);
    let lengths = numbers(&result["links"]["lengths"]);
    let ends = ["lower", "upper"].map(|end| numbers(&result["limits_deg"][end]));
    let share = |lengths: &[f64], ends: &[Vec<f64>; 2]| {
        let pairs = ends[0].iter().zip(&ends[1]).map(|(l, u)| [*l, *u]);
        let limits = ArtificialLimits::from_degrees(&pairs.collect::<Vec<_>>());
        let failures = FailureSet::any(3);
        let arm = PlanarArm {
            lengths,
            limits: &limits,
            failures: &failures,
        };
        PlanarPosition::new().sizes(arm).normalised()
    };
    let base = share(&lengths, &ends);
    let each = result["sensitivity"].as_array().unwrap();
    assert!(each.len() > 3);
    let mut largest: f64 = 0.0;
    for entry in each {
        let name = entry["parameter"].as_str().unwrap();
        let (what, number) = name.split_once('_').unwrap();
        let k = number.parse::<usize>().unwrap() - 1;
        for (side, sign) in [("less", -1.0), ("more", 1.0)] {
            let (mut lengths, mut ends) = (lengths.clone(), ends.clone());
            match what {
                "l" => lengths[k] += sign * entry["tolerance"].as_f64().unwrap(),
                "lower" => ends[0][k] += sign * entry["tolerance_deg"].as_f64().unwrap(),
                _ => ends[1][k] += sign * entry["tolerance_deg"].as_f64().unwrap(),
            }
            let expected = share(&lengths, &ends) - base;
            let told = entry[side]["value"].as_f64().unwrap();
            assert!(
                (told - expected).abs() < 1e-9,
                "{name} {side}: {told}, {expected}"
            );
            largest = largest.max(told.abs());
        }
    }
    assert!(largest > 1e-4, "{largest}");
    assert!((each[0]["tolerance"].as_f64().unwrap() - 0.003).abs() < 1e-12);
}

/// With fixed links there is no new robot.
#[test]
fn limits_alone_make_no_robot() {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let result = run_file(&root.join("studies/quick.toml"), folder.path(), 2);
    assert_eq!(result["reference"], Value::Null);
    for file in ["robot.toml", "robot.urdf", "robot_study.toml", "robots.png"] {
        assert!(!folder.path().join(file).exists(), "{file}");
    }
}
