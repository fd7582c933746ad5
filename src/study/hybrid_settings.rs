//! Settings of the hybrid estimator: `[estimator.hybrid]`, validated.

use crate::design::TaskSpace;
use crate::workspace::hybrid::{AtlasSettings, Rule, Sampling};
use serde::Serialize;

/// How the hybrid estimator samples and traces.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hybrid {
    /// Which task points are taken.
    #[serde(flatten)]
    pub sampling: HybridSampling,
    /// Largest distance between a stored polyline and its curve, radians, default 0.01 for spatial
    /// poses, else 0.001.
    pub tolerance_rad: f64,
    /// Size above which an atlas is not built, megabytes, default 4096.
    pub memory_limit_mb: u64,
    /// Values of each surplus joint at which pre-images of more than one degree of redundancy are
    /// cut, default 32.
    pub slices: u64,
    /// How the workspace before a failure is formed, default the definition.
    pub rule: Rule,
    /// Reachable task points on which inverse kinematics with locked joints checks the result,
    /// default 0: none.
    pub check_poses: u64,
}

/// Which task points are taken.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "sampling", rename_all = "kebab-case")]
pub enum HybridSampling {
    /// A randomly shifted lattice, the default.
    Lattice {
        /// Samples in all: 100 000 for spatial poses, else 20 000.
        samples: u32,
        /// Independent shifts, default 16; at least 2, at most a sixteenth of the samples.
        replicates: u32,
    },
    /// Square cells with random orientations in each [S4].
    Grid {
        /// Side of a cell as a share of the reach, default 0.04.
        cell: f64,
        /// Orientations per cell: 200 for spatial poses, 25 for planar ones, 1 for positions.
        orientations: u32,
        /// Whether all samples of a cell sit at its centre, default false.
        centres: bool,
    },
}

impl Hybrid {
    /// The defaults for `task`.
    pub fn for_task(task: TaskSpace) -> Hybrid {
        let settings = AtlasSettings::default();
        Hybrid {
            sampling: HybridSampling::Lattice {
                samples: default_samples(task),
                replicates: DEFAULT_REPLICATES,
            },
            tolerance_rad: default_tolerance(task),
            memory_limit_mb: settings.memory_limit >> 20,
            slices: settings.slices as u64,
            rule: Rule::default(),
            check_poses: 0,
        }
    }

    /// The settings of an atlas.
    pub(super) fn atlas_settings(&self) -> AtlasSettings {
        AtlasSettings {
            tolerance: self.tolerance_rad,
            slices: self.slices as usize,
            memory_limit: self.memory_limit_mb << 20,
            ..AtlasSettings::default()
        }
    }
}

impl HybridSampling {
    /// As the sample plan has it; `turns` tells that joint 1 turns.
    pub(super) fn to_plan(self, turns: bool) -> Sampling {
        match self {
            HybridSampling::Lattice {
                samples,
                replicates,
            } if !turns => Sampling::Everywhere {
                samples,
                replicates,
            },
            HybridSampling::Lattice {
                samples,
                replicates,
            } => Sampling::Lattice {
                samples,
                replicates,
            },
            HybridSampling::Grid {
                cell,
                orientations,
                centres,
            } => Sampling::Grid {
                cell,
                orientations,
                centres,
            },
        }
    }
}

/// Shifts of a lattice if the study names no number.
pub(super) const DEFAULT_REPLICATES: u32 = 16;

/// Side of a grid cell if the study names none, as a share of the reach [S4].
pub(super) const DEFAULT_CELL: f64 = 0.04;

/// Samples of a lattice if the study names no number.
pub(super) fn default_samples(task: TaskSpace) -> u32 {
    match task {
        TaskSpace::SpatialPose => 100_000,
        _ => 20_000,
    }
}

/// Distance between stored polylines and their curves if the study names none, radians. Memory is
/// scarce for spatial poses alone, and there sampling errors are larger.
pub(super) fn default_tolerance(task: TaskSpace) -> f64 {
    match task {
        TaskSpace::SpatialPose => 0.01,
        _ => 0.001,
    }
}

/// Orientations of a grid cell if the study names no number.
pub(super) fn default_orientations(task: TaskSpace) -> u32 {
    match task {
        TaskSpace::SpatialPose => 200,
        TaskSpace::PlanarPose => 25,
        _ => 1,
    }
}
