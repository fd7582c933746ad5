//! Physical limits of joint 1, the only ones that break the symmetry about its axis.
//!
//! Turning a task point by β turns θ₁ along, so which part of the pre-image the robot can use
//! depends on β. With P₁ the limits and T_j(a) the θ₁ values at which joint j holds the angle a,
//! joint j may lock at a exactly if (T_j(a) + β) meets P₁; so β is lost if T_j(a) + β lies in the
//! gap outside P₁ for some a in A_j.

use super::block::{BlockView, PoseRecord};
use super::turn16::{Arc16, STEP, quantise};
use crate::angle::{AngleSet, Arc};

/// Angles at which a lock is examined lie at most this far apart, radians.
const LOCK_STEP: f64 = 0.02;

/// An edge along which the joint stands still is examined at points this close, radians.
const LONGEST_TURN: f64 = 0.2;

/// Rotation angles at which joint `joint` (from 0) may lock anywhere in `limit`.
///
/// `gap` is the complement of P₁, and `slab` half the distance between slices along the joint.
pub(super) fn survives_any_lock(
    view: &BlockView,
    pose: &PoseRecord,
    joint: usize,
    limit: Arc16,
    gap: &Arc,
    slab: f64,
) -> AngleSet {
    let arc = limit.arc();
    let locks = (arc.width() / LOCK_STEP).ceil().max(1.0) as usize;
    let mut lost = AngleSet::empty();
    for k in 0..=locks {
        let angle = arc.start() + arc.width() * k as f64 / locks as f64;
        lost = lost.union(&lost_at(view, pose, joint, quantise(angle), gap, slab));
        if lost.is_full() {
            break;
        }
    }
    lost.complement()
}

/// Rotation angles at which a lock at `angle` leaves joint 1 nowhere to go.
fn lost_at(
    view: &BlockView,
    pose: &PoseRecord,
    joint: usize,
    angle: u16,
    gap: &Arc,
    slab: f64,
) -> AngleSet {
    // { β : t + β in the gap for every t found so far }.
    let mut lost = AngleSet::full();
    let mut none = true;
    let mut add = |theta: f64| {
        none = false;
        lost = lost.intersection(&AngleSet::from(gap.rotated(-theta)));
        !lost.is_empty()
    };
    let reach = (slab / STEP).round() as i32;
    for piece in view.pieces(pose) {
        let mut vertices = piece.chunks_exact(view.joints);
        let Some(mut from) = vertices.next() else {
            continue;
        };
        for to in vertices {
            let before = i32::from(from[joint].wrapping_sub(angle) as i16);
            let step = i32::from(to[joint].wrapping_sub(from[joint]) as i16);
            let turn = f64::from(to[0].wrapping_sub(from[0]) as i16);
            let theta = |u: f64| (f64::from(from[0]) + u * turn) * STEP;
            let goes_on = if step == 0 {
                let parts = (turn.abs() * STEP / LONGEST_TURN).ceil().max(1.0);
                before.abs() > reach || (0..=parts as usize).all(|k| add(theta(k as f64 / parts)))
            } else if before.signum() * (before + step).signum() <= 0 && before.abs() <= step.abs()
            {
                add(theta(-f64::from(before) / f64::from(step)))
            } else {
                true
            };
            if !goes_on {
                return lost;
            }
            from = to;
        }
    }
    // A ⊂ Θ says that the angle is taken, be it within rounding of an end or between slices.
    if none { AngleSet::empty() } else { lost }
}
