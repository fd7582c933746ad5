//! Time of one exact evaluation of S_F, the unit of work of every optimiser.
//!
//! Compare the lines of one run with each other: absolute times depend on the machine.

use criterion::{Criterion, criterion_group, criterion_main};
use faultspace::objective::{DesignSpace, Objective, PlanarObjective, PlanarTask};
use faultspace::sampling;
use faultspace::workspace::planar::{PlanarArm, PlanarPose, PlanarPosition, PoseResolution};
use faultspace::workspace::{ArtificialLimits, FailureSet};
use rayon::prelude::*;
use std::hint::black_box;

fn position(c: &mut Criterion) {
    let optimum = |n: usize, first: f64, rest: f64| {
        let mut pairs = vec![[-rest, rest]; n];
        pairs[0] = [-first, first];
        ArtificialLimits::from_degrees(&pairs)
    };
    let cases = [
        ("3R optimum", 3, optimum(3, 18.21, 111.322)),
        (
            "3R asymmetric",
            3,
            ArtificialLimits::from_degrees(&[[-20.0, 35.0], [-80.0, 120.0], [-140.0, 95.0]]),
        ),
        ("4R optimum", 4, optimum(4, 6.609, 109.995)),
        (
            "4R asymmetric",
            4,
            ArtificialLimits::from_degrees(&[
                [-20.0, 35.0],
                [-80.0, 120.0],
                [-100.0, 95.0],
                [-70.0, 115.0],
            ]),
        ),
        ("5R optimum", 5, optimum(5, 6.0, 110.0)),
    ];
    for (name, n, limits) in &cases {
        let lengths = vec![1.0; *n];
        let failures = FailureSet::any(*n);
        let arm = PlanarArm {
            lengths: &lengths,
            limits,
            failures: &failures,
        };
        let mut estimator = PlanarPosition::new();
        c.bench_function(&format!("planar position {name}"), |b| {
            b.iter(|| estimator.fault_tolerant_size(black_box(arm)))
        });
    }
}

/// The evaluations of one generation of the genetic algorithm, on all cores.
fn generation(c: &mut Criterion) {
    let space = DesignSpace::new(&[1.0, 1.0, 1.0], 0.0, false, None);
    let objective = PlanarObjective::new(space, PlanarTask::Position, FailureSet::any(3), false);
    let mut generator = sampling::stream(1, 0);
    let candidates: Vec<Vec<f64>> = (0..100)
        .map(|_| objective.space().random(&mut generator))
        .collect();
    c.bench_function("planar position 3R, generation of 100", |b| {
        b.iter(|| -> Vec<f64> {
            let scores = candidates.par_iter().map(|x| objective.score(x));
            scores.collect()
        })
    });
}

fn pose(c: &mut Criterion) {
    let cases = [
        (
            "4R asymmetric",
            vec![[-60.0, 75.0], [20.0, 140.0], [10.0, 150.0], [-120.0, 90.0]],
        ),
        (
            "5R published",
            vec![
                [-111.0, 111.0],
                [-150.0, 25.0],
                [-150.0, 25.0],
                [-150.0, 150.0],
                [130.0, 275.0],
            ],
        ),
    ];
    for (name, pairs) in cases {
        let limits = ArtificialLimits::from_degrees(&pairs);
        let lengths = vec![1.0; pairs.len()];
        let failures = FailureSet::any(pairs.len());
        let arm = PlanarArm {
            lengths: &lengths,
            limits: &limits,
            failures: &failures,
        };
        for (label, resolution) in [
            ("coarse", PoseResolution::coarse()),
            ("default", PoseResolution::default()),
        ] {
            let mut estimator = PlanarPose::new(resolution);
            c.bench_function(&format!("planar pose {name}, {label}"), |b| {
                b.iter(|| estimator.fault_tolerant_size(black_box(arm)))
            });
        }
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).measurement_time(std::time::Duration::from_secs(2));
    targets = position, generation, pose
}
criterion_main!(benches);
