//! Which task points are sampled, and with what weight.
//!
//! Turning a task point about joint 1 by β changes nothing but θ₁, so points are taken at azimuth
//! 0: in the half-plane (r, z) of a spatial task or on the half-line r of a planar one [S4 §III.A].
//! A sample stands for its whole circle: the size of a workspace is Σ w |B|, where |B| is the
//! measure of the rotation angles β at which the turned sample belongs to it, and w is the
//! sample's share of r dr dz times the volume of orientations (2π in the plane, π² in space).
//!
//! A joint 1 that slides turns nothing. Task points are then taken at all azimuths
//! ([`Sampling::Everywhere`]), and each stands for itself: |B| is 2π or 0.

use crate::design::TaskSpace;
use crate::sampling::{Lattice, rotation, stream};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use rand::Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// The part of the half-plane in which a workspace lies, relative to the frame of joint 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Region {
    /// Largest distance from joint 1's axis, metres.
    pub radius: f64,
    /// Least height along the axis, metres; 0 for planar tasks.
    pub lower: f64,
    /// Greatest height, metres; 0 for planar tasks.
    pub upper: f64,
    /// Largest distance from the origin of joint 1's frame, metres: points beyond are out of
    /// reach without a search.
    pub reach: f64,
}

/// How task points are sampled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampling {
    /// Square cells in the half-plane with random orientations in each [S4].
    Grid {
        /// Side of a cell as a share of the reach; [S4] takes 0.04.
        cell: f64,
        /// Orientations per cell; 1 for position tasks.
        orientations: u32,
        /// Whether all samples of a cell sit at its centre, as in [S4]. Otherwise each has its
        /// own random place in the cell, which removes the error of discretisation.
        centres: bool,
    },
    /// A randomly shifted lattice over positions and orientations together.
    Lattice {
        /// Samples in all.
        samples: u32,
        /// Independent shifts, whose scatter gives the standard error.
        replicates: u32,
    },
    /// The lattice over positions at all azimuths: needed where joint 1 slides, so that no turn
    /// leaves the pre-image as it is.
    Everywhere {
        /// Samples in all.
        samples: u32,
        /// Independent shifts, whose scatter gives the standard error.
        replicates: u32,
    },
}

impl Sampling {
    /// Whether a sample stands for all task points on its circle about joint 1's axis.
    pub fn uses_turns(&self) -> bool {
        !matches!(self, Sampling::Everywhere { .. })
    }
}

/// All samples of an estimate. A sample depends on its number alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SamplePlan {
    /// The task's space.
    pub task: TaskSpace,
    /// Where samples lie.
    pub region: Region,
    /// How they are drawn.
    pub sampling: Sampling,
    /// Seed of every random stream.
    pub seed: u64,
}

/// One task point, at azimuth 0 unless samples lie everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Tool pose in the frame of joint 1; at azimuth 0, y = 0 and x = r ≥ 0.
    pub tool: Isometry3<f64>,
    /// Its weight: the size of a workspace is Σ weight · |B|.
    pub weight: f64,
    /// The stratum whose scatter gives the error: the cell of a grid, the replicate of a lattice.
    pub stratum: u32,
}

/// The random stream of sample number `index` for the search of its manifolds is
/// `stream(seed, SEARCH + index)`; samples themselves use the numbers below.
const SEARCH: u64 = 1 << 40;

