//! Figures of a search for robots: what they show of made-up results, and that nothing odd in
//! these stops them.

mod figure_laws;

use faultspace::report::{
    DesignParameter, Figure, FindingReport, Format, HistoryGeneration, HistoryStage,
    ParameterSensitivity, ParameterSensitivityFigure, SearchHistoryFigure, Table, TradeOffFigure,
    TradeOffObjective, TradeOffPoint, write_finding_report,
};
use figure_laws::draw;

/// A fraction in [0, 1), the same for the same numbers.
fn noise(a: usize, b: usize) -> f64 {
    let x = (a as f64 * 12.9898 + b as f64 * 78.233).sin() * 43_758.547;
    x - x.floor()
}

fn objective(name: &str, unit: &str, is_larger_better: bool) -> TradeOffObjective {
    TradeOffObjective {
        name: name.into(),
        unit: unit.into(),
        is_larger_better,
    }
}

fn point(label: &str, values: &[f64], is_on_front: bool) -> TradeOffPoint {
    TradeOffPoint {
        label: label.into(),
        values: values.to_vec(),
        errors: vec![0.12, 0.9, 0.02, 0.3, 0.01],
        is_on_front,
    }
}

/// A front with `count` objectives: ball share, share of pre-failure workspace, length, survival,
/// dexterity.
fn trade_offs(count: usize) -> TradeOffFigure {
    let objectives = [
        objective("ball share", "%", true),
        objective("W_0 / S₀ₘₐₓ", "%", true),
        objective("total length", "m", false),
        objective("survival W_F / W_0", "%", true),
        objective("1 / condition", "", true),
    ];
    let values = |k: usize, loss: f64| {
        let t = k as f64 / 33.0;
        let length = 0.9 + 0.9 * noise(k, 3) * (1.0 - 0.4 * t);
        let share = 6.2 * (1.0 - t * t) * (length / 1.8).sqrt() * (1.0 - 0.23 * loss);
        vec![
            share + 0.2 * noise(k, 1),
            18.0 + 55.0 * t - 6.0 * loss,
            length + 0.2 * loss,
            70.0 - 40.0 * t * noise(k, 5),
            0.05 + 0.1 * noise(k, 6) * (1.0 - t),
        ]
    };
    let points = (0..34).map(|k| point("", &values(k, 0.0), k % 9 != 4));
    let searched = (0..400).map(|k| values(k % 34, 4.0 * noise(k, 9).powi(2) + 0.1));
    TradeOffFigure {
        points: points.collect(),
        named: vec![
            point("start", &[1.9, 34.0, 1.7, 45.0, 0.06], false),
            point("chosen_robot", &[5.4, 41.0, 1.35, 60.0, 0.09], true),
        ],
        searched: searched.chain([vec![-40.0, 0.0, 9.0, 0.0, 0.0]]).collect(),
        objectives: objectives[..count].to_vec(),
        title: "spatial 7R, poses".into(),
    }
}

#[test]
fn trade_offs_show_pairs_of_objectives() {
    for (count, panels) in [(2, 1), (3, 3), (4, 3), (5, 4)] {
        let figure = trade_offs(count);
        let svg = draw(&figure);
        assert_eq!(
            svg.matches(">\nbetter\n<").count(),
            panels,
            "{count} objectives"
        );
        for text in [
            "ball share (%)",
            "chosen-robot",
            "beaten when scored anew",
            "spatial 7R",
        ] {
            assert!(svg.contains(text), "{text}");
        }
        assert_eq!(svg.contains("(c)"), panels > 2);
        let table = figure.table();
        assert_eq!(
            table.header[2..4],
            ["ball_share_percent", "ball_share_percent_error"]
        );
        assert_eq!(table.header.len(), 2 + 2 * count);
        assert_eq!(table.rows.len(), 34 + 2 + 401);
        let caption = figure.caption();
        assert!(
            caption.contains("between ball share") && caption.contains("outside"),
            "{caption}"
        );
    }
}

#[test]
fn odd_trade_offs_are_drawn() {
    for count in 0..=1 {
        assert!(draw(&trade_offs(count)).contains("fewer than two"));
    }
    let nothing = TradeOffFigure {
        points: vec![],
        named: vec![],
        searched: vec![],
        ..trade_offs(3)
    };
    assert!(draw(&nothing).contains("no data"));
    let odd = [f64::NAN, f64::INFINITY, 0.0, -1e300, 1e-300];
    for value in odd {
        draw(&TradeOffFigure {
            points: vec![point(&"long name ".repeat(30), &[value; 3], true)],
            named: vec![point(&"long name ".repeat(30), &[1.0, value], true)],
            searched: vec![vec![value], vec![value; 4]],
            title: "a very long title ".repeat(30),
            ..trade_offs(3)
        });
    }
    let six = TradeOffFigure {
        objectives: vec![objective("x", "", true); 6],
        ..trade_offs(5)
    };
    assert_eq!(draw(&six).matches(">\nbetter\n<").count(), 4);
}

fn stage(name: &str, from: f64, to: f64, scores: [f64; 2]) -> HistoryStage {
    let generation = |k: u32| {
        let t = f64::from(k) / 24.0;
        let noisy = 0.5 * (noise(k as usize, from as usize) - 0.5);
        let best = scores[0] + (scores[1] - scores[0]) * (1.0 - (-4.0 * t).exp()) + noisy;
        let spread = 0.4 + 3.0 * (-3.0 * t).exp();
        HistoryGeneration {
            at: from + t * (to - from),
            best,
            median: best - spread,
            quartiles: [best - 1.6 * spread, best - 0.5 * spread],
        }
    };
    HistoryStage {
        name: name.into(),
        generations: (0..=24).map(generation).collect(),
    }
}

