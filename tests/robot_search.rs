//! The search for robots: known optima in the plane, a search in space from start to report, and
//! the robots of an earlier search, scored anew.

use faultspace::design::{Convention, Geometry, Joint, JointKind, Link, Robot, TaskSpace};
use faultspace::design::{parse_design, read_design};
use faultspace::diagnostic::Source;
use faultspace::manifold::{Completeness, PreImageSearch, SearchSettings};
use faultspace::study::{Progress, Question, RobotSearch, RunError, RunOptions, Study, run};
use faultspace::synthesis::{
    Arm, Bounds, Care, Column, DesignProblem, LinkRow, LinkSpace, Look, Merit, Parameter,
    ParetoSearch, ParetoSettings, Purpose, Synthesis, SynthesisSettings, sample_seed,
};
use faultspace::workspace::hybrid::AtlasSettings;
use faultspace::workspace::{ArtificialLimits, FailureSet, JointLimit};
use nalgebra::Isometry3;
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

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

fn shipped(study: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    root.join("studies").join(format!("{study}.toml"))
}

fn value(json: &Value) -> f64 {
    json.as_f64()
        .unwrap_or_else(|| panic!("a number, not {json}"))
}

/// What is the same in every run of a study.
fn without_times(mut result: Value) -> Value {
    result["seconds"] = Value::Null;
    result["provenance"] = Value::Null;
    result
}

/// The optima of planar 3R arms for several least widths of limits, which a separate search by
/// differential evolution found to the digits given; without a least width the optimum is exactly
/// 1/3 on a whole family of robots, which the report must say.
#[test]
fn planar_robots() {
    let folder = tempfile::tempdir().unwrap();
    for (study, share) in [
        ("design_3r_free", 0.3333),
        ("design_3r_5deg", 0.3153),
        ("design_3r_20deg", 0.2640),
    ] {
        let study = Study::load(&shipped(study)).unwrap();
        let mut study = study;
        study.report.figures = false;
        let result = run(&study, &options(folder.path(), 2), Arc::new(Silent)).unwrap();
        let found = value(&result["size"]["normalised"]);
        assert!((found - share).abs() < 1e-4, "{}: {found}", study.name);
        let notes = result["notes"].to_string();
        let is_ridge = study.name == "design_3r_free";
        assert_eq!(notes.contains("flat ridge"), is_ridge, "{notes}");
    }
}

/// Raises the interrupt flag after some reports of progress.
struct StopAfter {
    left: AtomicU64,
    flag: Arc<AtomicBool>,
}

impl Progress for StopAfter {
    fn update(&self, _: u64, _: u64, _: f64, _: &str) {
        if self.left.fetch_sub(1, Ordering::SeqCst) == 1 {
            self.flag.store(true, Ordering::SeqCst);
        }
    }
}

/// A search in space from its file to its report: files that can be used at once, a check that
/// agrees, the same result on one thread, and after an interruption.
#[test]
fn a_quick_search_in_space() {
    let study = Study::load(&shipped("design_quick")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name);
    let whole = run(&study, &options(&out("whole"), 2), Arc::new(Silent)).unwrap();

    let share = &whole["merits"]["share"];
    let (found, error) = (value(&share["value"]), value(&share["standard_error"]));
    let reference = value(&whole["reference"]["merits"]["share"]["value"]);
    assert!(found > 2.0 * reference, "{found} against {reference}");
    assert!(error > 0.0 && error < 0.1 * found);
    let check = &whole["locked_joint_check"];
    assert!(
        value(&check["difference_in_standard_errors"]).abs() < 3.5,
        "{check}"
    );

    let robot = read_design(&out("whole").join("robot.toml")).unwrap();
    assert_eq!(robot.joints(), study.design.robot.joints());
    let again = Study::load(&out("whole").join("robot_study.toml")).unwrap();
    let again = run(&again, &options(&out("again"), 2), Arc::new(Silent)).unwrap();
    let sizes = &again["size"];
    let measured = value(&sizes["normalised"]);
    let off = value(&sizes["standard_error"]) / value(&sizes["unrestricted"]);
    assert!(
        (measured - found).abs() < 4.0 * error.hypot(off),
        "{measured} against {found}"
    );
    let check = &again["locked_joint_check"];
    assert_eq!(check["poses"], 10_000);
    assert!(
        value(&check["difference_in_standard_errors"]).abs() < 4.0,
        "{check}"
    );
    let text = std::fs::read_to_string(out("whole").join("robot.urdf")).unwrap();
    assert_eq!(text.matches("type=\"continuous\"").count(), 4);

    let mut slow = options(&out("stopped"), 1);
    let stop = StopAfter {
        left: AtomicU64::new(4),
        flag: slow.interrupt.clone(),
    };
    let stopped = run(&study, &slow, Arc::new(stop));
    assert!(matches!(stopped, Err(RunError::Interrupted)));
    slow.interrupt = Arc::new(AtomicBool::new(false));
    (slow.resume, slow.overwrite) = (true, false);
    let resumed = run(&study, &slow, Arc::new(Silent)).unwrap();
    assert_eq!(without_times(resumed), without_times(whole));
}

