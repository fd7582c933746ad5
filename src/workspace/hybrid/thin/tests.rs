use super::*;
use crate::design::{Geometry, Robot, TaskSpace};
use crate::workspace::hybrid::{AtlasRecipe, AtlasSettings, Region};
use crate::workspace::{ArtificialLimits, FailureSet};
use std::sync::atomic::AtomicBool;

const LATTICE: Sampling = Sampling::Lattice {
    samples: 8000,
    replicates: 4,
};

const GRID: Sampling = Sampling::Grid {
    cell: 0.0005,
    orientations: 1,
    centres: false,
};

fn atlas(sampling: Sampling) -> Atlas {
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
        sampling,
        seed: 1,
    };
    let recipe = AtlasRecipe::new(&robot, plan, AtlasSettings::default()).unwrap();
    let never = AtomicBool::new(false);
    recipe.build(None, &never, &|_, _| ()).unwrap()
}

/// A part of the samples measures the same workspace, more roughly; parts are nested.
#[test]
fn a_part_stands_for_the_whole() {
    let limits = ArtificialLimits::from_degrees(&[[-60.0, 60.0], [-111.0, 111.0], [-100.0, 105.0]]);
    let any = FailureSet::any(3);
    for sampling in [LATTICE, GRID] {
        let whole = atlas(sampling);
        let plan = whole.plan();
        let size = whole.fault_tolerant_size(&limits, &any);
        assert!(size > 1.0, "{size}");
        for every in [4, 16] {
            let part = whole.thinned(every);
            let kept = plan.kept(every);
            assert!(
                kept.abs_diff(plan.len() / every) <= 4,
                "{kept} of {}",
                plan.len()
            );
            assert!(part.bytes() < whole.bytes() / every * 3 / 2);
            assert_eq!(part.counts().samples, kept);
            let rough = part.fault_tolerant_size(&limits, &any);
            assert!((rough / size - 1.0).abs() < 0.03, "{rough} against {size}");
        }
        assert!((0..plan.len()).all(|k| plan.keeps(k, 4) || !plan.keeps(k, 16)));
        let all = whole.thinned(1);
        assert_eq!((all.bytes(), all.counts()), (whole.bytes(), whole.counts()));
        assert_eq!(all.fault_tolerant_size(&limits, &any), size);
    }
}
