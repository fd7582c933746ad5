//! The result of `kind = "synthesis"`: numbers, files and page.

use super::found_robot;
use super::locked_check;
use super::report_parts::{formats, provenance_rows};
use super::result::{SCHEMA, limits_deg, provenance};
use super::run::{RunError, RunOptions};
use super::settings::{DegreeLimits, Study};
use super::structure;
use super::synthesis_check::SynthesisQuestion;
use super::synthesis_merit::{history_json, merit_json, merit_number, merits_json};
use super::synthesis_page::{tenth, tidy};
use crate::design::Robot;
use crate::manifold::Intolerance;
use crate::report::{FindingReport, write_finding_report};
use crate::synthesis::{
    Arm, AtMargin, Column, Draft, Finalist, FrontRobot, Links, Measures, ParameterSensitivity,
    ParetoSearch, Perturbed, Synthesis,
};
use crate::workspace::hybrid::SampleCounts;
use crate::workspace::{ArtificialLimits, Estimate, LockedJointEstimate, SpatialShareMap};
use serde_json::{Value, json};

/// The winner on the samples of the report.
pub(super) struct Winner {
    pub draft: Draft,
    pub measures: Measures,
    pub counts: SampleCounts,
    /// Where its workspace lies.
    pub map: SpatialShareMap,
    /// Metres, of the map.
    pub reach: f64,
    /// The share when joints overshoot their limits.
    pub margins: Vec<AtMargin>,
    /// The estimate by inverse kinematics with locked joints, if it was asked for.
    pub check: Option<LockedJointEstimate>,
    /// Change of the merit with every parameter; empty if it was not asked for.
    pub sensitivity: Vec<ParameterSensitivity>,
}

