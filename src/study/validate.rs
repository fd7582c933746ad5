//! Checks a study file against its robot and fills in defaults.

use super::file::{Failures, Kind, StudyFile};
use super::search::{Method, OptimiserTable};
use super::settings::{
    Design, Estimate, Estimator, EstimatorMethod, FigureFormat, Manifolds, Optimise,
    OptimiserSettings, Question, ReportSettings, Study,
};
use super::singular_settings::LargestManifold;
use super::surrogate_check::Subject;
use super::{hybrid_table, limits, margin, pose_table, serve, singular_table, synthesis_check};
use crate::diagnostic::{Item, Place, Problem, Problems};
use crate::workspace::FailureSet;

/// Random starts of a search whose score costs milliseconds, if the study names no number.
const COSTLY_RESTARTS: u64 = 8;

/// Candidates per generation of a search whose score costs microseconds, likewise.
const CHEAP_POPULATION: u64 = 600;

/// The validated study; reports to `problems` whatever is wrong.
pub(super) fn study(
    name: &str,
    file: &StudyFile,
    problems: &Problems,
    design: Design,
) -> Option<Study> {
    let margin_deg = margin::degrees(file, problems, &design.robot);
    let failures = failures(file, problems, design.robot.joints());
    let failures = failures.with_margin(margin_deg.to_radians());
    let subject = Subject {
        file,
        problems,
        design: &design,
        failures: &failures,
    };
    let (question, estimator) = match file.kind.value {
        Kind::Estimate => {
            let estimator = estimator(&subject);
            let question = estimate(file, problems, &design).map(Question::Estimate);
            (question, estimator)
        }
        Kind::Optimise => {
            let estimator = estimator(&subject);
            let question = optimise(file, problems, &design, &estimator).map(Question::Optimise);
            (question, estimator)
        }
        Kind::Manifolds => {
            let question = manifolds(file, problems, &design).map(Question::Manifolds);
            (question, Estimator::default())
        }
        Kind::Train => {
            refuse_tables(file, problems, "train");
            (subject.train().map(Question::Train), Estimator::default())
        }
        Kind::Validate => {
            refuse_tables(file, problems, "validate");
            let question = subject.validate().map(Question::Validate);
            (question, Estimator::default())
        }
        Kind::Synthesis => {
            refuse_tables(file, problems, "synthesis");
            let question = synthesis_check::synthesis(file, problems, &design);
            (question.map(Question::Synthesis), Estimator::default())
        }
        kind => (
            singular(file, problems, &design, kind),
            Estimator::default(),
        ),
    };
    Some(Study {
        name: name.to_owned(),
        title: file.title.clone(),
        seed: file.seed.unwrap_or(1),
        task: file.space.value,
        failures,
        margin_deg,
        question: question?,
        estimator,
        report: report(file, problems),
        design,
    })
}

fn estimator(subject: &Subject) -> Estimator {
    let Subject {
        file,
        problems,
        design,
        ..
    } = subject;
    match serve::choose(file, problems, &design.robot) {
        EstimatorMethod::Surrogate => {
            if file.kind.value == Kind::Estimate {
                refuse_predicted_estimate(file, problems);
            }
            let links = limits::search(file, problems, &design.robot).links;
            match subject.estimator(links.as_ref()) {
                Some(surrogate) => Estimator::Surrogate { surrogate },
                None => Estimator::default(),
            }
        }
        EstimatorMethod::Exact => match file.estimator.tolerance {
            Some(tolerance) => Estimator::Exact { tolerance },
            None => Estimator::default(),
        },
        EstimatorMethod::Hybrid => {
            let table = file.estimator.hybrid.as_ref();
            Estimator::Hybrid {
                hybrid: hybrid_table::settings(table, file.space.value, problems),
            }
        }
    }
}

/// A size that is reported is computed, never predicted.
fn refuse_predicted_estimate(file: &StudyFile, problems: &Problems) {
    let place = file.estimator.method.as_ref().map(|item| &item.place);
    if let Some(place) = place.or(file.estimator.place.as_ref()) {
        problems.reject(
            place,
            "a surrogate scores searches; it measures nothing",
            "\"exact\" or \"hybrid\"",
            "use `method = \"exact\"`; `kind = \"validate\"` shows what a surrogate predicts",
        );
    }
}

fn estimate(file: &StudyFile, problems: &Problems, design: &Design) -> Option<Estimate> {
    refuse_tables(file, problems, "estimate");
    let Some(table) = &file.limits else {
        report_missing_limits(problems, design.robot.joints());
        return None;
    };
    let radii = file.estimate.as_ref().and_then(|e| e.value.radii.as_ref());
    Some(Estimate {
        limits: limits::check(table, problems, &design.robot)?,
        radii: radii.map(|item| item.value.clone()).unwrap_or_default(),
    })
}

