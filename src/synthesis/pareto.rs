//! Robots between which only the user can choose: NSGA-II over links and limits together.
//!
//! Links vary by blending and Gaussian steps; limits come from the better parent and are refitted
//! for S_F, widened for more use before a failure (narrowed for more margin), or moved at random. Samples are renewed every
//! few generations and the population measured again, so that nobody lives on luck.

use super::assessment::{Care, DesignProblem, Draft, Look};
use super::finalists::REPLICATES;
use super::link_space::Links;
use super::measures::{Measures, Merit};
use super::seeds::{Purpose, sample_seed};
use crate::optimiser::{crowding, ranks, survivors};
use crate::sampling::stream;
use crate::workspace::{ArtificialLimits, JointLimit};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// How long and how carefully is searched.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParetoSettings {
    /// Random robots, of which the best form the first population.
    pub screened: u32,
    /// Robots in the population.
    pub population: u32,
    /// Generations.
    pub generations: u32,
    /// Task points for each robot.
    pub samples: u32,
    /// Task points for each robot of the front at the end.
    pub report_samples: u32,
}

/// A robot of the front, measured on samples that the search has not seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrontRobot {
    /// The robot; its own measures are the search's and biased.
    pub draft: Draft,
    /// Its merits on the report's samples.
    pub held_out: Measures,
}

/// The search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParetoSearch {
    settings: ParetoSettings,
    merits: Vec<Merit>,
    seed: u64,
    screened: u32,
    generation: u32,
    population: Vec<Draft>,
    /// Merits of everything measured, for the picture.
    seen: Vec<Vec<f64>>,
    front: Vec<FrontRobot>,
    measured: usize,
    evaluations: u64,
    /// Robots left out because the bounds keep them from the reach.
    off_reach: u64,
    starts: Vec<Links>,
}

/// Why a new robot has no draft.
enum LeftOut {
    /// The bounds keep it from the reach.
    OffReach,
    /// It has no workspace to speak of.
    Nothing,
}

/// Random robots of one step.
const BATCH: u32 = 32;
/// Generations that share their task points.
const RENEWED: u32 = 4;
/// Standard deviation of steps in coordinates of links.
const STEP: f64 = 0.06;
/// Probability that one coordinate makes such a step.
const MUTATED: f64 = 0.35;
/// Largest turn of one end of limits that is moved at random, radians.
const TURN: f64 = 0.4;
/// How much wider limits may become at once, as a share.
const WIDENED: f64 = 0.5;
/// Robots of the front that are measured in one step.
const REPORTED: usize = 4;

impl ParetoSearch {
    /// A search for robots that trade `merits` (two or more) against each other.
    pub fn new(
        settings: ParetoSettings,
        merits: Vec<Merit>,
        seed: u64,
        starts: Vec<Links>,
    ) -> ParetoSearch {
        ParetoSearch {
            settings,
            merits,
            seed,
            screened: 0,
            generation: 0,
            population: Vec::new(),
            seen: Vec::new(),
            front: Vec::new(),
            measured: 0,
            evaluations: 0,
            off_reach: 0,
            starts,
        }
    }

    /// Whether there is nothing left to do.
    pub fn is_done(&self) -> bool {
        self.generation >= self.settings.generations && self.measured >= self.population.len()
    }

    /// Goes one step further.
    pub fn advance(&mut self, problem: &DesignProblem) {
        if self.screened < self.settings.screened + self.starts.len() as u32 {
            self.screen(problem);
        } else if self.generation < self.settings.generations {
            self.breed(problem);
        } else if self.measured < self.population.len() {
            self.measure(problem);
        }
    }

    /// Share of the work done.
    pub fn progress(&self) -> f64 {
        let s = &self.settings;
        let all = s.screened / 2 + s.generations * s.population;
        let done = self.screened / 2 + self.generation * s.population;
        let searched = 0.9 * f64::from(done) / f64::from(all.max(1));
        let count = self.population.len().max(1);
        searched + 0.1 * self.measured as f64 / count as f64
    }

    /// The merits that are traded.
    pub fn merits(&self) -> &[Merit] {
        &self.merits
    }

    /// The front on held-out samples, once the search is done: robots that no other dominates.
    pub fn front(&self) -> Vec<&FrontRobot> {
        let merits = |robot: &FrontRobot| merit_values(&robot.held_out, &self.merits);
        let points: Vec<Vec<f64>> = self.front.iter().map(merits).collect();
        let ranks = ranks(&points);
        let kept = self.front.iter().zip(ranks).filter(|(_, rank)| *rank == 0);
        let mut front: Vec<&FrontRobot> = kept.map(|(robot, _)| robot).collect();
        let first = |robot: &FrontRobot| merit_values(&robot.held_out, &self.merits)[0];
        front.sort_by(|a, b| first(b).total_cmp(&first(a)));
        front
    }

