//! Decoders fitted on kept-back designs.

use super::arm::SurrogateArm;
use super::dataset::Dataset;
use super::decode::Decoder;
use super::difference_filter::DifferenceFilter;
use super::mixture::Mixture;
use super::model::{Model, Surrogate};
use crate::angle::AngleSet;
use crate::sampling::stream;
use rayon::prelude::*;

/// Designs that decoders are fitted on, spread evenly over the kept-back ones.
const DESIGNS: usize = 120;

/// Candidates.
const SHARES: [f64; 7] = [0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5];
const OUTLIERS: [f64; 3] = [2.0, 3.0, 5.0];
const GAPS: [f64; 3] = [3.0, 6.0, 10.0];

/// A mixture with its weight in S_F, the set that it should stand for, and what closed forms leave
/// of any set.
struct Known {
    mixture: Mixture,
    weight: f64,
    truth: AngleSet,
    allowed: AngleSet,
}

/// The decoder of the same kind as `decoder` whose sets have the largest pooled intersection over
/// union with the exact ones. `decoder` itself if the model has no mixtures.
pub fn fitted(model: &Model, kept_back: &Dataset, decoder: &Decoder) -> Decoder {
    let known = known(model, kept_back);
    if known.is_empty() {
        return *decoder;
    }
    let candidates: Vec<Decoder> = match decoder {
        Decoder::Level { .. } => SHARES.map(|share| Decoder::Level { share }).to_vec(),
        Decoder::Sampling(filter) => {
            let with = |(outlier, gap)| {
                Decoder::Sampling(DifferenceFilter {
                    outlier,
                    gap,
                    ..*filter
                })
            };
            let pairs = OUTLIERS
                .iter()
                .flat_map(|&o| GAPS.iter().map(move |&g| (o, g)));
            pairs.map(with).collect()
        }
    };
    let scores = candidates.iter().map(|candidate| pooled(candidate, &known));
    let scored = candidates.iter().zip(scores.collect::<Vec<f64>>());
    let best = scored.max_by(|a, b| a.1.total_cmp(&b.1));
    best.map_or(*decoder, |(candidate, _)| *candidate)
}

fn known(model: &Model, kept_back: &Dataset) -> Vec<Known> {
    let designs = kept_back.designs();
    let step = designs.len().div_ceil(DESIGNS).max(1);
    let chosen: Vec<usize> = (0..designs.len()).step_by(step).collect();
    let of = |&k: &usize| known_of(model, model.arm(), &designs[k].design());
    chosen.par_iter().flat_map_iter(of).collect()
}

fn known_of(model: &Model, arm: &SurrogateArm, design: &crate::objective::Design) -> Vec<Known> {
    let locked = arm.locked_joints(design);
    let rule = model.quadrature(&locked);
    let mixtures = model.mixtures(design, &rule.cells).unwrap_or_default();
    let truths = arm.fault_tolerant_sets(design, &rule.cells);
    let rows = mixtures.into_iter().zip(truths);
    let rows = rows.zip(rule.cells.iter().zip(&rule.weights));
    rows.map(|((mixture, truth), (cell, &weight))| Known {
        mixture,
        weight,
        truth,
        allowed: model.allowed(&locked, cell),
    })
    .collect()
}

fn pooled(decoder: &Decoder, known: &[Known]) -> f64 {
    let areas = |(k, known): (usize, &Known)| {
        let set = decoder.decode(&known.mixture, &mut stream(0, k as u64));
        let set = set.intersection(&known.allowed);
        let common = set.overlap(&known.truth);
        let union = set.measure() + known.truth.measure() - common;
        [known.weight * common, known.weight * union]
    };
    let areas: Vec<[f64; 2]> = known.par_iter().enumerate().map(areas).collect();
    let sum = |k: usize| areas.iter().map(|area| area[k]).sum::<f64>();
    if sum(1) > 0.0 { sum(0) / sum(1) } else { 0.0 }
}