fn problem(n: usize, twists: &[f64], most: f64) -> DesignProblem {
    let row = LinkRow {
        twist: Parameter::OneOf(twists.to_vec()),
        length: Parameter::Bounded([0.0, most]),
        offset: Parameter::Bounded([-most, most]),
    };
    DesignProblem {
        links: LinkSpace::new(vec![row; n], TaskSpace::SpatialPose),
        failures: FailureSet::any(n),
        min_width: 20f64.to_radians(),
        merit: Merit::Share,
        merits: vec![Merit::Share],
        bounds: Bounds {
            most_length: 1.8,
            least_fill: 0.25,
            least_pre_failure_share: 0.3,
            least_share: 0.0,
        },
        atlas: AtlasSettings {
            tolerance: 0.02,
            ..AtlasSettings::default()
        },
    }
}

fn robot(alpha: [f64; 7], a: [f64; 7], d: [f64; 7]) -> Robot {
    let joint = |k: usize| Joint {
        kind: JointKind::Revolute,
        link: Link {
            twist: alpha[k].to_radians(),
            length: a[k],
            offset: d[k],
            angle: 0.0,
        },
    };
    Robot {
        name: "r".into(),
        source: None,
        geometry: Geometry::Rows {
            convention: Convention::Standard,
            joints: (0..7).map(joint).collect(),
        },
        tool: Isometry3::identity(),
        physical_limits: None,
    }
}

/// Three robots that an independent prototype found, with the shares that it measured on 100,000
/// poses and more, and their errors.
#[test]
fn robots_of_an_earlier_search() {
    let full = [-180.0, 180.0];
    let cases = [
        (
            robot(
                [90.0, 90.0, 90.0, 90.0, 90.0, -90.0, 0.0],
                [0.0, 0.16, 0.15, 0.40, 0.0, 0.12, 0.0],
                [0.0, -0.12, 0.0, -0.18, 0.18, 0.08, 0.0],
            ),
            [
                full,
                [-136.0, 162.0],
                [-90.0, 53.0],
                [-108.0, 196.0],
                [126.0, 357.0],
                [75.0, 108.0],
                full,
            ],
            (0.1864, 0.0009),
        ),
        (
            robot(
                [-89.25, -109.37, -84.11, 78.50, -76.20, -87.79, 0.0],
                [-0.0042, 0.1538, 0.1693, 0.3838, 0.1227, -0.0009, 0.0],
                [0.0, 0.1387, 0.0505, -0.1696, 0.2605, -0.1385, 0.0],
            ),
            [
                full,
                [43.0, 359.5],
                [-145.5, 66.0],
                [-136.1, 8.9],
                [-77.7, 166.7],
                [-96.6, -61.4],
                [-178.0, 178.0],
            ],
            (0.1854, 0.0016),
        ),
        (
            robot(
                [86.86, 91.13, 90.34, 94.77, 88.33, -87.68, 0.0],
                [0.0080, 0.1564, 0.1515, 0.4086, -0.0093, 0.1345, 0.0],
                [0.0, -0.1230, 0.0102, -0.1837, 0.1779, 0.0834, 0.0],
            ),
            [
                full,
                [-133.7, 164.3],
                [-96.3, 53.3],
                [-112.5, 187.5],
                [130.3, 364.7],
                [75.3, 103.7],
                [-175.5, 175.5],
            ],
            (0.1875, 0.0014),
        ),
    ];
    let problem = problem(7, &[-FRAC_PI_2, FRAC_PI_2], 0.5);
    for (robot, limits, (share, error)) in cases {
        let arm = Arm::of_robot(&robot, TaskSpace::SpatialPose).unwrap();
        let look = Look {
            samples: 20_000,
            seed: 5,
            replicates: 16,
        };
        let limits = ArtificialLimits::from_degrees(&limits);
        let atlas = problem.atlas(&arm, look, Some(&limits)).unwrap();
        let found = problem.measures(&arm, &atlas, &limits).share;
        let off = (found.value - share) / found.error.hypot(error);
        assert!(off.abs() < 3.0, "{found:?} against {share}");
    }
}

