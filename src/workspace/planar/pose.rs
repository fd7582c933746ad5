//! Sizes of planar pose workspaces (position and orientation) for four and five joints.
//!
//! In wrist coordinates (r, β, γ) of [`super::wrist_slice`] the size is ∫ r·m(r) dr, where m(r) is
//! the measure of the fault-tolerant (β, γ). Where joint 1 or joint n is free, m(r) is a product
//! of two closed forms; otherwise it is one integral over β of closed forms. Panels of r are split
//! at every radius where m jumps, and refined adaptively.

use super::circle::Circle;
use super::orientation::ThreeLinks;
use super::position::{PlanarArm, PlanarPosition};
use super::post_failure::{LockedJoint1, annulus, annulus_area, locked_joint_radii, radial_gate};
use super::quadrature::{Kronrod, flattened_midpoints, integrate};
use super::reach::PreFailure;
use super::region::sort_distinct;
use super::resolution::PoseResolution;
use super::wrist::Wrist;
use super::wrist_slice::{Directions, Sweep, SweepTable, three_links};
use crate::angle::{AngleSet, Arc, turn};
use crate::workspace::{Estimate, JointLimit, WorkspaceSizes};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Workspaces of pose tasks in the plane. Keeps its buffers between evaluations.
#[derive(Clone, Debug, Default)]
pub struct PlanarPose {
    resolution: PoseResolution,
    forward: PreFailure,
    backward: PreFailure,
    chain: Option<ThreeLinks>,
    critical: Vec<Circle>,
    table: SweepTable,
}

/// m(r) is probed for a jump this share of the outer radius to either side.
const JUMP_PROBE: f64 = 1e-6;

/// Relative change of m(r) across a probe that counts as a jump: a root opens by √1e-6 there.
const JUMP_SHARE: f64 = 2e-3;

/// Fewest bearings between two jumps.
const LEAST_BEARINGS: usize = 4;

/// The parts of an arc between the `jumps` that lie on it.
fn pieces(arc: &Arc, jumps: &[f64]) -> Vec<Arc> {
    let mut cuts: Vec<f64> = jumps
        .iter()
        .map(|&jump| turn(arc.start(), jump))
        .filter(|&cut| cut < arc.width())
        .collect();
    cuts.extend([0.0, arc.width()]);
    sort_distinct(&mut cuts, 1e-9);
    let piece = |pair: &[f64]| Arc::new(arc.start() + pair[0], pair[1] - pair[0]);
    cuts.windows(2).map(piece).collect()
}

/// Which of the workspaces to intersect.
#[derive(Clone, Copy)]
struct Parts {
    pre_failure: bool,
    joint_1: Option<LockedJoint1>,
    joint_n: Option<LockedJoint1>,
    radii: [f64; 2],
}

impl PlanarPose {
    /// An estimator at the given resolution.
    pub fn new(resolution: PoseResolution) -> PlanarPose {
        PlanarPose {
            resolution,
            ..PlanarPose::default()
        }
    }

    /// S_F, the volume of the fault-tolerant workspace, m² rad, with the error of the radial
    /// quadrature alone. The fast path of optimisers.
    ///
    /// `arm` has four or five joints.
    pub fn fault_tolerant_size(&mut self, arm: PlanarArm<'_>) -> Estimate {
        let wrist = Wrist::new(arm);
        self.volume(&wrist, Parts::fault_tolerant(arm, &wrist))
    }

    /// S_0max, the volume reachable with all joints free, m² rad.
    pub fn unrestricted_size(lengths: &[f64]) -> f64 {
        TAU * annulus_area(annulus(&lengths[..lengths.len() - 1]))
    }

