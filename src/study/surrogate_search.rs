//! A search whose score is a surrogate's: what it claims, what is true of it, and what an exact
//! search finds in the same time.

use super::optimise::{Optimum, Session, Terms, Timed, Truth, search, search_for};
use super::run::RunError;
use super::settings::{Optimise, Study};
use super::surrogate_settings::SurrogateEstimator;
use crate::objective::DesignSpace;
use crate::surrogate::{Card, SurrogateObjective, card_path};
use serde_json::{Value, json};
use std::time::Instant;

/// What is told of a search through a surrogate.
#[derive(Clone, Debug)]
pub(super) struct SurrogateTrace {
    card: Card,
    /// Score that the surrogate gave its favourite.
    predicted: f64,
    /// Exact score of the best of the last candidates.
    rescored: f64,
    /// Exact score after the polish, if there was one.
    polished: Option<f64>,
    seconds: f64,
    exact_search: Option<Timed>,
}

/// Searches through the surrogate of `estimator`, decides by `exact`, and compares.
///
/// # Errors
/// As [`search`]; or the surrogate's files have changed since they were checked.
pub(super) fn search_through(
    study: &Study,
    optimise: &Optimise,
    estimator: &SurrogateEstimator,
    terms: &Terms,
    saved: Option<super::checkpoint::Stage>,
    session: &Session,
) -> Result<(Optimum, SurrogateTrace), RunError> {
    let path = &estimator.model.path;
    let card = Card::load(&card_path(path)).map_err(anyhow::Error::from)?;
    let model = card.model(path).map_err(anyhow::Error::from)?;
    let exact = terms.objective;
    let space: &DesignSpace = terms.space;
    let normalised = optimise.search.links.is_some();
    let objective = SurrogateObjective::new(&model, space.clone(), normalised);
    let started = Instant::now();
    let through = Terms {
        space,
        objective: &objective,
        samples: None,
        coarse: Vec::new(),
        starts: terms.starts.clone(),
        max_sweeps: terms.max_sweeps,
        tolerance: terms.tolerance,
        short_step: terms.short_step,
        truth: Some(Truth {
            objective: exact,
            polish: estimator.polish,
        }),
    };
    let optimum = search(optimise, &through, study.seed, saved, session)?;
    let seconds = started.elapsed().as_secs_f64();
    let exact_search = match estimator.compare {
        true => {
            let tell = &session.progress;
            tell.update(0, 1, optimum.score(), "exact search of equal time");
            Some(search_for(optimise, terms, study.seed, seconds)?)
        }
        false => None,
    };
    let trace = SurrogateTrace {
        predicted: optimum.stages[0].best_score,
        rescored: optimum.stages[0].rescored.unwrap_or(0.0),
        polished: optimum.stages.get(1).map(|stage| stage.best_score),
        seconds,
        exact_search,
        card,
    };
    Ok((optimum, trace))
}

impl SurrogateTrace {
    /// The part of `result.json`.
    pub fn to_json(&self) -> Value {
        let data = &self.card.data;
        json!({
            "robot": self.card.robot,
            "weights_sha256": self.card.weights_sha256,
            "data_hash": data.hash,
            "predicted_score": self.predicted,
            "rescored": self.rescored,
            "polished": self.polished,
            "best_training_label": {
                "fault_tolerant": data.largest,
                "limits_deg": {
                    "lower": data.largest_lower_deg,
                    "upper": data.largest_upper_deg,
                },
                "lengths": data.largest_lengths,
            },
            "seconds": self.seconds,
            "exact_search_of_equal_time": self.exact_search.as_ref().map(|timed| json!({
                "score": timed.best_score,
                "evaluations": timed.evaluations,
                "seconds": timed.seconds,
                "ended_by_itself": timed.ended_by_itself,
            })),
        })
    }

    /// What a reader of the numbers must not miss.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = vec![format!(
            "The search was scored by a surrogate: its favourite was predicted {:.6}; the best of \
             its last candidates is {:.6} exactly. The largest size among the surrogate's own \
             training labels is {:.6}.",
            self.predicted, self.rescored, self.card.data.largest
        )];
        if let Some(polished) = self.polished {
            notes.push(format!(
                "Refined with exact scores, it reaches {polished:.6}."
            ));
        }
        if let Some(timed) = &self.exact_search {
            notes.push(format!(
                "An exact search with the same settings finds {:.6} in {:.2} s (this one took \
                 {:.2} s); how far it gets depends on the machine.",
                timed.best_score, timed.seconds, self.seconds
            ));
        }
        notes
    }
}