/// Robots of parallel, coincident and intersecting axes: pre-images that are singular throughout.
/// The work per task point is limited, so this ends; what could not be finished is counted.
#[test]
fn robots_of_singular_structure_do_not_hang() {
    let problem = problem(7, &[0.0, FRAC_PI_2, -FRAC_PI_2, PI], 0.5);
    let look = Look {
        samples: 64,
        seed: 1,
        replicates: 1,
    };
    for number in 0..24 {
        let seed = sample_seed(9, Purpose::Robot, number);
        let mut links = problem
            .links
            .random(&mut faultspace::sampling::stream(seed, 0));
        for (row, link) in links.iter_mut().enumerate() {
            // Many zeros on top of those drawn.
            if (number as usize + row).is_multiple_of(2) {
                *link.get_mut(Column::Offset) = 0.0;
            }
        }
        let Some(arm) = Arm::of_links(&problem.links, &links) else {
            continue;
        };
        if let Some(atlas) = problem.atlas(&arm, look, None) {
            assert!(atlas.counts().reachable <= 64);
        }
    }
}

/// The limit itself: a search that may trace no more than a few vertices ends, and says that it is
/// incomplete.
#[test]
fn a_search_that_was_cut_short_proves_nothing() {
    let robot = read_design(&Path::new(env!("CARGO_MANIFEST_DIR")).join("designs/spatial_7r.toml"));
    let robot = robot.unwrap();
    let pose = faultspace::kinematics::tool_frame(&robot, &[0.3, -0.8, 1.1, 0.5, -0.4, 1.2, 0.1]);
    let find = |most_vertices: usize| {
        let settings = SearchSettings {
            most_vertices,
            ..SearchSettings::default()
        };
        let mut search = PreImageSearch::new(&robot, TaskSpace::SpatialPose, settings).unwrap();
        search.find(&pose, &mut faultspace::sampling::stream(1, 0))
    };
    assert_ne!(find(1_000_000).completeness, Completeness::Unknown);
    assert_eq!(find(20).completeness, Completeness::Unknown);
}

/// PA-10: joint 4 stands still in every self-motion, so that the search has nothing to screen.
#[test]
fn intolerant_robots_are_told_before_they_are_traced() {
    let problem = problem(7, &[-FRAC_PI_2, FRAC_PI_2], 0.5);
    let text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("designs/pa10.toml"));
    let pa10 = parse_design(&Source::new("pa10.toml", text.unwrap())).unwrap();
    let mut links = LinkSpace::links_of(&pa10).expect("revolute joints in standard rows");
    problem.links.settle(&mut links);
    let verdict = problem.verdict(&links).expect("a verdict");
    assert_eq!(verdict.joints, [4]);
    let other = problem
        .links
        .random(&mut faultspace::sampling::stream(1, 1));
    assert!(problem.verdict(&other).is_none());
}

fn small_front(seed: u64) -> ParetoSearch {
    let settings = ParetoSettings {
        screened: 16,
        population: 12,
        generations: 5,
        samples: 200,
        report_samples: 1024,
    };
    let merits = vec![Merit::BallShare, Merit::PreFailureShare, Merit::Slenderness];
    ParetoSearch::new(settings, merits, seed, Vec::new())
}

