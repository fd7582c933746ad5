//! Where the fault-tolerant workspace lies: shares of orientations, cell by cell.

use super::atlas::Atlas;
use super::block::BlockView;
use super::plan::Sampling;
use super::score::{Limits16, Rule};
use crate::angle::{AngleSet, Arc};
use crate::design::TaskSpace;
use crate::workspace::{
    ArtificialLimits, FailureSet, Ring, RingMap, ShareMap, SpatialShareMap, WorkspaceMap,
};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Cells around the circle.
const AZIMUTHS: usize = 72;

/// Samples that a cell of a lattice's map should have.
const PER_CELL: f64 = 40.0;

/// Most cells along one side of a map.
const MOST_CELLS: f64 = 60.0;

/// What the map says about one sample.
struct Spot {
    sample: u64,
    set: AngleSet,
}

/// Counts over a grid of cells in the half-plane.
struct Cells {
    columns: usize,
    rows: usize,
    samples: Vec<f64>,
    reachable: Vec<f64>,
    tolerant: Vec<f64>,
    azimuths: usize,
}

impl Atlas {
    /// The workspace of a spatial task.
    pub fn share_map(&self, limits: &ArtificialLimits, failures: &FailureSet) -> SpatialShareMap {
        let plan = self.plan();
        let region = &plan.region;
        let [columns, rows] = self.map_cells();
        let cells = self.count([columns, rows], AZIMUTHS, limits, failures);
        let (width, height) = match plan.sampling {
            Sampling::Grid { .. } => (plan.cell_side(), plan.cell_side()),
            Sampling::Lattice { .. } => (
                region.radius / columns as f64,
                (region.upper - region.lower) / rows as f64,
            ),
        };
        let edge = |first: f64, step: f64, count: usize| -> Vec<f64> {
            (0..=count).map(|k| first + k as f64 * step).collect()
        };
        SpatialShareMap {
            radius_edges: edge(0.0, width, columns),
            height_edges: edge(region.lower, height, rows),
            azimuths: AZIMUTHS,
            share: cells.shares(),
            unrestricted: cells.reachable_shares(),
            orientations: plan.task == TaskSpace::SpatialPose,
        }
    }

    /// The workspace of a planar task.
    pub fn planar_map(&self, limits: &ArtificialLimits, failures: &FailureSet) -> WorkspaceMap {
        let region = &self.plan().region;
        let [columns, _] = self.map_cells();
        if self.plan().task == TaskSpace::PlanarPosition {
            return WorkspaceMap::Rings(self.ring_map(limits, failures));
        }
        let azimuths = 360;
        let cells = self.count([columns, 1], azimuths, limits, failures);
        let step = region.radius / columns as f64;
        let reached = |column: &usize| cells.reachable[*column] > 0.0;
        let first = (0..columns).find(reached).unwrap_or(0);
        WorkspaceMap::Shares(ShareMap {
            unrestricted: [first as f64 * step, region.radius],
            radius_edges: (0..=columns).map(|k| k as f64 * step).collect(),
            angles: azimuths,
            share: cells.shares().into_iter().map(f64::from).collect(),
        })
    }

    /// Columns and rows of the map: those of the grid, or as many as the samples fill.
    fn map_cells(&self) -> [usize; 2] {
        let plan = self.plan();
        if let Sampling::Grid { .. } = plan.sampling {
            return plan.cells();
        }
        let cells = plan.len() as f64 / PER_CELL;
        if plan.task.is_planar() {
            return [cells.clamp(8.0, 2.0 * MOST_CELLS) as usize, 1];
        }
        let aspect = (plan.region.upper - plan.region.lower) / plan.region.radius;
        let columns = (cells / aspect).sqrt().clamp(4.0, MOST_CELLS);
        let rows = (columns * aspect).clamp(4.0, 2.0 * MOST_CELLS);
        [columns.round() as usize, rows.round() as usize]
    }

    /// Rotation sets of all reachable samples, in order.
    fn spots(&self, limits: &ArtificialLimits, failures: &FailureSet) -> Vec<Spot> {
        let limits = self.limits(limits, failures, Rule::Definition);
        let parts: Vec<Vec<Spot>> = self
            .views()
            .map(|view| block_spots(&view, &limits))
            .collect();
        parts.into_iter().flatten().collect()
    }

