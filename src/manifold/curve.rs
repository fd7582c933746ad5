//! One traced curve of a pre-image, as the fixed-size kernels see it.

use super::nearby::Blocks;
use super::segment::Segment;
use crate::angle::wrap;
use crate::kinematics::{Real, dot};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// How tracing a curve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CurveStatus {
    /// Back at its start, modulo full turns.
    Closed,
    /// Both ends lie where a prismatic joint leaves its stroke.
    Stroke,
    /// At least one end lies at a singular configuration that could not be crossed.
    Singular,
    /// The longest curve the settings allow was traced without closing.
    TooLong,
}

/// A polyline with tangents: vertices at most [`super::TraceSettings::max_step`] apart.
#[derive(Clone, Debug)]
pub(crate) struct Curve<const N: usize> {
    /// Vertices, internal joint variables, unwrapped along the curve.
    pub points: Vec<[f64; N]>,
    /// Unit tangents at the vertices (0 at an isolated singular configuration), in the direction of the cofactor field at the start.
    pub tangents: Vec<[f64; N]>,
    pub status: CurveStatus,
    /// Full turns of every joint along a closed curve.
    pub winding: [i32; N],
    /// Arc length, radians.
    pub length: f64,
    /// Singular configurations that were crossed: indices of the vertices behind them.
    pub crossings: Vec<usize>,
    /// Longest segment, radians.
    pub longest: f64,
    /// The vertices once more, for [`Curve::locate`].
    blocks: Blocks<N>,
}

impl<const N: usize> Curve<N> {
    pub fn new() -> Curve<N> {
        Curve {
            points: Vec::with_capacity(512),
            tangents: Vec::with_capacity(512),
            status: CurveStatus::TooLong,
            winding: [0; N],
            length: 0.0,
            crossings: Vec::new(),
            longest: 0.0,
            blocks: Blocks::default(),
        }
    }

    pub fn clear(&mut self) {
        self.points.clear();
        self.tangents.clear();
        self.crossings.clear();
        self.status = CurveStatus::TooLong;
        self.winding = [0; N];
        self.length = 0.0;
        self.longest = 0.0;
    }

    pub fn push(&mut self, point: [f64; N], tangent: [f64; N]) {
        self.points.push(point);
        self.tangents.push(tangent);
    }

    /// Whether the curve closed, or ended at a stroke, without a singular configuration.
    pub fn is_smooth(&self) -> bool {
        let ended = matches!(self.status, CurveStatus::Closed | CurveStatus::Stroke);
        ended && self.crossings.is_empty()
    }

    /// Number of segments.
    pub fn segments(&self) -> usize {
        self.points.len().saturating_sub(1)
    }

    pub fn segment(&self, index: usize) -> Segment<N> {
        Segment::new(
            &self.points[index],
            &self.points[index + 1],
            &self.tangents[index],
            &self.tangents[index + 1],
        )
    }

    /// Sums up lengths and, for a closed curve, the winding numbers, of the finished curve.
    pub fn measure(&mut self) {
        self.blocks.set(&self.points);
        self.length = 0.0;
        self.longest = 0.0;
        for index in 0..self.segments() {
            let length = self.segment(index).length;
            self.length += length;
            self.longest = self.longest.max(length);
        }
        if self.status == CurveStatus::Closed
            && let (Some(first), Some(last)) = (self.points.first(), self.points.last())
        {
            self.winding = std::array::from_fn(|k| ((last[k] - first[k]) / TAU).round() as i32);
        }
    }

    /// Turns the curve round.
    pub fn reverse(&mut self) {
        self.points.reverse();
        self.tangents.reverse();
        for tangent in &mut self.tangents {
            *tangent = tangent.map(|x| -x);
        }
        self.winding = self.winding.map(|w| -w);
        let last = self.points.len();
        self.crossings.reverse();
        for index in &mut self.crossings {
            *index = last - *index;
        }
    }

    /// The segment on which `point` (modulo full turns) lies within `tolerance`, with the
    /// parameter on it.
    ///
    /// Where two strands run past each other closer than that, `tangent`, the cofactor field at
    /// the point, tells them apart: neighbours are oriented oppositely. Pass `None` if it is not
    /// known; it is not looked at on curves through singular configurations, which change sign.
    pub fn locate(
        &self,
        point: &[f64; N],
        tangent: Option<&[f64; N]>,
        tolerance: f64,
    ) -> Option<(usize, f64)> {
        if let [only] = self.points.as_slice() {
            return (distance(only, point) < tolerance).then_some((0, 0.0));
        }
        let tangent = tangent.filter(|_| self.crossings.is_empty());
        // A point of a segment is no farther from the nearer end than half the segment.
        let near = 0.55 * self.longest + tolerance;
        let mut best: Option<(usize, f64, f64)> = None;
        let mut seen = None;
        for index in self.blocks.near(point, near) {
            let vertex = &self.points[index];
            let lifted: [f64; N] =
                std::array::from_fn(|k| vertex[k] + short_way(point[k] - vertex[k]));
            for segment in [index.wrapping_sub(1), index] {
                if segment >= self.segments() || seen == Some(segment) {
                    continue;
                }
                seen = Some(segment);
                if let Some((u, miss)) = self.segment(segment).project(&lifted)
                    && miss < tolerance
                    && best.is_none_or(|(_, _, least)| miss < least)
                    && tangent.is_none_or(|tangent| self.runs_along(segment, u, tangent))
                {
                    best = Some((segment, u, miss));
                }
            }
            if best.is_some_and(|(_, _, miss)| miss < 0.1 * tolerance) {
                break;
            }
        }
        best.map(|(segment, u, _)| (segment, u))
    }
}

impl<const N: usize> Curve<N> {
    fn runs_along(&self, segment: usize, u: f64, tangent: &[f64; N]) -> bool {
        let first = dot(&self.tangents[segment], tangent);
        let last = dot(&self.tangents[segment + 1], tangent);
        (1.0 - u) * first + u * last > 0.0
    }
}

/// The difference of two angles taken the short way, in [−π, π].
#[inline(always)]
pub(crate) fn short_way<T: Real>(difference: T) -> T {
    let round = T::constant(6_755_399_441_055_744.0);
    let turns = (difference * T::constant(1.0 / TAU) + round) - round;
    difference - turns * T::constant(TAU)
}

/// Distance modulo full turns.
pub(crate) fn distance<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let d: [f64; N] = std::array::from_fn(|k| short_way(a[k] - b[k]));
    dot(&d, &d).sqrt()
}

/// A configuration with every revolute joint in [−π, π).
pub(crate) fn wrapped<const N: usize>(point: &[f64; N]) -> [f64; N] {
    point.map(wrap)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_short_way_is_short() {
        for x in [-10.0, -3.2, -3.1, 0.0, 3.0, 3.2, 6.3, 100.0] {
            let d = short_way(x);
            assert!(d.abs() <= PI + 1e-12);
            assert!((wrap(d) - wrap(x)).abs() < 1e-12);
        }
    }
}
