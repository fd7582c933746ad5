//! Pre-images of two or more dimensions, cut into curves.
//!
//! Fixing one joint at each value of a grid leaves a robot with one degree of redundancy less;
//! down to one, where the slices are curves. Only joint ranges ([`super::extents`]) and images of
//! boxes are wanted, not the surface itself.

use super::any_solver::AnySolver;
use super::ascent::Ascent;
use super::extents::{self, Extent};
use super::lift::Lift;
use super::solver::{BATCH, Job, SearchSettings};
use super::source::{CurveRef, Pose};
use crate::angle::{AngleSet, Arc};
use crate::design::TaskSpace;
use crate::kinematics::{Chain, Goal};
use nalgebra::Isometry3;

/// Slices times task points that are searched together: some tens of megabytes of curves.
const MOST_AT_ONCE: usize = 512;

/// A family of curves: some joints fixed, the others free.
#[derive(Clone, Debug)]
struct Slice {
    /// Fixed joints (from 0, ascending) with their values.
    fixed: Vec<(usize, f64)>,
    chain: Chain,
    solver: AnySolver,
}

/// The pre-image as slices over a grid of values of some joints.
#[derive(Clone, Debug)]
pub(super) struct Sliced {
    joints: usize,
    chain: Chain,
    task: TaskSpace,
    ascent: Ascent,
    /// The joints that are fixed, ascending.
    pub cut: Vec<usize>,
    /// Values a joint takes.
    per_joint: usize,
    slices: Vec<Slice>,
    settings: SearchSettings,
    pub seeds: usize,
    pub sound: bool,
    extents: Vec<Extent>,
    /// Where each task point of the batch was first reached; `None` if it is out of reach.
    landed: Vec<Option<Vec<f64>>>,
    /// Physical limits of every joint.
    bounds: Vec<Arc>,
    /// The walls of their box, if a joint from 2 on has any: the surface inside may lie between
    /// the slices, and ranges have their ends there.
    walls: Option<Faces>,
}

impl Sliced {
    /// `None` if the degree of redundancy is not 2 or 3. `bounds` are the physical limits.
    pub fn new(
        chain: &Chain,
        bounds: Vec<Arc>,
        task: TaskSpace,
        per_joint: usize,
        settings: SearchSettings,
    ) -> Option<Sliced> {
        let joints = chain.len();
        let degree = joints.checked_sub(task.dimension())?;
        let ascent = Ascent::new(chain, task)?;
        // The joints in the middle: neither joint 1, whose angle is the image that is wanted,
        // nor the last one, on which position tasks depend least.
        let first = 1 + (joints - degree) / 2;
        let cut: Vec<usize> = (first..first + degree - 1).collect();
        let mut sliced = Sliced {
            joints,
            chain: chain.clone(),
            task,
            ascent,
            per_joint,
            slices: Vec::new(),
            settings: sparse(settings),
            seeds: 0,
            sound: true,
            extents: Vec::new(),
            landed: Vec::new(),
            bounds,
            walls: None,
            cut,
        };
        let mut fixed = Vec::new();
        sliced.lay_out(&mut fixed);
        if sliced.is_bounded() {
            let end = |arc: &Arc| (!arc.is_full()).then(|| [arc.start(), arc.end()]);
            let ends: Vec<_> = sliced.bounds.iter().map(end).collect();
            sliced.walls = Some(sliced.faces(&ends));
        }
        Some(sliced)
    }

    /// Whether a joint from 2 on has physical limits.
    fn is_bounded(&self) -> bool {
        !self.bounds.iter().skip(1).all(Arc::is_full)
    }

    /// Distance between neighbouring slices along `joint`, radians; 0 if it is not cut.
    pub fn spacing(&self, joint: usize) -> f64 {
        match self.cut.contains(&joint) {
            true => self.bounds[joint].width() / self.per_joint as f64,
            false => 0.0,
        }
    }

    fn lay_out(&mut self, fixed: &mut Vec<(usize, f64)>) {
        if fixed.len() == self.cut.len() {
            let slice = self.slice(fixed);
            self.slices.extend(slice);
            return;
        }
        let joint = self.cut[fixed.len()];
        for k in 0..self.values(joint) {
            fixed.push((joint, self.grid_value(joint, k)));
            self.lay_out(fixed);
            fixed.pop();
        }
    }

