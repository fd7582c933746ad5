//! Design vectors: artificial limits and, optionally, link lengths as points of a box.
//!
//! Each joint's limits are searched by their middle (on the circle) and their width. Turning the
//! workspace about joint 1 changes no size, so joint 1 is searched by its width alone, with
//! a̲₁ = −ā₁ [S4 §IV]; for pose tasks the same holds for joint n.

use super::space::{SearchSpace, Variable};
use crate::design::{JointKind, Robot, TaskSpace};
use crate::workspace::hybrid::Growth;
use crate::workspace::{ArtificialLimits, JointLimit};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Share of random limits that are free or as narrow as allowed.
const END_BIAS: f64 = 0.3;

/// A box before it is laid out.
const EMPTY: SearchSpace = SearchSpace {
    variables: Vec::new(),
    directions: Vec::new(),
    blocks: Vec::new(),
};

/// What a point of the box stands for.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Artificial limits of every joint.
    pub limits: ArtificialLimits,
    /// Link lengths, metres; none where they are not searched and the score knows them.
    pub lengths: Vec<f64>,
}

/// A direction along which only one joint's limits change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleLimit {
    /// The joint, from 0.
    pub joint: usize,
    /// The variable that holds its width.
    pub width_variable: usize,
    /// Which end moves.
    pub growth: Growth,
    /// Change of the width per unit along the direction.
    pub per_t: f64,
}

/// How limits and link lengths map to a box.
#[derive(Clone, Debug)]
pub struct DesignSpace {
    lengths: Vec<f64>,
    /// Whether joint k's middle is searched.
    centred: Vec<bool>,
    /// Whether joint k slides: its internal variable runs from −π/2 to π/2, and does not wrap.
    slides: Vec<bool>,
    link_bounds: Option<Vec<[f64; 2]>>,
    space: SearchSpace,
}

impl DesignSpace {
    /// The box of limits of an arm with the given link lengths (metres).
    ///
    /// `min_width` (radians) is the least width of any joint's limits. `last_is_symmetric` tells
    /// that the score does not depend on the middle of joint n's limits. With `link_bounds`
    /// (metres, [shortest, longest] per link) the lengths are searched too, at fixed sum.
    pub fn new(
        lengths: &[f64],
        min_width: f64,
        last_is_symmetric: bool,
        link_bounds: Option<Vec<[f64; 2]>>,
    ) -> DesignSpace {
        let n = lengths.len();
        let centred = (0..n)
            .map(|k| k == 0 || (last_is_symmetric && k + 1 == n))
            .collect();
        let mut design = DesignSpace {
            lengths: lengths.to_vec(),
            centred,
            slides: vec![false; n],
            link_bounds,
            space: EMPTY,
        };
        design.lay_out(min_width);
        design
    }

    /// The box of limits of any robot, in internal joint variables.
    ///
    /// `min_width` (radians) is the least width of any revolute joint's limits. Where turning
    /// joint 1, or the last joint of a pose task, changes no size, limits are kept symmetric: the
    /// volume of poses is the same after any motion from the left or from the right.
    pub fn of_robot(robot: &Robot, task: TaskSpace, min_width: f64) -> DesignSpace {
        let n = robot.joints();
        let slides = |k: usize| robot.joint_kind(k) == JointKind::Prismatic;
        let free = |k: usize| {
            let limits = robot.physical_limits.as_ref();
            !slides(k) && limits.is_none_or(|l| l.upper[k] - l.lower[k] >= TAU - 1e-9)
        };
        let is_pose = matches!(task, TaskSpace::PlanarPose | TaskSpace::SpatialPose);
        let mut design = DesignSpace {
            lengths: Vec::new(),
            centred: (0..n)
                .map(|k| free(k) && (k == 0 || is_pose && k + 1 == n))
                .collect(),
            slides: (0..n).map(slides).collect(),
            link_bounds: None,
            space: EMPTY,
        };
        design.lay_out(min_width);
        design
    }

