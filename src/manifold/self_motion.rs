//! A self-motion manifold as results show it, and what is measured on it.

use super::curve::{Curve, CurveStatus};
use super::segment::{Segment, arc_length};
use crate::angle::{AngleSet, Arc};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A joint that moves less than this along a whole curve stands still, radians: above the error of
/// the cubic between vertices.
const STILL: f64 = 1e-4;

/// One connected component of the pre-image of a task point, for one degree of redundancy.
///
/// A smooth curve in joint space, known by vertices and unit tangents; between vertices it is the
/// cubic through both. Joint variables are internal ones (see
/// [`crate::kinematics::JointScale`]): radians for revolute joints.
#[derive(Clone, Debug, PartialEq)]
pub struct SelfMotionManifold {
    /// Number of joints n.
    pub joints: usize,
    /// How tracing ended.
    pub status: CurveStatus,
    /// Arc length, radians.
    pub length: f64,
    /// Full turns of every joint along the curve, with the sign of the cofactor orientation;
    /// zeros unless the curve is closed.
    pub winding: Vec<i32>,
    /// Vertices, n numbers each, unwrapped along the curve. The last vertex of a closed curve is
    /// the first one, turned by the winding.
    pub points: Vec<f64>,
    /// Unit tangents at the vertices, n numbers each.
    pub tangents: Vec<f64>,
    /// Vertices just behind singular configurations that the curve runs through.
    pub crossings: Vec<usize>,
    /// How many random starts landed on it.
    pub hits: usize,
}

/// A configuration on a manifold at which one joint's angle is stationary [S4 Fig. 2].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CriticalPoint {
    /// The joint, from 0.
    pub joint: usize,
    /// The configuration, unwrapped, n internal joint variables.
    pub theta: Vec<f64>,
    /// Whether the joint's angle is greatest there (else least), among its neighbours.
    pub is_maximum: bool,
}

impl SelfMotionManifold {
    pub(super) fn from_curve<const N: usize>(curve: &Curve<N>, hits: usize) -> SelfMotionManifold {
        SelfMotionManifold {
            joints: N,
            status: curve.status,
            length: curve.length,
            winding: curve.winding.to_vec(),
            points: curve.points.as_flattened().to_vec(),
            tangents: curve.tangents.as_flattened().to_vec(),
            crossings: curve.crossings.clone(),
            hits,
        }
    }

    /// The number of vertices.
    pub fn vertices(&self) -> usize {
        self.points.len() / self.joints
    }

    /// Vertex `index`.
    pub fn point(&self, index: usize) -> &[f64] {
        &self.points[index * self.joints..][..self.joints]
    }

    /// Unit tangent at vertex `index`.
    pub fn tangent(&self, index: usize) -> &[f64] {
        &self.tangents[index * self.joints..][..self.joints]
    }

    /// Arc length of the segment from vertex `index` to the next one, radians; they add up to
    /// `length`.
    pub fn segment_length(&self, index: usize) -> f64 {
        self.coordinate(index, 0).length
    }

    /// The cubic of coordinate `joint` alone, between vertices `index` and `index + 1`.
    fn coordinate(&self, index: usize, joint: usize) -> Segment<1> {
        // An isolated configuration has no second vertex.
        let next = (index + 1).min(self.vertices() - 1);
        let (a, b) = (self.point(index), self.point(next));
        let (s, t) = (self.tangent(index), self.tangent(next));
        let square = |pairs: [&[f64]; 2]| -> f64 {
            let both = pairs[0].iter().zip(pairs[1]);
            both.map(|(x, y)| (x - y) * (x - y)).sum()
        };
        Segment {
            start: [a[joint]],
            chord: [b[joint] - a[joint]],
            first: [s[joint]],
            last: [t[joint]],
            length: arc_length(square([a, b]), square([s, t])),
        }
    }

    /// The segment on which `theta` lies within `tolerance` radians (modulo full turns of revolute
    /// joints), with the parameter on it in [−0.03, 1.03].
    pub fn locate(&self, theta: &[f64], tolerance: f64) -> Option<(usize, f64)> {
        match self.joints {
            3 => self
                .curve::<3>()
                .locate(theta.try_into().ok()?, None, tolerance),
            4 => self
                .curve::<4>()
                .locate(theta.try_into().ok()?, None, tolerance),
            _ => self
                .curve::<7>()
                .locate(theta.try_into().ok()?, None, tolerance),
        }
    }

    fn curve<const N: usize>(&self) -> Curve<N> {
        let mut curve = Curve::new();
        for index in 0..self.vertices() {
            let [point, tangent] = [self.point(index), self.tangent(index)];
            curve.push(
                std::array::from_fn(|k| point[k]),
                std::array::from_fn(|k| tangent[k]),
            );
        }
        curve.measure();
        curve
    }

    /// Configuration on segment `index` at parameter `u` in [0, 1].
    pub fn at(&self, index: usize, u: f64) -> Vec<f64> {
        (0..self.joints)
            .map(|joint| self.coordinate(index, joint).coordinate(0, u))
            .collect()
    }

    /// Extrema of `joint` (from 0) along the curve: segment, parameter and whether it is a
    /// maximum.
    fn extrema(&self, joint: usize) -> Vec<(usize, f64, bool)> {
        let mut found = Vec::new();
        for index in 0..self.vertices().saturating_sub(1) {
            let segment = self.coordinate(index, joint);
            let rising = self.tangent(index)[joint];
            if rising * self.tangent(index + 1)[joint] > 0.0 {
                continue;
            }
            for (nth, u) in segment.extrema(0).into_iter().flatten().enumerate() {
                found.push((index, u, (rising > 0.0) == (nth == 0)));
            }
        }
        found
    }

    /// All critical points of `joint` (from 0); none if it stands still along the curve, like the
    /// elbow of an arm with spherical shoulder and wrist, where every extremum is round-off.
    pub fn critical_points(&self, joint: usize) -> Vec<CriticalPoint> {
        let [low, high] = self.span(joint);
        if high - low < STILL {
            return Vec::new();
        }
        let point = |(index, u, is_maximum): (usize, f64, bool)| CriticalPoint {
            joint,
            theta: self.at(index, u),
            is_maximum,
        };
        self.extrema(joint).into_iter().map(point).collect()
    }

    /// Least and greatest value of `joint` (from 0), unwrapped along the curve.
    pub fn span(&self, joint: usize) -> [f64; 2] {
        let vertices = (0..self.vertices()).map(|index| self.point(index)[joint]);
        let between = self
            .extrema(joint)
            .into_iter()
            .map(|(index, u, _)| self.coordinate(index, joint).coordinate(0, u));
        let start = [f64::INFINITY, f64::NEG_INFINITY];
        vertices.chain(between).fold(start, |[low, high], value| {
            [low.min(value), high.max(value)]
        })
    }

    /// The angles that `joint` (from 0) takes: the full circle if the curve winds or spans it,
    /// else one arc, because the curve is connected.
    pub fn joint_range(&self, joint: usize) -> Arc {
        let [low, high] = self.span(joint);
        if self.winding[joint] != 0 || high - low >= TAU {
            Arc::FULL
        } else {
            Arc::from_interval(low, high)
        }
    }
}

/// Per joint the union of ranges over manifolds: Θ of the task point.
pub(super) fn joint_ranges(joints: usize, manifolds: &[SelfMotionManifold]) -> Vec<AngleSet> {
    let union = |joint| AngleSet::from_arcs(manifolds.iter().map(|m| m.joint_range(joint)));
    (0..joints).map(union).collect()
}
