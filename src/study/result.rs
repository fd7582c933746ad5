//! The content of `result.json`, described in `docs/result.md`.

use super::optimise::Optimum;
use super::planar_arm::{AtRadius, PlanarStudy};
use super::settings::{Optimise, Question, Study};
use crate::angle::degree_pairs;
use crate::workspace::{ArtificialLimits, Estimate, WorkspaceSizes};
use serde_json::{Value, json};

/// Version of the result's schema.
const SCHEMA: u32 = 1;

/// Everything that a finished planar study knows.
pub(super) struct Finding<'a> {
    pub study: &'a Study,
    pub arm: &'a PlanarStudy,
    /// Limits between links.
    pub limits: &'a ArtificialLimits,
    pub sizes: &'a WorkspaceSizes,
    pub optimum: Option<&'a Optimum>,
    pub radii: &'a [f64],
    pub seconds: Value,
    pub threads: usize,
    pub notes: &'a [String],
}

impl Finding<'_> {
    pub fn status(&self) -> &'static str {
        match self.optimum {
            None => "done",
            Some(optimum) if optimum.last().converged => "converged",
            Some(_) => "stopped",
        }
    }

    pub fn to_json(&self) -> Value {
        let study = self.study;
        let mut result = json!({
            "schema": SCHEMA,
            "study": study.name,
            "kind": study.question.kind(),
            "status": self.status(),
            "size": self.size(),
            "workspaces": self.workspaces(),
            "limits_deg": self.limits_deg(),
            "links": { "lengths": self.arm.lengths, "unit": "m" },
            "evaluations": self.optimum.map_or(0, Optimum::evaluations),
            "failed_poses": 0,
        });
        if let (Some(optimum), Question::Optimise(optimise)) = (self.optimum, &study.question) {
            result["search"] = search(optimum, optimise);
        }
        if !self.radii.is_empty() {
            result["rotation_sets"] = self.rotation_sets();
        }
        result["notes"] = json!(self.notes);
        result["seconds"] = self.seconds.clone();
        result["provenance"] = json!({
            "version": env!("CARGO_PKG_VERSION"),
            "seed": study.seed,
            "threads": self.threads,
            "design": study.design.robot.name,
            "design_sha256": study.design.sha256,
        });
        result
    }

    /// The limits of an estimate as the study has them, of an optimum as degrees.
    fn limits_deg(&self) -> Value {
        match &self.study.question {
            Question::Estimate(estimate) => {
                let limits = &estimate.limits;
                json!({ "lower": limits.lower_deg, "upper": limits.upper_deg })
            }
            Question::Optimise(_) => limits_deg(&self.arm.to_joints(self.limits)),
        }
    }

    fn size(&self) -> Value {
        let sizes = self.sizes;
        json!({
            "fault_tolerant": sizes.fault_tolerant.value,
            "error": sizes.fault_tolerant.error,
            "standard_error": 0.0,
            "unrestricted": sizes.unrestricted.value,
            "normalised": sizes.normalised(),
            "unit": self.study.task.unit(),
        })
    }

    fn workspaces(&self) -> Value {
        let value =
            |estimate: &Estimate| json!({ "size": estimate.value, "error": estimate.error });
        let post_failure = (1..).zip(&self.sizes.post_failure).map(|(joint, size)| {
            let prone = self.study.failures.contains(joint);
            json!({ "joint": joint, "prone": prone, "size": size.value, "error": size.error })
        });
        json!({
            "pre_failure": value(&self.sizes.pre_failure),
            "post_failure": post_failure.collect::<Vec<Value>>(),
            "unrestricted": value(&self.sizes.unrestricted),
        })
    }

    fn rotation_sets(&self) -> Value {
        let at = |&r: &f64| match self.arm.at_radius(self.limits, r) {
            AtRadius::Angles(set) => json!({ "r": r, "beta_deg": degree_pairs(&set) }),
            AtRadius::Measure(measure) => json!({ "r": r, "measure_beta_gamma": measure }),
        };
        self.radii.iter().map(at).collect()
    }
}

fn limits_deg(limits: &ArtificialLimits) -> Value {
    let lower = limits.joints().iter().map(|limit| limit.lower.to_degrees());
    let upper = limits.joints().iter().map(|limit| limit.upper.to_degrees());
    json!({ "lower": lower.collect::<Vec<f64>>(), "upper": upper.collect::<Vec<f64>>() })
}

fn search(optimum: &Optimum, optimise: &Optimise) -> Value {
    let stage = |name: &str, record: &super::checkpoint::Record| {
        json!({
            "stage": name,
            "score": record.best_score,
            "evaluations": record.evaluations,
            "converged": record.converged,
        })
    };
    let method = optimise.optimiser.method();
    let mut stages = vec![stage(method, &optimum.global)];
    stages.extend(optimum.local.as_ref().map(|local| stage("polish", local)));
    let score = if optimise.search.links.is_some() {
        "S_F / S_0max"
    } else {
        "S_F"
    };
    json!({ "method": method, "score": score, "stages": stages })
}
