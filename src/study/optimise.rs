//! The search of an optimisation study: a global stage, then local ones.
//!
//! Planar positions are scored exactly. Planar poses are scored at the coarse resolution
//! throughout, and everything else over an atlas; then the optimum is measured anew at the study's
//! tolerance or on an independent atlas.
//!
//! After a genetic stage coordinate ascent refines the best. Over an atlas, coordinate ascent
//! starts on a part of the samples, and its best go on with more and more of them.

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
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Starting points of the local stage.
const POLISHED: usize = 5;

/// Most sweeps of a stage that goes on with more samples: it starts close to a maximum.
const REFINING_SWEEPS: usize = 5;

/// Copies of the best candidate start the local stage this far off it, as a share of the box:
/// climbers that stall on one ridge at different places show each other its direction.
const SPREAD: f64 = 0.01;

/// Scores from this share of the best one on count as equal to it.
const EQUAL: f64 = 0.999;

/// What is searched, and how far it pays to search.
pub(super) struct Terms<'a> {
    pub space: &'a DesignSpace,
    pub objective: &'a dyn Objective,
    /// Samples behind a score, if it is an estimate.
    pub samples: Option<u64>,
    /// Cheaper estimates of the same score, coarsest first, with which coordinate ascent begins.
    pub coarse: Vec<Coarse<'a>>,
    /// First candidates, beside random ones.
    pub starts: Vec<Vec<f64>>,
    /// Most sweeps: fewer where a score costs milliseconds.
    pub max_sweeps: usize,
    /// Least relative gain of a sweep that counts: no less than what the score is good to.
    pub tolerance: f64,
    /// Length up to which steps are short.
    pub short_step: f64,
    /// The exact score, if `objective` is a surrogate's.
    pub truth: Option<Truth<'a>>,
}

/// What decides between the last candidates of a search through a surrogate.
#[derive(Clone, Copy)]
pub(super) struct Truth<'a> {
    pub objective: &'a dyn Objective,
    /// Whether the best of them is refined.
    pub polish: bool,
}

/// The score estimated from a part of the samples.
pub(super) struct Coarse<'a> {
    pub objective: &'a dyn Objective,
    pub samples: u64,
    /// How many of the best found with it go on.
    pub finalists: usize,
}

/// A local stage.
struct Local<'a> {
    name: &'static str,
    objective: &'a dyn Objective,
    samples: Option<u64>,
    /// Finalists of the stage before; `None` for those of [`polish_starts`].
    finalists: Option<usize>,
    settings: CoordinateAscentSettings,
}

impl Terms<'_> {
    fn within_reason(&self, settings: CoordinateAscentSettings) -> CoordinateAscentSettings {
        CoordinateAscentSettings {
            max_sweeps: settings.max_sweeps.min(self.max_sweeps),
            tolerance: settings.tolerance.max(self.tolerance),
            short_step: self.short_step,
            ..settings
        }
    }

    /// The score of the global stage, with its number of samples.
    fn first(&self, optimise: &Optimise) -> (&dyn Objective, Option<u64>) {
        match (&optimise.optimiser, self.coarse.first()) {
            (OptimiserSettings::CoordinateAscent(_), Some(coarse)) => {
                (coarse.objective, Some(coarse.samples))
            }
            _ => (self.objective, self.samples),
        }
    }

    /// The stages after the global one.
    fn local_stages(&self, optimise: &Optimise) -> Vec<Local<'_>> {
        let polish = |objective| Local {
            name: "polish",
            objective,
            samples: self.samples,
            finalists: None,
            settings: self.within_reason(Default::default()),
        };
        let ascent = match (&optimise.optimiser, self.truth) {
            (_, Some(truth)) if truth.polish => return vec![polish(truth.objective)],
            (OptimiserSettings::Genetic(genetic), None) if genetic.polish => {
                return vec![polish(self.objective)];
            }
            (_, Some(_)) | (OptimiserSettings::Genetic(_), None) => return Vec::new(),
            (OptimiserSettings::CoordinateAscent(ascent), None) => ascent,
        };
        let settings = self.within_reason(ascent_settings(ascent));
        let finer = self.coarse.iter().skip(1);
        let finer = finer.map(|coarse| (coarse.objective, Some(coarse.samples)));
        let scores = finer.chain([(self.objective, self.samples)]);
        let stages = self.coarse.iter().zip(scores);
        stages
            .map(|(before, (objective, samples))| Local {
                name: "refine",
                objective,
                samples,
                finalists: Some(before.finalists),
                settings: CoordinateAscentSettings {
                    max_sweeps: settings.max_sweeps.min(REFINING_SWEEPS),
                    ..settings.clone()
                },
            })
            .collect()
    }
}

