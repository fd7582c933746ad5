//! Laws of sets of angles, for random sets: against an exact model on a lattice of angles, and as
//! algebra with random real numbers.

use faultspace::angle::{AngleSet, Arc, degree_pairs, turn, wrap};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// Round-off allowed in angles and measures, far above the library's gap tolerance of 1e-12.
const NEAR: f64 = 1e-9;

// --- An exact model -------------------------------------------------------------------------

/// Cells of 5° around the circle; an arc between lattice angles is a run of cells, a set a mask.
/// Single angles cover no cell, so the model knows sets up to finitely many angles.
const CELLS: usize = 72;

type Mask = [bool; CELLS];

/// An arc from lattice angle `start` over `cells` cells, as set and as mask.
#[derive(Clone, Copy, Debug)]
struct LatticeArc {
    start: usize,
    cells: usize,
}

impl LatticeArc {
    fn arc(self) -> Arc {
        // Also unwrapped starts, on either side of ±π.
        let start = angle(self.start)
            - if self.start.is_multiple_of(2) {
                TAU
            } else {
                0.0
            };
        Arc::new(start, angle(self.cells))
    }
}

fn angle(cells: usize) -> f64 {
    (5.0 * cells as f64).to_radians()
}

fn mask(arcs: &[LatticeArc]) -> Mask {
    let mut mask = [false; CELLS];
    for arc in arcs {
        for k in 0..arc.cells {
            mask[(arc.start + k) % CELLS] = true;
        }
    }
    mask
}

fn set(arcs: &[LatticeArc]) -> AngleSet {
    AngleSet::from_arcs(arcs.iter().map(|arc| arc.arc()))
}

/// The cells whose middle the set contains; also that it holds all of such a cell, none of others.
fn cells_of(set: &AngleSet) -> Mask {
    let mut mask = [false; CELLS];
    for (k, covered) in mask.iter_mut().enumerate() {
        let at = |share: f64| set.contains(angle(k) + share * angle(1));
        *covered = at(0.5);
        for share in [0.001, 0.25, 0.75, 0.999] {
            assert_eq!(at(share), *covered, "cell {k} is cut: {set:?}");
        }
    }
    let covered = mask.iter().filter(|c| **c).count();
    assert!((set.measure() - angle(covered)).abs() < NEAR, "{set:?}");
    mask
}

fn zip(a: Mask, b: Mask, rule: fn(bool, bool) -> bool) -> Mask {
    std::array::from_fn(|k| rule(a[k], b[k]))
}

/// Angles k for which cell `k + y` is covered for some (or every) y of `arc`. While an angle
/// runs through a cell, its sums with an arc of w cells run through w + 1.
fn eroded(mask: Mask, arc: LatticeArc) -> Mask {
    let covered = |k: usize, y: usize| mask[(k + arc.start + y) % CELLS];
    std::array::from_fn(|k| {
        arc.cells >= CELLS && mask == [true; CELLS]
            || arc.cells < CELLS && (0..=arc.cells).all(|y| covered(k, y))
    })
}

fn summed(mask: Mask, arc: LatticeArc) -> Mask {
    let mut sum = [false; CELLS];
    for (k, covered) in mask.iter().enumerate() {
        for y in 0..=arc.cells {
            sum[(k + arc.start + y) % CELLS] |= covered;
        }
    }
    sum
}

/// Zero-width, narrow, wide and full arcs, as often touching as not.
fn lattice_arc() -> impl Strategy<Value = LatticeArc> {
    let cells = prop_oneof![Just(0), 1..4usize, 1..CELLS, Just(CELLS)];
    (0..CELLS, cells).prop_map(|(start, cells)| LatticeArc { start, cells })
}

fn lattice_arcs() -> impl Strategy<Value = Vec<LatticeArc>> {
    let short = (0..CELLS, 0..10usize).prop_map(|(start, cells)| LatticeArc { start, cells });
    prop_oneof![
        prop::collection::vec(short, 0..8),
        prop::collection::vec(lattice_arc(), 0..4),
    ]
}

