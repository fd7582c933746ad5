//! The search for one robot: screening, runs of CMA-ES, rounding, choice between finalists.
//!
//! It goes in steps of seconds at most; between two of them its state can be saved, and goes on
//! to the same end.

use super::assessment::{Care, DesignProblem, Draft, Look};
use super::finalists::{End, Finalist, finalists};
use super::link_space::Links;
use super::run::{Generation, Run, RunSettings, Stage};
use super::seeds::{Purpose, sample_seed};
use crate::manifold::Intolerance;
use crate::sampling::stream;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// How long and how carefully is searched.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SynthesisSettings {
    /// Random robots that are looked at first.
    pub screened: u32,
    /// Task points for each of them.
    pub screening_samples: u32,
    /// Robots from which runs start.
    pub runs: u32,
    /// Generations of each run before the best goes on alone.
    pub trial_generations: u32,
    /// Most generations of the best run in each stage.
    pub generations: u32,
    /// Robots per generation.
    pub population: u32,
    /// Task points for each robot of a generation.
    pub samples: u32,
    /// Generations without a better median after which a stage ends.
    pub patience: u32,
    /// Task points on which limits are fitted last.
    pub fit_samples: u32,
    /// Task points on which finalists are compared.
    pub selection_samples: u32,
    /// Lengths are rounded to multiples of this, in reaches; 0 for no rounding.
    pub round_length: f64,
    /// Limits are rounded to multiples of this, radians; 0 for no rounding.
    pub round_limit: f64,
}

/// Where a search stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Phase {
    Screening,
    Trials { current: usize },
    Running,
    Choosing,
    Done,
}

/// The search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Synthesis {
    settings: SynthesisSettings,
    seed: u64,
    phase: Phase,
    /// Number of random robots looked at.
    screened: u32,
    /// Those of them that structure alone makes intolerant.
    intolerant: u32,
    /// Scores of all screened robots.
    screening: Vec<f64>,
    /// The best of them, best first.
    drafts: Vec<Draft>,
    runs: Vec<Run>,
    /// Ends of stages.
    ends: Vec<End>,
    history: Vec<Generation>,
    evaluations: u64,
    finalists: Vec<Finalist>,
    /// The robots given as starts.
    starts: Vec<Links>,
}

/// Random robots of one step.
const BATCH: u32 = 32;

/// Screened robots that are looked at again, per run.
const SECOND_LOOKS: usize = 4;

/// Task points of a second look, as a multiple of those of the first.
const SECOND_SAMPLES: u32 = 3;

/// First steps of the stages; larger ones lose the limits that robots inherit.
const FIRST_STEP: f64 = 0.12;
const LATER_STEP: f64 = 0.05;

/// Task points of the later stages, which are about smaller differences, as a multiple.
const LATER_SAMPLES: u32 = 2;

/// Twists this near to a right angle become one, radians: beyond, another robot is meant.
const NEARLY_RIGHT: f64 = 0.35;

impl Synthesis {
    /// A search for `problem`, from random robots and from `starts`.
    pub fn new(settings: SynthesisSettings, seed: u64, starts: Vec<Links>) -> Synthesis {
        Synthesis {
            settings,
            seed,
            phase: Phase::Screening,
            screened: 0,
            intolerant: 0,
            screening: Vec::new(),
            drafts: Vec::new(),
            runs: Vec::new(),
            ends: Vec::new(),
            history: Vec::new(),
            evaluations: 0,
            finalists: Vec::new(),
            starts,
        }
    }

    /// The end of a search of another kind: `drafts` are its best robots, from which the winner is
    /// still to be chosen.
    pub fn of_drafts(
        settings: SynthesisSettings,
        seed: u64,
        drafts: &[Draft],
        evaluations: u64,
    ) -> Synthesis {
        let end = |(number, draft): (usize, &Draft)| End {
            name: format!("candidate {number}"),
            links: draft.links.clone(),
            limits: vec![draft.limits.clone()],
        };
        Synthesis {
            phase: Phase::Choosing,
            ends: (1..).zip(drafts).map(end).collect(),
            evaluations,
            ..Synthesis::new(settings, seed, Vec::new())
        }
    }

    /// Whether there is nothing left to do.
    pub fn is_done(&self) -> bool {
        self.phase == Phase::Done
    }

