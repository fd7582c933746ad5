//! Exact sizes of planar position workspaces.
//!
//! W₀, W₁ and with them W_F are bounded by arcs of circles, so their areas are sums of closed
//! forms: between neighbouring critical radii every polar angle of the boundary is one
//! [`Circle::polar_angle`], and ∫ r·angle dr is [`Circle::swept_area`]. No quadrature error
//! remains; what can go wrong is a missed critical radius, which [`PlanarPosition::sizes`]
//! looks for by classifying every panel again at other radii.

use super::circle::{Circle, Side};
use super::post_failure::{LockedJoint1, annulus, annulus_area, locked_joint_radii, radial_gate};
use super::reach::PreFailure;
use super::region::{Panel, Region, sort_distinct};
use super::sweep::{CellSweep, Edge, EdgeArc};
use crate::angle::{AngleSet, turn};
use crate::workspace::{ArtificialLimits, Estimate, FailureSet, JointLimit, WorkspaceSizes};
use std::f64::consts::{PI, TAU};

/// Panels thinner than this share of the reach are dropped.
const THIN_PANEL: f64 = 1e-12;

/// Relative error of an area from round-off alone, observed below 1e-13 on panels that number
/// in the hundreds.
const ROUND_OFF: f64 = 1e-12;

/// A planar arm, its artificial limits and the joints that may fail.
#[derive(Clone, Copy, Debug)]
pub struct PlanarArm<'a> {
    /// Link lengths, metres, all positive, joint 1's link first.
    pub lengths: &'a [f64],
    /// Limits of every joint.
    pub limits: &'a ArtificialLimits,
    /// Joints prone to failure.
    pub failures: &'a FailureSet,
}

/// Exact workspaces of position tasks in the plane. Keeps its buffers between evaluations: after
/// the first few, none allocates.
#[derive(Clone, Debug, Default)]
pub struct PlanarPosition {
    pre_failure: PreFailure,
    panel: SubPanels,
    scratch: Region,
}

/// Which of the workspaces to intersect.
#[derive(Clone, Copy)]
struct Parts {
    pre_failure: bool,
    joint_1: Option<LockedJoint1>,
    radii: [f64; 2],
}

impl PlanarPosition {
    /// An estimator without history.
    pub fn new() -> PlanarPosition {
        PlanarPosition::default()
    }

    /// S_F, the area of the fault-tolerant workspace, m². The fast path of optimisers.
    pub fn fault_tolerant_size(&mut self, arm: PlanarArm<'_>) -> f64 {
        let parts = Parts::fault_tolerant(arm);
        if parts.radii[0] >= parts.radii[1] {
            return 0.0;
        }
        self.pre_failure
            .rebuild(arm.lengths, arm.limits, parts.radii);
        self.area(parts).value
    }

    /// Radii [inner, outer] reachable with all joints free, metres.
    pub fn unrestricted_radii(lengths: &[f64]) -> [f64; 2] {
        annulus(lengths)
    }

    /// S_0max, the area reachable with all joints free, m².
    pub fn unrestricted_size(lengths: &[f64]) -> f64 {
        annulus_area(annulus(lengths))
    }

    /// Size of W₁: what stays reachable wherever within `limit` joint 1 locks, m².
    pub fn locked_joint_1_size(lengths: &[f64], limit: JointLimit) -> Estimate {
        let only = Parts {
            pre_failure: false,
            joint_1: Some(LockedJoint1::new(lengths, limit)),
            radii: annulus(lengths),
        };
        PlanarPosition::new().area(only)
    }

    /// All sizes, m², each with an error estimate: round-off plus any disagreement between the
    /// panels and a direct classification at two radii of every panel.
    pub fn sizes(&mut self, arm: PlanarArm<'_>) -> WorkspaceSizes {
        let unrestricted = annulus(arm.lengths);
        let parts = Parts::fault_tolerant(arm);
        let exact = |value: f64| Estimate {
            value,
            error: ROUND_OFF * value,
        };
        let post_failure = (1..=arm.lengths.len()).map(|joint| {
            let limit = arm.failures.lock_range(arm.limits.joints()[joint - 1]);
            if joint == 1 {
                PlanarPosition::locked_joint_1_size(arm.lengths, limit)
            } else {
                exact(annulus_area(locked_joint_radii(arm.lengths, joint, limit)))
            }
        });
        let post_failure = post_failure.collect();
        self.pre_failure
            .rebuild(arm.lengths, arm.limits, unrestricted);
        let pre_failure = self.verified_area(Parts {
            pre_failure: true,
            joint_1: None,
            radii: unrestricted,
        });
        WorkspaceSizes {
            fault_tolerant: self.verified_area(parts),
            pre_failure,
            post_failure,
            unrestricted: exact(annulus_area(unrestricted)),
        }
    }

