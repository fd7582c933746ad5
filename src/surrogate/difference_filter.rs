//! The difference filter: draws become ranges [S3 §III.A, eq. 6].

use crate::angle::{AngleSet, Arc};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Parameters of the filter and of the grouping after it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DifferenceFilter {
    /// Number of draws N.
    pub draws: usize,
    /// α: neighbours whose difference exceeds the mean by this many standard deviations are
    /// removed.
    pub outlier: f64,
    /// ε: neighbours closer than this, radians, are removed.
    pub closeness: f64,
    /// How often draws are filtered.
    pub passes: usize,
    /// γ: differences that exceed the mean by this many standard deviations part two ranges.
    pub gap: f64,
}

impl Default for DifferenceFilter {
    fn default() -> DifferenceFilter {
        DifferenceFilter {
            draws: 300,
            outlier: 3.0,
            closeness: 1e-5,
            passes: 1,
            gap: 6.0,
        }
    }
}

impl DifferenceFilter {
    /// The ranges that `draws` (radians) stand for. On the circle (`wrapped`) they are cut open at
    /// their widest gap, else at ±π.
    pub fn set(&self, draws: Vec<f64>, wrapped: bool) -> AngleSet {
        let kept = self.filtered(draws, wrapped);
        AngleSet::from_arcs(self.grouped(&kept))
    }

    /// The draws that survive, ascending; on the circle they may run past π.
    pub fn filtered(&self, draws: Vec<f64>, wrapped: bool) -> Vec<f64> {
        let mut sorted = draws;
        sorted.sort_by(f64::total_cmp);
        if wrapped {
            open_at_widest_gap(&mut sorted);
        }
        for _ in 0..self.passes {
            sorted = self.pass(&sorted);
        }
        sorted
    }

    fn pass(&self, sorted: &[f64]) -> Vec<f64> {
        let Some((mean, deviation)) = statistics(sorted) else {
            return sorted.to_vec();
        };
        let removed = |difference: f64| {
            difference - mean > self.outlier * deviation || difference < self.closeness
        };
        let mut keep = vec![true; sorted.len()];
        for (k, pair) in sorted.windows(2).enumerate() {
            if removed(pair[1] - pair[0]) {
                keep[k] = false;
                keep[k + 1] = false;
            }
        }
        let pairs = sorted.iter().zip(keep);
        pairs.filter(|(_, keep)| *keep).map(|(x, _)| *x).collect()
    }

    fn grouped(&self, sorted: &[f64]) -> Vec<Arc> {
        let Some((mean, deviation)) = statistics(sorted) else {
            return Vec::new();
        };
        let limit = mean + self.gap * deviation;
        let groups = sorted.chunk_by(|a, b| b - a <= limit);
        groups
            .filter(|group| group.len() > 1)
            .map(|group| Arc::from_interval(group[0], group[group.len() - 1]))
            .collect()
    }
}

/// Turns the first draws on by 2π so that the list begins after its widest gap.
fn open_at_widest_gap(sorted: &mut [f64]) {
    let n = sorted.len();
    if n < 2 {
        return;
    }
    let gap = |k: usize| match k + 1 == n {
        true => sorted[0] + TAU - sorted[k],
        false => sorted[k + 1] - sorted[k],
    };
    let widest = (0..n)
        .max_by(|&a, &b| gap(a).total_cmp(&gap(b)))
        .unwrap_or(n - 1);
    sorted.rotate_left((widest + 1) % n);
    if widest + 1 < n {
        for angle in &mut sorted[n - 1 - widest..] {
            *angle += TAU;
        }
    }
    // Ranges are the same on the circle; the first draw stays in [−π, π).
    debug_assert!(sorted[0] >= -PI);
}

/// Mean and standard deviation of the differences between neighbours; none below three draws.
fn statistics(sorted: &[f64]) -> Option<(f64, f64)> {
    if sorted.len() < 3 {
        return None;
    }
    let count = (sorted.len() - 1) as f64;
    let mean = (sorted[sorted.len() - 1] - sorted[0]) / count;
    let square = |pair: &[f64]| (pair[1] - pair[0] - mean).powi(2);
    let variance = sorted.windows(2).map(square).sum::<f64>() / count;
    Some((mean, variance.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filter() -> DifferenceFilter {
        DifferenceFilter::default()
    }

    /// Evenly spaced draws from two ranges and one outlier between them.
    #[test]
    fn ranges_are_found_and_an_outlier_is_not() {
        let mut draws: Vec<f64> = (0..100).map(|k| -2.0 + 0.01 * f64::from(k)).collect();
        draws.extend((0..100).map(|k| 1.0 + 0.01 * f64::from(k)));
        draws.push(0.0);
        let set = filter().set(draws, false);
        assert_eq!(set.arcs().len(), 2, "{set:?}");
        // The filter takes the draws next to a gap with the outlier.
        let expected = [[-2.0, -1.01], [1.01, 1.99]];
        for (arc, [start, end]) in set.arcs().iter().zip(expected) {
            assert!((arc.start() - start).abs() < 0.025, "{arc:?}");
            assert!((arc.end() - end).abs() < 0.025, "{arc:?}");
        }
    }

    #[test]
    fn on_the_circle_the_seam_is_no_gap() {
        let draws: Vec<f64> = (0..200)
            .map(|k| crate::angle::wrap(2.5 + 0.01 * f64::from(k)))
            .collect();
        let set = filter().set(draws.clone(), true);
        assert_eq!(set.arcs().len(), 1, "{set:?}");
        assert!((set.measure() - 1.99).abs() < 1e-9);
        assert_eq!(filter().set(draws, false).arcs().len(), 2);
    }

    #[test]
    fn too_few_draws_are_no_range() {
        assert!(filter().set(vec![0.1, 0.2], true).is_empty());
        assert!(filter().set(Vec::new(), false).is_empty());
    }
}
