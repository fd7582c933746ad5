//! The rings of a position task's workspace, cut finer where arcs appear, end, split or merge, so
//! that a rounded tip does not look like stairs.
//!
//! Between the middle radii of two rings an arc that has no successor shrinks like the tip of a
//! rounded shape, the square of its width linear in the radius, as its last two rings foretell. If
//! they foretell no end before the next ring, the arc ends bluntly halfway. A gap that closes is
//! an arc of the complement that ends.

use crate::angle::{AngleSet, Arc, turn, wrap};
use crate::workspace::{Ring, RingMap};

/// Cuts between the middles of two rings; even, so that blunt ends lie on a cut.
const CUTS: usize = 8;

/// A tip foretold to end within this many rings is rounded; it ends before the next ring all the
/// same. More than one, as a circle's tip ends a little earlier than foretold.
const ROUND: f64 = 2.0;

/// A thin ring with its angles at the radius `at`.
#[derive(Clone)]
pub(super) struct Slice {
    pub inner: f64,
    pub outer: f64,
    pub at: f64,
    pub set: AngleSet,
}

/// The slices of a map in order of radius.
pub(super) fn slices(map: &RingMap) -> Vec<Slice> {
    let rings: Vec<&Ring> = map.rings.iter().filter(|ring| is_drawable(ring)).collect();
    let runs = rings.chunk_by(|a, b| {
        (b.inner - a.outer).abs() <= 1e-3 * (b.outer - b.inner).min(a.outer - a.inner)
    });
    runs.flat_map(|run| refined(run.iter().map(|ring| whole(ring)).collect()))
        .collect()
}

fn is_drawable(ring: &Ring) -> bool {
    ring.inner.is_finite() && ring.outer.is_finite() && 0.0 <= ring.inner && ring.inner < ring.outer
}

/// The slices of rings without a space between them.
pub(super) fn refined(mut rows: Vec<Slice>) -> Vec<Slice> {
    let [Some(first), Some(last)] = [rows.first(), rows.last()] else {
        return rows;
    };
    let below = empty(2.0 * first.inner - first.at);
    let above = empty(2.0 * last.outer - last.at);
    rows.insert(0, below);
    rows.push(above);
    let nothing = AngleSet::empty();
    let mut fine = Vec::new();
    for k in 1..rows.len() {
        let (low, high) = (rows[k - 1].clone(), rows[k].clone());
        if pairs(&low.set, &high.set).is_none() {
            let before = k.checked_sub(2).map_or(&nothing, |k| &rows[k].set);
            let after = rows.get(k + 1).map_or(&nothing, |row| &row.set);
            fine.extend(cut(before, &low, &high, after));
            rows[k - 1].outer = low.at;
            rows[k].inner = high.at;
        }
    }
    fine.extend(rows);
    fine.retain(|slice| slice.inner <= slice.outer && !slice.set.is_empty());
    fine.sort_by(|a, b| (a.inner + a.outer).total_cmp(&(b.inner + b.outer)));
    fine
}

fn whole(ring: &Ring) -> Slice {
    Slice {
        inner: ring.inner,
        outer: ring.outer,
        at: 0.5 * (ring.inner + ring.outer),
        set: ring.rotation_set.clone(),
    }
}

fn empty(at: f64) -> Slice {
    Slice {
        inner: at,
        outer: at,
        at,
        set: AngleSet::empty(),
    }
}

/// The arcs of two sets in pairs that follow each other, or none if the arcs do not match.
fn pairs(a: &AngleSet, b: &AngleSet) -> Option<Vec<(Arc, Arc)>> {
    let partners = |arc: &Arc, set: &AngleSet| -> Vec<Arc> {
        let all = set.arcs().iter().copied();
        all.filter(|other| meet(arc, other)).collect()
    };
    if !b.arcs().iter().all(|arc| partners(arc, a).len() == 1) {
        return None;
    }
    let pair = |arc: &Arc| match partners(arc, b).as_slice() {
        [other] if arc.is_full() == other.is_full() => Some((*arc, *other)),
        _ => None,
    };
    a.arcs().iter().map(pair).collect()
}

/// Whether two closed arcs have an angle in common.
pub(super) fn meet(a: &Arc, b: &Arc) -> bool {
    turn(a.start(), b.start()) <= a.width() || turn(b.start(), a.start()) <= b.width()
}

/// Slices between the middles of `low` and `high`; `before` and `after` are the sets around them.
fn cut(before: &AngleSet, low: &Slice, high: &Slice, after: &AngleSet) -> Vec<Slice> {
    let up = Ends::new(before, &low.set, &high.set);
    let down = Ends::new(after, &high.set, &low.set);
    let [low_body, high_body] = [&up, &down].map(|ends| &ends.body);
    let pairs = pairs(low_body, high_body);
    let slice = |k: usize| {
        let t = (k as f64 + 0.5) / CUTS as f64;
        let body = match &pairs {
            Some(pairs) => AngleSet::from_arcs(pairs.iter().map(|(a, b)| mixed(a, b, t))),
            None if t < 0.5 => low_body.clone(),
            None => high_body.clone(),
        };
        let both = [up.at(t), down.at(1.0 - t)];
        let [gaps, arcs] = [0, 1].map(|k| both[0][k].union(&both[1][k]));
        let radius = |t: f64| low.at + t * (high.at - low.at);
        Slice {
            inner: radius(k as f64 / CUTS as f64),
            outer: radius((k + 1) as f64 / CUTS as f64),
            at: radius(t),
            set: body.intersection(&gaps.complement()).union(&arcs),
        }
    };
    (0..CUTS).map(slice).collect()
}

