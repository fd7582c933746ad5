//! One radius of a planar pose workspace: the (β, γ) that the wrist circle |w| = r allows.
//!
//! With the wrist w = p − l_n·e^{iφ}, β = arg w and γ = φ − β, the volume element is
//! r dr dβ dγ and l_n drops out. W₀(r) = D(r) ⊕ (A₁ × A_n), where D(r) holds the pairs
//! (arg z, θ₂ + … + θ_{n−1} − arg z) of the wrist chain behind joint 1. W₁ restricts β, W_n
//! restricts γ, the other W_j restrict r.

use super::circle::{Circle, Side};
use super::orientation::{ElbowArc, ElbowArcs, ThreeLinks};
use super::region::sort_distinct;
use crate::angle::{AngleSet, Arc, turn, wrap};
use crate::workspace::JointLimit;
use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

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
        critical: &'a [Circle],
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
    /// Bearings at which the set of γ may jump, because an arc of directions appears or ends in
    /// what joint 1 sweeps; `over` are the bearings of interest.
    pub fn jumps(&self, over: &AngleSet) -> Vec<f64> {
        match self {
            Directions::Constant(_) => Vec::new(),
            Directions::Direct {
                chain,
                critical,
                radius,
                ..
            } => {
                let at = |beta| structure(&chain.directions(Complex::from_polar(*radius, beta)));
                let arcs = over.arcs().iter();
                arcs.flat_map(|arc| changes_within(arc, critical, *radius, at))
                    .collect()
            }
            Directions::Swept { joint_1, table, .. } => {
                let ends = |&event: &f64| [event + joint_1.lower, event + joint_1.upper];
                table.events.iter().flat_map(ends).collect()
            }
        }
    }

    /// The γ of W₀ at bearing β of the wrist.
    pub fn at(&self, beta: f64) -> AngleSet {
        match self {
            Directions::Constant(set) => set.clone(),
            Directions::Direct {
                chain,
                last,
                radius,
                ..
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
                let start = beta - joint_1.upper;
                table.window(start, joint_1.width(), [&from, &to], last)
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

/// Three links carried by a first one that joint 1 turns, with the last joint's limits at the end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep<'a> {
    pub last: Arc,
    pub chain: &'a ThreeLinks,
    pub first_link: f64,
    /// Circles where the structure of the chain's directions can change.
    pub critical: &'a [Circle],
}

/// Slices of D(r) at bearings spread over the arcs of E(r), denser towards their ends, with
/// unions over windows of 1, 2, 4, … neighbours.
#[derive(Clone, Debug, Default)]
pub(super) struct SweepTable {
    /// Start of the first arc; `offsets` count from here.
    base: f64,
    /// Bearings of the slices, ascending in [0, 2π).
    offsets: Vec<f64>,
    slices: Vec<ElbowArcs>,
    /// `unions[0][k]` covers bearings from slice k to slice k + 1, cyclically.
    unions: Vec<Vec<AngleSet>>,
    /// Bearings at which an arc appears, ends, splits or merges.
    events: Vec<f64>,
}

/// The first and last slice of an arc of E(r) lie this far inside it (radians): at its very end
/// round-off decides whether the chain reaches at all.
const INSET: f64 = 1e-9;

/// Slices on either side of a bearing at which the structure can change (radians).
const BESIDE: f64 = 1e-7;

/// Halvings between two slices whose arcs move far.
const REFINEMENTS: usize = 6;

/// Arcs move at most this many radians between neighbouring slices, divided by the number of
/// slices a full circle gets. Where the wrist passes joint 2, directions turn by π at once.
const STRIDE: f64 = 16.0;

/// Fewest slices of one arc of E(r).
const LEAST_SLICES: usize = 12;

impl SweepTable {
    /// Slices for the wrist radius `r`, where the chain behind joint 1 reaches `bearings`; about
    /// `count` for a full circle.
    pub fn rebuild(&mut self, sweep: Sweep<'_>, r: f64, bearings: &AngleSet, count: usize) {
        self.offsets.clear();
        self.slices.clear();
        self.events.clear();
        self.unions.truncate(1);
        self.unions.resize_with(1, Vec::new);
        self.unions[0].clear();
        let arcs = bearings.arcs();
        let Some(first) = arcs.first() else {
            return;
        };
        self.base = first.start();
        for arc in arcs {
            let from = self.slices.len();
            self.add_slices(sweep, r, arc, count);
            for k in from..self.slices.len() - 1 {
                let link = linked(&self.slices[k], &self.slices[k + 1]);
                self.unions[0].push(link.sum(&sweep.last));
            }
            // Nothing is reached between this arc and the next.
            self.unions[0].push(AngleSet::empty());
        }
        if bearings.is_full() {
            let last = self.slices.len() - 1;
            let link = linked(&self.slices[last], &self.slices[0]);
            self.unions[0][last] = link.sum(&sweep.last);
        }
        self.double();
    }

    fn add_slices(&mut self, sweep: Sweep<'_>, r: f64, arc: &Arc, count: usize) {
        let slice = |bearing: f64| directions_behind(sweep.chain, sweep.first_link, r, bearing);
        let mut bearings: Vec<f64> = spread(arc, count).collect();
        let structure_at = |bearing: f64| structure(&slice(bearing));
        let changes = changes_within(arc, sweep.critical, r, structure_at);
        bearings.extend(changes.into_iter().flat_map(beside));
        bearings.sort_unstable_by(f64::total_cmp);
        let mut last: Option<f64> = None;
        for bearing in bearings {
            let next = slice(bearing);
            if let Some(from) = last {
                self.fill(&slice, from, (bearing, &next), STRIDE / count as f64, 0);
            }
            self.push(bearing, next);
            last = Some(bearing);
        }
    }

    /// Adds slices between the last one, at bearing `from`, and `to`, until the arcs of neighbours
    /// move less than `stride`; notes a change of structure.
    fn fill(
        &mut self,
        slice: &impl Fn(f64) -> ElbowArcs,
        from: f64,
        to: (f64, &ElbowArcs),
        stride: f64,
        depth: usize,
    ) {
        let Some(last) = self.slices.last() else {
            return;
        };
        if structure(last) != structure(to.1) {
            self.events.push(0.5 * (from + to.0));
        } else if depth < REFINEMENTS && movement(last, to.1) > stride {
            let middle = 0.5 * (from + to.0);
            let between = slice(middle);
            self.fill(slice, from, (middle, &between), stride, depth + 1);
            self.push(middle, between);
            self.fill(slice, middle, to, stride, depth + 1);
        }
    }

    fn push(&mut self, bearing: f64, slice: ElbowArcs) {
        self.offsets.push(bearing - self.base);
        self.slices.push(slice);
    }

    fn double(&mut self) {
        let count = self.slices.len();
        let mut length = 1;
        while 2 * length <= count {
            let below = &self.unions[self.unions.len() - 1];
            let pairs = (0..count).map(|k| below[k].union(&below[(k + length) % count]));
            let doubled = pairs.collect();
            self.unions.push(doubled);
            length *= 2;
        }
    }

    /// Union of D's slices ⊕ A_n over the window of `width` < 2π from bearing `from`, whose exact
    /// slices at both ends are given.
    fn window(
        &self,
        from: f64,
        width: f64,
        [first, last]: [&ElbowArcs; 2],
        last_joint: &Arc,
    ) -> AngleSet {
        let count = self.slices.len();
        let start = turn(self.base, from);
        let inner = self.offsets.partition_point(|&offset| offset < start);
        let end = start + width;
        let outer = if end < TAU {
            self.offsets.partition_point(|&offset| offset <= end)
        } else {
            count + self.offsets.partition_point(|&offset| offset <= end - TAU)
        };
        if outer <= inner {
            return linked(first, last).sum(last_joint);
        }
        let (inner, cells) = (inner % count, outer - inner - 1);
        let between = self.range(inner, cells.min(count));
        if between.is_full() {
            return between;
        }
        let ends = linked(first, &self.slices[inner])
            .union(&linked(&self.slices[(outer - 1) % count], last));
        between.union(&ends.sum(last_joint))
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

/// Bearings spread over an arc, denser towards its ends; about `count` for a full circle.
fn spread(arc: &Arc, count: usize) -> impl Iterator<Item = f64> + use<> {
    let arc = *arc;
    let cells = (arc.width() / TAU * count as f64).ceil() as usize;
    let cells = cells.max(LEAST_SLICES);
    // The full circle needs no slice at its end, which is its start.
    let nodes = if arc.is_full() { cells } else { cells + 1 };
    (0..nodes).map(move |k| {
        let t = k as f64 / cells as f64;
        let share = if arc.is_full() {
            t
        } else {
            0.5 - 0.5 * (PI * t).cos()
        };
        arc.start() + INSET + share * (arc.width() - 2.0 * INSET).max(0.0)
    })
}

/// The bearings of an arc of |z| = `r` at which the structure changes, unwrapped from the arc's
/// start. It can change where a critical circle crosses only, so one look between two neighbouring
/// crossings finds every change.
fn changes_within(
    arc: &Arc,
    critical: &[Circle],
    r: f64,
    structure_at: impl Fn(f64) -> [usize; 2],
) -> Vec<f64> {
    let mut leads: Vec<f64> = critical
        .iter()
        .filter(|circle| circle.crosses(r))
        .flat_map(|circle| [Side::Left, Side::Right].map(|side| circle.polar_angle(r, side)))
        .map(|mark| turn(arc.start(), mark))
        .filter(|&lead| lead > 2.0 * BESIDE && lead < arc.width() - 2.0 * BESIDE)
        .collect();
    sort_distinct(&mut leads, 4.0 * BESIDE);
    let middle = |from: f64, to: f64| arc.start() + 0.5 * (from + to);
    let mut before = structure_at(middle(0.0, leads.first().copied().unwrap_or(arc.width())));
    let mut changes = Vec::new();
    for (k, &lead) in leads.iter().enumerate() {
        let next = leads.get(k + 1).copied().unwrap_or(arc.width());
        let behind = structure_at(middle(lead, next));
        if behind != before {
            changes.push(arc.start() + lead);
        }
        before = behind;
    }
    changes
}

/// Just before and just behind a mark.
fn beside(mark: f64) -> [f64; 2] {
    [mark - BESIDE, mark + BESIDE]
}

/// Largest move of an arc's end between two slices, as far as their arcs have partners.
fn movement(a: &ElbowArcs, b: &ElbowArcs) -> f64 {
    let moves = a.iter().filter_map(|p| {
        let same = b.iter().filter(|q| q.elbow_left == p.elbow_left);
        let ends = same.map(|q| {
            let start = wrap(q.arc.start() - p.arc.start()).abs();
            let end = wrap(q.arc.end() - p.arc.end()).abs();
            start.max(end)
        });
        ends.min_by(f64::total_cmp)
    });
    moves.fold(0.0, f64::max)
}

/// Number of arcs of either elbow.
fn structure(slice: &ElbowArcs) -> [usize; 2] {
    let left = slice.iter().filter(|found| found.elbow_left).count();
    [left, slice.len() - left]
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