fn history(names: [&str; 4]) -> SearchHistoryFigure {
    SearchHistoryFigure {
        score_label: "S_F / S₀ₘₐₓ".into(),
        unit: "%".into(),
        axis_label: "evaluations".into(),
        stages: vec![
            stage(names[0], 40.0, 2000.0, [3.0, 8.0]),
            stage(names[1], 2050.0, 5000.0, [9.0, 16.8]),
            stage(names[2], 5050.0, 9000.0, [16.5, 19.6]),
            stage(names[3], 9020.0, 9600.0, [19.2, 19.3]),
        ],
        reported: Some([18.72, 0.11]),
        title: "spatial 7R, poses".into(),
    }
}

#[test]
fn histories_show_stages_and_the_score_held_out() {
    let figure = history(["screening", "links", "general twists", "rounding"]);
    let svg = draw(&figure);
    for text in [
        "evaluations",
        "held out: 18.72 ± 0.11 %",
        "D rounding",
        "median",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    // Where all names have room there are no letters.
    assert!(!draw(&history(["one", "two", "three", "4"])).contains("A one"));
    let table = figure.table();
    assert_eq!(table.rows.len(), 4 * 25 + 1);
    assert_eq!(table.rows[100][..3], ["reported", "", "18.72"]);
    assert!(figure.caption().contains("screening, links"));
}

#[test]
fn odd_histories_are_drawn() {
    assert!(draw(&SearchHistoryFigure::default()).contains("no data"));
    let one = |value: f64| HistoryStage {
        name: "a very long name of a stage ".repeat(9),
        generations: vec![HistoryGeneration {
            at: value,
            best: value,
            median: -value,
            quartiles: [value, 1.0],
        }],
    };
    for value in [f64::NAN, f64::INFINITY, 0.0, -3.0, 1e300, 1e-300] {
        for reported in [None, Some([value, 1.0]), Some([1.0, value])] {
            draw(&SearchHistoryFigure {
                stages: vec![one(value), HistoryStage::default(), one(2.0)],
                reported,
                ..history(["", "", "", ""])
            });
        }
    }
}

fn tolerances(joints: usize) -> ParameterSensitivityFigure {
    type Kind = fn(usize) -> DesignParameter;
    let kinds: [Kind; 5] = [
        DesignParameter::Length,
        DesignParameter::Offset,
        DesignParameter::Twist,
        DesignParameter::LowerLimit,
        DesignParameter::UpperLimit,
    ];
    let mut parameters = Vec::new();
    for (number, kind) in kinds.into_iter().enumerate() {
        for joint in 1..=joints {
            let size = 0.8 * noise(number, joint).powi(2);
            parameters.push(ParameterSensitivity {
                parameter: kind(joint),
                change: [-size * 0.8, size * (noise(joint, number) - 0.8)],
                error: [0.03 + 0.02 * size, 0.03],
            });
        }
    }
    ParameterSensitivityFigure {
        score_label: "S_F / S₀ₘₐₓ".into(),
        tolerance: "lengths ±0.5 % of the reach, angles ±0.5°".into(),
        parameters,
        title: "found 7R: 18.7 %".into(),
    }
}

#[test]
fn tolerances_are_shown_parameter_by_parameter() {
    let figure = tolerances(8);
    let svg = draw(&figure);
    for text in [
        "(a) link parameters",
        "(b) artificial limits",
        "α₈",
        "a₁",
        "θ₃ upper",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    assert_eq!(figure.table().rows.len(), 40);
    assert_eq!(figure.table().rows[16][0], "alpha_1");
    assert!(figure.caption().contains("±0.5 % of the reach"));
    assert_eq!(figure.size().width, 504.0);
    let few = tolerances(2);
    assert_eq!(few.size().width, 241.0);
    assert!(!draw(&few).contains("(a)"));
    let mut links = tolerances(8);
    links.parameters.retain(|row| !row.parameter.is_limit());
    assert!(!draw(&links).contains("artificial limits"));
    assert!(draw(&ParameterSensitivityFigure::default()).contains("no data"));
    for value in [f64::NAN, f64::INFINITY, 0.0, 1e300, -1e-300] {
        let mut odd = tolerances(1);
        odd.parameters[0].change = [value, 1.0];
        odd.parameters[1].error = [value; 2];
        odd.parameters[2].parameter = DesignParameter::Angle(123);
        draw(&odd);
    }
}

#[test]
fn a_report_links_its_files() {
    let figure = history(["a", "b", "c", "d"]);
    let report = FindingReport {
        title: "A better robot".into(),
        study: "s".into(),
        robot: "r".into(),
        source: String::new(),
        summary: vec!["Found.".into()],
        sections: vec![],
        figures: vec![&figure],
        tables: vec![("front.csv", Table::new(&["x"]))],
        files: vec![("found.toml".into(), "name = \"r\"\n".into())],
        result_json: serde_json::json!({ "schema": 1 }),
        study_toml: String::new(),
        provenance: vec![],
        notes: vec![],
    };
    let folder = tempfile::tempdir().unwrap();
    let written = write_finding_report(&report, folder.path(), &[Format::Svg], true).unwrap();
    assert!(written.contains(&folder.path().join("found.toml")));
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    assert!(page.contains("<a href=\"found.toml\" download"), "{page}");
    let text = std::fs::read_to_string(folder.path().join("found.toml")).unwrap();
    assert_eq!(text, "name = \"r\"\n");
}
