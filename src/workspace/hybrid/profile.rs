//! S_F as a function of one joint's limits, for many widths in one pass over the atlas.
//!
//! As the limits of joint j grow from width 0 on, every part of a pre-image inside the box of
//! the *other* joints enters at a known width, and the pose is lost at the width at which A_j
//! leaves Θ_j (with a margin: at which A_j enlarged by it does). So one walk along the pre-image serves all widths, and the result at each of them
//! is the very number that scoring these limits alone would give (to round-off).

use super::atlas::Atlas;
use super::block::{BlockView, PoseRecord};
use super::clip::Box16;
use super::cover::Cover;
use super::family::{Family, Growth};
use super::hull::Strand;
use super::lanes::Place;
use super::score::{Limits16, Rule, covers};
use super::turn16::{Arc16, STEP, angle_set};
use crate::angle::{AngleSet, Arc};
use crate::workspace::{ArtificialLimits, FailureSet, JointLimit};
use rayon::prelude::*;
use std::f64::consts::TAU;

impl Atlas {
    /// S_F for `limits` with those of `joint` (from 0) replaced by every width of `widths`
    /// (radians, ascending, in [0, 2π]); `None` for robots with physical limits and for samples that
    /// stand for themselves, which have to be scored one by one.
    pub fn profile(
        &self,
        limits: &ArtificialLimits,
        failures: &FailureSet,
        joint: usize,
        growth: Growth,
        widths: &[f64],
    ) -> Option<Vec<f64>> {
        if !self.is_free() || !self.plan.sampling.uses_turns() {
            return None;
        }
        let fixed = self.limits(limits, failures, Rule::Definition);
        let parts: Vec<Vec<f64>> = if joint == 0 {
            self.views()
                .map(|view| first_joint(&view, &fixed, widths))
                .collect()
        } else {
            let family = Family::new(limits, joint, growth, widths, self.slabs[joint]);
            let family = family.with_margin(failures.margin());
            let rest = fixed.rest.without(joint);
            self.views()
                .map(|view| other_joint(&view, &fixed, &rest, &family))
                .collect()
        };
        let mut sums = vec![0.0; widths.len()];
        for part in parts {
            for (sum, add) in sums.iter_mut().zip(part) {
                *sum += add;
            }
        }
        Some(sums)
    }
}

/// All widths of joint 1, symmetric as always.
fn first_joint(view: &BlockView, fixed: &Limits16, widths: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; widths.len()];
    for (index, pose) in view.poses.iter().enumerate() {
        let mut ranges = view.ranges(index);
        let range = ranges.next().unwrap_or_default();
        if !fixed.survives_others(ranges, 0) {
            continue;
        }
        let image = fixed.image(view, pose);
        if image.is_empty() {
            continue;
        }
        let after = fixed.prone[0].then(|| angle_set(range));
        // Wider limits do not fit Θ₁ any more.
        let room = match &after {
            None => TAU,
            Some(set) => set.arcs().iter().map(Arc::width).fold(0.0, f64::max),
        };
        let image = image.mirrored();
        for (sum, &width) in sums.iter_mut().zip(widths) {
            let lock = JointLimit::around(0.0, width).enlarged(fixed.margin);
            if lock.width() > room {
                break;
            }
            let limit = Arc::new(-0.5 * width, width);
            let after = after.as_ref();
            let after = after.map(|range| range.erosion(&lock.arc()).mirrored());
            *sum += pose.weight * overlap(&limit, &image, after.as_ref());
        }
    }
    sums
}

