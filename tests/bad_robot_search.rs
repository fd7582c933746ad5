//! Bad input of robot searches: exit code 2 and one message with file, line, key and a hint.

use assert_cmd::Command;
use std::fs;
use tempfile::TempDir;

/// A study of a shipped design with this task and table `[synthesis]`, which begins at line 5.
fn folder(design: &str, space: &str, table: &str) -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    let root = env!("CARGO_MANIFEST_DIR");
    let text = fs::read_to_string(format!("{root}/designs/{design}.toml")).unwrap();
    fs::write(dir.path().join("arm.toml"), text).unwrap();
    let study = format!(
        "kind = \"synthesis\"\ndesign = \"arm.toml\"\n[task]\nspace = \"{space}\"\n\
         [synthesis]\neffort = \"quick\"\n{table}\n"
    );
    fs::write(dir.path().join("study.toml"), study).unwrap();
    dir
}

fn check(dir: &TempDir) -> (Option<i32>, String) {
    let mut command = Command::cargo_bin("faultspace").unwrap();
    let command = command.current_dir(dir.path());
    let output = command.args(["check", "study.toml"]).output().unwrap();
    (
        output.status.code(),
        String::from_utf8(output.stderr).unwrap(),
    )
}

fn assert_refused(dir: &TempDir, parts: &[&str]) {
    let (code, message) = check(dir);
    assert_eq!(code, Some(2), "{message}");
    for part in parts {
        assert!(message.contains(part), "{part:?} is not in\n{message}");
    }
    assert!(message.contains("help: "), "no hint in\n{message}");
    assert_eq!(message.matches("error: ").count(), 1, "{message}");
}

#[test]
fn merits_that_do_not_exist() {
    for (wrong, meant) in [
        ("conditon", "condition"),
        ("null_component", "null-component"),
        ("margins", "margin"),
    ] {
        let objectives = format!("objectives = [\"share\", \"{wrong}\"]");
        let dir = folder("spatial_4r", "spatial-position", &objectives);
        let meant = format!("did you mean \"{meant}\"?");
        assert_refused(
            &dir,
            &["study.toml:7:", "objectives", &meant, "slenderness"],
        );
    }
}

/// Pre-images of more than one degree of redundancy are no curves.
#[test]
fn merits_that_the_robots_do_not_have() {
    for merit in ["condition", "null-component"] {
        let objectives = format!("objectives = [\"{merit}\"]");
        let dir = folder("spatial_8r", "spatial-pose", &objectives);
        assert_refused(&dir, &["study.toml:7:", "8 joints", "robots with 7 joints"]);
        let dir = folder(
            "spatial_7r",
            "spatial-pose",
            &format!("{objectives}\njoints = 8"),
        );
        assert_refused(&dir, &["study.toml:7:", "8 joints", "robots with 7 joints"]);
        let dir = folder("spatial_7r", "spatial-pose", &objectives);
        assert_eq!(check(&dir).0, Some(0));
    }
    let dir = folder("spatial_8r", "spatial-pose", "objectives = [\"margin\"]");
    assert_eq!(check(&dir).0, Some(0));
}

#[test]
fn shares_beyond_one() {
    let dir = folder("spatial_4r", "spatial-position", "min_share = 1.5");
    assert_refused(&dir, &["study.toml:7:", "min_share", "0.99"]);
}

/// Links of which no robot with the reach can be made.
#[test]
fn links_that_are_too_short() {
    let row = "{ a = 0.1, d = 0.1 }";
    let last = "{ a = 0.1, d = 0.1 }";
    let links = format!("links = [{{ a = 0.1 }}, {row}, {row}, {last}]");
    let dir = folder("spatial_4r", "spatial-position", &links);
    assert_refused(
        &dir,
        &["study.toml:7:", "links", "`reach` = 1 m", " m, none"],
    );
    let links = format!("links = [{{ a = 0.1 }}, {row}, {{}}, {{}}]");
    let dir = folder("spatial_4r", "spatial-position", &links);
    assert_eq!(check(&dir).0, Some(0), "{}", check(&dir).1);
}

/// No length is left to be searched: the robots that the lists allow are screened, and that is all.
#[test]
fn nothing_but_lists() {
    let dir = folder(
        "spatial_4r",
        "spatial-position",
        "links = [{ a = 0.25 }, { a = 0.25, d = 0 }, { a = 0.25, d = 0 }, { a = 0.25, d = 0 }]\n\
         screened = 4\ngenerations = 1\ntrial_generations = 1\npopulation = 4\nsamples = 100\n\
         fit_samples = 300\nselection_samples = 1024\nreport_samples = 1024\ncheck_poses = 0",
    );
    let mut command = Command::cargo_bin("faultspace").unwrap();
    let command = command.current_dir(dir.path());
    let output = command
        .args(["run", "study.toml", "--out", "out"])
        .output()
        .unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(matches!(output.status.code(), Some(0 | 1)), "{message}");
    assert!(!message.contains("panicked"), "{message}");
}
