//! Time of one predicted S_F beside the exact one, on one thread.
//!
//! Compare the lines of one run with each other: absolute times depend on the machine.

use criterion::{Criterion, criterion_group, criterion_main};
use faultspace::objective::Design;
use faultspace::surrogate::{Card, Draw, Recipe, Region, Surrogate, SurrogateArm, card_path};
use std::hint::black_box;
use std::path::Path;

/// Half uniform limits, half threshold walks.
fn designs(arm: &SurrogateArm) -> Vec<Design> {
    let recipe = Recipe {
        seed: 5,
        draw: Draw::HeldOut,
        uniform_units: 4,
        walk_units: 4,
        cells: 0,
        region: Region::Gate,
    };
    let units = (0..recipe.units()).map(|unit| recipe.build_unit(arm, 0.1, unit));
    let designs = units.flat_map(|unit| {
        unit.designs()
            .iter()
            .map(|d| d.design())
            .collect::<Vec<_>>()
    });
    designs.collect()
}

fn sizes(c: &mut Criterion) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/planar_3r_equal");
    for name in ["size", "arcs", "mdn"] {
        let path = folder.join(format!("{name}.safetensors"));
        let card = Card::load(&card_path(&path)).expect("a shipped surrogate");
        let model = card.model(&path).expect("its weights");
        let designs = designs(model.arm());
        let count = if name == "size" { designs.len() } else { 16 };
        let few = &designs[..count];
        c.bench_function(&format!("{name}, {count} designs at once"), |b| {
            b.iter(|| model.sizes(black_box(few)))
        });
        c.bench_function(&format!("{name}, one design"), |b| {
            b.iter(|| model.sizes(black_box(&designs[..1])))
        });
        c.bench_function(&format!("exact, {count} designs"), |b| {
            b.iter(|| model.arm().sizes(black_box(few)))
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = sizes
}
criterion_main!(benches);
