//! Pre-images of two or more dimensions, cut into curves.
//!
//! Fixing one joint at each value of a grid leaves a robot with one degree of redundancy less;
//! down to one, where the slices are curves. Only joint ranges and images of boxes are wanted,
//! not the surface itself: ranges are unions over slices whose ends are then walked to the
//! nearest extremum on the surface ([`super::ascent`]), which also closes the gaps that a grid
//! leaves between slices.

use super::any_solver::AnySolver;
use super::ascent::Ascent;
use super::solver::SearchSettings;
use super::source::CurveRef;
use crate::angle::{AngleSet, Arc};
use crate::design::TaskSpace;
use crate::kinematics::{Chain, Goal};
use nalgebra::Isometry3;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};

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
    contributions: Vec<Contribution>,
}

/// The range of one joint on one curve, with the configurations at both ends.
#[derive(Clone, Debug)]
struct Contribution {
    joint: usize,
    arc: Arc,
    low: Vec<f64>,
    high: Vec<f64>,
}

impl Sliced {
    /// `None` if the degree of redundancy is not 2 or 3.
    pub fn new(
        chain: &Chain,
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
            contributions: Vec::new(),
            cut,
        };
        let mut fixed = Vec::new();
        sliced.lay_out(&mut fixed);
        Some(sliced)
    }

    /// Distance between neighbouring slices, radians.
    pub fn spacing(&self) -> f64 {
        TAU / self.per_joint as f64
    }

    fn lay_out(&mut self, fixed: &mut Vec<(usize, f64)>) {
        if fixed.len() == self.cut.len() {
            let slice = self.slice(fixed);
            self.slices.extend(slice);
            return;
        }
        let joint = self.cut[fixed.len()];
        for k in 0..self.per_joint {
            let share = (k as f64 + 0.5) / self.per_joint as f64 - 0.5;
            let range = if self.chain.joints[joint].turn == 0.0 {
                PI
            } else {
                TAU
            };
            fixed.push((joint, share * range));
            self.lay_out(fixed);
            fixed.pop();
        }
    }

    /// Value number `k` of the grid along a joint; strokes are half a turn long.
    fn grid_value(&self, joint: usize, k: usize) -> f64 {
        let is_prismatic = self.chain.joints[joint].turn == 0.0;
        let share = (k as f64 + 0.5) / self.per_joint as f64 - 0.5;
        share * if is_prismatic { PI } else { TAU }
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

    /// Finds the curves of all slices, shows them, and gathers joint ranges.
    pub fn solve(
        &mut self,
        tool: &Isometry3<f64>,
        rng: &mut ChaCha8Rng,
        show: &mut dyn FnMut(CurveRef<'_>),
    ) -> Vec<AngleSet> {
        self.seeds = 0;
        self.sound = true;
        self.contributions.clear();
        let whole = Goal::new(&self.chain, tool);
        // Out of reach of the whole robot: no slice needs to be searched.
        let Some(landed) = self
            .ascent
            .land(&whole, self.settings.unreachable_after * 2, rng)
        else {
            return vec![AngleSet::empty(); self.joints];
        };
        let mut slices = std::mem::take(&mut self.slices);
        for slice in &mut slices {
            self.solve_slice(slice, tool, rng, show);
        }
        self.slices = slices;
        if self.contributions.is_empty() {
            // A small pre-image between the slices: cut it where it was found.
            let fixed: Vec<_> = self
                .cut
                .iter()
                .map(|&joint| (joint, landed[joint]))
                .collect();
            if let Some(mut slice) = self.slice(&fixed) {
                self.solve_slice(&mut slice, tool, rng, show);
            }
        }
        self.ranges(&whole)
    }

    fn solve_slice(
        &mut self,
        slice: &mut Slice,
        tool: &Isometry3<f64>,
        rng: &mut ChaCha8Rng,
        show: &mut dyn FnMut(CurveRef<'_>),
    ) {
        let goal = Goal::new(&slice.chain, tool);
        slice.solver.solve(&goal, &self.settings, rng);
        self.seeds += slice.solver.effort().0;
        self.sound &= slice.solver.is_sound();
        let mut lift = Lift::default();
        slice.solver.show(|curve| {
            let lifted = lift.lift(&curve, &slice.fixed);
            contribute(&lifted, &mut self.contributions);
            show(lifted);
        });
    }

    /// Shows the curves on the faces of a box: joint j fixed at either end of `limits[j]`
    /// (`None`: not limited), for every j but joint 1.
    pub fn solve_faces(
        &mut self,
        tool: &Isometry3<f64>,
        faces: &mut Faces,
        rng: &mut ChaCha8Rng,
        show: &mut dyn FnMut(CurveRef<'_>),
    ) {
        let mut lift = Lift::default();
        for slice in &mut faces.slices {
            let goal = Goal::new(&slice.chain, tool);
            slice.solver.solve(&goal, &self.settings, rng);
            self.seeds += slice.solver.effort().0;
            slice
                .solver
                .show(|curve| show(lift.lift(&curve, &slice.fixed)));
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
            for k in 0..self.per_joint {
                fixed.push((joint, self.grid_value(joint, k)));
                slices.extend(self.slice(fixed));
                fixed.pop();
            }
        }
    }

    /// Θ of every joint: unions over slices, ends walked to the extremum.
    fn ranges(&self, goal: &Goal<f64>) -> Vec<AngleSet> {
        (0..self.joints)
            .map(|joint| self.range(goal, joint))
            .collect()
    }

    fn range(&self, goal: &Goal<f64>, joint: usize) -> AngleSet {
        let own = || self.contributions.iter().filter(|c| c.joint == joint);
        let gap = if self.cut.contains(&joint) {
            self.spacing() * 1.001
        } else {
            0.0
        };
        let coarse = bridged(&AngleSet::from_arcs(own().map(|c| c.arc)), gap);
        if coarse.is_full() {
            return coarse;
        }
        let refined = coarse.arcs().iter().map(|arc| {
            let reach = |sign: f64| {
                let end = if sign > 0.0 { arc.end() } else { arc.start() };
                let near = |c: &&Contribution| {
                    let own = if sign > 0.0 {
                        c.arc.end()
                    } else {
                        c.arc.start()
                    };
                    AngleSet::from(Arc::new(own - 1e-9, 2e-9)).contains(end)
                };
                let gains = own().filter(near).take(4).map(|c| {
                    let start = if sign > 0.0 { &c.high } else { &c.low };
                    let value = self.ascent.extremum(goal, start, joint, sign);
                    (sign * (value - start[joint])).max(0.0)
                });
                gains.fold(0.0, f64::max)
            };
            let (below, above) = (reach(-1.0), reach(1.0));
            Arc::new(arc.start() - below, arc.width() + below + above)
        });
        AngleSet::from_arcs(refined)
    }
}

/// The slices on the faces of a box.
#[derive(Clone, Debug)]
pub struct Faces {
    slices: Vec<Slice>,
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

/// The set with gaps of at most `gap` closed.
fn bridged(set: &AngleSet, gap: f64) -> AngleSet {
    let wide = |arc: &Arc| Arc::new(arc.start() - 0.5 * gap, arc.width() + gap);
    if gap == 0.0 || set.arcs().len() < 2 {
        return set.clone();
    }
    let closed = AngleSet::from_arcs(set.arcs().iter().map(wide));
    if closed.is_full() {
        return closed;
    }
    let narrow = |arc: &Arc| Arc::new(arc.start() + 0.5 * gap, arc.width() - gap);
    AngleSet::from_arcs(closed.arcs().iter().map(narrow))
}

/// Room for a curve with the fixed joints put back.
#[derive(Default)]
struct Lift {
    points: Vec<f64>,
    tangents: Vec<f64>,
    winding: Vec<i32>,
}

impl Lift {
    fn lift<'a>(&'a mut self, curve: &CurveRef<'_>, fixed: &[(usize, f64)]) -> CurveRef<'a> {
        self.points.clear();
        self.tangents.clear();
        self.winding.clear();
        for index in 0..curve.vertices() {
            spread(curve.point(index), fixed.iter().copied(), &mut self.points);
            let still = fixed.iter().map(|&(joint, _)| (joint, 0.0));
            spread(curve.tangent(index), still, &mut self.tangents);
        }
        let still = fixed.iter().map(|&(joint, _)| (joint, 0));
        spread(curve.winding(), still, &mut self.winding);
        CurveRef::new(
            curve.joints + fixed.len(),
            &self.points,
            &self.tangents,
            curve.status,
            &self.winding,
        )
    }
}

/// Appends `values` with the `fixed` entries (ascending joints) put in their places.
fn spread<T: Copy>(values: &[T], fixed: impl Iterator<Item = (usize, T)>, out: &mut Vec<T>) {
    let begin = out.len();
    out.extend_from_slice(values);
    for (joint, value) in fixed {
        out.insert(begin + joint, value);
    }
}

/// The range of every joint on a curve.
fn contribute(curve: &CurveRef<'_>, contributions: &mut Vec<Contribution>) {
    for joint in 0..curve.joints {
        let vertices = 0..curve.vertices();
        let value = |index: &usize| curve.point(*index)[joint];
        let low = vertices
            .clone()
            .min_by(|a, b| value(a).total_cmp(&value(b)));
        let high = vertices.max_by(|a, b| value(a).total_cmp(&value(b)));
        let (Some(low), Some(high)) = (low, high) else {
            continue;
        };
        contributions.push(Contribution {
            joint,
            arc: curve.range(joint),
            low: curve.point(low).to_vec(),
            high: curve.point(high).to_vec(),
        });
    }
}
