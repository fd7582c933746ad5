//! Structural verdicts: which robots have a joint that stands still in every self-motion, and what
//! studies and `show` make of it.

use assert_cmd::Command;
use faultspace::design::{Geometry, Robot, TaskSpace, read_design};
use faultspace::manifold::{Intolerance, SelfMotionShares};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

fn path(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("designs");
    folder.join(name)
}

fn design(name: &str) -> Robot {
    read_design(&path(name)).unwrap()
}

fn verdict(robot: &Robot, task: TaskSpace) -> Option<Intolerance> {
    Intolerance::of(robot, task, |_| true)
}

#[test]
fn the_elbow_of_a_shoulder_elbow_wrist_arm_stands_still() {
    for name in ["pa10.toml", "kuka_iiwa_14.toml"] {
        let found = verdict(&design(name), TaskSpace::SpatialPose).expect(name);
        assert_eq!(found.joints, [4], "{name}");
        assert!(found.largest_component < 1e-12 && found.configurations > 100);
        assert!(!found.cures.is_empty());
        let text = found.to_string();
        assert!(text.contains("structurally intolerant: joint 4 stands"));
    }
}

#[test]
fn other_robots_are_not_accused() {
    let spatial = ["franka_panda.toml", "kinova_gen3.toml", "spatial_7r.toml"];
    for name in spatial.into_iter().chain(["spatial_8r.toml"]) {
        assert_eq!(
            verdict(&design(name), TaskSpace::SpatialPose),
            None,
            "{name}"
        );
    }
    let planar = design("planar_3r_equal.toml");
    assert_eq!(verdict(&planar, TaskSpace::PlanarPosition), None);
    // A task without redundancy, and one that the robot cannot do at all.
    assert_eq!(verdict(&planar, TaskSpace::PlanarPose), None);
    assert_eq!(verdict(&planar, TaskSpace::SpatialPosition), None);
}

/// With one degree of redundancy the null space is one unit vector.
#[test]
fn components_are_those_of_unit_vectors() {
    let planar = design("planar_3r_equal.toml");
    let shares = SelfMotionShares::of(&planar, TaskSpace::PlanarPosition).unwrap();
    assert!(shares.still_joints().is_empty());
    for (largest, median) in shares.largest.iter().zip(&shares.median) {
        assert!(*median > 0.1 && median < largest && *largest <= 1.0 + 1e-12);
    }
}

/// An elbow offset leaves the distance of shoulder and wrist a function of joint 4 alone; an
/// offset inside the shoulder or the wrist does not.
#[test]
fn cures_break_the_shoulder_or_the_wrist() {
    let mut robot = design("pa10.toml");
    let found = verdict(&robot, TaskSpace::SpatialPose).unwrap();
    let names: Vec<String> = found.cures.iter().map(|cure| cure.to_string()).collect();
    for useless in ["d_1", "a_3", "d_3", "a_4", "d_5", "d_7"] {
        assert!(!names.iter().any(|name| name == useless), "{names:?}");
    }
    for useful in ["a_1", "a_2", "d_2", "a_5", "d_6", "a_6"] {
        assert!(names.iter().any(|name| name == useful), "{names:?}");
    }
    let Geometry::Rows { joints, .. } = &mut robot.geometry else {
        panic!("rows");
    };
    joints[2].link.length = 0.05;
    joints[3].link.length = -0.05;
    assert!(verdict(&robot, TaskSpace::SpatialPose).is_some());
    let Geometry::Rows { joints, .. } = &mut robot.geometry else {
        panic!("rows");
    };
    joints[0].link.length = found.offset;
    assert_eq!(verdict(&robot, TaskSpace::SpatialPose), None);
}

#[test]
fn only_joints_that_may_fail_count() {
    let robot = design("pa10.toml");
    let others = |joint| joint != 4;
    assert_eq!(
        Intolerance::of(&robot, TaskSpace::SpatialPose, others),
        None
    );
}

/// Runs a study of the PA-10 and returns its result.
fn run(folder: &Path, kind: &str, more: &str) -> Value {
    let design = path("pa10.toml").display().to_string();
    let study = format!(
        "kind = \"{kind}\"\ndesign = '{design}'\n[task]\nspace = \"spatial-pose\"\n{more}\n\
         [estimator.hybrid]\nsamples = 800\n[report]\nfigures = false\n"
    );
    fs::write(folder.join("study.toml"), study).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_faultspace"));
    let arguments = ["run", "study.toml", "--quiet", "--json", "--out", kind];
    let output = command
        .current_dir(folder)
        .env("FAULTSPACE_CACHE", folder.join("cache"))
        .args(arguments)
        .output()
        .unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{message}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_search_that_cannot_succeed_ends_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let started = Instant::now();
    let result = run(folder.path(), "optimise", "failures = \"any\"");
    assert!(started.elapsed().as_secs_f64() < 5.0);
    assert_eq!(result["status"], "structurally-intolerant");
    assert_eq!(result["size"]["fault_tolerant"], 0.0);
    assert_eq!(result["structure"]["joint"], 4);
    assert!(result["notes"][0].as_str().unwrap().contains("joint 4"));
    let report = folder.path().join("optimise");
    assert!(report.join("result.json").exists() && report.join("study.toml").exists());
    assert!(!folder.path().join("cache").exists(), "nothing is traced");
}

#[test]
fn an_estimate_agrees_with_its_verdict() {
    let limits = "failures = \"any\"\n[limits]\nlower_deg = [-170, -90, -170, 30, -170, -90, -170]\n\
                  upper_deg = [170, 90, 170, 90, 170, 90, 170]";
    let folder = tempfile::tempdir().unwrap();
    let result = run(folder.path(), "estimate", limits);
    assert_eq!(result["status"], "done");
    assert_eq!(result["structure"]["joint"], 4);
    assert_eq!(result["size"]["fault_tolerant"], 0.0);
    assert!(
        result["workspaces"]["pre_failure"]["size"]
            .as_f64()
            .unwrap()
            > 0.0
    );
    let spared = limits.replace("\"any\"", "[1, 2, 3, 5, 6, 7]");
    let other = tempfile::tempdir().unwrap();
    let result = run(other.path(), "estimate", &spared);
    assert!(result["structure"].is_null());
}

#[test]
fn show_prints_the_verdict() {
    let show = |name: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_faultspace"));
        let output = command.arg("show").arg(path(name)).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(show("pa10.toml").contains("structurally intolerant: joint 4"));
    assert!(!show("franka_panda.toml").contains("intolerant"));
}
