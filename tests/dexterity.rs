//! Dexterity inside W_F against a scan of the pre-images of a planar arm in closed form.

use faultspace::angle::AngleSet;
use faultspace::design::{Geometry, Robot, TaskSpace};
use faultspace::workspace::hybrid::{
    Atlas, AtlasRecipe, AtlasSettings, Region, SamplePlan, Sampling,
};
use faultspace::workspace::planar::{PlanarArm, PlanarPosition};
use faultspace::workspace::{ArtificialLimits, FailureSet};
use nalgebra::{Complex, Isometry3, Matrix2, Vector2};
use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

const LENGTHS: [f64; 3] = [0.57, 1.44, 0.99];

fn robot() -> Robot {
    Robot {
        name: "planar".into(),
        source: None,
        geometry: Geometry::Planar {
            lengths: LENGTHS.to_vec(),
        },
        tool: Isometry3::identity(),
        physical_limits: None,
    }
}

fn recipe() -> AtlasRecipe {
    let plan = SamplePlan {
        task: TaskSpace::PlanarPosition,
        region: Region {
            radius: 3.0,
            lower: 0.0,
            upper: 0.0,
            reach: 3.0,
        },
        sampling: Sampling::Lattice {
            samples: 2000,
            replicates: 4,
        },
        seed: 2,
    };
    AtlasRecipe::new(&robot(), plan, AtlasSettings::default()).unwrap()
}

fn build(recipe: &AtlasRecipe) -> Atlas {
    let atlas = recipe.build(None, &AtomicBool::new(false), &|_, _| ());
    atlas.unwrap()
}

/// The least entry of the unit null vector and 1/cond at (θ₂, θ₃), from cross products and a
/// singular value decomposition.
fn measures(theta_2: f64, theta_3: f64) -> [f64; 2] {
    let [a, b, c] = LENGTHS;
    let at = |length: f64, angle: f64| Vector2::new(angle.cos(), angle.sin()) * length;
    let levers = [
        at(a, 0.0) + at(b, theta_2) + at(c, theta_2 + theta_3),
        at(b, theta_2) + at(c, theta_2 + theta_3),
        at(c, theta_2 + theta_3),
    ];
    let null = [(1, 2), (2, 0), (0, 1)].map(|(i, j): (usize, usize)| levers[i].perp(&levers[j]));
    let norm = null.iter().map(|n| n * n).sum::<f64>().sqrt();
    let least = null
        .iter()
        .fold(f64::INFINITY, |least, n| least.min(n.abs()));
    let gram: Matrix2<f64> = levers.iter().map(|l| l * l.transpose()).sum();
    let values = gram.svd(false, false).singular_values;
    [least / norm, (values.min() / values.max()).sqrt()]
}

/// All configurations of a fine scan of θ₃ that reach radius r: θ₁ at azimuth 0, θ₂, θ₃.
fn pre_image(r: f64) -> Vec<[f64; 3]> {
    let [a, b, c] = LENGTHS;
    let mut found = Vec::new();
    for k in 0..4000 {
        let theta_3 = TAU * k as f64 / 4000.0;
        let w = Complex::from(b) + Complex::from_polar(c, theta_3);
        let cosine = (r * r - a * a - w.norm_sqr()) / (2.0 * a * w.norm());
        if cosine.abs() <= 1.0 {
            for sign in [-1.0, 1.0] {
                let theta_2 = sign * cosine.acos() - w.arg();
                let z = Complex::from(a) + Complex::from_polar(1.0, theta_2) * w;
                found.push([-z.arg(), theta_2, theta_3]);
            }
        }
    }
    found
}

fn turns(set: &AngleSet) -> Vec<f64> {
    let all = (0..200).map(|k| TAU * (k as f64 + 0.5) / 200.0);
    all.filter(|turn| set.contains(*turn)).step_by(5).collect()
}

/// Means over W_F of the best measures.
fn scan(limits: &ArtificialLimits) -> [f64; 2] {
    let failures = FailureSet::any(3);
    let arm = PlanarArm {
        lengths: &LENGTHS,
        limits,
        failures: &failures,
    };
    let arcs: Vec<_> = limits.joints().iter().map(|limit| limit.arc()).collect();
    let (mut sums, mut total) = ([0.0; 2], 0.0);
    for k in 0..400 {
        let r = 3.0 * (k as f64 + 0.5) / 400.0;
        let set = PlanarPosition::new().rotation_set(arm, r);
        let turns = turns(&set);
        if turns.is_empty() {
            continue;
        }
        let inside = pre_image(r).into_iter();
        let inside = inside.filter(|q| arcs[1].contains(q[1]) && arcs[2].contains(q[2]));
        let inside: Vec<_> = inside.map(|q| (q[0], measures(q[1], q[2]))).collect();
        let weight = r * set.measure() / turns.len() as f64;
        for turn in turns {
            let own = inside
                .iter()
                .filter(|(first, _)| arcs[0].contains(first + turn));
            let best = own.fold([0.0f64; 2], |best, (_, m)| {
                [best[0].max(m[0]), best[1].max(m[1])]
            });
            sums = [sums[0] + weight * best[0], sums[1] + weight * best[1]];
            total += weight;
        }
    }
    sums.map(|sum| sum / total)
}

#[test]
fn agrees_with_a_scan_of_closed_forms() {
    let atlas = build(&recipe());
    let failures = FailureSet::any(3);
    for limits in [
        [[-180.0, 180.0], [-176.0, 168.0], [-120.0, -100.0]],
        [[-125.0, 125.0], [-176.0, 168.0], [-120.0, -100.0]],
    ] {
        let limits = ArtificialLimits::from_degrees(&limits);
        let found = atlas.dexterity(&robot(), &limits, &failures, 500).unwrap();
        assert!(found.poses > 100 && found.poses <= 500);
        let pairs = [found.null_component, found.inverse_condition];
        for (found, wanted) in pairs.into_iter().zip(scan(&limits)) {
            println!("{:.4} ± {:.4} for {wanted:.4}", found.value, found.error);
            let allowed = 3.0 * found.error + 0.005;
            assert!((found.value - wanted).abs() < allowed);
        }
    }
}

#[test]
fn there_is_none_without_configurations_or_tolerance() {
    let limits =
        ArtificialLimits::from_degrees(&[[-125.0, 125.0], [-176.0, 168.0], [-120.0, -100.0]]);
    let failures = FailureSet::any(3);
    let focused = build(&recipe().focused(&limits));
    assert_eq!(focused.dexterity(&robot(), &limits, &failures, 100), None);
    let free = ArtificialLimits::free(3);
    let atlas = build(&recipe());
    assert!(atlas.fault_tolerant_size(&free, &failures) == 0.0);
    assert_eq!(atlas.dexterity(&robot(), &free, &failures, 100), None);
}
