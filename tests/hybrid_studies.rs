//! Studies with the hybrid estimator and studies of one pose, from the command line: what they
//! find, and that neither threads, cache, damage nor a kill changes it.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A folder with a study, its robot and a cache of its own.
struct Place {
    dir: TempDir,
}

impl Place {
    /// `head` goes before the estimator's table, `hybrid` into it.
    fn new(links: &str, head: &str, hybrid: &str) -> Place {
        let place = Place {
            dir: tempfile::tempdir().unwrap(),
        };
        place.write("arm.toml", &format!("name = \"arm\"\nlinks = {links}\n"));
        let estimator = format!("[estimator]\nmethod = \"hybrid\"\n[estimator.hybrid]\n{hybrid}\n");
        let report = "[report]\nfigures = false\n";
        let study = format!("design = \"arm.toml\"\n{head}{estimator}{report}");
        place.write("study.toml", &study);
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_faultspace"));
        command
            .current_dir(self.dir.path())
            .env("FAULTSPACE_CACHE", self.path("cache"))
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        command
    }

    fn call(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().expect("the binary starts")
    }

    /// Calls faultspace, which must succeed, and returns what it printed.
    fn done(&self, arguments: &[&str]) -> String {
        let output = self.call(arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{message}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs the study and returns the result without what may differ.
    fn result(&self, out: &str, more: &[&str]) -> Value {
        let arguments = ["run", "study.toml", "--quiet", "--json", "--out", out];
        let text = self.done(&[&arguments, more].concat());
        let mut result: Value = serde_json::from_str(&text).unwrap();
        let fields = result.as_object_mut().unwrap();
        assert!(fields.remove("seconds").is_some() && fields.remove("provenance").is_some());
        result
    }

    /// All shards below the cache folder `cache`, with their bytes.
    fn shards(&self, cache: &str) -> Vec<(String, Vec<u8>)> {
        let mut shards = Vec::new();
        for atlas in fs::read_dir(self.path(cache)).unwrap() {
            let atlas = atlas.unwrap();
            for shard in fs::read_dir(atlas.path()).unwrap() {
                let path = shard.unwrap().path();
                let name = path.strip_prefix(self.path(cache)).unwrap();
                shards.push((name.display().to_string(), fs::read(&path).unwrap()));
            }
        }
        shards.sort();
        shards
    }
}

const POSITION: &str = "kind = \"estimate\"\n[task]\nspace = \"planar-position\"\n[limits]\n\
    lower_deg = [-18.21, -111.322, -111.322]\nupper_deg = [18.21, 111.322, 111.322]\n";
const R3: &str = "[1.0, 1.0, 1.0]";

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// Asserts that `found` lies within four standard errors of `exact`, and that these are small.
fn assert_agrees(found: f64, error: f64, exact: f64) {
    assert!(
        (found - exact).abs() < 4.0 * error,
        "{found} ± {error} for {exact}"
    );
    assert!(error > 0.0 && error < 0.04 * exact, "{error} of {exact}");
}

#[test]
fn planar_positions_agree_with_the_closed_form() {
    for hybrid in ["samples = 8000", "sampling = \"grid\"\ncell = 0.002"] {
        let place = Place::new(R3, POSITION, hybrid);
        let result = place.result("out", &["--no-cache"]);
        let size = &result["size"];
        assert_agrees(
            number(&size["fault_tolerant"]),
            number(&size["standard_error"]),
            3.562,
        );
        assert!((number(&size["unrestricted"]) / 28.274_333_9 - 1.0).abs() < 0.02);
        assert_eq!(result["failed_poses"], 0);
        assert_eq!(result["size"]["unit"], "m^2");
        assert!(!place.path("cache").exists(), "--no-cache left something");
    }
}

/// The closed form is 12.6 % of 9π; inverse kinematics knows neither it nor the manifolds.
#[test]
fn inverse_kinematics_checks_what_was_measured() {
    let place = Place::new(R3, POSITION, "samples = 4096\ncheck_poses = 2000");
    let result = place.result("out", &[]);
    let check = &result["locked_joint_check"];
    assert_eq!(check["poses"], 2000);
    let share = &check["share"];
    let exact = 3.562 / 28.274_333_9;
    assert_agrees_loosely(share, exact);
    let off = number(&check["difference_in_standard_errors"]);
    let measured = number(&result["size"]["normalised"]);
    assert_eq!(off > 0.0, number(&share["value"]) > measured);
    let notes = result["notes"].to_string();
    assert!(notes.contains("Inverse kinematics"), "{notes}");
    assert_eq!(notes.contains("do not rely"), off.abs() > 3.0, "{notes}");
    let said = place.done(&["run", "study.toml", "--quiet", "--overwrite"]);
    assert!(said.contains("the same, checked"), "{said}");

    let unasked = Place::new(R3, POSITION, "samples = 4096").result("out", &[]);
    assert!(unasked["locked_joint_check"].is_null());
    assert_eq!(unasked["size"], result["size"], "a check changes nothing");
}

/// Within four standard errors of an estimate that few poses give.
fn assert_agrees_loosely(estimate: &Value, exact: f64) {
    let [value, error] = ["value", "standard_error"].map(|key| number(&estimate[key]));
    assert!((value - exact).abs() < 4.0 * error && error < 0.1 * exact);
}

#[test]
fn planar_poses_agree_with_the_exact_estimator() {
    let head = "kind = \"estimate\"\n[task]\nspace = \"planar-pose\"\n[limits]\n\
        lower_deg = [-120, 90, 92, -170]\nupper_deg = [120, 143, 141, 170]\n";
    let place = Place::new("[1.0, 1.0, 1.0, 1.0]", head, "samples = 8000");
    let hybrid = place.result("hybrid", &[]);
    let study = fs::read_to_string(place.path("study.toml")).unwrap();
    place.write("study.toml", &study.replace("\"hybrid\"", "\"exact\""));
    let exact = place.result("exact", &[]);
    for name in ["pre_failure", "unrestricted"] {
        let (a, b) = (&hybrid["workspaces"][name], &exact["workspaces"][name]);
        assert_agrees(number(&a["size"]), number(&a["error"]), number(&b["size"]));
    }
    for joint in 0..4 {
        let [a, b] = [&hybrid, &exact].map(|r| &r["workspaces"]["post_failure"][joint]);
        assert_agrees(number(&a["size"]), number(&a["error"]), number(&b["size"]));
    }
    let size = &hybrid["size"];
    let exact = number(&exact["size"]["fault_tolerant"]);
    assert_agrees(
        number(&size["fault_tolerant"]),
        number(&size["standard_error"]),
        exact,
    );
}

#[test]
fn threads_cache_and_damage_change_nothing() {
    let place = Place::new(R3, POSITION, "samples = 4096");
    let first = place.result("one", &["--threads", "1"]);
    let shards = place.shards("cache");
    assert_eq!(shards.len(), 4);
    let arguments = ["--threads", "2", "--cache", "other"];
    assert_eq!(place.result("two", &arguments), first);
    assert_eq!(place.shards("other"), shards);
    assert_eq!(place.result("hit", &[]), first);
    assert_eq!(place.result("memory", &["--no-cache"]), first);
    let path = |name: &str| place.path("cache").join(name);
    let (bytes, middle) = (&shards[1].1, shards[1].1.len() / 2);
    let mut flipped = bytes.clone();
    flipped[middle] ^= 1;
    for damaged in [&bytes[..0], &bytes[..63], &bytes[..middle], &flipped, b"x"] {
        fs::write(path(&shards[1].0), damaged).unwrap();
        fs::remove_file(path(&shards[2].0)).unwrap();
        assert_eq!(place.result("again", &["--overwrite"]), first);
        assert_eq!(place.shards("cache"), shards);
    }
}

#[test]
fn parts_make_up_the_whole() {
    let head = POSITION.replace("estimate", "optimise");
    let few = "[optimiser.coordinate-ascent]\nrestarts = 2\nfinalists = 1\nmax_sweeps = 2\n";
    let place = Place::new(R3, &format!("{head}{few}"), "samples = 3000");
    let whole = place.result("whole", &[]);
    for (part, cache) in [("1/2", "a"), ("2/2", "b")] {
        let arguments = [
            "run",
            "study.toml",
            "--quiet",
            "--shard",
            part,
            "--cache",
            cache,
        ];
        let text = place.done(&arguments);
        assert!(text.contains("of 6 shards"), "{text}");
    }
    let text = place.done(&["merge", "study.toml", "a", "--cache", "c"]);
    assert!(
        text.contains("4 of 6 shards copied; 2 are still missing"),
        "{text}"
    );
    let text = place.done(&["merge", "study.toml", "a", "b", "--cache", "c"]);
    assert!(
        text.contains("2 of 6 shards copied; none is missing"),
        "{text}"
    );
    assert_eq!(place.shards("c"), place.shards("cache"));
    assert_eq!(place.result("merged", &["--cache", "c"]), whole);

    // The search's own samples flatter its optimum; the headline is of others.
    let search = &whole["search"];
    let stages = search["stages"].as_array().unwrap();
    let samples: Vec<f64> = stages.iter().map(|s| number(&s["samples"])).collect();
    assert_eq!(samples, [752.0, 2992.0]);
    assert_eq!(search["score_on_search_sample"], stages[1]["score"]);
    assert_eq!(place.result("serial", &["--threads", "1"]), whole);
    let (seen, size) = (
        &search["score_on_search_sample"],
        &whole["size"]["fault_tolerant"],
    );
    assert!(number(seen) > 3.0 && number(size) > 3.0 && seen != size);
    assert_eq!(whole["limits_deg"]["lower"].as_array().unwrap().len(), 3);
}

#[test]
fn a_killed_build_goes_on_where_it_was() {
    let place = Place::new(R3, POSITION, "samples = 30720");
    let first = place.result("whole", &["--no-cache"]);
    let shard = |number: usize| {
        let folders = fs::read_dir(place.path("cache")).into_iter().flatten();
        let mut atlases = folders.map(|folder| folder.unwrap().path());
        let name = format!("{number:06}.shard");
        atlases.any(|atlas| atlas.join(&name).exists())
    };
    let arguments = [
        "run",
        "study.toml",
        "--quiet",
        "--out",
        "out",
        "--threads",
        "1",
    ];
    let mut child = place.command(&arguments).spawn().unwrap();
    let started = Instant::now();
    while !shard(1) && started.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(1));
    }
    child.kill().unwrap(); // SIGKILL
    child.wait().unwrap();
    assert!(shard(1) && !shard(29), "not killed in the middle");
    let kept = fs::metadata(find(&place.path("cache"), "000001.shard")).unwrap();
    // Neither `--resume` nor `--overwrite` is needed.
    assert_eq!(place.result("out", &[]), first);
    let after = fs::metadata(find(&place.path("cache"), "000001.shard")).unwrap();
    assert_eq!(kept.modified().unwrap(), after.modified().unwrap());
}