/// All widths of a joint from 2 on.
fn other_joint(view: &BlockView, fixed: &Limits16, rest: &Box16, family: &Family) -> Vec<f64> {
    // Differences of the sums from one width to the next.
    let count = family.widths.len();
    let mut steps = vec![0.0; count + 1];
    let mut bins: Vec<Vec<Arc>> = vec![Vec::new(); count];
    for (index, pose) in view.poses.iter().enumerate() {
        let mut ranges = view.ranges(index);
        let first = ranges.next().unwrap_or_default();
        if !fixed.first_fits(first) || !fixed.survives_others(ranges, family.joint) {
            continue;
        }
        let fits = if fixed.prone[family.joint] {
            let own = view.ranges(index).nth(family.joint);
            family.fitting(own.unwrap_or_default())
        } else {
            count
        };
        if fits == 0 {
            continue;
        }
        if fixed.is_free_of_joint_1() {
            let entry = first_entry(view, pose, rest, family);
            let on = family
                .widths
                .partition_point(|&width| (width as f64) < entry);
            if on < fits {
                steps[on] += pose.weight * TAU;
                steps[fits] -= pose.weight * TAU;
            }
        } else {
            collect(view, pose, rest, family, &mut bins[..fits]);
            let after = fixed.prone[0].then(|| fixed.lock_of_1(first));
            let mut last = 0.0;
            let mut image = AngleSet::empty();
            for (bin, step) in bins[..fits].iter_mut().zip(&mut steps) {
                if bin.is_empty() {
                    continue;
                }
                // Mirrored from the start, as the difference A₁ − T wants it.
                let mirrored = bin.drain(..).map(|arc| arc.mirrored());
                image = image.union(&AngleSet::from_arcs(mirrored));
                let measure = pose.weight * overlap(&fixed.first, &image, after.as_ref());
                *step += measure - last;
                last = measure;
            }
            steps[fits] -= last;
        }
    }
    let mut sum = 0.0;
    steps.truncate(count);
    for step in &mut steps {
        sum += *step;
        *step = sum.max(0.0);
    }
    steps
}

/// The least width at which the pre-image enters the box.
fn first_entry(view: &BlockView, pose: &PoseRecord, rest: &Box16, family: &Family) -> f64 {
    let mut least = f64::INFINITY;
    for chunk in view.strands(pose).flat_map(Strand::chunks) {
        let arc = chunk.arc(family.joint);
        if rest.place_hull(&chunk) == Place::Outside || family.span(arc)[0] >= least {
            continue;
        }
        rest.walk_edges(chunk.row(), view.joints, |_, part, from, to| {
            family.entries(from[family.joint], to[family.joint], part, |_, widths| {
                least = least.min(widths[0]).min(widths[1]);
            });
        });
    }
    least
}

/// The angles of joint 1, by the first width at which they are inside.
struct Entered<'b> {
    bins: &'b mut [Vec<Arc>],
    cover: Cover,
}

impl Entered<'_> {
    fn take(&mut self, bin: usize, low: f64, high: f64) {
        if let Some(arcs) = self.bins.get_mut(bin) {
            arcs.push(Arc::from_interval(low, high));
            self.cover.take(low / STEP, high / STEP, bin as u16);
        }
    }
}

/// Sorts the θ₁ values of all parts into the first width at which they are inside.
fn collect(
    view: &BlockView,
    pose: &PoseRecord,
    rest: &Box16,
    family: &Family,
    bins: &mut [Vec<Arc>],
) {
    let beyond = bins.len();
    let widths = &family.widths[..beyond];
    let mut entered = Entered {
        bins,
        cover: Cover::new(),
    };
    let mut hint = 0;
    for strand in view.strands(pose) {
        let mut run = Run::default();
        for chunk in strand.chunks() {
            let place = rest.place_hull(&chunk);
            if place == Place::Outside {
                continue;
            }
            let span = family.span(chunk.arc(family.joint));
            let [near, far] = span.map(|width| bin_of(widths, width, hint));
            let (start, width) = chunk.arc(0);
            if near == beyond || entered.cover.holds((start, width), near as u16) {
                continue;
            }
            let is_whole = place == Place::Inside && width < u16::MAX;
            let ends = [f64::from(start), f64::from(start) + f64::from(width)];
            if is_whole && near == far {
                entered.take(near, ends[0] * STEP, ends[1] * STEP);
                continue;
            }
            rest.walk_edges(chunk.row(), view.joints, |_, part, from, to| {
                collect_edge(
                    [from, to],
                    part,
                    family,
                    widths,
                    (&mut hint, &mut run),
                    &mut entered,
                );
            });
            if is_whole && far < beyond {
                entered.cover.take(ends[0], ends[1], far as u16);
            }
        }
        run.finish(&mut entered);
    }
}

