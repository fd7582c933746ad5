//! Fills a block: traces the pre-images of a range of samples and packs them.

use super::block::BlockBuilder;
use super::clip::Box16;
use super::plan::{Sample, SamplePlan};
use super::polyline::Polyline;
use super::runs::{Runs, arc};
use super::turn16::{Arc16, STEP, angle, arcs16, quantise};
use crate::angle::{AngleSet, Arc};
use crate::manifold::{CurveRef, CurveSource, Extent, Faces, Pose};
use crate::workspace::ArtificialLimits;

/// What is kept of a pre-image, and how closely.
#[derive(Clone, Debug)]
pub(super) struct Packing {
    /// Largest distance between a polyline and its curve, radians.
    pub tolerance: f64,
    /// The same for the polylines that ranges inside physical limits are taken from: a chord ends
    /// before its curve's extremum.
    pub close: f64,
    /// Physical limits of every joint.
    pub physical: Vec<Arc>,
    /// Keep only what scoring these very limits needs: ranges and the θ₁-image of the box.
    pub focus: Option<Focus>,
}

/// Tolerance of the curves behind a focused atlas, as a share of the usual one.
const FOCUSED: f64 = 1.0 / 16.0;

/// Tolerance of the curves that ranges inside physical limits are taken from, as a share of the
/// usual one.
const CLOSE: f64 = 1.0 / 16.0;

/// Least tolerance of curves that are slices of a surface, radians: slices lie many times as far
/// from each other, and closer chords would only take time.
const SLICED: f64 = 0.01;

impl Packing {
    /// Whole pre-images within `tolerance`.
    pub fn new(tolerance: f64, is_sliced: bool, physical: Vec<Arc>) -> Packing {
        Packing {
            tolerance: match is_sliced {
                true => tolerance.max(SLICED),
                false => tolerance,
            },
            close: CLOSE * tolerance,
            physical,
            focus: None,
        }
    }

    /// What `focus` needs. Images of chords end inside those of curves; no curves are kept, so
    /// that finer ones cost no memory.
    pub fn focused(self, tolerance: f64, focus: Focus) -> Packing {
        Packing {
            tolerance: FOCUSED * tolerance,
            close: FOCUSED * self.close,
            physical: self.physical,
            focus: Some(focus),
        }
    }
}

/// The only limits that an atlas will be scored for.
#[derive(Clone, Debug)]
pub(super) struct Focus {
    /// The limits.
    pub limits: ArtificialLimits,
    /// The faces of their box, where images of surfaces have their ends.
    pub faces: Option<Faces>,
}

/// Packs the samples `indices` of `plan` into one block.
///
/// The result depends on the plan and the indices alone.
pub(super) fn build_block(
    source: &mut CurveSource,
    packing: &mut Packing,
    plan: &SamplePlan,
    indices: impl Iterator<Item = u64>,
) -> BlockBuilder {
    let mut packer = Packer::new(source.joints(), packing, plan);
    let most = source.batch();
    let mut batch = Vec::with_capacity(most);
    for index in indices {
        let sample = plan.sample(index);
        packer.block.samples += 1;
        if sample.tool.translation.vector.norm() > plan.region.reach {
            continue;
        }
        batch.push((index, sample));
        if batch.len() == most {
            packer.add_all(source, packing, plan, &mut batch);
        }
    }
    packer.add_all(source, packing, plan, &mut batch);
    packer.block
}

struct Packer {
    joints: usize,
    block: BlockBuilder,
    line: Polyline,
    /// Physical limits of the joints from 2 on; those of joint 1 depend on β where a sample stands
    /// for its circle (see `score`), else they are here too.
    inner: Box16,
    /// The box of the focus, if there is one.
    focus: Option<Box16>,
    /// Ranges of every joint over the parts of the current pose inside physical limits.
    parts: Vec<Extent>,
    /// The curves that these ranges are taken from, closer than the ones kept.
    close: Polyline,
    /// θ₁-image of the focus, of the curves pushed last.
    image: Vec<Arc>,
    flat: Vec<u16>,
    curves: usize,
}

