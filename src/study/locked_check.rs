//! The same share by another way: inverse kinematics with locked joints on random task points.

use super::settings::Study;
use crate::design::Robot;
use crate::report::with_error;
use crate::synthesis::{Purpose, sample_seed};
use crate::workspace::{
    ArtificialLimits, Estimate, FailureSet, LockedJointCheck, LockedJointEstimate, WorkspaceSizes,
};
use serde_json::{Value, json};

/// Distance in standard errors beyond which a check contradicts what it checks.
const CONTRADICTION: f64 = 3.0;

/// What is checked.
pub(super) struct Checked<'a> {
    pub study: &'a Study,
    pub robot: &'a Robot,
    pub limits: &'a ArtificialLimits,
    pub failures: &'a FailureSet,
    /// Reachable task points to judge.
    pub poses: u64,
}

impl Checked<'_> {
    /// The check's counts. `watch` is told how many task points are done, of how many. `None` if
    /// `stop` says so, if nothing was asked for, or if the robot has more joints than can be checked.
    pub fn count(
        &self,
        watch: &(dyn Fn(u64, u64) + Sync),
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<LockedJointEstimate> {
        let check = LockedJointCheck {
            poses: self.poses,
            margin: self.failures.margin(),
            seed: sample_seed(self.study.seed, Purpose::Check, 0),
            ..LockedJointCheck::default()
        };
        let (robot, task) = (self.robot, self.study.task);
        (self.poses > 0)
            .then(|| check.run(robot, task, self.limits, self.failures, watch, stop))
            .flatten()
    }
}

/// S_F / S_0max. The error is that of S_F alone: S_0max is known far better, and moves with it.
pub(super) fn share(sizes: &WorkspaceSizes) -> Estimate {
    let unrestricted = sizes.unrestricted.value.max(f64::MIN_POSITIVE);
    Estimate {
        value: sizes.normalised(),
        error: sizes.fault_tolerant.error / unrestricted,
    }
}

/// How far the check is above the share that it checks, in standard errors of the difference.
fn distance(check: &LockedJointEstimate, reported: &Estimate) -> f64 {
    let share = check.fault_tolerant_share();
    (share.value - reported.value) / share.error.hypot(reported.error)
}

/// What the check says, as a sentence.
pub(super) fn sentence(check: &LockedJointEstimate, reported: &Estimate) -> String {
    let share = check.fault_tolerant_share();
    format!(
        "Inverse kinematics with locked joints, an independent way, finds S_F / S_0max = {} % on {} \
         reachable task points: {:.1} standard errors of the difference away.",
        with_error(100.0 * share.value, 100.0 * share.error),
        check.reachable,
        distance(check, reported).abs()
    )
}

/// What a reader must not miss if the two disagree.
pub(super) fn contradiction(check: &LockedJointEstimate, reported: &Estimate) -> Option<String> {
    (distance(check, reported).abs() > CONTRADICTION).then(|| {
        "The independent check disagrees with the reported share by more than three standard \
         errors: do not rely on the number."
            .into()
    })
}

/// The check beside the number it checks.
pub(super) fn to_json(check: &LockedJointEstimate, reported: &Estimate) -> Value {
    let estimate = |found: Estimate| json!({ "value": found.value, "standard_error": found.error });
    json!({
        "poses": check.reachable,
        "share": estimate(check.fault_tolerant_share()),
        "pre_failure_share": estimate(check.pre_failure_share()),
        "difference_in_standard_errors": distance(check, reported),
    })
}
