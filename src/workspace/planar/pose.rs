//! Sizes of planar pose workspaces (position and orientation) for four and five joints.
//!
//! In wrist coordinates (r, β, γ) of [`super::wrist_slice`] the size is ∫ r·m(r) dr, where m(r) is
//! the measure of the fault-tolerant (β, γ). Where joint 1 or joint n is free, m(r) is a product
//! of two closed forms; otherwise it is one integral over β of closed forms. Panels of r are split
//! at every radius where m jumps, and refined adaptively.

use super::orientation::ThreeLinks;
use super::position::{PlanarArm, PlanarPosition};
use super::post_failure::{LockedJoint1, annulus, annulus_area, locked_joint_radii, radial_gate};
use super::quadrature::{flattened_midpoints, integrate};
use super::reach::PreFailure;
use super::region::sort_radii;
use super::wrist_slice::{Directions, SweepTable, three_links};
use crate::angle::AngleSet;
use crate::workspace::{ArtificialLimits, Estimate, FailureSet, JointLimit, WorkspaceSizes};
use std::f64::consts::TAU;

/// How finely a pose workspace is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseResolution {
    /// Relative error at which the radial quadrature stops. Too large: an optimiser climbs the
    /// noise; too small: time grows, while the bearing nodes bound the accuracy. Default 3e-4.
    pub tolerance: f64,
    /// Bearings β per full circle at which the set of γ is computed. Default 64.
    pub bearings: usize,
    /// Slices per full circle that joint 1 sweeps (five joints only). Default 128.
    pub slices: usize,
    /// Radial panels after which refinement stops whatever the error. Default 200.
    pub max_panels: usize,
}

impl Default for PoseResolution {
    fn default() -> Self {
        PoseResolution {
            tolerance: 3e-4,
            bearings: 64,
            slices: 128,
            max_panels: 200,
        }
    }
}

impl PoseResolution {
    /// Settings that keep the error of most workspaces within the relative `tolerance`: the error
    /// of the bearings and slices falls with the square of their number.
    pub fn for_tolerance(tolerance: f64) -> PoseResolution {
        let default = PoseResolution::default();
        let finer = (1e-3 / tolerance).sqrt().clamp(0.5, 16.0);
        PoseResolution {
            tolerance: 0.3 * tolerance,
            bearings: (default.bearings as f64 * finer).ceil() as usize,
            slices: (default.slices as f64 * finer).ceil() as usize,
            max_panels: (default.max_panels as f64 * finer).ceil() as usize,
        }
    }

    /// Coarse settings for a search whose winner is scored again: about 1 % in a third of the time.
    pub fn coarse() -> PoseResolution {
        PoseResolution {
            tolerance: 2e-3,
            bearings: 32,
            slices: 64,
            max_panels: 60,
        }
    }

    fn doubled(self) -> PoseResolution {
        PoseResolution {
            tolerance: 0.5 * self.tolerance,
            bearings: 2 * self.bearings,
            slices: 2 * self.slices,
            max_panels: 2 * self.max_panels,
        }
    }
}

/// Workspaces of pose tasks in the plane. Keeps its buffers between evaluations.
#[derive(Clone, Debug, Default)]
pub struct PlanarPose {
    resolution: PoseResolution,
    forward: PreFailure,
    backward: PreFailure,
    chain: Option<ThreeLinks>,
    table: SweepTable,
}

/// The wrist chain seen from joint 1 and, mirrored, from joint n.
struct Wrist {
    lengths: Vec<f64>,
    limits: ArtificialLimits,
    failures: FailureSet,
    reversed_lengths: Vec<f64>,
    reversed_limits: ArtificialLimits,
    last: JointLimit,
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
        let post_failure = (1..=n).map(|joint| match joint {
            1 => scaled(
                locked_base_area(&wrist.lengths, arm.limits.joints()[0]),
                TAU,
            ),
            j if j == n => scaled(locked_base_area(&wrist.reversed_lengths, wrist.last), TAU),
            j => {
                let limit = arm.limits.joints()[j - 1];
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

    /// For each wrist radius and each of `bearings` equally spaced β from −π, the fault-tolerant
    /// set of γ.
    pub fn direction_table(
        &mut self,
        arm: PlanarArm<'_>,
        radii: &[f64],
        bearings: usize,
    ) -> Vec<Vec<AngleSet>> {
        let wrist = Wrist::new(arm);
        let parts = Parts::fault_tolerant(arm, &wrist);
        self.prepare(&wrist, parts);
        let step = TAU / bearings as f64;
        let row = |&r: &f64| {
            let (beta, gamma) = self.outer_sets(parts, r);
            if !beta.is_empty() {
                self.refresh_table(&wrist, r);
            }
            let directions = (!beta.is_empty()).then(|| self.directions(&wrist, parts, r));
            let at = |k: usize| {
                let angle = -std::f64::consts::PI + (k as f64 + 0.5) * step;
                match &directions {
                    Some(directions) if beta.contains(angle) => {
                        directions.at(angle).intersection(&gamma)
                    }
                    _ => AngleSet::empty(),
                }
            };
            (0..bearings).map(at).collect()
        };
        radii.iter().map(row).collect()
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
        self.chain = Some(three_links(&wrist.lengths, wrist.limits.joints()));
    }

    fn volume(&mut self, wrist: &Wrist, parts: Parts) -> Estimate {
        if parts.radii[0] >= parts.radii[1] {
            return Estimate::default();
        }
        self.prepare(wrist, parts);
        let breaks = self.breaks(parts);
        let PoseResolution {
            tolerance,
            max_panels,
            ..
        } = self.resolution;
        let integral = integrate(&breaks, tolerance, max_panels, |r| {
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
        sort_radii(&mut breaks, 1e-9 * outer);
        breaks
    }

    /// The β that W₀ and W₁ allow at `r`, and the γ that W_n allows.
    fn outer_sets(&self, parts: Parts, r: f64) -> (AngleSet, AngleSet) {
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
        let mut measure = 0.0;
        for arc in beta.arcs().iter().filter(|arc| arc.width() > 0.0) {
            let share = arc.width() / TAU;
            let count = (share * self.resolution.bearings as f64).ceil() as usize;
            for (x, weight) in flattened_midpoints(count.max(6)) {
                let set = directions.at(arc.start() + x * arc.width());
                measure += weight * arc.width() * set.overlap(&gamma);
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
            self.table.rebuild(chain, wrist.lengths[0], r, slices);
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

impl Wrist {
    fn new(arm: PlanarArm<'_>) -> Wrist {
        let n = arm.lengths.len();
        debug_assert!((4..=5).contains(&n));
        let lengths = arm.lengths[..n - 1].to_vec();
        let joints = arm.limits.joints();
        let numbers: Vec<usize> = arm.failures.numbers().filter(|&j| j < n).collect();
        let reversed = std::iter::once(joints[n - 1])
            .chain(joints[1..n - 1].iter().rev().copied())
            .collect();
        Wrist {
            reversed_lengths: lengths.iter().rev().copied().collect(),
            lengths,
            limits: ArtificialLimits::new(joints[..n - 1].to_vec()),
            failures: FailureSet::of(n - 1, &numbers),
            reversed_limits: ArtificialLimits::new(reversed),
            last: joints[n - 1],
        }
    }
}

impl Parts {
    fn fault_tolerant(arm: PlanarArm<'_>, wrist: &Wrist) -> Parts {
        let n = arm.lengths.len();
        let failing = |joint: usize, lengths: &[f64], limit: JointLimit| {
            let locked = || LockedJoint1::new(lengths, limit);
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
