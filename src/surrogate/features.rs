//! What a network sees of a design and a cell.

use super::arm::SurrogateArm;
use super::cell::Cell;
use crate::objective::Design;
use crate::workspace::JointLimit;
use crate::workspace::planar::LockedJoints;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// How limits and cells are written as inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Encoding {
    /// Ends of the limits and radius, scaled to about one, as in [S3].
    Raw,
    /// Sines and cosines of the ends, widths, and what is known in closed form: the radii common
    /// to W₂ … W_n and the angles of W₁ and W_n.
    Trigonometric,
}

/// The inputs of a network for one arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Features {
    encoding: Encoding,
    arm: SurrogateArm,
    with_cell: bool,
}

/// Radii, as shares of the common ones, at which a design without a cell is described.
const PROBES: [f64; 3] = [0.0, 0.5, 1.0];

impl Features {
    /// Inputs for designs with cells, or without for surrogates of the size.
    pub fn new(arm: &SurrogateArm, encoding: Encoding, with_cell: bool) -> Features {
        Features {
            encoding,
            arm: arm.clone(),
            with_cell,
        }
    }

    /// Number of inputs.
    pub fn count(&self) -> usize {
        let n = self.arm.joints();
        let centred = (0..n).filter(|&k| self.arm.is_centred(k)).count();
        let links = if self.arm.link_bounds.is_some() { n } else { 0 };
        let pose = usize::from(self.arm.pose);
        let cell = usize::from(self.with_cell);
        match self.encoding {
            Encoding::Raw => centred + 2 * (n - centred) + links + cell * (1 + 2 * pose),
            Encoding::Trigonometric => {
                let limits = 3 * centred + 5 * (n - centred) + links + 2;
                let described = if self.with_cell { 1 } else { PROBES.len() };
                let chains = described * 4 * (1 + pose);
                limits + chains + cell * (2 + 2 * pose)
            }
        }
    }

    /// Writes the inputs of a design, with a cell if the network sees one, mirrored if asked to:
    /// the mirror image of an arm has the limits −A and the cell's bearing −β.
    ///
    /// `row` has [`Features::count`] entries.
    pub fn write(
        &self,
        design: &Design,
        locked: &LockedJoints,
        cell: Option<&Cell>,
        mirrored: bool,
        row: &mut [f32],
    ) {
        let mut inputs = Inputs { row, next: 0 };
        let total: f64 = design.lengths.iter().sum();
        let sign = if mirrored { -1.0 } else { 1.0 };
        for (k, limit) in design.limits.joints().iter().enumerate() {
            self.write_limit(limit, self.arm.is_centred(k), mirrored, &mut inputs);
        }
        if self.arm.link_bounds.is_some() {
            for length in &design.lengths {
                inputs.push(length / total);
            }
        }
        match self.encoding {
            Encoding::Raw => {
                if let Some(cell) = cell {
                    inputs.push(cell.radius / total);
                    if self.arm.pose {
                        inputs.push(cell.bearing.cos());
                        inputs.push(sign * cell.bearing.sin());
                    }
                }
            }
            Encoding::Trigonometric => {
                let [inner, outer] = locked.radii();
                inputs.push(inner / total);
                inputs.push(outer / total);
                let span = (outer - inner).max(1e-12);
                match cell {
                    Some(cell) => {
                        self.write_chains(locked, cell.radius, &mut inputs);
                        inputs.push((cell.radius - inner) / span);
                        inputs.push(cell.radius / total);
                        if self.arm.pose {
                            inputs.push(cell.bearing.cos());
                            inputs.push(sign * cell.bearing.sin());
                        }
                    }
                    None => {
                        for share in PROBES {
                            self.write_chains(locked, inner + share * span, &mut inputs);
                        }
                    }
                }
            }
        }
        debug_assert_eq!(inputs.next, inputs.row.len());
    }

    fn write_limit(
        &self,
        limit: &JointLimit,
        centred: bool,
        mirrored: bool,
        inputs: &mut Inputs<'_>,
    ) {
        let [lower, upper] = match mirrored {
            true => [-limit.upper, -limit.lower],
            false => [limit.lower, limit.upper],
        };
        match (self.encoding, centred) {
            (Encoding::Raw, true) => inputs.push(limit.width() / TAU),
            (Encoding::Raw, false) => {
                inputs.push(lower / PI);
                inputs.push(upper / PI);
            }
            (Encoding::Trigonometric, true) => {
                inputs.push(limit.width() / TAU);
                inputs.push_angle(0.5 * limit.width());
            }
            (Encoding::Trigonometric, false) => {
                inputs.push(limit.width() / TAU);
                inputs.push_angle(lower);
                inputs.push_angle(upper);
            }
        }
    }

    /// The bearings Φ that the chain behind joint 1 leaves at `radius`, and for poses the same
    /// from joint n's side: cosines of its two half-angles and the angles as shares of π.
    fn write_chains(&self, locked: &LockedJoints, radius: f64, inputs: &mut Inputs<'_>) {
        let chains = locked.half_angles(radius);
        for [hole, out] in chains.into_iter().take(1 + usize::from(self.arm.pose)) {
            inputs.push(hole.cos());
            inputs.push(hole / PI);
            inputs.push(out.cos());
            inputs.push(out / PI);
        }
    }
}

struct Inputs<'a> {
    row: &'a mut [f32],
    next: usize,
}

impl Inputs<'_> {
    fn push(&mut self, value: f64) {
        self.row[self.next] = value as f32;
        self.next += 1;
    }

    fn push_angle(&mut self, angle: f64) {
        let (sin, cos) = angle.sin_cos();
        self.push(sin);
        self.push(cos);
    }
}
