//! The search of an optimisation study: a global stage, and after a genetic one a local one.
//!
//! Planar positions are scored exactly. Planar poses are scored at the coarse resolution
//! throughout, and everything else over an atlas; then the optimum is measured anew at the study's
//! tolerance or on an independent atlas.

use super::checkpoint::{Record, Stage, Store};
use super::run::{Progress, RunError};
use super::settings::{Optimise, OptimiserSettings};
use crate::objective::{Design, DesignSpace, Objective};
use crate::optimiser::{
    Candidate, Control, CoordinateAscent, CoordinateAscentSettings, Genetic, GeneticSettings,
    HistoryPoint, Maximise, Search, SearchState, Snapshot, run_search,
};
use crate::sampling;
use argmin::core::Solver;
use rand::Rng;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Starting points of the local stage.
const POLISHED: usize = 5;

/// Copies of the best candidate start the local stage this far off it, as a share of the box:
/// climbers that stall on one ridge at different places show each other its direction.
const SPREAD: f64 = 0.01;

/// What is searched, and how far it pays to search.
pub(super) struct Terms<'a> {
    pub space: &'a DesignSpace,
    pub objective: &'a dyn Objective,
    /// A first candidate.
    pub start: Option<Vec<f64>>,
    /// Most sweeps: fewer where a score costs milliseconds.
    pub max_sweeps: usize,
    /// Least relative gain of a sweep that counts: no less than what the score is good to.
    pub tolerance: f64,
}

impl Terms<'_> {
    fn within_reason(&self, settings: CoordinateAscentSettings) -> CoordinateAscentSettings {
        CoordinateAscentSettings {
            max_sweeps: settings.max_sweeps.min(self.max_sweeps),
            tolerance: settings.tolerance.max(self.tolerance),
            ..settings
        }
    }
}

/// The best design found and how.
pub(super) struct Optimum {
    pub design: Design,
    /// Score at the end of each stage, with the records.
    pub global: Record,
    pub local: Option<Record>,
}

impl Optimum {
    /// The stage that ended the search.
    pub fn last(&self) -> &Record {
        self.local.as_ref().unwrap_or(&self.global)
    }

    pub fn score(&self) -> f64 {
        self.last().best_score
    }

    pub fn evaluations(&self) -> u64 {
        self.global.evaluations + self.local.as_ref().map_or(0, |local| local.evaluations)
    }

    /// Progress of both stages, evaluations counted through.
    pub fn history(&self) -> Vec<HistoryPoint> {
        let mut history = self.global.history.clone();
        if let Some(record) = &self.local {
            history.extend(record.history.iter().map(|point| HistoryPoint {
                evaluations: point.evaluations + self.global.evaluations,
                ..*point
            }));
        }
        let end = history.last().map(|point| HistoryPoint {
            evaluations: self.evaluations(),
            mean: None,
            ..*point
        });
        history.extend(end);
        history
    }
}

/// What every stage needs.
pub(super) struct Session {
    pub store: Arc<Store>,
    pub progress: Arc<dyn Progress>,
    pub interrupt: Arc<AtomicBool>,
}

/// Runs the search of `optimise` to its end.
///
/// # Errors
/// The run was interrupted (a checkpoint is stored), the checkpoint is of another study, or
/// writing it failed.
pub(super) fn search(
    optimise: &Optimise,
    terms: &Terms,
    seed: u64,
    saved: Option<Stage>,
    session: &Session,
) -> Result<Optimum, RunError> {
    let (space, objective) = (terms.space, terms.objective);
    let (global, polish) = match saved {
        Some(Stage::Polish { before, snapshot }) => (Ended::known(before), Some(snapshot)),
        other => {
            let ended = global_stage(optimise, terms, seed, other, session)?;
            (ended, None)
        }
    };
    let polishes = match &optimise.optimiser {
        OptimiserSettings::Genetic(genetic) => genetic.polish,
        // Coordinate ascent refines as it goes.
        OptimiserSettings::CoordinateAscent(_) => false,
    };
    if !polishes {
        let best = &global.candidates[0];
        return Ok(Optimum {
            design: space.design(&best.x),
            global: global.record,
            local: None,
        });
    }
    let starts = polish_starts(&global.candidates, objective, seed);
    let settings = terms.within_reason(Default::default());
    let solver = CoordinateAscent::polish(&settings, seed ^ 1, starts);
    let before = global.record.clone();
    let wrap = move |snapshot| Stage::Polish {
        before: before.clone(),
        snapshot,
    };
    let local = stage(objective, solver, polish, wrap, session, "polishing")?;
    Ok(Optimum {
        design: space.design(&local.candidates[0].x),
        global: global.record,
        local: Some(local.record),
    })
}

fn ascent_settings(ascent: &super::settings::CoordinateAscent) -> CoordinateAscentSettings {
    CoordinateAscentSettings {
        restarts: ascent.restarts as usize,
        line_samples: ascent.line_samples as usize,
        scout_sweeps: ascent.scout_sweeps as usize,
        finalists: ascent.finalists as usize,
        max_sweeps: ascent.max_sweeps as usize,
        tolerance: ascent.tolerance,
    }
}

