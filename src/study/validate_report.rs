//! What a study that validates surrogates tells.

use super::report_parts::{failures_label, formats, provenance_rows};
use super::result::{SCHEMA, provenance};
use super::run::RunOptions;
use super::settings::Study;
use super::surrogate_settings::Validate;
use super::train_report::{SCORE_HEADER, method, score_row};
use super::validate_picture::Pictures;
use crate::report::{self, ReportError, ReportTable, SurrogateReport, write_surrogate_report};
use crate::surrogate::validation::{CalibrationBin, Case, Score};
use crate::surrogate::{Card, Dataset, Model, SurrogateArm};
use serde_json::{Value, json};

/// A surrogate that was judged.
pub(super) struct Judged {
    pub name: String,
    pub card: Card,
    pub model: Model,
    pub described: String,
    pub cases: Vec<Case>,
    /// The unit of its errors of S_F.
    pub largest: f64,
    pub uniform: Score,
    pub walk: Score,
    pub calibration: Vec<CalibrationBin>,
    /// Seconds per design: one by one, in batches, exact.
    pub timing: [f64; 3],
}

/// All surrogates of a study beside each other.
pub(super) struct Comparison<'a> {
    pub study: &'a Study,
    pub validate: &'a Validate,
    pub held_out: &'a [(SurrogateArm, Dataset)],
    pub judged: &'a [Judged],
    pub seconds: Value,
    pub threads: usize,
}

impl Comparison<'_> {
    /// The content of `result.json`.
    pub fn to_json(&self) -> Value {
        let surrogate = |judged: &Judged| {
            let [alone, batch, exact] = judged.timing;
            json!({
                "name": judged.name,
                "method": method(&judged.card.architecture),
                "weights_sha256": judged.card.weights_sha256,
                "largest": judged.largest,
                "uniform": judged.uniform,
                "walk": judged.walk,
                "calibration": judged.calibration,
                "timing": {
                    "seconds_alone": alone,
                    "seconds_in_batches": batch,
                    "seconds_exact": exact,
                    "exact_per_batched": exact / batch.max(1e-12),
                },
            })
        };
        let surrogates: Vec<Value> = self.judged.iter().map(surrogate).collect();
        json!({
            "schema": SCHEMA,
            "study": self.study.name,
            "kind": "validate",
            "status": "done",
            "draw": self.validate.draw,
            "unit": self.study.task.unit(),
            "surrogates": surrogates,
            "seconds": self.seconds,
            "provenance": provenance(self.study, self.threads),
        })
    }

    /// The designs on which a surrogate was judged.
    pub fn designs_of(&self, judged: &Judged) -> Option<&Dataset> {
        let arm = crate::surrogate::Surrogate::arm(&judged.model);
        let found = self.held_out.iter().find(|(known, _)| known == arm);
        found.map(|(_, data)| data)
    }

    fn tables(&self) -> Vec<ReportTable> {
        let table = |name: &str, caption: &str, header: &[&str], rows| ReportTable {
            name: name.into(),
            caption: caption.into(),
            header: header.iter().map(|&text| text.to_owned()).collect(),
            rows,
        };
        let scores = self.judged.iter().flat_map(|judged| {
            let parts = [("uniform", &judged.uniform), ("walk", &judged.walk)];
            parts.map(|(designs, score)| score_row(&judged.name, designs, score))
        });
        let cells = self.judged.iter().flat_map(|judged| {
            let parts = [("uniform", &judged.uniform), ("walk", &judged.walk)];
            parts.into_iter().filter_map(|(designs, score)| {
                let cells = score.cells.as_ref()?;
                let percent = |share: f64| format!("{:.2}", 100.0 * share);
                Some(vec![
                    judged.name.clone(),
                    designs.into(),
                    percent(cells.false_empty),
                    percent(cells.false_non_empty),
                ])
            })
        });
        let timing = self.judged.iter().map(|judged| {
            let micro = |seconds: f64| format!("{:.2}", 1e6 * seconds);
            let [alone, batch, exact] = judged.timing;
            vec![
                judged.name.clone(),
                micro(alone),
                micro(batch),
                micro(exact),
                format!("{:.3}", exact / batch.max(1e-12)),
            ]
        });
        vec![
            table(
                "scores",
                "Surrogates against exact workspaces. IoU: intersection over union of predicted \
                 and exact workspaces; the third mean leaves out designs below 1 % of the largest \
                 size. Errors of S_F in percent of the largest size; “network alone” compares \
                 with exact sets at the surrogate's own quadrature nodes.",
                &SCORE_HEADER,
                scores.collect(),
            ),
            table(
                "cells",
                "Cells confused: share of non-empty cells predicted empty, and of empty cells \
                 predicted non-empty.",
                &[
                    "surrogate",
                    "designs",
                    "false empty / %",
                    "false non-empty / %",
                ],
                cells.collect(),
            ),
            table(
                "timing",
                "Time of one size on one thread of this machine, in the same run.",
                &[
                    "surrogate",
                    "one by one / µs",
                    "in batches / µs",
                    "exact / µs",
                    "exact / batched",
                ],
                timing.collect(),
            ),
        ]
    }

    fn rows(&self) -> Vec<(String, String)> {
        let each = self.judged.iter();
        each.map(|judged| (judged.name.clone(), judged.described.clone()))
            .collect()
    }
}

/// Writes the report, or without figures its numbers alone.
pub(super) fn write(
    comparison: &Comparison,
    result: &Value,
    options: &RunOptions,
    study_toml: &str,
) -> Result<(), ReportError> {
    let study = comparison.study;
    if !study.report.figures {
        return report::write_json(&options.out.join("result.json"), result);
    }
    let pictures = Pictures::of(comparison);
    let robot = &study.design.robot;
    let report = SurrogateReport {
        title: study.title.clone().unwrap_or_else(|| study.name.clone()),
        study: study.name.clone(),
        robot: robot.name.clone(),
        source: robot.source.clone().unwrap_or_default(),
        task: study.task.to_string(),
        failures_label: failures_label(study),
        status: "done".into(),
        rows: comparison.rows(),
        tables: comparison.tables(),
        figures: pictures.figures(),
        result_json: result.clone(),
        study_toml: study_toml.to_owned(),
        provenance: provenance_rows(study, comparison.threads),
        notes: Vec::new(),
    };
    write_surrogate_report(&report, &options.out, &formats(study))?;
    Ok(())
}