impl SamplePlan {
    /// Number of samples.
    pub fn len(&self) -> u64 {
        match self.sampling {
            Sampling::Grid { orientations, .. } => {
                let [columns, rows] = self.cells();
                columns as u64 * rows as u64 * u64::from(orientations)
            }
            Sampling::Lattice {
                samples,
                replicates,
            }
            | Sampling::Everywhere {
                samples,
                replicates,
            } => u64::from(samples / replicates.max(1)) * u64::from(replicates),
        }
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of strata.
    pub fn strata(&self) -> u32 {
        match self.sampling {
            Sampling::Grid { .. } => {
                let [columns, rows] = self.cells();
                (columns * rows) as u32
            }
            Sampling::Lattice { replicates, .. } | Sampling::Everywhere { replicates, .. } => {
                replicates
            }
        }
    }

    /// Volume of the sampled orientations: 2π in the plane, π² in space, 1 without orientations.
    pub fn orientation_volume(&self) -> f64 {
        match self.task {
            TaskSpace::PlanarPose => TAU,
            TaskSpace::SpatialPose => PI * PI,
            _ => 1.0,
        }
    }

    /// Columns (along r) and rows (along z, 1 for planar tasks) of the grid; [0, 0] for a lattice.
    pub fn cells(&self) -> [usize; 2] {
        let Sampling::Grid { cell, .. } = self.sampling else {
            return [0, 0];
        };
        let side = cell * self.region.reach;
        let count = |length: f64| ((length / side - 1e-9).ceil().max(1.0)) as usize;
        let columns = count(self.region.radius);
        if self.task.is_planar() {
            [columns, 1]
        } else {
            [columns, count(self.region.upper - self.region.lower)]
        }
    }

    /// Side of a grid cell, metres.
    pub fn cell_side(&self) -> f64 {
        match self.sampling {
            Sampling::Grid { cell, .. } => cell * self.region.reach,
            Sampling::Lattice { .. } | Sampling::Everywhere { .. } => 0.0,
        }
    }

    /// The random stream for the search of sample `index`.
    pub fn search_stream(&self, index: u64) -> rand_chacha::ChaCha8Rng {
        stream(self.seed, SEARCH + index)
    }

    /// Sample number `index`.
    pub fn sample(&self, index: u64) -> Sample {
        match self.sampling {
            Sampling::Grid {
                orientations,
                centres,
                ..
            } => self.grid_sample(index, orientations, centres),
            Sampling::Lattice {
                samples,
                replicates,
            } => self.lattice_sample(index, samples / replicates.max(1)),
            Sampling::Everywhere {
                samples,
                replicates,
            } => self.sample_anywhere(index, samples / replicates.max(1)),
        }
    }

    fn grid_sample(&self, index: u64, orientations: u32, centres: bool) -> Sample {
        let stratum = (index / u64::from(orientations)) as u32;
        let [columns, _] = self.cells();
        let (column, row) = (stratum as usize % columns, stratum as usize / columns);
        let mut rng = stream(self.seed, index);
        let place: [f64; 2] = std::array::from_fn(|_| rng.random());
        let place = if centres { [0.5, 0.5] } else { place };
        let side = self.cell_side();
        let r = (column as f64 + place[0]) * side;
        let (z, area) = if self.task.is_planar() {
            (0.0, side)
        } else {
            (
                self.region.lower + (row as f64 + place[1]) * side,
                side * side,
            )
        };
        let turn: [f64; 3] = std::array::from_fn(|_| rng.random());
        Sample {
            tool: self.tool([r, 0.0, z], turn),
            weight: r * area * self.orientation_volume() / f64::from(orientations),
            stratum,
        }
    }

    fn lattice_sample(&self, index: u64, each: u32) -> Sample {
        let (replicate, number) = (index / u64::from(each), index % u64::from(each));
        let mut rng = stream(self.seed, replicate);
        let region = &self.region;
        let half_disc = 0.5 * region.radius * region.radius;
        // Only as many dimensions as the task has: fewer dimensions are filled more evenly.
        let (r, z, turn, area) = match self.task {
            TaskSpace::PlanarPosition => {
                let [a] = Lattice::<1>::random(&mut rng).point(number);
                (a, 0.0, [0.0; 3], half_disc)
            }
            TaskSpace::PlanarPose => {
                let [a, t] = Lattice::<2>::random(&mut rng).point(number);
                (a, 0.0, [t, 0.0, 0.0], half_disc)
            }
            TaskSpace::SpatialPosition => {
                let [a, b] = Lattice::<2>::random(&mut rng).point(number);
                (a, b, [0.0; 3], half_disc * (region.upper - region.lower))
            }
            TaskSpace::SpatialPose => {
                let [a, b, s, t, u] = Lattice::<5>::random(&mut rng).point(number);
                (a, b, [s, t, u], half_disc * (region.upper - region.lower))
            }
        };
        let r = region.radius * r.sqrt();
        let z = match self.task.is_planar() {
            true => 0.0,
            false => region.lower + (region.upper - region.lower) * z,
        };
        let samples = u64::from(each) * u64::from(self.strata());
        Sample {
            tool: self.tool([r, 0.0, z], turn),
            weight: area * self.orientation_volume() / samples as f64,
            stratum: replicate as u32,
        }
    }

    /// As [`SamplePlan::lattice_sample`], with the azimuth as one more dimension.
    fn sample_anywhere(&self, index: u64, each: u32) -> Sample {
        let (replicate, number) = (index / u64::from(each), index % u64::from(each));
        let mut rng = stream(self.seed, replicate);
        let region = &self.region;
        let (place, height, turn) = match self.task {
            TaskSpace::PlanarPosition => {
                let [a, b] = Lattice::<2>::random(&mut rng).point(number);
                ([a, b], 0.0, [0.0; 3])
            }
            TaskSpace::PlanarPose => {
                let [a, b, t] = Lattice::<3>::random(&mut rng).point(number);
                ([a, b], 0.0, [t, 0.0, 0.0])
            }
            TaskSpace::SpatialPosition => {
                let [a, b, c] = Lattice::<3>::random(&mut rng).point(number);
                ([a, b], c, [0.0; 3])
            }
            TaskSpace::SpatialPose => {
                let [a, b, c, s, t, u] = Lattice::<6>::random(&mut rng).point(number);
                ([a, b], c, [s, t, u])
            }
        };
        let r = region.radius * place[0].sqrt();
        let (sine, cosine) = (TAU * place[1]).sin_cos();
        let half_disc = 0.5 * region.radius * region.radius;
        let (z, area) = match self.task.is_planar() {
            true => (0.0, half_disc),
            false => {
                let tall = region.upper - region.lower;
                (region.lower + tall * height, half_disc * tall)
            }
        };
        let samples = u64::from(each) * u64::from(self.strata());
        Sample {
            tool: self.tool([r * cosine, r * sine, z], turn),
            weight: area * self.orientation_volume() / samples as f64,
            stratum: replicate as u32,
        }
    }

    fn tool(&self, [x, y, z]: [f64; 3], turn: [f64; 3]) -> Isometry3<f64> {
        let rotation = match self.task {
            TaskSpace::SpatialPose => rotation(turn),
            TaskSpace::PlanarPose => {
                UnitQuaternion::from_axis_angle(&Vector3::z_axis(), TAU * turn[0])
            }
            _ => UnitQuaternion::identity(),
        };
        Isometry3::from_parts(Translation3::new(x, y, z), rotation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(task: TaskSpace, sampling: Sampling) -> SamplePlan {
        SamplePlan {
            task,
            region: Region {
                radius: 2.0,
                lower: -1.0,
                upper: 2.0,
                reach: 2.5,
            },
            sampling,
            seed: 1,
        }
    }

    /// Σ w · 2π is the volume of the region times that of the orientations.
    #[test]
    fn weights_measure_the_region() {
        let lattice = Sampling::Lattice {
            samples: 1000,
            replicates: 4,
        };
        let grid = Sampling::Grid {
            cell: 0.04,
            orientations: 2,
            centres: true,
        };
        let everywhere = Sampling::Everywhere {
            samples: 1000,
            replicates: 4,
        };
        for sampling in [lattice, grid, everywhere] {
            for (task, volume) in [
                (TaskSpace::PlanarPosition, 4.0 * PI),
                (TaskSpace::PlanarPose, 8.0 * PI * PI),
                (TaskSpace::SpatialPosition, 12.0 * PI),
                (TaskSpace::SpatialPose, 12.0 * PI.powi(3)),
            ] {
                let plan = plan(task, sampling);
                let sum: f64 = (0..plan.len()).map(|i| plan.sample(i).weight * TAU).sum();
                assert!((sum / volume - 1.0).abs() < 1e-9, "{task} {sampling:?}");
            }
        }
    }

    #[test]
    fn samples_stay_in_the_region() {
        let sampling = Sampling::Grid {
            cell: 0.1,
            orientations: 3,
            centres: false,
        };
        let plan = plan(TaskSpace::SpatialPose, sampling);
        assert_eq!(plan.cells(), [8, 12]);
        assert_eq!(plan.len(), 8 * 12 * 3);
        for index in 0..plan.len() {
            let p = plan.sample(index).tool.translation;
            assert!(p.x >= 0.0 && p.x <= 2.0 && p.y == 0.0);
            assert!((-1.0..=2.0).contains(&p.z));
            assert!(plan.sample(index).stratum < plan.strata());
        }
    }

    /// Samples everywhere fill the cylinder evenly: each octant of it alike.
    #[test]
    fn samples_everywhere_have_all_azimuths() {
        let sampling = Sampling::Everywhere {
            samples: 4000,
            replicates: 4,
        };
        let plan = plan(TaskSpace::SpatialPosition, sampling);
        let mut octants = [0; 8];
        for index in 0..plan.len() {
            let p = plan.sample(index).tool.translation;
            assert!(p.x.hypot(p.y) <= 2.0 && (-1.0..=2.0).contains(&p.z));
            let signs = [p.x > 0.0, p.y > 0.0, p.z > 0.5];
            octants[signs.iter().fold(0, |k, &sign| 2 * k + usize::from(sign))] += 1;
        }
        assert!(
            octants.iter().all(|&count: &i32| (count - 500).abs() < 25),
            "{octants:?}"
        );
    }
}