// --- Random real sets -----------------------------------------------------------------------

/// Any arc: full, zero-width, narrow, across ±π, with a start many turns away.
fn arc() -> impl Strategy<Value = Arc> {
    let start = prop_oneof![-20.0..20.0, Just(PI), Just(-PI), Just(0.0)];
    let width = prop_oneof![
        1 => Just(0.0), 1 => Just(TAU), 2 => 0.0..1e-6, 6 => 0.0..1.0, 3 => 0.0..TAU
    ];
    (start, width).prop_map(|(start, width)| Arc::new(start, width))
}

fn any_set() -> impl Strategy<Value = AngleSet> {
    prop::collection::vec(arc(), 0..7).prop_map(AngleSet::from_arcs)
}

/// Whether every angle of `inner` lies in `outer` or within `NEAR` of it.
fn within(inner: &AngleSet, outer: &AngleSet) -> bool {
    let arcs = outer.arcs().iter();
    let wider: Vec<Arc> = arcs
        .map(|arc| {
            if arc.is_full() {
                *arc
            } else {
                Arc::new(arc.start() - NEAR, arc.width() + 2.0 * NEAR)
            }
        })
        .collect();
    // A union of closed arcs covers an arc if it covers its ends and the ends of the arcs that cut it.
    let wider = AngleSet::from_arcs(wider);
    inner.arcs().iter().all(|arc| wider.contains_arc(arc))
}

/// Equal up to round-off, single angles included.
fn alike(a: &AngleSet, b: &AngleSet) -> bool {
    within(a, b) && within(b, a) && (a.measure() - b.measure()).abs() < NEAR
}

/// Equal up to round-off and finitely many angles.
fn almost_alike(a: &AngleSet, b: &AngleSet) -> bool {
    let outside = |x: &AngleSet, y: &AngleSet| x.intersection(&y.complement()).measure();
    outside(a, b) < NEAR && outside(b, a) < NEAR
}

fn checked(set: AngleSet) -> AngleSet {
    assert_eq!(set.check(), Ok(()), "{set:?}");
    set
}