    /// All sizes, m² rad. Computed twice, at the resolution and at its double; the finer value is
    /// given, its error is the quadrature's plus the difference of the two.
    pub fn sizes(&mut self, arm: PlanarArm<'_>) -> WorkspaceSizes {
        let wrist = Wrist::new(arm);
        let whole = annulus(&wrist.lengths);
        let parts = Parts::fault_tolerant(arm, &wrist);
        let pre_failure = Parts {
            pre_failure: true,
            joint_1: None,
            joint_n: None,
            radii: whole,
        };
        let exact = |value: f64| Estimate {
            value,
            error: 1e-12 * value,
        };
        let n = arm.lengths.len();
        let lock = |joint: usize| arm.failures.lock_range(arm.limits.joints()[joint - 1]);
        let post_failure = (1..=n).map(|joint| match joint {
            1 => scaled(locked_base_area(&wrist.lengths, lock(1)), TAU),
            j if j == n => scaled(locked_base_area(&wrist.reversed_lengths, lock(n)), TAU),
            j => {
                let limit = lock(j);
                exact(TAU * annulus_area(locked_joint_radii(&wrist.lengths, j, limit)))
            }
        });
        let post_failure = post_failure.collect();
        WorkspaceSizes {
            fault_tolerant: self.checked_volume(&wrist, parts),
            pre_failure: self.checked_volume(&wrist, pre_failure),
            post_failure,
            unrestricted: exact(TAU * annulus_area(whole)),
        }
    }

    /// Measure of the fault-tolerant (β, γ) at wrist radius `r`, in [0, 4π²].
    pub fn wrist_measure(&mut self, arm: PlanarArm<'_>, r: f64) -> f64 {
        let wrist = Wrist::new(arm);
        let parts = Parts::fault_tolerant(arm, &wrist);
        self.prepare(&wrist, parts);
        self.measure(&wrist, parts, r)
    }

    /// W₀ at wrist radius `r`: for each of `bearings` β the directions γ that the arm reaches
    /// inside its limits.
    pub fn pre_failure_directions(
        &mut self,
        arm: PlanarArm<'_>,
        r: f64,
        bearings: &[f64],
    ) -> Vec<AngleSet> {
        let wrist = Wrist::new(arm);
        let reach = annulus(&wrist.lengths);
        let parts = Parts {
            pre_failure: true,
            joint_1: None,
            joint_n: None,
            radii: reach,
        };
        self.prepare(&wrist, parts);
        let beta = self.outer_sets(parts, r).0;
        if beta.is_empty() {
            return vec![AngleSet::empty(); bearings.len()];
        }
        self.refresh_table(&wrist, r);
        let directions = self.directions(&wrist, parts, r);
        let at = |&angle: &f64| match beta.contains(angle) {
            true => directions.at(angle),
            false => AngleSet::empty(),
        };
        bearings.iter().map(at).collect()
    }

    /// For each wrist radius and each of `bearings` cells around the circle from −π, the
    /// fault-tolerant set of γ at the cell's middle.
    pub fn direction_table(
        &mut self,
        arm: PlanarArm<'_>,
        radii: &[f64],
        bearings: usize,
    ) -> Vec<Vec<AngleSet>> {
        let wrist = Wrist::new(arm);
        let parts = Parts::fault_tolerant(arm, &wrist);
        self.prepare(&wrist, parts);
        let prepared = &*self;
        radii
            .par_iter()
            .map_init(
                || prepared.clone(),
                |estimator, &r| estimator.direction_row(&wrist, parts, r, bearings),
            )
            .collect()
    }

    fn direction_row(
        &mut self,
        wrist: &Wrist,
        parts: Parts,
        r: f64,
        bearings: usize,
    ) -> Vec<AngleSet> {
        let (beta, gamma) = self.outer_sets(parts, r);
        if beta.is_empty() || gamma.is_empty() {
            return vec![AngleSet::empty(); bearings];
        }
        self.refresh_table(wrist, r);
        let directions = self.directions(wrist, parts, r);
        let at = |k: usize| {
            let angle = -PI + (k as f64 + 0.5) * TAU / bearings as f64;
            if beta.contains(angle) {
                directions.at(angle).intersection(&gamma)
            } else {
                AngleSet::empty()
            }
        };
        (0..bearings).map(at).collect()
    }

    fn checked_volume(&mut self, wrist: &Wrist, parts: Parts) -> Estimate {
        let coarse = self.volume(wrist, parts);
        let resolution = self.resolution;
        self.resolution = resolution.doubled();
        let fine = self.volume(wrist, parts);
        self.resolution = resolution;
        Estimate {
            value: fine.value,
            error: fine.error + (fine.value - coarse.value).abs(),
        }
    }