fn optimise(
    file: &StudyFile,
    problems: &Problems,
    design: &Design,
    estimator: &Estimator,
) -> Option<Optimise> {
    refuse_tables(file, problems, "optimise");
    let table = file.limits.as_ref();
    let start = table.and_then(|table| limits::check(table, problems, &design.robot));
    let search = limits::search(file, problems, &design.robot);
    if let (Some(table), Some(start)) = (table, &start) {
        limits::check_start(table, start, problems, search.min_width_deg);
    }
    let table = file.optimiser.as_ref().map(|item| &item.value);
    let mut optimiser = optimiser_settings(table, problems);
    match (&mut optimiser, estimator) {
        (OptimiserSettings::CoordinateAscent(ascent), Estimator::Hybrid { .. })
            if !table.is_some_and(|table| table.restarts_given) =>
        {
            ascent.restarts = COSTLY_RESTARTS;
        }
        (OptimiserSettings::Genetic(genetic), Estimator::Surrogate { .. })
            if !table.is_some_and(|table| table.population_given) =>
        {
            genetic.population = CHEAP_POPULATION;
        }
        _ => {}
    }
    Some(Optimise {
        start,
        search,
        optimiser,
    })
}

fn manifolds(file: &StudyFile, problems: &Problems, design: &Design) -> Option<Manifolds> {
    refuse_tables(file, problems, "manifolds");
    serve::check_manifolds(file, problems, &design.robot);
    let Some(pose) = &file.pose else {
        report_missing_pose(problems);
        return None;
    };
    let limits = file.limits.as_ref();
    let search = file.manifolds.as_ref().map(|item| &item.value);
    Some(Manifolds {
        pose: pose_table::pose(pose, file.space.value, problems)?,
        limits: match limits {
            Some(table) => Some(limits::check(table, problems, &design.robot)?),
            None => None,
        },
        search: pose_table::search(
            search,
            design.robot.degree_of_redundancy(file.space.value),
            problems,
        ),
    })
}

/// The studies about singular configurations.
fn singular(
    file: &StudyFile,
    problems: &Problems,
    design: &Design,
    kind: Kind,
) -> Option<Question> {
    let singularities = file.singularities.as_ref().map(|item| item.value.clone());
    let singularities = singularities.unwrap_or_default();
    match kind {
        Kind::Singularities => {
            refuse_tables(file, problems, "singularities");
            serve::check_singularities(file, problems, &design.robot);
            Some(Question::Singularities(singularities))
        }
        Kind::LargestManifold => {
            refuse_tables(file, problems, "largest-manifold");
            serve::check_curves(file, problems, &design.robot);
            let largest = file.largest.as_ref().map(|item| item.value.clone());
            Some(Question::LargestManifold(LargestManifold {
                singularities,
                largest: largest.unwrap_or_default(),
            }))
        }
        _ => {
            refuse_tables(file, problems, "failure-experiment");
            serve::check_curves(file, problems, &design.robot);
            let Some(table) = &file.failure else {
                report_missing_goals(problems);
                return None;
            };
            let study = singular_table::failure(&table.value, &design.robot, problems)?;
            Some(Question::FailureExperiment(study))
        }
    }
}

/// Reports every table that belongs to another kind of study.
fn refuse_tables(file: &StudyFile, problems: &Problems, kind: &str) {
    fn place<T>(item: &Option<Item<T>>) -> Option<&Place> {
        item.as_ref().map(|item| &item.place)
    }
    let limits = file.limits.as_ref().map(|limits| Place {
        key: "limits".into(),
        span: limits.lower_deg.place.span.clone(),
    });
    let measured: &[&str] = &["estimate", "optimise"];
    let tables: [(Option<&Place>, &[&str]); 13] = [
        (
            place(&file.singularities),
            &["singularities", "largest-manifold"],
        ),
        (place(&file.largest), &["largest-manifold"]),
        (place(&file.failure), &["failure-experiment"]),
        (file.estimator.place.as_ref(), measured),
        (place(&file.estimate), &["estimate"]),
        (place(&file.search), &["optimise"]),
        (place(&file.optimiser), &["optimise"]),
        (place(&file.pose), &["manifolds"]),
        (place(&file.manifolds), &["manifolds"]),
        (file.train_place.as_ref(), &["train"]),
        (place(&file.validate), &["validate"]),
        (place(&file.synthesis), &["synthesis"]),
        (
            limits.as_ref(),
            &["estimate", "optimise", "manifolds", "synthesis"],
        ),
    ];
    for (place, kinds) in tables {
        if let Some(place) = place.filter(|_| !kinds.contains(&kind)) {
            refuse_table(problems, place, kind, kinds[0]);
        }
    }
}

