//! Artificial joint limits and the joints prone to failure.

use crate::angle::{AngleSet, Arc, turn};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Artificial limits [a̲, ā] of one joint, radians, possibly written beyond ±π.
///
/// A width of zero holds the joint still (it may still fail, at that angle); a width of 2π is the
/// full circle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointLimit {
    /// Lower limit a̲, radians.
    pub lower: f64,
    /// Upper limit ā ≥ a̲, radians.
    pub upper: f64,
}

impl JointLimit {
    /// No restriction.
    pub const FREE: JointLimit = JointLimit {
        lower: -std::f64::consts::PI,
        upper: std::f64::consts::PI,
    };

    /// Limits from `lower` to `upper`, radians.
    pub fn new(lower: f64, upper: f64) -> JointLimit {
        debug_assert!(lower <= upper);
        JointLimit { lower, upper }
    }

    /// Limits of the given width around `centre`, radians.
    pub fn around(centre: f64, width: f64) -> JointLimit {
        JointLimit {
            lower: centre - 0.5 * width,
            upper: centre + 0.5 * width,
        }
    }

    /// Width in [0, 2π].
    pub fn width(&self) -> f64 {
        (self.upper - self.lower).clamp(0.0, TAU)
    }

    /// Middle of the interval, not wrapped.
    pub fn centre(&self) -> f64 {
        0.5 * (self.lower + self.upper)
    }

    /// Whether the limits leave the joint the full circle. Widths within 1e-12 rad of 2π count:
    /// 360° does not survive the conversion to radians and back to the last bit.
    pub fn is_full(&self) -> bool {
        self.upper - self.lower >= TAU - 1e-12
    }

    /// The allowed angles.
    pub fn arc(&self) -> Arc {
        if self.is_full() {
            Arc::FULL
        } else {
            Arc::from_interval(self.lower, self.upper)
        }
    }

    /// The same limits shifted by `angle`.
    pub fn shifted(&self, angle: f64) -> JointLimit {
        JointLimit {
            lower: self.lower + angle,
            upper: self.upper + angle,
        }
    }

    /// The limits with `margin` ≥ 0 radians added at both ends; the full circle once they span it.
    /// Without a margin they are the same to the last bit.
    pub fn enlarged(&self, margin: f64) -> JointLimit {
        let limit = JointLimit {
            lower: self.lower - margin,
            upper: self.upper + margin,
        };
        match margin > 0.0 {
            true if limit.is_full() => JointLimit::FREE,
            true => limit,
            false => *self,
        }
    }

    /// As [`JointLimit::enlarged`], but not past the ends of `physical`, where mechanical stops
    /// are, nor across the gap between them.
    pub(super) fn enlarged_within(&self, margin: f64, physical: &Arc) -> JointLimit {
        if physical.is_full() || margin <= 0.0 {
            return self.enlarged(margin);
        }
        let lead = turn(physical.start(), self.lower);
        // Round-off may put the lower limit just in front of the stop.
        let below = if lead > physical.width() { 0.0 } else { lead };
        let above = (physical.width() - below - self.width()).max(0.0);
        JointLimit {
            lower: self.lower - margin.min(below),
            upper: self.upper + margin.min(above),
        }
    }
}

/// Artificial limits A₁ × … × A_n of every joint, which hold before a failure and are released
/// after it [S4 §II.A].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArtificialLimits {
    joints: Vec<JointLimit>,
}

impl ArtificialLimits {
    /// Limits per joint, joint 1 first.
    pub fn new(joints: Vec<JointLimit>) -> ArtificialLimits {
        ArtificialLimits { joints }
    }

    /// Every joint free: the box of S_0max.
    pub fn free(joints: usize) -> ArtificialLimits {
        ArtificialLimits::new(vec![JointLimit::FREE; joints])
    }

    /// From limits in degrees.
    pub fn from_degrees(pairs: &[[f64; 2]]) -> ArtificialLimits {
        let joint = |p: &[f64; 2]| JointLimit::new(p[0].to_radians(), p[1].to_radians());
        ArtificialLimits::new(pairs.iter().map(joint).collect())
    }

    /// The limits cut to physical ones, joint by joint. Where two pieces are left, the longer one.
    pub fn within(&self, physical: &[Arc]) -> ArtificialLimits {
        let cut = |(limit, physical): (&JointLimit, &Arc)| {
            if physical.is_full() {
                return *limit;
            }
            let both = AngleSet::from(limit.arc()).intersection(&AngleSet::from(*physical));
            let longest = both
                .arcs()
                .iter()
                .reduce(|a, b| if b.width() > a.width() { b } else { a });
            match longest {
                Some(arc) => JointLimit::new(arc.start(), arc.end()),
                // Nothing is left: the joint stands at a physical limit.
                None => JointLimit::new(physical.start(), physical.start()),
            }
        };
        ArtificialLimits::new(self.joints.iter().zip(physical).map(cut).collect())
    }

    /// Limits of each joint, joint 1 first.
    pub fn joints(&self) -> &[JointLimit] {
        &self.joints
    }

