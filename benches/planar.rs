//! Time of one exact evaluation of S_F, the unit of work of every optimiser.
//!
//! Compare the lines of one run with each other: absolute times depend on the machine.

use criterion::{Criterion, criterion_group, criterion_main};
use faultspace::workspace::planar::{PlanarArm, PlanarPosition};
use faultspace::workspace::{ArtificialLimits, FailureSet};
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

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).measurement_time(std::time::Duration::from_secs(2));
    targets = position
}
criterion_main!(benches);
