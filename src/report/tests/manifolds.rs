//! Figures and files of self-motion manifolds.

use super::*;

fn curve(joints: usize) -> ManifoldCurve {
    let angle = |t: f64, joint: usize| match joint {
        0 => t,
        _ => 2.5 * (t + joint as f64).sin(),
    };
    let vertex = |k: usize| {
        let t = 0.1 * k as f64;
        (0..joints).map(|joint| angle(t, joint)).collect()
    };
    ManifoldCurve {
        points: (0..63).map(vertex).collect(),
        closed: true,
    }
}

fn ranges(joints: usize) -> Vec<AngleSet> {
    let arcs = [Arc::from_interval(-1.0, 0.5), Arc::from_interval(3.0, 3.5)];
    let mut ranges = vec![AngleSet::from_arcs(arcs); joints];
    ranges
        .iter_mut()
        .take(1)
        .for_each(|first| *first = AngleSet::full());
    ranges
}

fn figures<'a>(
    curves: &'a [ManifoldCurve],
    joint_ranges: &'a [AngleSet],
    limits: Option<&'a ArtificialLimits>,
    marks: (&'a [CriticalPoint], &'a [Vec<f64>]),
) -> (ManifoldFigure<'a>, ManifoldFigure3d<'a>) {
    let flat = ManifoldFigure {
        curves,
        joint_ranges,
        limits,
        critical_points: marks.0,
        crossings: marks.1,
        are_slices: false,
        title: "manifolds & more".into(),
    };
    let in_space = ManifoldFigure3d {
        curves,
        joint_count: joint_ranges.len(),
        joints: [1, 2, 3],
        limits,
        critical_points: marks.0,
        crossings: marks.1,
        title: String::new(),
    };
    (flat, in_space)
}

#[test]
fn every_joint_has_a_panel_and_the_limits_are_shown() {
    let (curves, ranges) = ([curve(7)], ranges(7));
    let limits = ArtificialLimits::from_degrees(&[[-60.0, 80.0]; 7]);
    let critical = [CriticalPoint {
        joint: 3,
        configuration: vec![0.1; 7],
    }];
    let crossings = [vec![0.2; 7]];
    let (flat, in_space) = figures(&curves, &ranges, Some(&limits), (&critical, &crossings));
    let svg = figure_svg(&flat).unwrap();
    assert_well_formed(&svg);
    for joint in 2..=7 {
        assert!(svg.contains(&format!("θ{} against θ₁", number::subscript(joint))));
    }
    for label in [
        "manifold 1",
        "artificial limits",
        "critical point",
        "&amp; more",
    ] {
        assert!(svg.contains(label), "{label}");
    }
    // Dots only where joint 3 is an axis: a rim and a disc, and one in the legend.
    assert_eq!(svg.matches("<circle").count(), 3);
    assert_draws(&in_space);
    assert!(figure_svg(&in_space).unwrap().contains("θ₃ (deg)"));
    let table = flat.table();
    assert_eq!(
        table.header[..4],
        ["kind", "number", "vertex", "theta_1_deg"]
    );
    assert_eq!((table.header.len(), table.rows.len()), (10, 65));
    assert_eq!(table.rows[0][..4], ["closed curve", "1", "1", "0"]);
    assert_eq!(table.rows[63][..3], ["critical point of joint", "3", ""]);
    assert_eq!(table.rows[64][0], "crossing");
    assert_eq!(table, in_space.table());
}

#[test]
fn odd_manifolds_are_drawn() {
    let odd = ManifoldCurve {
        points: vec![
            vec![f64::NAN; 3],
            vec![1e300, 0.0, 0.0],
            vec![0.0; 3],
            vec![1.0],
        ],
        closed: true,
    };
    let limit = |lower, upper| JointLimit { lower, upper };
    let odd_limits = ArtificialLimits::new(vec![
        limit(f64::NAN, 1.0),
        limit(f64::NEG_INFINITY, f64::INFINITY),
        limit(1.0, 1.0),
        JointLimit::FREE,
    ]);
    let wrong = [CriticalPoint {
        joint: 9,
        configuration: vec![0.0],
    }];
    let many = vec![curve(3); 9];
    let (none, full) = (AngleSet::empty(), AngleSet::full());
    for (curves, ranges) in [
        (vec![], vec![]),
        (vec![curve(1)], vec![full.clone()]),
        (
            vec![odd.clone(), curve(3)],
            vec![none, full.clone(), full.clone()],
        ),
        (many, vec![full; 3]),
    ] {
        for limits in [None, Some(&odd_limits)] {
            let (flat, in_space) = figures(&curves, &ranges, limits, (&wrong, &[]));
            assert_draws(&flat);
            assert_draws(&in_space);
        }
    }
}

#[test]
fn curves_are_written_as_polylines() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("manifolds.vtk");
    let short = ManifoldCurve {
        points: vec![vec![1.0]; 4],
        closed: false,
    };
    write_curves(&[curve(4), short, curve(4)], [1, 3, 4], &path).unwrap();
    let file = vtkio::Vtk::import_legacy_be(&path).unwrap();
    let vtkio::model::DataSet::PolyData { pieces, .. } = file.data else {
        panic!("no curves")
    };
    let piece = pieces[0].load_piece_data(None).unwrap();
    assert_eq!((piece.num_points(), piece.num_lines()), (126, 2));
    let places: Vec<f64> = piece.points.cast_into().unwrap();
    // The first curve ends at θ₁ = 6.2 rad, not wrapped.
    assert!((places[62 * 3] - 6.2f64.to_degrees()).abs() < 1e-9);
    write_curves(&[], [0, 1, 2], &path).unwrap();
}
