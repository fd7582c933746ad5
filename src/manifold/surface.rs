//! The pre-image of one task point with two or three degrees of redundancy: a surface, known by
//! curves on it.
//!
//! Holding one or two joints at each value of a grid leaves robots with one degree of redundancy,
//! whose self-motion manifolds are slices of the surface. What is asked of the surface are sets of
//! angles ([`Surface::ranges`]), which need no mesh of it. A part that lies between all slices is
//! found only if a random start lands on it; [`Surface::evidence`] tells how much may be missing.

use super::any_solver::AnySolver;
use super::ascent::Ascent;
use super::bounds::physical_arcs;
use super::cuts::{Cuts, Held};
use super::pre_image::{ManifoldError, PreImageSearch, is_beyond};
use super::self_motion::SelfMotionManifold;
use super::{Completeness, SearchSettings};
use crate::angle::{AngleSet, Arc};
use crate::design::{Robot, TaskSpace};
use crate::kinematics::{Chain, Goal};
use crate::sampling::stream;
use nalgebra::Isometry3;
use rayon::prelude::*;

/// Random starts on the whole surface for every one of a slice: they are cheap beside slices.
const STARTS: usize = 4;

/// Random streams of slices begin here; those below are for starts on the whole surface.
const SLICES: u64 = 1 << 32;

/// The stream of slices that are looked at and forgotten: the same starts serve for all.
const LOCKS: u64 = 1 << 40;

/// How far outside a set an angle counts as missing, radians: the accuracy of its ends.
const MISSING: f64 = 1e-3;

/// Curves of the surface along which some joints stand still.
#[derive(Clone, Debug)]
pub struct SurfaceSlice {
    /// The joints that are held (from 0, ascending) with their internal variables.
    pub held: Vec<(usize, f64)>,
    /// The curves, with all joints of the robot.
    pub curves: Vec<SelfMotionManifold>,
    /// Whether every check of completeness passed.
    pub is_sound: bool,
    /// Random starts made.
    pub seeds: usize,
}

/// What random starts on the whole surface tell about the sets found on its slices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceEvidence {
    /// Random starts.
    pub starts: usize,
    /// Those that landed on the surface inside the limits asked about.
    pub landed: usize,
    /// Those of them with a joint outside its set.
    pub outside: usize,
}

/// Finds surfaces of one robot and task.
#[derive(Clone, Debug)]
pub struct SurfaceSearch {
    pub(super) chain: Chain,
    pub(super) task: TaskSpace,
    pub(super) cuts: Cuts,
    pub(super) ascent: Ascent,
    settings: SearchSettings,
    physical: Vec<Arc>,
}

impl SurfaceSearch {
    /// A search for `robot` with two or three joints more than `task` has dimensions; `slices`
    /// values of each joint that is held.
    ///
    /// # Errors
    /// Another degree of redundancy, a prismatic joint without limits, or an arm that cannot do
    /// the task anywhere.
    pub fn new(
        robot: &Robot,
        task: TaskSpace,
        slices: usize,
        settings: SearchSettings,
    ) -> Result<SurfaceSearch, ManifoldError> {
        let chain = Chain::new(robot).ok_or(ManifoldError::Unlimited)?;
        let degree = robot.degree_of_redundancy(task);
        let ascent = Ascent::new(&chain, task).ok_or_else(|| ManifoldError::Redundancy {
            joints: chain.len(),
            dimension: task.dimension(),
            degree,
            wanted: "2 or 3",
        })?;
        let physical = physical_arcs(robot);
        let search = SurfaceSearch {
            cuts: Cuts::new(physical.clone(), degree as usize, slices.max(1)),
            chain,
            task,
            ascent,
            settings,
            physical,
        };
        search.check_rank()?;
        Ok(search)
    }

    /// Whether some slice can do the task.
    fn check_rank(&self) -> Result<(), ManifoldError> {
        let ranks = self.cuts.grid().into_iter().take(3).map(|held| {
            let solver = AnySolver::new(&self.held(&held), self.task);
            solver.map_or(0, |solver| solver.rank())
        });
        let (rank, dimension) = (ranks.max().unwrap_or(0), self.task.dimension());
        match rank < dimension {
            true => Err(ManifoldError::Degenerate {
                task: self.task,
                rank,
                dimension,
            }),
            false => Ok(()),
        }
    }

