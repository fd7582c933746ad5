//! Directions in which the last of three links can point while the chain's end stays put.
//!
//! A chain of three links a, b, c with limited joints holds its end at distance ρ from its base.
//! The direction ψ of the last link (relative to the line from base to end) parametrises its
//! self-motion, once for either elbow. It is a union of arcs whose ends are closed forms:
//! joint 2 at a limit, stretched or folded (the wrist on a circle around the base), joint 1 at
//! a limit (the wrist on a circle around the elbow), joint 3 at a limit (links b and c rigid).

use super::chain::HELD_WIDTH;
use super::circle::Circle;
use crate::angle::{Arc, turn, wrap};
use crate::workspace::JointLimit;
use nalgebra::Complex;
use smallvec::SmallVec;
use std::f64::consts::{PI, TAU};

/// Cosines that pass a limit by this much count as inside. It widens a limit by less than
/// 1.5e-6 rad, and only matters for held joints, whose angle a computed solution meets to round-off.
const COSINE_SLACK: f64 = 1e-12;

/// Cells of ψ narrower than this (radians) are not tested.
const THIN_CELL: f64 = 1e-11;

/// The allowed directions of one joint, tested without trigonometry.
#[derive(Clone, Copy, Debug)]
struct Cone {
    /// Conjugate of the unit vector along the middle of the limits.
    middle: Complex<f64>,
    /// Cosine of half the width.
    cosine: f64,
}

impl Cone {
    fn new(limit: JointLimit) -> Cone {
        let half = 0.5 * (limit.upper - limit.lower);
        let full = limit.is_full();
        Cone {
            middle: Complex::from_polar(1.0, -limit.centre()),
            cosine: if full { -2.0 } else { half.cos() },
        }
    }

    /// Whether the vector `v` of length `norm` points into the cone.
    fn contains(&self, v: Complex<f64>, norm: f64) -> bool {
        (v * self.middle).re >= (self.cosine - COSINE_SLACK) * norm
    }
}

/// Three links whose joints are limited; joint 1's angle is that of link 1 against the x axis.
#[derive(Clone, Debug)]
pub(super) struct ThreeLinks {
    lengths: [f64; 3],
    limits: [JointLimit; 3],
    cones: [Cone; 3],
    held: [bool; 3],
    /// Distances of the wrist from the base at which joint 2 meets a limit, or is straight or folded.
    elbow_stops: SmallVec<[f64; 4]>,
    /// Links b and c rigid at either limit of joint 3: length, and the direction of c against it.
    rigid_ends: SmallVec<[(f64, f64); 2]>,
}

/// An arc of ψ that one elbow allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ElbowArc {
    pub arc: Arc,
    pub elbow_left: bool,
}

/// Arcs for both elbows.
pub(super) type ElbowArcs = SmallVec<[ElbowArc; 8]>;

impl ThreeLinks {
    pub fn new(lengths: [f64; 3], limits: [JointLimit; 3]) -> ThreeLinks {
        let [a, b, c] = lengths;
        let held = limits.map(|limit| limit.upper - limit.lower <= HELD_WIDTH);
        let ends = |limit: JointLimit| {
            let count = if limit.is_full() { 0 } else { 2 };
            [limit.lower, limit.upper].into_iter().take(count)
        };
        let rigid = |first: f64, second: f64, angle: f64| {
            let vector = first + Complex::from_polar(second, angle);
            (vector.norm(), angle - vector.arg())
        };
        let mut elbow_stops: SmallVec<[f64; 4]> =
            ends(limits[1]).map(|angle| rigid(a, b, angle).0).collect();
        if !held[1] {
            elbow_stops.extend([a + b, (a - b).abs()]);
        }
        ThreeLinks {
            lengths,
            limits,
            cones: limits.map(Cone::new),
            held,
            elbow_stops,
            rigid_ends: ends(limits[2]).map(|angle| rigid(b, c, angle)).collect(),
        }
    }

