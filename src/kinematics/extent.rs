//! How far a robot really reaches, seen from joint 1.

use super::fixed::{fixed_transforms, joint_motion};
use super::posture::spread;
use crate::design::{JointKind, Robot};
use nalgebra::{Isometry3, Vector3};
use std::f64::consts::TAU;

/// The extent of the tool's positions about joint 1, in the frame of joint 1 at joint variable 0
/// (its z axis is the joint's axis). Metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Largest distance from joint 1's axis.
    pub radius: f64,
    /// Least height along the axis.
    pub lower: f64,
    /// Largest height along the axis.
    pub upper: f64,
    /// Largest distance from the origin of joint 1's frame, which lies on the axis.
    pub reach: f64,
}

/// How hard an extent is searched.
#[derive(Clone, Copy)]
struct Care {
    /// Starting postures. The arms of the papers have a handful of local maxima.
    starts: usize,
    /// Relative gain of a sweep below which a start has converged; far below the accuracy
    /// promised, because gains of a slow ascent add up.
    gain: f64,
}

const THOROUGH: Care = Care {
    starts: 96,
    gain: 1e-13,
};

const ROUGH: Care = Care {
    starts: 24,
    gain: 1e-8,
};

/// Sweeps over all joints after which a start ends at the latest.
const MAX_SWEEPS: usize = 2000;

/// The extent of the robot's workspace, accurate to about 1e-9 of the reach.
///
/// Revolute joints turn freely unless physical limits keep them from a full turn; joint 1 always
/// does if it is revolute, which moves none of the four numbers. `None` if a prismatic joint has
/// no physical limits.
pub fn workspace_extent(robot: &Robot) -> Option<Extent> {
    extent(Arm::new(robot, THOROUGH)?)
}

/// The same for a robot that is looked at once among thousands: accurate to about 1e-4 of the
/// reach, several times faster, and a distant maximum may be overlooked in rare robots.
pub fn rough_extent(robot: &Robot) -> Option<Extent> {
    extent(Arm::new(robot, ROUGH)?)
}

fn extent(arm: Arm) -> Option<Extent> {
    let upper = arm.maximum(Aim::Along(Vector3::z()));
    // The sum makes −0 a 0.
    let lower = 0.0 - arm.maximum(Aim::Along(-Vector3::z()));
    let reach = arm.maximum(Aim::Away).max(0.0).sqrt();
    // A turn about joint 1's axis brings the farthest point above the x axis.
    let radius = arm.turning().maximum(Aim::Along(Vector3::x()));
    Some(Extent {
        radius,
        lower,
        upper,
        reach,
    })
}

/// The reach alone, as rough as [`rough_extent`].
pub fn rough_reach(robot: &Robot) -> Option<f64> {
    Some(Arm::new(robot, ROUGH)?.maximum(Aim::Away).max(0.0).sqrt())
}

/// What is made as large as possible.
#[derive(Clone, Copy)]
enum Aim {
    /// The component of the position in a direction.
    Along(Vector3<f64>),
    /// The square of the distance from the origin.
    Away,
}

impl Aim {
    fn value(self, point: &Vector3<f64>) -> f64 {
        match self {
            Aim::Along(direction) => direction.dot(point),
            Aim::Away => point.norm_squared(),
        }
    }
}

/// One joint with what follows it.
struct Motion {
    kind: JointKind,
    /// From the frame that the joint moves to the next joint's.
    link: Isometry3<f64>,
    /// Range of the variable; `None` for a joint that turns freely.
    range: Option<[f64; 2]>,
}

struct Arm {
    joints: Vec<Motion>,
    care: Care,
}

impl Arm {
    fn new(robot: &Robot, care: Care) -> Option<Arm> {
        let fixed = fixed_transforms(robot);
        let mut joints = Vec::with_capacity(robot.joints());
        for (index, link) in fixed.iter().skip(1).enumerate() {
            let kind = robot.joint_kind(index);
            let range = match (kind, &robot.physical_limits) {
                (JointKind::Prismatic, None) => return None,
                (JointKind::Revolute, None) => None,
                (_, Some(limits)) => Some([limits.lower[index], limits.upper[index]]),
            };
            joints.push(Motion {
                kind,
                link: *link,
                range: range.filter(|r| match kind {
                    JointKind::Revolute => index > 0 && r[1] - r[0] < TAU,
                    JointKind::Prismatic => true,
                }),
            });
        }
        let is_finite = |m: &Motion| m.range.is_none_or(|r| r.iter().all(|v| v.is_finite()));
        joints.iter().all(is_finite).then_some(Arm { joints, care })
    }

    /// The same arm on a base that turns freely about joint 1's axis.
    fn turning(mut self) -> Arm {
        let turn = Motion {
            kind: JointKind::Revolute,
            link: Isometry3::identity(),
            range: None,
        };
        self.joints.insert(0, turn);
        self
    }

