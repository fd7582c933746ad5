//! The content of `result.json`, described in `docs/result.md`.

use super::optimise::Optimum;
use super::planar_arm::{AtRadius, PlanarStudy};
use super::settings::{DegreeLimits, Optimise, Question, Study};
use super::surrogate_search::SurrogateTrace;
use crate::angle::degree_pairs;
use crate::workspace::{ArtificialLimits, Estimate, FailureSet, WorkspaceSizes};
use serde_json::{Value, json};

/// Version of the result's schema.
pub(super) const SCHEMA: u32 = 1;

/// Everything that a finished planar study knows.
pub(super) struct Finding<'a> {
    pub study: &'a Study,
    pub arm: &'a PlanarStudy,
    /// Limits between links.
    pub limits: &'a ArtificialLimits,
    pub sizes: &'a WorkspaceSizes,
    pub optimum: Option<&'a Optimum>,
    /// How a search through a surrogate went.
    pub surrogate: Option<&'a SurrogateTrace>,
    pub radii: &'a [f64],
    pub seconds: Value,
    pub threads: usize,
    pub notes: &'a [String],
}

impl Finding<'_> {
    pub fn status(&self) -> &'static str {
        status(self.optimum)
    }

    /// Heading of the report.
    pub fn title(&self) -> String {
        let title = self.study.title.clone();
        title.unwrap_or_else(|| self.study.name.clone())
    }

    /// Whether the robot is another one than the design.
    pub fn has_new_links(&self) -> bool {
        matches!(&self.study.question, Question::Optimise(optimise) if optimise.search.links.is_some())
    }

    pub fn to_json(&self) -> Value {
        let study = self.study;
        let mut result = json!({
            "schema": SCHEMA,
            "study": study.name,
            "kind": study.question.kind(),
            "status": self.status(),
            "size": self.size(),
            "workspaces": workspaces(self.sizes, &study.failures),
            "margin_deg": study.margin_deg,
            "limits_deg": self.limits_deg(),
            "links": { "lengths": self.arm.lengths, "unit": "m" },
            "evaluations": self.optimum.map_or(0, Optimum::evaluations),
            "failed_poses": 0,
        });
        if let (Some(optimum), Question::Optimise(optimise)) = (self.optimum, &study.question) {
            result["search"] = search(optimum, optimise);
        }
        if let Some(trace) = self.surrogate {
            result["surrogate"] = trace.to_json();
        }
        if !self.radii.is_empty() {
            result["rotation_sets"] = self.rotation_sets();
        }
        result["notes"] = json!(self.notes);
        result["seconds"] = self.seconds.clone();
        result["provenance"] = provenance(study, self.threads);
        result
    }

    /// The limits of an estimate as the study has them, of an optimum as degrees.
    fn limits_deg(&self) -> Value {
        let robot = &self.study.design.robot;
        match &self.study.question {
            Question::Estimate(estimate) => limits_deg(&estimate.limits),
            _ => {
                let limits = self.arm.to_joints(self.limits);
                limits_deg(&DegreeLimits::from_limits(&limits, robot))
            }
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

    fn rotation_sets(&self) -> Value {
        let at = |&r: &f64| match self.arm.at_radius(self.limits, r) {
            AtRadius::Angles(set) => json!({ "r": r, "beta_deg": degree_pairs(&set) }),
            AtRadius::Measure(measure) => json!({ "r": r, "measure_beta_gamma": measure }),
        };
        self.radii.iter().map(at).collect()
    }
}

/// How the run ended.
pub(super) fn status(optimum: Option<&Optimum>) -> &'static str {
    match optimum {
        None => "done",
        Some(optimum) if optimum.last().converged => "converged",
        Some(_) => "stopped",
    }
}

/// Every workspace with its size and error.
pub(super) fn workspaces(sizes: &WorkspaceSizes, failures: &FailureSet) -> Value {
    let value = |estimate: &Estimate| json!({ "size": estimate.value, "error": estimate.error });
    let post_failure = (1..).zip(&sizes.post_failure).map(|(joint, size)| {
        let prone = failures.contains(joint);
        json!({ "joint": joint, "prone": prone, "size": size.value, "error": size.error })
    });
    json!({
        "pre_failure": value(&sizes.pre_failure),
        "post_failure": post_failure.collect::<Vec<Value>>(),
        "unrestricted": value(&sizes.unrestricted),
    })
}

/// Where the result comes from.
pub(super) fn provenance(study: &Study, threads: usize) -> Value {
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "seed": study.seed,
        "threads": threads,
        "design": study.design.robot.name,
        "design_sha256": study.design.sha256,
    })
}

/// Limits of revolute joints.
pub(super) fn limits_deg(limits: &DegreeLimits) -> Value {
    json!({ "lower": limits.lower_deg, "upper": limits.upper_deg })
}

/// How the search went.
pub(super) fn search(optimum: &Optimum, optimise: &Optimise) -> Value {
    let stage = |record: &super::checkpoint::Record| {
        let mut stage = json!({
            "stage": record.stage,
            "score": record.best_score,
            "evaluations": record.evaluations,
            "converged": record.converged,
        });
        if let Some(samples) = record.samples {
            stage["samples"] = json!(samples);
        }
        stage
    };
    let method = optimise.optimiser.method();
    let stages: Vec<Value> = optimum.stages.iter().map(stage).collect();
    let score = if optimise.search.links.is_some() {
        "S_F / S_0max"
    } else {
        "S_F"
    };
    json!({ "method": method, "score": score, "stages": stages })
}
