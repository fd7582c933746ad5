//! Sets of angles on the part of a surface inside a box, from curves on it.

use super::ascent::Ascent;
use super::cuts::Held;
use super::extents::Extent;
use super::self_motion::SelfMotionManifold;
use super::surface::{Surface, SurfaceSlice, is_missing, lies_inside};
use super::within::runs_in_box;
use crate::angle::{AngleSet, Arc, turn};
use crate::kinematics::Goal;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Parts of a segment between which a curve is looked at, by the number of joints held. A segment
/// is at most 0.4 rad long; with two joints held there are many curves, and walks do the rest.
const PARTS: [usize; 2] = [64, 16];

/// Slack of a box, radians: curves and Newton steps end within this of the surface.
const SLACK: f64 = 1e-6;

/// Times that gaps and landings are looked into; each round halves what is left, or ends it.
const ROUNDS: usize = 4;

/// Most curves from which the end of an arc is walked on: also those that end a little before it
/// may lie on a part of the surface that goes farther.
const WALKS: usize = 48;

impl SurfaceSlice {
    /// The arcs that `joint` sweeps on the parts of the curves inside `bounds`.
    pub(super) fn arcs_inside(&self, joint: usize, bounds: &[Arc]) -> Vec<Arc> {
        let extents = self.extents(bounds);
        let own = extents.iter().filter(|extent| extent.joint == joint);
        own.map(|extent| extent.arc).collect()
    }

    /// The arcs that every joint sweeps on the parts of the curves inside `bounds`.
    fn extents(&self, bounds: &[Arc]) -> Vec<Extent> {
        let parts = PARTS[(self.held.len() - 1).min(1)];
        let mut free = bounds.to_vec();
        for &(joint, value) in &self.held {
            if !bounds[joint].contains_within(value, SLACK) {
                return Vec::new();
            }
            free[joint] = Arc::FULL;
        }
        let curves = self.curves.iter();
        curves
            .flat_map(|curve| extents(curve, parts, &free))
            .collect()
    }
}

fn extents(curve: &SelfMotionManifold, parts: usize, bounds: &[Arc]) -> Vec<Extent> {
    let runs = runs_in_box(curve, parts, bounds).into_iter();
    runs.flat_map(|run| {
        let is_whole = run.ends.is_empty();
        let each = run.spans.into_iter().zip(run.extremes).enumerate();
        each.map(move |(joint, ([least, most], [low, high]))| Extent {
            joint,
            arc: match is_whole && curve.winding[joint] != 0 {
                true => Arc::FULL,
                false => Arc::from_interval(least, most),
            },
            low,
            high,
        })
    })
    .collect()
}

