//! The pre-images of all samples of a plan, built once and scored many times.

use super::block::BlockView;
use super::build::{Focus, Packing, build_block};
use super::plan::SamplePlan;
use super::score::{Limits16, Rule};
use super::store::{AtlasKey, AtlasStore, ShardBytes};
use crate::angle::Arc;
use crate::design::{JointKind, Robot};
use crate::kinematics::fixed_transforms;
use crate::manifold::{CurveSource, ManifoldError, SearchSettings, physical_arcs};
use crate::workspace::{ArtificialLimits, FailureSet};
use rayon::prelude::*;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

/// Samples in a shard, the unit of work that a killed build may lose.
pub(super) const SHARD: u64 = 1024;

/// Changes whenever the content of a block changes for the same question.
const FORMAT: u32 = 4;

/// How an atlas is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtlasSettings {
    /// Largest distance between a stored polyline and its curve, radians. Memory falls with its
    /// square root; sizes hardly notice up to 0.05.
    pub tolerance: f64,
    /// With more than one degree of redundancy: values of each surplus joint at which the
    /// pre-image is cut into curves. Fewer: sizes come out too small.
    pub slices: usize,
    /// How manifolds are searched and traced.
    pub search: SearchSettings,
    /// Bytes above which an atlas is not built.
    pub memory_limit: u64,
}

impl Default for AtlasSettings {
    fn default() -> AtlasSettings {
        AtlasSettings {
            tolerance: 0.01,
            slices: 32,
            search: SearchSettings::coarse(),
            memory_limit: 4 << 30,
        }
    }
}

/// Why there is no atlas.
#[derive(Debug, thiserror::Error)]
pub enum AtlasError {
    /// The robot has no manifolds to trace.
    #[error(transparent)]
    Manifold(#[from] ManifoldError),
    /// It would not fit.
    #[error("the atlas would take about {predicted_mb} MB, more than the limit of {limit_mb} MB")]
    TooLarge {
        /// Predicted size, megabytes.
        predicted_mb: u64,
        /// The limit, megabytes.
        limit_mb: u64,
    },
    /// The interrupt flag was raised; finished shards are on disk.
    #[error("interrupted")]
    Interrupted,
    /// A shard could not be written.
    #[error("cannot write the atlas: {0}")]
    Write(#[from] std::io::Error),
}

/// Size and time that building an atlas will take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    /// Bytes in memory and on disk.
    pub bytes: u64,
    /// Seconds of one core.
    pub core_seconds: f64,
}

/// Pre-images of all samples of a plan.
#[derive(Debug)]
pub struct Atlas {
    pub(super) plan: SamplePlan,
    pub(super) joints: usize,
    /// Physical limits of every joint.
    pub(super) physical: Vec<Arc>,
    /// Half the distance between slices along every joint, radians.
    pub(super) slabs: Vec<f64>,
    /// Whether it holds images of one box only, and no configurations.
    pub(super) is_focused: bool,
    pub(super) shards: Vec<ShardBytes>,
}

/// What an atlas is built from.
#[derive(Clone, Debug)]
pub struct AtlasRecipe {
    robot: Robot,
    plan: SamplePlan,
    settings: AtlasSettings,
    source: CurveSource,
    packing: Packing,
}

/// Called with the number of finished shards and of all shards.
pub type ShardProgress<'a> = &'a (dyn Fn(u64, u64) + Sync);

impl AtlasRecipe {
    /// A recipe for the pre-images of `robot` at the samples of `plan`.
    ///
    /// # Errors
    /// The robot has no curves to trace for this task, or joint 1 slides and samples do not lie
    /// everywhere.
    pub fn new(
        robot: &Robot,
        plan: SamplePlan,
        settings: AtlasSettings,
    ) -> Result<AtlasRecipe, ManifoldError> {
        let slides = robot.joint_kind(0) == JointKind::Prismatic;
        let turns = plan.sampling.uses_turns();
        let degree = robot.degree_of_redundancy(plan.task);
        if slides && turns {
            return Err(ManifoldError::NoSymmetry);
        }
        // Surfaces are cut without regard to limits of joint 1.
        if !turns && degree > 1 {
            return Err(ManifoldError::Redundancy {
                joints: robot.joints(),
                dimension: plan.task.dimension(),
                degree,
                wanted: "1 without a joint 1 that turns",
            });
        }
        let is_sliced = degree > 1;
        Ok(AtlasRecipe {
            source: CurveSource::new(robot, plan.task, settings.slices, settings.search)?,
            packing: Packing::new(settings.tolerance, is_sliced, physical_arcs(robot)),
            robot: robot.clone(),
            plan,
            settings,
        })
    }

