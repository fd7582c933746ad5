//! Checks a study file against its robot and fills in defaults.

use super::file::{Failures, Kind, StudyFile};
use super::search::{Method, OptimiserTable};
use super::settings::{
    Design, Estimate, Estimator, EstimatorMethod, FigureFormat, Manifolds, Optimise,
    OptimiserSettings, Question, ReportSettings, Study,
};
use super::{hybrid_table, limits, pose_table, serve};
use crate::diagnostic::{Item, Place, Problem, Problems};
use crate::workspace::FailureSet;

/// Random starts of a search whose score costs milliseconds, if the study names no number.
const COSTLY_RESTARTS: u64 = 8;

/// The validated study; reports to `problems` whatever is wrong.
pub(super) fn study(
    name: &str,
    file: &StudyFile,
    problems: &Problems,
    design: Design,
) -> Option<Study> {
    let (question, estimator) = match file.kind.value {
        Kind::Estimate => {
            let estimator = estimator(file, problems, &design);
            let question = estimate(file, problems, &design).map(Question::Estimate);
            (question, estimator)
        }
        Kind::Optimise => {
            let estimator = estimator(file, problems, &design);
            let costly = matches!(estimator, Estimator::Hybrid { .. });
            let question = optimise(file, problems, &design, costly).map(Question::Optimise);
            (question, estimator)
        }
        Kind::Manifolds => {
            let question = manifolds(file, problems, &design).map(Question::Manifolds);
            (question, Estimator::default())
        }
    };
    let failures = failures(file, problems, design.robot.joints());
    Some(Study {
        name: name.to_owned(),
        title: file.title.clone(),
        seed: file.seed.unwrap_or(1),
        task: file.space.value,
        failures,
        question: question?,
        estimator,
        report: report(file, problems),
        design,
    })
}

fn estimator(file: &StudyFile, problems: &Problems, design: &Design) -> Estimator {
    match serve::choose(file, problems, &design.robot) {
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
    costly: bool,
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
    if let OptimiserSettings::CoordinateAscent(ascent) = &mut optimiser
        && costly
        && !table.is_some_and(|table| table.restarts_given)
    {
        ascent.restarts = COSTLY_RESTARTS;
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
        search: pose_table::search(search),
    })
}

