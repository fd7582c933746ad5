//! Tests of whole figures and reports on made-up results.

use super::*;
use crate::angle::{AngleSet, Arc};
use crate::workspace::{
    ArtificialLimits, Estimate, FailureSet, JointLimit, Ring, RingMap, ShareMap, WorkspaceMap,
    WorkspaceSizes,
};
use resvg::tiny_skia::Pixmap;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::Path;

mod manifolds;
mod odd_input;
mod singular;
mod spatial;
mod surrogates;

const BOTH: [Format; 2] = [Format::Png, Format::Svg];

/// What figures borrow.
struct Sample {
    map: WorkspaceMap,
    limits: ArtificialLimits,
    links: Vec<f64>,
    sizes: WorkspaceSizes,
    failures: FailureSet,
}

fn rings() -> RingMap {
    let ring = |k: usize| {
        let inner = 1.0 + 0.1 * k as f64;
        let half = 1.0 - 0.05 * k as f64;
        let arcs = [
            Arc::from_interval(-half, half),
            Arc::from_interval(3.0, 3.0 + half),
        ];
        Ring {
            inner,
            outer: inner + 0.1,
            rotation_set: AngleSet::from_arcs(arcs),
        }
    };
    RingMap {
        unrestricted: [0.5, 3.0],
        rings: (0..11).map(ring).collect(),
    }
}

fn shares() -> ShareMap {
    ShareMap {
        unrestricted: [0.0, 3.0],
        radius_edges: vec![0.5, 1.0, 1.5, 2.0],
        angles: 8,
        share: (0..24).map(|k| k as f64 / 24.0).collect(),
    }
}

fn sizes(joints: usize, scale: f64) -> WorkspaceSizes {
    let size = |value: f64| Estimate {
        value: scale * value,
        error: 0.0123 * scale,
    };
    WorkspaceSizes {
        fault_tolerant: size(3.56234),
        pre_failure: size(20.0),
        post_failure: (1..=joints).map(|k| size(4.0 * k as f64)).collect(),
        unrestricted: size(28.0),
    }
}

fn sample(map: WorkspaceMap) -> Sample {
    Sample {
        map,
        limits: ArtificialLimits::from_degrees(&[[-18.0, 18.0], [-180.0, 180.0], [90.0, 90.0]]),
        links: vec![1.0; 3],
        sizes: sizes(3, 1.0),
        failures: FailureSet::of(3, &[1, 3]),
    }
}

fn convergence() -> Convergence {
    let point = |k: u64| ConvergencePoint {
        evaluations: 4 * k * k,
        best: k as f64,
        mean: Some(0.5 * k as f64),
    };
    Convergence {
        method: "genetic algorithm".into(),
        score_label: "S_F".into(),
        unit: "m^2".into(),
        points: (1..30).map(point).collect(),
        seconds: Some(2.0),
    }
}

fn sensitivity() -> Sensitivity {
    let curve = |joint, side| SensitivityCurve {
        joint,
        side,
        values: (-3..4)
            .map(|k| (0.1 * k as f64, 3.0 - 0.1 * (k * k) as f64))
            .collect(),
        optimum: (0.0, 3.0),
    };
    Sensitivity {
        score_label: "S_F".into(),
        mark: "optimum".into(),
        unit: "m^2".into(),
        curves: vec![
            curve(1, LimitSide::HalfWidth),
            curve(2, LimitSide::Lower),
            curve(2, LimitSide::Upper),
        ],
    }
}

fn figure(sample: &Sample) -> WorkspaceFigure<'_> {
    WorkspaceFigure {
        map: &sample.map,
        limits: &sample.limits,
        links: &sample.links,
        arm_angles: vec![0.2, 0.5, PI / 2.0],
        title: "three & links".into(),
    }
}

fn report(sample: &Sample) -> Report<'_> {
    Report {
        title: "<script>alert(1)</script>".into(),
        study: "test".into(),
        robot: "planar".into(),
        source: "made up".into(),
        task: "position in the plane".into(),
        failures_label: "joint 1 or 3".into(),
        status: "converged".into(),
        failures: &sample.failures,
        sizes: &sample.sizes,
        unit: "m^2".into(),
        limits: &sample.limits,
        links: &sample.links,
        workspace: Some(figure(sample)),
        figures: vec![],
        points: None,
        files: Vec::new(),
        convergence: Some(convergence()),
        sensitivity: Some(sensitivity()),
        result_json: serde_json::json!({ "schema": 1 }),
        study_toml: "kind = \"optimise\" # <b>\n".into(),
        provenance: vec![("seed".into(), "1".into())],
        notes: vec!["One pose failed.".into()],
    }
}