    /// Goes one step further.
    pub fn advance(&mut self, problem: &DesignProblem) {
        match self.phase {
            Phase::Screening => self.screen(problem),
            Phase::Trials { current } => self.try_run(problem, current),
            Phase::Running => self.run_on(problem),
            Phase::Choosing => self.choose(problem),
            Phase::Done => {}
        }
    }

    /// Finalists, best first, once the search is done.
    pub fn finalists(&self) -> &[Finalist] {
        &self.finalists
    }

    /// The robot that the search ends with: the best finalist, or a round one that is not worse
    /// than it by more than a standard error.
    pub fn winner(&self) -> Option<&Finalist> {
        let best = self.finalists.first()?;
        let good = |f: &&Finalist| f.score >= best.score - best.error;
        self.finalists
            .iter()
            .filter(|f| f.is_round)
            .find(good)
            .or(Some(best))
    }

    /// Scores of all generations so far.
    pub fn history(&self) -> &[Generation] {
        &self.history
    }

    /// Scores of the screened robots, in the order drawn.
    pub fn screening(&self) -> &[f64] {
        &self.screening
    }

    /// Screened robots that are structurally intolerant.
    pub fn intolerant(&self) -> u32 {
        self.intolerant
    }

    /// Robots assessed so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Share of the work done, about, and the latest score.
    pub fn progress(&self) -> (f64, f64) {
        let latest = self.history.last().map(|g| g.quartiles[1]);
        let best_screened = self.screening.iter().copied().fold(0.0, f64::max);
        let s = &self.settings;
        let all = s.screened / 4
            + s.runs * s.trial_generations * s.population
            + 2 * s.generations * s.population;
        let done = f64::from(self.screened.min(s.screened)) / 4.0
            + self.history.len() as f64 * f64::from(s.population);
        let share = match self.phase {
            Phase::Done => 1.0,
            Phase::Choosing => 0.97,
            _ => (done / f64::from(all.max(1))).min(0.95),
        };
        (share, latest.unwrap_or(best_screened))
    }

    fn screen(&mut self, problem: &DesignProblem) {
        let look = Look {
            samples: self.settings.screening_samples,
            seed: sample_seed(self.seed, Purpose::Screening, 0),
            replicates: 1,
        };
        let given = self.starts.len() as u32;
        let all = self.settings.screened + given;
        let numbers = self.screened..(self.screened + BATCH).min(all);
        let robot = |number: u32| match self.starts.get(number as usize) {
            Some(links) => links.clone(),
            None => {
                let seed = sample_seed(self.seed, Purpose::Robot, u64::from(number));
                problem.links.random(&mut stream(seed, 0))
            }
        };
        let looked: Vec<Option<Draft>> = numbers
            .clone()
            .into_par_iter()
            .map(|number| {
                let links = robot(number);
                let verdict = problem.verdict(&links);
                match verdict {
                    Some(_) => None,
                    None => problem.draft(&links, &[], look, Care::Scratch),
                }
            })
            .collect();
        self.evaluations += looked.len() as u64;
        self.intolerant += looked.iter().filter(|draft| draft.is_none()).count() as u32;
        let score = |draft: &Option<Draft>| draft.as_ref().map_or(0.0, |draft| draft.score);
        self.screening.extend(looked.iter().map(score));
        self.drafts.extend(looked.into_iter().flatten());
        self.sort_drafts();
        self.screened = numbers.end;
        if self.screened >= all {
            self.confirm(problem);
        }
    }

    fn sort_drafts(&mut self) {
        self.drafts.sort_by(|a, b| b.score.total_cmp(&a.score));
        self.drafts
            .truncate(self.settings.runs as usize * SECOND_LOOKS);
    }

    /// Looks again at the best of the screening, whose scores are those of the luckiest, and
    /// starts runs from the best.
    fn confirm(&mut self, problem: &DesignProblem) {
        let look = Look {
            samples: self.settings.screening_samples * SECOND_SAMPLES,
            seed: sample_seed(self.seed, Purpose::Confirmation, 0),
            replicates: 1,
        };
        let again = |draft: &Draft| {
            let starts = [draft.limits.clone()];
            problem.draft(&draft.links, &starts, look, Care::Scratch)
        };
        self.evaluations += self.drafts.len() as u64;
        self.drafts = self.drafts.par_iter().filter_map(again).collect();
        self.sort_drafts();
        let settings = self.run_settings(FIRST_STEP, 1);
        let count = self.settings.runs as usize;
        let start = |(number, draft): (u32, &Draft)| {
            Run::new(problem, draft, Stage::Lengths, settings, number)
        };
        self.runs = (0..).zip(&self.drafts).take(count).map(start).collect();
        self.phase = match self.runs.is_empty() {
            true => Phase::Done,
            false => Phase::Trials { current: 0 },
        };
    }