    /// The same, but for scoring `limits` alone: the atlas is small, and with more than one
    /// degree of redundancy its images have their exact ends, which lie on the faces of the box.
    ///
    /// Physical limits of joint 1 need the whole pre-image, and so do samples that stand for
    /// themselves: then this changes nothing.
    pub fn focused(mut self, limits: &ArtificialLimits) -> AtlasRecipe {
        if !self.packing.physical[0].is_full() || !self.plan.sampling.uses_turns() {
            return self;
        }
        let limits = limits.within(&self.packing.physical);
        let ends = limits.joints().iter().map(|limit| {
            let is_free = limit.is_full();
            (!is_free).then_some([limit.lower, limit.upper])
        });
        let faces = self.source.faces(&ends.collect::<Vec<_>>());
        let focus = Focus { limits, faces };
        self.packing = self.packing.focused(self.settings.tolerance, focus);
        self
    }

    /// The number of shards.
    pub fn shards(&self) -> u64 {
        self.plan.len().div_ceil(SHARD)
    }

    fn samples(&self, shard: u64) -> Range<u64> {
        shard * SHARD..((shard + 1) * SHARD).min(self.plan.len())
    }

    /// The hash of everything that the content depends on.
    pub fn key(&self) -> AtlasKey {
        let mut text = format!(
            "faultspace atlas {FORMAT} {}\n{:?}\n{:?}\n{:?}\n",
            env!("CARGO_PKG_VERSION"),
            self.plan,
            (
                self.settings.tolerance,
                self.settings.slices,
                self.settings.search
            ),
            self.packing.focus.as_ref().map(|focus| &focus.limits),
        );
        for transform in fixed_transforms(&self.robot) {
            let (t, r) = (transform.translation.vector, transform.rotation.coords);
            text += &format!("{:?} {:?}\n", t.as_slice(), r.as_slice());
        }
        for joint in 0..self.robot.joints() {
            text += &format!("{:?}\n", self.robot.joint_kind(joint));
        }
        text += &format!("{:?}", self.robot.physical_limits);
        AtlasKey::of(text.as_bytes())
    }

    /// Traces a few samples spread over the plan and scales up.
    pub fn predict(&self) -> Prediction {
        const PILOT: u64 = 96;
        let stride = (self.plan.len() / PILOT).max(1);
        let started = Instant::now();
        let picks = (0..self.plan.len()).step_by(stride as usize);
        let block = self.block(&mut self.source.clone(), picks.clone());
        let bytes = block.to_bytes().len() as u64 - 40;
        let scale = self.plan.len() as f64 / picks.count().max(1) as f64;
        Prediction {
            bytes: (bytes as f64 * scale) as u64,
            core_seconds: started.elapsed().as_secs_f64() * scale,
        }
    }

    fn block(
        &self,
        source: &mut CurveSource,
        indices: impl Iterator<Item = u64>,
    ) -> super::block::BlockBuilder {
        build_block(source, &mut self.packing.clone(), &self.plan, indices)
    }

    /// Builds the atlas, or reads what `store` has of it; new shards are written to the store.
    ///
    /// The bytes do not depend on the number of threads.
    ///
    /// # Errors
    /// Too large, interrupted, or a file could not be written.
    pub fn build(
        &self,
        store: Option<&AtlasStore>,
        interrupt: &AtomicBool,
        progress: ShardProgress,
    ) -> Result<Atlas, AtlasError> {
        let all: Vec<u64> = (0..self.shards()).collect();
        let shards = self.build_shards(&all, store, interrupt, progress)?;
        Ok(Atlas {
            plan: self.plan.clone(),
            joints: self.robot.joints(),
            physical: self.packing.physical.clone(),
            slabs: match self.packing.focus {
                None => self.source.slabs(),
                Some(_) => vec![0.0; self.robot.joints()],
            },
            is_focused: self.packing.focus.is_some(),
            shards,
        })
    }

