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

/// Samples that a cell of a lattice's map should have in the mean, and near the axis at least.
const PER_CELL: f64 = 80.0;
const LEAST_PER_CELL: f64 = 40.0;

/// Most cells along one side of a map.
const MOST_CELLS: f64 = 60.0;

/// What the map says about one sample.
struct Spot {
    sample: u64,
    set: AngleSet,
}

/// Edges of cells in the half-plane, metres.
struct Layout {
    radii: Vec<f64>,
    heights: Vec<f64>,
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
        let layout = self.layout();
        let cells = self.count(&layout, AZIMUTHS, limits, failures);
        SpatialShareMap {
            azimuths: AZIMUTHS,
            share: cells.shares(),
            unrestricted: cells.reachable_shares(),
            orientations: self.plan().task == TaskSpace::SpatialPose,
            radius_edges: layout.radii,
            height_edges: layout.heights,
        }
    }

    /// The workspace of a planar task.
    pub fn planar_map(&self, limits: &ArtificialLimits, failures: &FailureSet) -> WorkspaceMap {
        if self.plan().task == TaskSpace::PlanarPosition {
            return WorkspaceMap::Rings(self.ring_map(limits, failures));
        }
        let azimuths = 360;
        let layout = self.layout();
        let cells = self.count(&layout, azimuths, limits, failures);
        let first = cells.reachable.iter().position(|&count| count > 0.0);
        WorkspaceMap::Shares(ShareMap {
            unrestricted: [layout.radii[first.unwrap_or(0)], self.plan().region.radius],
            angles: azimuths,
            share: cells.shares().into_iter().map(f64::from).collect(),
            radius_edges: layout.radii,
        })
    }

    /// The cells of the map: those of the grid, or as many as the samples fill.
    fn layout(&self) -> Layout {
        let plan = self.plan();
        let region = &plan.region;
        let even = |first: f64, step: f64, count: usize| -> Vec<f64> {
            (0..=count).map(|k| first + k as f64 * step).collect()
        };
        if let Sampling::Grid { .. } = plan.sampling {
            let ([columns, rows], side) = (plan.cells(), plan.cell_side());
            return Layout {
                radii: even(0.0, side, columns),
                heights: even(region.lower, side, rows),
            };
        }
        let cells = plan.len() as f64 / PER_CELL;
        let height = region.upper - region.lower;
        let (columns, rows) = if plan.task.is_planar() {
            (cells.clamp(8.0, 2.0 * MOST_CELLS), 1.0)
        } else {
            let aspect = height / region.radius;
            let columns = (cells / aspect).sqrt().clamp(4.0, MOST_CELLS);
            (columns, (columns * aspect).clamp(4.0, 2.0 * MOST_CELLS))
        };
        // Samples are uniform in the square of the radius, so cells near the axis must be wider.
        let step = region.radius / columns.round();
        let least = LEAST_PER_CELL * rows.round() / plan.len() as f64;
        let mut radii = vec![0.0f64];
        while let Some(&inner) = radii.last()
            && inner < region.radius * (1.0 - 1e-9)
        {
            let wide = (inner * inner + least * region.radius * region.radius).sqrt();
            let outer = (inner + step).max(wide).min(region.radius);
            // No sliver at the rim.
            let rest = region.radius - outer;
            radii.push(if rest < 0.5 * step {
                region.radius
            } else {
                outer
            });
        }
        Layout {
            radii,
            heights: even(region.lower, height / rows.round(), rows.round() as usize),
        }
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
        layout: &Layout,
        azimuths: usize,
        limits: &ArtificialLimits,
        failures: &FailureSet,
    ) -> Cells {
        let plan = self.plan();
        let [columns, rows] = [&layout.radii, &layout.heights].map(|edges| edges.len() - 1);
        let cell_of = |index: u64| {
            if let Sampling::Grid { .. } = plan.sampling {
                return plan.sample(index).stratum as usize;
            }
            let place = plan.sample(index).tool.translation;
            let find = |edges: &[f64], value: f64| {
                let above = edges.partition_point(|&edge| edge <= value);
                above.clamp(1, edges.len() - 1) - 1
            };
            find(&layout.heights, place.z) * columns + find(&layout.radii, place.x)
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
