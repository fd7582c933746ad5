//! Which angles of a joint most task points can do without.

use super::atlas::Atlas;
use super::turn16::angle_set;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

impl Atlas {
    /// For every joint and each of `bins` equal parts of the circle from −π on: the share of the
    /// reachable samples, by weight, whose range Θ holds the middle of the part. A lock there
    /// leaves these samples reachable, so good limits lie where the share is large.
    pub fn coverage(&self, bins: usize) -> Vec<Vec<f64>> {
        let bins = bins.max(1);
        let middle = |bin: usize| -PI + (bin as f64 + 0.5) * TAU / bins as f64;
        let parts: Vec<(f64, Vec<Vec<f64>>)> = self
            .views()
            .map(|view| {
                let mut sums = vec![vec![0.0; bins]; self.joints];
                let mut total = 0.0;
                for (index, pose) in view.poses.iter().enumerate() {
                    total += pose.weight;
                    for (sums, range) in sums.iter_mut().zip(view.ranges(index)) {
                        let range = angle_set(range);
                        for (bin, sum) in sums.iter_mut().enumerate() {
                            if range.contains(middle(bin)) {
                                *sum += pose.weight;
                            }
                        }
                    }
                }
                (total, sums)
            })
            .collect();
        let total: f64 = parts.iter().map(|(total, _)| total).sum();
        let share = |joint: usize, bin: usize| {
            let sum: f64 = parts.iter().map(|(_, sums)| sums[joint][bin]).sum();
            if total > 0.0 { sum / total } else { 0.0 }
        };
        (0..self.joints)
            .map(|joint| (0..bins).map(|bin| share(joint, bin)).collect())
            .collect()
    }
}
