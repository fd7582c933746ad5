//! Figures, points and reports of spatial tasks.

use super::*;
use crate::workspace::SpatialShareMap;

/// A ring of fault-tolerant cells that does not close, within a torus.
pub(super) fn map(orientations: bool) -> SpatialShareMap {
    let mut map = SpatialShareMap {
        radius_edges: (0..=6).map(|k| 0.1 * f64::from(k)).collect(),
        height_edges: (0..=5).map(|k| -0.2 + 0.2 * f64::from(k)).collect(),
        azimuths: 8,
        orientations,
        ..SpatialShareMap::default()
    };
    for ir in 0..map.radii() {
        for iz in 0..map.heights() {
            let is_reachable = (1..5).contains(&ir) && (1..4).contains(&iz);
            map.unrestricted.push(if is_reachable { 0.75 } else { 0.0 });
            for k in 0..8 {
                let is_tolerant = ir == 3 && iz == 2 && k > 0;
                map.share
                    .push(if is_tolerant { k as f32 / 16.0 } else { 0.0 });
            }
        }
    }
    map
}

fn figure(map: &SpatialShareMap) -> SpatialWorkspaceFigure<'_> {
    SpatialWorkspaceFigure {
        map,
        title: "torus".into(),
    }
}

fn half_plane(map: &SpatialShareMap) -> HalfPlaneFigure<'_> {
    HalfPlaneFigure {
        map,
        title: "torus".into(),
    }
}

#[test]
fn sections_carry_their_labels_and_the_height_of_the_fullest() {
    let map = map(true);
    assert_eq!(map.check(), Ok(()));
    let svg = figure_svg(&figure(&map)).unwrap();
    assert_well_formed(&svg);
    for label in [
        "x–y section, z = 0.30 m",
        "z (m)",
        "fault-tolerant orientations (%)",
    ] {
        assert!(svg.contains(label), "{label}");
    }
    // Four panels and a bar; the scale ends at the next round number above 7/16.
    assert_eq!(svg.matches("<image").count(), 5);
    assert!(svg.contains("50\n") && !svg.contains("100\n"));
    let svg = figure_svg(&half_plane(&map)).unwrap();
    assert_well_formed(&svg);
    assert!(svg.contains("r (m)") && svg.contains("reachable orientations (%)"));
    let positions = super::spatial::map(false);
    let svg = figure_svg(&half_plane(&positions)).unwrap();
    assert!(!svg.contains("orientations"));
    assert!(!figure(&positions).caption().contains("orientations"));
}

#[test]
fn tables_hold_the_cells_of_the_sections() {
    let map = map(true);
    let csv = figure(&map).table().to_csv().unwrap();
    assert!(csv.starts_with("section,x_m,y_m,z_m,share,unrestricted\n"));
    let rows = |section: &str| csv.lines().filter(|line| line.starts_with(section)).count();
    // 4 reachable radii of 8 azimuths; 4 by 3 cells on either side of the axis.
    assert_eq!([rows("xy"), rows("xz"), rows("yz")], [32, 24, 24]);
    // Azimuth 0 is in cell 4, −180° in cell 0, 90° in cell 6.
    let has = |start: &str, share: f64| {
        let line = csv.lines().find(|line| line.starts_with(start)).unwrap();
        assert!(line.ends_with(&format!(",{share},0.75")), "{line}");
    };
    has("xz,0.35,0,0.3", 0.25);
    has("xz,-0.35,0,0.3", 0.0);
    has("yz,0,0.35,0.3", 0.375);
    let half = half_plane(&map).table();
    assert_eq!(half.header[4..], ["share_mean", "unrestricted"]);
    assert_eq!(half.rows.len(), 12);
    let means: f64 = half
        .rows
        .iter()
        .map(|row| row[4].parse::<f64>().unwrap())
        .sum();
    assert!((means - 28.0 / 16.0 / 8.0).abs() < 1e-12);
}