    /// The chain whose internal joint variables the curves have.
    pub fn chain(&self) -> &Chain {
        &self.chain
    }

    /// The joints (from 0) that the slices of the grid hold.
    pub fn held_joints(&self) -> &[usize] {
        &self.cuts.cut
    }

    /// The surface of the tool pose `tool` (world frame), cut over the grid.
    pub fn find(&self, tool: &Isometry3<f64>, seed: u64) -> Surface<'_> {
        let mut surface = Surface {
            search: self,
            tool: *tool,
            goal: Goal::new(&self.chain, tool),
            seed,
            traced: 0,
            is_out_of_reach: is_beyond(&self.chain, self.task, tool),
            slices: Vec::new(),
            grid: 0,
            starts: 0,
            landings: Vec::new(),
            seeds: 0,
            failed: 0,
        };
        if surface.is_out_of_reach || !tool.translation.vector.iter().all(|x| x.is_finite()) {
            return surface;
        }
        surface.starts = STARTS * self.settings.least_seeds;
        surface.landings = surface.land(0);
        if !surface.landings.is_empty() {
            surface.slices = surface.trace(self.cuts.grid());
            surface.grid = surface.slices.len();
        }
        surface
    }

    fn held(&self, held: &Held) -> Chain {
        let chain = self.chain.clone();
        let lock = |chain: Chain, &(joint, value): &(usize, f64)| chain.locked(joint, value);
        // From the last joint on, so that numbers of the others stay what they are.
        held.iter().rev().fold(chain, lock)
    }

    /// `None` if the robot cannot do the task with these joints held.
    fn slice(
        &self,
        held: Held,
        tool: &Isometry3<f64>,
        seed: u64,
        item: u64,
    ) -> Option<SurfaceSlice> {
        let chain = self.held(&held);
        let mut search = PreImageSearch::from_chain(chain, self.task, self.settings).ok()?;
        let found = search.find(tool, &mut stream(seed, SLICES + item));
        let curves = found.manifolds.iter();
        Some(SurfaceSlice {
            curves: curves.map(|curve| lifted(curve, &held)).collect(),
            is_sound: found.completeness != Completeness::Unknown,
            seeds: found.seeds,
            held,
        })
    }
}

/// The surface of one task point.
#[derive(Clone, Debug)]
pub struct Surface<'s> {
    pub(super) search: &'s SurfaceSearch,
    pub(super) tool: Isometry3<f64>,
    pub(super) goal: Goal<f64>,
    seed: u64,
    /// Slices traced so far: the number of the next one's random stream.
    traced: u64,
    /// Whether the task point is farther away than all links together reach.
    pub is_out_of_reach: bool,
    /// The slices: those of the grid, and behind them those through configurations that random
    /// starts found outside the sets of the others.
    pub slices: Vec<SurfaceSlice>,
    /// How many of them are the grid's.
    pub grid: usize,
    /// Random starts made on the whole surface.
    pub starts: usize,
    /// Where they landed.
    pub landings: Vec<Vec<f64>>,
    /// Random starts made on slices, also those traced for [`Surface::ranges`] alone.
    pub seeds: usize,
    /// Slices with curves of which a check failed.
    pub failed: usize,
}

