use super::*;
use crate::design::{Geometry, Robot, TaskSpace};
use crate::workspace::JointLimit;
use crate::workspace::hybrid::{AtlasRecipe, AtlasSettings, Region, SamplePlan, Sampling};
use std::sync::atomic::AtomicBool;

fn atlas() -> Atlas {
    atlas_of(vec![1.0, 1.0, 1.0], 400)
}

fn atlas_of(lengths: Vec<f64>, samples: u32) -> Atlas {
    let robot = Robot {
        name: "arm".into(),
        source: None,
        geometry: Geometry::Planar {
            lengths: lengths.clone(),
        },
        physical_limits: None,
        tool: nalgebra::Isometry3::identity(),
    };
    let plan = SamplePlan {
        task: TaskSpace::PlanarPosition,
        region: Region {
            radius: lengths.iter().sum(),
            lower: 0.0,
            upper: 0.0,
            reach: lengths.iter().sum(),
        },
        sampling: Sampling::Lattice {
            samples,
            replicates: 4,
        },
        seed: 1,
    };
    let settings = AtlasSettings {
        slices: 8,
        ..AtlasSettings::default()
    };
    let recipe = AtlasRecipe::new(&robot, plan, settings).unwrap();
    recipe
        .build(None, &AtomicBool::new(false), &|_, _| ())
        .unwrap()
}

/// At every width the profile is what scoring these limits alone gives.
#[test]
fn profiles_agree_with_single_scores() {
    let atlas = atlas();
    let widths: Vec<f64> = (0..=40).map(|k| k as f64 * TAU / 40.0).collect();
    let [tight, free] = [
        [[-18.0, 18.0], [-111.0, 111.0], [-100.0, 105.0]],
        [[-180.0, 180.0], [-111.0, 111.0], [30.0, 105.0]],
    ]
    .map(|pairs| ArtificialLimits::from_degrees(&pairs));
    let mut positive = 0;
    let margin = 7f64.to_radians();
    for failures in [
        FailureSet::any(3),
        FailureSet::of(3, &[2]),
        FailureSet::any(3).with_margin(margin),
        FailureSet::of(3, &[1, 3]).with_margin(3.0 * margin),
    ] {
        for limits in [&tight, &free] {
            for joint in 0..3 {
                for growth in [Growth::Lower, Growth::Upper, Growth::Both] {
                    let profile = atlas
                        .profile(limits, &failures, joint, growth, &widths)
                        .unwrap();
                    let mut best = 0.0f64;
                    for (&width, &found) in widths.iter().zip(&profile) {
                        let changed = changed(limits, joint, growth, width);
                        let alone = atlas.fault_tolerant_size(&changed, &failures);
                        best = best.max(alone);
                        let error = (found - alone).abs();
                        assert!(
                            error < 2e-3,
                            "joint {joint} {growth:?} {width}: {found} against {alone}"
                        );
                    }
                    positive += usize::from(best > 0.0);
                }
            }
        }
    }
    // Many of the 72 families hold limits with a workspace.
    assert!(positive >= 24, "{positive}");
}

/// The same where pre-images are surfaces, cut along joint 3.
#[test]
fn profiles_over_slices_agree_with_single_scores() {
    let atlas = atlas_of(vec![1.0, 1.2, 1.1, 0.8], 80);
    assert!(atlas.slabs[2] > 0.0);
    let widths: Vec<f64> = (0..=30).map(|k| k as f64 * TAU / 30.0).collect();
    let pairs = [
        [-40.0, 40.0],
        [-140.0, 100.0],
        // No end lies in the middle between two slices, where round-off decides.
        [-91.0, 100.0],
        [-120.0, 150.0],
    ];
    let limits = ArtificialLimits::from_degrees(&pairs);
    let mut positive = 0;
    for failures in [FailureSet::any(4), FailureSet::of(4, &[4])] {
        for joint in 0..4 {
            for growth in [Growth::Lower, Growth::Upper, Growth::Both] {
                let profile = atlas.profile(&limits, &failures, joint, growth, &widths);
                for (&width, &found) in widths.iter().zip(&profile.unwrap()) {
                    let changed = changed(&limits, joint, growth, width);
                    let alone = atlas.fault_tolerant_size(&changed, &failures);
                    positive += usize::from(alone > 0.0);
                    let error = (found - alone).abs();
                    assert!(
                        error < 2e-3 * alone.max(1.0),
                        "joint {joint} {growth:?} {width}: {found} against {alone}"
                    );
                }
            }
        }
    }
    assert!(positive > 200, "{positive}");
}

fn changed(
    limits: &ArtificialLimits,
    joint: usize,
    growth: Growth,
    width: f64,
) -> ArtificialLimits {
    let mut joints = limits.joints().to_vec();
    let old = joints[joint];
    joints[joint] = match growth {
        _ if joint == 0 => JointLimit::around(0.0, width),
        Growth::Lower => JointLimit::new(old.upper - width, old.upper),
        Growth::Upper => JointLimit::new(old.lower, old.lower + width),
        Growth::Both => JointLimit::around(old.centre(), width),
    };
    ArtificialLimits::new(joints)
}
