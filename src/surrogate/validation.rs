//! How far a surrogate is from the exact workspaces, on designs it has not seen.

use super::arm::SurrogateArm;
use super::cell::Quadrature;
use super::dataset::{Dataset, Origin};
use super::mixture::logistic;
use super::model::{Model, Surrogate};
use super::surrogate_net::{ClosedForms, Head};
use crate::angle::AngleSet;
use crate::objective::Design;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Nodes at which sets are compared: radii, and for poses radii × bearings.
const RADII: usize = 100;
const POSE_RADII: usize = 16;
const POSE_BEARINGS: usize = 12;

/// Designs whose S_F is below this share of the largest are left out of the second mean overlap:
/// a sliver has a poor intersection over union however good its prediction.
pub const AREA_FLOOR: f64 = 0.01;

/// Bins of predicted probability, and angles of a cell that go into them.
const BINS: usize = 10;
const BIN_ANGLES: usize = 24;

/// How well a surrogate does on designs of one origin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Number of designs.
    pub designs: usize,
    /// Errors of S_F.
    pub size: SizeScore,
    /// Intersection over union of the workspaces, if the surrogate knows sets.
    pub overlap: Option<OverlapScore>,
    /// Empty and non-empty cells told apart, if it knows sets.
    pub cells: Option<CellScore>,
}

/// Errors of S_F, in shares of the largest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SizeScore {
    /// Mean of predicted − exact.
    pub bias: f64,
    /// Root of the mean squared error.
    pub rmse: f64,
    /// Largest error.
    pub worst: f64,
    /// Root of the mean squared error of the network alone: against the exact sets at the nodes
    /// of the surrogate's own quadrature. Equal to `rmse` where there is no quadrature.
    pub rmse_network: f64,
    /// Root of the mean squared error of that quadrature with exact sets.
    pub rmse_quadrature: f64,
    /// Rank correlation (Spearman).
    pub spearman: f64,
    /// Rank correlation within the quarter of the designs with the largest S_F.
    pub spearman_top: f64,
}

/// Intersection over union, weighted by area.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OverlapScore {
    /// Mean over all designs with a workspace.
    pub mean: f64,
    /// Median over the same designs.
    pub median: f64,
    /// Mean over designs whose S_F is at least [`AREA_FLOOR`] of the largest.
    pub mean_large: f64,
    /// Sum of all intersections over sum of all unions.
    pub pooled: f64,
}

/// Rates of confusion between empty and non-empty cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CellScore {
    /// Share of the non-empty cells that are predicted empty.
    pub false_empty: f64,
    /// Share of the empty cells that are predicted non-empty.
    pub false_non_empty: f64,
}

/// Cells or angles of similar predicted probability.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CalibrationBin {
    /// Mean predicted probability.
    pub predicted: f64,
    /// Share for which it was true.
    pub observed: f64,
    /// How many.
    pub count: u64,
}

/// Exact and predicted of one design.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Case {
    /// Exact S_F.
    pub exact: f64,
    /// Predicted S_F.
    pub predicted: f64,
    /// S_F from exact sets at the surrogate's own nodes; `exact` where it has none.
    pub at_nodes: f64,
    /// Area (poses: volume) of the intersection and of the union, if the surrogate knows sets.
    pub areas: Option<[f64; 2]>,
    /// Non-empty cells, those of them predicted empty, empty cells, those of them predicted
    /// non-empty.
    pub confusion: [u64; 4],
}

impl Case {
    /// Intersection over union; 1 if both are empty.
    pub fn overlap(&self) -> Option<f64> {
        self.areas
            .map(|[common, union]| if union > 0.0 { common / union } else { 1.0 })
    }
}

/// Compares a model with the exact workspaces of every design.
pub fn cases(model: &Model, dataset: &Dataset) -> Vec<Case> {
    let arm = model.arm();
    let designs = dataset.designs();
    let one = |k: usize| {
        let design = designs[k].design();
        case(model, arm, &design, designs[k].size)
    };
    (0..designs.len()).into_par_iter().map(one).collect()
}

fn case(model: &Model, arm: &SurrogateArm, design: &Design, exact: f64) -> Case {
    let mut case = Case {
        exact,
        predicted: model.sizes(std::slice::from_ref(design))[0],
        at_nodes: exact,
        ..Case::default()
    };
    let rule = comparison(model, design);
    let Some(predicted) = model.sets(design, &rule.cells) else {
        return case;
    };
    let truth = arm.fault_tolerant_sets(design, &rule.cells);
    let mut areas = [0.0; 2];
    for ((truth, predicted), weight) in truth.iter().zip(&predicted).zip(&rule.weights) {
        let common = truth.overlap(predicted);
        areas[0] += weight * common;
        areas[1] += weight * (truth.measure() + predicted.measure() - common);
        let (is, seems) = (truth.measure() > 0.0, predicted.measure() > 0.0);
        let confusion = &mut case.confusion;
        match is {
            true => confusion[0] += 1,
            false => confusion[2] += 1,
        }
        match (is, seems) {
            (true, false) => confusion[1] += 1,
            (false, true) => confusion[3] += 1,
            _ => {}
        }
    }
    case.areas = Some(areas);
    let nodes = model.quadrature(&arm.locked_joints(design));
    case.at_nodes = nodes.sum(&arm.fault_tolerant_sets(design, &nodes.cells));
    case
}