    /// How many values of `joint` the grid has.
    fn values(&self, joint: usize) -> usize {
        // Limits of width 0 leave it one.
        match self.bounds[joint].width() > 0.0 {
            true => self.per_joint,
            false => 1,
        }
    }

    /// Value number `k` of the grid along a joint, within its physical limits.
    fn grid_value(&self, joint: usize, k: usize) -> f64 {
        let bound = &self.bounds[joint];
        bound.start() + bound.width() * (k as f64 + 0.5) / self.values(joint) as f64
    }

    fn slice(&self, fixed: &[(usize, f64)]) -> Option<Slice> {
        let mut fixed = fixed.to_vec();
        fixed.sort_by_key(|&(joint, _)| joint);
        let mut chain = self.chain.clone();
        for &(joint, value) in fixed.iter().rev() {
            chain = chain.locked(joint, value);
        }
        Some(Slice {
            solver: AnySolver::new(&chain, self.task)?,
            chain,
            fixed,
        })
    }

    /// Task points that are best searched at once. All their curves are kept until they are
    /// shown, so the more slices, the fewer.
    pub fn batch(&self) -> usize {
        (MOST_AT_ONCE / self.slices.len().max(1)).clamp(1, BATCH)
    }

    /// Finds the curves of all slices of many task points; see [`Sliced::show`].
    pub fn search_all(&mut self, poses: &mut [Pose]) {
        let starts = self.settings.unreachable_after * 2;
        self.landed.clear();
        for (tool, rng) in poses.iter_mut() {
            // Out of reach of the whole robot: no slice needs to be searched.
            let whole = Goal::new(&self.chain, tool);
            self.landed.push(self.ascent.land(&whole, starts, rng));
        }
        for slice in &mut self.slices {
            let pairs = poses.iter_mut().zip(&self.landed);
            let reached = pairs.filter_map(|(pose, landed)| landed.as_ref().map(|_| pose));
            slice.search(reached, &self.settings);
        }
    }

