//! The studies of singular configurations end to end: files in, reports out; bad input is refused with
//! one clear message.

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::Path;

const PLANAR: &str = "name = 'r'\nlinks = [1.0, 0.8, 0.45]\n";

fn write(folder: &Path, study: &str) -> std::path::PathBuf {
    fs::write(folder.join("r.toml"), PLANAR).expect("a folder");
    let path = folder.join("s.toml");
    fs::write(&path, study).expect("a folder");
    path
}

fn run(folder: &Path, study: &str, more: &[&str]) -> std::process::Output {
    let path = write(folder, study);
    let mut command = Command::cargo_bin("faultspace").expect("the binary");
    command.args([
        "run",
        path.to_str().expect("text"),
        "--quiet",
        "--json",
        "--overwrite",
    ]);
    command
        .args(["--out", folder.join("out").to_str().expect("text")])
        .args(more);
    command.output().expect("it runs")
}

fn result(folder: &Path, study: &str, more: &[&str]) -> Value {
    let output = run(folder, study, more);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn head(kind: &str) -> String {
    format!("kind = '{kind}'\ndesign = 'r.toml'\n[task]\nspace = 'planar-position'\n")
}

fn without_time(mut value: Value) -> Value {
    value["seconds"] = Value::Null;
    value["provenance"]["threads"] = Value::Null;
    value
}

#[test]
fn singularities_of_a_planar_arm() {
    let folder = tempfile::tempdir().expect("a folder");
    let study = head("singularities") + "[singularities]\nstarts = 40\n";
    let found = result(folder.path(), &study, &[]);
    assert_eq!(found["full_rank"], 2);
    assert_eq!(found["families"].as_array().map(Vec::len), Some(4));
    let held = &found["families"][0]["held"];
    assert_eq!(
        (&held[0]["joint"], &held[1]["joint"]),
        (&Value::from(2), &Value::from(3))
    );
    let out = folder.path().join("out");
    for file in [
        "result.json",
        "study.toml",
        "report.html",
        "singularities.png",
        "singularities.csv",
        "split.svg",
    ] {
        assert!(out.join(file).exists(), "{file}");
    }
    let one = result(folder.path(), &study, &["--threads", "1"]);
    let two = result(folder.path(), &study, &["--threads", "2"]);
    assert_eq!(without_time(one), without_time(two));
}

#[test]
fn the_largest_manifold_of_a_planar_arm() {
    let folder = tempfile::tempdir().expect("a folder");
    let study = head("largest-manifold")
        + "[singularities]\nstarts = 20\n[largest-manifold]\ncomparison = 20\n";
    let found = result(folder.path(), &study, &[]);
    let size = |key: &str| found[key].as_f64().expect("a number");
    assert!(size("largest_size") <= size("most_possible") + 1e-9);
    assert!(size("smallest_size") <= size("largest_size"));
    assert!(
        found["pareto"][0]["locations"]
            .as_array()
            .is_some_and(|front| !front.is_empty())
    );
    for file in [
        "projections.png",
        "joint_ranges.svg",
        "pareto.csv",
        "size_distributions.png",
    ] {
        assert!(folder.path().join("out").join(file).exists(), "{file}");
    }
    let again = result(folder.path(), &study, &["--threads", "1"]);
    assert_eq!(without_time(found), without_time(again));
}

#[test]
fn a_failure_experiment_in_the_plane() {
    let folder = tempfile::tempdir().expect("a folder");
    let study = head("failure-experiment")
        + "[failure-experiment]\nlocks = 5\nstart_deg = [0, 60, 60]\n\
           goals = [ { name = 'near', theta_deg = [10, 70, 50] }, { name = 'far', theta_deg = [0, 0, 0] } ]\n";
    let found = result(folder.path(), &study, &[]);
    let goals = found["goals"].as_array().expect("goals");
    assert_eq!(goals.len(), 2);
    // The stretched arm has one configuration: only the last locks, at the goal itself, are survived.
    assert!(goals[1]["success"].as_f64().is_some_and(|s| s < 0.5));
    assert!(
        goals[1]["worst_position_error_m"]
            .as_f64()
            .is_some_and(|e| e > 0.01)
    );
    assert!(folder.path().join("out/locks.csv").exists());
    // Without figures: numbers alone.
    let bare = study + "[report]\nfigures = false\n";
    fs::remove_dir_all(folder.path().join("out")).expect("a report");
    result(folder.path(), &bare, &[]);
    assert!(folder.path().join("out/locks.csv").exists());
    assert!(!folder.path().join("out/report.html").exists());
}

#[test]
fn bad_input_is_refused_with_its_place() {
    let failure = head("failure-experiment") + "[failure-experiment]\n";
    let goal = "goals = [ { name = 'a', theta_deg = [0, 0, 0] } ]\n";
    let cases: Vec<(String, &str)> = vec![
        (head("singularity"), "did you mean \"singularities\"?"),
        (
            head("singularities") + "[singularities]\nstarts = 0\n",
            "starts",
        ),
        (
            head("singularities") + "[singularities]\nstart = 3\n",
            "did you mean `starts`",
        ),
        (
            head("singularities") + "[pose]\nposition = [1, 1]\n",
            "no meaning",
        ),
        (
            head("singularities") + "[limits]\nlower_deg = [0,0,0]\nupper_deg = [1,1,1]\n",
            "no meaning",
        ),
        (
            head("estimate") + "[largest-manifold]\nfinalists = 1\n",
            "largest-manifold",
        ),
        (
            head("largest-manifold").replace("planar-position", "planar-pose"),
            "joints",
        ),
        (
            head("largest-manifold") + "[largest-manifold]\ncomparison = -1\n",
            "comparison",
        ),
        (head("failure-experiment"), "needs a start and goals"),
        (failure.clone() + goal, "start_deg"),
        (failure.clone() + "start_deg = [0, 0, 0]\n", "goals"),
        (
            failure.clone() + "start_deg = [0, 0]\n" + goal,
            "one entry per revolute joint",
        ),
        (
            failure.clone() + "start_deg = [0, 0, nan]\n" + goal,
            "start_deg",
        ),
        (
            failure.clone() + "start_deg = [0, 0, 0]\ngoals = []\n",
            "there is no goal",
        ),
        (
            failure.clone() + "start_deg = [0, 0, 0]\ngoals = 3\n",
            "goals",
        ),
        (
            failure.clone() + "start_deg = [0, 0, 0]\ngoals = [ { name = 'a' } ]\n",
            "theta_deg",
        ),
        (
            failure.clone() + "start_deg = [0, 0, 0]\nlocks = 1\n" + goal,
            "locks",
        ),
        (
            failure.clone()
                + "start_deg = [0, 0, 0]\ngoals = [ { name = 'a', theta_deg = [0,0,0] }, { name = 'a', theta_deg = [1,0,0] } ]\n",
            "one name",
        ),
        (
            failure + "start_deg = [0, 0, 0]\nstart = [1]\n" + goal,
            "prismatic",
        ),
    ];
    for (study, words) in cases {
        let folder = tempfile::tempdir().expect("a folder");
        let output = run(folder.path(), &study, &[]);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{study}\n{text}");
        assert!(text.contains(words), "{words} is not in\n{text}");
    }
}

#[test]
fn configurations_outside_physical_limits_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let robot = format!(
        "{PLANAR}[physical_limits]\nlower_deg = [-180, -90, -90]\nupper_deg = [180, 90, 90]\n"
    );
    let study = head("failure-experiment")
        + "[failure-experiment]\nstart_deg = [0, 0, 100]\ngoals = [ { name = 'a', theta_deg = [0, 0, 0] } ]\n";
    let path = write(folder.path(), &study);
    fs::write(folder.path().join("r.toml"), robot).expect("a folder");
    let mut command = Command::cargo_bin("faultspace").expect("the binary");
    let output = command
        .args(["check", path.to_str().expect("text")])
        .output()
        .expect("it runs");
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        text.contains("joint 3 is outside its physical limits"),
        "{text}"
    );
}
