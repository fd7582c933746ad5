//! Cells: the task points at which surrogates predict sets of angles.
//!
//! Turning about joint 1 changes nothing but β, so the cells of a position task are radii, and a
//! cell's set is that of the fault-tolerant β. The cells of a planar pose task are a wrist radius
//! and bearing (r, β); turning about joint n changes only the direction γ of the last link, and a
//! cell's set is that of the fault-tolerant γ.

use super::arm::SurrogateArm;
use crate::angle::AngleSet;
use crate::workspace::planar::LockedJoints;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Bearings of a pose task share one radius in groups of this size, because the exact sets of one
/// radius cost little more than one of them.
const BEARINGS: usize = 4;

/// A cell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// Distance of the task point (poses: of the wrist) from joint 1, metres.
    pub radius: f64,
    /// Poses: polar angle β of the wrist, radians. Positions: 0.
    pub bearing: f64,
}

/// Radii from which cells are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Region {
    /// The whole reach of the arm, as in [S3].
    Reach,
    /// The radii common to W₂ … W_n.
    Gate,
}

/// About `count` random cells, one in each of as many equal shares of the radii; none if there
/// are no radii.
pub fn draw_cells(
    arm: &SurrogateArm,
    locked: &LockedJoints,
    region: Region,
    count: usize,
    generator: &mut ChaCha8Rng,
) -> Vec<Cell> {
    let [inner, outer] = match region {
        Region::Reach => locked.reach(),
        Region::Gate => locked.radii(),
    };
    if inner >= outer {
        return Vec::new();
    }
    let rows = if arm.pose {
        count.div_ceil(BEARINGS)
    } else {
        count
    };
    let mut cells = Vec::with_capacity(count);
    for row in 0..rows {
        let share = (row as f64 + generator.random::<f64>()) / rows as f64;
        let radius = inner + share * (outer - inner);
        if !arm.pose {
            cells.push(Cell {
                radius,
                bearing: 0.0,
            });
            continue;
        }
        let allowed = match region {
            Region::Reach => AngleSet::full(),
            Region::Gate => locked.bearings(radius),
        };
        for k in 0..BEARINGS {
            let share = (k as f64 + generator.random::<f64>()) / BEARINGS as f64;
            if let Some(bearing) = angle_at_share(&allowed, share) {
                cells.push(Cell { radius, bearing });
            }
        }
    }
    cells
}

/// The angle below which `share` of the set's measure lies, counted along its arcs.
pub(super) fn angle_at_share(set: &AngleSet, share: f64) -> Option<f64> {
    let mut rest = share * set.measure();
    for arc in set.arcs() {
        if rest <= arc.width() {
            return Some(crate::angle::wrap(arc.start() + rest));
        }
        rest -= arc.width();
    }
    set.arcs().last().map(|arc| crate::angle::wrap(arc.end()))
}

/// Cells with weights such that Σ weight · |set| approximates S_F.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Quadrature {
    /// The nodes; of pose tasks in rows of one radius.
    pub cells: Vec<Cell>,
    /// Weight of every node: r Δr, for poses r Δr Δβ.
    pub weights: Vec<f64>,
}

impl Quadrature {
    /// The midpoint rule over the radii common to W₂ … W_n in `radii` steps of r², for poses with
    /// `bearings` steps on the β that W₁ allows. [S3] steps over the reach in r instead, which
    /// misses the jumps at the ends of the common radii.
    pub fn inside_gate(
        arm: &SurrogateArm,
        locked: &LockedJoints,
        radii: usize,
        bearings: usize,
    ) -> Quadrature {
        let [inner, outer] = locked.radii();
        let mut rule = Quadrature::default();
        if inner >= outer {
            return rule;
        }
        let step = (outer * outer - inner * inner) / radii as f64;
        for k in 0..radii {
            let radius = (inner * inner + (k as f64 + 0.5) * step).sqrt();
            rule.add_row(arm, locked, radius, 0.5 * step, bearings);
        }
        rule
    }

    /// The midpoint rule over the reach in `radii` steps of r [S3 eq. 9].
    pub fn over_reach(
        arm: &SurrogateArm,
        locked: &LockedJoints,
        radii: usize,
        bearings: usize,
    ) -> Quadrature {
        let [inner, outer] = locked.reach();
        let step = (outer - inner) / radii as f64;
        let mut rule = Quadrature::default();
        for k in 0..radii {
            let radius = inner + (k as f64 + 0.5) * step;
            rule.add_row(arm, locked, radius, radius * step, bearings);
        }
        rule
    }

    fn add_row(
        &mut self,
        arm: &SurrogateArm,
        locked: &LockedJoints,
        radius: f64,
        weight: f64,
        bearings: usize,
    ) {
        if !arm.pose {
            self.cells.push(Cell {
                radius,
                bearing: 0.0,
            });
            self.weights.push(weight);
            return;
        }
        let allowed = locked.bearings(radius);
        let measure = allowed.measure();
        if measure <= 0.0 {
            return;
        }
        let count = ((bearings as f64 * measure / TAU).ceil() as usize).max(1);
        for k in 0..count {
            let share = (k as f64 + 0.5) / count as f64;
            let bearing = angle_at_share(&allowed, share).unwrap_or(-PI);
            self.cells.push(Cell { radius, bearing });
            self.weights.push(weight * measure / count as f64);
        }
    }

    /// Σ weight · |set|.
    pub fn sum(&self, sets: &[AngleSet]) -> f64 {
        let terms = self.weights.iter().zip(sets);
        terms.map(|(weight, set)| weight * set.measure()).sum()
    }
}