    fn run_settings(&self, step: f64, times: u32) -> RunSettings {
        RunSettings {
            population: self.settings.population,
            samples: times * self.settings.samples,
            patience: self.settings.patience,
            step,
        }
    }

    fn try_run(&mut self, problem: &DesignProblem, current: usize) {
        self.generation(problem, current);
        if self.runs[current].generations() < u64::from(self.settings.trial_generations) {
            return;
        }
        if current + 1 < self.runs.len() {
            self.phase = Phase::Trials {
                current: current + 1,
            };
            return;
        }
        self.runs.sort_by(|a, b| b.level().total_cmp(&a.level()));
        self.runs.truncate(1);
        self.phase = Phase::Running;
    }

    fn generation(&mut self, problem: &DesignProblem, index: usize) {
        let mut generation = self.runs[index].advance(problem, self.seed);
        self.evaluations += u64::from(self.runs[index].population());
        generation.evaluations = self.evaluations;
        self.history.push(generation);
    }

    /// One more generation of the best run; at its end the next stage.
    fn run_on(&mut self, problem: &DesignProblem) {
        let Some(run) = self.runs.first() else {
            self.phase = Phase::Choosing;
            return;
        };
        let before = match run.stage {
            Stage::Lengths => self.settings.trial_generations,
            Stage::All | Stage::Refined | Stage::RightAngles => 0,
        };
        let most = u64::from(self.settings.generations + before);
        if run.generations() < most && !run.has_settled() {
            self.generation(problem, 0);
            return;
        }
        let (stage, number) = (run.stage, run.number);
        let (links, limits) = (run.centre().clone(), run.limits().to_vec());
        let name = match stage {
            Stage::Lengths => "lengths",
            Stage::All => "lengths and twists",
            Stage::Refined => "refined lengths",
            Stage::RightAngles => "right angles",
        };
        self.ends.push(End {
            name: name.into(),
            links: links.clone(),
            limits: limits.clone(),
        });
        let has_twists = problem.links.variables(true).len() > problem.links.variables(false).len();
        let next = match stage {
            Stage::Lengths if has_twists => Some((Stage::All, links)),
            Stage::Lengths => Some((Stage::Refined, links)),
            Stage::All => {
                let round = right_angles(problem, &links);
                round.map(|links| (Stage::RightAngles, links))
            }
            Stage::Refined | Stage::RightAngles => None,
        };
        match next {
            Some((stage, links)) => {
                let draft = Draft {
                    links,
                    limits: limits[0].clone(),
                    ..self.drafts[0].clone()
                };
                let settings = self.run_settings(LATER_STEP, LATER_SAMPLES);
                self.runs = vec![Run::new(problem, &draft, stage, settings, number + 100)];
            }
            None => self.phase = Phase::Choosing,
        }
    }

    /// Compares the ends of all stages.
    fn choose(&mut self, problem: &DesignProblem) {
        self.finalists = finalists(problem, &self.settings, self.seed, &self.ends);
        self.evaluations += self.finalists.len() as u64;
        self.phase = Phase::Done;
    }
}

impl DesignProblem {
    /// Why no limits make a robot with these links fault tolerant, if so.
    pub fn verdict(&self, links: &Links) -> Option<Intolerance> {
        let prone = |joint| self.failures.contains(joint);
        let robot = self.links.robot(links, 1.0, "candidate");
        Intolerance::of(&robot, self.task(), prone)
    }
}

/// `links` with twists near right angles set to them; `None` if that is no change or a twist is
/// far from one.
fn right_angles(problem: &DesignProblem, links: &Links) -> Option<Links> {
    let mut round = links.clone();
    for link in &mut round {
        let nearest = (link.twist / FRAC_PI_2).round() * FRAC_PI_2;
        if (link.twist - nearest).abs() > NEARLY_RIGHT {
            return None;
        }
        link.twist = nearest;
    }
    if round == *links {
        return None;
    }
    problem.links.settle(&mut round);
    Some(round)
}