/// Width and height after a walk over all chunks up to the last.
fn png_size(bytes: &[u8]) -> (u32, u32) {
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    let (mut at, mut last) = (8, [0; 4]);
    while at < bytes.len() {
        last.copy_from_slice(&bytes[at + 4..at + 8]);
        at += 12 + number(at) as usize;
    }
    assert_eq!((at, &last), (bytes.len(), b"IEND"));
    (number(16), number(20))
}

/// Every tag is closed, in order; nothing in the document is not a number.
fn assert_well_formed(svg: &str) {
    let mut open = Vec::new();
    for tag in svg.split('<').skip(1) {
        let (tag, _) = tag.split_once('>').unwrap();
        let name = tag.split(' ').next().unwrap();
        match name.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop(), Some(name)),
            None if tag.ends_with('/') => {}
            None => open.push(name),
        }
    }
    assert!(open.is_empty());
    for part in svg.split("href=\"data:") {
        // The pixels of a picture may spell anything.
        let text = part.split_once("\"/>").map_or(part, |(_, text)| text);
        for word in ["NaN", "inf"] {
            let at = text.find(word);
            assert!(at.is_none(), "{:?}", at.map(|at| text[at..].lines().next()));
        }
    }
}

fn assert_draws(figure: &dyn Figure) {
    assert_well_formed(&figure_svg(figure).unwrap());
    let (width, height) = png_size(&figure_png(figure).unwrap());
    assert!((1..=3400).contains(&width) && (1..=8000).contains(&height));
    let table = figure.table();
    assert!(table.rows.iter().all(|row| row.len() == table.header.len()));
    assert!(!figure.caption().is_empty());
}

fn files(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let read = |entry: std::io::Result<std::fs::DirEntry>| {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        (name, std::fs::read(entry.path()).unwrap())
    };
    std::fs::read_dir(directory).unwrap().map(read).collect()
}

#[test]
fn figures_carry_their_labels() {
    let sample = sample(WorkspaceMap::Rings(rings()));
    let has = |figure: &dyn Figure, labels: &[&str]| {
        let svg = figure_svg(figure).unwrap();
        assert_well_formed(&svg);
        assert!(labels.iter().all(|label| svg.contains(label)), "{labels:?}");
    };
    has(
        &figure(&sample),
        &[
            "three &amp; links",
            "x (m)",
            "y (m)",
            "artificial joint limits",
        ],
    );
    has(
        &LimitsFigure {
            limits: &sample.limits,
            is_planar: true,
        },
        &["θ₁", "−18.0° … 18.0°", "free", "held"],
    );
    has(
        &convergence(),
        &["evaluations", "29 m²", "10³", "mean of the generation"],
    );
    has(
        &sensitivity(),
        &["artificial limit (deg)", "joint 2, θ₂", "upper limit"],
    );
    let sizes = SizesFigure {
        sizes: &sample.sizes,
        failures: &sample.failures,
        unit: "m^2",
    };
    has(&sizes, &["joint 3 locked W₃", "3.562 ± 0.012 m²"]);
}

#[test]
fn a_position_task_is_drawn_as_vectors_and_a_pose_task_as_one_picture() {
    let position = sample(WorkspaceMap::Rings(rings()));
    let svg = figure_svg(&figure(&position)).unwrap();
    assert!(
        !svg.contains("<image") && svg.len() < 100_000,
        "{}",
        svg.len()
    );
    let pose = sample(WorkspaceMap::Shares(shares()));
    let svg = figure_svg(&figure(&pose)).unwrap();
    // The map and the colour bar.
    assert_eq!(svg.matches("href=\"data:image/png;base64,").count(), 2);
    assert!(svg.len() < 500_000, "{}", svg.len());
    assert_eq!(png_size(&figure_png(&figure(&pose)).unwrap()).0, 1600);
}

#[test]
fn bitmaps_are_not_blank() {
    let sample = sample(WorkspaceMap::Shares(shares()));
    let png = figure_png(&figure(&sample)).unwrap();
    let picture = Pixmap::decode_png(&png).unwrap();
    let pixels = picture.data();
    let dark = pixels
        .chunks(4)
        .filter(|p| p[..3].iter().all(|c| *c < 128))
        .count();
    let coloured = pixels
        .chunks(4)
        .filter(|p| p[0].abs_diff(p[2]) > 20)
        .count();
    assert!(dark > 5_000 && coloured > 100_000, "{dark} {coloured}");
    assert_eq!(pixels[..4], [255; 4]);
    assert!(pixels.chunks(4).all(|p| p[3] == 255));
}