/// A reachable sample, but for the faces of the focus.
struct Found<'p> {
    index: u64,
    sample: Sample,
    /// Θ of every joint.
    ranges: Vec<AngleSet>,
    /// θ₁-image of the focus.
    image: Vec<Arc>,
    is_sound: bool,
    pose: &'p mut Pose,
}

impl Packer {
    fn new(joints: usize, packing: &Packing, plan: &SamplePlan) -> Packer {
        let turns = usize::from(plan.sampling.uses_turns());
        let arcs = |arcs: &[Arc]| {
            let arcs: Vec<_> = arcs.iter().map(Arc16::nearest).collect();
            Box16::new(arcs.into_iter().enumerate().skip(turns))
        };
        let focus = packing.focus.as_ref().map(|focus| {
            let limits = focus.limits.joints().iter();
            arcs(&limits.map(|limit| limit.arc()).collect::<Vec<_>>())
        });
        Packer {
            joints,
            block: BlockBuilder::new(joints),
            line: Polyline::new(joints, packing.tolerance),
            inner: arcs(&packing.physical),
            focus,
            parts: Vec::new(),
            close: Polyline::new(joints, packing.close),
            image: Vec::new(),
            flat: Vec::new(),
            curves: 0,
        }
    }

    /// Packs the pre-images of a batch of samples, which is empty afterwards.
    fn add_all(
        &mut self,
        source: &mut CurveSource,
        packing: &mut Packing,
        plan: &SamplePlan,
        batch: &mut Vec<(u64, Sample)>,
    ) {
        let pose = |(index, sample): &(u64, Sample)| (sample.tool, plan.search_stream(*index));
        let mut poses: Vec<_> = batch.iter().map(pose).collect();
        source.search_all(&mut poses);
        let (limits, mut faces) = match &mut packing.focus {
            None => (None, None),
            Some(Focus { limits, faces }) => (Some(&*limits), faces.as_mut()),
        };
        let mut waiting = Vec::new();
        for (nth, ((index, sample), pose)) in batch.drain(..).zip(&mut poses).enumerate() {
            let Some(found) = self.look(source, nth, (index, sample), pose) else {
                continue;
            };
            match faces {
                None => self.add(found, limits),
                Some(_) => waiting.push(found),
            }
        }
        if let Some(faces) = &mut faces {
            source.search_faces(waiting.iter_mut().map(|found| &mut *found.pose), faces);
            for (nth, mut found) in waiting.into_iter().enumerate() {
                self.image.append(&mut found.image);
                let seeds = source.show_faces(nth, faces, |curve| self.push_curve(&curve, false));
                found.image.append(&mut self.image);
                self.block.seeds += seeds as u64;
                self.add(found, limits);
            }
        }
    }