    /// The fault-tolerant rotation set B(r): polar angles of W_F at radius `r`. Touching arcs
    /// that meet in a single angle leave no trace.
    pub fn rotation_set(&mut self, arm: PlanarArm<'_>, r: f64) -> AngleSet {
        self.rotation_sets(arm, &[r]).remove(0)
    }

    /// [`PlanarPosition::rotation_set`] for several radii.
    pub fn rotation_sets(&mut self, arm: PlanarArm<'_>, radii: &[f64]) -> Vec<AngleSet> {
        let parts = Parts::fault_tolerant(arm);
        self.pre_failure
            .rebuild(arm.lengths, arm.limits, annulus(arm.lengths));
        let set = |&r: &f64| self.set_at(parts, r);
        radii.iter().map(set).collect()
    }

    /// W₀(r): what the arm reaches inside its limits at several radii, as polar angles.
    pub fn pre_failure_sets(&mut self, arm: PlanarArm<'_>, radii: &[f64]) -> Vec<AngleSet> {
        let reach = annulus(arm.lengths);
        let parts = Parts {
            pre_failure: true,
            joint_1: None,
            radii: reach,
        };
        self.pre_failure.rebuild(arm.lengths, arm.limits, reach);
        radii.iter().map(|&r| self.set_at(parts, r)).collect()
    }

    /// Radii of W_F's panels: between two neighbours the rotation set keeps its number of arcs,
    /// whose ends move smoothly.
    pub fn critical_radii(&mut self, arm: PlanarArm<'_>) -> Vec<f64> {
        let parts = Parts::fault_tolerant(arm);
        let mut radii = vec![parts.radii[0], parts.radii[1].max(parts.radii[0])];
        self.pre_failure
            .rebuild(arm.lengths, arm.limits, parts.radii);
        self.area_with(parts, |panel, _| radii.extend([panel[0], panel[1]]));
        sort_distinct(&mut radii, THIN_PANEL * parts.radii[1]);
        radii
    }

    /// The parts' intersection at one radius, from set operations alone.
    fn set_at(&mut self, parts: Parts, r: f64) -> AngleSet {
        if r < parts.radii[0] || r > parts.radii[1] {
            return AngleSet::empty();
        }
        let mut set = AngleSet::full();
        if parts.pre_failure {
            set = self.pre_failure.rotation_set(&mut self.scratch, r);
        }
        if let Some(joint_1) = parts.joint_1 {
            set = set.intersection(&joint_1.rotation_set(r));
        }
        set.without_narrow_arcs(0.0)
    }

    fn area(&mut self, parts: Parts) -> Estimate {
        let value = self.area_with(parts, |_, _| {});
        Estimate {
            value,
            error: ROUND_OFF * value,
        }
    }

    /// The area, checked by classifying every panel again at two radii off its middle.
    fn verified_area(&mut self, parts: Parts) -> Estimate {
        let mut panels = Vec::new();
        let value = self.area_with(parts, |radii, arcs| {
            panels.push((radii, arcs.to_vec()));
        });
        let mut error = ROUND_OFF * value;
        let mut covered = parts.radii[0];
        for ([inner, outer], arcs) in panels {
            error += self.unseen(parts, covered, inner);
            covered = outer;
            for share in [0.21, 0.79] {
                let r = inner + share * (outer - inner);
                let measure: f64 = arcs.iter().map(|arc| arc.width(r)).sum();
                let difference = (measure - self.set_at(parts, r).measure()).abs();
                // An acos near ±1 is good to √ε ≈ 1e-8 only; that is round-off, not a miss.
                if difference > 1e-7 {
                    error += 0.5 * difference * r * (outer - inner);
                }
            }
        }
        error += self.unseen(parts, covered, parts.radii[1]);
        Estimate { value, error }
    }

    /// Area that a direct classification sees between panels.
    fn unseen(&mut self, parts: Parts, inner: f64, outer: f64) -> f64 {
        if outer - inner <= THIN_PANEL * outer {
            return 0.0;
        }
        let r = 0.5 * (inner + outer);
        self.set_at(parts, r).measure() * r * (outer - inner)
    }

