//! Bad input: exit code 2 and one message with file, line, key and a hint; nothing is written.

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

const ROBOT: &str = "name = \"arm\"\nlinks = [1.0, 1.0, 1.0]\n";
const STUDY: &str = "\
kind = \"estimate\"
design = \"arm.toml\"
seed = 1
[task]
space = \"planar-position\"
failures = \"any\"
[limits]
lower_deg = [-18, -111, -111]
upper_deg = [18, 111, 111]
[estimator]
method = \"exact\"
";

/// A folder with a good robot and a good study.
fn folder() -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("arm.toml"), ROBOT).unwrap();
    fs::write(dir.path().join("study.toml"), STUDY).unwrap();
    dir
}

fn faultspace(dir: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::cargo_bin("faultspace").unwrap();
    command
        .current_dir(dir)
        .args(arguments)
        .output()
        .expect("the binary starts")
}

/// Runs `study.toml` and expects a refusal whose message has all `parts`.
fn assert_refused(dir: &Path, parts: &[&str]) {
    let output = faultspace(dir, &["run", "study.toml", "--out", "out", "--json"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(output.stdout.is_empty());
    for part in parts {
        assert!(message.contains(part), "{part:?} is not in\n{message}");
    }
    assert!(message.contains("help: "), "no hint in\n{message}");
    assert_eq!(message.matches("error: ").count(), 1, "{message}");
    assert!(!dir.join("out").exists(), "something was written");
}

/// Replaces `good` in the study by `bad` and expects an error at `line`, about `key` (if any).
fn assert_bad_study(good: &str, bad: &str, line: usize, key: &str, hints: &[&str]) {
    let dir = folder();
    assert!(STUDY.contains(good), "{good:?} is not in the study");
    fs::write(dir.path().join("study.toml"), STUDY.replacen(good, bad, 1)).unwrap();
    let place = format!("study.toml:{line}:");
    let key = match key {
        "" => String::new(),
        key => format!("`{key}`"),
    };
    assert_refused(dir.path(), &[&[place.as_str(), &key][..], hints].concat());
}

/// Uses `robot` instead of the good one and expects an error at `line` of its file.
fn assert_bad_robot(robot: &str, line: usize, key: &str, hints: &[&str]) {
    let dir = folder();
    fs::write(dir.path().join("arm.toml"), robot).unwrap();
    let (place, key) = (format!("arm.toml:{line}:"), format!("`{key}`"));
    assert_refused(dir.path(), &[&[place.as_str(), &key][..], hints].concat());
}

#[test]
fn unknown_keys_name_the_nearest() {
    assert_bad_study("seed", "sede", 3, "sede", &["did you mean `seed`?"]);
    let hints = ["did you mean `upper_deg`?"];
    assert_bad_study("upper_deg", "uper_deg", 9, "limits.uper_deg", &hints);
    let hints = ["did you mean `limits`?"];
    assert_bad_study("[limits]", "[limit]", 7, "limit", &hints);
    let robot = ROBOT.replace("links", "lniks");
    assert_bad_robot(&robot, 2, "lniks", &["did you mean `links`?"]);
}

#[test]
fn unknown_choices_name_the_nearest() {
    let hints = ["did you mean \"planar-position\"?", "planer-position"];
    assert_bad_study(
        "planar-position",
        "planer-position",
        5,
        "task.space",
        &hints,
    );
    assert_bad_study("\"estimate\"", "\"optimize\"", 1, "kind", &["\"optimise\""]);
    assert_bad_study(
        "\"estimate\"",
        "\"redundancy\"",
        1,
        "kind",
        &["\"optimise\""],
    );
    let hints = ["did you mean \"hybrid\"?"];
    assert_bad_study("\"exact\"", "\"hybird\"", 11, "estimator.method", &hints);
}

#[test]
fn wrong_types() {
    let hints = ["found the string \"1\"", "a whole number"];
    assert_bad_study("seed = 1", "seed = \"1\"", 3, "seed", &hints);
    assert_bad_study(
        "seed = 1",
        "seed = -1",
        3,
        "seed",
        &["found -1", "at least 0"],
    );
    assert_bad_study("[18, 111, 111]", "18", 9, "limits.upper_deg", &["array"]);
    assert_bad_study("-18, -111", "-18, true", 8, "limits.lower_deg", &["true"]);
    assert_bad_robot(
        "name = 3\nlinks = [1, 1, 1]\n",
        1,
        "name",
        &["found the integer 3"],
    );
}

#[test]
fn nan_and_infinity() {
    for bad in ["nan", "inf", "-inf", "1e999"] {
        let limits = format!("-18, {bad}");
        let found = format!("found {bad}");
        assert_bad_study("-18, -111", &limits, 8, "limits.lower_deg", &[&found]);
        let robot = format!("name = \"arm\"\nlinks = [1.0, {bad}, 1.0]\n");
        assert_bad_robot(&robot, 2, "links", &[&found]);
    }
}

#[test]
fn too_few_joints_for_the_task() {
    let hints = ["needs more joints than the task has dimensions"];
    assert_bad_study("planar-position", "planar-pose", 5, "task.space", &hints);
}

#[test]
fn negative_and_zero_lengths() {
    for bad in ["-1.0", "0.0"] {
        let robot = format!("name = \"arm\"\nlinks = [\n  1.0,\n  {bad},\n  1.0,\n]\n");
        let found = format!("found {bad}");
        assert_bad_robot(
            &robot,
            4,
            "links",
            &[&found, "link 2 needs a positive length"],
        );
    }
}

#[test]
fn lower_above_upper() {
    let hints = ["found -19", "at least the lower limit -18"];
    assert_bad_study("[18, 111", "[-19, 111", 9, "limits.upper_deg", &hints);
}

#[test]
fn width_above_360_degrees() {
    let hints = ["found 250", "more than 360° apart", "joint 2"];
    assert_bad_study("[18, 111", "[18, 250", 9, "limits.upper_deg", &hints);
}

#[test]
fn a_limit_is_missing() {
    let hints = ["found 2 entries", "expected 3 entries"];
    assert_bad_study("[18, 111, 111]", "[18, 111]", 9, "limits.upper_deg", &hints);
    let hints = ["missing", "add `upper_deg"];
    let line = "upper_deg = [18, 111, 111]\n";
    assert_bad_study(line, "", 7, "limits.upper_deg", &hints);
}

#[test]
fn failure_sets() {
    let bad = |set: &str, hint: &str| {
        assert_bad_study("failures = \"any\"", set, 6, "task.failures", &[hint]);
    };
    bad("failures = []", "empty");
    bad("failures = [1, 4]", "no joint 4");
    bad("failures = [0]", "at least 1");
    bad("failures = [2, 2]", "twice");
    bad("failures = \"all\"", "did you mean \"any\"?");
}

#[test]
fn margins() {
    let bad = |value: &str, hints: &[&str]| {
        let text = format!("failures = \"any\"\nmargin_deg = {value}");
        assert_bad_study("failures = \"any\"", &text, 7, "task.margin_deg", hints);
    };
    bad("-1", &["from 0 to 90 degrees"]);
    bad("91", &["from 0 to 90 degrees"]);
    bad("nan", &["from 0 to 90 degrees"]);
    bad("\"2\"", &["expected a number"]);
    bad("[1, 1, 1]", &["expected a number"]);
}

#[test]
fn a_missing_design_file() {
    let hints = ["nowhere.toml", "relative to the study file"];
    assert_bad_study("arm.toml", "nowhere.toml", 2, "design", &hints);
}

#[test]
fn an_estimator_that_cannot_serve() {
    let hints = ["unknown choice", "\"hybrid\""];
    assert_bad_study("\"exact\"", "\"neural\"", 11, "estimator.method", &hints);
    let hints = ["measures nothing", "\"hybrid\""];
    assert_bad_study("\"exact\"", "\"surrogate\"", 11, "estimator.method", &hints);
    let dir = folder();
    let row = "{ kind = \"revolute\", alpha_deg = 90, a = 0.5 }";
    let robot =
        format!("name = \"arm\"\nconvention = \"standard\"\njoints = [{row}, {row}, {row}]\n");
    fs::write(dir.path().join("arm.toml"), robot).unwrap();
    let parts = [
        "study.toml:11:",
        "`estimator.method`",
        "hybrid",
        "twist of row 1",
    ];
    assert_refused(dir.path(), &parts);
}

/// Settings of the hybrid estimator, one line each below `[estimator.hybrid]`.
#[test]
fn settings_of_the_hybrid_estimator() {
    let bad = |line: &str, key: &str, hints: &[&str]| {
        let table = format!("\"hybrid\"\n[estimator.hybrid]\n{line}");
        let key = format!("estimator.hybrid.{key}");
        // The last line of `line` is the bad one.
        let number = 12 + line.lines().count();
        assert_bad_study("\"exact\"", &table, number, &key, hints);
    };
    bad("sample = 1", "sample", &["did you mean `samples`?"]);
    bad("samples = 0", "samples", &["found 0", "from 32"]);
    bad("samples = 1.5", "samples", &["found the float 1.5"]);
    bad(
        "samples = 320\nreplicates = 21",
        "replicates",
        &["from 2 to 20", "`samples`"],
    );
    bad("replicates = 1", "replicates", &["from 2"]);
    bad(
        "sampling = \"grit\"",
        "sampling",
        &["did you mean \"grid\"?"],
    );
    bad("cell = 0.1", "cell", &["only with `sampling = \"grid\"`"]);
    bad(
        "centres = true",
        "centres",
        &["only with `sampling = \"grid\"`"],
    );
    let grid = "sampling = \"grid\"\n";
    bad(&format!("{grid}cell = 0.7"), "cell", &["from 0.002 to 0.5"]);
    bad(&format!("{grid}cell = nan"), "cell", &["finite"]);
    bad(
        &format!("{grid}samples = 99"),
        "samples",
        &["only with `sampling = \"lattice\"`"],
    );
    bad(
        &format!("{grid}orientations = 5"),
        "orientations",
        &["no orientations", "expected 1"],
    );
    bad(
        &format!("{grid}centres = 1"),
        "centres",
        &["`true` or `false`"],
    );
    bad("tolerance_rad = 1", "tolerance_rad", &["0.2 rad"]);
    bad("memory_limit_mb = 0", "memory_limit_mb", &["found 0"]);
    bad("rule = \"max\"", "rule", &["\"definition\"", "\"paper\""]);
    let hints = ["reports no rotation sets", "manifolds"];
    let radii = "\"hybrid\"\n[estimate]\nradii = [1.0]";
    assert_bad_study("\"exact\"", radii, 13, "estimate.radii", &hints);
}

/// A study of one pose in the plane; lines 1 to 9.
const POSE: &str = "\
kind = \"manifolds\"
design = \"arm.toml\"
[task]
space = \"planar-position\"
[pose]
position = [1.0, 0.5]
[manifolds]
seeds = 64
residual = 1e-6
";

#[test]
fn poses() {
    let bad = |good: &str, bad: &str, line: usize, key: &str, hints: &[&str]| {
        let dir = folder();
        assert!(POSE.contains(good));
        fs::write(dir.path().join("study.toml"), POSE.replacen(good, bad, 1)).unwrap();
        let (place, key) = (format!("study.toml:{line}:"), format!("`{key}`"));
        assert_refused(dir.path(), &[&[place.as_str(), &key][..], hints].concat());
    };
    bad(
        "[1.0, 0.5]",
        "[1.0]",
        6,
        "pose.position",
        &["2 numbers", "found 1 entries"],
    );
    bad(
        "[1.0, 0.5]",
        "[1.0, inf]",
        6,
        "pose.position",
        &["found inf"],
    );
    bad(
        "position =",
        "positon =",
        6,
        "pose.positon",
        &["did you mean `position`?"],
    );
    let orientation = "[1.0, 0.5]\nphi_deg = 30";
    bad(
        "[1.0, 0.5]",
        orientation,
        7,
        "pose.phi_deg",
        &["no meaning"],
    );
    let rotation = "[1.0, 0.5]\nrotation = [[1, 2], 3]";
    bad(
        "[1.0, 0.5]",
        rotation,
        7,
        "pose.rotation",
        &["row of three numbers"],
    );
    bad(
        "planar-position",
        "spatial-pose",
        4,
        "task.space",
        &["more joints"],
    );
    bad("64", "0", 8, "manifolds.seeds", &["found 0"]);
    bad("1e-6", "0", 9, "manifolds.residual", &["from 0.000000001"]);
    bad(
        "[manifolds]",
        "[search]\n[manifolds]",
        7,
        "search",
        &["kind = \"optimise\""],
    );
    bad(
        "[manifolds]",
        "[estimator]\n[manifolds]",
        7,
        "estimator",
        &["kind = \"estimate\""],
    );
    let limits = "[limits]\nlower_deg = [0]\nupper_deg = [1]\n[manifolds]";
    bad(
        "[manifolds]",
        limits,
        8,
        "limits.lower_deg",
        &["expected 3 entries"],
    );
    bad(
        "[pose]\nposition = [1.0, 0.5]\n",
        "",
        1,
        "pose",
        &["needs a pose"],
    );
}

#[test]
fn tables_of_another_kind() {
    let hints = ["kind = \"optimise\""];
    assert_bad_study("[estimator]", "[search]\n[estimator]", 10, "search", &hints);
}

#[test]
fn broken_toml() {
    assert_bad_study("seed = 1", "seed = = 1", 3, "seed", &["not TOML"]);
    assert_bad_study("[limits]", "[limits", 7, "", &["not TOML"]);
    assert_bad_study("seed = 1", "kind = \"x\"", 3, "kind", &["duplicate"]);
}

#[test]
fn urdf_files_must_be_there() {
    let robot = "name = \"arm\"\nurdf = \"none.urdf\"\n";
    let hints = ["cannot read the URDF file", "relative to the robot file"];
    assert_bad_robot(robot, 2, "urdf", &hints);
}

#[test]
fn missing_and_unreadable_studies() {
    let dir = folder();
    fs::write(dir.path().join("binary.toml"), b"kind = \"\xff\xfe\"\n").unwrap();
    for (file, hint) in [
        ("none.toml", "none.toml"),
        ("binary.toml", "binary.toml:1:"),
    ] {
        let output = faultspace(dir.path(), &["run", file, "--out", "out"]);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(
            message.contains(hint) && message.contains("help: "),
            "{message}"
        );
        assert!(!dir.path().join("out").exists());
    }
}

#[test]
fn an_existing_report_is_left_alone() {
    let dir = folder();
    let out = dir.path().join("out");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("result.json"), "{}").unwrap();
    let output = faultspace(dir.path(), &["run", "study.toml", "--out", "out"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    for part in ["out", "--overwrite", "--resume", "already exists"] {
        assert!(message.contains(part), "{part} is not in\n{message}");
    }
    assert_eq!(fs::read_to_string(out.join("result.json")).unwrap(), "{}");
    assert_eq!(fs::read_dir(&out).unwrap().count(), 1);
}

#[test]
fn an_unwritable_folder_is_refused_before_the_run() {
    let dir = folder();
    // A file where a folder is needed stops every user, also one who may write anywhere.
    let output = faultspace(dir.path(), &["run", "study.toml", "--out", "arm.toml/out"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(
        message.contains("arm.toml/out") && message.contains("--out"),
        "{message}"
    );
}

#[test]
fn bad_arguments() {
    let dir = folder();
    for arguments in [
        &["run", "study.toml", "--threads", "0"][..],
        &["run", "study.toml", "--seed", "-1"],
        &["run", "study.toml", "--resume", "--overwrite"],
        &["run"],
        &["walk"],
    ] {
        let output = faultspace(dir.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(!dir.path().join("reports").exists());
    }
}

#[test]
fn check_looks_at_every_file() {
    let dir = folder();
    fs::write(dir.path().join("bad.toml"), "name = \"x\"\nlinks = [1]\n").unwrap();
    let files = ["check", "bad.toml", "arm.toml", "study.toml"];
    let output = faultspace(dir.path(), &files);
    assert_eq!(output.status.code(), Some(2));
    let stdout = String::from_utf8(output.stdout).unwrap();
    assert_eq!(stdout.matches("ok: ").count(), 2, "{stdout}");
    let good = faultspace(dir.path(), &["check", "arm.toml", "study.toml"]);
    assert_eq!(good.status.code(), Some(0));
}

#[test]
fn list_and_show_survive_bad_files() {
    let dir = folder();
    fs::create_dir(dir.path().join("designs")).unwrap();
    fs::write(dir.path().join("designs/bad.toml"), "links = 3").unwrap();
    let output = faultspace(dir.path(), &["list"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8(output.stdout).unwrap().contains("(bad: "));
    let shown = faultspace(dir.path(), &["show", "designs/bad.toml"]);
    assert_eq!(shown.status.code(), Some(2));
    let shown = faultspace(dir.path(), &["show", "arm.toml"]);
    let text = String::from_utf8(shown.stdout).unwrap();
    assert!(
        text.contains("arm") && text.contains("planar-position:   1"),
        "{text}"
    );
}