#[test]
fn pictures_reach_the_png_pixel_by_pixel() {
    let size = Size {
        width: 241.0,
        height: 50.0,
    };
    let stripes = |x: f64, _| match (x * 1600.0 / 241.0) as u32 % 2 {
        0 => [255, 0, 0],
        _ => [0, 0, 255],
    };
    let draw = |canvas: &mut Canvas| canvas.picture([10.1, 3.3], [100.0, 20.0], stripes);
    let picture = Pixmap::decode_png(&canvas::png(size, draw).unwrap()).unwrap();
    assert_eq!((picture.width(), picture.height()), (1600, 332));
    for (x, y) in [(67, 22), (100, 22), (101, 80), (400, 153), (729, 22)] {
        let pixel = picture.pixel(x, y).unwrap();
        let expected = [[255, 0, 0], [0, 0, 255]][x as usize % 2];
        assert_eq!(
            [pixel.red(), pixel.green(), pixel.blue()],
            expected,
            "{x} {y}"
        );
    }
    for (x, y) in [(66, 30), (731, 30), (100, 21), (100, 155)] {
        assert_eq!(picture.pixel(x, y).unwrap().green(), 255, "{x} {y}");
    }
}

#[test]
fn tables_have_a_row_per_item_and_units_in_the_header() {
    let sample_rings = sample(WorkspaceMap::Rings(rings()));
    let csv = figure(&sample_rings).table().to_csv().unwrap();
    assert!(csv.starts_with("radius_inner_m,radius_outer_m,beta_lower_deg,beta_upper_deg\n"));
    assert_eq!(csv.lines().count(), 1 + 2 * 11);
    let sample_shares = sample(WorkspaceMap::Shares(shares()));
    assert_eq!(figure(&sample_shares).table().rows.len(), 24);
    assert_eq!(
        convergence().table().header,
        ["evaluations", "best_m2", "mean_m2"]
    );
    assert_eq!(sensitivity().table().rows.len(), 3 * 8);
    let limits = LimitsFigure {
        limits: &sample_rings.limits,
        is_planar: true,
    }
    .table();
    assert_eq!(
        limits.header,
        ["joint", "lower_deg", "upper_deg", "width_deg"]
    );
    assert_eq!(limits.rows[2], ["3", "90", "90", "0"]);
}

#[test]
fn the_page_is_one_file_and_escapes_what_it_is_given() {
    let sample = sample(WorkspaceMap::Rings(rings()));
    let picture = InlineFigure {
        png: vec![1, 2, 3],
        caption: "a \"quoted\" caption".into(),
        is_wide: false,
    };
    let html = page(&report(&sample), &[picture]);
    assert!(!html.contains("<script") && html.contains("&lt;script&gt;alert(1)"));
    assert!(html.contains("# &lt;b&gt;"));
    assert!(html.contains("src=\"data:image/png;base64,AQID\""));
    assert!(html.contains("alt=\"a &quot;quoted&quot; caption\""));
    assert!(html.contains("(3.562 ± 0.012) m²"));
    assert!(html.contains("12.723 ± 0.050 %"));
    assert!(html.contains("−18.0000°") && html.contains("360° (free)"));
    assert!(html.contains("One pose failed."));
    assert!(!html.contains("http"));
}

#[test]
fn two_reports_are_byte_identical() {
    let sample = sample(WorkspaceMap::Rings(rings()));
    let directories = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let [first, second] = directories.each_ref().map(|directory| {
        let written = write_report(&report(&sample), directory.path(), &BOTH).unwrap();
        assert!(written.iter().all(|path| path.is_file()));
        assert_eq!(written.len(), 5 * 3 + 3);
        files(directory.path())
    });
    assert_eq!(first.len(), 18);
    assert_eq!(first, second);
}

#[test]
fn a_figure_is_written_in_the_formats_asked_for() {
    let directory = tempfile::tempdir().unwrap();
    write_figure(&convergence(), directory.path(), &[Format::Svg]).unwrap();
    let names: Vec<String> = files(directory.path()).into_keys().collect();
    assert_eq!(names, ["convergence.csv", "convergence.svg"]);
}
