//! S_F over an atlas along every limit through an optimum.

use super::picture::{CURVE_POINTS, CURVE_RANGE};
use crate::objective::DesignSpace;
use crate::report::{LimitSide, Sensitivity, SensitivityCurve};
use crate::workspace::hybrid::{Atlas, Growth};
use crate::workspace::{ArtificialLimits, FailureSet};
use std::f64::consts::TAU;

/// S_F along every limit through `limits`, all others fixed. Where the search kept limits
/// symmetric they move so here.
///
/// `None` where S_F is not known for all widths at once: drawing would take as long as the search.
pub(super) fn sensitivity(
    atlas: &Atlas,
    space: &DesignSpace,
    limits: &ArtificialLimits,
    failures: &FailureSet,
    unit: &str,
) -> Option<Sensitivity> {
    let size = atlas.fault_tolerant_size(limits, failures);
    let curve = |joint: usize, side: LimitSide| {
        let own = limits.joints()[joint];
        let (growth, optimum) = match side {
            LimitSide::Lower => (Growth::Lower, own.lower),
            LimitSide::Upper => (Growth::Upper, own.upper),
            LimitSide::HalfWidth => (Growth::Both, 0.5 * own.width()),
        };
        let widths = widths(own.width(), if growth == Growth::Both { 2.0 } else { 1.0 });
        let scores = atlas.profile(limits, failures, joint, growth, &widths)?;
        let limit = |width: f64| match side {
            LimitSide::Lower => own.upper - width,
            LimitSide::Upper => own.lower + width,
            LimitSide::HalfWidth => 0.5 * width,
        };
        let values = widths.iter().map(|&width| limit(width)).zip(scores);
        let mut values: Vec<(f64, f64)> = values.collect();
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        Some(SensitivityCurve {
            joint: joint + 1,
            side,
            values,
            optimum: (optimum, size),
        })
    };
    let sides = |joint: usize| -> &[LimitSide] {
        match space.is_centred(joint) {
            true => &[LimitSide::HalfWidth],
            false => &[LimitSide::Lower, LimitSide::Upper],
        }
    };
    let all = (0..limits.joints().len())
        .flat_map(|joint| sides(joint).iter().map(move |&side| (joint, side)));
    Some(Sensitivity {
        score_label: "S_F".into(),
        unit: unit.into(),
        mark: "optimum".into(),
        curves: all
            .map(|(joint, side)| curve(joint, side))
            .collect::<Option<_>>()?,
    })
}

/// Widths around `own`, ascending; the limit moves by 1/`per_limit` of the width.
fn widths(own: f64, per_limit: f64) -> Vec<f64> {
    let reach = per_limit * CURVE_RANGE;
    let (from, to) = ((own - reach).max(0.0), (own + reach).min(TAU));
    let step = (to - from) / CURVE_POINTS as f64;
    let mut widths: Vec<f64> = (0..=CURVE_POINTS).map(|k| from + k as f64 * step).collect();
    widths.push(own);
    widths.sort_by(f64::total_cmp);
    widths.dedup();
    widths
}