fn optimiser_settings(table: Option<&OptimiserTable>, problems: &Problems) -> OptimiserSettings {
    let Some(table) = table else {
        return OptimiserSettings::CoordinateAscent(Default::default());
    };
    let population = table.genetic.population;
    let at_most = |item: &Option<Item<u64>>, most: u64| {
        if let Some(item) = item.as_ref().filter(|item| item.value > most) {
            problems.reject(
                &item.place,
                "too many for the population",
                &format!("at most {most} with a population of {population}"),
                "lower it, or raise `population`",
            );
        }
    };
    at_most(&table.elite, population.saturating_sub(1));
    at_most(&table.tournament, population);
    match table.method {
        Method::CoordinateAscent => {
            OptimiserSettings::CoordinateAscent(table.coordinate_ascent.clone())
        }
        Method::Genetic => OptimiserSettings::Genetic(table.genetic.clone()),
    }
}

fn failures(file: &StudyFile, problems: &Problems, joints: usize) -> FailureSet {
    let Some(item) = &file.failures else {
        return FailureSet::any(joints);
    };
    let Failures::Of(list) = &item.value else {
        return FailureSet::any(joints);
    };
    let expected = format!("joint numbers from 1 to {joints}, each once, or \"any\"");
    if list.is_empty() {
        let help = "name the joints that may lock, or write `failures = \"any\"`";
        problems.reject(&item.place, "the failure set is empty", &expected, help);
    }
    let mut numbers = Vec::with_capacity(list.len());
    for entry in list {
        let number = usize::try_from(entry.value).unwrap_or(usize::MAX);
        if number > joints {
            let message = format!("the robot has no joint {number}");
            let help = format!("the robot has {joints} joints, counted from 1 at the base");
            problems.reject(&entry.place, &message, &expected, &help);
        } else if numbers.contains(&number) {
            let message = format!("joint {number} is listed twice");
            problems.reject(&entry.place, &message, &expected, "remove one of the two");
        }
        numbers.push(number);
    }
    FailureSet::of(joints, &numbers)
}

fn report(file: &StudyFile, problems: &Problems) -> ReportSettings {
    let default = ReportSettings::default();
    let mut formats: Vec<FigureFormat> = Vec::new();
    for format in file.formats.iter().flat_map(|item| &item.value) {
        if formats.contains(&format.value) {
            let (expected, help) = ("each format once", "remove one of the two");
            problems.reject(&format.place, "a format is listed twice", expected, help);
        }
        formats.push(format.value);
    }
    ReportSettings {
        formats: match file.formats {
            Some(_) => formats,
            None => default.formats,
        },
        figures: file.figures.unwrap_or(default.figures),
    }
}

fn refuse_table(problems: &Problems, place: &Place, kind: &str, other: &str) {
    let key = &place.key;
    let problem = Problem {
        message: format!("this table has no meaning for `kind = \"{kind}\"`"),
        found: format!("`[{key}]`"),
        expected: format!("`[{key}]` only with `kind = \"{other}\"`"),
        help: format!("remove the table, or write `kind = \"{other}\"`"),
    };
    problems.report(place, problem);
}

fn report_missing_limits(problems: &Problems, joints: usize) {
    let place = Place {
        key: "limits".into(),
        span: 0..0,
    };
    let problem = Problem {
        message: "an estimate needs artificial joint limits".into(),
        found: "no table `[limits]`".into(),
        expected: format!("`lower_deg` and `upper_deg` with {joints} entries each"),
        help: "add `[limits]` with `lower_deg = […]` and `upper_deg = […]`".into(),
    };
    problems.report_absent(&place, problem);
}

fn report_missing_goals(problems: &Problems) {
    let place = Place {
        key: "failure-experiment".into(),
        span: 0..0,
    };
    let problem = Problem {
        message: "a failure experiment needs a start and goals".into(),
        found: "no table `[failure-experiment]`".into(),
        expected: "`start_deg` and `goals`".into(),
        help: "add `[failure-experiment]` with `start_deg = […]` and `goals = [ { name = \"A\", \
               theta_deg = […] } ]`"
            .into(),
    };
    problems.report_absent(&place, problem);
}

fn report_missing_pose(problems: &Problems) {
    let place = Place {
        key: "pose".into(),
        span: 0..0,
    };
    let problem = Problem {
        message: "a study of manifolds needs a pose".into(),
        found: "no table `[pose]`".into(),
        expected: "`position` and, for pose tasks, `rotation` or `phi_deg`".into(),
        help: "add `[pose]` with `position = […]`".into(),
    };
    problems.report_absent(&place, problem);
}

#[cfg(test)]
mod hybrid_tests;
#[cfg(test)]
mod tests;
