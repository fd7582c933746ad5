//! The verdict before the numbers: a robot that no limits make fault tolerant.

use super::report_parts::failures_label;
use super::result::{SCHEMA, provenance};
use super::run::{Ready, RunError, RunOptions};
use super::settings::Study;
use crate::manifold::{Cure, Intolerance};
use crate::report;
use serde_json::{Value, json};

/// Why S_F of the study is 0 for all limits; `None` if nothing in the robot's structure says so.
pub(super) fn verdict(study: &Study) -> Option<Intolerance> {
    let prone = |joint| study.failures.contains(joint);
    Intolerance::of(&study.design.robot, study.task, prone)
}

/// The verdict as a field of `result.json`.
pub(super) fn to_json(verdict: &Intolerance) -> Value {
    let cure = |cure: &Cure| {
        json!({
            "joint": cure.joint,
            "parameter": cure.parameter,
            "component": cure.component,
        })
    };
    json!({
        "joint": verdict.joints.first(),
        "joints": verdict.joints,
        "largest_component": verdict.largest_component,
        "configurations": verdict.configurations,
        "offset_m": verdict.offset,
        "cures": verdict.cures.iter().map(cure).collect::<Vec<Value>>(),
    })
}

/// The verdict in two sentences.
pub(super) fn note(verdict: &Intolerance) -> String {
    format!("S_F is 0 for all artificial limits. The robot is {verdict}.")
}

/// Ends a search that has nothing to search, before any manifold is traced.
///
/// # Errors
/// A file could not be written.
pub(super) fn without_search(
    study: &Study,
    verdict: &Intolerance,
    options: &RunOptions,
    ready: &Ready,
) -> Result<Value, RunError> {
    ready.begin(options)?;
    let failures = failures_label(study);
    let result = json!({
        "schema": SCHEMA,
        "study": study.name,
        "kind": study.question.kind(),
        "status": "structurally-intolerant",
        "size": {
            "fault_tolerant": 0.0,
            "error": 0.0,
            "standard_error": 0.0,
            "normalised": 0.0,
            "unit": study.task.unit(),
        },
        "evaluations": 0,
        "structure": to_json(verdict),
        "notes": [
            note(verdict),
            format!(
                "No limits were searched. Leave the joint out of `failures` (now: {failures}), or \
                 give the robot such an offset."
            ),
        ],
        "seconds": { "total": ready.session.store.seconds() },
        "provenance": provenance(study, rayon::current_num_threads()),
    });
    let path = options.out.join("result.json");
    report::write_json(&path, &result).map_err(anyhow::Error::from)?;
    ready.session.store.remove();
    Ok(result)
}