/// The nodes at which sets are compared: over the whole reach if the network learnt it, else
/// inside the gate, outside of which exact and predicted sets are empty.
fn comparison(model: &Model, design: &Design) -> Quadrature {
    let arm = model.arm();
    let locked = arm.locked_joints(design);
    let radii = if arm.pose { POSE_RADII } else { RADII };
    match model.architecture().closed_forms {
        ClosedForms::None => Quadrature::over_reach(arm, &locked, radii, POSE_BEARINGS),
        _ => Quadrature::inside_gate(arm, &locked, radii, POSE_BEARINGS),
    }
}

/// Scores over the cases of designs of one origin; `largest` is the unit of errors of S_F.
pub fn score(cases: &[Case], dataset: &Dataset, origin: Origin, largest: f64) -> Score {
    let pairs = cases.iter().zip(dataset.designs());
    let chosen: Vec<Case> = pairs
        .filter(|(_, design)| design.origin == origin)
        .map(|(case, _)| *case)
        .collect();
    Score {
        designs: chosen.len(),
        size: size_score(&chosen, largest),
        overlap: overlap_score(&chosen, largest),
        cells: cell_score(&chosen),
    }
}

fn size_score(cases: &[Case], largest: f64) -> SizeScore {
    if cases.is_empty() || largest <= 0.0 {
        return SizeScore::default();
    }
    let count = cases.len() as f64;
    let mean = |of: &dyn Fn(&Case) -> f64| cases.iter().map(of).sum::<f64>() / count;
    let root = |of: &dyn Fn(&Case) -> f64| mean(&|case| of(case).powi(2)).sqrt() / largest;
    let error = |case: &Case| case.predicted - case.exact;
    let mut by_size: Vec<&Case> = cases.iter().collect();
    by_size.sort_by(|a, b| b.exact.total_cmp(&a.exact));
    by_size.truncate(cases.len().div_ceil(4));
    let columns = |cases: &[&Case]| {
        let exact: Vec<f64> = cases.iter().map(|case| case.exact).collect();
        let predicted: Vec<f64> = cases.iter().map(|case| case.predicted).collect();
        spearman(&exact, &predicted)
    };
    SizeScore {
        bias: mean(&error) / largest,
        rmse: root(&error),
        worst: cases.iter().map(|c| error(c).abs()).fold(0.0, f64::max) / largest,
        rmse_network: root(&|case| case.predicted - case.at_nodes),
        rmse_quadrature: root(&|case| case.at_nodes - case.exact),
        spearman: columns(&cases.iter().collect::<Vec<_>>()),
        spearman_top: columns(&by_size),
    }
}

fn overlap_score(cases: &[Case], largest: f64) -> Option<OverlapScore> {
    let present: Vec<(&Case, f64)> = cases
        .iter()
        .filter(|case| case.exact > 0.0)
        .filter_map(|case| Some((case, case.overlap()?)))
        .collect();
    if present.is_empty() {
        return None;
    }
    let mut values: Vec<f64> = present.iter().map(|(_, overlap)| *overlap).collect();
    let large = present
        .iter()
        .filter(|(case, _)| case.exact >= AREA_FLOOR * largest)
        .map(|(_, overlap)| *overlap);
    let large: Vec<f64> = large.collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    let sum = |k: usize| -> f64 {
        let areas = cases.iter().filter_map(|case| case.areas);
        areas.map(|areas| areas[k]).sum()
    };
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    Some(OverlapScore {
        mean: mean(&values),
        median: match values.len() % 2 {
            1 => values[half],
            _ => 0.5 * (values[half - 1] + values[half]),
        },
        mean_large: mean(&large),
        pooled: if sum(1) > 0.0 { sum(0) / sum(1) } else { 1.0 },
    })
}

fn cell_score(cases: &[Case]) -> Option<CellScore> {
    let sum = |k: usize| cases.iter().map(|case| case.confusion[k]).sum::<u64>() as f64;
    (sum(0) + sum(2) > 0.0).then(|| CellScore {
        false_empty: sum(1) / sum(0).max(1.0),
        false_non_empty: sum(3) / sum(2).max(1.0),
    })
}