    /// Circles on which the structure of the directions can change, for a chain carried by a link
    /// of length `first` along the x axis: every circle that the end describes with some joints at
    /// a limit and the others in line with it.
    pub fn critical_circles(&self, first: f64) -> Vec<Circle> {
        let [a, b, c] = self.lengths;
        let ends = |joint: usize| {
            let limit = self.limits[joint];
            let count = if limit.is_full() { 0 } else { 2 };
            [limit.lower, limit.upper].into_iter().take(count)
        };
        let rigid = |length: f64, angle: f64, tip: f64| length + Complex::from_polar(tip, angle);
        let mut outer: Vec<f64> = ends(2).map(|angle| rigid(b, angle, c).norm()).collect();
        outer.extend([b + c, (b - c).abs()]);
        let axis = |radius: &f64| Circle::new(Complex::new(a, 0.0), *radius);
        let mut circles: Vec<Circle> = outer.iter().map(axis).collect();
        circles.extend(ends(1).map(|angle| Circle::new(rigid(a, angle, b), c)));
        let mut radii: Vec<f64> = circles
            .iter()
            .flat_map(|circle| [circle.nearest(), circle.farthest()])
            .collect();
        for bend in ends(1) {
            let vertex = |angle| (a + Complex::from_polar(1.0, bend) * rigid(b, angle, c)).norm();
            radii.extend(ends(2).map(vertex));
        }
        let base = Complex::new(first, 0.0);
        let around = radii.iter().map(|&radius| Circle::new(base, radius));
        let mut all: Vec<Circle> = around.collect();
        for angle in ends(0) {
            let turn = Complex::from_polar(1.0, angle);
            all.extend(
                circles
                    .iter()
                    .map(|circle| Circle::new(base + turn * circle.centre, circle.radius)),
            );
        }
        all
    }

    /// The arcs of ψ − arg `end` for which the chain reaches `end`.
    pub fn directions(&self, end: Complex<f64>) -> ElbowArcs {
        let (distance, bearing) = (end.norm(), end.arg());
        let turned = Complex::from_polar(1.0, bearing);
        let mut stops: SmallVec<[f64; 24]> = SmallVec::new();
        let mut found = ElbowArcs::new();
        if self.held.contains(&true) {
            self.stops_of_held_joint(distance, bearing, &mut stops);
            for &angle in &stops {
                let allowed = self.allows(distance, turned, angle);
                for (elbow_left, _) in [true, false].into_iter().zip(allowed).filter(|e| e.1) {
                    let arc = Arc::point(angle);
                    found.push(ElbowArc { arc, elbow_left });
                }
            }
            return found;
        }
        self.elbow_angles(distance, &mut stops);
        self.base_angles(distance, bearing, &mut stops);
        self.wrist_angles(distance, &mut stops);
        for stop in &mut stops {
            *stop = wrap(*stop);
        }
        stops.sort_unstable_by(f64::total_cmp);
        // One test of a cell's middle answers for both elbows.
        let inside: SmallVec<[[bool; 2]; 24]> = middles(&stops)
            .map(|middle| match middle {
                Some(angle) => self.allows(distance, turned, angle),
                None => [false; 2],
            })
            .collect();
        for (elbow, elbow_left) in [(0, true), (1, false)] {
            push_runs(&stops, |cell| inside[cell][elbow], elbow_left, &mut found);
        }
        found
    }

    /// Every angle at which a held joint has its one allowed value.
    fn stops_of_held_joint(&self, distance: f64, bearing: f64, stops: &mut SmallVec<[f64; 24]>) {
        if self.held[0] {
            self.base_angles(distance, bearing, stops);
        } else if self.held[1] {
            self.elbow_angles(distance, stops);
        } else {
            self.wrist_angles(distance, stops);
        }
        // Both limits of a held joint give the same angles.
        stops.sort_unstable_by(f64::total_cmp);
        stops.dedup_by(|next, kept| *next - *kept <= THIN_CELL);
    }

    /// Joint 2 at a limit, stretched or folded.
    fn elbow_angles(&self, distance: f64, stops: &mut SmallVec<[f64; 24]>) {
        let c = self.lengths[2];
        for &wrist in &self.elbow_stops {
            push_symmetric(distance, c, wrist, 0.0, stops);
        }
    }

    /// Joint 1 at a limit.
    fn base_angles(&self, distance: f64, bearing: f64, stops: &mut SmallVec<[f64; 24]>) {
        let [a, b, c] = self.lengths;
        if self.limits[0].is_full() {
            return;
        }
        for limit in [self.limits[0].lower, self.limits[0].upper] {
            let elbow = Complex::from_polar(a, limit - bearing);
            let rest = distance - elbow;
            push_symmetric(rest.norm(), c, b, rest.arg(), stops);
        }
    }