    /// The box C′_A: the same limits with joint 1 released [S4 §III.B].
    pub fn with_joint_1_released(&self) -> ArtificialLimits {
        let mut released = self.clone();
        released.joints[0] = JointLimit::FREE;
        released
    }
}

/// The joints F that may lock, at most one at a time, and where: joint i inside its artificial
/// limits A_i, or up to a margin beyond them.
///
/// A joint is rarely stopped at once, nor are its limits kept to the last bit: tracking errors,
/// calibration and braking carry it past them. With a margin m, a task point belongs to W_i if it
/// stays reachable wherever within [a̲_i − m, ā_i + m] joint i locks; W₀ does not change. The margin
/// is an angle, of revolute joints: leave it 0 for a robot with prismatic joints that may lock,
/// whose internal variables are no angles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailureSet {
    prone: Vec<bool>,
    /// Radians in [0, π].
    #[serde(default)]
    margin: f64,
}

impl FailureSet {
    /// Any single joint of `joints` may fail.
    pub fn any(joints: usize) -> FailureSet {
        FailureSet {
            prone: vec![true; joints],
            margin: 0.0,
        }
    }

    /// Only the listed joints may fail; `numbers` count from 1 and lie in 1..=`joints`.
    pub fn of(joints: usize, numbers: &[usize]) -> FailureSet {
        let prone = (1..=joints).map(|j| numbers.contains(&j)).collect();
        FailureSet { prone, margin: 0.0 }
    }

    /// The same joints, which may come to rest up to `radians` beyond their artificial limits. With
    /// π a joint may lock anywhere; more is cut to that, and what is no positive number counts as 0.
    pub fn with_margin(self, radians: f64) -> FailureSet {
        FailureSet {
            margin: match radians > 0.0 {
                true => radians.min(PI),
                false => 0.0,
            },
            ..self
        }
    }

    /// How far beyond its artificial limits a joint may lock, radians.
    pub fn margin(&self) -> f64 {
        self.margin
    }

    /// Where a joint with artificial limits `limit` may lock: the limits enlarged by the margin.
    pub fn lock_range(&self, limit: JointLimit) -> JointLimit {
        limit.enlarged(self.margin)
    }

    /// Whether joint number `joint` (from 1) may fail.
    pub fn contains(&self, joint: usize) -> bool {
        self.prone[joint - 1]
    }

    /// The numbers (from 1) of the joints that may fail.
    pub fn numbers(&self) -> impl Iterator<Item = usize> + '_ {
        (1..=self.prone.len()).filter(|&j| self.contains(j))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_margin_enlarges_limits_up_to_the_full_circle() {
        let limit = JointLimit::new(0.1, 0.3);
        assert_eq!(limit.enlarged(0.0), limit);
        let wide = limit.enlarged(0.05);
        assert!((wide.lower - 0.05).abs() < 1e-15 && (wide.upper - 0.35).abs() < 1e-15);
        assert!(limit.enlarged(PI).is_full() && JointLimit::FREE.enlarged(0.2).is_full());
        assert!(!limit.enlarged(PI - 0.11).is_full());
        let held = JointLimit::new(2.0, 2.0);
        assert!((held.enlarged(0.05).width() - 0.1).abs() < 1e-15);
    }

    #[test]
    fn a_margin_ends_at_the_stops() {
        let stops = Arc::from_interval(-3.0, 3.0);
        let widths = |lower: f64, upper: f64| {
            let limit = JointLimit::new(lower, upper);
            let wide = limit.enlarged_within(0.5, &stops);
            [lower - wide.lower, wide.upper - upper]
        };
        let close = |found: [f64; 2], wanted: [f64; 2]| {
            let off = (found[0] - wanted[0]).abs() + (found[1] - wanted[1]).abs();
            assert!(off < 1e-12, "{found:?} {wanted:?}");
        };
        close(widths(-1.0, 1.0), [0.5, 0.5]);
        // Not across the gap, narrow though it is.
        close(widths(-2.8, 2.9), [0.2, 0.1]);
        close(widths(-3.0, 3.0), [0.0, 0.0]);
        close(widths(-2.8 + TAU, -1.0 + TAU), [0.2, 0.5]);
        let free = JointLimit::new(-1.0, 1.0).enlarged_within(0.5, &Arc::FULL);
        assert_eq!(free, JointLimit::new(-1.5, 1.5));
    }

    #[test]
    fn margins_are_angles_and_default_to_none() {
        let margin = |radians: f64| FailureSet::any(3).with_margin(radians).margin();
        assert_eq!(FailureSet::of(3, &[2]).margin(), 0.0);
        assert_eq!([margin(0.2), margin(4.0)], [0.2, PI]);
        assert_eq!([margin(-0.1), margin(f64::NAN)], [0.0, 0.0]);
        let old: FailureSet = serde_json::from_str("{\"prone\":[true,false]}").unwrap();
        assert_eq!(old, FailureSet::of(2, &[1]));
    }
}