    fn prepare(&mut self, wrist: &Wrist, parts: Parts) {
        let base = &wrist.limits;
        self.forward.rebuild(&wrist.lengths, base, parts.radii);
        let mirrored = &wrist.reversed_limits;
        self.backward
            .rebuild(&wrist.reversed_lengths, mirrored, parts.radii);
        let chain = three_links(&wrist.lengths, wrist.limits.joints());
        // A chain of four carries the three links on its first; a chain of three starts at joint 1.
        let carried = wrist.lengths.len() == 4;
        self.critical = chain.critical_circles(if carried { wrist.lengths[0] } else { 0.0 });
        self.chain = Some(chain);
    }

    fn volume(&mut self, wrist: &Wrist, parts: Parts) -> Estimate {
        if parts.radii[0] >= parts.radii[1] {
            return Estimate::default();
        }
        self.prepare(wrist, parts);
        let mut breaks = self.breaks(parts);
        if self.resolution.rule == Kronrod::Fifteen {
            self.add_jumps(wrist, parts, &mut breaks);
        }
        let PoseResolution {
            tolerance,
            max_panels,
            rule,
            ..
        } = self.resolution;
        let integral = integrate(rule, &breaks, tolerance, max_panels, |r| {
            r * self.measure(wrist, parts, r)
        });
        Estimate {
            value: integral.value.max(0.0),
            error: integral.error,
        }
    }

    /// Radii at which m(r) may jump or bend sharply.
    fn breaks(&self, parts: Parts) -> Vec<f64> {
        let [inner, outer] = parts.radii;
        let mut breaks = vec![inner, outer];
        let mut add = |r: f64| {
            if inner < r && r < outer {
                breaks.push(r);
            }
        };
        for locked in [parts.joint_1, parts.joint_n].into_iter().flatten() {
            locked.critical_radii().into_iter().for_each(&mut add);
        }
        if parts.pre_failure {
            for tail in [self.forward.tail(), self.backward.tail()]
                .into_iter()
                .flatten()
            {
                tail.events().iter().copied().for_each(&mut add);
            }
        }
        sort_distinct(&mut breaks, 1e-9 * outer);
        breaks
    }

    /// Adds the radii at which a part of the self-motion appears or ends, where m(r) jumps there.
    fn add_jumps(&mut self, wrist: &Wrist, parts: Parts, breaks: &mut Vec<f64>) {
        let free = wrist.limits.joints()[0].is_full() || wrist.last.is_full();
        if free || !parts.pre_failure {
            return;
        }
        let [inner, outer] = parts.radii;
        let extremes = self
            .critical
            .iter()
            .flat_map(|c| [c.nearest(), c.farthest()]);
        let off = JUMP_PROBE * outer;
        let mut radii: Vec<f64> = extremes
            .filter(|&r| inner + off < r && r < outer - off)
            .collect();
        sort_distinct(&mut radii, 1e-9 * outer);
        for r in radii {
            let below = self.measure(wrist, parts, r - off);
            let above = self.measure(wrist, parts, r + off);
            if (above - below).abs() > JUMP_SHARE * (above + below) {
                breaks.push(r);
            }
        }
        sort_distinct(breaks, 1e-9 * outer);
    }

    /// The β that W₀ and W₁ allow at `r`, and the γ that W_n allows; none if another W_j forbids
    /// `r`.
    fn outer_sets(&self, parts: Parts, r: f64) -> (AngleSet, AngleSet) {
        if r < parts.radii[0] || r > parts.radii[1] {
            return (AngleSet::empty(), AngleSet::empty());
        }
        let of = |locked: Option<LockedJoint1>| {
            locked.map_or(AngleSet::full(), |locked| locked.rotation_set(r))
        };
        let mut beta = of(parts.joint_1);
        if parts.pre_failure && !beta.is_empty() {
            beta = beta.intersection(&self.forward.set_at(r));
        }
        (beta, of(parts.joint_n))
    }

    /// m(r): measure of the (β, γ) common to all parts.
    fn measure(&mut self, wrist: &Wrist, parts: Parts, r: f64) -> f64 {
        let (beta, gamma) = self.outer_sets(parts, r);
        if beta.is_empty() || gamma.is_empty() {
            return 0.0;
        }
        if !parts.pre_failure {
            return beta.measure() * gamma.measure();
        }
        self.refresh_table(wrist, r);
        let directions = self.directions(wrist, parts, r);
        if let Directions::Constant(set) = &directions {
            return beta.measure() * set.overlap(&gamma);
        }
        let bearings = self.resolution.bearings;
        let jumps = directions.jumps(&beta);
        let mut measure = 0.0;
        for arc in beta.arcs().iter().filter(|arc| arc.width() > 0.0) {
            for piece in pieces(arc, &jumps) {
                let count = (piece.width() / TAU * bearings as f64).ceil() as usize;
                for (x, weight) in flattened_midpoints(count + LEAST_BEARINGS) {
                    let set = directions.at(piece.start() + x * piece.width());
                    measure += weight * piece.width() * set.overlap(&gamma);
                }
            }
        }
        measure
    }