    /// The best of the population by the score of `problem` on held-out samples, at most `count`.
    pub fn leaders(&self, problem: &DesignProblem, count: usize) -> Vec<Draft> {
        let score = |robot: &FrontRobot| problem.score(&robot.held_out);
        let mut robots: Vec<&FrontRobot> = self.front.iter().collect();
        robots.sort_by(|a, b| score(b).total_cmp(&score(a)));
        let leaders = robots.into_iter().take(count);
        leaders.map(|robot| robot.draft.clone()).collect()
    }

    /// Merits of everything measured in the search.
    pub fn seen(&self) -> &[Vec<f64>] {
        &self.seen
    }

    /// Robots assessed so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Robots left out because the bounds keep them from the reach.
    pub fn off_reach(&self) -> u64 {
        self.off_reach
    }

    fn look(&self) -> Look {
        let number = u64::from(self.generation / RENEWED);
        Look {
            samples: self.settings.samples,
            seed: sample_seed(self.seed, Purpose::Generation, number),
            replicates: 1,
        }
    }

    fn screen(&mut self, problem: &DesignProblem) {
        let all = self.settings.screened + self.starts.len() as u32;
        let numbers = self.screened..(self.screened + BATCH).min(all);
        let look = self.look();
        let draft = |number: u32| {
            let links = match self.starts.get(number as usize) {
                Some(links) => links.clone(),
                None => problem.links.numbered(self.seed, number),
            };
            if !problem.links.has_reach(&links) {
                return Err(LeftOut::OffReach);
            }
            match problem.verdict(&links) {
                Some(_) => Err(LeftOut::Nothing),
                None => {
                    let draft = problem.draft(&links, &[], look, Care::Scratch);
                    draft.ok_or(LeftOut::Nothing)
                }
            }
        };
        let looked: Vec<Result<Draft, LeftOut>> =
            numbers.clone().into_par_iter().map(draft).collect();
        self.take(problem, looked);
        self.screened = numbers.end;
    }

    /// Joins `drafts` to the population and lets the fittest survive.
    fn add(&mut self, problem: &DesignProblem, drafts: Vec<Draft>) {
        let new: Vec<Vec<f64>> = drafts.iter().map(|d| self.point(problem, d)).collect();
        self.seen.extend(new);
        let all: Vec<Draft> = std::mem::take(&mut self.population)
            .into_iter()
            .chain(drafts)
            .collect();
        let points: Vec<Vec<f64>> = all.iter().map(|d| self.point(problem, d)).collect();
        let kept = survivors(&points, self.settings.population as usize);
        self.population = kept.into_iter().map(|k| all[k].clone()).collect();
    }

    /// Merits, lowered where a bound is missed.
    fn point(&self, problem: &DesignProblem, draft: &Draft) -> Vec<f64> {
        let discount = problem.discount(&draft.measures);
        let values = merit_values(&draft.measures, &self.merits);
        values.into_iter().map(|value| value * discount).collect()
    }

    fn breed(&mut self, problem: &DesignProblem) {
        let look = self.look();
        if self.generation.is_multiple_of(RENEWED) {
            let again = |draft: &Draft| problem.measured_apart(&draft.links, &draft.limits, look);
            let renewed: Vec<Draft> = self.population.par_iter().filter_map(again).collect();
            self.evaluations += self.population.len() as u64;
            self.population = renewed;
        }
        let points: Vec<Vec<f64>> = self
            .population
            .iter()
            .map(|d| self.point(problem, d))
            .collect();
        let rank = ranks(&points);
        let crowd = crowding(&points, &rank);
        let fitter = |a: usize, b: usize| {
            let order = rank[a].cmp(&rank[b]).then(crowd[b].total_cmp(&crowd[a]));
            if order.is_le() { a } else { b }
        };
        let child = |number: u32| {
            let id = u64::from(self.generation) << 32 | u64::from(number);
            let mut rng = stream(sample_seed(self.seed, Purpose::Draw, id), 0);
            let count = self.population.len();
            let mut pick = || fitter(rng.random_range(0..count), rng.random_range(0..count));
            let [a, b] = [pick(), pick()].map(|k| &self.population[k]);
            self.child(problem, a, b, look, &mut rng)
        };
        if self.population.is_empty() {
            self.generation = self.settings.generations;
            return;
        }
        let numbers = 0..self.settings.population;
        let children: Vec<Result<Draft, LeftOut>> = numbers.into_par_iter().map(child).collect();
        self.take(problem, children);
        self.generation += 1;
    }

