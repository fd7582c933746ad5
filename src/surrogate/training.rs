//! Training: epochs of AdamW with a cosine schedule, stopped early, the same on any number of
//! threads.
//!
//! A batch is cut into as many chunks whatever the number of threads; each has its own random
//! stream, and their gradients are added in order.

use super::adamw::AdamW;
use super::arm::SurrogateArm;
use super::dataset::Dataset;
use super::dataset_store::Parts;
use super::network::{Layers, Network};
use super::surrogate_net::{Architecture, Example};
use crate::sampling::stream;
use rand::seq::SliceRandom;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Chunks of a batch: a multiple of these.
const CHUNKS: usize = 4;

/// Examples of the kept-back data that are looked at after every epoch.
const JUDGED: usize = 16_384;

/// Steps over which the learning rate rises to its full value, at most a tenth of all.
const WARM_UP: f64 = 200.0;

/// The learning rate ends at this share of its largest value.
const LAST_RATE: f64 = 0.01;

/// Random streams of the first weights and of the judged examples.
const WEIGHT_STREAM: u64 = 1 << 50;
const JUDGE_STREAM: u64 = 1 << 51;

/// How a network is trained.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrainingSettings {
    /// Seed of weights, order and draws.
    pub seed: u64,
    /// Passes over the training data.
    pub epochs: u64,
    /// Examples per step.
    pub batch: usize,
    /// Largest learning rate.
    pub learning_rate: f64,
    /// Decoupled weight decay.
    pub weight_decay: f64,
    /// Epochs without improvement on kept-back data after which training ends.
    pub patience: u64,
    /// Whether every other example is replaced by its mirror image.
    pub mirror: bool,
}

/// How an epoch went.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Epoch {
    /// Number, from 1.
    pub number: u64,
    /// Mean loss while training.
    pub training_loss: f64,
    /// Mean loss on kept-back data.
    pub kept_back_loss: f64,
}

/// Training between two epochs: what a checkpoint holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Training {
    network: Network,
    adam: AdamW,
    best: Network,
    history: Vec<Epoch>,
}

/// Training failed.
#[derive(Debug, thiserror::Error)]
pub enum TrainingError {
    /// The loss or a gradient is not finite.
    #[error("training diverged in epoch {epoch}")]
    Diverged {
        /// The epoch.
        epoch: u64,
    },
    /// There is nothing to learn from.
    #[error("the {part} data has no example")]
    NoData {
        /// Which data.
        part: &'static str,
    },
    /// From candle.
    #[error(transparent)]
    Candle(#[from] candle_core::Error),
}

/// What training works with and never changes.
pub struct Lesson<'a> {
    arm: &'a SurrogateArm,
    architecture: &'a Architecture,
    settings: TrainingSettings,
    training: &'a Dataset,
    kept_back: &'a Dataset,
    examples: Vec<Example>,
    judged: Vec<Example>,
}

impl<'a> Lesson<'a> {
    /// # Errors
    /// One of the two parts has no example.
    pub fn new(
        arm: &'a SurrogateArm,
        architecture: &'a Architecture,
        settings: TrainingSettings,
        parts: &'a Parts,
    ) -> Result<Lesson<'a>, TrainingError> {
        let examples = architecture.examples(&parts.training);
        let mut judged = architecture.examples(&parts.kept_back);
        for (part, list) in [("training", &examples), ("kept-back", &judged)] {
            if list.is_empty() {
                return Err(TrainingError::NoData { part });
            }
        }
        judged.shuffle(&mut stream(settings.seed, JUDGE_STREAM));
        judged.truncate(JUDGED);
        Ok(Lesson {
            arm,
            architecture,
            settings,
            training: &parts.training,
            kept_back: &parts.kept_back,
            examples,
            judged,
        })
    }

    /// Passes over the training data, unless training ends early.
    pub fn epochs(&self) -> u64 {
        self.settings.epochs
    }

    fn steps(&self) -> usize {
        self.examples.len().div_ceil(self.settings.batch)
    }

    fn rate(&self, step: f64) -> f64 {
        let total = self.settings.epochs as f64 * self.steps() as f64;
        let cosine = 0.5 * (1.0 + (PI * (step / total).min(1.0)).cos());
        let share = LAST_RATE + (1.0 - LAST_RATE) * cosine;
        self.settings.learning_rate
            * share
            * ((step + 1.0) / WARM_UP.min(0.1 * total).max(1.0)).min(1.0)
    }
}

impl Training {
    /// Random weights.
    pub fn new(lesson: &Lesson) -> Training {
        let sizes = lesson.architecture.sizes(lesson.arm);
        let generator = &mut stream(lesson.settings.seed, WEIGHT_STREAM);
        let network = Network::random(&sizes, generator);
        Training {
            adam: AdamW::new(network.weights().len()),
            best: network.clone(),
            network,
            history: Vec::new(),
        }
    }

    /// Epochs so far.
    pub fn history(&self) -> &[Epoch] {
        &self.history
    }

    /// The network of the epoch with the least loss on kept-back data.
    pub fn best(&self) -> &Network {
        &self.best
    }

    /// The epoch with the least loss on kept-back data.
    pub fn best_epoch(&self) -> Option<&Epoch> {
        let finite = |a: &&Epoch, b: &&Epoch| a.kept_back_loss.total_cmp(&b.kept_back_loss);
        self.history.iter().min_by(finite)
    }

