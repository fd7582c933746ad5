//! What a planar chain still reaches after one joint locked: W₁ … W_n in closed form.
//!
//! Locking joint j ≥ 2 at q leaves a chain whose links j−1 and j are one rigid link of length
//! L(q); it reaches an annulus whatever the other joints' angles, so W_j is an annulus. Locking
//! joint 1 leaves the annulus of links 2 … n around joint 2, so W₁ is an erosion of arcs.

use super::circle::{Circle, Side};
use crate::angle::{AngleSet, Arc};
use crate::workspace::{ArtificialLimits, FailureSet, JointLimit};
use std::f64::consts::{PI, TAU};

/// Radii [inner, outer] that a chain of free links reaches.
pub(super) fn annulus(lengths: &[f64]) -> [f64; 2] {
    let sum: f64 = lengths.iter().sum();
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    [(2.0 * longest - sum).max(0.0), sum]
}

/// Area of an annulus, zero if `inner` ≥ `outer`.
pub(super) fn annulus_area([inner, outer]: [f64; 2]) -> f64 {
    PI * (outer * outer - inner * inner).max(0.0)
}

/// Radii of W_j for joint number `joint` ≥ 2: what stays reachable wherever within its limits the
/// joint locks. Empty if inner ≥ outer.
pub(super) fn locked_joint_radii(lengths: &[f64], joint: usize, limit: JointLimit) -> [f64; 2] {
    let (a, b) = (lengths[joint - 2], lengths[joint - 1]);
    let [shortest, longest] = rigid_link_range(a, b, limit);
    let (mut sum, mut other) = (0.0, 0.0_f64);
    for (k, &length) in lengths.iter().enumerate() {
        if k != joint - 2 && k != joint - 1 {
            sum += length;
            other = other.max(length);
        }
    }
    let inner = (longest - sum).max(2.0 * other - sum - shortest).max(0.0);
    [inner, shortest + sum]
}

/// Smallest and largest length of two links joined at an angle within `limit`.
fn rigid_link_range(a: f64, b: f64, limit: JointLimit) -> [f64; 2] {
    let length = |cosine: f64| (a * a + b * b + 2.0 * a * b * cosine).max(0.0).sqrt();
    let arc = limit.arc();
    let (lower, upper) = (length(limit.lower.cos()), length(limit.upper.cos()));
    let folded = arc.contains(PI);
    let stretched = arc.contains(0.0);
    [
        if folded {
            (a - b).abs()
        } else {
            lower.min(upper)
        },
        if stretched { a + b } else { lower.max(upper) },
    ]
}

/// Radii common to all W_j with j ≥ 2, j ∈ F, joints locking up to the margin beyond their limits.
pub(super) fn radial_gate(
    lengths: &[f64],
    limits: &ArtificialLimits,
    failures: &FailureSet,
) -> [f64; 2] {
    let mut gate = annulus(lengths);
    for joint in failures.numbers().filter(|&j| j >= 2) {
        let lock = failures.lock_range(limits.joints()[joint - 1]);
        let [inner, outer] = locked_joint_radii(lengths, joint, lock);
        gate = [gate[0].max(inner), gate[1].min(outer)];
    }
    gate
}

/// W₁: where the end point can be, whatever angle within A₁ joint 1 locks at.
///
/// Φ(r) = { φ : |r·e^{iφ} − l₁| ∈ [d_min, d_max] } holds the bearings of the end point relative to
/// link 1; W₁(r) is its erosion by A₁.
#[derive(Clone, Copy, Debug)]
pub(super) struct LockedJoint1 {
    outer: Circle,
    inner: Circle,
    limit: JointLimit,
}

impl LockedJoint1 {
    pub fn new(lengths: &[f64], limit: JointLimit) -> LockedJoint1 {
        let [d_min, d_max] = annulus(&lengths[1..]);
        LockedJoint1 {
            outer: Circle::on_axis(lengths[0], d_max),
            inner: Circle::on_axis(lengths[0], d_min),
            limit,
        }
    }

    /// Radii at which Φ appears, ends, becomes full or opens.
    pub fn critical_radii(&self) -> [f64; 4] {
        [
            self.outer.nearest(),
            self.outer.farthest(),
            self.inner.nearest(),
            self.inner.farthest(),
        ]
    }

    /// Φ(r).
    pub fn bearings(&self, r: f64) -> AngleSet {
        let link = self.outer.distance;
        if r > self.outer.farthest() || r < link - self.outer.radius {
            return AngleSet::empty();
        }
        if r < self.inner.radius - link {
            return AngleSet::empty();
        }
        let outer = self.outer.crosses(r).then(|| self.outer.half_angle(r));
        let inner = self.inner.crosses(r).then(|| self.inner.half_angle(r));
        match (inner, outer) {
            (None, None) => AngleSet::full(),
            (None, Some(out)) => Arc::new(-out, 2.0 * out).into(),
            (Some(hole), None) => Arc::new(hole, TAU - 2.0 * hole).into(),
            (Some(hole), Some(out)) => {
                AngleSet::from_arcs([Arc::new(hole, out - hole), Arc::new(-out, out - hole)])
            }
        }
    }

    /// Φ(r) as half-angles [hole, out], radians in [0, π]: the bearings φ with hole ≤ |φ| ≤ out.
    /// Empty if hole ≥ out.
    pub fn half_angles(&self, r: f64) -> [f64; 2] {
        let inside = |circle: &Circle| match () {
            () if circle.crosses(r) => circle.half_angle(r),
            // Not crossing, the circle |z| = r lies inside this one whole or not at all.
            () if r < circle.radius - circle.distance => PI,
            () => 0.0,
        };
        [inside(&self.inner), inside(&self.outer)]
    }

    /// W₁(r): { β : β − A₁ ⊂ Φ(r) }.
    pub fn rotation_set(&self, r: f64) -> AngleSet {
        self.bearings(r).erosion(&self.limit.arc().mirrored())
    }

    /// The circles, already turned by the joint's limits, that bound W₁ near radius `r`, with
    /// the side on which they do.
    pub fn edges(&self, r: f64) -> impl Iterator<Item = (Circle, Side)> {
        let of = |circle: Circle, start: Side, end: Side| {
            let crossing = circle.crosses(r) && !self.limit.is_full();
            let ends = [(start, self.limit.upper), (end, self.limit.lower)];
            ends.into_iter()
                .filter(move |_| crossing)
                .map(move |(side, turn)| (circle.rotated(turn), side))
        };
        of(self.outer, Side::Right, Side::Left).chain(of(self.inner, Side::Left, Side::Right))
    }
}