#[test]
fn odd_maps_are_drawn() {
    let one = SpatialShareMap {
        radius_edges: vec![0.0, 1e-3],
        height_edges: vec![5.0, 9.0],
        azimuths: 1,
        share: vec![f32::NAN],
        unrestricted: vec![1.0],
        orientations: true,
    };
    let mut unreachable = map(true);
    unreachable.unrestricted.clear();
    let mut endless = map(false);
    endless.height_edges[5] = f64::INFINITY;
    for map in [SpatialShareMap::default(), one, unreachable, endless] {
        let svg = figure_svg(&figure(&map)).unwrap();
        assert_well_formed(&svg);
        assert_well_formed(&figure_svg(&half_plane(&map)).unwrap());
        let is_empty = !map.share.iter().any(|share| *share > 0.0);
        assert_eq!(svg.contains("is empty"), is_empty);
        let tables = [figure(&map).table(), half_plane(&map).table()];
        for table in tables {
            assert!(table.rows.iter().all(|row| row.len() == table.header.len()));
        }
    }
}

#[test]
fn points_are_read_back() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("points.vtk");
    write_points(&map(true), &path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("# vtk DataFile Version 3.0\n") && text.contains("POINTS 7 double"));
    assert_eq!(text.matches("SCALARS").count(), 2);
    let file = vtkio::Vtk::parse_legacy_be(text.as_bytes()).unwrap();
    let vtkio::model::DataSet::PolyData { pieces, .. } = file.data else {
        panic!("no points")
    };
    let piece = pieces[0].load_piece_data(None).unwrap();
    assert_eq!((piece.num_points(), piece.num_verts()), (7, 7));
    let places: Vec<f64> = piece.points.cast_into().unwrap();
    for place in places.chunks(3) {
        assert!((place[0].hypot(place[1]) - 0.35).abs() < 1e-8 && place[2] == 0.3);
    }
    let shares = match &piece.data.point[0] {
        vtkio::model::Attribute::DataArray(array) => array.data.cast_into::<f32>().unwrap(),
        other => panic!("{other:?}"),
    };
    assert_eq!(
        shares,
        (1..8u8).map(|k| f32::from(k) / 16.0).collect::<Vec<_>>()
    );
    write_points(&SpatialShareMap::default(), &path).unwrap();
    assert!(std::fs::read_to_string(&path).unwrap().contains("POINTS 0"));
    assert!(write_points(&map(true), directory.path()).is_err());
}

#[test]
fn a_report_needs_no_planar_workspace() {
    let map = map(true);
    let sample = sample(WorkspaceMap::Rings(rings()));
    let mut sizes = sizes(7, 1.0);
    sizes.post_failure[4].value = f64::NAN;
    let half_plane = half_plane(&map);
    let report = Report {
        sizes: &sizes,
        unit: "m^3".into(),
        links: &[],
        workspace: None,
        figures: vec![&half_plane],
        points: Some(&map),
        sensitivity: None,
        ..report(&sample)
    };
    let directory = tempfile::tempdir().unwrap();
    let written = write_report(&report, directory.path(), &[Format::Svg]).unwrap();
    let files = files(directory.path());
    assert_eq!(written.len(), files.len());
    let names: Vec<&str> = files.keys().map(String::as_str).collect();
    let expected = [
        "convergence.csv",
        "convergence.svg",
        "half_plane.csv",
        "half_plane.svg",
        "limits.csv",
        "limits.svg",
        "points.vtk",
        "report.html",
        "result.json",
        "study.toml",
    ];
    assert_eq!(names, expected);
    let html = String::from_utf8_lossy(&files["report.html"]);
    assert!(html.contains("(3.562 ± 0.012) m³") && html.contains("<code>points.vtk</code>"));
    assert!(html.contains("not known") && html.contains("flex-basis:100%;max-width:none"));
    assert!(html.contains("Angles are the joint variables"));
}