    /// Whether the limits of `joint` (from 0) stay symmetric about zero.
    pub fn is_centred(&self, joint: usize) -> bool {
        self.centred[joint]
    }

    /// The box.
    pub fn space(&self) -> &SearchSpace {
        &self.space
    }

    /// What changes along `direction`, if it is one joint's lower limit, upper limit or width.
    pub fn single_limit(&self, direction: &[f64]) -> Option<SingleLimit> {
        let moved = |k: &usize| direction[*k] != 0.0;
        let mut w = 0;
        for (joint, &centred) in self.centred.iter().enumerate() {
            let count = if centred { 1 } else { 2 };
            let own = w..w + count;
            if own.clone().any(|k| moved(&k)) {
                let alone = (0..direction.len()).filter(|k| !own.contains(k));
                let centre = if centred { 0.0 } else { direction[w + 1] };
                let per_t = direction[w];
                let growth = if centre == 0.0 {
                    Growth::Both
                } else if centre == -0.5 * per_t {
                    Growth::Lower
                } else if centre == 0.5 * per_t {
                    Growth::Upper
                } else {
                    return None;
                };
                let is_single = alone.filter(moved).count() == 0 && per_t != 0.0;
                return is_single.then_some(SingleLimit {
                    joint,
                    width_variable: w,
                    growth,
                    per_t,
                });
            }
            w += count;
        }
        None
    }

    fn lay_out(&mut self, min_width: f64) {
        let width = Variable {
            lower: min_width,
            upper: TAU,
            periodic: false,
            end_bias: END_BIAS,
        };
        let middle = Variable {
            lower: -PI,
            upper: PI,
            periodic: true,
            end_bias: 0.0,
        };
        let mut steps: Vec<Vec<(usize, f64)>> = Vec::new();
        for (&centred, &slides) in self.centred.iter().zip(&self.slides) {
            let w = self.space.variables.len();
            let (width, middle) = match slides {
                false => (width.clone(), middle.clone()),
                true => stroke(),
            };
            self.space.variables.push(width);
            if centred {
                self.space.blocks.push(vec![w]);
                steps.push(vec![(w, 1.0)]);
                continue;
            }
            let c = w + 1;
            self.space.variables.push(middle);
            self.space.blocks.push(vec![w, c]);
            steps.push(vec![(w, -1.0), (c, 0.5)]); // lower limit alone
            steps.push(vec![(w, 1.0), (c, 0.5)]); // upper limit alone
            steps.push(vec![(c, 1.0)]); // both limits shift
            steps.push(vec![(w, 1.0)]); // both limits part
        }
        self.lay_out_links(&mut steps);
        let n = self.space.dimension();
        self.space.directions = steps.iter().map(|sparse| dense(sparse, n)).collect();
    }

    /// Lengths of one link traded against another's: the sum stays.
    fn lay_out_links(&mut self, steps: &mut Vec<Vec<(usize, f64)>>) {
        let Some(bounds) = &self.link_bounds else {
            return;
        };
        let first = self.space.variables.len();
        for &[lower, upper] in bounds {
            self.space.variables.push(Variable {
                lower,
                upper,
                periodic: false,
                end_bias: 0.0,
            });
        }
        self.space
            .blocks
            .push((first..first + bounds.len()).collect());
        for a in 0..bounds.len() {
            for b in 0..a {
                steps.push(vec![(first + a, 1.0), (first + b, -1.0)]);
            }
        }
    }

    /// The design that a point stands for. Link lengths are brought to the fixed sum by one common
    /// shift within their bounds.
    pub fn design(&self, x: &[f64]) -> Design {
        let limits = ArtificialLimits::new(self.limits_of(x));
        let lengths = match &self.link_bounds {
            None => self.lengths.clone(),
            Some(bounds) => {
                let wanted = &x[x.len() - bounds.len()..];
                with_sum(wanted, bounds, self.lengths.iter().sum())
            }
        };
        Design { limits, lengths }
    }

