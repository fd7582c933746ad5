//! Parts of a pre-image along which J is singular throughout.
//!
//! Where two pairs of axes fall in line at once, such as θ₂ = θ₆ = 0 of the PA-10, the tool depends
//! on θ₁ + θ₃ and θ₅ + θ₇ alone: the pre-image holds a torus, on which J has lost rank at every
//! point. The stretched elbow leaves a curve of such points. Neither can be traced by a null vector
//! that is unique; joint ranges over them come from walks that push one joint at a time
//! [S1 eq. 6].

use super::stratum::{Arm, kernel};
use crate::angle::{AngleSet, Arc, wrap};
use nalgebra::{DVector, Isometry3};
use std::f64::consts::TAU;

/// A connected set of singular configurations of a location, of dimension one or more.
#[derive(Clone, Debug, PartialEq)]
pub struct SingularSurface {
    /// A configuration on it, n internal joint variables.
    pub theta: Vec<f64>,
    /// By how much J falls short of rank m on it.
    pub loss: usize,
    /// Its dimension.
    pub dimension: usize,
    /// Joints (from 0) that stand still on it.
    pub held: Vec<usize>,
    /// Angles of every joint on it: a lower bound, from walks.
    pub ranges: Vec<AngleSet>,
}

/// Step of a walk, radians.
const STEP: f64 = 0.2;
/// Step with which surfaces around a configuration are looked for, radians.
const PROBE: f64 = 0.2;
/// Most steps of a walk.
const MOST_STEPS: usize = 150;
/// Share of a joint's axis in the surface below which the joint has reached an end.
const LEVEL: f64 = 0.02;

/// A basis of the directions in which the tool, and the rank loss, stay; n × dimension.
fn directions(arm: &Arm, theta: &[f64], loss: usize) -> nalgebra::DMatrix<f64> {
    let singular = arm.tangent_space(theta, loss);
    let moved = arm.at(theta).jacobian() * &singular;
    let still = kernel_of(&moved);
    singular * still
}

/// Vectors that a matrix takes to 0, in columns, by an absolute measure.
fn kernel_of(matrix: &nalgebra::DMatrix<f64>) -> nalgebra::DMatrix<f64> {
    let columns = matrix.ncols();
    let mut gram = matrix.tr_mul(matrix);
    if columns == 0 {
        return gram;
    }
    // So that a matrix of zeros keeps every direction.
    let size = gram.amax();
    if size < 1e-12 {
        gram.fill(0.0);
        return nalgebra::DMatrix::identity(columns, columns);
    }
    kernel(&gram, (1e-12 / size).max(1e-10))
}

impl SingularSurface {
    /// The surface through `theta`, a singular configuration of the location `tool`; `None` if the
    /// configuration stands alone.
    pub(super) fn through(
        arm: &Arm,
        tool: &Isometry3<f64>,
        theta: &[f64],
        loss: usize,
        physical: &[Arc],
    ) -> Option<SingularSurface> {
        let basis = directions(arm, theta, loss);
        if basis.ncols() == 0 {
            return None;
        }
        // A direction that only the first order allows is none.
        let along: Vec<f64> = basis.column(0).iter().copied().collect();
        let moved: Vec<f64> = theta.iter().zip(&along).map(|(a, d)| a + 0.1 * d).collect();
        let settled = arm.settle(&moved, loss, Some(tool))?;
        let gone: f64 = (0..theta.len())
            .map(|k| (settled[k] - theta[k]) * along[k])
            .sum();
        if gone < 0.05 {
            return None;
        }
        let still = |joint: &usize| basis.row(*joint).norm() < 1e-4;
        let mut surface = SingularSurface {
            theta: theta.to_vec(),
            loss,
            dimension: basis.ncols(),
            held: (0..theta.len()).filter(still).collect(),
            ranges: Vec::new(),
        };
        surface.ranges = surface.walk(arm, tool, physical);
        Some(surface)
    }

    /// Surfaces of less rank loss that a configuration of rank loss `loss` lies on: looked for along
    /// directions of the null space, `known` ones left out.
    pub(super) fn beside(
        arm: &Arm,
        tool: &Isometry3<f64>,
        (theta, loss): (&[f64], usize),
        physical: &[Arc],
        known: &[SingularSurface],
    ) -> Vec<SingularSurface> {
        let null = arm.parts(theta).still(loss + arm.surplus());
        let size = null.ncols();
        let mut shares: Vec<DVector<f64>> = Vec::new();
        for i in 0..size {
            for k in i..size {
                let share = |row: usize| f64::from(u8::from(row == i || row == k));
                shares.push(DVector::from_fn(size, |row, _| share(row)).normalize());
            }
        }
        let mut found: Vec<SingularSurface> = Vec::new();
        for less in 1..loss {
            for share in &shares {
                let has = |s: &SingularSurface| s.loss == less && s.holds(theta);
                if known.iter().chain(&found).any(has) {
                    break;
                }
                let step = &null * share;
                let moved: Vec<f64> = theta
                    .iter()
                    .zip(step.iter())
                    .map(|(a, d)| a + PROBE * d)
                    .collect();
                let Some(settled) = arm.settle(&moved, less, Some(tool)) else {
                    continue;
                };
                let away = super::location::apart(&settled, theta);
                let lost = arm.parts(&settled).loss(super::SINGULAR);
                if lost == less && (0.3 * PROBE..3.0 * PROBE).contains(&away) {
                    found.extend(SingularSurface::through(
                        arm, tool, &settled, less, physical,
                    ));
                }
            }
        }
        found
    }