    /// The largest value over all starts.
    fn maximum(&self, aim: Aim) -> f64 {
        let values = (0..self.care.starts).map(|start| self.ascend(aim, self.start(start)));
        values.fold(f64::NEG_INFINITY, f64::max)
    }

    fn start(&self, number: usize) -> Vec<f64> {
        let full = |joint: &Motion| joint.range.unwrap_or([0.0, TAU]);
        let ranges: Vec<[f64; 2]> = self.joints.iter().map(full).collect();
        spread(number, &ranges)
    }

    /// Coordinate ascent: one joint at a time goes to where it is best, in closed form.
    fn ascend(&self, aim: Aim, mut theta: Vec<f64>) -> f64 {
        let mut best = f64::NEG_INFINITY;
        for _ in 0..MAX_SWEEPS {
            let value = self.sweep(aim, &mut theta);
            let scale = value.abs().max(best.abs());
            if best.is_finite() && value - best <= self.care.gain * scale {
                return value.max(best);
            }
            best = value;
        }
        best
    }

    /// Moves every joint once, from the last to the first, and returns the value reached.
    fn sweep(&self, aim: Aim, theta: &mut [f64]) -> f64 {
        // before[k]: the frame in which joint k moves, which only earlier joints change.
        let mut before = Vec::with_capacity(self.joints.len());
        let mut frame = Isometry3::identity();
        for (joint, variable) in self.joints.iter().zip(theta.iter()) {
            before.push(frame);
            frame = frame * joint_motion(joint.kind, *variable) * joint.link;
        }
        let mut point = Vector3::zeros();
        for (k, joint) in self.joints.iter().enumerate().rev() {
            point = joint.link.rotation * point + joint.link.translation.vector;
            theta[k] = joint.best(aim, &before[k], &point, theta[k]);
            let moved = joint_motion(joint.kind, theta[k]);
            point = moved.rotation * point + moved.translation.vector;
        }
        aim.value(&point)
    }
}

impl Motion {
    /// The variable at which the tool, at `point` in the frame that the joint moves, is best.
    ///
    /// Along a direction and squared, the distance is a + b cos θ + c sin θ for a turn, and convex
    /// for a slide, so that an end is best.
    fn best(&self, aim: Aim, before: &Isometry3<f64>, point: &Vector3<f64>, now: f64) -> f64 {
        let value = |variable: f64| {
            let moved = joint_motion(self.kind, variable);
            let local = moved.rotation * point + moved.translation.vector;
            aim.value(&(before.rotation * local + before.translation.vector))
        };
        let [low, high] = match (self.kind, self.range) {
            (JointKind::Revolute, None) => [f64::NEG_INFINITY, f64::INFINITY],
            (_, range) => range.unwrap_or([now, now]),
        };
        let ends = [low, high].into_iter().filter(|end| end.is_finite());
        let mut best = (value(now), now);
        let mut consider = |variable: f64| {
            let candidate = (value(variable), variable);
            if candidate.0 > best.0 {
                best = candidate;
            }
        };
        ends.for_each(&mut consider);
        if self.kind == JointKind::Revolute {
            let peak = peak(aim, before, point);
            // The turn of the peak that comes first in the range, if any does.
            let inside = match low.is_finite() {
                true => low + (peak - low).rem_euclid(TAU),
                false => peak,
            };
            if inside <= high {
                consider(inside);
            }
        }
        best.1
    }
}

/// The angle θ about z at which a + b cos θ + c sin θ is largest.
fn peak(aim: Aim, before: &Isometry3<f64>, point: &Vector3<f64>) -> f64 {
    // Both aims are, up to a constant, the component in one direction of the turned point.
    let direction = match aim {
        Aim::Along(direction) => direction,
        Aim::Away => before.translation.vector,
    };
    let local = before.rotation.inverse() * direction;
    let cosine = local.x * point.x + local.y * point.y;
    let sine = local.y * point.x - local.x * point.y;
    sine.atan2(cosine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    #[test]
    fn the_peak_is_where_it_is_best() {
        let before = Isometry3::new(Vector3::new(0.3, -0.4, 0.9), Vector3::new(0.4, 1.0, -2.0));
        let point = Vector3::new(0.7, -0.2, 0.1);
        for aim in [Aim::Away, Aim::Along(Vector3::new(0.6, 0.0, 0.8))] {
            let at = |angle: f64| {
                let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
                aim.value(&(before.rotation * (turn * point) + before.translation.vector))
            };
            let top = at(peak(aim, &before, &point));
            assert!((0..360).all(|k| at(f64::from(k).to_radians()) <= top));
        }
    }
}