fn find(cache: &Path, name: &str) -> PathBuf {
    let folders = fs::read_dir(cache).unwrap();
    let paths = folders.map(|folder| folder.unwrap().path().join(name));
    paths.into_iter().find(|path| path.exists()).unwrap()
}

/// A message of bad input, exit code 2, and nothing written.
fn assert_refused(place: &Place, more: &[&str], parts: &[&str]) {
    let arguments = ["run", "study.toml", "--quiet", "--out", "refused"];
    let output = place.call(&[&arguments, more].concat());
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    for part in parts {
        assert!(message.contains(part), "{part:?} is not in\n{message}");
    }
    assert!(!place.path("refused").exists(), "something was written");
}

#[test]
fn what_does_not_fit_is_refused_before_anything_is_written() {
    let place = Place::new(R3, POSITION, "samples = 50000000\nmemory_limit_mb = 3");
    let parts = [
        "at most 3 MB",
        "memory_limit_mb",
        "fewer samples",
        "of one core",
    ];
    assert_refused(&place, &["--no-cache"], &parts);
    let head = POSITION
        .replace("position", "pose")
        .replace("111.322]", "111.322, 180]");
    let grid = "sampling = \"grid\"\norientations = 90000000";
    let place = Place::new("[1.0, 1.0, 1.0, 1.0]", &head, grid);
    assert_refused(
        &place,
        &["--no-cache"],
        &["too many samples", "`orientations`"],
    );
    let place = Place::new(R3, POSITION, "rule = \"paper\"\ncheck_poses = 10");
    assert_refused(&place, &[], &["check_poses", "definition", "remove"]);
    let place = Place::new(R3, POSITION, "samples = 4096");
    let parts = ["cache folder cannot be written to", "--no-cache"];
    assert_refused(&place, &["--cache", "arm.toml/x"], &parts);
    assert_refused(&place, &["--shard", "3/2"], &["I from 1 to N"]);
    assert_refused(
        &place,
        &["--shard", "1/2", "--no-cache"],
        &["cannot be used with"],
    );
    let output = place.call(&["merge", "study.toml", "nowhere"]);
    assert_eq!(output.status.code(), Some(2));
    let study = fs::read_to_string(place.path("study.toml")).unwrap();
    place.write("study.toml", &study.replace("\"hybrid\"", "\"exact\""));
    assert_refused(&place, &["--shard", "1/2"], &["no atlas", "--shard"]);
}

