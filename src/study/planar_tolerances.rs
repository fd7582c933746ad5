//! What manufacturing tolerances of a planar robot's links and limits cost.

use super::planar_arm::PlanarStudy;
use crate::report::{DesignParameter, ParameterSensitivity, ParameterSensitivityFigure};
use crate::workspace::{ArtificialLimits, Estimate, JointLimit};
use rayon::prelude::*;
use serde_json::{Value, json};

/// Tolerance of lengths as a share of their sum, and of limits in degrees.
const TOLERANCE: f64 = 1e-3;
/// See [`TOLERANCE`].
const TOLERANCE_DEG: f64 = 0.5;

/// Changes of S_F / S_0max where single numbers are off.
pub(super) struct PlanarTolerances {
    /// Metres.
    length: f64,
    changes: Vec<Change>,
}

/// What is off; links and joints from 1.
#[derive(Clone, Copy)]
enum Off {
    Length(usize),
    Lower(usize),
    Upper(usize),
}

/// Changes when one number is too small and too large by its tolerance.
struct Change {
    what: Off,
    change: [Estimate; 2],
}

impl PlanarTolerances {
    /// Every length and every end of limits off, one at a time.
    pub fn new(arm: &PlanarStudy, limits: &ArtificialLimits) -> PlanarTolerances {
        let length = TOLERANCE * arm.lengths.iter().sum::<f64>();
        let mut all: Vec<Off> = (1..=arm.lengths.len()).map(Off::Length).collect();
        for (joint, limit) in (1..).zip(limits.joints()) {
            if !limit.is_full() {
                all.extend([Off::Lower(joint), Off::Upper(joint)]);
            }
        }
        let base = share(arm, limits);
        let change = |what: Off| {
            let tolerance = match what {
                Off::Length(_) => length,
                Off::Lower(_) | Off::Upper(_) => TOLERANCE_DEG.to_radians(),
            };
            let change = [-tolerance, tolerance].map(|by| {
                let built = what.built(arm, limits, by);
                Estimate {
                    value: built.value - base.value,
                    error: built.error.hypot(base.error),
                }
            });
            Change { what, change }
        };
        PlanarTolerances {
            length,
            changes: all.into_par_iter().map(change).collect(),
        }
    }

    /// The changes as a figure.
    pub fn figure(&self, title: String) -> ParameterSensitivityFigure {
        let parameter = |change: &Change| ParameterSensitivity {
            parameter: match change.what {
                Off::Length(link) => DesignParameter::Link(link),
                Off::Lower(joint) => DesignParameter::LowerLimit(joint),
                Off::Upper(joint) => DesignParameter::UpperLimit(joint),
            },
            change: change.change.map(|change| 100.0 * change.value),
            error: change.change.map(|change| 100.0 * change.error),
        };
        ParameterSensitivityFigure {
            score_label: "S_F / S₀ₘₐₓ".into(),
            tolerance: format!(
                "lengths ±{} mm, angles ±{TOLERANCE_DEG}°",
                (1e6 * self.length).round() / 1e3
            ),
            parameters: self.changes.iter().map(parameter).collect(),
            title,
        }
    }

    /// The changes as `result.json` has them.
    pub fn to_json(&self) -> Value {
        let number = |e: &Estimate| json!({ "value": e.value, "error": e.error });
        let change = |change: &Change| {
            let [less, more] = change.change.each_ref().map(number);
            let (name, key, tolerance) = match change.what {
                Off::Length(link) => (format!("l_{link}"), "tolerance", self.length),
                Off::Lower(joint) => (format!("lower_{joint}"), "tolerance_deg", TOLERANCE_DEG),
                Off::Upper(joint) => (format!("upper_{joint}"), "tolerance_deg", TOLERANCE_DEG),
            };
            json!({ "parameter": name, key: tolerance, "less": less, "more": more })
        };
        self.changes.iter().map(change).collect()
    }
}

impl Off {
    /// S_F / S_0max of the arm as built.
    fn built(self, arm: &PlanarStudy, limits: &ArtificialLimits, by: f64) -> Estimate {
        match self {
            Off::Length(link) => {
                let mut lengths = arm.lengths.clone();
                lengths[link - 1] = (lengths[link - 1] + by).max(0.0);
                share(&arm.with_lengths(lengths), limits)
            }
            Off::Lower(joint) => share(arm, &with_end(limits, joint, [by, 0.0])),
            Off::Upper(joint) => share(arm, &with_end(limits, joint, [0.0, by])),
        }
    }
}

/// S_F / S_0max with the estimator's error.
fn share(arm: &PlanarStudy, limits: &ArtificialLimits) -> Estimate {
    let sizes = arm.sizes(limits);
    Estimate {
        value: sizes.normalised(),
        error: sizes.fault_tolerant.error / sizes.unrestricted.value.max(f64::MIN_POSITIVE),
    }
}

/// `limits` with the ends of one joint's moved; widths stay at least 0.
fn with_end(limits: &ArtificialLimits, joint: usize, [low, high]: [f64; 2]) -> ArtificialLimits {
    let mut joints = limits.joints().to_vec();
    let own = joints[joint - 1];
    let lower = (own.lower + low).min(own.upper);
    joints[joint - 1] = JointLimit::new(lower, (own.upper + high).max(lower));
    ArtificialLimits::new(joints)
}
