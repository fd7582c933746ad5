use super::*;
use crate::design::{Geometry, Robot, TaskSpace};
use crate::workspace::JointLimit;
use crate::workspace::hybrid::{AtlasRecipe, AtlasSettings, Region, SamplePlan, Sampling};
use std::sync::atomic::AtomicBool;

fn atlas() -> Atlas {
    let robot = Robot {
        name: "arm".into(),
        source: None,
        geometry: Geometry::Planar {
            lengths: vec![1.0, 1.0, 1.0],
        },
        physical_limits: None,
        tool: nalgebra::Isometry3::identity(),
    };
    let plan = SamplePlan {
        task: TaskSpace::PlanarPosition,
        region: Region {
            radius: 3.0,
            lower: 0.0,
            upper: 0.0,
            reach: 3.0,
        },
        sampling: Sampling::Lattice {
            samples: 400,
            replicates: 4,
        },
        seed: 1,
    };
    let recipe = AtlasRecipe::new(&robot, plan, AtlasSettings::default()).unwrap();
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