    fn count(
        &self,
        [columns, rows]: [usize; 2],
        azimuths: usize,
        limits: &ArtificialLimits,
        failures: &FailureSet,
    ) -> Cells {
        let plan = self.plan();
        let region = &plan.region;
        let cell_of = |index: u64| {
            if let Sampling::Grid { .. } = plan.sampling {
                return plan.sample(index).stratum as usize;
            }
            let place = plan.sample(index).tool.translation;
            let share = |value: f64, size: f64, count: usize| {
                ((value / size * count as f64) as usize).min(count - 1)
            };
            let column = share(place.x, region.radius, columns);
            let height = region.upper - region.lower;
            let row = match rows {
                1 => 0,
                _ => share(place.z - region.lower, height, rows),
            };
            row * columns + column
        };
        let places: Vec<usize> = (0..plan.len()).into_par_iter().map(cell_of).collect();
        let mut cells = Cells {
            columns,
            rows,
            samples: vec![0.0; columns * rows],
            reachable: vec![0.0; columns * rows],
            tolerant: vec![0.0; columns * rows * azimuths],
            azimuths,
        };
        for &place in &places {
            cells.samples[place] += 1.0;
        }
        for spot in self.spots(limits, failures) {
            let place = places[spot.sample as usize];
            cells.reachable[place] += 1.0;
            cells.add(place, &spot.set);
        }
        cells
    }

    /// Rings around the samples, which lie at different radii.
    fn ring_map(&self, limits: &ArtificialLimits, failures: &FailureSet) -> RingMap {
        let plan = self.plan();
        let radius = |spot: &Spot| plan.sample(spot.sample).tool.translation.x;
        let mut spots: Vec<(f64, AngleSet)> = self
            .spots(limits, failures)
            .into_iter()
            .map(|spot| (radius(&spot), spot.set))
            .collect();
        spots.sort_by(|a, b| a.0.total_cmp(&b.0));
        let thin = (spots.len() / 400).max(1);
        let spots: Vec<_> = spots.into_iter().step_by(thin).collect();
        let middle = |k: usize| 0.5 * (spots[k].0 + spots[k + 1].0);
        let rings = (0..spots.len()).map(|k| Ring {
            inner: if k == 0 { spots[k].0 } else { middle(k - 1) },
            outer: if k + 1 < spots.len() {
                middle(k)
            } else {
                spots[k].0
            },
            rotation_set: spots[k].1.clone(),
        });
        RingMap {
            unrestricted: [
                spots.first().map_or(0.0, |spot| spot.0),
                spots.last().map_or(plan.region.radius, |spot| spot.0),
            ],
            rings: rings.collect(),
        }
    }
}

fn block_spots(view: &BlockView, limits: &Limits16) -> Vec<Spot> {
    let spot = |(index, pose): (usize, &super::block::PoseRecord)| Spot {
        sample: u64::from(pose.sample),
        set: limits.rotation_set(view, index),
    };
    view.poses.iter().enumerate().map(spot).collect()
}

impl Cells {
    /// Adds a rotation set to the cells around the circle, each by the share that it covers.
    fn add(&mut self, place: usize, set: &AngleSet) {
        if set.is_empty() {
            return;
        }
        let step = TAU / self.azimuths as f64;
        let own = &mut self.tolerant[place * self.azimuths..][..self.azimuths];
        for (k, sum) in own.iter_mut().enumerate() {
            let cell = Arc::new(-PI + k as f64 * step, step);
            *sum += set.overlap(&AngleSet::from(cell)) / step;
        }
    }

    /// Shares with the order of cells that maps have: radius, then height, then azimuth.
    fn shares(&self) -> Vec<f32> {
        let mut shares = Vec::with_capacity(self.tolerant.len());
        for column in 0..self.columns {
            for row in 0..self.rows {
                let place = row * self.columns + column;
                let own = &self.tolerant[place * self.azimuths..][..self.azimuths];
                let all = self.samples[place].max(1.0);
                shares.extend(own.iter().map(|sum| (sum / all).clamp(0.0, 1.0) as f32));
            }
        }
        shares
    }

    fn reachable_shares(&self) -> Vec<f32> {
        let mut shares = Vec::with_capacity(self.samples.len());
        for column in 0..self.columns {
            for row in 0..self.rows {
                let place = row * self.columns + column;
                shares.push((self.reachable[place] / self.samples[place].max(1.0)) as f32);
            }
        }
        shares
    }
}