    /// Sums the closed forms of all panels, which `visit` sees with their arcs.
    fn area_with(&mut self, parts: Parts, mut visit: impl FnMut([f64; 2], &[BoundArc])) -> f64 {
        let whole = [Panel::full(parts.radii[0], parts.radii[1])];
        let joint_1 = self.pre_failure.joint_1();
        let tail = self.pre_failure.tail().filter(|_| parts.pre_failure);
        let panels: &[Panel] = match tail {
            Some(tail) => tail.panels(),
            None if parts.pre_failure => &[],
            None => &whole,
        };
        let mut area = 0.0;
        for panel in panels {
            let arcs = tail.map_or(&[][..], |tail| tail.arcs_of(panel));
            let circles = tail.map_or(&[][..], Region::circles);
            let inner = panel.inner.max(parts.radii[0]);
            let outer = panel.outer.min(parts.radii[1]);
            let piece = Piece {
                full: panel.full || (joint_1.is_full() && !arcs.is_empty()),
                arcs,
                circles,
                joint_1_limit: joint_1,
                locked: parts.joint_1.as_ref(),
            };
            area += self.panel.area(piece, [inner, outer], &mut visit);
        }
        area
    }
}

impl Parts {
    fn fault_tolerant(arm: PlanarArm<'_>) -> Parts {
        let joint_1 = arm.failures.lock_range(arm.limits.joints()[0]);
        let locked = || LockedJoint1::new(arm.lengths, joint_1);
        Parts {
            pre_failure: true,
            joint_1: arm.failures.contains(1).then(locked),
            radii: radial_gate(arm.lengths, arm.limits, arm.failures),
        }
    }
}

/// The sets that meet on one panel of E.
#[derive(Clone, Copy)]
struct Piece<'a> {
    /// Whether W₀(r) is the full circle.
    full: bool,
    arcs: &'a [EdgeArc],
    circles: &'a [Circle],
    joint_1_limit: JointLimit,
    locked: Option<&'a LockedJoint1>,
}

impl Piece<'_> {
    /// Whether `angle` is in W₀(r) and in W₁(r), given as numbers.
    fn contains(&self, arcs: &[(f64, f64)], locked: &AngleSet, angle: f64) -> bool {
        let reached = |&(start, width): &(f64, f64)| turn(start, angle) <= width;
        (self.full || arcs.iter().any(reached)) && locked.contains(angle)
    }
}

/// An arc of W_F between two circles, with the circles at hand.
#[derive(Clone, Copy, Debug)]
struct BoundArc {
    start: (Circle, Side),
    end: (Circle, Side),
    turns: f64,
}

impl BoundArc {
    fn width(&self, r: f64) -> f64 {
        let angle = |(circle, side): (Circle, Side)| circle.polar_angle(r, side);
        angle(self.end) - angle(self.start) + self.turns
    }

    /// ∫ r·width dr over the panel.
    fn area(&self, [inner, outer]: [f64; 2]) -> f64 {
        let swept = |(circle, side): (Circle, Side)| {
            circle.swept_area(outer, side) - circle.swept_area(inner, side)
        };
        let whole_turns = 0.5 * self.turns * (outer * outer - inner * inner);
        swept(self.end) - swept(self.start) + whole_turns
    }
}

/// Splits a panel where the boundaries of W₀ and W₁ cross, and integrates the pieces.
#[derive(Clone, Debug, Default)]
struct SubPanels {
    circles: Vec<Circle>,
    edges: Vec<Edge>,
    radii: Vec<f64>,
    sweep: CellSweep,
    shifted: Vec<(f64, f64)>,
    found: Vec<EdgeArc>,
    bound: Vec<BoundArc>,
}

impl SubPanels {
    fn area(
        &mut self,
        piece: Piece<'_>,
        radii: [f64; 2],
        visit: &mut impl FnMut([f64; 2], &[BoundArc]),
    ) -> f64 {
        let tolerance = THIN_PANEL * radii[1];
        if radii[1] - radii[0] <= tolerance {
            return 0.0;
        }
        self.radii.clear();
        self.radii.extend(radii);
        self.split_by_locked_joint(piece, radii);
        let mut area = 0.0;
        let count = self.radii.len();
        for k in 1..count {
            let part = [self.radii[k - 1], self.radii[k]];
            let from = self.radii.len();
            self.collect_edges(piece, 0.5 * (part[0] + part[1]));
            self.split_by_crossings(part, tolerance);
            let mut inner = part[0];
            for j in from..=self.radii.len() {
                let outer = self.radii.get(j).copied().unwrap_or(part[1]);
                area += self.closed_form(piece, [inner, outer], visit);
                inner = outer;
            }
            self.radii.truncate(from);
        }
        area
    }

