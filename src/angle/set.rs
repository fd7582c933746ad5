//! Finite unions of closed arcs.

use super::{Arc, turn, wrap};
use smallvec::SmallVec;
use std::f64::consts::{PI, TAU};

/// Gaps narrower than this (radians) are closed when arcs are joined.
///
/// Two arcs that meet at a computed angle may miss each other by round-off; without the tolerance
/// an erosion would find a gap where the exact sets have none. 1e-12 rad is a thousand times the
/// round-off of an `acos` away from ±1 and a millionth of the accuracy promised for interval ends.
pub const GAP_TOLERANCE: f64 = 1e-12;

/// A set of angles: finitely many disjoint closed arcs modulo 2π.
///
/// Arcs are sorted by their start in [−π, π); only the last may reach past π. The full circle is
/// one arc [−π, π]; the empty set has none. Single angles are ordinary members.
/// Sets with up to six arcs live without heap allocation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AngleSet {
    arcs: SmallVec<[Arc; 6]>,
}

impl AngleSet {
    /// The empty set.
    pub fn empty() -> AngleSet {
        AngleSet::default()
    }

    /// The full circle.
    pub fn full() -> AngleSet {
        AngleSet::from(Arc::FULL)
    }

    /// The union of any arcs, in any order, overlapping or not.
    pub fn from_arcs(arcs: impl IntoIterator<Item = Arc>) -> AngleSet {
        let mut set = AngleSet {
            arcs: arcs.into_iter().collect(),
        };
        set.normalise();
        set
    }

    /// The disjoint arcs, sorted by start.
    pub fn arcs(&self) -> &[Arc] {
        &self.arcs
    }

    /// Whether the set has no angle at all.
    pub fn is_empty(&self) -> bool {
        self.arcs.is_empty()
    }

    /// Whether the set is the whole circle.
    pub fn is_full(&self) -> bool {
        matches!(self.arcs.as_slice(), [arc] if arc.is_full())
    }

    /// Total width in radians, in [0, 2π]; single angles count nothing.
    pub fn measure(&self) -> f64 {
        self.arcs.iter().map(Arc::width).sum::<f64>().min(TAU)
    }

    /// Whether `angle` (modulo 2π) belongs to the set.
    pub fn contains(&self, angle: f64) -> bool {
        self.arcs.iter().any(|arc| arc.contains(angle))
    }

    /// Whether the whole `arc` lies in the set, i.e. in one of its arcs.
    ///
    /// Ends may stick out by [`GAP_TOLERANCE`].
    pub fn contains_arc(&self, arc: &Arc) -> bool {
        self.is_full()
            || self.arcs.iter().any(|own| {
                let lead = turn(own.start() - GAP_TOLERANCE, arc.start());
                lead + arc.width() <= own.width() + 2.0 * GAP_TOLERANCE
            })
    }

    /// All angles that belong to either set.
    pub fn union(&self, other: &AngleSet) -> AngleSet {
        if self.is_full() || other.is_empty() {
            return self.clone();
        }
        if other.is_full() || self.is_empty() {
            return other.clone();
        }
        AngleSet::from_arcs(self.arcs.iter().chain(&other.arcs).copied())
    }

    /// All angles that belong to both sets.
    pub fn intersection(&self, other: &AngleSet) -> AngleSet {
        if self.is_full() {
            return other.clone();
        }
        if other.is_full() {
            return self.clone();
        }
        let mut arcs = SmallVec::new();
        for a in &self.arcs {
            for b in &other.arcs {
                push_overlap(&mut arcs, a, b);
            }
        }
        let mut set = AngleSet { arcs };
        set.normalise();
        set
    }

    /// Measure of the intersection, without building it.
    pub fn overlap(&self, other: &AngleSet) -> f64 {
        if self.is_full() {
            return other.measure();
        }
        if other.is_full() {
            return self.measure();
        }
        let pairs = self
            .arcs
            .iter()
            .flat_map(|a| other.arcs.iter().map(move |b| overlap_width(a, b)));
        pairs.sum()
    }

    /// The closure of all angles that do not belong to the set.
    ///
    /// Sets are closed, so the ends belong to both a set and its complement, and single angles
    /// leave no trace in the complement.
    pub fn complement(&self) -> AngleSet {
        let solid: SmallVec<[Arc; 6]> = self
            .arcs
            .iter()
            .filter(|arc| arc.width() > 0.0)
            .copied()
            .collect();
        if solid.is_empty() {
            return AngleSet::full();
        }
        if self.is_full() {
            return AngleSet::empty();
        }
        let next = solid.iter().cycle().skip(1);
        let gaps = solid
            .iter()
            .zip(next)
            .map(|(arc, next)| Arc::new(arc.end(), gap_width(arc, next)));
        AngleSet::from_arcs(gaps)
    }

    /// The Minkowski sum { x + y : x ∈ self, y ∈ arc }.
    pub fn sum(&self, arc: &Arc) -> AngleSet {
        AngleSet::from_arcs(self.arcs.iter().map(|own| own.sum(arc)))
    }

    /// The erosion { x : x + y ∈ self for every y ∈ arc }.
    pub fn erosion(&self, arc: &Arc) -> AngleSet {
        if self.is_full() {
            return AngleSet::full();
        }
        let fitting = self.arcs.iter().filter(|own| own.width() >= arc.width());
        AngleSet::from_arcs(
            fitting.map(|own| Arc::new(own.start() - arc.start(), own.width() - arc.width())),
        )
    }

