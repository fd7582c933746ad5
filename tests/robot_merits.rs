//! Merits that the size of W_F does not tell, as measures and as objectives of a search.

use faultspace::design::{TaskSpace, read_design};
use faultspace::study::{Progress, Question, RunOptions, Study, run};
use faultspace::synthesis::{
    Arm, Bounds, Care, DesignProblem, LinkRow, LinkSpace, Look, Merit, Parameter, ParetoSearch,
    ParetoSettings, WIDEST_MARGIN,
};
use faultspace::workspace::hybrid::{Atlas, AtlasSettings, Rule};
use faultspace::workspace::{ArtificialLimits, FailureSet};
use serde_json::Value;
use std::f64::consts::FRAC_PI_2;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const TASK: TaskSpace = TaskSpace::SpatialPosition;

struct Silent;

impl Progress for Silent {
    fn update(&self, _: u64, _: u64, _: f64, _: &str) {}
}

fn row(length: Parameter, offset: Parameter) -> LinkRow {
    LinkRow {
        twist: Parameter::OneOf(vec![-FRAC_PI_2, FRAC_PI_2]),
        length,
        offset,
    }
}

fn problem(rows: Vec<LinkRow>, failures: FailureSet) -> DesignProblem {
    DesignProblem {
        links: LinkSpace::new(rows, TASK),
        failures,
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

/// Robots with four joints for positions.
fn four_joints() -> DesignProblem {
    let free = row(
        Parameter::Bounded([0.0, 0.5]),
        Parameter::Bounded([-0.5, 0.5]),
    );
    problem(vec![free; 4], FailureSet::any(4))
}

fn look(samples: u32, seed: u64, replicates: u32) -> Look {
    Look {
        samples,
        seed,
        replicates,
    }
}

/// The shipped 4R, limits fitted to it, and an atlas of other samples.
fn measured(problem: &DesignProblem, seed: u64) -> (Arm, ArtificialLimits, Atlas) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("designs/spatial_4r.toml");
    let arm = Arm::of_robot(&read_design(&path).unwrap(), TASK).unwrap();
    let fitted = problem.atlas(&arm, look(1000, 1, 1), None).unwrap();
    let limits = problem.fit(&arm, &fitted, &[], Care::Scratch, 1);
    let atlas = problem.atlas(&arm, look(4000, seed, 16), None).unwrap();
    (arm, limits, atlas)
}

/// What is asked for is measured, and nothing else; the numbers are those of the atlas.
#[test]
fn measured_when_asked_for() {
    let problem = four_joints();
    let (arm, limits, atlas) = measured(&problem, 2);
    let few = problem.measures(&arm, &atlas, &limits);
    assert!(few.dexterity.is_none() && few.margin.is_none());
    for merit in [Merit::Condition, Merit::NullComponent, Merit::Margin] {
        assert!(!few.has(merit));
        assert_eq!(few.merit(merit).value, 0.0);
    }
    let all = problem.with_all_merits().measures(&arm, &atlas, &limits);
    assert_eq!(few.share, all.share);
    // An eighth of 4000 samples.
    let dexterity = atlas.dexterity(&arm.robot, &limits, &problem.failures, 500);
    assert_eq!(all.dexterity, dexterity);
    let dexterity = dexterity.unwrap();
    assert_eq!(all.merit(Merit::Condition), dexterity.inverse_condition);
    assert_eq!(all.merit(Merit::NullComponent), dexterity.null_component);
}

/// By the definition: a tenth of S_F is lost just beyond the margin and not just before it.
#[test]
fn the_margin_costs_a_tenth() {
    let problem = four_joints();
    let (_, limits, atlas) = measured(&problem, 2);
    let size = |margin: f64| {
        let failures = FailureSet::any(4).with_margin(margin);
        let sizes = atlas.sizes(&limits, &failures, Rule::Definition);
        sizes.fault_tolerant.value
    };
    let found = problem.margin(&atlas, &limits).value;
    assert!(found > 0.0 && found < WIDEST_MARGIN, "{found}");
    let step = 0.02f64.to_radians();
    assert!(size(found - step) > 0.9 * size(0.0));
    assert!(size(found + step) < 0.9 * size(0.0));
    // It is counted from the limits, however far the study lets joints overshoot.
    let wide = DesignProblem {
        failures: FailureSet::any(4).with_margin(0.05),
        ..problem
    };
    assert_eq!(wide.margin(&atlas, &limits).value, found);
}

/// Nothing to lose: 0. Nothing lost: the widest margin.
#[test]
fn margins_at_both_ends() {
    let problem = four_joints();
    let (_, limits, atlas) = measured(&problem, 2);
    let free = ArtificialLimits::free(4);
    assert_eq!(atlas.fault_tolerant_size(&free, &problem.failures), 0.0);
    assert_eq!(problem.margin(&atlas, &free).value, 0.0);
    // Joint 1 alone may lock, and is free already: an overshoot changes nothing.
    let only_first = DesignProblem {
        failures: FailureSet::of(4, &[1]),
        ..problem
    };
    let mut joints = limits.joints().to_vec();
    joints[0] = faultspace::workspace::JointLimit::FREE;
    let limits = ArtificialLimits::new(joints);
    assert!(atlas.fault_tolerant_size(&limits, &only_first.failures) > 0.0);
    assert_eq!(only_first.margin(&atlas, &limits).value, WIDEST_MARGIN);
}

/// The standard error of the margin is the scatter between independent samples.
#[test]
fn the_error_of_the_margin() {
    let problem = four_joints();
    let (arm, limits, _) = measured(&problem, 2);
    let found: Vec<_> = (10..22)
        .map(|seed| {
            let atlas = problem.atlas(&arm, look(2000, seed, 16), None).unwrap();
            problem.margin(&atlas, &limits)
        })
        .collect();
    let count = found.len() as f64;
    let mean = found.iter().map(|m| m.value).sum::<f64>() / count;
    let square: f64 = found.iter().map(|m| (m.value - mean).powi(2)).sum();
    let scatter = (square / (count - 1.0)).sqrt();
    let told = found.iter().map(|m| m.error).sum::<f64>() / count;
    println!("{:.3e} told, {scatter:.3e} found, mean {mean:.3e}", told);
    // Twelve samples give their scatter to about 20 %.
    assert!(told > 0.5 * scatter && told < 2.5 * scatter);
}

/// A robot of which too little survives is discounted, one with enough is not.
#[test]
fn the_least_share_is_a_bound() {
    let problem = four_joints();
    let (arm, limits, atlas) = measured(&problem, 2);
    let measures = problem.measures(&arm, &atlas, &limits);
    let share = measures.share.value;
    let with = |least_share: f64| {
        let bounds = Bounds {
            least_share,
            ..problem.bounds
        };
        let problem = DesignProblem {
            bounds,
            ..problem.clone()
        };
        problem.discount(&measures)
    };
    assert_eq!(with(0.5 * share), with(0.0));
    let expected = with(0.0) * 0.125;
    assert!((with(2.0 * share) - expected).abs() < 1e-12);
}

fn small_front() -> ParetoSearch {
    let settings = ParetoSettings {
        screened: 16,
        population: 12,
        generations: 6,
        samples: 200,
        report_samples: 1024,
    };
    let merits = vec![Merit::Share, Merit::Condition, Merit::Margin];
    ParetoSearch::new(settings, merits, 3, Vec::new())
}

fn search(problem: &DesignProblem) -> ParetoSearch {
    let mut search = small_front();
    while !search.is_done() {
        search.advance(problem);
    }
    search
}

/// A front of these merits: all of them measured anew for every robot, the same on one thread.
#[test]
fn fronts_of_dexterity_and_margin() {
    let problem = DesignProblem {
        merits: vec![Merit::Share, Merit::Condition, Merit::Margin],
        ..four_joints()
    };
    let found = search(&problem);
    let front = found.front();
    assert!(front.len() >= 3, "{}", front.len());
    for robot in &front {
        assert!(Merit::ALL.iter().all(|merit| robot.held_out.has(*merit)));
        let values = search_values(&robot.held_out);
        assert!(values.iter().all(|value| value.is_finite() && *value > 0.0));
    }
    // By the definition of a front, on samples that the search has not seen.
    for a in &front {
        for b in &front {
            let pairs = search_values(&a.held_out).into_iter();
            let pairs: Vec<_> = pairs.zip(search_values(&b.held_out)).collect();
            let no_worse = pairs.iter().all(|(a, b)| a >= b);
            assert!(!(no_worse && pairs.iter().any(|(a, b)| a > b)));
        }
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    let alone = pool.build().unwrap().install(|| search(&problem));
    assert_eq!(alone, found);
}

fn search_values(measures: &faultspace::synthesis::Measures) -> Vec<f64> {
    let merits = [Merit::Share, Merit::Condition, Merit::Margin];
    faultspace::synthesis::merit_values(measures, &merits)
}

/// Lengths from lists beside fixed ones: robots of another reach are counted, not compared.
#[test]
fn robots_of_another_reach_are_counted() {
    let length = || Parameter::OneOf(vec![0.1, 0.2, 0.3, 0.4]);
    let none = || Parameter::Fixed(0.0);
    let rows = vec![row(length(), none()); 4];
    let problem = problem(rows, FailureSet::any(4));
    let missed = problem.links.off_reach(3, 0..16);
    assert!(missed > 0 && missed < 16, "{missed}");
    let found = search(&problem);
    assert!(found.off_reach() >= u64::from(missed));
    for robot in found.front() {
        assert!(problem.links.has_reach(&robot.draft.links));
    }
    // With the usual bounds some are too short all the same, but far fewer.
    let listed = problem.links.off_reach(3, 0..64);
    let usual = four_joints().links.off_reach(3, 0..64);
    assert!(4 * usual < listed, "{usual} against {listed}");
}

fn number(json: &Value) -> f64 {
    json.as_f64()
        .unwrap_or_else(|| panic!("a number, not {json}"))
}

/// A search for one robot by a merit, from its file to its report.
fn found(merit: Merit, screened: u64, generations: u64) -> Value {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().unwrap();
    let mut study = Study::load(&root.join("studies/design_quick.toml")).unwrap();
    let Question::Synthesis(question) = &mut study.question else {
        panic!("a search for robots");
    };
    question.search.objectives = vec![merit];
    question.search.min_share = 0.05;
    let effort = &mut question.search.effort;
    effort.screened = screened;
    effort.generations = generations;
    effort.trial_generations = generations;
    effort.check_poses = 0;
    effort.report_samples = 4096;
    study.report.figures = false;
    let options = RunOptions {
        out: folder.path().join("out"),
        resume: false,
        overwrite: true,
        threads: Some(2),
        interrupt: Arc::new(AtomicBool::new(false)),
        cache: None,
    };
    run(&study, &options, Arc::new(Silent)).unwrap()
}

fn merit_of(result: &Value, key: &str) -> f64 {
    number(&result["merits"][key]["value"])
}

/// What a search goes by is the merit asked for with the bounds, on the samples it is measured on.
#[test]
fn scores_are_the_merit_asked_for() {
    // Some robot with a workspace to speak of; without one there is no dexterity.
    let plain = |number: u32| {
        let problem = four_joints();
        let links = problem.links.numbered(5, number);
        problem.draft(&links, &[], look(300, 1, 1), Care::Scratch)
    };
    let is_good = |draft: &faultspace::synthesis::Draft| draft.measures.share.value > 0.02;
    let plain = (0..32).filter_map(plain).find(is_good).unwrap();
    for merit in [Merit::Condition, Merit::NullComponent, Merit::Margin] {
        let mut problem = DesignProblem {
            merit,
            merits: vec![merit],
            ..four_joints()
        };
        problem.bounds.least_share = 0.1;
        let draft = problem.draft(&plain.links, &[], look(300, 1, 1), Care::Scratch);
        let draft = draft.unwrap();
        assert!(draft.measures.has(merit) && draft.measures.merit(merit).value > 0.0);
        let expected = draft.measures.merit(merit).value * problem.discount(&draft.measures);
        assert_eq!(draft.score, expected);
        // Limits are fitted for S_F whatever is searched for.
        assert_eq!(plain.limits, draft.limits);
    }
}

/// The winner is chosen by it, and the report says how limits were fitted.
#[test]
fn a_search_for_dexterity() {
    let [share, condition] = [Merit::Share, Merit::Condition].map(|merit| found(merit, 16, 2));
    let reported = &condition["honesty"]["reported"]["value"];
    assert_eq!(number(reported), merit_of(&condition, "condition"));
    let finalists = condition["finalists"].as_array().unwrap();
    let best = finalists.iter().map(|f| number(&f["score"]));
    let best = best.fold(0.0, f64::max);
    let chosen = finalists.iter().find(|f| f["name"] == condition["chosen"]);
    let chosen = chosen.unwrap();
    assert!(number(&chosen["score"]) >= best - number(&finalists[0]["standard_error"]));
    for finalist in finalists {
        let merits = &finalist["merits"];
        let discount = number(&finalist["score"]) / number(&merits["condition"]["value"]);
        assert!(discount <= 1.0 + 1e-12, "{finalist}");
        // Only what was searched for was measured here.
        assert_eq!(merits["margin_deg"], Value::Null);
    }
    let notes = condition["notes"].to_string();
    assert!(notes.contains("limits were fitted for S_F"), "{notes}");
    assert!(!share["notes"].to_string().contains("limits were fitted"));
}

/// Degrees wherever a margin is told; while searching it is measured on other samples than the
/// limits were fitted to, on which it would be about 0.
#[test]
fn a_search_for_margin() {
    let result = found(Merit::Margin, 16, 2);
    let margin = merit_of(&result, "margin_deg");
    assert!(margin > 0.2 && margin <= 30.0, "{margin}");
    let honesty = &result["honesty"];
    assert_eq!(number(&honesty["reported"]["value"]), margin);
    assert_eq!(number(&result["margin"]["ten_percent_deg"]), margin);
    for told in [
        &honesty["on_fit_samples"],
        &honesty["on_selection_samples"]["value"],
    ] {
        let ratio = number(told) / margin;
        assert!(ratio > 0.3 && ratio < 3.0, "{honesty}");
    }
    assert!(
        number(&honesty["best_of_all_generations"]) > 0.1 * margin,
        "{honesty}"
    );
}