    fn split_by_locked_joint(&mut self, piece: Piece<'_>, [inner, outer]: [f64; 2]) {
        if let Some(locked) = piece.locked {
            let critical = locked.critical_radii();
            let within = critical.into_iter().filter(|&r| inner < r && r < outer);
            self.radii.extend(within);
            sort_distinct(&mut self.radii, THIN_PANEL * outer);
        }
    }

    /// The circles that may bound W_F near radius `r`.
    fn collect_edges(&mut self, piece: Piece<'_>, r: f64) {
        self.circles.clear();
        self.edges.clear();
        if !piece.full {
            for arc in piece.arcs {
                let ends = [
                    (arc.start, piece.joint_1_limit.lower),
                    (arc.end, piece.joint_1_limit.upper),
                ];
                for (edge, turn) in ends {
                    let circle = piece.circles[edge.circle as usize].rotated(turn);
                    self.add_edge(circle, edge.side);
                }
            }
        }
        for (circle, side) in piece.locked.into_iter().flat_map(|locked| locked.edges(r)) {
            self.add_edge(circle, side);
        }
    }

    fn add_edge(&mut self, circle: Circle, side: Side) {
        let index = self.circles.len() as u32;
        self.circles.push(circle);
        let edge = Edge {
            circle: index,
            side,
        };
        self.edges.push(edge);
    }

    /// Appends the sorted radii inside the panel at which two of its edges cross.
    fn split_by_crossings(&mut self, [inner, outer]: [f64; 2], tolerance: f64) {
        let from = self.radii.len();
        for (k, circle) in self.circles.iter().enumerate() {
            for other in &self.circles[..k] {
                let crossings = circle.crossing_radii(other).into_iter().flatten();
                let within = crossings.filter(|&r| inner + tolerance < r && r < outer - tolerance);
                self.radii.extend(within);
            }
        }
        self.radii[from..].sort_unstable_by(f64::total_cmp);
    }

    fn closed_form(
        &mut self,
        piece: Piece<'_>,
        [inner, outer]: [f64; 2],
        visit: &mut impl FnMut([f64; 2], &[BoundArc]),
    ) -> f64 {
        if outer - inner <= THIN_PANEL * outer {
            return 0.0;
        }
        let r = 0.5 * (inner + outer);
        self.classify(piece, r);
        self.bound.clear();
        if self.sweep.is_full() {
            let everywhere = Circle::new(nalgebra::Complex::new(0.0, 0.0), 0.0);
            let edge = (everywhere, Side::Left);
            self.bound.push(BoundArc {
                start: edge,
                end: edge,
                turns: TAU,
            });
        } else {
            for arc in &self.found {
                let of = |edge: Edge| (self.circles[edge.circle as usize], edge.side);
                self.bound.push(BoundArc {
                    start: of(arc.start),
                    end: of(arc.end),
                    turns: arc.turns,
                });
            }
        }
        visit([inner, outer], &self.bound);
        self.bound
            .iter()
            .map(|arc| arc.area([inner, outer]))
            .sum::<f64>()
            .clamp(0.0, PI * (outer * outer - inner * inner))
    }

    /// Finds the arcs of W_F at radius `r` among the collected edges.
    fn classify(&mut self, piece: Piece<'_>, r: f64) {
        self.sweep.clear();
        for &edge in &self.edges {
            let circle = &self.circles[edge.circle as usize];
            self.sweep.mark(circle.polar_angle(r, edge.side), edge);
        }
        let locked = piece
            .locked
            .map_or(AngleSet::full(), |locked| locked.rotation_set(r));
        let limit = piece.joint_1_limit;
        self.shifted.clear();
        for arc in piece.arcs {
            let (start, width) = arc.at(piece.circles, r);
            let width = width + limit.upper - limit.lower;
            self.shifted.push((start + limit.lower, width));
        }
        let shifted = &self.shifted;
        self.sweep
            .classify(|angle| piece.contains(shifted, &locked, angle));
        self.found.clear();
        if !self.sweep.is_full() {
            self.sweep.append_arcs(&self.circles, r, &mut self.found);
        }
    }
}
