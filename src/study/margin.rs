//! The margin beyond artificial limits: which studies have one.

use super::file::{Kind, StudyFile};
use super::settings::EstimatorMethod;
use crate::design::{JointKind, Robot};
use crate::diagnostic::Problems;

/// The study's `margin_deg`; a margin that the study cannot have is reported to `problems`.
pub(super) fn degrees(file: &StudyFile, problems: &Problems, robot: &Robot) -> f64 {
    let Some(item) = &file.margin_deg else {
        return 0.0;
    };
    // Every study may say that it has none.
    if item.value == 0.0 {
        return 0.0;
    }
    let method = file.estimator.method.as_ref().map(|item| item.value);
    let slides = |joint: &usize| robot.joint_kind(*joint) == JointKind::Prismatic;
    let remove = "remove the key, or write `margin_deg = 0`";
    match file.kind.value {
        Kind::Train | Kind::Validate => problems.reject(
            &item.place,
            "a surrogate knows no margin beyond the artificial limits",
            "0",
            remove,
        ),
        Kind::Optimise if method == Some(EstimatorMethod::Surrogate) => problems.reject(
            &item.place,
            "a surrogate knows no margin beyond the artificial limits",
            "0 with `method = \"surrogate\"`",
            "write `method = \"exact\"`, or remove the key",
        ),
        Kind::Singularities | Kind::LargestManifold | Kind::FailureExperiment => problems.reject(
            &item.place,
            "this kind of study has no artificial limits, so there is no margin beyond them",
            "0",
            remove,
        ),
        Kind::Estimate | Kind::Optimise | Kind::Manifolds | Kind::Synthesis => {
            if let Some(joint) = (0..robot.joints()).find(slides) {
                let message = format!(
                    "the margin is an angle, and joint {} is prismatic",
                    joint + 1
                );
                problems.reject(&item.place, &message, "0 for this robot", remove);
            }
        }
    }
    item.value
}

#[cfg(test)]
mod tests;