impl Surface<'_> {
    /// The sets of the joints `of`: see [`Surface::ranges`].
    pub(super) fn ranges_of(&mut self, of: &[usize], bounds: &[Arc]) -> Vec<AngleSet> {
        if self.landings.is_empty() {
            return vec![AngleSet::empty(); of.len()];
        }
        let faces = self.trace(self.search.cuts.faces(bounds));
        let mut parts = parts_inside(self.slices.iter().chain(&faces), bounds);
        let mut looked: Vec<(usize, f64)> = Vec::new();
        let mut rounds = 0;
        loop {
            let sets: Vec<AngleSet> = of
                .par_iter()
                .map(|&joint| self.walked(&parts, joint, bounds))
                .collect();
            rounds += 1;
            if rounds > ROUNDS {
                return sets;
            }
            let gaps = self.narrow_gaps(of, &sets, &looked);
            let missed = self.missed(of, &sets, bounds);
            if gaps.is_empty() && missed.is_empty() {
                return sets;
            }
            let through = |&(joint, value): &(usize, f64)| self.search.cuts.through(joint, value);
            let probes = self.trace(gaps.iter().flat_map(through).collect());
            looked.extend(gaps);
            let added = self.trace(missed);
            parts.extend(parts_inside(probes.iter().chain(&added), bounds));
            self.slices.extend(added);
        }
    }

    /// The distance between slices, radians: a joint moves about as far between two of them as the
    /// one that is cut.
    fn widest_spacing(&self) -> f64 {
        let cuts = &self.search.cuts;
        let each = cuts.cut.iter().map(|&joint| cuts.spacing(joint));
        each.fold(0.0, f64::max)
    }

    /// Gaps that slices may have left, with the value in their middle.
    fn narrow_gaps(
        &self,
        of: &[usize],
        sets: &[AngleSet],
        looked: &[(usize, f64)],
    ) -> Vec<(usize, f64)> {
        let narrow = 2.0 * self.widest_spacing();
        let mut gaps = Vec::new();
        for (&joint, set) in of.iter().zip(sets) {
            if set.is_empty() {
                continue;
            }
            for gap in set.complement().arcs() {
                let known = |&(other, value): &(usize, f64)| other == joint && gap.contains(value);
                if gap.width() < narrow && gap.width() > SLACK && !looked.iter().any(known) {
                    gaps.push((joint, gap.centre()));
                }
            }
        }
        gaps
    }

    /// Cuts through the configurations that random starts found outside the sets.
    fn missed(&self, of: &[usize], sets: &[AngleSet], bounds: &[Arc]) -> Vec<Held> {
        let landed = self.landings.iter();
        let missed =
            landed.filter(|theta| lies_inside(theta, bounds, 0.0) && is_missing(theta, of, sets));
        // A few at a time: those near each other are mended together.
        missed
            .take(4)
            .map(|theta| self.search.cuts.at(theta))
            .collect()
    }

    /// The union of a joint's arcs, with every end walked on.
    fn walked(&self, parts: &[Extent], joint: usize, bounds: &[Arc]) -> AngleSet {
        let own = || parts.iter().filter(|part| part.joint == joint);
        let coarse = AngleSet::from_arcs(own().map(|part| part.arc));
        if coarse.is_full() {
            return coarse;
        }
        let walked = coarse.arcs().iter().map(|arc| {
            let gain = |sign: f64| {
                let end = |arc: &Arc| if sign > 0.0 { arc.end() } else { arc.start() };
                // How far before the end of the union a curve has its own.
                let before = |part: &Extent| turn(0.0, sign * (end(arc) - end(&part.arc)));
                let room = arc.width().min(self.widest_spacing());
                let mut near: Vec<(f64, &Extent)> = own()
                    .map(|part| (before(part), part))
                    .map(|(way, part)| (if way > TAU - 1e-9 { 0.0 } else { way }, part))
                    .filter(|(way, _)| *way <= room + 1e-9)
                    .collect();
                near.sort_by(|a, b| a.0.total_cmp(&b.0));
                let walk = |&(way, part): &(f64, &Extent)| {
                    let start = if sign > 0.0 { &part.high } else { &part.low };
                    self.gain(start, joint, sign, bounds) - way
                };
                near.iter().take(WALKS).map(walk).fold(0.0, f64::max)
            };
            let (below, above) = (gain(-1.0), gain(1.0));
            Arc::new(arc.start() - below, (arc.width() + below + above).min(TAU))
        });
        AngleSet::from_arcs(walked)
    }

    /// How far `joint` can be raised (`sign` = 1) or lowered from `start` without leaving the box,
    /// on the surface or, with three degrees of redundancy, on a face of the box.
    fn gain(&self, start: &[f64], joint: usize, sign: f64, bounds: &[Arc]) -> f64 {
        let search = self.search;
        let inside = |theta: &[f64]| lies_inside(theta, bounds, SLACK);
        let risen = |end: Option<Vec<f64>>, from: f64, joint: usize| {
            end.map_or(0.0, |end| (sign * (end[joint] - from)).max(0.0))
        };
        let free = search
            .ascent
            .extremum_inside(&self.goal, start, (joint, sign), &inside);
        let free = risen(free, start[joint], joint);
        let at_end = |side: usize| {
            let arc = &bounds[side];
            let ends = [arc.start(), arc.end()];
            let end = ends
                .into_iter()
                .find(|&end| Arc::point(end).contains_within(start[side], SLACK));
            end.filter(|_| side != joint && !arc.is_full())
        };
        let on_faces = (0..start.len()).filter_map(|side| {
            let held = search.chain.locked(side, at_end(side)?);
            // Curves on the faces of two degrees of redundancy have their ends by themselves.
            let ascent = Ascent::new(&held, search.task)?;
            let goal = Goal::new(&held, &self.tool);
            let without = |theta: &[f64]| {
                let mut theta = theta.to_vec();
                theta.remove(side);
                theta
            };
            let within = without_arc(bounds, side);
            let joint = joint - usize::from(side < joint);
            let inside = |theta: &[f64]| lies_inside(theta, &within, SLACK);
            let start = without(start);
            let end = ascent.extremum_inside(&goal, &start, (joint, sign), &inside);
            Some(risen(end, start[joint], joint))
        });
        on_faces.fold(free, f64::max)
    }
}

fn without_arc(bounds: &[Arc], side: usize) -> Vec<Arc> {
    let mut rest = bounds.to_vec();
    rest.remove(side);
    rest
}

/// The arcs of all joints on all slices inside `bounds`.
fn parts_inside<'s>(slices: impl Iterator<Item = &'s SurfaceSlice>, bounds: &[Arc]) -> Vec<Extent> {
    let slices: Vec<&SurfaceSlice> = slices.collect();
    let each: Vec<Vec<Extent>> = slices
        .par_iter()
        .map(|slice| slice.extents(bounds))
        .collect();
    each.concat()
}