    /// The set turned by `angle`.
    pub fn rotated(&self, angle: f64) -> AngleSet {
        AngleSet::from_arcs(self.arcs.iter().map(|arc| arc.rotated(angle)))
    }

    /// The mirror image { −x : x ∈ self }.
    pub fn mirrored(&self) -> AngleSet {
        AngleSet::from_arcs(self.arcs.iter().map(Arc::mirrored))
    }

    /// The set without its arcs of width at most `width` radians.
    pub fn without_narrow_arcs(&self, width: f64) -> AngleSet {
        AngleSet {
            arcs: self
                .arcs
                .iter()
                .filter(|arc| arc.width() > width)
                .copied()
                .collect(),
        }
    }

    /// The laws of the type: sorted, disjoint, starts in [−π, π), widths in [0, 2π].
    ///
    /// # Errors
    /// A sentence that names the broken law.
    pub fn check(&self) -> Result<(), String> {
        for arc in &self.arcs {
            if !(-PI..PI).contains(&arc.start()) || !(0.0..=TAU).contains(&arc.width()) {
                return Err(format!("arc out of range: {arc:?}"));
            }
        }
        if self.arcs.len() > 1 && self.arcs.iter().any(Arc::is_full) {
            return Err("a full circle beside other arcs".into());
        }
        for pair in self.arcs.windows(2) {
            if pair[1].start() <= pair[0].end() {
                return Err(format!("arcs not sorted and disjoint: {pair:?}"));
            }
        }
        match self.arcs.as_slice() {
            [first, .., last] if last.end() - TAU >= first.start() => {
                Err("the last arc runs into the first".into())
            }
            _ => Ok(()),
        }
    }

    /// Sorts the arcs and joins those that overlap or touch.
    fn normalise(&mut self) {
        if self.arcs.iter().any(Arc::is_full) {
            self.arcs.clear();
            self.arcs.push(Arc::FULL);
            return;
        }
        if self.arcs.len() <= 1 {
            return;
        }
        self.arcs
            .sort_unstable_by(|a, b| a.start().total_cmp(&b.start()));
        let mut kept = 0;
        for k in 1..self.arcs.len() {
            let (current, next) = (self.arcs[kept], self.arcs[k]);
            if next.start() <= current.end() + GAP_TOLERANCE {
                self.arcs[kept] = joined(current, next);
            } else {
                kept += 1;
                self.arcs[kept] = next;
            }
        }
        self.arcs.truncate(kept + 1);
        self.join_across_pi();
        if let Some(&full) = self.arcs.iter().find(|arc| arc.is_full()) {
            self.arcs.clear();
            self.arcs.push(full);
        }
    }

    /// Joins the last arc with the first ones if it reaches past π into them.
    fn join_across_pi(&mut self) {
        while self.arcs.len() > 1 {
            let (first, last) = (self.arcs[0], self.arcs[self.arcs.len() - 1]);
            if first.start() + TAU > last.end() + GAP_TOLERANCE {
                break;
            }
            let end = (first.end() + TAU).max(last.end());
            let index = self.arcs.len() - 1;
            self.arcs[index] = Arc::new(last.start(), end - last.start());
            self.arcs.remove(0);
        }
        if let [only] = self.arcs.as_slice()
            && only.width() >= TAU - GAP_TOLERANCE
        {
            self.arcs[0] = Arc::FULL;
        }
    }
}

impl From<Arc> for AngleSet {
    fn from(arc: Arc) -> AngleSet {
        AngleSet {
            arcs: SmallVec::from_iter([arc]),
        }
    }
}

fn joined(current: Arc, next: Arc) -> Arc {
    Arc::new(
        current.start(),
        current.width().max(next.end() - current.start()),
    )
}

/// Counter-clockwise gap from the end of `arc` to the start of `next` on a set's own order.
fn gap_width(arc: &Arc, next: &Arc) -> f64 {
    let gap = next.start() - arc.end();
    // The gap behind the last arc crosses ±π, also when that arc is the only one.
    if next.start() <= arc.start() {
        gap + TAU
    } else {
        gap
    }
}

/// Appends the at most two common pieces of two arcs, neither of which is full.
fn push_overlap(out: &mut SmallVec<[Arc; 6]>, a: &Arc, b: &Arc) {
    let offset = turn(a.start(), b.start());
    if offset <= a.width() {
        out.push(Arc::new(b.start(), b.width().min(a.width() - offset)));
    }
    // b may also come round the circle and cover the start of a.
    let tail = offset + b.width() - TAU;
    if offset > 0.0 && tail >= 0.0 {
        out.push(Arc::new(a.start(), tail.min(a.width())));
    }
}

fn overlap_width(a: &Arc, b: &Arc) -> f64 {
    let offset = turn(a.start(), b.start());
    let head = if offset <= a.width() {
        b.width().min(a.width() - offset)
    } else {
        0.0
    };
    let tail = (offset + b.width() - TAU).min(a.width());
    if offset > 0.0 {
        head + tail.max(0.0)
    } else {
        head
    }
}

/// Degrees as a result file writes them: `[lower, upper]` pairs, lower in [−180, 180), upper may
/// exceed 180; the full circle is [[−180, 180]], the empty set has no pair.
pub fn degree_pairs(set: &AngleSet) -> Vec<[f64; 2]> {
    set.arcs()
        .iter()
        .map(|arc| {
            if arc.is_full() {
                [-180.0, 180.0]
            } else {
                let start = wrap(arc.start());
                [start.to_degrees(), (start + arc.width()).to_degrees()]
            }
        })
        .collect()
}