/// No robot of a front beats another in everything, on samples that the search has not seen.
#[test]
fn fronts_are_fronts_on_fresh_samples() {
    let problem = problem(7, &[-FRAC_PI_2, FRAC_PI_2], 0.5);
    let mut search = small_front(3);
    let mut saved = None;
    while !search.is_done() {
        search.advance(&problem);
        if saved.is_none() && search.progress() > 0.5 {
            saved = Some(postcard::to_stdvec(&search).unwrap());
        }
    }
    let front = search.front();
    assert!(front.len() >= 3, "{}", front.len());
    for a in &front {
        for b in &front {
            let better =
                |merit: &Merit| a.held_out.merit(*merit).value > b.held_out.merit(*merit).value;
            let no_worse =
                |merit: &Merit| a.held_out.merit(*merit).value >= b.held_out.merit(*merit).value;
            let merits = search.merits();
            assert!(!(merits.iter().all(no_worse) && merits.iter().any(better)));
        }
    }
    let mut resumed: ParetoSearch = postcard::from_bytes(&saved.unwrap()).unwrap();
    while !resumed.is_done() {
        resumed.advance(&problem);
    }
    assert_eq!(resumed, search);
}

/// A search goes on from any of its steps to the same end.
#[test]
fn a_search_resumes_bit_for_bit() {
    let problem = problem(7, &[-FRAC_PI_2, FRAC_PI_2], 0.5);
    let settings = SynthesisSettings {
        screened: 8,
        screening_samples: 100,
        runs: 2,
        trial_generations: 2,
        full_runs: 1,
        generations: 2,
        population: 4,
        samples: 100,
        patience: 10,
        fit_samples: 200,
        selection_samples: 1024,
        round_length: 0.01,
        round_limit: 1f64.to_radians(),
    };
    let mut states = Vec::new();
    let mut search = Synthesis::new(settings, 4, Vec::new());
    while !search.is_done() {
        states.push(postcard::to_stdvec(&search).unwrap());
        search.advance(&problem);
    }
    let last = postcard::to_stdvec(&search).unwrap();
    for state in states.iter().skip(1).step_by(3) {
        let mut resumed: Synthesis = postcard::from_bytes(state).unwrap();
        while !resumed.is_done() {
            resumed.advance(&problem);
        }
        assert_eq!(postcard::to_stdvec(&resumed).unwrap(), last);
    }
    let round = search.finalists().iter().filter(|f| f.is_round);
    for finalist in round {
        for link in &finalist.draft.links {
            let steps = link.length / 0.01;
            assert!((steps - steps.round()).abs() < 1e-9);
        }
    }
}

/// After every heat the better half of the runs goes on; those that are left go through the first
/// stage, the better half of them through the next.
#[test]
fn the_better_half_of_the_runs_goes_on() {
    let problem = problem(7, &[-FRAC_PI_2, FRAC_PI_2], 0.5);
    let settings = SynthesisSettings {
        screened: 16,
        screening_samples: 100,
        runs: 6,
        trial_generations: 1,
        full_runs: 3,
        generations: 6,
        population: 4,
        samples: 100,
        patience: 10,
        fit_samples: 100,
        selection_samples: 1024,
        round_length: 0.0,
        round_limit: 0.0,
    };
    let mut search = Synthesis::new(settings, 2, Vec::new());
    let mut progress = vec![search.progress().0];
    while !search.is_done() {
        search.advance(&problem);
        progress.push(search.progress().0);
    }
    assert!(progress.is_sorted(), "{progress:?}");
    assert_eq!((progress[0], progress.last()), (0.0, Some(&1.0)));
    let generations = |run: u32| search.history().iter().filter(|g| g.run == run).count();
    // One heat, then six generations more for three of the six.
    let mut lengths: Vec<usize> = (0..6).map(generations).collect();
    lengths.sort();
    assert_eq!(lengths, [1, 1, 1, 7, 7, 7]);
    let refined: Vec<u32> = (100..106).filter(|&run| generations(run) > 0).collect();
    assert_eq!(refined.len(), 2);
    assert!(refined.iter().all(|&run| generations(run - 100) == 7));
    // Of the runs that ended, those that went on had the better medians of late.
    let last = |run: u32| {
        let of_run = search.history().iter().filter(|g| g.run == run);
        let medians: Vec<f64> = of_run.map(|g| g.quartiles[1]).collect();
        let late = &medians[medians.len() - 5..];
        late.iter().sum::<f64>() / late.len() as f64
    };
    let ended: Vec<u32> = (0..6).filter(|&run| generations(run) == 7).collect();
    let dropped = ended.iter().find(|&&run| !refined.contains(&(run + 100)));
    for run in &refined {
        assert!(last(run - 100) >= last(*dropped.unwrap()));
    }
    assert_eq!(search.finalists().len(), 5);
    let mut names: Vec<&str> = search.finalists().iter().map(|f| &f.name[..]).collect();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), 5);
}