/// Whether `x` is too close to an end of an arc to say on which side it lies.
fn at_an_end(set: &AngleSet, x: f64) -> bool {
    set.arcs().iter().any(|arc| {
        !arc.is_full()
            && [arc.start(), arc.end()]
                .iter()
                .any(|end| wrap(x - end).abs() < NEAR)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn boolean_operations_agree_with_the_lattice(a in lattice_arcs(), b in lattice_arcs()) {
        let (sa, sb) = (checked(set(&a)), checked(set(&b)));
        let (ma, mb) = (mask(&a), mask(&b));
        prop_assert_eq!(cells_of(&sa), ma);
        prop_assert_eq!(cells_of(&checked(sa.union(&sb))), zip(ma, mb, |x, y| x || y));
        prop_assert_eq!(cells_of(&checked(sa.intersection(&sb))), zip(ma, mb, |x, y| x && y));
        prop_assert_eq!(cells_of(&checked(sa.complement())), ma.map(|x| !x));
    }

    #[test]
    fn erosion_and_sum_agree_with_the_lattice(a in lattice_arcs(), by in lattice_arc()) {
        let (s, m) = (set(&a), mask(&a));
        prop_assert_eq!(cells_of(&checked(s.erosion(&by.arc()))), eroded(m, by));
        // Single angles are members, too: their sum with an arc covers cells.
        let points = a.iter().filter(|arc| arc.cells == 0);
        let turned: Vec<LatticeArc> = points
            .map(|p| LatticeArc { start: (p.start + by.start) % CELLS, cells: by.cells })
            .collect();
        let expected = zip(summed(m, by), mask(&turned), |x, y| x || y);
        prop_assert_eq!(cells_of(&checked(s.sum(&by.arc()))), expected);
    }

    /// Closed sets hold the ends of their arcs, whichever turn an angle is written on.
    #[test]
    fn ends_and_single_angles_are_members(a in lattice_arcs()) {
        let s = set(&a);
        for arc in &a {
            for cells in [arc.start, arc.start + arc.cells] {
                let member = s.arcs().iter().any(|own| own.contains_within(angle(cells), NEAR));
                prop_assert!(member, "{cells} is not in {s:?}");
            }
        }
    }

    #[test]
    fn union_and_intersection_are_commutative(a in any_set(), b in any_set()) {
        prop_assert!(alike(&checked(a.union(&b)), &checked(b.union(&a))));
        prop_assert!(alike(&checked(a.intersection(&b)), &checked(b.intersection(&a))));
    }

    #[test]
    fn union_and_intersection_are_associative(a in any_set(), b in any_set(), c in any_set()) {
        prop_assert!(alike(&a.union(&b).union(&c), &a.union(&b.union(&c))));
        let (left, right) = (a.intersection(&b).intersection(&c), a.intersection(&b.intersection(&c)));
        prop_assert!(almost_alike(&checked(left), &checked(right)));
    }

    #[test]
    fn they_distribute_and_absorb(a in any_set(), b in any_set(), c in any_set()) {
        prop_assert!(alike(&a.union(&a.intersection(&b)), &a));
        prop_assert!(alike(&a.intersection(&a.union(&b)), &a));
        let left = a.intersection(&b.union(&c));
        prop_assert!(almost_alike(&left, &a.intersection(&b).union(&a.intersection(&c))));
    }

    /// Complements are closed, so these laws hold up to the ends of arcs.
    #[test]
    fn de_morgan(a in any_set(), b in any_set()) {
        let (not_a, not_b) = (checked(a.complement()), checked(b.complement()));
        prop_assert!(almost_alike(&a.union(&b).complement(), &not_a.intersection(&not_b)));
        prop_assert!(almost_alike(&a.intersection(&b).complement(), &not_a.union(&not_b)));
        prop_assert!(almost_alike(&not_a.complement(), &a));
    }

    #[test]
    fn a_set_and_its_complement_fill_the_circle(a in any_set()) {
        let rest = a.complement();
        prop_assert!((a.measure() + rest.measure() - TAU).abs() < NEAR);
        prop_assert!(a.overlap(&rest) < NEAR);
        prop_assert!(a.union(&rest).measure() > TAU - NEAR);
    }

    #[test]
    fn measures_add_up(a in any_set(), b in any_set()) {
        let (or, and) = (a.union(&b).measure(), a.intersection(&b).measure());
        prop_assert!((or + and - a.measure() - b.measure()).abs() < NEAR);
        prop_assert!((a.overlap(&b) - and).abs() < NEAR);
        prop_assert!((a.overlap(&b) - b.overlap(&a)).abs() < NEAR);
    }

    #[test]
    fn membership_is_that_of_the_operation(a in any_set(), b in any_set(), xs in prop::collection::vec(-9.0..9.0, 40)) {
        let (or, and, not) = (a.union(&b), a.intersection(&b), a.complement());
        for x in xs {
            if !at_an_end(&a, x) && !at_an_end(&b, x) {
                prop_assert_eq!(or.contains(x), a.contains(x) || b.contains(x));
                prop_assert_eq!(and.contains(x), a.contains(x) && b.contains(x));
                prop_assert_eq!(not.contains(x), !a.contains(x));
            }
            prop_assert_eq!(a.contains(x), a.contains(wrap(x)));
        }
    }

    /// Erosion is the adjoint of the Minkowski sum: what is summed and eroded again is no less, what is
    /// eroded and summed again no more. That W₁ is a subset of what W₀ could reach rests on it.
    #[test]
    fn erosion_is_the_adjoint_of_the_sum(s in any_set(), by in arc()) {
        let closing = checked(checked(s.sum(&by)).erosion(&by));
        prop_assert!(within(&s, &closing), "{s:?} is not in {closing:?}");
        let opening = checked(checked(s.erosion(&by)).sum(&by));
        prop_assert!(within(&opening, &s), "{opening:?} is not in {s:?}");
    }

    /// The definitions { x : x + y ∈ S for every y ∈ A } and { s + y }, by sampling.
    #[test]
    fn erosion_and_sum_keep_their_definitions(s in any_set(), by in arc(), xs in prop::collection::vec(-PI..PI, 10)) {
        let (eroded, sum) = (s.erosion(&by), s.sum(&by));
        let steps = 64;
        let of = |arc: &Arc, k: usize| arc.start() + arc.width() * k as f64 / steps as f64;
        for own in eroded.arcs() {
            for j in 0..=steps {
                for k in [0, 1, 17, 40, steps] {
                    let at = of(own, j) + of(&by, k);
                    let member = s.arcs().iter().any(|a| a.contains_within(at, NEAR));
                    prop_assert!(member, "{at} is not in {s:?}");
                }
            }
        }
        for own in s.arcs() {
            for j in [0, 9, 33, steps] {
                for k in 0..=steps {
                    let at = of(own, j) + of(&by, k);
                    prop_assert!(sum.arcs().iter().any(|a| a.contains_within(at, NEAR)));
                }
            }
        }
        // And nothing else: outside the erosion some y leads out of S …
        let outside = s.complement();
        for x in xs {
            if !at_an_end(&eroded, x) && !eroded.contains(x) {
                let turned = Arc::new(by.start() + x, by.width());
                let out = AngleSet::from(turned).overlap(&outside) > 0.0
                    || (by.width() <= NEAR && !s.contains(turned.centre()));
                prop_assert!(out || at_an_end(&s, by.start() + x) || at_an_end(&s, by.end() + x));
            }
            // … and outside the sum no y leads back into S.
            if !at_an_end(&sum, x) && !sum.contains(x) {
                let back = Arc::new(x - by.end(), by.width());
                prop_assert!(AngleSet::from(back).overlap(&s) < NEAR);
            }
        }
    }

    #[test]
    fn turning_and_mirroring_keep_the_measure(s in any_set(), by in -20.0..20.0) {
        let (turned, mirrored) = (checked(s.rotated(by)), checked(s.mirrored()));
        prop_assert!((turned.measure() - s.measure()).abs() < NEAR);
        prop_assert!((mirrored.measure() - s.measure()).abs() < NEAR);
        prop_assert!(alike(&turned.rotated(-by), &s));
        prop_assert!(alike(&mirrored.mirrored(), &s));
        for x in [-2.9, -1.0, 0.3, 2.2] {
            if !at_an_end(&s, x) {
                prop_assert_eq!(turned.contains(x + by), s.contains(x));
                prop_assert_eq!(mirrored.contains(-x), s.contains(x));
            }
        }
    }

    /// What a result file says is the set.
    #[test]
    fn degree_pairs_round_trip(s in any_set()) {
        let pairs = degree_pairs(&s);
        for &[lower, upper] in &pairs {
            prop_assert!((-180.0..180.0).contains(&lower), "{lower}");
            prop_assert!(lower <= upper && upper <= lower + 360.0, "{lower} {upper}");
        }
        prop_assert!(pairs.windows(2).all(|p| p[0][1] < p[1][0]));
        let arcs = pairs.iter().map(|p| Arc::from_interval(p[0].to_radians(), p[1].to_radians()));
        let back = AngleSet::from_arcs(arcs);
        prop_assert!(alike(&back, &s), "{back:?} instead of {s:?}");
        prop_assert_eq!(back.is_full(), s.is_full());
    }

    #[test]
    fn turns_and_wraps(a in -50.0..50.0f64, b in -50.0..50.0f64) {
        prop_assert!((-PI..PI).contains(&wrap(a)));
        prop_assert!((0.0..TAU).contains(&turn(a, b)));
        prop_assert!(wrap(a + turn(a, b) - b).abs() < NEAR);
    }
}

#[test]
fn conventions_of_degree_pairs() {
    let pairs = |arcs: &[(f64, f64)]| {
        let arcs = arcs
            .iter()
            .map(|(l, u)| Arc::from_interval(l.to_radians(), u.to_radians()));
        degree_pairs(&AngleSet::from_arcs(arcs))
    };
    assert_eq!(pairs(&[]), Vec::<[f64; 2]>::new());
    assert_eq!(pairs(&[(0.0, 360.0)]), [[-180.0, 180.0]]);
    assert_eq!(pairs(&[(-90.0, 90.0), (90.0, 270.0)]), [[-180.0, 180.0]]);
    let near = |found: Vec<[f64; 2]>, expected: &[[f64; 2]]| {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (f, e) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!((f - e).abs() < 1e-9, "{found:?}");
        }
    };
    // Across 180°: one pair whose upper end exceeds 180.
    near(pairs(&[(170.0, 190.0)]), &[[170.0, 190.0]]);
    near(pairs(&[(-190.0, -170.0)]), &[[170.0, 190.0]]);
    // From 180° on is from −180° on.
    near(pairs(&[(180.0, 200.0)]), &[[-180.0, -160.0]]);
    // Written on another turn, touching, overlapping, single.
    near(pairs(&[(720.0, 730.0), (10.0, 20.0)]), &[[0.0, 20.0]]);
    near(
        pairs(&[(40.0, 40.0), (0.0, 1.0)]),
        &[[0.0, 1.0], [40.0, 40.0]],
    );
}

/// Two half circles share exactly the two angles at which they meet.
#[test]
fn touching_arcs_meet_in_single_angles() {
    let right = AngleSet::from(Arc::new(-1.0, 2.0));
    let left = AngleSet::from(Arc::new(1.0, TAU - 2.0));
    let common = checked(right.intersection(&left));
    assert_eq!(common.measure(), 0.0);
    assert_eq!(common.arcs().len(), 2, "{common:?}");
    assert!(common.contains(1.0));
    assert!(checked(right.union(&left)).is_full());
    assert!(common.without_narrow_arcs(0.0).is_empty());
}

/// Single angles: members of a set, without measure, gone from the complement's complement.
#[test]
fn single_angles() {
    let point = AngleSet::from(Arc::point(PI));
    assert!(!point.is_empty() && point.measure() == 0.0);
    assert!(point.contains(-PI) && point.contains(PI) && point.contains(3.0 * PI));
    assert!(point.complement().is_full());
    assert!(point.complement().complement().is_empty());
    // Eroding an arc by itself leaves one angle; by more, none.
    let arc = Arc::new(3.0, 1.0);
    let eroded = AngleSet::from(arc).erosion(&arc);
    assert!(eroded.measure() == 0.0 && eroded.contains(0.0));
    assert!(AngleSet::from(arc).erosion(&Arc::new(3.0, 1.1)).is_empty());
}

/// The full circle minus an angle is, closed, the full circle; only a full set survives erosion by
/// the full circle.
#[test]
fn the_full_circle() {
    let full = AngleSet::full();
    assert!(full.is_full() && full.measure() == TAU);
    assert!(full.complement().is_empty() && AngleSet::empty().complement().is_full());
    assert!(full.erosion(&Arc::FULL).is_full());
    assert!(
        AngleSet::from(Arc::new(0.0, 6.2))
            .erosion(&Arc::FULL)
            .is_empty()
    );
    assert!(AngleSet::empty().erosion(&Arc::point(1.0)).is_empty());
    assert!(AngleSet::empty().sum(&Arc::FULL).is_empty());
    assert!(AngleSet::from(Arc::point(1.0)).sum(&Arc::FULL).is_full());
    assert!(Arc::new(5.0, 7.0).is_full());
}
