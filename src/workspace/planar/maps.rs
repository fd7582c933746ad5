//! Sampled pictures of exact planar workspaces.

use super::pose::PlanarPose;
use super::position::{PlanarArm, PlanarPosition};
use super::post_failure::annulus;
use crate::angle::AngleSet;
use crate::workspace::{Ring, RingMap, ShareMap};
use nalgebra::Complex;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Bearings of the wrist around the circle for which a share map tabulates directions.
const TABLE_BEARINGS: usize = 720;

/// Wrist radii for which a share map tabulates directions.
const TABLE_RADII: usize = 400;

/// Orientations per tool position of a share map.
const ORIENTATIONS: usize = 480;

impl PlanarPosition {
    /// W_F as about `rings` thin rings, finer towards critical radii, where arcs open like square
    /// roots.
    pub fn ring_map(&mut self, arm: PlanarArm<'_>, rings: usize) -> RingMap {
        let critical = self.critical_radii(arm);
        let extent = critical[critical.len() - 1] - critical[0];
        let mut edges = Vec::new();
        for panel in critical.windows(2).filter(|panel| panel[1] > panel[0]) {
            let share = (panel[1] - panel[0]) / extent;
            let count = ((share * rings as f64).ceil() as usize).max(4);
            let (middle, half) = (0.5 * (panel[0] + panel[1]), 0.5 * (panel[1] - panel[0]));
            let edge = |k: usize| middle - half * (PI * k as f64 / count as f64).cos();
            edges.extend((0..count).map(|k| [edge(k), edge(k + 1)]));
        }
        let middles: Vec<f64> = edges.iter().map(|e| 0.5 * (e[0] + e[1])).collect();
        let sets = self.rotation_sets(arm, &middles);
        let ring = |([inner, outer], rotation_set): ([f64; 2], AngleSet)| Ring {
            inner,
            outer,
            rotation_set,
        };
        RingMap {
            unrestricted: annulus(arm.lengths),
            rings: edges.into_iter().zip(sets).map(ring).collect(),
        }
    }
}

impl PlanarPose {
    /// For every tool position the share of orientations that is fault tolerant, on `radii` ×
    /// `angles` polar cells.
    ///
    /// The wrist of tool position p at orientation φ is p − l_n·e^{iφ}; its fault-tolerant
    /// directions are looked up in a table, so shares are good to about a percent: a picture, not
    /// a measurement.
    pub fn share_map(&mut self, arm: PlanarArm<'_>, radii: usize, angles: usize) -> ShareMap {
        let wrist_lengths = &arm.lengths[..arm.lengths.len() - 1];
        let [wrist_inner, wrist_outer] = annulus(wrist_lengths);
        let step = (wrist_outer - wrist_inner) / TABLE_RADII as f64;
        let wrist_radii: Vec<f64> = (0..TABLE_RADII)
            .map(|k| wrist_inner + (k as f64 + 0.5) * step)
            .collect();
        let table = self.direction_table(arm, &wrist_radii, TABLE_BEARINGS);
        let contains = |wrist: f64, beta: f64, gamma: f64| {
            let row = ((wrist - wrist_inner) / step) as usize;
            let turn = crate::angle::turn(-PI, beta) / TAU;
            let column = (turn * TABLE_BEARINGS as f64) as usize % TABLE_BEARINGS;
            wrist >= wrist_inner
                && table
                    .get(row)
                    .is_some_and(|sets| sets[column].contains(gamma))
        };
        let last = arm.lengths[arm.lengths.len() - 1];
        let unrestricted = annulus(arm.lengths);
        let edge = |k: usize| {
            unrestricted[0] + (unrestricted[1] - unrestricted[0]) * k as f64 / radii as f64
        };
        let row_of_shares = |row: usize| -> Vec<f64> {
            let r = 0.5 * (edge(row) + edge(row + 1));
            let orientations = orientations_at(r, last);
            let at = |column: usize| {
                let turned = -PI + (column as f64 + 0.5) * TAU / angles as f64;
                let tolerant = orientations
                    .iter()
                    .filter(|o| contains(o.wrist, o.bearing + turned, o.direction));
                tolerant.count() as f64 / ORIENTATIONS as f64
            };
            (0..angles).map(at).collect()
        };
        let rows: Vec<Vec<f64>> = (0..radii).into_par_iter().map(row_of_shares).collect();
        let share = rows.concat();
        ShareMap {
            unrestricted,
            radius_edges: (0..=radii).map(edge).collect(),
            angles,
            share,
        }
    }
}

/// Where the wrist is for one orientation of a tool on the x axis.
struct Orientation {
    wrist: f64,
    bearing: f64,
    /// γ = φ − bearing: the last link against the line to the wrist.
    direction: f64,
}

fn orientations_at(r: f64, last: f64) -> Vec<Orientation> {
    (0..ORIENTATIONS)
        .map(|k| {
            let phi = -PI + (k as f64 + 0.5) * TAU / ORIENTATIONS as f64;
            let wrist = r - Complex::from_polar(last, phi);
            Orientation {
                wrist: wrist.norm(),
                bearing: wrist.arg(),
                direction: phi - wrist.arg(),
            }
        })
        .collect()
}
