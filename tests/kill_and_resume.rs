//! A run that is killed at any moment continues from its checkpoint and ends with the result it
//! would have had anyway.
#![cfg(unix)]

use rand::Rng;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A search with both stages, the global one and the polish.
const STUDY: &str = "\
kind = \"optimise\"
design = \"arm.toml\"
seed = 7
[task]
space = \"planar-position\"
[optimiser]
method = \"genetic\"
[optimiser.genetic]
population = POPULATION
generations = GENERATIONS
patience = 1000
[report]
figures = false
";

/// Some seconds of one core, most of them in the polish.
const LONG: Search = Search {
    links: "[0.9, 1.0, 0.8, 0.6]",
    population: "60",
    generations: "50",
};

/// About a second, most of it in the genetic algorithm.
const SHORT: Search = Search {
    links: "[0.9, 1.0, 0.8]",
    population: "100",
    generations: "600",
};

struct Search {
    links: &'static str,
    population: &'static str,
    generations: &'static str,
}

/// How often each run is killed.
const KILLS: usize = 20;

/// A folder with the robot and the study.
struct Place {
    dir: TempDir,
}

impl Place {
    fn new(search: Search) -> Place {
        let dir = tempfile::tempdir().unwrap();
        let place = Place { dir };
        let robot = format!("name = \"arm\"\nlinks = {}\n", search.links);
        let study = STUDY.replace("POPULATION", search.population);
        place.write("arm.toml", &robot);
        place.write(
            "study.toml",
            &study.replace("GENERATIONS", search.generations),
        );
        place
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    /// Calls `look` while `old` is `new` in the file `name`.
    fn with_changed(&self, name: &str, old: &str, new: &str, look: impl FnOnce()) {
        let text = fs::read_to_string(self.path(name)).unwrap();
        assert!(text.contains(old));
        self.write(name, &text.replace(old, new));
        look();
        self.write(name, &text);
    }

    fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    fn checkpoint(&self, out: &str) -> PathBuf {
        self.path(out).join("checkpoint").join("search.bin")
    }

    fn command(&self, out: &str, threads: &str, more: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_faultspace"));
        command
            .current_dir(self.dir.path())
            .args([
                "run",
                "study.toml",
                "--quiet",
                "--out",
                out,
                "--threads",
                threads,
            ])
            .args(more)
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        command
    }

    fn run(&self, out: &str, threads: &str, more: &[&str]) -> Output {
        let mut command = self.command(out, threads, more);
        command.output().expect("the binary starts")
    }

    /// Runs to the end and returns the result without what may differ.
    fn finish(&self, out: &str, threads: &str, more: &[&str]) -> Value {
        let output = self.run(out, threads, more);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{message}");
        self.result(out)
    }

    fn result(&self, out: &str) -> Value {
        let text = fs::read_to_string(self.path(out).join("result.json")).unwrap();
        let mut result: Value = serde_json::from_str(&text).unwrap();
        let fields = result.as_object_mut().unwrap();
        assert!(fields.remove("seconds").is_some() && fields.remove("provenance").is_some());
        assert!(result["size"]["fault_tolerant"].as_f64().unwrap() > 1.0);
        result
    }

    /// Starts a run, waits for its first checkpoint and sends it a signal.
    fn stop_by_signal(&self, out: &str, signal: &str) -> ExitStatus {
        let mut child = self.command(out, "1", &[]).spawn().unwrap();
        assert!(
            wait_for(&mut child, &self.checkpoint(out)),
            "the run ended before its first checkpoint"
        );
        let sent = Command::new("kill")
            .args([signal, &child.id().to_string()])
            .status();
        assert!(sent.unwrap().success());
        child.wait().unwrap()
    }
}

/// Waits until `file` exists; false if the child ends before.
fn wait_for(child: &mut Child, file: &Path) -> bool {
    let start = Instant::now();
    while !file.exists() {
        if child.try_wait().unwrap().is_some() {
            return file.exists();
        }
        assert!(start.elapsed() < Duration::from_secs(60), "no checkpoint");
        sleep(Duration::from_millis(5));
    }
    true
}

/// Names in `folder`, sorted.
fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// Kills a run at pseudo-random moments, resumes it each time, and expects the known result.
fn kill_often_and_compare(threads: &str, seed: u64, expected: &Value, place: &Place) {
    let out = format!("killed-{threads}");
    let mut moments = faultspace::sampling::stream(seed, 0);
    let (mut kills, mut resumed) = (0, 0);
    while kills < KILLS {
        let more: &[&str] = if kills == 0 { &[] } else { &["--resume"] };
        let mut child = place.command(&out, threads, more).spawn().unwrap();
        // A checkpoint is due after 200 ms: some of these runs get that far, some do not. On a busy
        // machine none might, so every third waits for one.
        if kills % 3 == 2 {
            wait_for(&mut child, &place.checkpoint(&out));
        }
        sleep(Duration::from_millis(moments.random_range(20..330)));
        child.kill().unwrap(); // SIGKILL
        if child.wait().unwrap().success() {
            break; // It was faster.
        }
        kills += 1;
        resumed += usize::from(place.checkpoint(&out).exists());
        assert!(!place.path(&out).join("result.json").exists());
    }
    assert!(
        kills >= 5 && resumed >= 3,
        "{kills} kills, {resumed} with a checkpoint: the study is too short"
    );
    let more: &[&str] = if place.path(&out).join("result.json").exists() {
        &["--overwrite"]
    } else {
        &["--resume"]
    };
    assert_eq!(place.finish(&out, threads, more), *expected);
    // Neither checkpoint nor half-written files stay behind.
    assert_eq!(names_in(&place.path(&out)), ["result.json", "study.toml"]);
}

#[test]
fn a_run_killed_twenty_times_ends_with_the_same_result() {
    let place = Place::new(LONG);
    let expected = place.finish("whole", "1", &[]);
    kill_often_and_compare("1", 11, &expected, &place);
    kill_often_and_compare("2", 12, &expected, &place);
}

/// SIGTERM and SIGINT end a run in order: exit code 1, a checkpoint, and the way to go on.
#[test]
fn a_signal_stops_a_run_that_resumes() {
    let place = Place::new(SHORT);
    let expected = place.finish("whole", "2", &[]);
    for signal in ["-TERM", "-INT"] {
        let out = format!("stopped{signal}");
        assert_eq!(place.stop_by_signal(&out, signal).code(), Some(1));
        assert!(place.checkpoint(&out).exists());
        assert!(!place.path(&out).join("result.json").exists());
        assert_eq!(place.finish(&out, "2", &["--resume"]), expected);
    }
}

/// A checkpoint is for the study that wrote it, and for whole files.
#[test]
fn foreign_and_damaged_checkpoints_are_refused() {
    let place = Place::new(SHORT);
    assert_eq!(place.stop_by_signal("out", "-TERM").code(), Some(1));
    let refused = |more: &[&str], why: &str| {
        let output = place.run("out", "2", &[&["--resume"], more].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{why}: {message}");
        assert!(message.contains("cannot be resumed"), "{why}: {message}");
        assert!(message.contains("search.bin"), "{why}: {message}");
        assert!(!message.contains("panicked"), "{why}: {message}");
    };
    refused(&["--seed", "8"], "another seed");

    place.with_changed("study.toml", "population = 100", "population = 101", || {
        refused(&[], "another population");
    });
    place.with_changed("arm.toml", "0.9", "0.91", || refused(&[], "another robot"));

    let checkpoint = place.checkpoint("out");
    let whole = fs::read(&checkpoint).unwrap();
    for length in [0, 1, 10, whole.len() / 2, whole.len() - 1] {
        fs::write(&checkpoint, &whole[..length]).unwrap();
        refused(&[], &format!("{length} bytes of {}", whole.len()));
    }
    let mut generator = faultspace::sampling::stream(5, 0);
    let noise: Vec<u8> = (0..whole.len()).map(|_| generator.random()).collect();
    fs::write(&checkpoint, noise).unwrap();
    refused(&[], "noise");

    // None of these refusals touched what is needed to go on.
    fs::write(&checkpoint, &whole).unwrap();
    place.finish("out", "2", &["--resume"]);
}

/// A finished run is not run again, and never replaced by another study's.
#[test]
fn resuming_a_finished_run_gives_its_result() {
    let place = Place::new(SHORT);
    let first = place.finish("out", "2", &[]);
    let written = fs::metadata(place.path("out/result.json"))
        .unwrap()
        .modified()
        .unwrap();
    assert_eq!(place.finish("out", "2", &["--resume"]), first);
    let after = fs::metadata(place.path("out/result.json"))
        .unwrap()
        .modified()
        .unwrap();
    assert_eq!(written, after);
    for (file, old, new) in [
        ("study.toml", "seed = 7", "seed = 8"),
        ("arm.toml", "0.8", "0.7"),
    ] {
        place.with_changed(file, old, new, || {
            let output = place.run("out", "2", &["--resume"]);
            assert_eq!(output.status.code(), Some(2));
            let message = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(
                message.contains("finished report of another study"),
                "{message}"
            );
        });
    }
}
