//! Figures and files of surrogates.

use super::*;

fn arc(low: f64, high: f64) -> AngleSet {
    AngleSet::from_arcs([Arc::from_interval(low, high)])
}

fn case(label: &str) -> WorkspaceCase {
    WorkspaceCase {
        label: label.into(),
        limits_label: "[−18°, 18°], free".into(),
        exact: rings(),
        predicted: RingMap {
            unrestricted: [0.5, 3.0],
            rings: vec![],
        },
        exact_size: 3.56194,
        predicted_size: 0.0,
        overlap: 0.25,
    }
}

fn workspaces(count: usize) -> PredictedWorkspaces {
    PredictedWorkspaces {
        cases: (0..count).map(|k| case(&format!("case {k}"))).collect(),
        unit: "m^2".into(),
    }
}

fn density() -> AngleDensity {
    AngleDensity {
        radii: vec![1.0, 1.5, 2.0],
        angles: 4,
        density: vec![0.0, 0.1, 0.2, 0.1, 0.3, f64::NAN, 0.2, 0.1],
        exact: vec![(1.25, arc(-1.0, 0.5)), (1.75, arc(3.0, 3.5))],
        gate: [1.1, 1.9],
        title: "mdn & more".into(),
    }
}

fn filter() -> FilterFigure {
    FilterFigure {
        before: vec![[1.0, 0.5], [1.0, 4.0], [f64::NAN, 1.0]],
        after: vec![[1.0, 0.5]],
        exact: density().exact,
        filter_label: "α = 3".into(),
    }
}

fn scatter(surrogates: usize) -> SizeScatter {
    let series = |k: usize| SizeSeries {
        label: format!("network_{}", k / 2),
        kind: ["walk", "uniform"][k % 2].into(),
        exact: vec![0.0, 1.0, 3.5],
        predicted: vec![0.1, 1.1, 3.4],
    };
    SizeScatter {
        series: (0..2 * surrogates).map(series).collect(),
        unit: "m^2".into(),
        largest: 3.56,
    }
}

fn calibration() -> Calibration {
    let bin = |predicted, observed, count| CalibrationBin {
        predicted,
        observed,
        count,
    };
    Calibration {
        curves: vec![CalibrationCurve {
            label: "arcs".into(),
            bins: vec![bin(0.1, 0.2, 30), bin(0.5, f64::NAN, 0), bin(0.9, 0.8, 70)],
        }],
    }
}

fn training(losses: &[f64]) -> TrainingCurve {
    let epoch = |(k, loss): (usize, &f64)| TrainingEpoch {
        number: k as u64 + 1,
        training_loss: *loss,
        kept_back_loss: 1.1 * loss,
    };
    TrainingCurve {
        epochs: losses.iter().enumerate().map(epoch).collect(),
        best: 2,
    }
}

#[test]
fn figures_of_surrogates_carry_their_labels() {
    let has = |figure: &dyn Figure, labels: &[&str]| {
        assert_draws(figure);
        let svg = figure_svg(figure).unwrap();
        for label in labels {
            assert!(svg.contains(label), "{}: {label}", figure.name());
        }
    };
    let texts = ["case 0: overlap 0.250", "= 3.562 m²", "= 0 m²", "is empty"];
    has(&workspaces(3), &texts);
    has(&workspaces(3), &["x (m)", "y (m)", "[−18°, 18°], free"]);
    let texts = ["β (deg)", "r (m)", "density of β (rad⁻¹)", "mdn &amp; more"];
    has(&density(), &texts);
    has(&density(), &["exact edge", "reachable gate", "no density"]);
    has(&filter(), &["(a) before", "(b) after", "α = 3", "β (deg)"]);
    has(&scatter(6), &["network 5", "walk", "uniform", "(m²)"]);
    has(&calibration(), &["predicted probability", "observed share"]);
    has(&training(&[1.0, 0.5, 0.2]), &["epoch 2", "mean loss"]);
}

#[test]
fn tables_of_surrogates_hold_all_numbers() {
    let csv = |figure: &dyn Figure| figure.table().to_csv().unwrap();
    let table = csv(&workspaces(9));
    let header = "case,limits,overlap,size_exact_m2,size_predicted_m2,workspace,";
    assert!(table.starts_with(header), "{table}");
    // The exact one has two arcs in each of 11 rings; the empty one has one row all the same.
    assert_eq!(table.lines().count(), 1 + 9 * (22 + 1));
    assert!(table.contains("0.25,3.56194,0,predicted,,,,\n"));
    let table = csv(&density());
    assert!(table.contains("cell,1,1.5,-90,0,0.1\n"));
    assert!(table.contains("cell,1.5,2,-90,0,\n"));
    assert_eq!(table.matches("exact,").count(), 2);
    let table = csv(&filter());
    assert_eq!(table.matches("before,").count(), 3);
    assert_eq!(table.matches("after,").count(), 1);
    let table = csv(&scatter(7));
    assert!(table.starts_with("surrogate,designs,exact_m2,predicted_m2\n"));
    assert!(table.contains("network_6,uniform,3.5,3.4\n"));
    let table = csv(&calibration());
    assert_eq!(
        table,
        "curve,predicted,observed,count\narcs,0.1,0.2,30\narcs,0.5,,0\narcs,0.9,0.8,70\n"
    );
    let table = csv(&training(&[1.0, 0.5]));
    assert!(table.contains("2,0.5,0.55,true\n"), "{table}");
}