impl<'s> Surface<'s> {
    /// Physical limits of every joint, as arcs of internal joint variables.
    pub fn physical(&self) -> &'s [Arc] {
        &self.search.physical
    }

    /// Traces slices.
    pub(super) fn trace(&mut self, cuts: Vec<Held>) -> Vec<SurfaceSlice> {
        let (search, tool, seed, first) = (self.search, &self.tool, self.seed, self.traced);
        self.traced += cuts.len() as u64;
        let slices: Vec<SurfaceSlice> = cuts
            .into_par_iter()
            .enumerate()
            .filter_map(|(k, held)| search.slice(held, tool, seed, first + k as u64))
            .collect();
        self.seeds += slices.iter().map(|slice| slice.seeds).sum::<usize>();
        self.failed += slices.iter().filter(|slice| !slice.is_sound).count();
        slices
    }

    /// Random starts on the whole surface, by the random stream `item`.
    fn land(&self, item: u64) -> Vec<Vec<f64>> {
        let mut rng = stream(self.seed, item);
        self.search
            .ascent
            .landings(&self.goal, self.starts, &mut rng)
    }

    /// The angles that every joint takes on the part of the surface inside `bounds`, arcs of
    /// internal joint variables.
    ///
    /// A set begins as the union over the curves inside; the faces of the box, on which sets have
    /// their ends, are traced as well. Every end is then walked on to where the joint's angle is
    /// stationary on the surface or on a face. Gaps that are narrow enough to be an artefact of the
    /// grid are looked into by a slice through their middle, and what random starts have found
    /// outside the sets is cut through too.
    pub fn ranges(&mut self, bounds: &[Arc]) -> Vec<AngleSet> {
        let all: Vec<usize> = (0..bounds.len()).collect();
        self.ranges_of(&all, bounds)
    }

    /// As [`Surface::ranges`], of the joint `joint` (from 0) alone.
    pub fn range(&mut self, joint: usize, bounds: &[Arc]) -> AngleSet {
        self.ranges_of(&[joint], bounds).swap_remove(0)
    }

    /// The angles of `other` on the part of the surface inside `bounds` where `joint` is held at
    /// `value` (internal variables, joints from 0), to the accuracy of the grid.
    pub fn range_where(
        &self,
        other: usize,
        (joint, value): (usize, f64),
        bounds: &[Arc],
    ) -> AngleSet {
        let cuts = self.search.cuts.through(joint, value).into_iter();
        let slices = cuts.filter_map(|held| self.search.slice(held, &self.tool, self.seed, LOCKS));
        let arcs = slices.flat_map(|slice| slice.arcs_inside(other, bounds));
        AngleSet::from_arcs(arcs)
    }

    /// What fresh random starts tell about `sets`, the ranges of the joints `of` inside `bounds`.
    pub fn evidence(&self, of: &[usize], sets: &[AngleSet], bounds: &[Arc]) -> SurfaceEvidence {
        let landed: Vec<Vec<f64>> = match self.landings.is_empty() {
            true => Vec::new(),
            false => self.land(1),
        };
        let inside = landed
            .iter()
            .filter(|theta| lies_inside(theta, bounds, 0.0));
        SurfaceEvidence {
            starts: self.starts,
            landed: inside.clone().count(),
            outside: inside.filter(|theta| is_missing(theta, of, sets)).count(),
        }
    }
}

/// Whether every joint lies in its arc, or at most `slack` beyond.
pub(super) fn lies_inside(theta: &[f64], bounds: &[Arc], slack: f64) -> bool {
    let mut pairs = theta.iter().zip(bounds);
    pairs.all(|(&angle, bound)| bound.contains_within(angle, slack))
}

/// Whether a joint of `of` lies outside its set.
pub(super) fn is_missing(theta: &[f64], of: &[usize], sets: &[AngleSet]) -> bool {
    let holds = |set: &AngleSet, angle: f64| {
        let mut arcs = set.arcs().iter();
        arcs.any(|arc| arc.contains_within(angle, MISSING))
    };
    of.iter()
        .zip(sets)
        .any(|(&joint, set)| !holds(set, theta[joint]))
}

/// The curve with the joints that were held put back.
fn lifted(curve: &SelfMotionManifold, held: &Held) -> SelfMotionManifold {
    let spread = |values: &[f64], value: &dyn Fn(f64) -> f64| -> Vec<f64> {
        let rows = values.chunks_exact(curve.joints);
        rows.flat_map(|row| {
            let mut row = row.to_vec();
            for &(joint, at) in held {
                row.insert(joint, value(at));
            }
            row
        })
        .collect()
    };
    let mut winding = curve.winding.clone();
    for &(joint, _) in held {
        winding.insert(joint, 0);
    }
    SelfMotionManifold {
        joints: curve.joints + held.len(),
        points: spread(&curve.points, &|at| at),
        tangents: spread(&curve.tangents, &|_| 0.0),
        winding,
        crossings: curve.crossings.clone(),
        ..*curve
    }
}
