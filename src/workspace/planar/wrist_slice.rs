//! One radius of a planar pose workspace: the (β, γ) that the wrist circle |w| = r allows.
//!
//! With the wrist w = p − l_n·e^{iφ}, β = arg w and γ = φ − β, the volume element is
//! r dr dβ dγ and l_n drops out. W₀(r) = D(r) ⊕ (A₁ × A_n), where D(r) holds the pairs
//! (arg z, θ₂ + … + θ_{n−1} − arg z) of the wrist chain behind joint 1. W₁ restricts β, W_n
//! restricts γ, the other W_j restrict r.

use super::orientation::{ElbowArc, ElbowArcs, ThreeLinks};
use crate::angle::{AngleSet, Arc, turn, wrap};
use crate::workspace::JointLimit;
use nalgebra::Complex;
use std::f64::consts::TAU;

/// Arcs of one elbow on neighbouring slices belong together if their middles are this close
/// (radians): far more than a slice apart, far less than to an arc across the circle.
const SAME_ARC: f64 = 0.5;

/// How γ depends on β within W₀ at one radius.
#[derive(Clone, Debug)]
pub(super) enum Directions<'a> {
    /// Joint 1 or joint n is free: one set of γ for every β.
    Constant(AngleSet),
    /// Four joints: the wrist chain itself has three, its directions are closed forms.
    Direct {
        chain: &'a ThreeLinks,
        last: Arc,
        radius: f64,
    },
    /// Five joints: joint 1 sweeps the closed forms of the three joints behind it.
    Swept {
        chain: &'a ThreeLinks,
        first_link: f64,
        joint_1: JointLimit,
        last: Arc,
        radius: f64,
        table: &'a SweepTable,
    },
}

impl Directions<'_> {
    /// The γ of W₀ at bearing β of the wrist.
    pub fn at(&self, beta: f64) -> AngleSet {
        match self {
            Directions::Constant(set) => set.clone(),
            Directions::Direct {
                chain,
                last,
                radius,
            } => {
                let arcs = chain.directions(Complex::from_polar(*radius, beta));
                AngleSet::from_arcs(arcs.iter().map(|found| found.arc)).sum(last)
            }
            Directions::Swept {
                chain,
                first_link,
                joint_1,
                last,
                radius,
                table,
            } => {
                let slice = |bearing| directions_behind(chain, *first_link, *radius, bearing);
                let from = slice(beta - joint_1.upper);
                let to = slice(beta - joint_1.lower);
                table
                    .window(beta - joint_1.upper, joint_1.width(), &from, &to)
                    .sum(last)
            }
        }
    }
}

/// γ′ of the chain behind joint 1 when the wrist is at radius `r` and `bearing` relative to
/// link 1.
fn directions_behind(chain: &ThreeLinks, first_link: f64, r: f64, bearing: f64) -> ElbowArcs {
    let end = Complex::from_polar(r, bearing) - first_link;
    let mut arcs = chain.directions(end);
    let turned = end.arg() - bearing;
    for found in &mut arcs {
        found.arc = found.arc.rotated(turned);
    }
    arcs
}

/// Slices of D(r) at equally spaced bearings, with unions over windows of 1, 2, 4, … of them.
#[derive(Clone, Debug, Default)]
pub(super) struct SweepTable {
    slices: Vec<ElbowArcs>,
    /// `unions[0][k]` covers bearings from slice k to slice k + 1.
    unions: Vec<Vec<AngleSet>>,
}

impl SweepTable {
    pub fn rebuild(&mut self, chain: &ThreeLinks, first_link: f64, r: f64, count: usize) {
        self.slices.clear();
        let step = TAU / count as f64;
        let bearings = (0..count).map(|k| k as f64 * step);
        let slices = bearings.map(|bearing| directions_behind(chain, first_link, r, bearing));
        self.slices.extend(slices);
        self.unions.resize_with(1, Vec::new);
        self.unions[0].clear();
        for k in 0..count {
            let link = linked(&self.slices[k], &self.slices[(k + 1) % count]);
            self.unions[0].push(link);
        }
        let mut length = 1;
        while 2 * length <= count {
            let below = &self.unions[self.unions.len() - 1];
            let pairs = (0..count).map(|k| below[k].union(&below[(k + length) % count]));
            let doubled = pairs.collect();
            self.unions.push(doubled);
            length *= 2;
        }
    }