    fn limits_of(&self, x: &[f64]) -> Vec<JointLimit> {
        let mut k = 0;
        let mut limits = Vec::with_capacity(self.centred.len());
        for &centred in &self.centred {
            let width = x[k];
            let centre = if centred { 0.0 } else { x[k + 1] };
            k += if centred { 1 } else { 2 };
            limits.push(if width >= TAU {
                JointLimit::FREE
            } else {
                JointLimit::around(centre, width)
            });
        }
        limits
    }

    /// The point of the box for given limits, with the arm's own link lengths.
    pub fn point(&self, limits: &ArtificialLimits) -> Vec<f64> {
        let mut x = Vec::with_capacity(self.space.dimension());
        for (limit, &centred) in limits.joints().iter().zip(&self.centred) {
            x.push(limit.width());
            if !centred {
                x.push(crate::angle::wrap(limit.centre()));
            }
        }
        if self.link_bounds.is_some() {
            x.extend_from_slice(&self.lengths);
        }
        self.space.confine(&mut x);
        x
    }
}

/// Width and middle of a prismatic joint's limits, whose stroke is half a turn.
fn stroke() -> (Variable, Variable) {
    let variable = |lower, upper, end_bias| Variable {
        lower,
        upper,
        periodic: false,
        end_bias,
    };
    (
        variable(0.0, PI, END_BIAS),
        variable(-FRAC_PI_2, FRAC_PI_2, 0.0),
    )
}

fn dense(sparse: &[(usize, f64)], n: usize) -> Vec<f64> {
    let mut direction = vec![0.0; n];
    for &(k, value) in sparse {
        direction[k] = value;
    }
    direction
}

/// Lengths nearest to `wanted` with the given sum: all shifted alike and stopped at their bounds.
fn with_sum(wanted: &[f64], bounds: &[[f64; 2]], sum: f64) -> Vec<f64> {
    let shifted = |shift: f64| -> Vec<f64> {
        let each = wanted.iter().zip(bounds);
        each.map(|(w, b)| (w + shift).clamp(b[0], b[1])).collect()
    };
    let off_by = |shift: f64| shifted(shift).iter().sum::<f64>() - sum;
    if off_by(0.0).abs() <= 1e-13 * sum {
        return shifted(0.0);
    }
    let (mut low, mut high) = (-sum, sum);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if off_by(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    shifted(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_survive_the_round_trip() {
        let design = DesignSpace::new(&[1.0, 1.0, 1.0], 0.0, false, None);
        let limits = ArtificialLimits::from_degrees(&[[-20.0, 20.0], [100.0, 260.0], [5.0, 5.0]]);
        let back = design.design(&design.point(&limits)).limits;
        for (a, b) in limits.joints().iter().zip(back.joints()) {
            assert!((a.width() - b.width()).abs() < 1e-12);
            assert!(crate::angle::wrap(a.centre() - b.centre()).abs() < 1e-12);
        }
        assert_eq!(design.space().dimension(), 5);
        assert_eq!(design.space().directions.len(), 9);
    }

    #[test]
    fn lengths_keep_their_sum_and_bounds() {
        let bounds = vec![[0.2, 2.0], [0.2, 0.9], [0.2, 2.0]];
        let design = DesignSpace::new(&[1.0, 0.8, 1.2], 0.0, false, Some(bounds));
        let mut x = design.point(&ArtificialLimits::free(3));
        let n = x.len();
        x[n - 3..].copy_from_slice(&[2.0, 0.9, 2.0]);
        let lengths = design.design(&x).lengths;
        assert!((lengths.iter().sum::<f64>() - 3.0).abs() < 1e-12);
        assert!(lengths.iter().all(|l| (0.2..=2.0).contains(l)) && lengths[1] <= 0.9);
    }
}
