//! Ranges of joints over a pre-image of two or more dimensions, from curves on it.
//!
//! The range of a joint is the union of its ranges on the curves; every end is then walked to the
//! nearest extremum on the surface ([`super::ascent`]), which also closes the gaps that a grid of
//! slices leaves. Inside physical limits an extremum is either one of the whole surface or lies
//! on a wall of their box, where curves are traced as well.

use super::ascent::Ascent;
use super::source::CurveRef;
use crate::angle::{AngleSet, Arc};
use crate::kinematics::Goal;

/// Slack of physical limits at the end of a walk, radians.
const SLACK: f64 = 1e-9;

/// The range of one joint on a part of a curve, with the configurations at both ends.
#[derive(Clone, Debug)]
pub struct Extent {
    /// The joint, from 0.
    pub joint: usize,
    /// The angles that it takes.
    pub arc: Arc,
    /// The configuration at which it is least, internal radians.
    pub low: Vec<f64>,
    /// The one at which it is greatest.
    pub high: Vec<f64>,
}

/// Appends the range of every joint on a curve.
pub(super) fn measure(curve: &CurveRef<'_>, extents: &mut Vec<Extent>) {
    for joint in 0..curve.joints {
        let vertices = 0..curve.vertices();
        let value = |index: &usize| curve.point(*index)[joint];
        let low = vertices
            .clone()
            .min_by(|a, b| value(a).total_cmp(&value(b)));
        let high = vertices.max_by(|a, b| value(a).total_cmp(&value(b)));
        let (Some(low), Some(high)) = (low, high) else {
            continue;
        };
        extents.push(Extent {
            joint,
            arc: curve.range(joint),
            low: curve.point(low).to_vec(),
            high: curve.point(high).to_vec(),
        });
    }
}

/// Θ of `joint` over the surface that the curves of `extents` lie on.
///
/// `gap` is the distance between slices along the joint, 0 if it is not cut; `bounds` the physical
/// limits of every joint, of which those of joint 1 do not count.
pub(super) fn range(
    extents: &[Extent],
    joint: usize,
    gap: f64,
    bounds: &[Arc],
    (ascent, goal): (&Ascent, &Goal<f64>),
) -> AngleSet {
    let own = || extents.iter().filter(|extent| extent.joint == joint);
    let coarse = bridged(&AngleSet::from_arcs(own().map(|extent| extent.arc)), gap);
    if coarse.is_full() {
        return coarse;
    }
    let is_allowed = |point: &[f64]| {
        let mut pairs = point.iter().zip(bounds).skip(1);
        pairs.all(|(&angle, bound)| bound.contains_within(angle, SLACK))
    };
    let gain = |extent: &Extent, sign: f64| {
        let start = if sign > 0.0 {
            &extent.high
        } else {
            &extent.low
        };
        match ascent.extremum(goal, start, joint, sign) {
            Some(end) if is_allowed(&end) => (sign * (end[joint] - start[joint])).max(0.0),
            _ => 0.0,
        }
    };
    let refined = coarse.arcs().iter().map(|arc| {
        let reach = |sign: f64| {
            let end = |arc: &Arc| if sign > 0.0 { arc.end() } else { arc.start() };
            let near =
                |extent: &&Extent| Arc::point(end(arc)).contains_within(end(&extent.arc), 1e-9);
            let gains = own().filter(near).take(4).map(|extent| gain(extent, sign));
            gains.fold(0.0, f64::max)
        };
        let (below, above) = (reach(-1.0), reach(1.0));
        Arc::new(arc.start() - below, arc.width() + below + above)
    });
    AngleSet::from_arcs(refined)
}

/// The set with gaps of at most `gap` closed.
fn bridged(set: &AngleSet, gap: f64) -> AngleSet {
    let wide = |arc: &Arc| Arc::new(arc.start() - 0.5 * gap, arc.width() + gap);
    if gap == 0.0 || set.arcs().len() < 2 {
        return set.clone();
    }
    let closed = AngleSet::from_arcs(set.arcs().iter().map(wide));
    if closed.is_full() {
        return closed;
    }
    let narrow = |arc: &Arc| Arc::new(arc.start() + 0.5 * gap, arc.width() - gap);
    AngleSet::from_arcs(closed.arcs().iter().map(narrow))
}
