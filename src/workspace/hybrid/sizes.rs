//! Sizes of all workspaces over an atlas, with standard errors.

use super::atlas::Atlas;
use super::block::BlockView;
use super::plan::Sampling;
use super::score::{Limits16, Rule, covers};
use crate::angle::AngleSet;
use crate::workspace::{ArtificialLimits, Estimate, FailureSet, WorkspaceSizes};
use rayon::prelude::*;

/// How many task points an estimate rests on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleCounts {
    /// Samples taken.
    pub samples: u64,
    /// Samples that the robot reaches with all joints free.
    pub reachable: u64,
    /// Reachable samples whose pre-image failed a check of completeness; they are counted with
    /// what was found.
    pub failed: u64,
    /// Random starts made.
    pub seeds: u64,
}

/// Sums of one stratum: for every workspace Σ y and Σ y², y = weight · measure.
type Sums = Vec<[f64; 2]>;

impl Atlas {
    /// S_F for `limits`: the score of a search.
    pub fn fault_tolerant_size(&self, limits: &ArtificialLimits, failures: &FailureSet) -> f64 {
        let limits = self.limits(limits, failures, Rule::Definition);
        let shares: Vec<f64> = self
            .views()
            .map(|view| {
                let poses = view.poses.iter().enumerate();
                poses
                    .map(|(index, pose)| pose.weight * limits.measure(&view, index))
                    .sum()
            })
            .collect();
        shares.iter().sum()
    }

    /// Sizes of all workspaces for `limits`.
    pub fn sizes(
        &self,
        limits: &ArtificialLimits,
        failures: &FailureSet,
        rule: Rule,
    ) -> WorkspaceSizes {
        let limits = self.limits(limits, failures, rule);
        let strata = self.plan().strata() as usize;
        let measures = self.joints + 3;
        let blocks: Vec<Vec<(usize, Sums)>> = self
            .views()
            .map(|view| block_sums(&view, &limits, measures))
            .collect();
        let mut sums: Vec<Sums> = vec![vec![[0.0; 2]; measures]; strata];
        // Blocks in order, so that the sum does not depend on threads.
        for (stratum, part) in blocks.into_iter().flatten() {
            for (total, add) in sums[stratum].iter_mut().zip(part) {
                total[0] += add[0];
                total[1] += add[1];
            }
        }
        let estimate = |measure: usize| {
            let column: Vec<[f64; 2]> = sums.iter().map(|stratum| stratum[measure]).collect();
            self.estimate(&column)
        };
        WorkspaceSizes {
            fault_tolerant: estimate(0),
            pre_failure: estimate(1),
            unrestricted: estimate(2),
            post_failure: (3..measures).map(estimate).collect(),
        }
    }

    /// a · S_F for the first failure set less b · S_F for the second, [a, b] = `factors`. Both see the
    /// same samples, so that the difference is known far better than either.
    pub fn fault_tolerant_difference(
        &self,
        limits: &ArtificialLimits,
        failures: [&FailureSet; 2],
        factors: [f64; 2],
    ) -> Estimate {
        let both = failures.map(|failures| self.limits(limits, failures, Rule::Definition));
        let mut sums = vec![[0.0; 2]; self.plan().strata() as usize];
        let parts = self.views().map(|view| {
            let poses = view.poses.iter().enumerate();
            let part = poses.map(|(index, pose)| {
                let [a, b] = both.each_ref().map(|limits| limits.measure(&view, index));
                let y = pose.weight * (factors[0] * a - factors[1] * b);
                (pose.stratum as usize, y)
            });
            part.collect::<Vec<(usize, f64)>>()
        });
        let parts: Vec<_> = parts.collect();
        for (stratum, y) in parts.into_iter().flatten() {
            sums[stratum][0] += y;
            sums[stratum][1] += y * y;
        }
        self.estimate(&sums)
    }

    /// Value and standard error from the sums of every stratum.
    fn estimate(&self, strata: &[[f64; 2]]) -> Estimate {
        let value: f64 = strata.iter().map(|sum| sum[0]).sum();
        let variance = match self.plan().sampling {
            Sampling::Lattice { .. } | Sampling::Everywhere { .. } => {
                replicate_variance(strata, value)
            }
            Sampling::Grid {
                orientations,
                centres,
                ..
            } => {
                let random = match orientations {
                    1 => variance_between(strata, self.plan().cells()[0]),
                    each => variance_within(strata, each),
                };
                let cells = if centres {
                    self.discretisation(strata)
                } else {
                    0.0
                };
                random + cells * cells
            }
        };
        Estimate {
            value,
            error: variance.max(0.0).sqrt(),
        }
    }

