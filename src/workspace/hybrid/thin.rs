//! A part of an atlas, on which a search scouts.

use super::atlas::{Atlas, SHARD};
use super::block::{BlockBuilder, BlockView};
use super::plan::{SamplePlan, Sampling};
use super::store::ShardBytes;
use rayon::prelude::*;

/// 2⁶⁴ divided by the golden ratio: multiples of it, modulo 2⁶⁴, fill the circle evenly.
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

impl SamplePlan {
    /// Whether sample `index` belongs to the `1/every` part of the samples. Parts are nested: that
    /// of 1/16 lies in that of 1/4.
    ///
    /// A lattice is thinned to the front of each replicate, which is a lattice again; cells and
    /// orientations of a grid evenly.
    pub fn keeps(&self, index: u64, every: u64) -> bool {
        match self.sampling {
            Sampling::Lattice {
                samples,
                replicates,
            }
            | Sampling::Everywhere {
                samples,
                replicates,
            } => {
                let each = u64::from(samples / replicates.max(1)).max(1);
                index % each < each.div_ceil(every)
            }
            Sampling::Grid { .. } => index.wrapping_mul(GOLDEN) <= u64::MAX / every,
        }
    }

    /// Number of samples in the `1/every` part.
    pub fn kept(&self, every: u64) -> u64 {
        let kept = |index: &u64| self.keeps(*index, every);
        (0..self.len()).filter(kept).count() as u64
    }
}

impl Atlas {
    /// The pre-images of the `1/every` part of the samples, with their weights scaled up, copied
    /// side by side.
    ///
    /// For scoring alone: the standard errors of a grid know nothing of samples left out.
    pub fn thinned(&self, every: u64) -> Atlas {
        let scale = self.plan.len() as f64 / self.plan.kept(every).max(1) as f64;
        let chunk = every.max(1);
        let thin = |(number, shards): (usize, &[ShardBytes])| {
            let mut block = BlockBuilder::new(self.joints);
            for shard in shards {
                if let Some(view) = BlockView::new(shard.block()) {
                    copy(&view, &mut block, scale, |index| {
                        self.plan.keeps(index, every)
                    });
                    block.seeds += view.seeds;
                }
            }
            let first = number as u64 * chunk * SHARD;
            let last = (first + chunk * SHARD).min(self.plan.len());
            let kept = (first..last).filter(|&index| self.plan.keeps(index, every));
            block.samples = kept.count() as u32;
            ShardBytes::from_bytes(&block.to_bytes())
        };
        Atlas {
            plan: self.plan.clone(),
            joints: self.joints,
            physical: self.physical.clone(),
            slabs: self.slabs.clone(),
            is_focused: self.is_focused,
            shards: self
                .shards
                .par_chunks(chunk as usize)
                .enumerate()
                .map(thin)
                .collect(),
        }
    }
}

fn copy(view: &BlockView, into: &mut BlockBuilder, scale: f64, keeps: impl Fn(u64) -> bool) {
    let poses = view.poses.iter().enumerate();
    for (index, pose) in poses.filter(|(_, pose)| keeps(u64::from(pose.sample))) {
        for piece in view.pieces(pose) {
            into.push_piece(piece.iter().copied());
        }
        let ranges = view.ranges(index).map(<[_]>::to_vec);
        let (sound, weight) = (pose.sound == 1, pose.weight * scale);
        into.finish_pose(pose.sample, pose.stratum, weight, sound, ranges);
    }
}

#[cfg(test)]
mod tests;
