//! Time and size of an atlas against the number of samples, for the 7R arm: one row a size, and a
//! figure in log-log axes if a file name (`.svg`) is given.
//!
//! `cargo run --release --example atlas_cost -- docs/atlas_cost.svg`

use anyhow::{Context, Result};
use faultspace::design::{TaskSpace, read_design};
use faultspace::kinematics::workspace_extent;
use faultspace::workspace::hybrid::{AtlasRecipe, AtlasSettings, Region, SamplePlan, Sampling};
use plotters::prelude::*;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Numbers of samples, over two decades.
const SAMPLES: [u32; 5] = [1_600, 5_120, 16_000, 51_200, 160_000];

fn main() -> Result<()> {
    let design = concat!(env!("CARGO_MANIFEST_DIR"), "/designs/spatial_7r.toml");
    let robot = read_design(Path::new(design))?;
    let extent = workspace_extent(&robot).context("an arm of revolute joints has an extent")?;
    let region = Region {
        radius: extent.radius,
        lower: extent.lower,
        upper: extent.upper,
        reach: extent.reach,
    };
    let mut rows = Vec::new();
    println!("samples  reachable  seconds  megabytes");
    for samples in SAMPLES {
        let plan = SamplePlan {
            task: TaskSpace::SpatialPose,
            region,
            sampling: Sampling::Lattice {
                samples,
                replicates: 16,
            },
            seed: 1,
        };
        let recipe = AtlasRecipe::new(&robot, plan, AtlasSettings::default())?;
        let started = Instant::now();
        let atlas = recipe.build(None, &AtomicBool::new(false), &|_, _| ())?;
        let seconds = started.elapsed().as_secs_f64();
        let megabytes = atlas.bytes() as f64 / 1e6;
        let reachable = atlas.counts().reachable;
        println!("{samples:>7}  {reachable:>9}  {seconds:>7.2}  {megabytes:>9.1}");
        rows.push((f64::from(samples), seconds, megabytes));
    }
    match std::env::args().nth(1) {
        Some(path) => draw(&rows, &path),
        None => Ok(()),
    }
}

fn draw(rows: &[(f64, f64, f64)], path: &str) -> Result<()> {
    let root = SVGBackend::new(path, (640, 420)).into_drawing_area();
    root.fill(&WHITE)?;
    let (x, y) = ((1e3..3e5).log_scale(), (0.05..400.0).log_scale());
    let mut chart = ChartBuilder::on(&root)
        .margin(14)
        .x_label_area_size(46)
        .y_label_area_size(60)
        .build_cartesian_2d(x, y)?;
    let font = ("sans-serif", 15);
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("samples (cells × orientations)")
        .y_desc("time (s), size (MB)")
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y}"))
        .label_style(font)
        .axis_desc_style(("sans-serif", 16))
        .draw()?;
    let series = [
        (
            "time, two threads",
            RGBColor(33, 102, 172),
            rows.iter().map(|r| (r.0, r.1)).collect(),
        ),
        (
            "size",
            RGBColor(178, 90, 20),
            rows.iter().map(|r| (r.0, r.2)).collect::<Vec<_>>(),
        ),
    ];
    for (label, colour, points) in series {
        let last = points[points.len() - 1];
        let slope = move |x: f64| (x, last.1 * x / last.0);
        let ideal = [slope(points[0].0), last];
        let line = PathElement::new(ideal.to_vec(), colour.mix(0.4));
        chart.draw_series(std::iter::once(line))?;
        chart
            .draw_series(points.iter().map(|&p| Circle::new(p, 4, colour.filled())))?
            .label(label)
            .legend(move |(x, y)| Circle::new((x + 10, y), 4, colour.filled()));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE)
        .border_style(TRANSPARENT)
        .label_font(font)
        .draw()?;
    root.present()?;
    Ok(())
}
