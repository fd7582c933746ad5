//! What a study that trains tells.

use super::report_parts::{failures_label, formats, provenance_rows};
use super::result::{SCHEMA, provenance};
use super::run::RunOptions;
use super::settings::Study;
use super::train_run::MODEL;
use crate::report::{
    self, ReportError, ReportTable, SurrogateReport, TrainingCurve, TrainingEpoch,
    write_surrogate_report,
};
use crate::surrogate::validation::Score;
use crate::surrogate::{Architecture, Card, Decoder, Head, Training};
use serde_json::{Value, json};

/// A surrogate that has learnt.
pub(super) struct Lesson<'a> {
    pub study: &'a Study,
    pub card: &'a Card,
    pub training: &'a Training,
    pub seconds: Value,
    pub threads: usize,
}

impl Lesson<'_> {
    fn status(&self) -> &'static str {
        let card = &self.card.training;
        match card.epochs < card.settings.epochs {
            true => "converged",
            false => "done",
        }
    }

    /// The content of `result.json`.
    pub fn to_json(&self) -> Value {
        let card = self.card;
        json!({
            "schema": SCHEMA,
            "study": self.study.name,
            "kind": "train",
            "status": self.status(),
            "surrogate": method(&card.architecture),
            "model": {
                "file": MODEL,
                "card": "model.toml",
                "sha256": card.weights_sha256,
            },
            "data": {
                "hash": card.data.hash,
                "largest": card.data.largest,
                "unit": self.study.task.unit(),
                "uniform": card.data.uniform,
                "walk": card.data.walk,
            },
            "training": {
                "epochs": card.training.epochs,
                "best_epoch": card.training.best.number,
                "training_loss": card.training.best.training_loss,
                "kept_back_loss": card.training.best.kept_back_loss,
            },
            "kept_back": card.kept_back,
            "seconds": self.seconds,
            "provenance": provenance(self.study, self.threads),
        })
    }

    fn rows(&self) -> Vec<(String, String)> {
        let card = self.card;
        let sizes = card.architecture.sizes(&card.arm);
        let sizes: Vec<String> = sizes.iter().map(usize::to_string).collect();
        let data = &card.data;
        let row = |name: &str, value: String| (name.to_owned(), value);
        vec![
            row("surrogate", described(&card.architecture)),
            row("layers", sizes.join(" – ")),
            row("decoder", decoder(card)),
            row(
                "designs learnt from",
                format!(
                    "{} of uniform limits ({:.1} % empty), {} of threshold walks ({:.1} % empty)",
                    data.uniform.designs,
                    100.0 * data.uniform.empty_designs,
                    data.walk.designs,
                    100.0 * data.walk.empty_designs
                ),
            ),
            row("largest size learnt from", format!("{:.6}", data.largest)),
            row(
                "epochs",
                format!(
                    "{}, the best is {}",
                    card.training.epochs, card.training.best.number
                ),
            ),
        ]
    }
}

/// The method as study files have it.
pub(super) fn method(architecture: &Architecture) -> &'static str {
    match architecture.head {
        Head::Mdn(_) => "mdn",
        Head::Arcs(_) => "arcs",
        Head::Size(_) => "size",
    }
}

/// What the network gives, in words.
pub(super) fn described(architecture: &Architecture) -> String {
    match &architecture.head {
        Head::Mdn(head) => format!(
            "mixture density of {} {} components{}",
            head.components,
            if head.wrapped { "wrapped" } else { "plain" },
            match head.emptiness {
                true => " with a probability of emptiness",
                false => "",
            }
        ),
        Head::Arcs(head) => format!("trigonometric logit of {} harmonics", head.harmonics),
        Head::Size(_) => "size alone".into(),
    }
}

fn decoder(card: &Card) -> String {
    match (&card.architecture.head, &card.decoder) {
        (Head::Mdn(_), Decoder::Level { share }) => format!("level at {share} of ∫ p²"),
        (Head::Mdn(_), Decoder::Sampling(filter)) => format!(
            "{} draws, α = {}, ε = {}, γ = {}",
            filter.draws, filter.outlier, filter.closeness, filter.gap
        ),
        (Head::Arcs(_), _) => "sign".into(),
        (Head::Size(_), _) => "none".into(),
    }
}

/// Heading of the columns of [`score_row`].
pub(super) const SCORE_HEADER: [&str; 12] = [
    "surrogate",
    "designs",
    "number",
    "IoU mean",
    "IoU median",
    "IoU mean, S > 1 %",
    "S_F bias / %",
    "S_F RMSE / %",
    "network alone / %",
    "worst / %",
    "Spearman",
    "Spearman, top quarter",
];

/// A score as a row of a table; errors in percent of the largest size.
pub(super) fn score_row(name: &str, designs: &str, score: &Score) -> Vec<String> {
    let percent = |x: f64| format!("{:.2}", 100.0 * x);
    let overlap = |of: fn(&crate::surrogate::validation::OverlapScore) -> f64| {
        let value = score.overlap.as_ref().map(of);
        value.map_or("–".into(), |value| format!("{value:.3}"))
    };
    let size = &score.size;
    vec![
        name.into(),
        designs.into(),
        score.designs.to_string(),
        overlap(|o| o.mean),
        overlap(|o| o.median),
        overlap(|o| o.mean_large),
        percent(size.bias),
        percent(size.rmse),
        percent(size.rmse_network),
        percent(size.worst),
        format!("{:.4}", size.spearman),
        format!("{:.4}", size.spearman_top),
    ]
}

/// Writes the report, or without figures its numbers alone.
pub(super) fn write(
    lesson: &Lesson,
    result: &Value,
    options: &RunOptions,
    study_toml: &str,
) -> Result<(), ReportError> {
    let study = lesson.study;
    if !study.report.figures {
        return report::write_json(&options.out.join("result.json"), result);
    }
    let history = lesson.training.history().iter();
    let curve = TrainingCurve {
        epochs: history
            .map(|epoch| TrainingEpoch {
                number: epoch.number,
                training_loss: epoch.training_loss,
                kept_back_loss: epoch.kept_back_loss,
            })
            .collect(),
        best: lesson.card.training.best.number,
    };
    let name = method(&lesson.card.architecture);
    let kept_back = &lesson.card.kept_back;
    let table = ReportTable {
        name: "kept_back".into(),
        caption: "Scores on designs kept back from training, which stopped it and fitted the \
                  decoder: for an unbiased judgement validate on held-out designs. Errors of S_F \
                  in percent of the largest size learnt from."
            .into(),
        header: SCORE_HEADER.map(str::to_owned).to_vec(),
        rows: vec![
            score_row(name, "uniform", &kept_back.uniform),
            score_row(name, "walk", &kept_back.walk),
        ],
    };
    let robot = &study.design.robot;
    let report = SurrogateReport {
        title: study.title.clone().unwrap_or_else(|| study.name.clone()),
        study: study.name.clone(),
        robot: robot.name.clone(),
        source: robot.source.clone().unwrap_or_default(),
        task: study.task.to_string(),
        failures_label: failures_label(study),
        status: lesson.status().into(),
        rows: lesson.rows(),
        tables: vec![table],
        figures: vec![&curve],
        result_json: result.clone(),
        study_toml: study_toml.to_owned(),
        provenance: provenance_rows(study, lesson.threads),
        notes: Vec::new(),
    };
    write_surrogate_report(&report, &options.out, &formats(study))?;
    Ok(())
}