/// The arc on the way from `a` (t = 0) to `b` (t = 1).
fn mixed(a: &Arc, b: &Arc, t: f64) -> Arc {
    let width = a.width() + t * (b.width() - a.width());
    let centre = a.centre() + t * wrap(b.centre() - a.centre());
    Arc::new(centre - 0.5 * width, width)
}

/// What of a ring does not reach the next one.
struct Ends {
    gaps: Vec<Tip>,
    arcs: Vec<Tip>,
    /// The ring without its ending arcs and gaps.
    body: AngleSet,
}

impl Ends {
    /// The ends of `near` on the way to `far`, with `behind` on the other side.
    fn new(behind: &AngleSet, near: &AngleSet, far: &AngleSet) -> Ends {
        let arcs = tips(behind, near, far);
        let gaps = tips(&behind.complement(), &near.complement(), &far.complement());
        let ends: Vec<Arc> = arcs.iter().map(|tip| tip.arc).collect();
        let lasting = near.arcs().iter().filter(|arc| !ends.contains(arc));
        let closed = gaps.iter().map(|tip| &tip.arc);
        let body = AngleSet::from_arcs(lasting.chain(closed).copied());
        Ends { gaps, arcs, body }
    }

    /// What is left of the gaps and of the arcs at the share `t` of the way.
    fn at(&self, t: f64) -> [AngleSet; 2] {
        [&self.gaps, &self.arcs]
            .map(|tips| AngleSet::from_arcs(tips.iter().filter_map(|tip| tip.at(t))))
    }
}

/// An arc that ends on the way to the next ring.
struct Tip {
    arc: Arc,
    /// Where a rounded arc ends, as a share of the way, and how far its centre turns on all of
    /// it; none for a blunt end.
    round: Option<(f64, f64)>,
}

fn tips(behind: &AngleSet, near: &AngleSet, far: &AngleSet) -> Vec<Tip> {
    let ending = |arc: &&Arc| !far.arcs().iter().any(|other| meet(arc, other));
    let tip = |arc: &Arc| {
        let mut roots = behind.arcs().iter().filter(|other| meet(arc, other));
        let root = roots.next().filter(|_| roots.next().is_none());
        let round = root.and_then(|root| {
            let [here, there] = [arc, root].map(|arc| arc.width().powi(2));
            let end = here / (there - here);
            let drift = wrap(arc.centre() - root.centre());
            (there > here && end <= ROUND).then_some((end.min(1.0), drift))
        });
        Tip { arc: *arc, round }
    };
    near.arcs().iter().filter(ending).map(tip).collect()
}

impl Tip {
    fn at(&self, t: f64) -> Option<Arc> {
        let Some((end, drift)) = self.round else {
            return (t < 0.5).then_some(self.arc);
        };
        let width = self.arc.width() * (1.0 - t / end).max(0.0).sqrt();
        let centre = self.arc.centre() + t * drift;
        (t < end).then(|| Arc::new(centre - 0.5 * width, width))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rings of thickness 0.02 across a disc of radius 0.5 at 2, or across all but that disc.
    fn disc(shift: f64, is_hole: bool) -> RingMap {
        let ring = |k: usize| {
            let inner = 1.0 + shift + 0.02 * k as f64;
            let r: f64 = inner + 0.01;
            let cosine = (r * r + 4.0 - 0.25) / (4.0 * r);
            let arcs = (cosine < 1.0).then(|| Arc::from_interval(-cosine.acos(), cosine.acos()));
            let set = AngleSet::from_arcs(arcs);
            Ring {
                inner,
                outer: inner + 0.02,
                rotation_set: if is_hole { set.complement() } else { set },
            }
        };
        RingMap {
            unrestricted: [0.0, 3.0],
            rings: (0..90).map(ring).collect(),
        }
    }

    #[test]
    fn tips_of_arcs_and_gaps_are_rounded() {
        for (shift, is_hole) in (0..20).map(|k| (0.001 * f64::from(k), k % 2 == 0)) {
            let slices = slices(&disc(shift, is_hole));
            let width = |slice: &Slice| match is_hole {
                true => slice.set.complement().measure(),
                false => slice.set.measure(),
            };
            let inside: Vec<&Slice> = slices.iter().filter(|s| width(s) > 0.0).collect();
            let [first, last] = [inside[0], inside[inside.len() - 1]];
            assert!(
                (first.inner - 1.5).abs() < 0.005,
                "{shift}: {}",
                first.inner
            );
            assert!((last.outer - 2.5).abs() < 0.005, "{shift}: {}", last.outer);
            for slice in inside {
                let r: f64 = slice.at;
                let cosine = (r * r + 4.0 - 0.25) / (4.0 * r);
                let exact = 2.0 * cosine.min(1.0).acos();
                assert!((width(slice) - exact).abs() < 0.05, "{r}: {exact}");
            }
            let covers = |pair: &[Slice]| (pair[0].outer - pair[1].inner).abs() < 1e-9;
            assert!(slices.windows(2).all(covers));
        }
    }

    #[test]
    fn blunt_ends_stay_at_the_edge_of_their_ring() {
        let ring = |k: usize| Ring {
            inner: k as f64,
            outer: k as f64 + 1.0,
            rotation_set: AngleSet::from_arcs([Arc::from_interval(0.0, 1.0)]),
        };
        let map = RingMap {
            unrestricted: [0.0, 9.0],
            rings: vec![ring(2), ring(3)],
        };
        let slices = slices(&map);
        let edges = [slices[0].inner, slices[slices.len() - 1].outer];
        assert_eq!(edges, [2.0, 4.0]);
        assert!(slices.iter().all(|s| (s.set.measure() - 1.0).abs() < 1e-9));
    }
}
