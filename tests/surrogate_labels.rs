//! What surrogates learn from: the labels against the exact estimator, the draws, the split.

use faultspace::surrogate::{
    Dataset, Draw, Origin, Quadrature, Recipe, Region, Surrogate, SurrogateArm, UNIT, data_hash,
};
use faultspace::workspace::planar::{PlanarArm, PlanarPosition};
use faultspace::workspace::{ArtificialLimits, FailureSet, JointLimit};

fn arm(lengths: &[f64], pose: bool) -> SurrogateArm {
    SurrogateArm {
        lengths: lengths.to_vec(),
        link_bounds: None,
        pose,
        failures: FailureSet::any(lengths.len()),
    }
}

fn recipe(draw: Draw) -> Recipe {
    Recipe {
        seed: 2,
        draw,
        uniform_units: 1,
        walk_units: 1,
        cells: 6,
        region: Region::Gate,
    }
}

/// W₀ ∩ W₁ ∩ … ∩ W_n put together from the labels' parts is the rotation set of the estimator.
#[test]
fn sets_of_positions_are_the_estimators() {
    let arm = arm(&[1.0, 0.8, 1.1, 0.4], false);
    let data = recipe(Draw::Training).build_unit(&arm, 0.1, 0);
    let mut estimator = PlanarPosition::new();
    for (k, labelled) in data.designs().iter().enumerate() {
        let design = labelled.design();
        let exact = PlanarArm {
            lengths: &arm.lengths,
            limits: &design.limits,
            failures: &arm.failures,
        };
        assert_eq!(labelled.size, estimator.fault_tolerant_size(exact));
        let locked = arm.locked_joints(&design);
        for cell in data.cells_of(k) {
            let place = data.cells()[cell];
            let post = arm.post_failure_set(&locked, &place);
            let set = data.pre_failure_set(cell).intersection(&post);
            let truth = estimator.rotation_set(exact, place.radius);
            let off = set.measure() + truth.measure() - 2.0 * set.overlap(&truth);
            // Labels are stored in single precision.
            assert!(off < 1e-5, "{off}");
        }
    }
}

/// Summed over the quadrature's nodes, the sets of a pose task have the volume of the estimator.
#[test]
fn sets_of_poses_sum_to_the_volume() {
    let arm = arm(&[1.0, 1.0, 1.0, 1.0], true);
    let quarter = JointLimit::new(0.5 * std::f64::consts::PI, 2.4);
    let limits = ArtificialLimits::new(vec![
        JointLimit::around(0.0, 1.2),
        quarter,
        quarter,
        JointLimit::around(0.0, 1.6),
    ]);
    let design = arm.design(limits);
    let locked = arm.locked_joints(&design);
    let rule = Quadrature::inside_gate(&arm, &locked, 150, 240);
    let volume = rule.sum(&arm.fault_tolerant_sets(&design, &rule.cells));
    let size = arm.size(&design);
    assert!(size > 0.5, "{size}");
    assert!((volume - size).abs() < 0.01 * size, "{volume} {size}");
}

#[test]
fn walks_have_large_workspaces_and_uniform_limits_have_not() {
    let arm = arm(&[1.0; 3], false);
    let build = |unit| recipe(Draw::Training).build_unit(&arm, 0.126, unit);
    let (uniform, walks) = (build(0), build(1));
    assert_eq!(
        (uniform.designs().len(), walks.designs().len()),
        (UNIT, UNIT)
    );
    let mean = |data: &Dataset| {
        let sizes = data.designs().iter().map(|design| design.size);
        sizes.sum::<f64>() / UNIT as f64
    };
    assert!(mean(&walks) > 3.0 * mean(&uniform));
    assert!(
        walks
            .designs()
            .iter()
            .all(|d| d.size > 0.0 && d.origin == Origin::Walk)
    );
    assert!(
        uniform
            .designs()
            .iter()
            .all(|d| d.origin == Origin::Uniform)
    );
    assert!(uniform.is_consistent(3) && walks.is_consistent(3));
    // Again the same, and nothing in common with what is held out.
    assert_eq!(build(1), walks);
    let held_out = recipe(Draw::HeldOut).build_unit(&arm, 0.126, 1);
    let other = |a: &f64| held_out.designs().iter().all(|design| design.size != *a);
    assert!(walks.designs().iter().all(|design| other(&design.size)));
}

#[test]
fn link_lengths_keep_their_sum_and_bounds() {
    let arm = SurrogateArm {
        link_bounds: Some(vec![[0.3, 2.0]; 3]),
        ..arm(&[1.0; 3], false)
    };
    let data = recipe(Draw::Training).build_unit(&arm, 0.3, 0);
    let mut first = Vec::new();
    for labelled in data.designs() {
        let lengths = labelled.design().lengths;
        assert!((lengths.iter().sum::<f64>() - 3.0).abs() < 1e-12);
        assert!(lengths.iter().all(|l| (0.3..=2.0).contains(l)));
        first.push(lengths[0]);
    }
    let spread = first
        .iter()
        .fold(0.0_f64, |m, l| m.max((l - first[0]).abs()));
    assert!(spread > 0.5);
}

/// The mirror image of limits has the mirrored sets: what augmentation rests on.
#[test]
fn mirrored_limits_have_mirrored_sets() {
    for (lengths, pose) in [(vec![1.0, 0.7, 1.2], false), (vec![1.0; 4], true)] {
        let arm = arm(&lengths, pose);
        let data = recipe(Draw::Training).build_unit(&arm, 0.1, 1);
        for labelled in data.designs().iter().take(4) {
            let design = labelled.design();
            let joints = design.limits.joints().iter();
            let mirrored = joints
                .map(|l| JointLimit::new(-l.upper, -l.lower))
                .collect();
            let mirrored = arm.design(ArtificialLimits::new(mirrored));
            let sizes = arm.sizes(&[design.clone(), mirrored.clone()]);
            assert!(
                (sizes[0] - sizes[1]).abs() < 2e-3 * (1.0 + sizes[0]),
                "{sizes:?}"
            );
            let locked = arm.locked_joints(&design);
            let rule = Quadrature::inside_gate(&arm, &locked, 5, 5);
            let mut cells = rule.cells.clone();
            cells
                .iter_mut()
                .for_each(|cell| cell.bearing = -cell.bearing);
            let sets = arm.fault_tolerant_sets(&design, &rule.cells);
            let images = arm.fault_tolerant_sets(&mirrored, &cells);
            for (set, image) in sets.iter().zip(&images) {
                let image = image.mirrored();
                let off = set.measure() + image.measure() - 2.0 * set.overlap(&image);
                assert!(off < 1e-6, "{off}");
            }
        }
    }
}

#[test]
fn the_hash_tells_data_apart() {
    let three = arm(&[1.0; 3], false);
    let base = data_hash(&three, &recipe(Draw::Training));
    let others = [
        data_hash(&arm(&[1.0, 1.0, 1.1], false), &recipe(Draw::Training)),
        data_hash(&three, &recipe(Draw::HeldOut)),
        data_hash(
            &three,
            &Recipe {
                seed: 3,
                ..recipe(Draw::Training)
            },
        ),
        data_hash(
            &three,
            &Recipe {
                cells: 7,
                ..recipe(Draw::Training)
            },
        ),
    ];
    assert!(others.iter().all(|other| *other != base));
    assert_eq!(base, data_hash(&three, &recipe(Draw::Training)));
}
