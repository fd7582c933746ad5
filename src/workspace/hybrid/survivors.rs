//! Limits that some sample survives: where a search may begin when random limits all score 0.

use super::atlas::Atlas;
use super::block::BlockView;
use super::turn16::{Arc16, STEP, angle};
use crate::sampling::stream;
use crate::workspace::{ArtificialLimits, JointLimit};
use rand::Rng;
use rayon::prelude::*;

/// The random stream of candidate k is `stream(seed, CANDIDATES + k)`.
const CANDIDATES: u64 = 1 << 48;

impl Atlas {
    /// `count` artificial limits; each is drawn around a configuration of a random sample's
    /// pre-image, inside the ranges that the joints have there.
    ///
    /// So A_i ⊂ Θ_i for all joints, and the sample is reached before a failure: unless physical
    /// limits of joint 1 intervene it belongs to W_F. None if no sample is reachable.
    pub fn surviving_limits(&self, count: usize, seed: u64) -> Vec<ArtificialLimits> {
        let views: Vec<BlockView> = self.views().collect();
        let poses: usize = views.iter().map(|view| view.poses.len()).sum();
        if poses == 0 {
            return Vec::new();
        }
        let draw = |k: usize| {
            let mut rng = stream(seed, CANDIDATES + k as u64);
            let mut index = rng.random_range(0..poses);
            let view = views.iter().find(|view| {
                let inside = index < view.poses.len();
                index -= if inside { 0 } else { view.poses.len() };
                inside
            });
            view.and_then(|view| limits_around(view, index, &mut rng))
        };
        (0..count).filter_map(draw).collect()
    }
}

/// Limits that pose `index` survives; `None` if it has no curve.
fn limits_around(view: &BlockView, index: usize, rng: &mut impl Rng) -> Option<ArtificialLimits> {
    let pieces: Vec<&[u16]> = view.pieces(&view.poses[index]).collect();
    let piece = pieces.get(rng.random_range(0..pieces.len().max(1)))?;
    let vertex = rng.random_range(0..piece.len() / view.joints);
    let theta = &piece[vertex * view.joints..][..view.joints];
    let pairs = theta.iter().zip(view.ranges(index));
    let limits = pairs.map(|(&theta, range)| {
        let share: f64 = rng.random();
        // An end of a range and a vertex there may be a rounding apart: then the joint stands.
        let arc = range.iter().find(|arc| arc.contains(theta));
        limit_within(arc.copied(), theta, share)
    });
    Some(ArtificialLimits::new(limits.collect()))
}

/// Both ends at `share` of the way from `theta` to the ends of `arc`.
fn limit_within(arc: Option<Arc16>, theta: u16, share: f64) -> JointLimit {
    let at = angle(theta);
    let Some(arc) = arc else {
        return JointLimit::new(at, at);
    };
    if arc.is_full() {
        return JointLimit::FREE;
    }
    let below = theta.wrapping_sub(arc.start);
    let way = |steps: u16| share * f64::from(steps) * STEP;
    JointLimit::new(at - way(below), at + way(arc.width - below))
}
