//! The hybrid estimator on the 7R arm of [S4]: building an atlas, one S_F, all widths of a limit.
//!
//! Compare ratios within one run: machines differ, and are noisy.

use criterion::{Criterion, criterion_group, criterion_main};
use faultspace::design::{Robot, TaskSpace, read_design};
use faultspace::kinematics::workspace_extent;
use faultspace::objective::{DesignSpace, HybridObjective};
use faultspace::optimiser::{
    Control, CoordinateAscent, CoordinateAscentSettings, Search, run_search,
};
use faultspace::workspace::hybrid::{
    Atlas, AtlasRecipe, AtlasSettings, Growth, Region, Rule, SamplePlan, Sampling,
};
use faultspace::workspace::{ArtificialLimits, FailureSet};
use std::f64::consts::TAU;
use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

fn robot() -> Robot {
    let design = concat!(env!("CARGO_MANIFEST_DIR"), "/designs/spatial_7r.toml");
    read_design(Path::new(design)).expect("a shipped robot")
}

fn recipe(robot: &Robot, samples: u32) -> AtlasRecipe {
    let extent = workspace_extent(robot).expect("revolute joints");
    let plan = SamplePlan {
        task: TaskSpace::SpatialPose,
        region: Region {
            radius: extent.radius,
            lower: extent.lower,
            upper: extent.upper,
            reach: extent.reach,
        },
        sampling: Sampling::Lattice {
            samples,
            replicates: 16,
        },
        seed: 1,
    };
    AtlasRecipe::new(robot, plan, AtlasSettings::default()).expect("one degree of redundancy")
}

fn build(recipe: &AtlasRecipe) -> Atlas {
    let never = AtomicBool::new(false);
    recipe.build(None, &never, &|_, _| ()).expect("an atlas")
}

/// The first stage of an `optimise` study, from fewer starts.
fn search(robot: &Robot, atlas: &Atlas) -> f64 {
    let space = DesignSpace::of_robot(robot, TaskSpace::SpatialPose, 0.0);
    let any = FailureSet::any(7);
    let objective = HybridObjective::new(space, atlas, any, Rule::Definition);
    let settings = CoordinateAscentSettings {
        restarts: 2,
        finalists: 1,
        max_sweeps: 3,
        ..CoordinateAscentSettings::default()
    };
    let solver = CoordinateAscent::new(settings, 1, Vec::new());
    let control = Control {
        interrupt: Arc::new(AtomicBool::new(false)),
        on_progress: Arc::new(|_, _| ()),
        on_snapshot: Arc::new(|_: &CoordinateAscent, _| Ok(())),
    };
    let (ended, _) = run_search(&objective, solver, None, control).expect("a search");
    ended.solver.candidates()[0].score
}

fn hybrid(criterion: &mut Criterion) {
    let robot = robot();
    let mut group = criterion.benchmark_group("hybrid 7R");
    group.sample_size(10);
    let small = recipe(&robot, 2048);
    group.bench_function("atlas of 2048 samples", |b| b.iter(|| build(&small)));
    let atlas = build(&recipe(&robot, 50_000));
    let limits = ArtificialLimits::from_degrees(&[
        [-74.0, 74.0],
        [-180.0, 180.0],
        [-180.0, 180.0],
        [-113.0, 86.0],
        [-165.0, 146.0],
        [-64.0, 98.0],
        [-180.0, 180.0],
    ]);
    let any = FailureSet::any(7);
    group.bench_function("S_F over 50000 samples", |b| {
        b.iter(|| atlas.fault_tolerant_size(black_box(&limits), &any));
    });
    group.bench_function("all sizes over 50000 samples", |b| {
        b.iter(|| atlas.sizes(black_box(&limits), &any, Rule::Definition));
    });
    group.bench_function("a sixteenth of 50000 samples copied", |b| {
        b.iter(|| atlas.thinned(16));
    });
    let part = atlas.thinned(16);
    group.bench_function("S_F over a sixteenth of 50000 samples", |b| {
        b.iter(|| part.fault_tolerant_size(black_box(&limits), &any));
    });
    group.bench_function("search from 2 starts on a sixteenth", |b| {
        b.iter(|| search(&robot, &part));
    });
    let widths: Vec<f64> = (0..=72).map(|k| f64::from(k) * TAU / 72.0).collect();
    group.bench_function("S_F for 73 widths of joint 4", |b| {
        b.iter(|| atlas.profile(black_box(&limits), &any, 3, Growth::Upper, &widths));
    });
    group.finish();
}

criterion_group!(benches, hybrid);
criterion_main!(benches);