fn genetic_settings(genetic: &super::settings::Genetic) -> GeneticSettings {
    GeneticSettings {
        population: genetic.population as usize,
        generations: genetic.generations as usize,
        elite: genetic.elite as usize,
        tournament: genetic.tournament as usize,
        crossover_rate: genetic.crossover_rate,
        mutation_rate: genetic.mutation_rate,
        patience: genetic.patience as usize,
    }
}

fn global_stage(
    optimise: &Optimise,
    terms: &Terms,
    seed: u64,
    saved: Option<Stage>,
    session: &Session,
) -> Result<Ended, RunError> {
    let objective = terms.objective;
    let starts: Vec<Vec<f64>> = terms.start.iter().cloned().collect();
    match (&optimise.optimiser, saved) {
        (OptimiserSettings::CoordinateAscent(ascent), saved) => {
            let saved = match saved {
                Some(Stage::Ascent(snapshot)) => Some(snapshot),
                _ => None,
            };
            let settings = terms.within_reason(ascent_settings(ascent));
            let solver = CoordinateAscent::new(settings, seed, starts);
            let name = "coordinate ascent";
            stage(objective, solver, saved, Stage::Ascent, session, name)
        }
        (OptimiserSettings::Genetic(genetic), saved) => {
            let saved = match saved {
                Some(Stage::Genetic(snapshot)) => Some(snapshot),
                _ => None,
            };
            let solver = Genetic::new(genetic_settings(genetic), seed, starts);
            let name = "genetic algorithm";
            stage(objective, solver, saved, Stage::Genetic, session, name)
        }
    }
}

/// A stage that has run to its end.
struct Ended {
    candidates: Vec<Candidate>,
    record: Record,
}

impl Ended {
    /// A stage known from a checkpoint of the next one, which holds its starts itself.
    fn known(record: Record) -> Ended {
        Ended {
            candidates: Vec::new(),
            record,
        }
    }
}

fn stage<S>(
    objective: &dyn Objective,
    solver: S,
    saved: Option<Box<Snapshot<S>>>,
    wrap: impl Fn(Box<Snapshot<S>>) -> Stage + Send + Sync + 'static,
    session: &Session,
    name: &'static str,
) -> Result<Ended, RunError>
where
    S: Search + Clone + Serialize + DeserializeOwned + Send + Sync + 'static,
    S: for<'p> Solver<Maximise<'p>, SearchState>,
{
    let wrap = Arc::new(wrap);
    let (store, wrapper) = (session.store.clone(), wrap.clone());
    let progress = session.progress.clone();
    let control = Control {
        interrupt: session.interrupt.clone(),
        on_progress: Arc::new(move |share: f64, best| {
            let done = (1000.0 * share.clamp(0.0, 1.0)) as u64;
            progress.update(done, 1000, best, name);
        }),
        on_snapshot: Arc::new(move |solver: &S, state: &SearchState| {
            store.save_if_due(|| {
                wrapper(Box::new(Snapshot {
                    solver: solver.clone(),
                    state: state.clone(),
                }))
            })
        }),
    };
    let (snapshot, interrupted) =
        run_search(objective, solver, saved.map(|saved| *saved), control)?;
    if interrupted {
        session.store.save(wrap(Box::new(snapshot)))?;
        return Err(RunError::Interrupted);
    }
    let solver = snapshot.solver;
    let candidates = solver.candidates();
    if candidates.is_empty() {
        return Err(anyhow::anyhow!("the search ended without a candidate").into());
    }
    let record = Record {
        best_score: candidates[0].score,
        evaluations: solver.evaluations(),
        history: solver.history().to_vec(),
        converged: solver.converged(),
    };
    Ok(Ended { candidates, record })
}

/// The best candidate, others far enough from it, and copies of the best a little off.
fn polish_starts(candidates: &[Candidate], objective: &dyn Objective, seed: u64) -> Vec<Vec<f64>> {
    let Some(best) = candidates.first() else {
        return Vec::new();
    };
    let space = objective.space();
    let mut starts = vec![best.x.clone()];
    let spans: Vec<f64> = space.variables.iter().map(|v| v.upper - v.lower).collect();
    let far = |a: &[f64], b: &[f64]| {
        let difference = space.difference(a, b);
        let shares = difference.iter().zip(&spans).map(|(d, s)| (d / s).abs());
        shares.fold(0.0, f64::max) > SPREAD
    };
    for candidate in candidates.iter().take(20) {
        if starts.len() < POLISHED - 2 && starts.iter().all(|x| far(x, &candidate.x)) {
            starts.push(candidate.x.clone());
        }
    }
    let mut generator = sampling::stream(seed, u64::MAX);
    while starts.len() < POLISHED {
        let mut off = |span: &f64| 2.0 * SPREAD * span * (generator.random::<f64>() - 0.5);
        let step: Vec<f64> = spans.iter().map(&mut off).collect();
        starts.push(space.along(&best.x, &step, 1.0));
    }
    starts
}
