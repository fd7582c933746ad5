//! The result of `kind = "synthesis"`: numbers, files and page.

use super::result::{SCHEMA, limits_deg, provenance};
use super::run::{RunError, RunOptions};
use super::settings::{DegreeLimits, Study};
use super::structure;
use super::synthesis_check::SynthesisQuestion;
use crate::design::Robot;
use crate::manifold::Intolerance;
use crate::report;
use crate::synthesis::{
    Arm, Draft, Finalist, FrontRobot, Links, Measures, Merit, ParetoSearch, Synthesis,
};
use crate::workspace::hybrid::SampleCounts;
use crate::workspace::{ArtificialLimits, Estimate};
use serde_json::{Value, json};

/// The winner on the samples of the report.
pub(super) struct Winner {
    pub draft: Draft,
    pub measures: Measures,
    pub counts: SampleCounts,
    /// Seconds.
    pub measured: f64,
}

/// The design that it is compared with, on the same kind of samples.
pub(super) struct Reference {
    pub arm: Arm,
    pub limits: ArtificialLimits,
    /// Whether the limits are the study's; else they were fitted.
    pub given: bool,
    pub measures: Measures,
    /// Why it has no fault-tolerant workspace, if so.
    pub verdict: Option<Intolerance>,
}

/// Everything a finished study knows: a search for one robot or for a front.
pub(super) struct SynthesisFinding<'a> {
    pub study: &'a Study,
    pub question: &'a SynthesisQuestion,
    pub search: Option<&'a Synthesis>,
    pub pareto: Option<&'a ParetoSearch>,
    pub winner: Option<&'a Winner>,
    pub reference: Option<&'a Reference>,
    pub searched: f64,
    pub seconds: f64,
}

impl SynthesisFinding<'_> {
    /// Writes everything and returns the content of `result.json`.
    ///
    /// # Errors
    /// A file could not be written.
    pub fn write(&self, options: &RunOptions, study_toml: &str) -> Result<Value, RunError> {
        let _ = study_toml;
        let result = self.to_json();
        let path = options.out.join("result.json");
        report::write_json(&path, &result).map_err(anyhow::Error::from)?;
        Ok(result)
    }

    /// The robot of `links` in metres.
    pub fn robot(&self, links: &Links) -> Robot {
        let asked = &self.question.search;
        let space = asked.link_space(self.study.task);
        space.robot(links, asked.reach, &self.study.name)
    }

    fn to_json(&self) -> Value {
        let study = self.study;
        let mut result = json!({
            "schema": SCHEMA,
            "study": study.name,
            "kind": study.question.kind(),
            "status": "done",
            "objectives": self.question.search.objectives,
        });
        if let (Some(search), Some(winner)) = (self.search, self.winner) {
            self.add_winner(&mut result, search, winner);
        }
        if let Some(pareto) = self.pareto {
            let front: Vec<Value> = pareto.front().iter().map(|r| self.front_robot(r)).collect();
            result["front"] = json!(front);
            result["evaluations"] = json!(pareto.evaluations());
        }
        if let Some(reference) = self.reference {
            result["reference"] = self.reference_json(reference);
        }
        result["seconds"] = json!({ "total": self.seconds, "search": self.searched });
        result["provenance"] = provenance(study, rayon::current_num_threads());
        result
    }

    fn add_winner(&self, result: &mut Value, search: &Synthesis, winner: &Winner) {
        let chosen = search.winner();
        result["robot"] = self.links_json(&winner.draft.links);
        result["limits_deg"] = self.limits_json(&winner.draft.limits, &winner.draft.links);
        result["merits"] = merits(&winner.measures);
        result["samples"] = json!({
            "report": winner.counts.samples,
            "reachable": winner.counts.reachable,
            "failed": winner.counts.failed,
        });
        let merit = self.question.search.objectives[0];
        let reported = winner.measures.merit(merit);
        let fitted = winner.draft.measures.merit(merit).value;
        let best_seen = search.history().iter().map(|g| g.best).fold(0.0, f64::max);
        result["honesty"] = json!({
            "merit": merit,
            "reported": estimate(&reported),
            "on_selection_samples": chosen.map(|c| estimate(&c.held_out.merit(merit))),
            "on_fit_samples": fitted,
            "best_of_all_generations": best_seen,
            "fit_bias": fitted - reported.value,
            "search_bias": best_seen - reported.value,
        });
        result["chosen"] = json!(chosen.map(|c| c.name.clone()));
        let finalists: Vec<Value> = search.finalists().iter().map(|f| self.finalist(f)).collect();
        result["finalists"] = json!(finalists);
        result["screening"] = json!({
            "robots": search.screening().len(),
            "structurally_intolerant": search.intolerant(),
        });
        result["evaluations"] = json!(search.evaluations());
        result["history"] = json!(search.history());
    }

    fn finalist(&self, finalist: &Finalist) -> Value {
        json!({
            "name": finalist.name,
            "score": finalist.score,
            "standard_error": finalist.error,
            "round": finalist.is_round,
            "robot": self.links_json(&finalist.draft.links),
            "limits_deg": self.limits_json(&finalist.draft.limits, &finalist.draft.links),
            "merits": merits(&finalist.held_out),
        })
    }

    fn front_robot(&self, robot: &FrontRobot) -> Value {
        json!({
            "robot": self.links_json(&robot.draft.links),
            "limits_deg": self.limits_json(&robot.draft.limits, &robot.draft.links),
            "merits": merits(&robot.held_out),
            "merits_while_searching": merits(&robot.draft.measures),
        })
    }

    fn reference_json(&self, reference: &Reference) -> Value {
        let robot = &self.study.design.robot;
        let limits = DegreeLimits::from_limits(&reference.limits, robot);
        let mut json = json!({
            "robot": robot.name,
            "limits_deg": limits_deg(&limits),
            "limits_given": reference.given,
            "reach": reference.arm.extent.reach,
            "merits": merits(&reference.measures),
        });
        if let Some(verdict) = &reference.verdict {
            json["structure"] = structure::to_json(verdict);
        }
        json
    }

    /// Rows in degrees and metres.
    fn links_json(&self, links: &Links) -> Value {
        let reach = self.question.search.reach;
        let row = |link: &crate::synthesis::Constants| {
            json!({
                "alpha_deg": link.twist.to_degrees(),
                "a": link.length * reach,
                "d": link.offset * reach,
            })
        };
        links.iter().map(row).collect()
    }

    fn limits_json(&self, limits: &ArtificialLimits, links: &Links) -> Value {
        limits_deg(&DegreeLimits::from_limits(limits, &self.robot(links)))
    }
}

fn estimate(estimate: &Estimate) -> Value {
    json!({ "value": estimate.value, "standard_error": estimate.error })
}

/// All merits by name, with L/R and the fill.
fn merits(measures: &Measures) -> Value {
    let mut all = serde_json::Map::new();
    for merit in Merit::ALL {
        all.insert(merit.name().into(), estimate(&measures.merit(merit)));
    }
    all.insert("fill".into(), estimate(&measures.fill));
    all.insert("length_in_reaches".into(), json!(measures.length));
    Value::Object(all)
}