    /// Half the difference between the sums over the two colours of a chessboard of cells.
    fn discretisation(&self, strata: &[[f64; 2]]) -> f64 {
        let [columns, _] = self.plan().cells();
        let signed = strata.iter().enumerate().map(|(cell, sum)| {
            let odd = (cell % columns + cell / columns) % 2 == 1;
            if odd { sum[0] } else { -sum[0] }
        });
        signed.sum::<f64>().abs()
    }

    /// What the estimates rest on.
    pub fn counts(&self) -> SampleCounts {
        let parts: Vec<SampleCounts> = self
            .views()
            .map(|view| SampleCounts {
                samples: u64::from(view.samples),
                reachable: view.poses.len() as u64,
                failed: view.poses.iter().filter(|pose| pose.sound == 0).count() as u64,
                seeds: view.seeds,
            })
            .collect();
        parts
            .iter()
            .fold(SampleCounts::default(), |a, b| SampleCounts {
                samples: a.samples + b.samples,
                reachable: a.reachable + b.reachable,
                failed: a.failed + b.failed,
                seeds: a.seeds + b.seeds,
            })
    }
}

/// Independent replicates: the scatter of their estimates.
///
/// From R replicates that scatter is itself known to a factor only. As JCGM 101:2008 §6.4.9
/// asks for, the standard error is that of the t distribution, √((R − 1)/(R − 3)) times larger,
/// where it exists.
fn replicate_variance(replicates: &[[f64; 2]], value: f64) -> f64 {
    let count = replicates.len() as f64;
    let widened = match replicates.len() {
        0..=3 => 1.0,
        _ => (count - 1.0) / (count - 3.0),
    };
    let mean = value / count;
    let square: f64 = replicates.iter().map(|sum| (sum[0] - mean).powi(2)).sum();
    // Var(Σ T) of R independent parts T: R times their sample variance.
    widened * square * count / (count - 1.0).max(1.0)
}

/// Independent samples in every cell.
fn variance_within(cells: &[[f64; 2]], each: u32) -> f64 {
    let n = f64::from(each);
    let within = |sum: &[f64; 2]| (sum[1] - sum[0] * sum[0] / n) * n / (n - 1.0);
    cells.iter().map(within).sum()
}

/// One sample in every cell, `columns` cells a row: half the mean square difference of neighbours,
/// all of them. The border of a workspace always lies between some two, so that the estimate
/// cannot miss it; pairs of cells taken apart would, every other time.
fn variance_between(cells: &[[f64; 2]], columns: usize) -> f64 {
    let squares = |pairs: &mut dyn Iterator<Item = (usize, usize)>| -> f64 {
        pairs
            .map(|(a, b)| (cells[a][0] - cells[b][0]).powi(2))
            .sum()
    };
    let count = cells.len();
    let beside = |&(a, _): &(usize, usize)| (a + 1) % columns != 0;
    let across = squares(&mut (1..count).map(|b| (b - 1, b)).filter(beside));
    let along = squares(&mut (columns..count).map(|b| (b - columns, b)));
    match count > columns {
        true => 0.25 * (across + along),
        false => 0.5 * across,
    }
}

/// Sums of every stratum in the block, in order of strata: S_F, W₀, unrestricted, W_1 … W_n.
fn block_sums(view: &BlockView, limits: &Limits16, measures: usize) -> Vec<(usize, Sums)> {
    let mut strata: Vec<(usize, Sums)> = Vec::new();
    for (index, pose) in view.poses.iter().enumerate() {
        let stratum = pose.stratum as usize;
        if strata.last().is_none_or(|(last, _)| *last != stratum) {
            strata.push((stratum, vec![[0.0; 2]; measures]));
        }
        if let Some((_, sums)) = strata.last_mut() {
            for (sum, measure) in sums.iter_mut().zip(pose_measures(view, index, limits)) {
                let y = pose.weight * measure;
                sum[0] += y;
                sum[1] += y * y;
            }
        }
    }
    strata
}

/// Measures of the rotation angles: S_F, W₀, unrestricted, then W_1 … W_n of every joint.
fn pose_measures(view: &BlockView, index: usize, limits: &Limits16) -> Vec<f64> {
    let pose = &view.poses[index];
    let image = limits.image(view, pose);
    let before = limits.before_failure(&image);
    let mut ranges = view.ranges(index);
    let first = ranges.next().unwrap_or_default();
    let mut measures = vec![
        0.0,
        before.measure(),
        limits.unrestricted(first).measure(),
        limits.lock_of_1(first).measure(),
    ];
    let mut tolerant = before;
    if limits.prone[0] {
        tolerant = tolerant.intersection(&limits.lock_of_1(first));
    }
    for (joint, range) in (1..).zip(ranges) {
        let survives = if covers(range, limits.locks[joint]) {
            limits.lock_of(view, pose, joint)
        } else {
            AngleSet::empty()
        };
        measures.push(survives.measure());
        if limits.prone[joint] {
            tolerant = tolerant.intersection(&survives);
        }
    }
    measures[0] = tolerant.measure();
    measures
}