/// Sorts the θ₁ values of one part of an edge.
#[inline]
fn collect_edge(
    [from, to]: [&[u16]; 2],
    part: [f64; 2],
    family: &Family,
    widths: &[i32],
    (hint, run): (&mut usize, &mut Run),
    entered: &mut Entered,
) {
    let step = f64::from(to[0].wrapping_sub(from[0]) as i16);
    let theta = |u: f64| (f64::from(from[0]) + u * step) * STEP;
    let (a, b) = (from[family.joint], to[family.joint]);
    family.entries(a, b, part, |[u, v], [start, end]| {
        // Along the curve; widths may rise or fall.
        let at = |width: f64| {
            let share = (width - start) / (end - start);
            theta(u + share.clamp(0.0, 1.0) * (v - u))
        };
        let (mut bin, last) = (bin_of(widths, start, *hint), bin_of(widths, end, *hint));
        *hint = last;
        if bin == widths.len() && last == bin {
            // Beyond all widths.
            std::mem::take(run).finish(entered);
            return;
        }
        let mut begin = theta(u);
        while bin < last {
            let stop = at(widths.get(bin).copied().map_or(end, f64::from));
            run.extend(bin, begin, stop, entered);
            (begin, bin) = (stop, bin + 1);
        }
        while bin > last {
            let stop = at(f64::from(widths[bin - 1]));
            run.extend(bin, begin, stop, entered);
            (begin, bin) = (stop, bin - 1);
        }
        run.extend(bin, begin, theta(v), entered);
    });
}

/// The first of `widths` that is no less than `width`, looked for at `hint` first: neighbouring
/// edges enter at much the same width.
#[inline]
fn bin_of(widths: &[i32], width: f64, hint: usize) -> usize {
    let before = hint == 0 || f64::from(widths[hint - 1]) < width;
    if before && widths.get(hint).is_none_or(|&w| width <= f64::from(w)) {
        return hint;
    }
    widths.partition_point(|&w| f64::from(w) < width)
}

/// A connected part of a curve that enters the box at one width.
#[derive(Clone, Copy, Debug)]
struct Run {
    bin: usize,
    low: f64,
    high: f64,
    end: f64,
}

impl Default for Run {
    fn default() -> Run {
        Run {
            bin: usize::MAX,
            low: 0.0,
            high: 0.0,
            end: f64::NAN,
        }
    }
}

impl Run {
    /// Appends the way from `begin` to `end`, radians modulo turns, which enters with `bin`.
    fn extend(&mut self, bin: usize, begin: f64, end: f64, entered: &mut Entered) {
        let gap = self.end - begin;
        let shift = match gap.abs() < 1e-9 {
            true => 0.0,
            false => (gap / TAU).round() * TAU,
        };
        let joins = bin == self.bin && (begin + shift - self.end).abs() < 1e-9;
        if !joins {
            self.finish(entered);
            *self = Run {
                bin,
                low: begin.min(end),
                high: begin.max(end),
                end,
            };
            return;
        }
        self.end = end + shift;
        self.low = self.low.min(self.end);
        self.high = self.high.max(self.end);
    }

    fn finish(&self, entered: &mut Entered) {
        entered.take(self.bin, self.low, self.high);
    }
}

impl Limits16 {
    /// Whether the sample survives locks of all joints i ≥ 2 but `except` (from 0); `ranges`
    /// begin with joint 2.
    fn survives_others<'r>(
        &self,
        ranges: impl Iterator<Item = &'r [Arc16]>,
        except: usize,
    ) -> bool {
        ranges.enumerate().all(|(k, range)| {
            let joint = k + 1;
            joint == except || !self.prone[joint] || covers(range, self.locks[joint])
        })
    }
}

/// |B₀ ∩ B₁| for A₁ = `limit`, the mirrored image −T and, if joint 1 may lock, B₁.
fn overlap(limit: &Arc, mirrored: &AngleSet, after: Option<&AngleSet>) -> f64 {
    let before = mirrored.sum(limit);
    after.map_or_else(|| before.measure(), |after| before.overlap(after))
}

#[cfg(test)]
mod tests;
