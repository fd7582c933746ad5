//! The search for one robot: screening, a race of CMA-ES runs, rounding, choice between finalists.
//!
//! It goes in steps of seconds at most; between two of them its state can be saved, and goes on
//! to the same end.

use super::assessment::{Care, DesignProblem, Draft, Look};
use super::finalists::{End, Finalist, sort_finalists, with_finalists};
use super::link_space::Links;
use super::run::{Generation, Run, Stage};
use super::seeds::{Purpose, sample_seed};
use super::stages::{FIRST, Leg};
use crate::manifold::Intolerance;
use crate::sampling::stream;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// How long and how carefully is searched.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SynthesisSettings {
    /// Random robots that are looked at first.
    pub screened: u32,
    /// Task points for each of them.
    pub screening_samples: u32,
    /// Robots from which runs start.
    pub runs: u32,
    /// Generations after which the better half of the runs goes on, again and again until
    /// `full_runs` are left.
    pub trial_generations: u32,
    /// Runs that go on to their end.
    pub full_runs: u32,
    /// Most generations of each stage after the trials.
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
    /// Run number `current` of this heat of the trials is on its way.
    Trials {
        heat: u32,
        current: usize,
    },
    /// Run number `current` is on its way through the stage that all runs are in.
    Running {
        current: usize,
    },
    /// The end number `current` is fitted and measured.
    Choosing {
        current: usize,
    },
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
            phase: Phase::Choosing { current: 0 },
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
            Phase::Trials { heat, current } => self.try_run(problem, heat, current),
            Phase::Running { current } => self.run_on(problem, current),
            Phase::Choosing { current } => self.choose(problem, current),
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
        let of = |done: f64, all: f64| (done / all.max(1.0)).min(1.0);
        let trials = s.trial_generations;
        // Weights from the work of a usual search; runs of a stage mostly end before its last
        // generation.
        let share = match self.phase {
            Phase::Screening => 0.1 * of(f64::from(self.screened), f64::from(s.screened)),
            Phase::Trials { heat, current } => {
                let run = self.runs[current].generations() as f64 - f64::from(heat * trials);
                let heat_share = of(
                    current as f64 + of(run, f64::from(trials)),
                    self.runs.len() as f64,
                );
                // Every heat has half the runs of the one before.
                0.1 + 0.3 * (1.0 - 0.5f64.powi(heat as i32) * (1.0 - 0.5 * heat_share))
            }
            Phase::Running { current } => {
                let run = &self.runs[current];
                let before = self.generations_before(run.stage);
                let done = run.generations().saturating_sub(before) as f64;
                let own = current as f64 + of(done, f64::from(s.generations));
                let [from, to] = match run.stage {
                    Stage::Lengths => [0.4, 0.6],
                    Stage::Refined | Stage::All => [0.6, 0.85],
                    Stage::RightAngles => [0.85, 0.9],
                };
                from + (to - from) * of(own, self.runs.len() as f64)
            }
            Phase::Choosing { current } => 0.9 + 0.1 * of(current as f64, self.ends.len() as f64),
            Phase::Done => 1.0,
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
        let looked: Vec<(bool, Option<Draft>)> = numbers
            .clone()
            .into_par_iter()
            .map(|number| {
                let links = robot(number);
                // Of another size, it could not be compared.
                if !problem.links.has_reach(&links) {
                    return (false, None);
                }
                match problem.verdict(&links) {
                    Some(_) => (true, None),
                    None => (false, problem.draft(&links, &[], look, Care::Scratch)),
                }
            })
            .collect();
        self.evaluations += looked.len() as u64;
        self.intolerant += looked.iter().filter(|(intolerant, _)| *intolerant).count() as u32;
        let score = |(_, draft): &(bool, Option<Draft>)| draft.as_ref().map_or(0.0, |d| d.score);
        self.screening.extend(looked.iter().map(score));
        self.drafts
            .extend(looked.into_iter().filter_map(|(_, draft)| draft));
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
        let settings = FIRST.settings(&self.settings);
        let count = self.settings.runs as usize;
        let start = |(number, draft): (u32, &Draft)| {
            Run::new(problem, draft, Stage::Lengths, settings, number)
        };
        self.runs = (0..).zip(&self.drafts).take(count).map(start).collect();
        self.phase = match self.runs.is_empty() {
            true => Phase::Done,
            false => self.next_heat(0),
        };
    }

    /// The next heat, if more runs are left than go on to the end.
    fn next_heat(&self, heat: u32) -> Phase {
        match self.runs.len() > self.settings.full_runs.max(1) as usize {
            true => Phase::Trials { heat, current: 0 },
            false => Phase::Running { current: 0 },
        }
    }

    /// One more generation of a run in a heat; after the last run the better half goes on.
    fn try_run(&mut self, problem: &DesignProblem, heat: u32, current: usize) {
        self.generation(problem, current);
        let until = u64::from((heat + 1) * self.settings.trial_generations);
        if self.runs[current].generations() < until {
            return;
        }
        if current + 1 < self.runs.len() {
            let current = current + 1;
            self.phase = Phase::Trials { heat, current };
            return;
        }
        let half = self.runs.len() / 2;
        self.keep_best(half.max(self.settings.full_runs.max(1) as usize));
        self.phase = self.next_heat(heat + 1);
    }

    /// Keeps the `count` best runs, best first.
    fn keep_best(&mut self, count: usize) {
        self.runs.sort_by(|a, b| b.level().total_cmp(&a.level()));
        self.runs.truncate(count);
    }

    fn generation(&mut self, problem: &DesignProblem, index: usize) {
        let mut generation = self.runs[index].advance(problem, self.seed);
        self.evaluations += u64::from(self.runs[index].population());
        generation.evaluations = self.evaluations;
        if let Phase::Trials { heat, .. } = self.phase {
            generation.heat = Some(heat + 1);
        }
        self.history.push(generation);
    }

    /// Generations that a run in `stage` has had in the trials.
    fn generations_before(&self, stage: Stage) -> u64 {
        let (mut left, mut heats) = (self.settings.runs, 0);
        while stage == Stage::Lengths && left > self.settings.full_runs.max(1) {
            left = (left / 2).max(self.settings.full_runs.max(1));
            heats += 1;
        }
        u64::from(heats * self.settings.trial_generations)
    }

    /// One more generation of a run; after the last run has ended, the next stage.
    fn run_on(&mut self, problem: &DesignProblem, current: usize) {
        let run = &self.runs[current];
        let most = u64::from(self.settings.generations) + self.generations_before(run.stage);
        if run.generations() < most && !run.has_settled() {
            self.generation(problem, current);
        } else if current + 1 < self.runs.len() {
            self.phase = Phase::Running {
                current: current + 1,
            };
        } else {
            self.next_stage(problem);
        }
    }

    /// Notes where all runs have ended, and starts the next stage from the better half of them.
    fn next_stage(&mut self, problem: &DesignProblem) {
        let all = self.runs.len();
        self.keep_best(all);
        let many = self.settings.full_runs > 1;
        self.ends.extend(self.runs.iter().map(|run| run.end(many)));
        let next = |run: &Run| {
            let leg = Leg::after(problem, run)?;
            Some(leg.start(problem, run, &self.settings))
        };
        self.runs = self.runs[..all.div_ceil(2)]
            .iter()
            .filter_map(next)
            .collect();
        self.phase = match self.runs.is_empty() {
            true => Phase::Choosing { current: 0 },
            false => Phase::Running { current: 0 },
        };
    }

    /// Fits and measures the end of one run; after the last one all are compared.
    fn choose(&mut self, problem: &DesignProblem, current: usize) {
        if let Some(end) = self.ends.get(current) {
            let found = with_finalists(problem, &self.settings, self.seed, end);
            self.evaluations += found.len() as u64;
            self.finalists.extend(found);
            self.phase = Phase::Choosing {
                current: current + 1,
            };
        } else {
            sort_finalists(&mut self.finalists);
            self.phase = Phase::Done;
        }
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
