use super::*;
use crate::diagnostic::{InputError, Source};
use crate::study::{CoordinateAscent, Genetic, StudyFile};

pub(super) const HEAD: &str = "kind = 'optimise'\ndesign = 'd.toml'\n[task]\nspace = ";
pub(super) const ROBOT: &str = "name = 'r'\nlinks = ";

/// Validates a study of a robot; `text` goes on after `HEAD`.
pub(super) fn parse(robot: &str, text: &str) -> Result<Study, InputError> {
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

pub(super) fn planar(links: &str, text: &str) -> Result<Study, InputError> {
    parse(&format!("{ROBOT}{links}"), text)
}

pub(super) const R3: &str = "[1, 1, 1]";

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
        let text = format!("'planar-position'\n[optimiser.genetic]\npopulation = 8\n{setting}\n");
        let error = planar(R3, &text).unwrap_err();
        assert_eq!(error.key(), format!("optimiser.genetic.{key}"));
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