#[test]
fn manifolds_of_a_spatial_pose() {
    let place = Place::new(R3, POSITION, "");
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies/manifolds_7r.toml");
    let study = shipped.to_string_lossy().into_owned();
    let arguments = ["run", &study, "--quiet", "--json", "--out", "out"];
    let result: Value = serde_json::from_str(&place.done(&arguments)).unwrap();
    let manifolds = result["manifolds"].as_array().unwrap();
    assert_eq!(manifolds.len(), 2);
    for manifold in manifolds {
        assert_eq!(manifold["status"], "closed");
        assert_eq!(manifold["joint_ranges_deg"].as_array().unwrap().len(), 7);
        // Joints 4 and 7 turn right round: no critical points where the range is full by winding.
        assert_eq!(
            manifold["joint_ranges_deg"][3].to_string(),
            "[[-180.0,180.0]]"
        );
        assert!(manifold["critical_points"].as_array().unwrap().len() >= 10);
    }
    assert_eq!(result["winding_sum"].to_string(), "[0,0,0,0,0,0,0]");
    assert_eq!(result["completeness"]["kind"], "evidence");
    assert!(number(&result["completeness"]["missed"]) < 0.05);
    assert!(number(&result["residual"]["m"]) < 1e-9);
    assert_eq!(result["fault_tolerant"], true);
    let table = fs::read_to_string(place.path("out/manifolds.csv")).unwrap();
    let mut lines = table.lines();
    assert!(
        lines
            .next()
            .unwrap()
            .starts_with("curve,vertex,arc_length,theta_1_deg,")
    );
    // The last vertex of a curve stands at its full length.
    let ends = lines.filter_map(|line| {
        let mut cells = line.split(',');
        let (curve, length) = (cells.next()?.parse::<usize>().ok()?, cells.nth(1)?);
        Some((curve, length.parse::<f64>().ok()?))
    });
    assert_is_a_report(&place, &result);
    let mut lengths = [0.0; 3];
    ends.for_each(|(curve, length)| lengths[curve] = length);
    for (length, manifold) in lengths[1..].iter().zip(manifolds) {
        assert!((length - number(&manifold["length"])).abs() < 1e-9);
    }
}