/// The design that it is compared with, on the same kind of samples.
pub(super) struct Reference {
    pub arm: Arm,
    pub limits: ArtificialLimits,
    /// Whether the limits are the study's; else they were fitted.
    pub given: bool,
    pub measures: Measures,
    /// Where its workspace lies.
    pub map: SpatialShareMap,
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
        let study = self.study;
        let result = self.to_json();
        let figures = self.figures();
        let report = FindingReport {
            title: study.title.clone().unwrap_or_else(|| study.name.clone()),
            study: study.name.clone(),
            robot: study.design.robot.name.clone(),
            source: study.design.robot.source.clone().unwrap_or_default(),
            summary: self.summary(),
            sections: self.sections(),
            figures: figures.iter().map(|figure| figure.as_ref()).collect(),
            tables: Vec::new(),
            files: self.files(),
            result_json: result.clone(),
            study_toml: study_toml.to_owned(),
            provenance: provenance_rows(study, rayon::current_num_threads()),
            notes: self.notes(),
        };
        write_finding_report(&report, &options.out, &formats(study), study.report.figures)
            .map_err(anyhow::Error::from)?;
        Ok(result)
    }

    /// The robot of `links` in metres.
    pub fn robot(&self, links: &Links) -> Robot {
        self.named_robot(links, self.study.name.replace('_', "-"))
    }

    fn named_robot(&self, links: &Links, name: String) -> Robot {
        let asked = &self.question.search;
        let space = asked.link_space(self.study.task);
        let mut robot = space.robot(&tidy(links, asked.reach), asked.reach, &name);
        robot.source = Some(found_robot::source(self.study));
        robot
    }

    /// Robot files, URDF files and a study of the winner, by name.
    fn files(&self) -> Vec<(String, String)> {
        let mut files = Vec::new();
        let named = |draft: &Draft, name: String| {
            let robot = self.named_robot(&draft.links, name);
            found_robot::robot_files(&robot, &draft.limits)
        };
        if let Some(winner) = self.winner {
            files.extend(named(&winner.draft, "robot".into()));
        }
        let front = self.pareto.map(|pareto| pareto.front()).unwrap_or_default();
        for (number, robot) in (1..).zip(front) {
            let own = named(&robot.draft, format!("robot-{number:02}"));
            files.extend(
                own.into_iter()
                    .map(|(name, text)| (format!("front/{name}"), text)),
            );
        }
        if let Some(winner) = self.winner {
            let (robot, limits) = (self.robot(&winner.draft.links), &winner.draft.limits);
            let failures = &self.question.failures(self.study);
            let study = found_robot::robot_study(self.study, &robot, limits, failures, "hybrid");
            files.push(study);
        }
        files
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
            result["off_reach"] = json!(pareto.off_reach());
        }
        if let Some(reference) = self.reference {
            result["reference"] = self.reference_json(reference);
        }
        result["notes"] = json!(self.notes());
        result["seconds"] = json!({ "total": self.seconds, "search": self.searched });
        result["provenance"] = provenance(study, rayon::current_num_threads());
        result
    }

    fn add_winner(&self, result: &mut Value, search: &Synthesis, winner: &Winner) {
        let chosen = search.winner();
        result["robot"] = self.links_json(&winner.draft.links);
        result["limits_deg"] = self.limits_json(&winner.draft.limits, &winner.draft.links);
        result["merits"] = merits_json(&winner.measures);
        result["samples"] = json!({
            "report": winner.counts.samples,
            "reachable": winner.counts.reachable,
            "failed": winner.counts.failed,
        });
        let merit = self.question.search.objectives[0];
        let number = |value: f64| merit_number(merit, value);
        let reported = winner.measures.merit(merit);
        let fitted = winner.draft.measures.merit(merit).value;
        let best_seen = search.history().iter().map(|g| g.best).fold(0.0, f64::max);
        result["honesty"] = json!({
            "merit": merit,
            "reported": merit_json(merit, &reported),
            "on_selection_samples": chosen.map(|c| merit_json(merit, &c.held_out.merit(merit))),
            "on_fit_samples": number(fitted),
            "best_of_all_generations": number(best_seen),
            "fit_bias": number(fitted - reported.value),
            "search_bias": number(best_seen - reported.value),
        });
        result["margin"] = margins(winner);
        if let Some(dexterity) = &winner.measures.dexterity {
            result["dexterity"] = json!({
                "poses": dexterity.poses,
                "least_null_vector_component": estimate(&dexterity.null_component),
                "inverse_condition": estimate(&dexterity.inverse_condition),
            });
        }
        if let Some(check) = &winner.check {
            result["locked_joint_check"] = locked_check::to_json(check, &winner.measures.share);
        }
        if !winner.sensitivity.is_empty() {
            let each = winner.sensitivity.iter().map(|s| self.sensitivity_json(s));
            result["sensitivity"] = each.collect();
        }
        result["chosen"] = json!(chosen.map(|c| c.name.clone()));
        let finalists: Vec<Value> = search
            .finalists()
            .iter()
            .map(|f| self.finalist(f))
            .collect();
        result["finalists"] = json!(finalists);
        result["screening"] = json!({
            "robots": search.screening().len(),
            "structurally_intolerant": search.intolerant(),
            "off_reach": self.screened_off_reach(),
        });
        result["evaluations"] = json!(search.evaluations());
        result["history"] = history_json(merit, search.history());
    }

    /// How many of the random robots that a search begins with miss the reach.
    pub(super) fn screened_off_reach(&self) -> u32 {
        let search = &self.question.search;
        // Robots that were given are numbered first.
        let given = u32::from(search.include_design);
        let screened = given..given + search.effort.screened as u32;
        let space = search.link_space(self.study.task);
        space.off_reach(self.study.seed, screened)
    }

    fn finalist(&self, finalist: &Finalist) -> Value {
        let merit = self.question.search.objectives[0];
        json!({
            "name": finalist.name,
            "score": merit_number(merit, finalist.score),
            "standard_error": merit_number(merit, finalist.error),
            "round": finalist.is_round,
            "robot": self.links_json(&finalist.draft.links),
            "limits_deg": self.limits_json(&finalist.draft.limits, &finalist.draft.links),
            "merits": merits_json(&finalist.held_out),
        })
    }

    fn front_robot(&self, robot: &FrontRobot) -> Value {
        json!({
            "robot": self.links_json(&robot.draft.links),
            "limits_deg": self.limits_json(&robot.draft.limits, &robot.draft.links),
            "merits": merits_json(&robot.held_out),
            "merits_while_searching": merits_json(&robot.draft.measures),
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
            "merits": merits_json(&reference.measures),
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

    /// Tolerance and changes of the merit when one number is too small and too large by it.
    fn sensitivity_json(&self, sensitivity: &ParameterSensitivity) -> Value {
        let reach = self.question.search.reach;
        let (key, tolerance) = match sensitivity.what {
            Perturbed::Link(_, Column::Length | Column::Offset) => {
                ("tolerance", sensitivity.tolerance * reach)
            }
            _ => ("tolerance_deg", sensitivity.tolerance.to_degrees()),
        };
        let [less, more] = &sensitivity.change;
        let mut json = json!({ "parameter": parameter_name(sensitivity.what) });
        json[key] = json!(tolerance);
        let merit = self.question.search.objectives[0];
        json["less"] = merit_json(merit, less);
        json["more"] = merit_json(merit, more);
        json
    }

    fn limits_json(&self, limits: &ArtificialLimits, links: &Links) -> Value {
        limits_deg(&DegreeLimits::from_limits(limits, &self.robot(links)))
    }
}

/// `alpha_3`, `a_2`, `d_4`, `lower_5`, `upper_5`.
pub(super) fn parameter_name(what: Perturbed) -> String {
    match what {
        Perturbed::Link(row, Column::Twist) => format!("alpha_{}", row + 1),
        Perturbed::Link(row, Column::Length) => format!("a_{}", row + 1),
        Perturbed::Link(row, Column::Offset) => format!("d_{}", row + 1),
        Perturbed::Lower(joint) => format!("lower_{}", joint + 1),
        Perturbed::Upper(joint) => format!("upper_{}", joint + 1),
    }
}

fn margins(winner: &Winner) -> Value {
    let point = |point: &AtMargin| {
        json!({
            "margin_deg": point.margin.to_degrees(),
            "share": point.share.value,
            "standard_error": point.share.error,
        })
    };
    let tenth = tenth(&winner.measures);
    json!({
        "points": winner.margins.iter().map(point).collect::<Vec<Value>>(),
        "ten_percent_deg": tenth.map(|margin| margin.value.to_degrees()),
        "standard_error_deg": tenth.map(|margin| margin.error.to_degrees()),
    })
}

fn estimate(estimate: &Estimate) -> Value {
    json!({ "value": estimate.value, "standard_error": estimate.error })
}
