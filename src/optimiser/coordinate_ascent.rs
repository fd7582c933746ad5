//! Coordinate ascent with random restarts [S4 §IV].
//!
//! Every restart improves its point along one direction after the other. The first sweeps scan
//! the whole box along each direction, so that jumps and distant maxima are seen; then the best
//! restarts go on with short adaptive steps.
//!
//! A score like S_F has sharp ridges, on which moves along coordinates stall: several kinks meet
//! in a curve and every coordinate step leaves it downhill. So each sweep ends with moves that
//! know the ridge: the total move of the last sweep and of the last few, the ways to the nearest
//! other restarts (which stall on the same ridge elsewhere), and some random directions.

use super::line_search::{Found, Line};
use super::search::{Candidate, HistoryPoint, Search, SearchState, status};
use super::{Maximise, search};
use crate::objective::{Objective, SearchSpace, Variable};
use crate::sampling;
use argmin::core::{Error, KV, Problem, Solver, State, TerminationStatus};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Settings of [`CoordinateAscent`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoordinateAscentSettings {
    /// Random starting points. Too few miss the highest maximum; time grows in proportion. 32.
    pub restarts: usize,
    /// Points of a scan along one direction, both ends included. Too few miss narrow maxima. 24.
    pub line_samples: usize,
    /// Sweeps that scan the whole box, for all restarts. 2.
    pub scout_sweeps: usize,
    /// Restarts that go on after the scouting sweeps. 6.
    pub finalists: usize,
    /// Sweeps after which a restart ends even if it still improves. 100.
    pub max_sweeps: usize,
    /// A restart has converged when two sweeps in a row gain less than this share of the score
    /// while its steps are short. Too large: it stops on a slope; too small: time. 1e-9.
    pub tolerance: f64,
    /// Steps up to this length are short. 1e-5.
    pub short_step: f64,
}

impl Default for CoordinateAscentSettings {
    fn default() -> Self {
        CoordinateAscentSettings {
            restarts: 32,
            line_samples: 24,
            scout_sweeps: 2,
            finalists: 6,
            max_sweeps: 100,
            tolerance: 1e-9,
            short_step: 1e-5,
        }
    }
}

/// Random points drawn for each restart, of which the best starts: a flat score (zero almost
/// everywhere) gives a single draw no slope to climb.
const DRAWS: usize = 16;

/// Share of the box along a direction with which short steps begin when there was no scan.
const FIRST_STEP: f64 = 0.02;

/// Sweeps over which the longer total move reaches back.
const TRAIL: usize = 5;

/// Nearest other restarts whose direction a sweep tries.
const PEERS: usize = 3;

/// The solver.
#[derive(Clone, Serialize, Deserialize)]
pub struct CoordinateAscent {
    settings: CoordinateAscentSettings,
    seed: u64,
    starts: Vec<Vec<f64>>,
    climbers: Vec<Climber>,
    evaluations: u64,
    history: Vec<HistoryPoint>,
    #[serde(skip)]
    interrupt: Option<Arc<AtomicBool>>,
}

/// One restart.
#[derive(Clone, Serialize, Deserialize)]
struct Climber {
    best: Candidate,
    generator: ChaCha8Rng,
    steps: Vec<f64>,
    sweep: usize,
    move_index: usize,
    sweep_start: Candidate,
    /// Points at the starts of the last few sweeps, oldest first.
    trail: Vec<Vec<f64>>,
    quiet_sweeps: usize,
    done: bool,
    converged: bool,
    evaluations: u64,
}

impl CoordinateAscent {
    /// A search from `settings.restarts` random points, in addition to `starts`.
    pub fn new(
        settings: CoordinateAscentSettings,
        seed: u64,
        starts: Vec<Vec<f64>>,
    ) -> CoordinateAscent {
        CoordinateAscent {
            settings,
            seed,
            starts,
            climbers: Vec::new(),
            evaluations: 0,
            history: Vec::new(),
            interrupt: None,
        }
    }

    /// A local search from `starts` alone: no scans, short steps only.
    pub fn polish(
        settings: &CoordinateAscentSettings,
        seed: u64,
        starts: Vec<Vec<f64>>,
    ) -> CoordinateAscent {
        let settings = CoordinateAscentSettings {
            restarts: 0,
            scout_sweeps: 0,
            finalists: starts.len(),
            ..settings.clone()
        };
        CoordinateAscent::new(settings, seed, starts)
    }

    fn begin(&mut self, objective: &dyn Objective) {
        let given = self.starts.len();
        let count = given + self.settings.restarts;
        let space = objective.space();
        self.climbers = (0..count)
            .into_par_iter()
            .map(|k| {
                let generator = sampling::stream(self.seed, k as u64);
                Climber::new(objective, space, self.starts.get(k), generator)
            })
            .collect();
    }

    /// Ends all restarts but the best when the scouting sweeps are over.
    fn choose_finalists(&mut self) {
        let scouts = self.settings.scout_sweeps;
        let scouting = self.climbers.iter().any(|c| !c.done && c.sweep < scouts);
        let chosen = self.climbers.iter().any(|c| c.sweep > scouts);
        if scouts == 0 || scouting || chosen {
            return;
        }
        let mut order: Vec<usize> = (0..self.climbers.len()).collect();
        order.sort_by(|&a, &b| {
            let score = |k: usize| self.climbers[k].best.score;
            score(b).total_cmp(&score(a))
        });
        for &k in order.iter().skip(self.settings.finalists.max(1)) {
            self.climbers[k].done = true;
        }
    }

    fn note_progress(&mut self) {
        self.evaluations = self.climbers.iter().map(|c| c.evaluations).sum();
        let scores = self.climbers.iter().map(|c| c.best.score);
        let best = scores.fold(0.0, f64::max);
        if self.history.last().is_none_or(|last| last.best < best) {
            self.history.push(HistoryPoint {
                evaluations: self.evaluations,
                best,
                mean: None,
            });
        }
    }

    fn best(&self) -> Option<&Candidate> {
        let all = self.climbers.iter().map(|c| &c.best);
        all.reduce(|a, b| if b.score > a.score { b } else { a })
    }
}

impl Climber {
    fn new(
        objective: &dyn Objective,
        space: &SearchSpace,
        start: Option<&Vec<f64>>,
        mut generator: ChaCha8Rng,
    ) -> Climber {
        let drawn = match start {
            Some(x) => vec![x.clone()],
            None => (0..DRAWS).map(|_| space.random(&mut generator)).collect(),
        };
        let mut best = Candidate {
            x: drawn[0].clone(),
            score: f64::NEG_INFINITY,
        };
        let evaluations = drawn.len() as u64;
        for x in drawn {
            let score = objective.score(&x);
            if score > best.score {
                best = Candidate { x, score };
            }
        }
        let moves = space.directions.len() + 2 + PEERS + space.dimension();
        Climber {
            sweep_start: best.clone(),
            trail: vec![best.x.clone()],
            best,
            generator,
            steps: vec![f64::NAN; moves],
            sweep: 0,
            move_index: 0,
            quiet_sweeps: 0,
            done: false,
            converged: false,
            evaluations,
        }
    }

    /// One search along one line.
    fn advance(
        &mut self,
        objective: &dyn Objective,
        settings: &CoordinateAscentSettings,
        peers: &[Vec<f64>],
    ) {
        let space = objective.space();
        let index = self.move_index;
        let direction = self.direction(space, peers);
        let range = space.travel(&self.best.x, &direction);
        if range[1] - range[0] > 0.0 {
            let line = Line {
                objective,
                x: &self.best.x,
                score: self.best.score,
                direction: &direction,
                range,
            };
            let scans = self.sweep < settings.scout_sweeps && index < space.directions.len();
            let found = if scans {
                line.exact(FIRST_STEP * (range[1] - range[0]))
                    .unwrap_or_else(|| line.scan(settings.line_samples.max(4)))
            } else {
                let step = self.step_length(index, range);
                line.exact_near(step).unwrap_or_else(|| line.step(step))
            };
            self.accept(space, &direction, found);
        }
        self.move_index += 1;
        if self.move_index == self.steps.len() {
            self.end_sweep(settings, space.directions.len());
        }
    }

    /// The direction of the current move: the space's own, then the total moves, then to peers,
    /// then random ones.
    fn direction(&mut self, space: &SearchSpace, peers: &[Vec<f64>]) -> Vec<f64> {
        let own = space.directions.len();
        match self.move_index {
            k if k < own => space.directions[k].clone(),
            k if k == own => space.difference(&self.sweep_start.x, &self.best.x),
            k if k == own + 1 => space.difference(&self.trail[0], &self.best.x),
            k if k < own + 2 + PEERS => self.to_peer(space, peers, k - own - 2),
            _ => self.random_direction(space),
        }
    }

    /// Towards the peer of the given rank by distance; no direction if there are fewer.
    fn to_peer(&self, space: &SearchSpace, peers: &[Vec<f64>], rank: usize) -> Vec<f64> {
        let ways = peers.iter().map(|x| space.difference(&self.best.x, x));
        let mut ways: Vec<(f64, Vec<f64>)> = ways.map(|way| (norm(&way), way)).collect();
        ways.retain(|(length, _)| *length > 0.0);
        ways.sort_by(|a, b| a.0.total_cmp(&b.0));
        match ways.into_iter().nth(rank) {
            Some((_, way)) => way,
            None => vec![0.0; self.best.x.len()],
        }
    }

    fn random_direction(&mut self, space: &SearchSpace) -> Vec<f64> {
        let draw = |v: &Variable| (v.upper - v.lower) * (self.generator.random::<f64>() - 0.5);
        let mut direction: Vec<f64> = space.variables.iter().map(draw).collect();
        let length = norm(&direction);
        if length > 0.0 {
            direction.iter_mut().for_each(|d| *d /= length);
        }
        direction
    }

    fn step_length(&self, index: usize, range: [f64; 2]) -> f64 {
        let span = range[1] - range[0];
        let step = self.steps[index];
        if step.is_nan() {
            FIRST_STEP * span
        } else {
            step.min(0.5 * span)
        }
    }

    fn accept(&mut self, space: &SearchSpace, direction: &[f64], found: Found) {
        self.steps[self.move_index] = found.step.max(1e-12);
        self.evaluations += found.evaluations;
        if found.score > self.best.score {
            let x = space.along(&self.best.x, direction, found.t);
            self.best = Candidate {
                x,
                score: found.score,
            };
        }
    }

    fn end_sweep(&mut self, settings: &CoordinateAscentSettings, own_directions: usize) {
        let gain = self.best.score - self.sweep_start.score;
        let quiet = gain <= settings.tolerance * self.best.score.abs();
        let short = |step: &f64| step.is_nan() || *step <= settings.short_step;
        let settled = quiet && self.steps[..own_directions].iter().all(short);
        self.quiet_sweeps = if settled { self.quiet_sweeps + 1 } else { 0 };
        self.sweep += 1;
        self.move_index = 0;
        self.sweep_start = self.best.clone();
        self.trail.push(self.best.x.clone());
        if self.trail.len() > TRAIL {
            self.trail.remove(0);
        }
        self.converged = self.quiet_sweeps >= 2;
        self.done |= self.converged || self.sweep >= settings.max_sweeps;
    }
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

impl Solver<Maximise<'_>, SearchState> for CoordinateAscent {
    fn name(&self) -> &str {
        "coordinate ascent"
    }

    fn init(
        &mut self,
        problem: &mut Problem<Maximise<'_>>,
        state: SearchState,
    ) -> Result<(SearchState, Option<KV>), Error> {
        self.begin(search::objective(problem)?);
        self.note_progress();
        Ok((search::with_best(state, self.best()), None))
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<Maximise<'_>>,
        state: SearchState,
    ) -> Result<(SearchState, Option<KV>), Error> {
        let objective = search::objective(problem)?;
        let settings = &self.settings;
        let active = self.climbers.iter().filter(|climber| !climber.done);
        let peers: Vec<Vec<f64>> = active.map(|climber| climber.best.x.clone()).collect();
        self.climbers
            .par_iter_mut()
            .filter(|climber| !climber.done)
            .for_each(|climber| climber.advance(objective, settings, &peers));
        self.choose_finalists();
        self.note_progress();
        Ok((search::with_best(state, self.best()), None))
    }

    fn terminate(&mut self, state: &SearchState) -> TerminationStatus {
        let started = state.get_iter() > 0 || !self.climbers.is_empty();
        status(
            &self.interrupt,
            started && self.climbers.iter().all(|c| c.done),
        )
    }
}

impl Search for CoordinateAscent {
    fn candidates(&self) -> Vec<Candidate> {
        let mut all: Vec<Candidate> = self.climbers.iter().map(|c| c.best.clone()).collect();
        all.sort_by(|a, b| b.score.total_cmp(&a.score));
        all
    }

    fn evaluations(&self) -> u64 {
        self.evaluations
    }

    fn history(&self) -> &[HistoryPoint] {
        &self.history
    }

    fn converged(&self) -> bool {
        let best = self.best().map(|b| b.score);
        let of_best = |c: &&Climber| Some(c.best.score) == best;
        self.climbers.iter().filter(of_best).any(|c| c.converged)
    }

    fn progress(&self) -> f64 {
        let scouts = self.settings.scout_sweeps as f64;
        let last = self.settings.max_sweeps as f64;
        let share = |c: &Climber| {
            if c.done {
                1.0
            } else {
                (c.sweep as f64 / (scouts + 0.3 * last)).min(0.99)
            }
        };
        let total: f64 = self.climbers.iter().map(share).sum();
        total / self.climbers.len().max(1) as f64
    }

    fn set_interrupt(&mut self, flag: Arc<AtomicBool>) {
        self.interrupt = Some(flag);
    }
}