/// The best design found and how.
pub(super) struct Optimum {
    pub design: Design,
    /// It and the others whose score is the same to [`EQUAL`].
    pub equals: Vec<Design>,
    /// The stages in order, at least one.
    pub stages: Vec<Record>,
}

impl Optimum {
    /// The stage that ended the search.
    pub fn last(&self) -> &Record {
        &self.stages[self.stages.len() - 1]
    }

    pub fn score(&self) -> f64 {
        let last = self.last();
        last.rescored.unwrap_or(last.best_score)
    }

    pub fn evaluations(&self) -> u64 {
        self.stages.iter().map(|stage| stage.evaluations).sum()
    }

    /// Progress of all stages, evaluations counted through.
    pub fn history(&self) -> Vec<HistoryPoint> {
        let mut history = Vec::new();
        let mut before = 0;
        for stage in &self.stages {
            history.extend(stage.history.iter().map(|point| HistoryPoint {
                evaluations: point.evaluations + before,
                ..*point
            }));
            before += stage.evaluations;
        }
        let end = history.last().map(|point| HistoryPoint {
            evaluations: before,
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
    let (mut stages, mut candidates, mut saved) = match saved {
        // The snapshot holds the starts of its stage itself.
        Some(Stage::Local { before, snapshot }) => (before, Vec::new(), Some(snapshot)),
        other => {
            let mut ended = global_stage(optimise, terms, seed, other, session)?;
            if let Some(truth) = terms.truth {
                ended.rescore(truth.objective);
            }
            (vec![ended.record], ended.candidates, None)
        }
    };
    let all = terms.local_stages(optimise);
    for local in all.iter().skip(stages.len() - 1) {
        let ended = local_stage(local, &candidates, &stages, seed, saved.take(), session)?;
        candidates = ended.candidates;
        stages.push(ended.record);
    }
    let best = candidates[0].score;
    let equals = candidates.iter().filter(|c| c.score >= best * EQUAL);
    Ok(Optimum {
        design: terms.space.design(&candidates[0].x),
        equals: equals.map(|c| terms.space.design(&c.x)).collect(),
        stages,
    })
}

fn local_stage(
    local: &Local,
    candidates: &[Candidate],
    before: &[Record],
    seed: u64,
    saved: Option<Box<Snapshot<CoordinateAscent>>>,
    session: &Session,
) -> Result<Ended, RunError> {
    let starts = match local.finalists {
        None => polish_starts(candidates, local.objective, seed),
        Some(count) => apart(candidates, local.objective, count),
    };
    let seed = seed ^ before.len() as u64;
    let solver = CoordinateAscent::polish(&local.settings, seed, starts);
    let before = before.to_vec();
    let wrap = move |snapshot| Stage::Local {
        before: before.clone(),
        snapshot,
    };
    let name = match local.finalists {
        None => "polishing",
        Some(_) => "refining",
    };
    let mut ended = stage(local.objective, solver, saved, wrap, session, name)?;
    ended.record.stage = local.name.into();
    ended.record.samples = local.samples;
    Ok(ended)
}

fn ascent_settings(ascent: &super::settings::CoordinateAscent) -> CoordinateAscentSettings {
    CoordinateAscentSettings {
        restarts: ascent.restarts as usize,
        line_samples: ascent.line_samples as usize,
        scout_sweeps: ascent.scout_sweeps as usize,
        finalists: ascent.finalists as usize,
        max_sweeps: ascent.max_sweeps as usize,
        tolerance: ascent.tolerance,
        ..CoordinateAscentSettings::default()
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
    let (objective, samples) = terms.first(optimise);
    let starts = terms.starts.clone();
    let mut ended = match (&optimise.optimiser, saved) {
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
    }?;
    ended.record.stage = optimise.optimiser.method().into();
    ended.record.samples = samples;
    Ok(ended)
}

/// A search that was given some time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Timed {
    pub best_score: f64,
    pub evaluations: u64,
    pub seconds: f64,
    /// Whether it ended before its time was over.
    pub ended_by_itself: bool,
}

/// Runs the global stage of `optimise` alone for at most about `seconds`. Unlike everything else
/// its result depends on the machine.
///
/// # Errors
/// None is expected.
pub(super) fn search_for(
    optimise: &Optimise,
    terms: &Terms,
    seed: u64,
    seconds: f64,
) -> Result<Timed, RunError> {
    let objective = terms.objective;
    match &optimise.optimiser {
        OptimiserSettings::CoordinateAscent(ascent) => {
            let settings = terms.within_reason(ascent_settings(ascent));
            timed(
                objective,
                CoordinateAscent::new(settings, seed, Vec::new()),
                seconds,
            )
        }
        OptimiserSettings::Genetic(genetic) => {
            let solver = Genetic::new(genetic_settings(genetic), seed, Vec::new());
            timed(objective, solver, seconds)
        }
    }
}

fn timed<S>(objective: &dyn Objective, solver: S, seconds: f64) -> Result<Timed, RunError>
where
    S: Search + Clone + Serialize + DeserializeOwned + Send + Sync + 'static,
    S: for<'p> Solver<Maximise<'p>, SearchState>,
{
    let started = Instant::now();
    let over = Arc::new(AtomicBool::new(false));
    let raise = over.clone();
    let control = Control {
        interrupt: over,
        on_progress: Arc::new(move |_, _| {
            if started.elapsed().as_secs_f64() >= seconds {
                raise.store(true, Ordering::Relaxed);
            }
        }),
        on_snapshot: Arc::new(|_: &S, _: &SearchState| Ok(())),
    };
    let (snapshot, interrupted) = run_search(objective, solver, None, control)?;
    let solver = snapshot.solver;
    let best = solver.candidates().first().map(|best| best.score);
    Ok(Timed {
        best_score: best.unwrap_or(0.0),
        evaluations: solver.evaluations(),
        seconds: started.elapsed().as_secs_f64(),
        ended_by_itself: !interrupted,
    })
}

/// A stage that has run to its end.
struct Ended {
    candidates: Vec<Candidate>,
    record: Record,
}

impl Ended {
    /// Orders the candidates by `objective`, best first.
    fn rescore(&mut self, objective: &dyn Objective) {
        let points: Vec<Vec<f64>> = self.candidates.iter().map(|c| c.x.clone()).collect();
        for (candidate, score) in self.candidates.iter_mut().zip(objective.scores(&points)) {
            candidate.score = score;
        }
        self.candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
        self.record.rescored = self.candidates.first().map(|best| best.score);
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
        stage: String::new(),
        samples: None,
        best_score: candidates[0].score,
        evaluations: solver.evaluations(),
        history: solver.history().to_vec(),
        converged: solver.converged(),
        rescored: None,
    };
    Ok(Ended { candidates, record })
}

/// The best candidates that lie far enough from each other, `count` at most.
fn apart(candidates: &[Candidate], objective: &dyn Objective, count: usize) -> Vec<Vec<f64>> {
    let space = objective.space();
    let spans: Vec<f64> = space.variables.iter().map(|v| v.upper - v.lower).collect();
    let far = |a: &[f64], b: &[f64]| {
        let difference = space.difference(a, b);
        let shares = difference.iter().zip(&spans).map(|(d, s)| (d / s).abs());
        shares.fold(0.0, f64::max) > SPREAD
    };
    let mut starts: Vec<Vec<f64>> = Vec::new();
    for candidate in candidates.iter().take(20) {
        if starts.len() < count && starts.iter().all(|x| far(x, &candidate.x)) {
            starts.push(candidate.x.clone());
        }
    }
    starts
}

/// The best candidate, others far enough from it, and copies of the best a little off.
fn polish_starts(candidates: &[Candidate], objective: &dyn Objective, seed: u64) -> Vec<Vec<f64>> {
    let Some(best) = candidates.first() else {
        return Vec::new();
    };
    let space = objective.space();
    let spans: Vec<f64> = space.variables.iter().map(|v| v.upper - v.lower).collect();
    let mut starts = apart(candidates, objective, POLISHED - 2);
    let mut generator = sampling::stream(seed, u64::MAX);
    while starts.len() < POLISHED {
        let mut off = |span: &f64| 2.0 * SPREAD * span * (generator.random::<f64>() - 0.5);
        let step: Vec<f64> = spans.iter().map(&mut off).collect();
        starts.push(space.along(&best.x, &step, 1.0));
    }
    starts
}