    fn refresh_table(&mut self, wrist: &Wrist, r: f64) {
        let swept = wrist.lengths.len() == 4
            && !wrist.limits.joints()[0].is_full()
            && !wrist.last.is_full();
        if let Some(chain) = self.chain.as_ref().filter(|_| swept) {
            let slices = self.resolution.slices;
            let bearings = self.forward.tail_at(r);
            let sweep = Sweep {
                last: wrist.last.arc(),
                chain,
                first_link: wrist.lengths[0],
                critical: &self.critical,
            };
            self.table.rebuild(sweep, r, &bearings, slices);
        }
    }

    fn directions(&self, wrist: &Wrist, parts: Parts, r: f64) -> Directions<'_> {
        let joint_1 = wrist.limits.joints()[0];
        debug_assert!(parts.pre_failure);
        match &self.chain {
            _ if wrist.last.is_full() => Directions::Constant(AngleSet::full()),
            _ if joint_1.is_full() => Directions::Constant(self.backward.set_at(r)),
            Some(chain) if wrist.lengths.len() == 3 => Directions::Direct {
                chain,
                critical: &self.critical,
                last: wrist.last.arc(),
                radius: r,
            },
            Some(chain) => Directions::Swept {
                chain,
                first_link: wrist.lengths[0],
                joint_1,
                last: wrist.last.arc(),
                radius: r,
                table: &self.table,
            },
            None => Directions::Constant(AngleSet::empty()),
        }
    }
}

impl Parts {
    fn fault_tolerant(arm: PlanarArm<'_>, wrist: &Wrist) -> Parts {
        let n = arm.lengths.len();
        let failing = |joint: usize, lengths: &[f64], limit: JointLimit| {
            let locked = || LockedJoint1::new(lengths, arm.failures.lock_range(limit));
            arm.failures.contains(joint).then(locked)
        };
        Parts {
            pre_failure: true,
            joint_1: failing(1, &wrist.lengths, wrist.limits.joints()[0]),
            joint_n: failing(n, &wrist.reversed_lengths, wrist.last),
            radii: radial_gate(&wrist.lengths, &wrist.limits, &wrist.failures),
        }
    }
}

/// Area of W₁ of a chain, m².
fn locked_base_area(lengths: &[f64], limit: JointLimit) -> Estimate {
    PlanarPosition::locked_joint_1_size(lengths, limit)
}

fn scaled(estimate: Estimate, factor: f64) -> Estimate {
    Estimate {
        value: factor * estimate.value,
        error: factor * estimate.error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::{ArtificialLimits, FailureSet};

    /// Links 2 and 3 cancel, so the wrist chain is links 1 and 4, and two wrist bearings remain.
    /// Joints 1 and 5 turn them about: |A₁|·|A₅|, if the directions of both lie apart or one only
    /// is within reach of joints 2 and 4.
    #[test]
    fn a_joint_held_folded_on_equal_links_leaves_the_rest_of_the_chain() {
        let limits = ArtificialLimits::new(vec![
            JointLimit::new(2.40917, 3.85759),
            JointLimit::new(2.50255, 3.78064),
            JointLimit::new(PI, PI),
            JointLimit::new(-1.46406, -0.80902),
            JointLimit::new(-2.86093, 2.58175),
        ]);
        let failures = FailureSet::of(5, &[2]);
        let arm = PlanarArm {
            lengths: &[1.0; 5],
            limits: &limits,
            failures: &failures,
        };
        let mut estimator = PlanarPose::new(PoseResolution::default());
        let measure = estimator.wrist_measure(arm, 0.993_805_808_628_316_4);
        let joints = limits.joints();
        let expected = joints[0].width() * joints[4].width();
        assert!(
            (measure - expected).abs() < 1e-3 * expected,
            "{measure} {expected}"
        );
    }
}