    /// Joint 3 at a limit.
    fn wrist_angles(&self, distance: f64, stops: &mut SmallVec<[f64; 24]>) {
        for &(length, bend) in &self.rigid_ends {
            push_symmetric(distance, length, self.lengths[0], bend, stops);
        }
    }

    /// Whether the chain reaches (`distance`, 0) inside its limits with the last link at `angle`,
    /// for the left and the right elbow. `turned` is the unit vector of the end's bearing, which
    /// joint 1's limits refer to.
    fn allows(&self, distance: f64, turned: Complex<f64>, angle: f64) -> [bool; 2] {
        let [a, b, c] = self.lengths;
        let last = Complex::from_polar(1.0, angle);
        let wrist = distance - last * c;
        let wrist2 = wrist.norm_sqr();
        let cosine = (wrist2 - a * a - b * b) / (2.0 * a * b);
        if !(-1.0 - COSINE_SLACK..=1.0 + COSINE_SLACK).contains(&cosine) {
            return [false; 2];
        }
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        [sine, -sine].map(|sine| {
            let second = Complex::new(cosine, sine);
            if !self.cones[1].contains(second, 1.0) {
                return false;
            }
            // Pointing along link 1 and |wrist|² long.
            let first = wrist * (a + second * b).conj();
            self.cones[0].contains(first * turned, wrist2)
                && self.cones[2].contains(last * (first * second).conj(), wrist2)
        })
    }
}

/// Middles of the cells between sorted `stops` around the circle; none for thin cells. Without
/// stops the circle is one cell.
fn middles(stops: &[f64]) -> impl Iterator<Item = Option<f64>> + '_ {
    let whole = stops.is_empty().then_some(Some(PI));
    let cells = (0..stops.len()).map(|k| {
        let end = stops.get(k + 1).copied().unwrap_or(stops[0] + TAU);
        (end - stops[k] > THIN_CELL).then_some(0.5 * (stops[k] + end))
    });
    whole.into_iter().chain(cells)
}

/// Directions ψ of a link of length `link` that ends at `base` (a distance along x) and starts
/// `reach` away from the origin: turned ± acos((base² + link² − reach²) / (2·base·link)).
fn push_symmetric(base: f64, link: f64, reach: f64, turned: f64, stops: &mut SmallVec<[f64; 24]>) {
    let cosine = (base * base + link * link - reach * reach) / (2.0 * base * link);
    if cosine.abs() <= 1.0 + COSINE_SLACK {
        let half = cosine.clamp(-1.0, 1.0).acos();
        stops.push(turned + half);
        stops.push(turned - half);
    }
}

/// Appends the maximal runs of allowed cells between sorted `stops`; thin cells belong to the run
/// before them.
fn push_runs(
    stops: &[f64],
    allowed: impl Fn(usize) -> bool,
    elbow_left: bool,
    found: &mut ElbowArcs,
) {
    let mut push = |arc| found.push(ElbowArc { arc, elbow_left });
    let Some(&first) = stops.first() else {
        if allowed(0) {
            push(Arc::FULL);
        }
        return;
    };
    let mut run: Option<f64> = None;
    let mut opening = None;
    for k in 0..stops.len() {
        let (start, end) = (stops[k], stops.get(k + 1).copied().unwrap_or(first + TAU));
        let thin = end - start <= THIN_CELL;
        let inside = if thin { run.is_some() } else { allowed(k) };
        match (inside, run) {
            (true, None) => run = Some(start),
            (false, Some(from)) => {
                if from == first && opening.is_none() {
                    opening = Some(start);
                } else {
                    push(Arc::from_interval(from, start));
                }
                run = None;
            }
            _ => {}
        }
    }
    match (run, opening) {
        (Some(from), None) if from == first => push(Arc::FULL),
        (Some(from), None) => push(Arc::from_interval(from, first + TAU)),
        (Some(from), Some(to)) => push(Arc::from_interval(from, to + TAU)),
        (None, Some(to)) => push(Arc::new(first, turn(first, to))),
        (None, None) => {}
    }
}