/// A row with -a and -α is the same link, with both joints at its ends turned by half a turn:
/// R_z(θ) T_z(d) T_x(a) R_x(α) R_z(π) = R_z(θ + π) T_z(d) T_x(-a) R_x(-α).
#[test]
fn links_with_negative_lengths_are_the_same_links() {
    let mut problem = problem(7, &[-FRAC_PI_2, FRAC_PI_2], 0.5);
    problem.atlas.tolerance = 0.002;
    // Each of these robots has random starts of its own; none may miss a manifold.
    problem.atlas.search = SearchSettings::default();
    let mut rng = faultspace::sampling::stream(11, 0);
    let links = problem.links.random(&mut rng);
    let look = Look {
        samples: 1000,
        seed: 3,
        replicates: 1,
    };
    let fitted = problem.draft(&links, &[], look, Care::Scratch).unwrap();
    // Fitted limits end where one of the samples ends, so that round-off would decide about it.
    let whole = |end: f64| end.to_degrees().round().to_radians();
    let joints = fitted.limits.joints().iter();
    let limits: Vec<JointLimit> = joints
        .map(|limit| JointLimit::new(whole(limit.lower), whole(limit.upper)))
        .collect();
    let before = ArtificialLimits::new(limits.clone());
    let before = problem.measured(&links, &before, look).unwrap();
    assert!(before.measures.share.value > 0.0);
    for row in 0..6 {
        let mut turned = links.clone();
        turned[row].length *= -1.0;
        turned[row].twist *= -1.0;
        let mut limits = limits.clone();
        for limit in &mut limits[row..row + 2] {
            *limit = JointLimit::new(limit.lower + PI, limit.upper + PI);
        }
        // Pairs of joints are turned; the search spaces of both robots hold joint 1's limits
        // symmetric, which measuring does not need.
        let limits = ArtificialLimits::new(limits);
        let same = problem.measured(&turned, &limits, look).unwrap().measures;
        let [a, b] = [&before.measures, &same].map(|m| (m.share.value, m.fill.value));
        assert!((a.0 - b.0).abs() < 2e-3 * a.0, "row {row}: {a:?} {b:?}");
        assert!((a.1 - b.1).abs() < 1e-3 * a.1, "row {row}: {a:?} {b:?}");
    }
}

/// Limits fitted to samples are better on them than limits fitted to others.
#[test]
fn limits_are_fitted_to_the_samples_given() {
    let problem = problem(7, &[-FRAC_PI_2, FRAC_PI_2], 0.5);
    let links = problem
        .links
        .random(&mut faultspace::sampling::stream(5, 0));
    let look = |seed| Look {
        samples: 300,
        seed,
        replicates: 1,
    };
    let fitted = problem.draft(&links, &[], look(1), Care::Scratch).unwrap();
    let elsewhere = problem.measured(&links, &fitted.limits, look(2)).unwrap();
    let again = problem
        .draft(
            &links,
            std::slice::from_ref(&fitted.limits),
            look(2),
            Care::Last,
        )
        .unwrap();
    assert!(again.measures.share.value >= elsewhere.measures.share.value);
    for limit in again.limits.joints() {
        assert!(limit.width() >= 20f64.to_radians() - 1e-9);
    }
}

/// The genetic algorithm instead: links and limits together.
#[test]
fn robots_can_be_bred() {
    let mut study = Study::load(&shipped("design_quick")).unwrap();
    study.report.figures = false;
    let Question::Synthesis(question) = &mut study.question else {
        panic!("a search for robots");
    };
    question.search.method = RobotSearch::Genetic;
    let folder = tempfile::tempdir().unwrap();
    let result = run(&study, &options(folder.path(), 2), Arc::new(Silent)).unwrap();
    let share = value(&result["merits"]["share"]["value"]);
    let design = value(&result["reference"]["merits"]["share"]["value"]);
    assert!(share > design, "{share} against {design}");
    assert!(result["finalists"].as_array().unwrap().len() == 2);
}
