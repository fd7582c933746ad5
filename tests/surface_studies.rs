//! Studies of poses with surplus joints and of robots on a rail, from the command line.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// A folder with a robot and studies of it.
struct Place(TempDir);

impl Place {
    fn new(robot: &str) -> Place {
        let place = Place(tempfile::tempdir().unwrap());
        place.write("arm.toml", &format!("name = \"arm\"\n{robot}\n"));
        place
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.path().join(name), text).unwrap();
    }

    fn run(&self, study: &str, out: &str) -> Output {
        self.write("study.toml", &format!("design = \"arm.toml\"\n{study}"));
        Command::new(env!("CARGO_BIN_EXE_faultspace"))
            .current_dir(self.0.path())
            .args([
                "run",
                "study.toml",
                "--quiet",
                "--json",
                "--no-cache",
                "--out",
                out,
            ])
            .output()
            .expect("the binary starts")
    }

    fn result(&self, study: &str, out: &str) -> Value {
        let output = self.run(study, out);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{message}");
        serde_json::from_slice(&output.stdout).unwrap()
    }

    fn refused(&self, study: &str, hints: &[&str]) {
        let output = self.run(study, "refused");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        for hint in hints {
            assert!(message.contains(hint), "{hint}: {message}");
        }
    }

    fn has(&self, name: &str) -> bool {
        Path::new(self.0.path()).join(name).exists()
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

const POSE: &str = "kind = \"manifolds\"\n[task]\nspace = \"planar-position\"\n";

/// At r = 3 joints 2 to 4 of four unit links range over ±120°.
#[test]
fn a_surface_is_reported_as_slices() {
    let place = Place::new("links = [1, 1, 1, 1]");
    let limits = "[limits]\nlower_deg = [-18, -60, -60, -60]\nupper_deg = [18, 60, 60, 60]\n";
    let pose = "[pose]\nposition = [0, 3]\n[manifolds]\nslices = 16\n";
    let result = place.result(&format!("{POSE}{pose}{limits}"), "out");
    assert_eq!(result["degree_of_redundancy"], 2);
    assert_eq!(result["manifolds"].as_array().unwrap().len(), 0);
    assert!(result.get("winding_sum").is_none());
    let slices = &result["slices"];
    assert_eq!(slices["joints"].to_string(), "[3]");
    assert_eq!(
        (&slices["values_per_joint"], &slices["count"]),
        (&16.into(), &16.into())
    );
    assert!(slices["with_curves"].as_u64() <= slices["curves"].as_u64());
    for joint in 1..4 {
        let arcs = result["joint_ranges_deg"][joint].as_array().unwrap();
        assert_eq!(arcs.len(), 1);
        assert!((number(&arcs[0][0]) + 120.0).abs() < 1e-3, "{arcs:?}");
        assert!((number(&arcs[0][1]) - 120.0).abs() < 1e-3, "{arcs:?}");
    }
    assert_eq!(result["completeness"]["kind"], "sampled");
    assert!(number(&result["completeness"]["missed_share"]) < 0.05);
    assert!(number(&result["residual"]["m"]) < 1e-5);
    for lock in &result["locks"].as_array().unwrap()[1..] {
        assert_eq!(lock["tolerated"], true);
    }
    assert!(!result["rotation_set_deg"].as_array().unwrap().is_empty());
    for name in ["slices.png", "slices.svg", "slices.csv", "report.html"] {
        assert!(place.has(&format!("out/{name}")), "{name}");
    }
    for name in ["manifolds.csv", "manifolds.png", "curves.vtk"] {
        assert!(!place.has(&format!("out/{name}")), "{name}");
    }
    // The study as run can be run again, and threads change nothing.
    let again = fs::read_to_string(place.0.path().join("out/study.toml")).unwrap();
    assert!(again.contains("slices = 16"), "{again}");
    let beyond = place.result(&format!("{POSE}[pose]\nposition = [0, 4.5]\n"), "beyond");
    assert_eq!(beyond["completeness"]["kind"], "proved");
    assert_eq!(beyond["joint_ranges_deg"][1].to_string(), "[]");
}

#[test]
fn three_surplus_joints_are_served_and_four_are_not() {
    let pose = "[pose]\nposition = [4, 0]\n[manifolds]\nslices = 8\nseeds = 32\n[report]\nfigures = false\n";
    let result = Place::new("links = [1, 1, 1, 1, 1]").result(&format!("{POSE}{pose}"), "out");
    assert_eq!(result["degree_of_redundancy"], 3);
    assert_eq!(result["slices"]["joints"].to_string(), "[3,4]");
    assert!((number(&result["joint_ranges_deg"][4][0][1]) - 120.0).abs() < 1e-3);
    let six = Place::new("links = [1, 1, 1, 1, 1, 1]");
    six.refused(&format!("{POSE}{pose}"), &["degree of redundancy of 4"]);
    let three = Place::new("links = [1, 1, 1]");
    three.refused(
        &format!("{POSE}{pose}"),
        &["slices", "one degree of redundancy"],
    );
}

/// Limits of 360° do not limit; narrower ones take rotations away.
#[test]
fn physical_limits_of_joint_1_are_part_of_the_verdict() {
    let limited = |lower: f64, upper: f64| {
        let place = Place::new(&format!(
            "convention = \"standard\"\njoints = [{}]\n[physical_limits]\n\
             lower_deg = [{lower}, -180, -180]\nupper_deg = [{upper}, 180, 180]",
            "{ kind = \"revolute\", a = 1 }, ".repeat(3)
        ));
        let limits = "[limits]\nlower_deg = [-30, -60, 20]\nupper_deg = [30, 70, 40]\n";
        let pose = "failures = [2]\n[pose]\nposition = [2.394, 0]\n[report]\nfigures = false\n";
        let result = place.result(&format!("{POSE}{pose}{limits}"), "out");
        let arcs = result["rotation_set_deg"].as_array().unwrap().clone();
        arcs.iter()
            .map(|arc| number(&arc[1]) - number(&arc[0]))
            .sum::<f64>()
    };
    let (free, narrow) = (limited(-180.0, 180.0), limited(-35.0, 35.0));
    assert!(narrow > 1.0 && narrow < free - 1.0, "{narrow} {free}");
}

const LIFT: &str = "convention = \"standard\"\njoints = [{ kind = \"prismatic\" }, \
    { kind = \"revolute\", a = 1 }, { kind = \"revolute\", a = 1 }, { kind = \"revolute\", a = 1 }]\n\
    [physical_limits]\nlower = [0]\nupper = [0.5]\nlower_deg = [-180, -180, -180]\n\
    upper_deg = [180, 180, 180]";

const SLIDING: &str = "[task]\nspace = \"spatial-position\"\nfailures = [2, 3, 4]\n";

/// A lift with a planar 3R: its best limits are those of the plane (3.562 m²) with the whole stroke.
#[test]
fn the_best_limits_of_a_lift_are_those_of_the_plane() {
    let place = Place::new(LIFT);
    let study = format!(
        "kind = \"optimise\"\nseed = 2\n{SLIDING}[estimator.hybrid]\nsamples = 12000\n\
         [optimiser.coordinate-ascent]\nrestarts = 6\n"
    );
    let result = place.result(&study, "out");
    let (size, error) = (
        number(&result["size"]["fault_tolerant"]),
        number(&result["size"]["standard_error"]),
    );
    println!("{size} ± {error}");
    assert!(
        (size - 0.5 * 3.562).abs() < 4.0 * error + 0.05,
        "{size} ± {error}"
    );
    assert!(number(&result["limits_m"]["lower"][0]) < 0.05);
    assert!(number(&result["limits_m"]["upper"][0]) > 0.45);
    assert_eq!(result["sampling"]["azimuths"], "all");
    let notes = result["notes"].to_string();
    assert!(notes.contains("Joint 1 slides"), "{notes}");
    assert!(place.has("out/report.html"));
    for name in ["half_plane.png", "workspace_spatial.png", "points.vtk"] {
        assert!(!place.has(&format!("out/{name}")), "{name}");
    }
}

#[test]
fn what_rests_on_turns_is_refused_where_joint_1_slides() {
    let place = Place::new(LIFT);
    let estimate = format!(
        "kind = \"estimate\"\n{SLIDING}[limits]\nlower = [0.1]\nupper = [0.4]\n\
         lower_deg = [-18, -111, -111]\nupper_deg = [18, 111, 111]\n[estimator.hybrid]\n"
    );
    place.refused(
        &format!("{estimate}sampling = \"grid\"\n"),
        &["half-plane", "joint 1", "lattice"],
    );
    place.refused(
        &format!("{estimate}rule = \"paper\"\n"),
        &["rule", "joint 1", "definition"],
    );
    let pose = "kind = \"manifolds\"\n[task]\nspace = \"spatial-position\"\n[pose]\n\
                position = [1, 0, 0.2]\n";
    place.refused(pose, &["joint 1 is prismatic", "hybrid"]);
}