#[test]
fn what_is_not_drawn_is_told() {
    assert!(workspaces(9).caption().contains("first 8 of 9"));
    assert!(scatter(7).caption().contains("first 6 of 7"));
    let mut wild = scatter(1);
    wild.series[0].predicted = vec![1e30, -7.0, 3.4];
    assert!(wild.caption().contains("2 predictions beyond"));
    assert_draws(&wild);
    let mut peak = density();
    peak.density = vec![0.1; 400];
    peak.density[7] = 50.0;
    assert!(peak.caption().contains("0.1 rad⁻¹ and more"));
    assert!(!density().caption().contains("and more"));
    assert!(filter().caption().contains("1 of 3 angles"));
}

#[test]
fn losses_are_drawn_over_a_logarithm_only_if_positive() {
    let svg = |losses: &[f64]| figure_svg(&training(losses)).unwrap();
    assert!(svg(&[100.0, 10.0, 0.1]).contains("10⁻¹"));
    assert!(svg(&[0.6, 0.2, 0.06]).contains(">0.05<") || svg(&[0.6, 0.2, 0.06]).contains("0.1"));
    assert!(!svg(&[100.0, -10.0, 0.1]).contains("10⁻¹"));
}

#[test]
fn surrogates_without_data_are_drawn() {
    for count in 0..10 {
        assert_draws(&workspaces(count));
        assert_draws(&scatter(count));
    }
    assert_draws(&AngleDensity::default());
    assert_draws(&FilterFigure::default());
    assert_draws(&Calibration::default());
    assert_draws(&TrainingCurve::default());
    for losses in [
        &[0.3][..],
        &[0.0],
        &[-1.0, -1.0],
        &[f64::NAN, f64::INFINITY],
    ] {
        assert_draws(&training(losses));
    }
    let mut empty = density();
    empty.density = vec![0.0; 8];
    empty.exact = vec![(1.0, AngleSet::empty()), (2.0, AngleSet::empty())];
    assert_draws(&empty);
    empty.exact = vec![(1.0, AngleSet::full()), (1.0, AngleSet::full())];
    empty.density.truncate(3);
    assert_draws(&empty);
    let mut zero = scatter(2);
    zero.largest = 0.0;
    for series in &mut zero.series {
        (series.exact, series.predicted) = (vec![0.0; 3], vec![0.0; 2]);
    }
    assert_draws(&zero);
}

#[test]
fn odd_numbers_of_surrogates_are_drawn() {
    for value in [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e300, 1e-300, f64::MIN] {
        let mut odd = workspaces(1);
        odd.cases[0].exact.unrestricted = [0.0, value];
        (odd.cases[0].exact_size, odd.cases[0].overlap) = (value, value);
        assert_draws(&odd);
        let mut odd = density();
        (odd.gate, odd.radii[1], odd.density[0]) = ([value, 1.0], value, value);
        odd.exact.push((value, arc(0.0, 1.0)));
        assert_draws(&odd);
        let mut odd = filter();
        odd.before.extend([[value, 1.0], [1.0, value]]);
        assert_draws(&odd);
        let mut odd = scatter(1);
        (
            odd.largest,
            odd.series[0].exact[1],
            odd.series[1].predicted[1],
        ) = (value, value, value);
        assert_draws(&odd);
        let mut odd = calibration();
        odd.curves[0].bins[0].predicted = value;
        assert_draws(&odd);
        assert_draws(&training(&[1.0, value, 0.5]));
    }
}

#[test]
fn a_report_on_surrogates_is_whole_and_overwrites_nothing() {
    let (first, second, curve) = (scatter(1), scatter(2), training(&[1.0, 0.5]));
    let of_arcs = FigureOf::new("arcs, wide", &curve);
    let report = SurrogateReport {
        title: "<b>surrogates</b>".into(),
        study: "validate".into(),
        robot: "planar".into(),
        source: String::new(),
        task: "position in the plane".into(),
        failures_label: "any single joint".into(),
        status: "complete".into(),
        rows: vec![("held-out sets".into(), "250".into())],
        tables: vec![
            ReportTable {
                name: "all surrogates".into(),
                caption: "All & everything.".into(),
                header: vec!["surrogate".into(), "RMSE (%)".into()],
                rows: vec![vec!["arcs".into(), "1.2".into()], vec!["size".into()]],
            },
            ReportTable::default(),
        ],
        figures: vec![&first, &second, &of_arcs],
        result_json: serde_json::json!({ "schema": 1 }),
        study_toml: "kind = \"validate\"\n".into(),
        provenance: vec![("seed".into(), "1".into())],
        notes: vec![],
    };
    let directory = tempfile::tempdir().unwrap();
    let written = write_surrogate_report(&report, directory.path(), &[Format::Svg]).unwrap();
    let files = files(directory.path());
    assert_eq!(written.len(), files.len());
    let names: Vec<&str> = files.keys().map(String::as_str).collect();
    let expected = [
        "all_surrogates.csv",
        "predicted_sizes.csv",
        "predicted_sizes.svg",
        "predicted_sizes_2.csv",
        "predicted_sizes_2.svg",
        "report.html",
        "result.json",
        "study.toml",
        "training_arcs_wide.csv",
        "training_arcs_wide.svg",
    ];
    assert_eq!(names, expected);
    let text = |name: &str| String::from_utf8(files[name].clone()).unwrap();
    assert_eq!(
        text("all_surrogates.csv"),
        "surrogate,RMSE (%)\narcs,1.2\nsize,\n"
    );
    let page = text("report.html");
    for part in [
        "&lt;b&gt;surrogates",
        "All &amp; everything.",
        "<td class=\"n\">1.2</td>",
        "held-out sets",
        "arcs, wide: Mean loss",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("http") && !page.contains("NaN"));
}
