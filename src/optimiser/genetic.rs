//! The genetic algorithm of [S3 §IV], with elitism and tournament selection.
//!
//! Crossover averages the two parents' limits; mutation replaces one joint's limits by random
//! ones. Averages on the circle go the short way round.

use super::Maximise;
use super::search::{self, Candidate, HistoryPoint, Search, SearchState, status};
use crate::objective::{Objective, SearchSpace};
use crate::sampling;
use argmin::core::{Error, KV, Problem, Solver, State, TerminationStatus};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Settings of [`Genetic`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GeneticSettings {
    /// Candidates of a generation. Too few lose variety; time grows in proportion. 100.
    pub population: usize,
    /// Generations after which the search ends. 200.
    pub generations: usize,
    /// Best candidates that pass unchanged. At least 1 keeps the best. 2.
    pub elite: usize,
    /// Candidates drawn for one parent, the best of which is taken. Larger converges sooner, to
    /// nearer maxima. 3.
    pub tournament: usize,
    /// Probability that a child averages two parents rather than copying one. 0.9.
    pub crossover_rate: f64,
    /// Probability that one of a child's joints gets random limits. 0.3.
    pub mutation_rate: f64,
    /// Generations without a better candidate after which the search ends. 50.
    pub patience: usize,
}

impl Default for GeneticSettings {
    fn default() -> Self {
        GeneticSettings {
            population: 100,
            generations: 200,
            elite: 2,
            tournament: 3,
            crossover_rate: 0.9,
            mutation_rate: 0.3,
            patience: 50,
        }
    }
}

/// Random points drawn for each place in the first generation: where most limits leave no
/// fault-tolerant workspace at all, a single draw leaves hardly a parent.
const DRAWS: usize = 10;

/// The solver.
#[derive(Clone, Serialize, Deserialize)]
pub struct Genetic {
    settings: GeneticSettings,
    generator: ChaCha8Rng,
    starts: Vec<Vec<f64>>,
    population: Vec<Candidate>,
    /// Best of all generations; without elitism a later one may be worse.
    best: Option<Candidate>,
    generation: usize,
    last_gain: usize,
    evaluations: u64,
    history: Vec<HistoryPoint>,
    #[serde(skip)]
    interrupt: Option<Arc<AtomicBool>>,
}

impl Genetic {
    /// A search whose first generation holds `starts` and random candidates.
    pub fn new(settings: GeneticSettings, seed: u64, starts: Vec<Vec<f64>>) -> Genetic {
        Genetic {
            settings,
            generator: sampling::stream(seed, 0),
            starts,
            population: Vec::new(),
            best: None,
            generation: 0,
            last_gain: 0,
            evaluations: 0,
            history: Vec::new(),
            interrupt: None,
        }
    }

    /// Scores in parallel; order and therefore results do not depend on the threads.
    fn evaluate(&mut self, objective: &dyn Objective, points: Vec<Vec<f64>>) -> Vec<Candidate> {
        self.evaluations += points.len() as u64;
        let scores = objective.scores(&points);
        let pairs = points.into_iter().zip(scores);
        pairs.map(|(x, score)| Candidate { x, score }).collect()
    }

    /// Replaces the population, best first; ties keep their order.
    fn settle(&mut self, mut population: Vec<Candidate>) {
        population.sort_by(|a, b| b.score.total_cmp(&a.score));
        let before = self.best.as_ref().map(|best| best.score);
        if before.is_none_or(|score| population[0].score > score) {
            self.last_gain = self.generation;
            self.best = Some(population[0].clone());
        }
        let mean = population.iter().map(|c| c.score).sum::<f64>() / population.len() as f64;
        self.history.push(HistoryPoint {
            evaluations: self.evaluations,
            best: before.map_or(population[0].score, |score| score.max(population[0].score)),
            mean: Some(mean),
        });
        self.population = population;
    }

    /// Draws all children serially from the one stream.
    fn children(&mut self, space: &SearchSpace) -> Vec<Vec<f64>> {
        let elite = self.settings.elite.min(self.population.len());
        let count = self.settings.population - elite.min(self.settings.population - 1);
        (0..count).map(|_| self.child(space)).collect()
    }

    fn child(&mut self, space: &SearchSpace) -> Vec<f64> {
        let mother = self.parent();
        let mut x = self.population[mother].x.clone();
        if self.generator.random_bool(self.settings.crossover_rate) {
            let father = self.parent();
            let way = space.difference(&x, &self.population[father].x);
            x = space.along(&x, &way, 0.5);
        }
        if self.generator.random_bool(self.settings.mutation_rate) {
            let block = self.generator.random_range(0..space.blocks.len());
            let fresh = space.random(&mut self.generator);
            for &k in &space.blocks[block] {
                x[k] = fresh[k];
            }
        }
        x
    }

    /// Index of the best of a few random candidates; the population is sorted.
    fn parent(&mut self) -> usize {
        let n = self.population.len();
        let draws = self.settings.tournament.max(1);
        let drawn = (0..draws).map(|_| self.generator.random_range(0..n));
        drawn.min().unwrap_or(0)
    }

    fn stalled(&self) -> bool {
        self.generation - self.last_gain >= self.settings.patience
    }
}

impl Solver<Maximise<'_>, SearchState> for Genetic {
    fn name(&self) -> &str {
        "genetic algorithm"
    }

    fn init(
        &mut self,
        problem: &mut Problem<Maximise<'_>>,
        state: SearchState,
    ) -> Result<(SearchState, Option<KV>), Error> {
        let objective = search::objective(problem)?;
        let mut points = self.starts.clone();
        let wanted = self.settings.population.max(points.len());
        while points.len() < DRAWS * wanted {
            points.push(objective.space().random(&mut self.generator));
        }
        let mut population = self.evaluate(objective, points);
        population.sort_by(|a, b| b.score.total_cmp(&a.score));
        population.truncate(wanted);
        self.settle(population);
        Ok((search::with_best(state, self.best.as_ref()), None))
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<Maximise<'_>>,
        state: SearchState,
    ) -> Result<(SearchState, Option<KV>), Error> {
        let objective = search::objective(problem)?;
        let children = self.children(objective.space());
        self.generation += 1;
        let mut next = self.evaluate(objective, children);
        let missing = self.settings.population.saturating_sub(next.len());
        next.extend(self.population.iter().take(missing).cloned());
        self.settle(next);
        Ok((search::with_best(state, self.best.as_ref()), None))
    }

    fn terminate(&mut self, state: &SearchState) -> TerminationStatus {
        let ended = self.generation >= self.settings.generations || self.stalled();
        status(&self.interrupt, state.get_iter() > 0 && ended)
    }
}

impl Search for Genetic {
    fn candidates(&self) -> Vec<Candidate> {
        let newer = self
            .population
            .iter()
            .skip_while(|c| self.best.as_ref() == Some(c));
        self.best.iter().chain(newer).cloned().collect()
    }

    fn evaluations(&self) -> u64 {
        self.evaluations
    }

    fn history(&self) -> &[HistoryPoint] {
        &self.history
    }

    fn converged(&self) -> bool {
        self.stalled()
    }

    fn progress(&self) -> f64 {
        self.generation as f64 / self.settings.generations.max(1) as f64
    }

    fn set_interrupt(&mut self, flag: Arc<AtomicBool>) {
        self.interrupt = Some(flag);
    }
}