/// Figures, page and polylines of a study of one pose with limits.
fn assert_is_a_report(place: &Place, result: &Value) {
    for stem in ["manifolds", "manifolds_3d"] {
        let png = fs::read(place.path(&format!("out/{stem}.png"))).unwrap();
        assert!(png.starts_with(b"\x89PNG"));
        let svg = fs::read_to_string(place.path(&format!("out/{stem}.svg"))).unwrap();
        assert!(svg.contains("crosses limit box"));
    }
    let page = fs::read_to_string(place.path("out/report.html")).unwrap();
    for part in [
        "2 self-motion manifolds",
        "supported by evidence",
        "is in the fault-tolerant",
        "curves.vtk",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(
        !page.contains("src=\"manifolds"),
        "the page needs no other file"
    );
    let vtk = fs::read_to_string(place.path("out/curves.vtk")).unwrap();
    assert!(vtk.starts_with("# vtk DataFile"));
    // Every crossing of the table is one of result.json, at a limit of some joint from 2 on.
    let table = fs::read_to_string(place.path("out/manifolds_3d.csv")).unwrap();
    let drawn = table
        .lines()
        .filter(|line| line.starts_with("crossing,"))
        .count();
    let mut crossings = 0;
    for point in result["manifolds"]
        .as_array()
        .unwrap()
        .iter()
        .flat_map(|m| m["limit_crossings"].as_array().unwrap())
    {
        let theta = point["theta_deg"].as_array().unwrap();
        let gap = |k: usize, side: &str| {
            let off = number(&theta[k]) - number(&result["limits_deg"][side][k]);
            (off + 180.0).rem_euclid(360.0) - 180.0
        };
        let limited = [3, 4, 5]
            .into_iter()
            .flat_map(|k| [gap(k, "lower"), gap(k, "upper")]);
        assert!(limited.map(f64::abs).fold(f64::INFINITY, f64::min) < 1e-6);
        crossings += 1;
    }
    assert_eq!((drawn, crossings), (12, 12));
}

/// Joint 2 of a planar arm holds the point at distance r with the two links around it between
/// 1 − r and 1 + r long: 2 cos(θ₂/2) runs from one to the other.
#[test]
fn manifolds_of_planar_poses() {
    let place = Place::new(R3, POSITION, "");
    let study = |space: &str, pose: &str| {
        let text = format!(
            "kind = \"manifolds\"\ndesign = \"arm.toml\"\n[task]\nspace = \"{space}\"\n\
             [pose]\n{pose}\n[manifolds]\nseeds = 20\nresidual = 1e-9\n"
        );
        place.write("study.toml", &text);
        place.result("out", &["--overwrite"])
    };
    let near = study("planar-position", "position = [0.1, 0.2]");
    assert_eq!(near["manifolds"].as_array().unwrap().len(), 2);
    assert_eq!(near["joint_ranges_deg"][0].to_string(), "[[-180.0,180.0]]");
    let r = 0.1f64.hypot(0.2);
    let end = |chord: f64| 2.0 * (0.5 * chord).acos().to_degrees();
    let arcs = near["joint_ranges_deg"][1].as_array().unwrap();
    for (arc, ends) in arcs
        .iter()
        .zip([[-end(1.0 - r), -end(1.0 + r)], [end(1.0 + r), end(1.0 - r)]])
    {
        for k in 0..2 {
            assert!(
                (number(&arc[k]) - ends[k]).abs() < 2e-3,
                "{arc} for {ends:?}"
            );
        }
    }
    assert!(near.get("rotation_set_deg").is_none());
    let far = study("planar-position", "position = [9, 0]");
    assert_eq!(far["completeness"]["kind"], "proved");
    assert_eq!(far["joint_ranges_deg"].to_string(), "[[],[],[]]");
    assert!(far["notes"][0].as_str().unwrap().contains("farther away"));
}