    /// Builds the given shards only, as one machine's part of an atlas.
    ///
    /// # Errors
    /// As [`AtlasRecipe::build`].
    pub fn build_part(
        &self,
        shards: &[u64],
        store: &AtlasStore,
        interrupt: &AtomicBool,
        progress: ShardProgress,
    ) -> Result<(), AtlasError> {
        self.build_shards(shards, Some(store), interrupt, progress)
            .map(drop)
    }

    fn build_shards(
        &self,
        shards: &[u64],
        store: Option<&AtlasStore>,
        interrupt: &AtomicBool,
        progress: ShardProgress,
    ) -> Result<Vec<ShardBytes>, AtlasError> {
        let done = AtomicU64::new(0);
        let used = AtomicU64::new(0);
        let total = shards.len() as u64;
        let one = |source: &mut CurveSource, &shard: &u64| {
            if interrupt.load(Ordering::Relaxed) {
                return Err(AtlasError::Interrupted);
            }
            let bytes = match store.and_then(|store| store.load(shard)) {
                Some(bytes) => bytes,
                None => self.make_shard(source, shard, store)?,
            };
            let used = used.fetch_add(bytes.block().len() as u64, Ordering::Relaxed);
            if used > self.settings.memory_limit {
                return Err(self.too_large(used / (shard + 1) * self.shards()));
            }
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
            Ok(bytes)
        };
        shards
            .par_iter()
            .map_init(|| self.source.clone(), one)
            .collect()
    }

    fn make_shard(
        &self,
        source: &mut CurveSource,
        shard: u64,
        store: Option<&AtlasStore>,
    ) -> Result<ShardBytes, AtlasError> {
        let bytes = self.block(source, self.samples(shard)).to_bytes();
        if let Some(store) = store {
            store.save(shard, &bytes)?;
            if let Some(mapped) = store.load(shard) {
                return Ok(mapped);
            }
        }
        Ok(ShardBytes::from_bytes(&bytes))
    }

    /// Refuses an atlas whose prediction exceeds the memory limit.
    ///
    /// # Errors
    /// [`AtlasError::TooLarge`].
    pub fn check_size(&self, prediction: &Prediction) -> Result<(), AtlasError> {
        if prediction.bytes > self.settings.memory_limit {
            return Err(self.too_large(prediction.bytes));
        }
        Ok(())
    }

    fn too_large(&self, bytes: u64) -> AtlasError {
        AtlasError::TooLarge {
            predicted_mb: bytes >> 20,
            limit_mb: self.settings.memory_limit >> 20,
        }
    }

    /// The store of this atlas below the cache folder `cache`.
    pub fn store(&self, cache: &Path) -> AtlasStore {
        AtlasStore::new(cache, self.key())
    }
}

impl Atlas {
    /// Limits prepared for this atlas.
    pub(super) fn limits(
        &self,
        limits: &ArtificialLimits,
        failures: &FailureSet,
        rule: Rule,
    ) -> Limits16 {
        let limits = &self.within_physical(limits);
        let turns = self.plan.sampling.uses_turns();
        Limits16::new(limits, failures, rule, (&self.slabs, &self.physical), turns)
    }

    /// Whether no joint has physical limits.
    pub fn is_free(&self) -> bool {
        self.physical.iter().all(Arc::is_full)
    }

    /// The limits cut to the physical ones, joint by joint. Where two pieces are left, the
    /// longer one.
    pub fn within_physical(&self, limits: &ArtificialLimits) -> ArtificialLimits {
        limits.within(&self.physical)
    }

    /// What was sampled.
    pub fn plan(&self) -> &SamplePlan {
        &self.plan
    }

    /// Number of joints n.
    pub fn joints(&self) -> usize {
        self.joints
    }

    /// Bytes of all blocks.
    pub fn bytes(&self) -> u64 {
        self.shards
            .iter()
            .map(|shard| shard.block().len() as u64)
            .sum()
    }

    /// The blocks, in order of samples.
    pub(super) fn views(&self) -> impl IndexedParallelIterator<Item = BlockView<'_>> {
        self.shards.par_iter().map(|shard| {
            // Every shard was checked when it was built or loaded.
            BlockView::new(shard.block()).unwrap_or_else(BlockView::empty)
        })
    }
}