    /// Counts new robots and joins them to the population.
    fn take(&mut self, problem: &DesignProblem, looked: Vec<Result<Draft, LeftOut>>) {
        self.evaluations += looked.len() as u64;
        let drafts = looked.into_iter().filter_map(|looked| match looked {
            Ok(draft) => Some(draft),
            Err(LeftOut::Nothing) => None,
            Err(LeftOut::OffReach) => {
                self.off_reach += 1;
                None
            }
        });
        let drafts = drafts.collect();
        self.add(problem, drafts);
    }

    fn child(
        &self,
        problem: &DesignProblem,
        a: &Draft,
        b: &Draft,
        look: Look,
        rng: &mut ChaCha8Rng,
    ) -> Result<Draft, LeftOut> {
        let links = vary(problem, &a.links, &b.links, rng);
        if !problem.links.has_reach(&links) {
            return Err(LeftOut::OffReach);
        }
        let action: f64 = rng.random();
        let limits = match action {
            x if x < 0.5 => {
                let starts = [a.limits.clone()];
                let draft = problem.draft(&links, &starts, look, Care::Refit);
                return draft.ok_or(LeftOut::Nothing);
            }
            x if x < 0.75 => {
                let wider = 1.0 + WIDENED * rng.random::<f64>();
                // Narrower limits leave a wider margin.
                let is_narrowed = self.merits.contains(&Merit::Margin) && rng.random::<bool>();
                let factor = if is_narrowed { 1.0 / wider } else { wider };
                widened(&a.limits, factor, problem.min_width)
            }
            _ => moved(&a.limits, problem.min_width, rng),
        };
        let draft = problem.measured_apart(&links, &limits, look);
        draft.ok_or(LeftOut::Nothing)
    }

    /// Measures a few robots of the last population on samples of their own.
    fn measure(&mut self, problem: &DesignProblem) {
        let look = Look {
            samples: self.settings.report_samples,
            seed: sample_seed(self.seed, Purpose::Report, 0),
            replicates: REPLICATES,
        };
        let end = (self.measured + REPORTED).min(self.population.len());
        // Only a front is reported from here.
        let problem = match self.merits.len() {
            1 => problem.clone(),
            _ => problem.with_all_merits(),
        };
        for draft in &self.population[self.measured..end] {
            if let Some(again) = problem.measured(&draft.links, &draft.limits, look) {
                self.front.push(FrontRobot {
                    held_out: again.measures,
                    draft: draft.clone(),
                });
            }
        }
        self.measured = end;
    }
}

/// The values of several merits.
pub fn merit_values(measures: &Measures, merits: &[Merit]) -> Vec<f64> {
    merits.iter().map(|m| measures.merit(*m).value).collect()
}

/// Links between and beyond two parents', with steps of their own. Twists and values from lists
/// come from one parent.
fn vary(problem: &DesignProblem, a: &Links, b: &Links, rng: &mut ChaCha8Rng) -> Links {
    let variables = problem.links.variables(true);
    let x = problem.links.coordinates(a, &variables);
    let y = problem.links.coordinates(b, &variables);
    // Blending robots of different kinds gives neither: mostly the first parent alone.
    let blend = match rng.random::<f64>() {
        share if share < 0.5 => 0.0,
        _ => 0.5 * rng.random::<f64>(),
    };
    let mixed = x.iter().zip(&y).map(|(x, y)| {
        let step = match rng.random::<f64>() < MUTATED {
            true => STEP * rng.sample::<f64, _>(StandardNormal),
            false => 0.0,
        };
        x + blend * (y - x) + step
    });
    let mixed: Vec<f64> = mixed.collect();
    let mut links = problem.links.at(a, &variables, &mixed);
    problem.links.settle(&mut links);
    links
}

/// Every limit `factor` times as wide about its middle.
fn widened(limits: &ArtificialLimits, factor: f64, min_width: f64) -> ArtificialLimits {
    let widen = |limit: &JointLimit| tidy(limit.centre(), limit.width() * factor, min_width);
    ArtificialLimits::new(limits.joints().iter().map(widen).collect())
}

/// Some ends of limits moved at random.
fn moved(limits: &ArtificialLimits, min_width: f64, rng: &mut ChaCha8Rng) -> ArtificialLimits {
    let mut shift = |limit: &JointLimit| {
        let [low, high]: [f64; 2] = std::array::from_fn(|_| {
            let turn = TURN * (2.0 * rng.random::<f64>() - 1.0);
            if rng.random::<bool>() { turn } else { 0.0 }
        });
        let centre = limit.centre() + 0.5 * (low + high);
        tidy(centre, limit.width() + high - low, min_width)
    };
    ArtificialLimits::new(limits.joints().iter().map(&mut shift).collect())
}

fn tidy(centre: f64, width: f64, min_width: f64) -> JointLimit {
    match width.max(min_width) {
        width if width >= TAU => JointLimit::FREE,
        width => JointLimit::around(centre, width),
    }
}
