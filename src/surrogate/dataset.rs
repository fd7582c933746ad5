//! Labelled designs: limits and cells with their exact sets and sizes.

use super::arm::SurrogateArm;
use super::cell::{Cell, Region, draw_cells};
use super::limit_sets::{self, KEPT, Sized};
use crate::angle::{AngleSet, Arc};
use crate::objective::Design;
use crate::sampling::stream;
use crate::workspace::{ArtificialLimits, JointLimit};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Designs of a unit: what one random stream yields, and what is split off as a whole.
pub const UNIT: usize = 8 * KEPT;

/// One unit in this many is kept back from training.
const KEPT_BACK: u64 = 10;

/// Climbs that estimate the largest S_F, and their steps.
const CLIMBS: u64 = 48;
const CLIMB_STEPS: usize = 400;

/// Random streams of the climbs and of held-out designs lie far from those of training designs.
const CLIMB_STREAM: u64 = 1 << 40;
const HELD_OUT_STREAM: u64 = 1 << 41;

/// Whether designs are for learning from or for judging what was learnt.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Draw {
    /// To learn from.
    Training,
    /// To judge by; never overlaps the training designs of any seed.
    HeldOut,
}

/// How designs are drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recipe {
    /// Seed of every random stream.
    pub seed: u64,
    /// For learning or for judging.
    pub draw: Draw,
    /// Units of uniform limits.
    pub uniform_units: u64,
    /// Units of threshold walks.
    pub walk_units: u64,
    /// Cells per design; about as many for poses. None for surrogates of the size alone.
    pub cells: usize,
    /// Where the cells lie.
    pub region: Region,
}

/// How a design was drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Origin {
    /// Uniform limits.
    Uniform,
    /// A step of a threshold walk.
    Walk,
}

/// A design with its labels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Labelled {
    /// Ends of the limits of every joint, radians.
    limits: Vec<[f64; 2]>,
    lengths: Vec<f64>,
    /// S_F.
    pub size: f64,
    /// How it was drawn.
    pub origin: Origin,
    /// Where its cells are.
    cells: [u32; 2],
}

/// Labelled designs of one unit or many.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Dataset {
    designs: Vec<Labelled>,
    cells: Vec<Cell>,
    /// Where the arcs of a cell end; they start where those of the cell before end.
    ends: Vec<u32>,
    /// Start and width of the arcs of the pre-failure sets, radians.
    arcs: Vec<[f32; 2]>,
}

/// Shares of what has no fault-tolerant workspace at all.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Emptiness {
    /// Number of designs.
    pub designs: usize,
    /// Share of designs with S_F = 0.
    pub empty_designs: f64,
    /// Share of cells whose fault-tolerant set is empty.
    pub empty_cells: f64,
    /// Largest S_F.
    pub largest: f64,
}

impl Recipe {
    /// Number of units.
    pub fn units(&self) -> u64 {
        self.uniform_units + self.walk_units
    }

    /// Whether a unit is kept back from training, to stop it and to fit decoders: one in ten of
    /// its kind.
    pub fn is_kept_back(&self, unit: u64) -> bool {
        let of_kind = if unit < self.uniform_units {
            unit
        } else {
            unit - self.uniform_units
        };
        of_kind % KEPT_BACK == 0
    }

    fn first_stream(&self) -> u64 {
        match self.draw {
            Draw::Training => 0,
            Draw::HeldOut => HELD_OUT_STREAM,
        }
    }

    /// The designs of one unit with all their labels. `largest` is the largest known S_F/S_0max.
    pub fn build_unit(&self, arm: &SurrogateArm, largest: f64, unit: u64) -> Dataset {
        let mut generator = stream(self.seed, self.first_stream() + unit);
        let (origin, drawn): (Origin, Vec<Sized>) = if unit < self.uniform_units {
            let designs = (0..UNIT).map(|_| limit_sets::uniform(arm, &mut generator));
            (Origin::Uniform, designs.collect())
        } else {
            let walks = UNIT / KEPT;
            let walks =
                (0..walks).flat_map(|_| limit_sets::threshold_walk(arm, largest, &mut generator));
            (Origin::Walk, walks.collect())
        };
        let mut dataset = Dataset::default();
        for sized in drawn {
            let cells = match self.cells {
                0 => Vec::new(),
                count => {
                    let locked = arm.locked_joints(&sized.design);
                    draw_cells(arm, &locked, self.region, count, &mut generator)
                }
            };
            dataset.push(arm, &sized, origin, &cells);
        }
        dataset
    }
}

/// The largest S_F/S_0max that climbing from uniform limits finds: a scale for thresholds, no
/// optimum.
pub fn largest_known(arm: &SurrogateArm, seed: u64) -> f64 {
    let climb = |k| limit_sets::climb(arm, CLIMB_STEPS, &mut stream(seed, CLIMB_STREAM + k));
    let shares: Vec<f64> = (0..CLIMBS).into_par_iter().map(climb).collect();
    shares.into_iter().fold(0.0, f64::max)
}

