//! CMA-ES over the links of one robot, with limits refitted inside.

use super::assessment::{Care, DesignProblem, Draft, Look};
use super::link_space::{Column, Links};
use super::off_reach::is_one;
use super::seeds::{Purpose, sample_seed};
use crate::optimiser::CmaEs;
use crate::sampling::stream;
use crate::workspace::ArtificialLimits;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// What a run may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stage {
    /// Lengths and offsets; the twists are those of the start.
    Lengths,
    /// Lengths and offsets again, with shorter steps and more task points.
    Refined,
    /// Twists as well.
    All,
    /// Lengths and offsets, with twists that have been rounded to right angles.
    RightAngles,
}

/// Scores of one generation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Generation {
    /// Robots assessed so far in the whole search.
    pub evaluations: u64,
    /// Number of the run.
    pub run: u32,
    /// What the run changes.
    pub stage: Stage,
    /// Heat of the trials, from 1; `None` after them.
    pub heat: Option<u32>,
    /// Robots that the bounds keep from the reach; they score 0.
    pub off_reach: u32,
    /// Greatest score: a biased number, the luckiest of many.
    pub best: f64,
    /// Upper quartile, median and lower quartile.
    pub quartiles: [f64; 3],
}

/// How a run goes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunSettings {
    /// Robots per generation.
    pub population: u32,
    /// Task points for each robot.
    pub samples: u32,
    /// Generations without a better median after which a run ends.
    pub patience: u32,
    /// First step, in units of a radian and 0.35 of the reach.
    pub step: f64,
}

/// The state of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Its number.
    pub number: u32,
    /// What it changes.
    pub stage: Stage,
    settings: RunSettings,
    variables: Vec<(usize, Column)>,
    search: CmaEs,
    /// The links around which robots are drawn.
    links: Links,
    /// Limits that the next generation begins with.
    inherited: Vec<ArtificialLimits>,
    medians: Vec<f64>,
}

/// Every so many robots limits are fitted from scratch too, lest all inherit a poor kind.
const FROM_SCRATCH: usize = 8;

/// Robots of a generation whose limits the next one begins with.
const INHERITED: usize = 2;

/// Generations over which medians are averaged.
const AVERAGED: usize = 5;

impl Run {
    /// A run that starts at `links`, with `limits` that are good for them.
    pub(super) fn from_links(
        problem: &DesignProblem,
        links: Links,
        limits: Vec<ArtificialLimits>,
        stage: Stage,
        settings: RunSettings,
        number: u32,
    ) -> Run {
        let variables = problem.links.variables(stage == Stage::All);
        let x = problem.links.coordinates(&links, &variables);
        Run {
            number,
            stage,
            settings,
            search: CmaEs::new(x, settings.step, settings.population as usize),
            variables,
            links,
            inherited: limits,
            medians: Vec::new(),
        }
    }

    /// Draws, assesses and learns from one generation. All its robots see the same task points,
    /// the next generation sees others.
    pub fn advance(&mut self, problem: &DesignProblem, seed: u64) -> Generation {
        let generation = self.search.generation();
        let number = u64::from(self.number) << 32 | generation;
        let drawn = self
            .search
            .ask(&mut stream(sample_seed(seed, Purpose::Draw, number), 0));
        let look = Look {
            samples: self.settings.samples,
            seed: sample_seed(seed, Purpose::Generation, number),
            replicates: 1,
        };
        let assess = |(index, x): (usize, &Vec<f64>)| {
            let mut links = problem.links.at(&self.links, &self.variables, x);
            let (scale, reach) = problem.links.settle(&mut links);
            let care = match (index + generation as usize) % FROM_SCRATCH {
                0 => Care::Scratch,
                _ => Care::Refit,
            };
            let has_reach = is_one(reach);
            let draft = match has_reach {
                true => problem.draft(&links, &self.inherited, look, care),
                false => None,
            };
            // The point that was assessed, at the size that was drawn.
            let settled = problem.links.coordinates(&links, &self.variables);
            (self.at_scale(&settled, scale), draft, has_reach)
        };
        let assessed: Vec<(Vec<f64>, Option<Draft>, bool)> =
            drawn.par_iter().enumerate().map(assess).collect();
        let score = |k: usize| assessed[k].1.as_ref().map_or(0.0, |draft| draft.score);
        let mut order: Vec<usize> = (0..assessed.len()).collect();
        order.sort_by(|&a, &b| score(b).total_cmp(&score(a)));
        let best_first: Vec<&[f64]> = order.iter().map(|&k| &assessed[k].0[..]).collect();
        self.search.tell(&best_first);
        self.recentre(problem);
        let leaders = order.iter().filter_map(|&k| assessed[k].1.as_ref());
        let limits: Vec<ArtificialLimits> =
            leaders.take(INHERITED).map(|d| d.limits.clone()).collect();
        if !limits.is_empty() {
            self.inherited = limits;
        }
        let at = |share: f64| score(order[(share * (order.len() - 1) as f64).round() as usize]);
        self.medians.push(at(0.5));
        Generation {
            evaluations: 0,
            run: self.number,
            stage: self.stage,
            heat: None,
            off_reach: assessed.iter().filter(|robot| !robot.2).count() as u32,
            best: at(0.0),
            quartiles: [at(0.25), at(0.5), at(0.75)],
        }
    }

    /// Coordinates with all lengths multiplied by `scale`.
    fn at_scale(&self, x: &[f64], scale: f64) -> Vec<f64> {
        let pairs = x.iter().zip(&self.variables);
        pairs
            .map(|(x, (_, column))| match column {
                Column::Twist => *x,
                _ => x * scale,
            })
            .collect()
    }

    /// Brings the centre of the search back to reach 1, where bounds and steps have their meaning.
    fn recentre(&mut self, problem: &DesignProblem) {
        let mut links = problem
            .links
            .at(&self.links, &self.variables, self.search.mean());
        problem.links.settle(&mut links);
        let mean = problem.links.coordinates(&links, &self.variables);
        self.search.set_mean(mean);
        self.links = links;
    }

    /// The centre of the search, settled: the run's answer, less noisy than its best robot.
    pub fn centre(&self) -> &Links {
        &self.links
    }

    /// Limits that the last generation found best.
    pub fn limits(&self) -> &[ArtificialLimits] {
        &self.inherited
    }

    /// Mean of the last few medians.
    pub fn level(&self) -> f64 {
        let last = &self.medians[self.medians.len().saturating_sub(AVERAGED)..];
        last.iter().sum::<f64>() / last.len().max(1) as f64
    }

    /// Whether the median has not risen for as long as patience lasts.
    pub fn has_settled(&self) -> bool {
        let patience = self.settings.patience as usize;
        let means: Vec<f64> = self
            .medians
            .windows(AVERAGED)
            .map(|w| w.iter().sum::<f64>() / AVERAGED as f64)
            .collect();
        let best = (0..means.len()).fold(0, |a, b| if means[b] > means[a] { b } else { a });
        means.len() > best + patience
    }

    /// Generations so far.
    pub fn generations(&self) -> u64 {
        self.search.generation()
    }

    /// Robots per generation.
    pub fn population(&self) -> u32 {
        self.settings.population
    }
}
