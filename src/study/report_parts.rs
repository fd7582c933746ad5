//! Parts of a report that do not depend on the estimator.

use super::optimise::Optimum;
use super::settings::{FigureFormat, Question, Study};
use crate::design::{JointKind, Robot};
use crate::report::{Convergence, ConvergencePoint, Format};
use crate::workspace::{ArtificialLimits, WorkspaceSizes};

/// The failures in words.
pub(super) fn failures_label(study: &Study) -> String {
    let numbers: Vec<String> = study.failures.numbers().map(|j| j.to_string()).collect();
    let which = if numbers.len() == study.design.robot.joints() {
        "any single joint".into()
    } else {
        format!("one of the joints {}", numbers.join(", "))
    };
    let margin = study.margin_deg;
    if margin > 0.0 {
        format!("{which}, up to {margin}° beyond its artificial limits")
    } else {
        which
    }
}

/// The course of the search.
pub(super) fn convergence(study: &Study, optimum: &Optimum, seconds: f64) -> Convergence {
    let (links, method) = match &study.question {
        Question::Optimise(optimise) => {
            let method = optimise.optimiser.method().replace('-', " ");
            (optimise.search.links.is_some(), method)
        }
        _ => (false, String::new()),
    };
    let points = optimum.history().into_iter().map(|point| ConvergencePoint {
        evaluations: point.evaluations,
        best: point.best,
        mean: point.mean,
    });
    Convergence {
        method,
        score_label: if links { "S_F / S_0max" } else { "S_F" }.into(),
        unit: if links { "" } else { study.task.unit() }.into(),
        points: points.collect(),
        seconds: Some(seconds),
    }
}

/// Names and values that tell where a result comes from.
pub(super) fn provenance_rows(study: &Study, threads: usize) -> Vec<(String, String)> {
    let row = |name: &str, value: String| (name.to_owned(), value);
    vec![
        row("faultspace", env!("CARGO_PKG_VERSION").into()),
        row("seed", study.seed.to_string()),
        row("threads", threads.to_string()),
        row("robot file, SHA-256", study.design.sha256.clone()),
    ]
}

/// What a reader of the numbers must not miss; `searched` tells that the limits were found.
pub(super) fn size_notes(
    sizes: &WorkspaceSizes,
    limits: &ArtificialLimits,
    robot: &Robot,
    searched: bool,
) -> Vec<String> {
    let mut notes = Vec::new();
    if sizes.fault_tolerant.value == 0.0 {
        notes.push(match searched {
            false => "The fault-tolerant workspace is empty for these limits.".into(),
            true => "No limits with a fault-tolerant workspace were found.".into(),
        });
    }
    for (index, limit) in limits.joints().iter().enumerate() {
        let number = index + 1;
        // Narrower than a control system resolves.
        if limit.width() < 1e-4 && robot.joint_kind(index) == JointKind::Revolute {
            let angle = limit.centre().to_degrees();
            notes.push(format!(
                "Joint {number} is held still at {angle:.4}° before a failure. Set \
                 `min_width_deg` in `[search]` to ask for limits that leave it room."
            ));
        }
    }
    notes
}

/// The formats of the study's figures.
pub(super) fn formats(study: &Study) -> Vec<Format> {
    let format = |format: &FigureFormat| match format {
        FigureFormat::Png => Format::Png,
        FigureFormat::Svg => Format::Svg,
    };
    study.report.formats.iter().map(format).collect()
}
