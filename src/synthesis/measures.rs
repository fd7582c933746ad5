//! What a robot with its limits is worth, in numbers that do not depend on its size.

use crate::design::TaskSpace;
use crate::workspace::hybrid::Dexterity;
use crate::workspace::{Estimate, WorkspaceSizes};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use std::fmt;

/// What may be searched for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Merit {
    /// S_F / S_0max: the share of the workspace that survives any failure.
    Share,
    /// S_F over the size of the ball of the robot's reach with all orientations: unlike the share
    /// it cannot be raised by shrinking the workspace.
    BallShare,
    /// S_F / Lᵈ with L the sum of all lengths and d the dimension of space: workspace per metre
    /// of arm.
    SizePerLength,
    /// W₀ / S_0max: how much can be used before a failure.
    PreFailureShare,
    /// W_F / W₀: the probability that a pose in use survives.
    Survival,
    /// R / L: how straight the arm is; the inverse of the total length in reaches.
    Slenderness,
    /// Mean over W_F of the greatest 1/cond J that the limits allow: how far from singular.
    Condition,
    /// Mean over W_F of the greatest min_j |n_j| that the limits allow, n the unit null vector: how
    /// much is left when the worst joint locks.
    NullComponent,
    /// How far joints may overshoot their limits, radians, until a tenth of S_F is lost.
    Margin,
}

impl Merit {
    /// All of them, in the order of reports.
    pub const ALL: [Merit; 9] = [
        Merit::Share,
        Merit::BallShare,
        Merit::SizePerLength,
        Merit::PreFailureShare,
        Merit::Survival,
        Merit::Slenderness,
        Merit::Condition,
        Merit::NullComponent,
        Merit::Margin,
    ];

    /// The name used in files.
    pub fn name(self) -> &'static str {
        match self {
            Merit::Share => "share",
            Merit::BallShare => "ball-share",
            Merit::SizePerLength => "size-per-length",
            Merit::PreFailureShare => "pre-failure-share",
            Merit::Survival => "survival",
            Merit::Slenderness => "slenderness",
            Merit::Condition => "condition",
            Merit::NullComponent => "null-component",
            Merit::Margin => "margin",
        }
    }

    /// Whether it grows with W_F itself.
    pub fn rewards_size(self) -> bool {
        matches!(self, Merit::Share | Merit::BallShare | Merit::SizePerLength)
    }

    /// Whether it tells how W_F is, however small W_F may be: searched for alone it would find
    /// robots of which next to nothing survives.
    pub fn is_blind_to_size(self) -> bool {
        self.needs_configurations() || self == Merit::Margin
    }

    /// Whether it is measured along self-motion manifolds.
    pub fn needs_configurations(self) -> bool {
        matches!(self, Merit::Condition | Merit::NullComponent)
    }
}

impl fmt::Display for Merit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Every merit of a robot with its limits, from one set of samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measures {
    /// S_F / S_0max.
    pub share: Estimate,
    /// S_F over the ball of the reach.
    pub ball_share: Estimate,
    /// S_F / Lᵈ.
    pub size_per_length: Estimate,
    /// W₀ / S_0max.
    pub pre_failure_share: Estimate,
    /// W_F / W₀.
    pub survival: Estimate,
    /// S_0max over the ball of the reach.
    pub fill: Estimate,
    /// L / R.
    pub length: f64,
    /// How far from singular the robot is inside W_F; `None` if it was not asked for, if W_F is
    /// empty or with more than one degree of redundancy.
    pub dexterity: Option<Dexterity>,
    /// The overshoot that costs a tenth of S_F, radians; `None` if it was not asked for.
    pub margin: Option<Estimate>,
}

impl Measures {
    /// What the sizes of workspaces tell of a robot of total length `length` and reach `reach`, in
    /// metres.
    pub fn new(sizes: &WorkspaceSizes, length: f64, reach: f64, task: TaskSpace) -> Measures {
        let dimension = if task.is_planar() { 2 } else { 3 };
        let ball = ball(task) * reach.powi(dimension);
        let metres = length.powi(dimension);
        let tolerant = sizes.fault_tolerant;
        Measures {
            share: ratio(tolerant, sizes.unrestricted),
            ball_share: over(tolerant, ball),
            size_per_length: over(tolerant, metres),
            pre_failure_share: ratio(sizes.pre_failure, sizes.unrestricted),
            survival: ratio(tolerant, sizes.pre_failure),
            fill: over(sizes.unrestricted, ball),
            length: length / reach,
            dexterity: None,
            margin: None,
        }
    }

    /// One of the merits; the larger the better, 0 for one that was not measured.
    pub fn merit(&self, merit: Merit) -> Estimate {
        match merit {
            Merit::Share => self.share,
            Merit::BallShare => self.ball_share,
            Merit::SizePerLength => self.size_per_length,
            Merit::PreFailureShare => self.pre_failure_share,
            Merit::Survival => self.survival,
            Merit::Slenderness => Estimate {
                value: if self.length > 0.0 {
                    1.0 / self.length
                } else {
                    0.0
                },
                error: 0.0,
            },
            Merit::Condition => {
                let dexterity = self.dexterity.map(|d| d.inverse_condition);
                dexterity.unwrap_or_default()
            }
            Merit::NullComponent => self.dexterity.map(|d| d.null_component).unwrap_or_default(),
            Merit::Margin => self.margin.unwrap_or_default(),
        }
    }

    /// Whether a merit was measured.
    pub fn has(&self, merit: Merit) -> bool {
        match merit {
            Merit::Condition | Merit::NullComponent => self.dexterity.is_some(),
            Merit::Margin => self.margin.is_some(),
            _ => true,
        }
    }
}

/// Size of the task points within a distance of 1 m, with all orientations.
fn ball(task: TaskSpace) -> f64 {
    match task {
        TaskSpace::PlanarPosition => PI,
        TaskSpace::PlanarPose => PI * TAU,
        TaskSpace::SpatialPosition => 4.0 / 3.0 * PI,
        TaskSpace::SpatialPose => 4.0 / 3.0 * PI * PI * PI,
    }
}

fn over(a: Estimate, b: f64) -> Estimate {
    if b > 0.0 {
        Estimate {
            value: a.value / b,
            error: a.error / b,
        }
    } else {
        Estimate::default()
    }
}

/// a / b. Both rise and fall with the same samples, so that the errors' sum of squares is an upper
/// bound.
fn ratio(a: Estimate, b: Estimate) -> Estimate {
    if a.value <= 0.0 || b.value <= 0.0 {
        return Estimate::default();
    }
    let value = a.value / b.value;
    Estimate {
        value,
        error: value * (a.error / a.value).hypot(b.error / b.value),
    }
}