impl Dataset {
    fn push(&mut self, arm: &SurrogateArm, sized: &Sized, origin: Origin, cells: &[Cell]) {
        let first = self.cells.len() as u32;
        for set in arm.pre_failure_sets(&sized.design, cells) {
            let arcs = set.arcs().iter();
            self.arcs
                .extend(arcs.map(|arc| [arc.start() as f32, arc.width() as f32]));
            self.ends.push(self.arcs.len() as u32);
        }
        self.cells.extend_from_slice(cells);
        let joints = sized.design.limits.joints();
        self.designs.push(Labelled {
            limits: joints.iter().map(|l| [l.lower, l.upper]).collect(),
            lengths: sized.design.lengths.clone(),
            size: sized.size,
            origin,
            cells: [first, self.cells.len() as u32],
        });
    }

    /// Appends another dataset.
    pub fn append(&mut self, other: Dataset) {
        let (cells, arcs) = (self.cells.len() as u32, self.arcs.len() as u32);
        self.designs
            .extend(other.designs.into_iter().map(|design| Labelled {
                cells: design.cells.map(|cell| cell + cells),
                ..design
            }));
        self.cells.extend(other.cells);
        self.ends
            .extend(other.ends.into_iter().map(|end| end + arcs));
        self.arcs.extend(other.arcs);
    }

    /// The designs.
    pub fn designs(&self) -> &[Labelled] {
        &self.designs
    }

    /// All cells, design by design.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// Which cells belong to a design.
    pub fn cells_of(&self, design: usize) -> std::ops::Range<usize> {
        let [first, end] = self.designs[design].cells;
        first as usize..end as usize
    }

    /// The exact pre-failure set of a cell.
    pub fn pre_failure_set(&self, cell: usize) -> AngleSet {
        let start = cell.checked_sub(1).map_or(0, |before| self.ends[before]);
        let arcs = &self.arcs[start as usize..self.ends[cell] as usize];
        let arc = |&[start, width]: &[f32; 2]| Arc::new(f64::from(start), f64::from(width));
        AngleSet::from_arcs(arcs.iter().map(arc))
    }

    /// The laws of the type: every design's cells and every cell's arcs are there.
    pub fn is_consistent(&self, joints: usize) -> bool {
        let sorted = self.ends.is_sorted() && self.ends.len() == self.cells.len();
        let last = self.ends.last().copied().unwrap_or(0);
        let mut next = 0;
        let chained = self.designs.iter().all(|design| {
            let follows = design.cells[0] == next && design.cells[0] <= design.cells[1];
            next = design.cells[1];
            let finite = design.limits.iter().flatten().all(|end| end.is_finite());
            follows
                && finite
                && design.size.is_finite()
                && design.limits.len() == joints
                && design.lengths.len() == joints
        });
        let sound = |x: f64| x.is_finite();
        sorted
            && chained
            && next as usize == self.cells.len()
            && last as usize == self.arcs.len()
            && self.arcs.iter().flatten().all(|x| sound(f64::from(*x)))
            && self
                .cells
                .iter()
                .all(|c| sound(c.radius) && sound(c.bearing))
    }

    /// How much of the data has no fault-tolerant workspace, for designs of one origin.
    pub fn emptiness(&self, arm: &SurrogateArm, origin: Origin) -> Emptiness {
        let chosen: Vec<usize> = (0..self.designs.len())
            .filter(|&k| self.designs[k].origin == origin)
            .collect();
        let cells = |&k: &usize| {
            let locked = arm.locked_joints(&self.designs[k].design());
            let empty = self.cells_of(k).filter(|&cell| {
                let post = arm.post_failure_set(&locked, &self.cells[cell]);
                self.pre_failure_set(cell).overlap(&post) <= 0.0
            });
            [empty.count(), self.cells_of(k).len()]
        };
        let counts: Vec<[usize; 2]> = chosen.par_iter().map(cells).collect();
        let sum = |k: usize| counts.iter().map(|count| count[k]).sum::<usize>() as f64;
        let sizes = || chosen.iter().map(|&k| self.designs[k].size);
        Emptiness {
            designs: chosen.len(),
            empty_designs: sizes().filter(|&s| s <= 0.0).count() as f64
                / chosen.len().max(1) as f64,
            empty_cells: sum(0) / sum(1).max(1.0),
            largest: sizes().fold(0.0, f64::max),
        }
    }
}

impl Labelled {
    /// The limits and lengths.
    pub fn design(&self) -> Design {
        let limit = |&[lower, upper]: &[f64; 2]| JointLimit::new(lower, upper);
        Design {
            limits: ArtificialLimits::new(self.limits.iter().map(limit).collect()),
            lengths: self.lengths.clone(),
        }
    }
}
