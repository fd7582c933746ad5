//! What every search method offers, and the loop that runs one.

use super::Maximise;
use crate::objective::Objective;
use argmin::core::checkpointing::{Checkpoint, CheckpointingFrequency};
use argmin::core::{
    Error, Executor, IterState, Solver, State, TerminationReason, TerminationStatus,
};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// argmin's state of a search: the best point so far and counters.
pub type SearchState = IterState<Vec<f64>, (), (), (), (), f64>;

/// A point and its score.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// Point of the box.
    pub x: Vec<f64>,
    /// Its score.
    pub score: f64,
}

/// Progress of a search after some evaluations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HistoryPoint {
    /// Evaluations of the objective so far.
    pub evaluations: u64,
    /// Best score so far.
    pub best: f64,
    /// Mean score of the current generation, for methods that have one.
    pub mean: Option<f64>,
}

/// A search method.
pub trait Search {
    /// Best candidates, best first, at least one once the search has run.
    fn candidates(&self) -> Vec<Candidate>;
    /// Evaluations of the objective so far.
    fn evaluations(&self) -> u64;
    /// Progress so far.
    fn history(&self) -> &[HistoryPoint];
    /// Whether the search ended because nothing better was in reach (rather than at its limit).
    fn converged(&self) -> bool;
    /// Share of the work done, in [0, 1], as far as it is known.
    fn progress(&self) -> f64;
    /// The flag that stops the search at the next iteration.
    fn set_interrupt(&mut self, flag: Arc<AtomicBool>);
}

/// A search stopped between two iterations; running it on gives the uninterrupted result.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Snapshot<S> {
    /// The method with all its random streams.
    pub solver: S,
    /// argmin's state.
    pub state: SearchState,
}

/// Hears progress in [0, 1] and the best score so far.
pub type OnProgress = Arc<dyn Fn(f64, f64) + Send + Sync>;

/// Stores a snapshot when it sees fit.
pub type OnSnapshot<S> = Arc<dyn Fn(&S, &SearchState) -> Result<(), Error> + Send + Sync>;

/// What the caller of a search hears and decides while it runs.
pub struct Control<S> {
    /// Raised to stop at the next iteration.
    pub interrupt: Arc<AtomicBool>,
    /// Called after every iteration.
    pub on_progress: OnProgress,
    /// Called after every iteration.
    pub on_snapshot: OnSnapshot<S>,
}

/// Runs `solver` on `objective` to its end, or from `snapshot` on. Returns where it stopped and
/// whether that was by interrupt.
///
/// # Errors
/// Those of the snapshot callback; the objective itself cannot fail.
pub fn run_search<S>(
    objective: &dyn Objective,
    solver: S,
    snapshot: Option<Snapshot<S>>,
    control: Control<S>,
) -> Result<(Snapshot<S>, bool), Error>
where
    S: Search + Clone + Serialize + DeserializeOwned + 'static,
    S: for<'p> Solver<Maximise<'p>, SearchState>,
{
    let (mut solver, mut state) = match snapshot {
        Some(snapshot) => (snapshot.solver, snapshot.state),
        None => (solver, SearchState::new().max_iters(u64::MAX)),
    };
    solver.set_interrupt(control.interrupt.clone());
    state.termination_status = TerminationStatus::NotTerminated;
    let hooks = Hooks {
        on_snapshot: control.on_snapshot,
        on_progress: control.on_progress,
    };
    let result = Executor::new(Maximise(objective), solver)
        .configure(|_| state)
        .ctrlc(false)
        .timer(false)
        .checkpointing(hooks)
        .run()?;
    let interrupted = matches!(
        result.state.termination_status,
        TerminationStatus::Terminated(TerminationReason::Interrupt)
    );
    let snapshot = Snapshot {
        solver: result.solver,
        state: result.state,
    };
    Ok((snapshot, interrupted))
}

/// Termination of a search that polls its interrupt flag.
pub(super) fn status(interrupt: &Option<Arc<AtomicBool>>, done: bool) -> TerminationStatus {
    let raised = |flag: &Arc<AtomicBool>| flag.load(Ordering::Relaxed);
    if done {
        TerminationStatus::Terminated(TerminationReason::SolverConverged)
    } else if interrupt.as_ref().is_some_and(raised) {
        TerminationStatus::Terminated(TerminationReason::Interrupt)
    } else {
        TerminationStatus::NotTerminated
    }
}

struct Hooks<S> {
    on_snapshot: OnSnapshot<S>,
    on_progress: OnProgress,
}

impl<S: Search> Checkpoint<S, SearchState> for Hooks<S> {
    fn save(&self, solver: &S, state: &SearchState) -> Result<(), Error> {
        (self.on_progress)(solver.progress(), -state.get_best_cost());
        (self.on_snapshot)(solver, state)
    }

    fn load(&self) -> Result<Option<(S, SearchState)>, Error> {
        // argmin would let a loaded state override the configured one: resuming is ours.
        Ok(None)
    }

    fn frequency(&self) -> CheckpointingFrequency {
        CheckpointingFrequency::Always
    }
}

/// The objective behind argmin's problem.
pub(super) fn objective<'p>(
    problem: &mut argmin::core::Problem<Maximise<'p>>,
) -> Result<&'p dyn Objective, Error> {
    let inner = problem.problem.as_ref();
    inner
        .map(|maximise| maximise.0)
        .ok_or_else(|| Error::msg("argmin took the problem away"))
}

/// The state with the current best candidate.
pub(super) fn with_best(state: SearchState, best: Option<&Candidate>) -> SearchState {
    match best {
        Some(best) => state.param(best.x.clone()).cost(-best.score),
        None => state,
    }
}