    /// Union of D's slices over the window of `width` from bearing `from`, whose exact slices
    /// at both ends are given.
    fn window(&self, from: f64, width: f64, first: &ElbowArcs, last: &ElbowArcs) -> AngleSet {
        let count = self.slices.len();
        let step = TAU / count as f64;
        let lead = turn(from, (turn(0.0, from) / step).ceil() * step);
        // A bearing on a slice up to round-off must not wait for a whole turn.
        let lead = if lead > TAU - 1e-9 { 0.0 } else { lead };
        if width < lead {
            return linked(first, last);
        }
        let start = ((turn(0.0, from) + lead) / step).round() as usize % count;
        let cells = ((width - lead) / step) as usize;
        let end = (start + cells) % count;
        let ends = linked(first, &self.slices[start]).union(&linked(&self.slices[end], last));
        ends.union(&self.range(start, cells.min(count)))
    }

    /// Union of `cells` neighbouring cells from cell `start`.
    fn range(&self, start: usize, cells: usize) -> AngleSet {
        if cells == 0 {
            return AngleSet::empty();
        }
        let count = self.slices.len();
        let level = cells.ilog2() as usize;
        let row = &self.unions[level.min(self.unions.len() - 1)];
        let second = (start + cells - (1 << level)) % count;
        row[start].union(&row[second])
    }
}

/// Union of two neighbouring slices and of what lies between arcs that belong together, so that
/// thin slices do not leave gaps.
fn linked(a: &ElbowArcs, b: &ElbowArcs) -> AngleSet {
    let mut hulls = ElbowArcs::new();
    for p in a {
        // Only arcs that are each other's nearest belong together: an arc that ends between two
        // slices must not be joined to its neighbour across a true gap.
        let partner = nearest(p, b).filter(|(_, q)| nearest(q, a).is_some_and(|(_, r)| r == p));
        if let Some((shift, q)) = partner {
            let mut hull = *p;
            hull.arc = hull_of(p.arc, q.arc, shift);
            hulls.push(hull);
        }
    }
    let all = a.iter().chain(b).chain(&hulls);
    AngleSet::from_arcs(all.map(|found| found.arc))
}

/// The arc of the same elbow whose middle is closest, with its shift; none if it is far or full.
fn nearest<'a>(arc: &ElbowArc, among: &'a ElbowArcs) -> Option<(f64, &'a ElbowArc)> {
    among
        .iter()
        .filter(|other| other.elbow_left == arc.elbow_left)
        .map(|other| (wrap(other.arc.centre() - arc.arc.centre()), other))
        .filter(|(shift, other)| {
            shift.abs() <= SAME_ARC && !arc.arc.is_full() && !other.arc.is_full()
        })
        .min_by(|x, y| x.0.abs().total_cmp(&y.0.abs()))
}

/// Smallest arc around two arcs whose middles are `shift` apart.
fn hull_of(a: Arc, b: Arc, shift: f64) -> Arc {
    let middle = a.start() + 0.5 * a.width();
    let (a_half, b_half) = (0.5 * a.width(), 0.5 * b.width());
    let lower = (-a_half).min(shift - b_half);
    let upper = a_half.max(shift + b_half);
    Arc::from_interval(middle + lower, middle + upper)
}

/// The three joints whose directions are closed forms: all of a four-joint arm's wrist chain, or
/// those behind joint 1 of a five-joint arm.
pub(super) fn three_links(lengths: &[f64], limits: &[JointLimit]) -> ThreeLinks {
    let last = lengths.len() - 3;
    let take = |k: usize| lengths[last + k];
    ThreeLinks::new(
        [take(0), take(1), take(2)],
        [limits[last], limits[last + 1], limits[last + 2]],
    )
}