    /// Whether `theta` agrees with the surface in the joints that stand still on it.
    pub(super) fn holds(&self, theta: &[f64]) -> bool {
        let same = |&joint: &usize| wrap(theta[joint] - self.theta[joint]).abs() < 1e-5;
        !self.held.is_empty() && self.held.iter().all(same)
    }

    /// Whether a start may have stalled next to the surface at `theta`.
    pub(super) fn is_near(&self, theta: &[f64]) -> bool {
        let near = |&joint: &usize| wrap(theta[joint] - self.theta[joint]).abs() < 0.03;
        !self.held.is_empty() && self.held.iter().all(near)
    }

    fn walk(&self, arm: &Arm, tool: &Isometry3<f64>, physical: &[Arc]) -> Vec<AngleSet> {
        let n = self.theta.len();
        let mut arcs: Vec<Vec<Arc>> = vec![Vec::new(); n];
        let inside = |theta: &[f64]| {
            let mut pairs = theta.iter().zip(physical);
            pairs.all(|(&angle, arc)| arc.contains_within(angle, 1e-9))
        };
        if !inside(&self.theta) {
            return vec![AngleSet::empty(); n];
        }
        for joint in (0..n).filter(|joint| !self.held.contains(joint)) {
            for sense in [1.0, -1.0] {
                let mut theta = self.theta.clone();
                let mut spans: Vec<[f64; 2]> = theta.iter().map(|&a| [a, a]).collect();
                let mut heading: Option<Vec<f64>> = None;
                for _ in 0..MOST_STEPS {
                    let pushed = self.pushed(arm, tool, &theta, joint, sense);
                    let next = pushed.or_else(|| {
                        // Across a point of lower rank, where the surface's tangent is not known.
                        let ahead = heading.as_ref()?;
                        self.stepped(arm, tool, &theta, ahead, [joint as f64, sense])
                    });
                    let Some(next) = next else {
                        break;
                    };
                    heading = Some(
                        next.iter()
                            .zip(&theta)
                            .map(|(b, a)| b - a)
                            .collect::<Vec<_>>(),
                    );
                    if !inside(&next) {
                        break;
                    }
                    for (span, &value) in spans.iter_mut().zip(&next) {
                        *span = [span[0].min(value), span[1].max(value)];
                    }
                    theta = next;
                    if (theta[joint] - self.theta[joint]).abs() > TAU {
                        break;
                    }
                }
                for (arcs, [low, high]) in arcs.iter_mut().zip(spans) {
                    arcs.push(Arc::from_interval(low, high));
                }
            }
        }
        arcs.into_iter().map(AngleSet::from_arcs).collect()
    }

    /// One step that moves `joint` up or down; `None` at an end.
    fn pushed(
        &self,
        arm: &Arm,
        tool: &Isometry3<f64>,
        theta: &[f64],
        joint: usize,
        sense: f64,
    ) -> Option<Vec<f64>> {
        let basis = directions(arm, theta, self.loss);
        let share = DVector::from_iterator(basis.ncols(), basis.row(joint).iter().copied());
        let push = &basis * share * sense;
        let norm = push.norm();
        if norm < LEVEL {
            return None;
        }
        let ahead: Vec<f64> = push.iter().copied().collect();
        self.stepped(arm, tool, theta, &ahead, [joint as f64, sense])
    }

    /// A step along `ahead` and back onto the surface, in which the joint `axis[0]` moves with the
    /// sign `axis[1]`.
    fn stepped(
        &self,
        arm: &Arm,
        tool: &Isometry3<f64>,
        theta: &[f64],
        ahead: &[f64],
        axis: [f64; 2],
    ) -> Option<Vec<f64>> {
        let (joint, sense) = (axis[0] as usize, axis[1]);
        let norm = ahead.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-12);
        let mut step = STEP;
        while step > 1e-3 {
            let guess: Vec<f64> = theta
                .iter()
                .zip(ahead)
                .map(|(a, d)| a + step * d / norm)
                .collect();
            if let Some(next) = arm.settle(&guess, self.loss, Some(tool))
                && sense * (next[joint] - theta[joint]) > 0.0
                && super::location::apart(&next, &guess) < 0.5 * step
            {
                return Some(next);
            }
            step *= 0.4;
        }
        None
    }
}