/// Rank correlation of two lists of one length, equal values sharing their mean rank (Spearman
/// 1904); 0 if one list is constant.
pub fn spearman(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (ranks(a), ranks(b));
    let middle = (a.len() as f64 - 1.0) / 2.0;
    let product = |x: &[f64], y: &[f64]| -> f64 {
        let pairs = x.iter().zip(y);
        pairs.map(|(x, y)| (x - middle) * (y - middle)).sum()
    };
    let scale = (product(&a, &a) * product(&b, &b)).sqrt();
    if scale > 0.0 {
        product(&a, &b) / scale
    } else {
        0.0
    }
}

fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for group in order.chunk_by(|&a, &b| values[a] == values[b]) {
        let rank = first as f64 + 0.5 * (group.len() as f64 - 1.0);
        group.iter().for_each(|&k| ranks[k] = rank);
        first += group.len();
    }
    ranks
}

/// Predicted probabilities against what was true: of a cell's not being empty for mixtures, of an
/// angle's being in the set for arcs. Empty for sizes.
pub fn calibration(model: &Model, dataset: &Dataset) -> Vec<CalibrationBin> {
    let of = |k: usize| calibration_of(model, &dataset.designs()[k].design());
    let parts: Vec<Vec<(f64, bool)>> = (0..dataset.designs().len())
        .into_par_iter()
        .map(of)
        .collect();
    let mut bins = vec![CalibrationBin::default(); BINS];
    for (probability, truth) in parts.into_iter().flatten() {
        let bin = &mut bins[((probability * BINS as f64) as usize).min(BINS - 1)];
        bin.predicted += probability;
        bin.observed += f64::from(u8::from(truth));
        bin.count += 1;
    }
    bins.retain(|bin| bin.count > 0);
    for bin in &mut bins {
        bin.predicted /= bin.count as f64;
        bin.observed /= bin.count as f64;
    }
    bins
}

fn calibration_of(model: &Model, design: &Design) -> Vec<(f64, bool)> {
    let arm = model.arm();
    let cells = comparison(model, design).cells;
    match &model.architecture().head {
        Head::Size(_) => Vec::new(),
        Head::Mdn(_) => {
            let mixtures = model.mixtures(design, &cells).unwrap_or_default();
            let truth = arm.fault_tolerant_sets(design, &cells);
            let pairs = mixtures.iter().zip(&truth);
            pairs
                .map(|(mixture, set)| (mixture.presence, set.measure() > 0.0))
                .collect()
        }
        Head::Arcs(head) => {
            let rows = model.rows(design, &cells);
            let truth: Vec<AngleSet> = match model.architecture().closed_forms {
                ClosedForms::PostFailure => arm.pre_failure_sets(design, &cells),
                _ => arm.fault_tolerant_sets(design, &cells),
            };
            let rows = rows.chunks_exact(head.outputs()).zip(&truth);
            rows.flat_map(|(row, set)| {
                (0..BIN_ANGLES).map(|k| {
                    let angle = -PI + (k as f64 + 0.5) * TAU / BIN_ANGLES as f64;
                    (logistic(head.logit(row, angle)), set.contains(angle))
                })
            })
            .collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_of_equal_values_are_shared() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0]), [1.5, 0.0, 1.5]);
        assert_eq!(spearman(&[1.0, 2.0, 3.0], &[10.0, 30.0, 90.0]), 1.0);
        assert_eq!(spearman(&[1.0, 2.0, 3.0], &[3.0, 2.0, 1.0]), -1.0);
        assert_eq!(spearman(&[1.0, 2.0], &[5.0, 5.0]), 0.0);
        // Without ties: 1 − 6 Σd²/(n(n² − 1)) with Σd² = 8, n = 5.
        let r = spearman(&[1.0, 2.0, 3.0, 4.0, 5.0], &[2.0, 3.0, 1.0, 5.0, 4.0]);
        assert!((r - (1.0 - 6.0 * 8.0 / 120.0)).abs() < 1e-12, "{r}");
    }

    #[test]
    fn scores_of_perfect_and_of_shifted_predictions() {
        let case = |exact: f64, off: f64| Case {
            exact,
            predicted: exact + off,
            at_nodes: exact,
            areas: Some([exact, exact + off]),
            confusion: [1, 0, 1, 0],
        };
        let perfect: Vec<Case> = (1..9).map(|k| case(f64::from(k), 0.0)).collect();
        let shifted: Vec<Case> = (1..9).map(|k| case(f64::from(k), 0.8)).collect();
        let score = size_score(&perfect, 8.0);
        assert_eq!(
            (score.rmse, score.spearman, score.spearman_top),
            (0.0, 1.0, 1.0)
        );
        let score = size_score(&shifted, 8.0);
        for value in [score.bias, score.rmse, score.worst, score.rmse_network] {
            assert!((value - 0.1).abs() < 1e-12);
        }
        let overlap = overlap_score(&shifted, 8.0).unwrap();
        assert!((overlap.pooled - 36.0 / 42.4).abs() < 1e-12);
        assert!(overlap.mean < 1.0 && overlap.median < 1.0);
    }
}