    /// Takes in the curves of task point `nth` of a batch; `None` if there are none.
    fn look<'p>(
        &mut self,
        source: &mut CurveSource,
        nth: usize,
        (index, sample): (u64, Sample),
        pose: &'p mut Pose,
    ) -> Option<Found<'p>> {
        self.parts.clear();
        self.curves = 0;
        let free = source.show(nth, pose, |curve| self.push_curve(&curve, true));
        self.block.seeds += source.seeds() as u64;
        let image = std::mem::take(&mut self.image);
        let ranges = match self.inner.is_everything() {
            true => free,
            false => source.ranges_within(&sample.tool, &self.parts),
        };
        (self.curves > 0).then(|| Found {
            index,
            sample,
            ranges,
            image,
            is_sound: source.is_sound(),
            pose,
        })
    }

    /// Packs a sample whose curves have been pushed.
    fn add(&mut self, found: Found, focus: Option<&ArtificialLimits>) {
        if let Some(limits) = focus {
            self.push_image(limits, found.image);
        }
        let ranges = found.ranges.iter().map(|set| arcs16(set).collect());
        self.block.finish_pose(
            found.index as u32,
            found.sample.stratum,
            found.sample.weight,
            found.is_sound,
            ranges,
        );
    }

    /// Packs a curve, or its image in the focus. Curves on faces of the focus are no part of the
    /// ranges.
    fn push_curve(&mut self, curve: &CurveRef, counts: bool) {
        let mut flat = std::mem::take(&mut self.flat);
        if self.inner.is_everything() {
            flatten(curve, &mut self.line, &mut flat);
            self.curves += 1;
            self.keep(&flat);
        } else {
            if counts {
                flatten(curve, &mut self.close, &mut flat);
                for part in parts_inside(&self.inner, &flat, self.joints) {
                    let extents = (0..self.joints).map(|joint| swept(&part, self.joints, joint));
                    self.parts.extend(extents);
                    self.curves += 1;
                }
            }
            flatten(curve, &mut self.line, &mut flat);
            for part in parts_inside(&self.inner, &flat, self.joints) {
                self.keep(&part);
            }
        }
        self.flat = flat;
    }

    fn keep(&mut self, piece: &[u16]) {
        match &self.focus {
            None => self.block.push_piece(piece.iter().copied()),
            Some(focus) => {
                let runs = Runs::of(focus, piece, self.joints);
                self.image.extend(runs.all.iter().map(arc));
            }
        }
    }

    /// Stores the image as polylines in the middle of the box along which only θ₁ changes.
    fn push_image(&mut self, limits: &ArtificialLimits, image: Vec<Arc>) {
        let rest: Vec<u16> = limits.joints()[1..]
            .iter()
            .map(|limit| quantise(limit.arc().centre()))
            .collect();
        for arc in AngleSet::from_arcs(image).arcs() {
            let edges = (arc.width() / 2.0).ceil().max(1.0) as usize;
            let vertex = |k: usize| {
                let theta = arc.start() + arc.width() * k as f64 / edges as f64;
                std::iter::once(quantise(theta)).chain(rest.iter().copied())
            };
            self.block.push_piece((0..=edges).flat_map(vertex));
        }
    }
}

/// The parts of a polyline inside a box.
fn parts_inside(limits: &Box16, piece: &[u16], n: usize) -> Vec<Vec<u16>> {
    let mut parts: Vec<Vec<u16>> = Vec::new();
    let mut ended = (usize::MAX, 0.0);
    limits.walk(piece, n, |index, part, from, to| {
        let at = |u: f64, joint: usize| {
            let step = f64::from(to[joint].wrapping_sub(from[joint]) as i16);
            from[joint].wrapping_add((u * step).round() as i32 as u16)
        };
        let continues = part[0] == 0.0 && ended.1 == 1.0 && ended.0.wrapping_add(1) == index;
        if !continues {
            parts.push((0..n).map(|joint| at(part[0], joint)).collect());
        }
        if let Some(current) = parts.last_mut() {
            current.extend((0..n).map(|joint| at(part[1], joint)));
        }
        ended = (index, part[1]);
    });
    parts
}

/// The curve as a polyline in steps.
fn flatten(curve: &CurveRef, line: &mut Polyline, flat: &mut Vec<u16>) {
    line.begin(curve.point(0));
    for index in 0..curve.vertices() - 1 {
        let (length, turn) = curve.bend(index);
        let splits = line.splits(length, turn);
        for split in 1..splits {
            let u = split as f64 / splits as f64;
            curve.at(index, u, |point| line.push(point));
        }
        line.push(curve.point(index + 1));
    }
    flat.clear();
    flat.extend(line.finish().iter().map(|&angle| quantise(angle)));
}

/// The arc that a joint sweeps along a polyline.
fn swept(part: &[u16], n: usize, joint: usize) -> Extent {
    let value = |vertex: usize| part[vertex * n + joint];
    // Where the joint stands after every vertex, unwrapped, in steps from the first one.
    let mut at = 0i64;
    let (mut low, mut high) = ((0, 0), (0, 0));
    for vertex in 1..part.len() / n {
        at += i64::from(value(vertex).wrapping_sub(value(vertex - 1)) as i16);
        low = low.min((at, vertex));
        high = high.max((at, vertex));
    }
    let configuration = |vertex: usize| {
        let steps = &part[vertex * n..][..n];
        steps.iter().map(|&step| angle(step)).collect()
    };
    let start = angle(value(0));
    Extent {
        joint,
        arc: Arc::from_interval(start + low.0 as f64 * STEP, start + high.0 as f64 * STEP),
        low: configuration(low.1),
        high: configuration(high.1),
    }
}
