//! The content of `result.json` of a hybrid study, described in `docs/result.md`.

use super::locked_check;
use super::optimise::Optimum;
use super::result::{SCHEMA, limits_deg, provenance, search, status, workspaces};
use super::settings::{DegreeLimits, Question, Study};
use super::structure;
use crate::manifold::Intolerance;
use crate::workspace::hybrid::{Atlas, SamplePlan, Sampling};
use crate::workspace::{LockedJointEstimate, WorkspaceSizes};
use serde_json::{Value, json};

/// Everything that a finished hybrid study knows.
pub(super) struct HybridFinding<'a> {
    pub study: &'a Study,
    pub limits: &'a DegreeLimits,
    pub sizes: &'a WorkspaceSizes,
    /// The atlas on which `sizes` were measured.
    pub atlas: &'a Atlas,
    pub optimum: Option<&'a Optimum>,
    /// Why S_F is 0 for all limits, if it is.
    pub structure: Option<&'a Intolerance>,
    /// Standard error of the optimum's S_F on the samples of its search.
    pub searched_error: Option<f64>,
    /// The same workspaces by inverse kinematics, if the study asks for it.
    pub check: Option<&'a LockedJointEstimate>,
    pub seconds: Value,
    pub threads: usize,
    pub notes: &'a [String],
}

impl HybridFinding<'_> {
    pub fn to_json(&self) -> Value {
        let study = self.study;
        let counts = self.atlas.counts();
        let mut result = json!({
            "schema": SCHEMA,
            "study": study.name,
            "kind": study.question.kind(),
            "status": status(self.optimum),
            "size": self.size(),
            "workspaces": workspaces(self.sizes, &study.failures),
            "margin_deg": study.margin_deg,
            "limits_deg": limits_deg(self.limits),
        });
        if !self.limits.lower.is_empty() {
            let limits = self.limits;
            result["limits_m"] = json!({ "lower": limits.lower, "upper": limits.upper });
        }
        result["evaluations"] = json!(self.optimum.map_or(0, Optimum::evaluations));
        result["sampling"] = sampling(self.atlas.plan());
        result["samples"] = json!(counts.samples);
        result["reachable"] = json!(counts.reachable);
        result["failed_poses"] = json!(counts.failed);
        result["seeds"] = json!(counts.seeds);
        if let (Some(optimum), Question::Optimise(optimise)) = (self.optimum, &study.question) {
            result["search"] = search(optimum, optimise);
            result["search"]["score_on_search_sample"] = json!(optimum.score());
            result["search"]["standard_error_on_search_sample"] = json!(self.searched_error);
        }
        if let Some(check) = self.check {
            let share = locked_check::share(self.sizes);
            result["locked_joint_check"] = locked_check::to_json(check, &share);
        }
        if let Some(verdict) = self.structure {
            result["structure"] = structure::to_json(verdict);
        }
        result["notes"] = json!(self.notes);
        result["seconds"] = self.seconds.clone();
        result["provenance"] = provenance(study, self.threads);
        result
    }

    fn size(&self) -> Value {
        let sizes = self.sizes;
        json!({
            "fault_tolerant": sizes.fault_tolerant.value,
            "error": sizes.fault_tolerant.error,
            "standard_error": sizes.fault_tolerant.error,
            "unrestricted": sizes.unrestricted.value,
            "normalised": sizes.normalised(),
            "unit": self.study.task.unit(),
        })
    }
}

/// The samples in a few numbers.
fn sampling(plan: &SamplePlan) -> Value {
    match plan.sampling {
        Sampling::Lattice {
            samples: _,
            replicates,
        } => json!({ "method": "lattice", "replicates": replicates }),
        Sampling::Everywhere {
            samples: _,
            replicates,
        } => json!({ "method": "lattice", "azimuths": "all", "replicates": replicates }),
        Sampling::Grid {
            cell: _,
            orientations,
            centres,
        } => json!({
            "method": "grid",
            "cells": plan.cells(),
            "cell_m": plan.cell_side(),
            "orientations": orientations,
            "centres": centres,
        }),
    }
}
