//! Nothing to draw, numbers that are none, texts that are too long.

use super::*;

#[test]
fn empty_results_are_drawn() {
    let map = |unrestricted| {
        WorkspaceMap::Rings(RingMap {
            unrestricted,
            rings: vec![],
        })
    };
    for unrestricted in [
        [0.0, 3.0],
        [0.0, 0.0],
        [2.0, 1.0],
        [f64::NAN, f64::INFINITY],
    ] {
        let mut empty = sample(map(unrestricted));
        assert!(figure_svg(&figure(&empty)).unwrap().contains("is empty"));
        assert_draws(&figure(&empty));
        empty.links.clear();
        empty.limits = ArtificialLimits::new(vec![]);
        assert_draws(&figure(&empty));
        assert_draws(&LimitsFigure {
            limits: &empty.limits,
            is_planar: true,
        });
    }
    let nothing = ShareMap {
        unrestricted: [0.0, 1.0],
        radius_edges: vec![],
        angles: 0,
        share: vec![],
    };
    assert_draws(&figure(&sample(WorkspaceMap::Shares(nothing))));
    assert_draws(&Convergence::default());
    assert_draws(&Sensitivity::default());
}

#[test]
fn no_sizes_are_drawn() {
    for (joints, scale) in [
        (0, 1.0),
        (2, 0.0),
        (5, f64::NAN),
        (1, f64::INFINITY),
        (9, 1e-12),
    ] {
        let (sizes, failures) = (sizes(joints, scale), FailureSet::any(joints));
        assert_draws(&SizesFigure {
            sizes: &sizes,
            failures: &failures,
            unit: "m^2 rad",
        });
    }
}

#[test]
fn odd_numbers_are_drawn() {
    let odd = [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e300, 1e-300, f64::MIN];
    for value in odd {
        let point = ConvergencePoint {
            evaluations: 7,
            best: value,
            mean: Some(-value),
        };
        assert_draws(&Convergence {
            points: vec![point],
            ..convergence()
        });
        let mut points = convergence().points;
        points.push(ConvergencePoint {
            evaluations: u64::MAX,
            best: value,
            mean: None,
        });
        assert_draws(&Convergence {
            points,
            ..convergence()
        });
        let mut odd = sensitivity();
        odd.curves[0].optimum = (value, value);
        odd.curves[1].values = vec![(value, 1.0), (0.0, value)];
        assert_draws(&odd);
        let limit = JointLimit {
            lower: value,
            upper: 1.0,
        };
        let mut sample = sample(WorkspaceMap::Rings(rings()));
        sample.limits = ArtificialLimits::new(vec![limit, JointLimit::FREE]);
        sample.links = vec![value, 1.0];
        assert_draws(&LimitsFigure {
            limits: &sample.limits,
            is_planar: true,
        });
        assert_draws(&figure(&sample));
    }
}

#[test]
fn long_titles_are_cut() {
    let sample = sample(WorkspaceMap::Rings(rings()));
    let title = "a very long title ".repeat(30);
    let svg = figure_svg(&WorkspaceFigure {
        title,
        ..figure(&sample)
    })
    .unwrap();
    assert!(svg.contains('…') && !svg.contains(&"a very long title ".repeat(6)));
}