    /// Shows the curves of task point `index` of the last batch, to be given once more, and gathers
    /// joint ranges. With physical limits of joints from 2 on the ranges are empty: see
    /// [`Sliced::ranges`].
    pub fn show(
        &mut self,
        index: usize,
        pose: &mut Pose,
        show: &mut dyn FnMut(CurveRef<'_>),
    ) -> Vec<AngleSet> {
        self.seeds = 0;
        self.sound = true;
        self.extents.clear();
        let Some(landed) = self.landed[index].clone() else {
            return vec![AngleSet::empty(); self.joints];
        };
        // Its place among those within reach.
        let seat = self.landed[..index].iter().flatten().count();
        let mut slices = std::mem::take(&mut self.slices);
        for slice in &mut slices {
            slice.solver.turn_to(seat);
            self.show_slice(slice, show);
        }
        self.slices = slices;
        if self.extents.is_empty() {
            // A small pre-image between the slices: cut it where it was found.
            let fixed: Vec<_> = self
                .cut
                .iter()
                .map(|&joint| (joint, landed[joint]))
                .collect();
            if let Some(mut slice) = self.slice(&fixed) {
                slice.search(std::iter::once(&mut *pose), &self.settings);
                self.show_slice(&slice, show);
            }
        }
        if self.is_bounded() {
            return vec![AngleSet::empty(); self.joints];
        }
        self.ranges(&pose.0, &self.extents)
    }

    fn show_slice(&mut self, slice: &Slice, show: &mut dyn FnMut(CurveRef<'_>)) {
        self.seeds += slice.solver.effort().0;
        self.sound &= slice.solver.is_sound();
        let mut lift = Lift::default();
        slice.solver.show(|curve| {
            let lifted = lift.lift(&curve, &slice.fixed);
            extents::measure(&lifted, &mut self.extents);
            show(lifted);
        });
    }

    /// Finds the curves of many task points on the faces of a box; see [`Faces::show`].
    pub fn search_faces<'p>(&self, poses: impl Iterator<Item = &'p mut Pose>, faces: &mut Faces) {
        let mut poses: Vec<&mut Pose> = poses.collect();
        for slice in &mut faces.slices {
            let again = poses.iter_mut().map(|pose| &mut **pose);
            slice.search(again, &self.settings);
        }
    }

    /// The slices on the faces of a box of limits (radians, unwrapped), joint 1 left out.
    ///
    /// With more than two degrees of redundancy a face is itself cut into slices: at the limits
    /// of the other joints and over the grid.
    pub fn faces(&self, limits: &[Option<[f64; 2]>]) -> Faces {
        let mut slices = Vec::new();
        let mut fixed = Vec::new();
        self.add_faces(limits, 1, &mut fixed, &mut slices);
        Faces { slices }
    }

    fn add_faces(
        &self,
        limits: &[Option<[f64; 2]>],
        from: usize,
        fixed: &mut Vec<(usize, f64)>,
        slices: &mut Vec<Slice>,
    ) {
        let left = self.cut.len() - fixed.len();
        if left == 0 {
            slices.extend(self.slice(fixed));
            return;
        }
        for joint in from..self.joints {
            for end in limits[joint].into_iter().flatten() {
                fixed.push((joint, end));
                self.add_faces(limits, joint + 1, fixed, slices);
                fixed.pop();
            }
        }
        // The inside of a face, over the grid.
        if let Some(&(face, _)) = fixed.first()
            && let Some(&joint) = self.cut.iter().find(|&&joint| joint != face)
            && left == 1
        {
            for k in 0..self.values(joint) {
                fixed.push((joint, self.grid_value(joint, k)));
                slices.extend(self.slice(fixed));
                fixed.pop();
            }
        }
    }

    /// Finds and shows the curves on the walls of the physical limits of the joints from 2 on.
    pub fn show_walls(&mut self, pose: &mut Pose, show: &mut dyn FnMut(CurveRef<'_>)) {
        if let Some(mut walls) = self.walls.take() {
            self.search_faces(std::iter::once(pose), &mut walls);
            self.seeds += walls.show(0, show);
            self.walls = Some(walls);
        }
    }

    /// Θ of every joint, from its ranges on parts of curves inside the physical limits.
    pub fn ranges(&self, tool: &Isometry3<f64>, parts: &[Extent]) -> Vec<AngleSet> {
        let goal = Goal::new(&self.chain, tool);
        let range = |joint: usize| {
            let gap = 1.001 * self.spacing(joint);
            extents::range(parts, joint, gap, &self.bounds, (&self.ascent, &goal))
        };
        (0..self.joints).map(range).collect()
    }
}

impl Slice {
    /// Finds the curves of many task points.
    fn search<'p>(&mut self, poses: impl Iterator<Item = &'p mut Pose>, settings: &SearchSettings) {
        let chain = &self.chain;
        let job = |(tool, rng): &'p mut Pose| -> Job<'p> { (Goal::new(chain, tool), rng) };
        let mut jobs: Vec<Job> = poses.map(job).collect();
        if !jobs.is_empty() {
            self.solver.solve_all(&mut jobs, settings);
        }
    }
}

/// The slices on the faces of a box.
#[derive(Clone, Debug)]
pub struct Faces {
    slices: Vec<Slice>,
}

impl Faces {
    /// Shows the curves of task point `index` of those last searched; the random starts made.
    pub(super) fn show(&mut self, index: usize, show: &mut dyn FnMut(CurveRef<'_>)) -> usize {
        let mut lift = Lift::default();
        let mut seeds = 0;
        for slice in &mut self.slices {
            slice.solver.turn_to(index);
            seeds += slice.solver.effort().0;
            slice
                .solver
                .show(|curve| show(lift.lift(&curve, &slice.fixed)));
        }
        seeds
    }
}

/// Fewer starts a slice than for a pre-image of its own: neighbouring slices show the same parts
/// of the surface.
fn sparse(settings: SearchSettings) -> SearchSettings {
    SearchSettings {
        least_seeds: settings.least_seeds.min(12),
        least_hits: settings.least_hits.min(2),
        most_seeds: settings.most_seeds.min(100),
        unreachable_after: settings.unreachable_after.min(12),
        ..settings
    }
}

#[cfg(test)]
mod tests;
