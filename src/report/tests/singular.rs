//! Figures about singular configurations draw whatever they are given.

use crate::angle::{AngleSet, Arc};
use crate::report::{
    ArmPose, ArmPosesFigure, DistributionFigure, Figure, GoalLocks, JointRangesFigure, LockMark,
    LocksFigure, ManifoldCurve, ParetoFigure, ParetoPoint, ProjectionsFigure, SingularPoint,
    SingularityFigure, SizeSample, SplitFigure, SplitPanel, figure_svg,
};
use nalgebra::{Isometry3, Vector3};
use std::f64::consts::PI;

fn assert_draws(figure: &dyn Figure) {
    let svg = figure_svg(figure).expect("a drawing");
    assert!(svg.contains("</svg>") && !svg.contains("NaN"));
    assert!(!figure.caption().is_empty());
    let table = figure.table();
    assert!(table.rows.iter().all(|row| row.len() == table.header.len()));
    table.to_csv().expect("a table");
}

fn curve(points: &[[f64; 3]]) -> ManifoldCurve {
    ManifoldCurve {
        points: points.iter().map(|p| p.to_vec()).collect(),
        closed: true,
    }
}

#[test]
fn projections_and_splits() {
    let wild = curve(&[
        [0.0; 3],
        [f64::NAN, 0.0, 0.0],
        [9.0, -9.0, 1e300],
        [1.0, 2.0, 3.0],
    ]);
    let fine = curve(&[[0.0; 3], [3.0, 0.2, 0.3], [6.3, 0.0, 0.0]]);
    for curves in [vec![], vec![wild.clone()], vec![fine.clone(), wild.clone()]] {
        for colour in [1, 3, 7] {
            let figure = ProjectionsFigure {
                curves: &curves,
                nodes: &[(vec![PI, 0.0, -PI], 1), (vec![f64::NAN; 3], 2), (vec![], 9)],
                joint_count: 3,
                rank: 2,
                panels: vec![[1, 2, 3], [1, 2, 9]],
                colour,
                title: "t".into(),
            };
            assert_draws(&figure);
        }
        let panel = |title: &str| SplitPanel {
            title: title.into(),
            curves: curves.clone(),
            size: f64::NAN,
        };
        let split = SplitFigure {
            panels: vec![panel("a"), panel("b"), panel("c")],
            node: vec![f64::INFINITY, 0.0, 0.0],
            joints: [1, 3],
            joint_count: 3,
            title: String::new(),
        };
        assert_draws(&split);
    }
}

#[test]
fn singular_points_and_ranges() {
    let point = |angle: f64, loss: usize| SingularPoint {
        configuration: vec![angle, 0.5],
        loss,
        sigma: vec![1.0, 0.0],
        hits: 1,
        family: 1,
    };
    for points in [
        vec![],
        vec![point(f64::NAN, 1), point(7.0, 2), point(0.0, 9)],
    ] {
        let figure = SingularityFigure {
            points: &points,
            joint_count: 2,
            rank: 2,
            title: "a_b".into(),
        };
        assert_draws(&figure);
    }
    let ranges = [
        AngleSet::empty(),
        AngleSet::full(),
        AngleSet::from(Arc::point(3.0)),
    ];
    assert_draws(&JointRangesFigure {
        ranges: &ranges,
        title: "t".into(),
    });
}

#[test]
fn distributions_and_fronts() {
    let sample = |sizes: &[f64]| SizeSample {
        name: vec!["a".into(), "b".into()],
        sizes: sizes.to_vec(),
    };
    let all = [
        vec![],
        vec![sample(&[]), sample(&[f64::NAN]), sample(&[3.0])],
        vec![sample(&[1.0, 1.0]), sample(&[0.0, 9.0, 4.0])],
    ];
    for samples in all {
        assert_draws(&DistributionFigure {
            samples,
            extremes: [9.0, 0.0],
            title: "t".into(),
        });
    }
    let point = |size: f64, measure: f64| ParetoPoint {
        size,
        measures: [measure; 3],
        origin: "random".into(),
    };
    for points in [
        vec![],
        vec![
            point(1.0, f64::INFINITY),
            point(f64::NAN, 2.0),
            point(2.0, 0.0),
        ],
    ] {
        assert_draws(&ParetoFigure {
            fronts: [points.clone(), vec![], points.clone()],
            points,
            title: "t".into(),
        });
    }
}

#[test]
fn arms_and_locks() {
    let pose = |x: f64| ArmPose {
        name: "n".into(),
        corners: vec![Vector3::zeros(), Vector3::new(x, 0.0, 1.0)],
        places: Vec::new(),
        tool: Isometry3::translation(x, 0.0, 1.0),
    };
    for poses in [
        vec![],
        vec![pose(0.0)],
        vec![pose(f64::NAN), pose(1.0), pose(2.0)],
    ] {
        assert_draws(&ArmPosesFigure {
            name: "arm",
            poses,
            caption: "c".into(),
            title: "t".into(),
        });
    }
    let lock = |share: f64, is_reached: bool| LockMark {
        joint: 2,
        share,
        angle: f64::NAN,
        is_reached,
        position_error: 0.1,
        orientation_error: 0.0,
    };
    let goal = |locks: Vec<LockMark>| GoalLocks {
        name: "goal_1".into(),
        locks,
    };
    for goals in [
        vec![],
        vec![goal(vec![]), goal(vec![lock(0.0, true), lock(1.0, false)])],
    ] {
        assert_draws(&LocksFigure {
            goals,
            title: "t".into(),
        });
    }
}
