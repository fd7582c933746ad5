//! Random artificial limits from which surrogates learn.
//!
//! Uniform limits, as [S3] draws them, hardly ever have a large fault-tolerant workspace: of those
//! of the 3R (1,1,1) one in seventy reaches half of the largest S_F. Threshold walks are drawn
//! beside them: from uniform limits a random walk climbs to a random threshold τ of S_F and then
//! wanders above it.

use super::arm::SurrogateArm;
use crate::angle::wrap;
use crate::objective::Design;
use crate::workspace::{ArtificialLimits, JointLimit};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};

/// Thresholds are drawn up to this share of the largest known S_F.
const HIGHEST_THRESHOLD: f64 = 0.97;

/// Designs kept of one walk.
pub const KEPT: usize = 8;

/// Steps from one kept design to the next.
const STRIDE: usize = 6;

/// Steps after which a walk that has not reached its threshold takes what it has reached for it.
const PATIENCE: usize = 400;

/// Shares of the reach that a link may take are redrawn until they fit their bounds, this often.
const REDRAWS: usize = 1000;

/// Decimal exponents of a step, radians: 0.01 to 2.
const EXPONENTS: [f64; 2] = [-2.0, 0.3];

/// A design with its size.
#[derive(Clone, Debug, PartialEq)]
pub struct Sized {
    /// Limits and lengths.
    pub design: Design,
    /// S_F.
    pub size: f64,
}

/// Limits whose ends are two sorted uniform draws from [−π, π] for every joint, those of joints
/// that count by their width alone centred at 0 [S3 §IV].
pub fn uniform(arm: &SurrogateArm, generator: &mut ChaCha8Rng) -> Sized {
    let joint = |k: usize, generator: &mut ChaCha8Rng| {
        let ends = [(); 2].map(|()| generator.random_range(-PI..=PI));
        let [lower, upper] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        match arm.is_centred(k) {
            true => JointLimit::around(0.0, upper - lower),
            false => JointLimit::new(lower, upper),
        }
    };
    let limits = (0..arm.joints()).map(|k| joint(k, generator)).collect();
    let design = Design {
        limits: ArtificialLimits::new(limits),
        lengths: lengths(arm, generator),
    };
    measured(arm, design)
}

/// Lengths uniform among those within the bounds that have the arm's sum.
fn lengths(arm: &SurrogateArm, generator: &mut ChaCha8Rng) -> Vec<f64> {
    let Some(bounds) = &arm.link_bounds else {
        return arm.lengths.clone();
    };
    let total: f64 = arm.lengths.iter().sum();
    for _ in 0..REDRAWS {
        let mut drawn: Vec<f64> = bounds[1..]
            .iter()
            .map(|&[shortest, longest]| generator.random_range(shortest..=longest))
            .collect();
        let first = total - drawn.iter().sum::<f64>();
        if (bounds[0][0]..=bounds[0][1]).contains(&first) {
            drawn.insert(0, first);
            return drawn;
        }
    }
    arm.lengths.clone()
}

fn measured(arm: &SurrogateArm, design: Design) -> Sized {
    let size = arm.size(&design);
    Sized { design, size }
}

/// [`KEPT`] designs of one walk that climbs to a random share of `largest`, the largest known
/// S_F/S_0max, and stays above it.
pub fn threshold_walk(arm: &SurrogateArm, largest: f64, generator: &mut ChaCha8Rng) -> Vec<Sized> {
    let share = HIGHEST_THRESHOLD * largest * generator.random::<f64>();
    let mut here = uniform(arm, generator);
    let mut threshold = share * arm.unrestricted_size(&here.design.lengths);
    let mut kept = Vec::with_capacity(KEPT);
    let mut climbing = 0;
    let mut since = 0;
    while kept.len() < KEPT {
        step(arm, &mut here, threshold, generator);
        if here.size < threshold {
            climbing += 1;
            if climbing > PATIENCE {
                threshold = here.size;
            }
            continue;
        }
        if since % STRIDE == 0 {
            kept.push(here.clone());
        }
        since += 1;
    }
    kept
}

/// The largest S_F/S_0max that `steps` accepted or refused steps uphill from uniform limits find.
pub fn climb(arm: &SurrogateArm, steps: usize, generator: &mut ChaCha8Rng) -> f64 {
    let mut here = uniform(arm, generator);
    for _ in 0..steps {
        step(arm, &mut here, f64::INFINITY, generator);
    }
    here.size / arm.unrestricted_size(&here.design.lengths)
}

/// One step, taken unless it falls below both the threshold and the size so far.
fn step(arm: &SurrogateArm, here: &mut Sized, threshold: f64, generator: &mut ChaCha8Rng) {
    let next = measured(arm, moved(arm, &here.design, generator));
    if next.size >= here.size.min(threshold) {
        *here = next;
    }
}

/// The design with one joint's lower limit, upper limit or both moved.
fn moved(arm: &SurrogateArm, design: &Design, generator: &mut ChaCha8Rng) -> Design {
    let mut joints = design.limits.joints().to_vec();
    let k = generator.random_range(0..joints.len());
    let size = 10f64.powf(generator.random_range(EXPONENTS[0]..=EXPONENTS[1]));
    let by = if generator.random() { size } else { -size };
    let which = generator.random_range(0..3);
    let limit = joints[k];
    let [lower, upper] = match (arm.is_centred(k), which) {
        (true, _) => [limit.lower - 0.5 * by, limit.upper + 0.5 * by],
        (false, 0) => [limit.lower + by, limit.upper],
        (false, 1) => [limit.lower, limit.upper + by],
        (false, _) => [limit.lower + by, limit.upper + by],
    };
    let width = (upper - lower).clamp(0.0, TAU);
    let centre = match arm.is_centred(k) {
        true => 0.0,
        false => wrap(0.5 * (lower + upper)),
    };
    joints[k] = match width >= TAU {
        true => JointLimit::FREE,
        false => JointLimit::around(centre, width),
    };
    Design {
        limits: ArtificialLimits::new(joints),
        lengths: design.lengths.clone(),
    }
}