    /// Whether all epochs are done, or the patience is at its end.
    pub fn is_done(&self, lesson: &Lesson) -> bool {
        let epochs = self.history.len() as u64;
        let best = self.best_epoch().map_or(0, |epoch| epoch.number);
        epochs >= lesson.settings.epochs || epochs - best >= lesson.settings.patience
    }

    /// Trains for one epoch.
    ///
    /// # Errors
    /// Training diverged (the state stays as it was before the epoch), or candle failed.
    pub fn epoch(&mut self, lesson: &Lesson) -> Result<Epoch, TrainingError> {
        let number = self.history.len() as u64 + 1;
        let (mut network, mut adam) = (self.network.clone(), self.adam.clone());
        let mut order: Vec<u32> = (0..lesson.examples.len() as u32).collect();
        order.shuffle(&mut stream(lesson.settings.seed, number << 24));
        let mut total = 0.0;
        let mut step = (number - 1) as f64 * lesson.steps() as f64;
        for (k, batch) in order.chunks(lesson.settings.batch).enumerate() {
            let first = (number << 24) + 1 + (k * 1024) as u64;
            let (loss, gradient) = batch_gradient(lesson, &network, batch, first)?;
            if !loss.is_finite() || gradient.iter().any(|g| !g.is_finite()) {
                return Err(TrainingError::Diverged { epoch: number });
            }
            let (rate, decay) = (lesson.rate(step), lesson.settings.weight_decay);
            adam.step(network.weights_mut(), &gradient, rate as f32, decay as f32);
            total += loss;
            step += 1.0;
        }
        let epoch = Epoch {
            number,
            training_loss: total / lesson.examples.len() as f64,
            kept_back_loss: judge(lesson, &network)?,
        };
        if !epoch.kept_back_loss.is_finite() {
            return Err(TrainingError::Diverged { epoch: number });
        }
        let best = self.best_epoch().map(|best| best.kept_back_loss);
        if best.is_none_or(|best| epoch.kept_back_loss < best) {
            self.best = network.clone();
        }
        (self.network, self.adam) = (network, adam);
        self.history.push(epoch);
        Ok(epoch)
    }
}

/// Summed loss and mean gradient over a batch, whose chunks use the streams from `first` on.
fn batch_gradient(
    lesson: &Lesson,
    network: &Network,
    batch: &[u32],
    first: u64,
) -> Result<(f64, Vec<f32>), TrainingError> {
    let layers = network.variables()?;
    let chunks = batch.len().div_ceil(network.rows_of_chunk());
    let rows = batch.len().div_ceil(chunks.next_multiple_of(CHUNKS)).max(1);
    let work = |(k, chunk): (usize, &[u32])| {
        let examples: Vec<Example> = chunk.iter().map(|&i| lesson.examples[i as usize]).collect();
        chunk_gradient(lesson, &layers, &examples, first + k as u64)
    };
    let parts: Result<Vec<_>, _> = batch.par_chunks(rows).enumerate().map(work).collect();
    let mut gradient = vec![0.0_f32; network.weights().len()];
    let mut loss = 0.0;
    for (value, part) in parts? {
        loss += value;
        for (sum, g) in gradient.iter_mut().zip(part) {
            *sum += g;
        }
    }
    let scale = 1.0 / batch.len() as f32;
    gradient.iter_mut().for_each(|g| *g *= scale);
    Ok((loss, gradient))
}

fn chunk_gradient(
    lesson: &Lesson,
    layers: &Layers,
    examples: &[Example],
    item: u64,
) -> Result<(f64, Vec<f32>), candle_core::Error> {
    let mut generator = stream(lesson.settings.seed, item);
    let mirror = lesson.settings.mirror;
    let prepared = lesson.architecture.prepare(
        lesson.arm,
        lesson.training,
        examples,
        mirror,
        &mut generator,
    );
    layers.gradient(&prepared.inputs, |outputs| {
        let mut by_outputs = vec![0.0; outputs.len()];
        let loss =
            lesson
                .architecture
                .loss(outputs, &prepared.targets, &mut generator, &mut by_outputs);
        (loss, by_outputs)
    })
}

/// Mean loss on kept-back data, always with the same draws.
fn judge(lesson: &Lesson, network: &Network) -> Result<f64, TrainingError> {
    let layers = network.layers()?;
    let rows = network.rows_of_chunk();
    let work = |(k, examples): (usize, &[Example])| {
        let mut generator = stream(lesson.settings.seed, JUDGE_STREAM + 1 + k as u64);
        let prepared = lesson.architecture.prepare(
            lesson.arm,
            lesson.kept_back,
            examples,
            false,
            &mut generator,
        );
        let outputs = layers.apply(&prepared.inputs)?;
        let mut ignored = vec![0.0; outputs.len()];
        let targets = &prepared.targets;
        Ok(lesson
            .architecture
            .loss(&outputs, targets, &mut generator, &mut ignored))
    };
    let chunks = lesson.judged.par_chunks(rows).enumerate().map(work);
    let losses: Result<Vec<f64>, candle_core::Error> = chunks.collect();
    Ok(losses?.into_iter().sum::<f64>() / lesson.judged.len() as f64)
}