/// Reports every table that belongs to another kind of study.
fn refuse_tables(file: &StudyFile, problems: &Problems, kind: &str) {
    fn place<T>(item: &Option<Item<T>>) -> Option<&Place> {
        item.as_ref().map(|item| &item.place)
    }
    let measured: &[&str] = &["estimate", "optimise"];
    let tables: [(Option<&Place>, &[&str]); 6] = [
        (file.estimator.place.as_ref(), measured),
        (place(&file.estimate), &["estimate"]),
        (place(&file.search), &["optimise"]),
        (place(&file.optimiser), &["optimise"]),
        (place(&file.pose), &["manifolds"]),
        (place(&file.manifolds), &["manifolds"]),
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
mod tests {
    use super::*;
    use crate::diagnostic::{InputError, Source};
    use crate::study::{CoordinateAscent, Genetic, StudyFile};

    const HEAD: &str = "kind = 'optimise'\ndesign = 'd.toml'\n[task]\nspace = ";
    const ROBOT: &str = "name = 'r'\nlinks = ";

    /// Validates a study of a robot; `text` goes on after `HEAD`.
    fn parse(robot: &str, text: &str) -> Result<Study, InputError> {
        let text = if text.starts_with("kind") {
            text.to_owned()
        } else {
            format!("{HEAD}{text}\n")
        };
        let source = Source::new("s.toml", text);
        let file = StudyFile::parse(&source)?;
        let design = Design::parse("/d.toml".into(), &Source::new("d.toml", robot))?;
        Study::validate("s", &file, &source, design)
    }

    fn planar(links: &str, text: &str) -> Result<Study, InputError> {
        parse(&format!("{ROBOT}{links}"), text)
    }

    const R3: &str = "[1, 1, 1]";

    #[test]
    fn defaults_are_filled_in() {
        let study = planar(R3, "'planar-position'").unwrap();
        assert_eq!((study.seed, study.name.as_str()), (1, "s"));
        assert_eq!(study.failures, FailureSet::any(3));
        assert_eq!(study.estimator, Estimator::default());
        assert_eq!(study.report, ReportSettings::default());
        let Question::Optimise(optimise) = study.question else {
            panic!("optimise expected");
        };
        assert_eq!(optimise.start, None);
        assert_eq!(
            (optimise.search.min_width_deg, optimise.search.links),
            (0.0, None)
        );
        let ascent = OptimiserSettings::CoordinateAscent(CoordinateAscent::default());
        assert_eq!(optimise.optimiser, ascent);
    }

    #[test]
    fn settings_reach_the_chosen_optimiser() {
        let text = "'planar-position'\n[optimiser]\nmethod = 'genetic'\n\
            [optimiser.genetic]\npopulation = 8\nelite = 7\ntournament = 8\npolish = false";
        let Question::Optimise(optimise) = planar(R3, text).unwrap().question else {
            panic!("optimise expected");
        };
        let genetic = Genetic {
            population: 8,
            elite: 7,
            tournament: 8,
            polish: false,
            ..Genetic::default()
        };
        assert_eq!(optimise.optimiser, OptimiserSettings::Genetic(genetic));
        for (setting, key) in [("elite = 8", "elite"), ("tournament = 9", "tournament")] {
            let text =
                format!("'planar-position'\n[optimiser.genetic]\npopulation = 8\n{setting}\n");
            let error = planar(R3, &text).unwrap_err();
            assert_eq!(error.key(), format!("optimiser.genetic.{key}"));
        }
    }

    #[test]
    fn what_exact_cannot_serve_is_refused_by_name() {
        let message = |robot: &str, task: &str| {
            let error = parse(robot, &format!("'{task}'")).unwrap_err();
            (error.key().to_owned(), error.render(false))
        };
        let arm = |n: usize| format!("{ROBOT}{:?}", vec![1.0; n]);
        for (n, task) in [
            (2, "planar-position"),
            (3, "planar-pose"),
            (6, "spatial-pose"),
        ] {
            let (key, text) = message(&arm(n), task);
            assert!(
                key == "task.space" && text.contains("more joints than"),
                "{text}"
            );
        }
        let bent = "name = 'r'\nconvention = 'standard'\njoints = [\n\
            { kind = 'revolute', alpha_deg = 90, a = 1 }, { kind = 'revolute', a = 1 },\n\
            { kind = 'revolute', a = 1 }]";
        let limited = format!(
            "{}\n[physical_limits]\nlower_deg = [0, 0, 0]\nupper_deg = [9, 9, 9]",
            arm(3)
        );
        let cases = [
            (arm(7), "spatial-pose", "task.space"),
            (arm(6), "planar-pose", "task.space"),
            (bent.to_owned(), "planar-position", "design"),
            (limited, "planar-position", "design"),
        ];
        for (robot, task, key) in cases {
            let (found, text) = message(&robot, task);
            assert!(found == key && text.contains("hybrid"), "{text}");
        }
    }

    #[test]
    fn limits_are_checked_against_the_robot() {
        let cases = [
            (
                "lower_deg = [0, 0]\nupper_deg = [1, 1, 1]",
                "lower_deg",
                "2 entries",
            ),
            (
                "lower_deg = [0, 5, 0]\nupper_deg = [1, 4, 1]",
                "upper_deg",
                "4",
            ),
            (
                "lower_deg = [-181, 0, 0]\nupper_deg = [180, 1, 1]",
                "upper_deg",
                "180",
            ),
        ];
        for (limits, key, found) in cases {
            for kind in ["estimate", "optimise"] {
                let text = format!(
                    "kind = '{kind}'\ndesign = 'd'\n[task]\nspace = 'planar-position'\n\
                     [limits]\n{limits}\n"
                );
                let error = planar(R3, &text).unwrap_err();
                assert_eq!(error.key(), format!("limits.{key}"));
                assert_eq!(error.problem().found, found);
            }
        }
        let full = "'planar-position'\n[limits]\n\
            lower_deg = [-18, 100, -180]\nupper_deg = [18, 460, 180]";
        assert!(planar(R3, full).is_ok());
        let narrow = format!("{full}\n[search]\nmin_width_deg = 40");
        assert_eq!(planar(R3, &narrow).unwrap_err().key(), "limits.upper_deg");
    }

    #[test]
    fn failure_sets_are_checked_against_the_robot() {
        let with = |list: &str| planar(R3, &format!("'planar-position'\nfailures = {list}"));
        assert_eq!(with("[3, 1]").unwrap().failures, FailureSet::of(3, &[1, 3]));
        for (list, found) in [("[]", "[]"), ("[4]", "4"), ("[1, 1]", "1"), ("[0]", "0")] {
            let error = with(list).unwrap_err();
            assert_eq!((error.key(), error.line()), ("task.failures", Some(5)));
            assert_eq!(error.problem().found, found);
        }
    }

    #[test]
    fn link_bounds_must_leave_room_for_the_total_length() {
        let with = |bounds: &str| planar(R3, &format!("'planar-position'\n[search]\n{bounds}"));
        let study = with("link_lower = [0.5, 0.5, 0.5]\nlink_upper = [2, 2, 2]").unwrap();
        let Question::Optimise(optimise) = study.question else {
            panic!("optimise expected");
        };
        assert_eq!(optimise.search.links.unwrap().link_upper, [2.0; 3]);
        let cases = [
            ("link_lower = [1, 1, 1]", "link_lower"),
            ("link_upper = [1, 1, 1]", "link_upper"),
            (
                "link_lower = [2, 1, 1]\nlink_upper = [2, 2, 2]",
                "link_lower",
            ),
            (
                "link_lower = [0.1, 0.1, 0.1]\nlink_upper = [0.5, 1, 1]",
                "link_upper",
            ),
            (
                "link_lower = [0, 0.1, 0.1]\nlink_upper = [2, 2, 2]",
                "link_lower",
            ),
            (
                "link_lower = [1, 0.1, 0.1]\nlink_upper = [0.5, 2, 2]",
                "link_upper",
            ),
            ("link_lower = [1]\nlink_upper = [2, 2, 2]", "link_lower"),
        ];
        for (bounds, key) in cases {
            assert_eq!(with(bounds).unwrap_err().key(), format!("search.{key}"));
        }
    }

    #[test]
    fn tables_of_the_other_kind_are_refused() {
        let limits = "[limits]\nlower_deg = [0, 0, 0]\nupper_deg = [9, 9, 9]\n";
        for table in ["search", "optimiser"] {
            let text = HEAD.replace("optimise", "estimate");
            let text = format!("{text}'planar-position'\n{limits}[{table}]\n");
            assert_eq!(planar(R3, &text).unwrap_err().key(), table);
        }
        let error = planar(R3, "'planar-position'\n[estimate]\nradii = []").unwrap_err();
        assert_eq!((error.key(), error.line()), ("estimate", Some(5)));
        let missing = HEAD.replace("optimise", "estimate") + "'planar-position'";
        assert_eq!(planar(R3, &missing).unwrap_err().key(), "limits");
    }
}
