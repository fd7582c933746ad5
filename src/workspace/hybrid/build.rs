//! Fills a block: traces the pre-images of a range of samples and packs them.

use super::block::BlockBuilder;
use super::clip::Box16;
use super::plan::{Sample, SamplePlan};
use super::polyline::Polyline;
use super::turn16::{Arc16, STEP, arcs16, quantise};
use crate::angle::{AngleSet, Arc};
use crate::manifold::{CurveRef, CurveSource};

/// How closely pre-images are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Packing {
    /// Largest distance between a polyline and its curve, radians.
    pub tolerance: f64,
}

/// Packs the samples `range` of `plan` into one block.
///
/// The result depends on the plan and the range alone.
pub(super) fn build_block(
    source: &mut CurveSource,
    physical: &[Arc],
    plan: &SamplePlan,
    range: std::ops::Range<u64>,
    packing: Packing,
) -> BlockBuilder {
    let joints = source.joints();
    let mut packer = Packer {
        block: BlockBuilder::new(joints),
        line: Polyline::new(joints, packing.tolerance),
        inner: Box16::new(physical.iter().map(Arc16::nearest).enumerate().skip(1)),
        ranges: vec![Vec::new(); joints],
        flat: Vec::new(),
    };
    for index in range {
        let sample = plan.sample(index);
        packer.block.samples += 1;
        if sample.tool.translation.vector.norm() > plan.region.reach {
            continue;
        }
        source.solve(&sample.tool, &mut plan.search_stream(index));
        packer.block.seeds += source.seeds() as u64;
        packer.pack(source, index, &sample);
    }
    packer.block
}

struct Packer {
    block: BlockBuilder,
    line: Polyline,
    /// Physical limits of the joints from 2 on. Those of joint 1 depend on β: see `score`.
    inner: Box16,
    /// Arcs of every joint over the pieces of the current pose.
    ranges: Vec<Vec<Arc>>,
    flat: Vec<u16>,
}

impl Packer {
    fn pack(&mut self, source: &CurveSource, index: u64, sample: &Sample) {
        for arcs in &mut self.ranges {
            arcs.clear();
        }
        let mut pieces = 0;
        source.visit(|curve| pieces += self.push_curve(&curve));
        if pieces == 0 {
            return;
        }
        let ranges: Vec<Vec<Arc16>> = self
            .ranges
            .iter()
            .map(|arcs| arcs16(&AngleSet::from_arcs(arcs.iter().copied())).collect())
            .collect();
        self.block.finish_pose(
            index as u32,
            sample.stratum,
            sample.weight,
            source.is_sound(),
            ranges.into_iter(),
        );
    }

    /// Packs a curve; returns the number of its pieces.
    fn push_curve(&mut self, curve: &CurveRef) -> usize {
        let n = curve.joints;
        self.line.begin(curve.point(0));
        for index in 0..curve.vertices() - 1 {
            let (length, turn) = curve.bend(index);
            let splits = self.line.splits(length, turn);
            for split in 1..splits {
                let u = split as f64 / splits as f64;
                curve.at(index, u, |point| self.line.push(point));
            }
            self.line.push(curve.point(index + 1));
        }
        self.flat.clear();
        self.flat
            .extend(self.line.finish().iter().map(|&angle| quantise(angle)));
        if self.inner.active.is_empty() {
            for (joint, arcs) in self.ranges.iter_mut().enumerate() {
                arcs.push(curve.range(joint));
            }
            self.block.push_piece(self.flat.iter().copied());
            return 1;
        }
        self.push_clipped(n)
    }

    /// Packs the parts of the current polyline inside the physical limits.
    fn push_clipped(&mut self, n: usize) -> usize {
        let mut parts: Vec<Vec<u16>> = Vec::new();
        let mut ended = (usize::MAX, 0.0);
        self.inner.walk(&self.flat, n, |index, part, from, to| {
            let at = |u: f64, joint: usize| {
                let step = f64::from(to[joint].wrapping_sub(from[joint]) as i16);
                from[joint].wrapping_add((u * step).round() as i32 as u16)
            };
            let continues = part[0] == 0.0 && ended.1 == 1.0 && ended.0 + 1 == index;
            if !continues {
                parts.push((0..n).map(|joint| at(part[0], joint)).collect());
            }
            if let Some(current) = parts.last_mut() {
                current.extend((0..n).map(|joint| at(part[1], joint)));
            }
            ended = (index, part[1]);
        });
        for part in &parts {
            for (joint, arcs) in self.ranges.iter_mut().enumerate() {
                arcs.push(swept(part, n, joint));
            }
            self.block.push_piece(part.iter().copied());
        }
        parts.len()
    }
}

/// The arc that a joint sweeps along a polyline.
fn swept(part: &[u16], n: usize, joint: usize) -> Arc {
    let mut values = part.chunks_exact(n).map(|vertex| vertex[joint]);
    let first = values.next().unwrap_or_default();
    let (mut low, mut high, mut at, mut last) = (0i64, 0i64, 0i64, first);
    for value in values {
        at += i64::from(value.wrapping_sub(last) as i16);
        last = value;
        (low, high) = (low.min(at), high.max(at));
    }
    let start = f64::from(first) * STEP;
    Arc::from_interval(start + low as f64 * STEP, start + high as f64 * STEP)
}
