//! Runs `kind = "synthesis"`: searches robots, then measures, checks and reports the winner.

use super::checkpoint::Stage;
use super::locked_check::Checked;
use super::run::{Ready, RunError, RunOptions};
use super::settings::Study;
use super::synthesis_check::SynthesisQuestion;
use super::synthesis_result::{Reference, SynthesisFinding, Winner};
use super::synthesis_settings::RobotSearch;
use crate::synthesis::{
    Arm, Care, DesignProblem, Draft, Links, Look, ParameterSensitivity, ParetoSearch, Purpose,
    REPLICATES, Synthesis, Tolerances, sample_seed,
};
use crate::workspace::{ArtificialLimits, LockedJointEstimate};
use serde_json::Value;
use std::sync::atomic::Ordering;

/// Runs `study` and returns the content of `result.json`.
///
/// # Errors
/// The run was interrupted (a checkpoint is stored), or a file could not be written.
pub(super) fn run(
    study: &Study,
    question: &SynthesisQuestion,
    options: &RunOptions,
    mut ready: Ready,
) -> Result<Value, RunError> {
    ready.begin(options)?;
    let asked = &question.search;
    let problem = asked.problem(study.task, &question.failures(study));
    let starts: Vec<Links> = match asked.include_design {
        true => asked
            .links_of(&study.design.robot, study.task)
            .into_iter()
            .collect(),
        false => Vec::new(),
    };
    let saved = ready.saved.take();
    let run = Run {
        study,
        question,
        options,
        ready: &ready,
        problem,
    };
    let result = match asked.objectives.len() {
        1 => run.one(saved, starts),
        _ => run.front(saved, starts),
    }?;
    ready.session.store.remove();
    Ok(result)
}

/// Margins that are reported, radians.
fn margins() -> Vec<f64> {
    [0.0, 1.0, 2.0, 5.0, 10.0].map(f64::to_radians).to_vec()
}

struct Run<'a> {
    study: &'a Study,
    question: &'a SynthesisQuestion,
    options: &'a RunOptions,
    ready: &'a Ready,
    problem: DesignProblem,
}

impl Run<'_> {
    fn tell(&self, share: f64, best: f64, message: &str) {
        let done = (1000.0 * share.clamp(0.0, 1.0)) as u64;
        self.ready
            .session
            .progress
            .update(done, 1000, best, message);
    }

    fn check_interrupt(&self) -> Result<(), RunError> {
        match self.ready.session.interrupt.load(Ordering::SeqCst) {
            true => Err(RunError::Interrupted),
            false => Ok(()),
        }
    }

    /// Searches one robot.
    fn one(&self, saved: Option<Stage>, starts: Vec<Links>) -> Result<Value, RunError> {
        let settings = self.question.search.search_settings();
        let genetic = self.question.search.method == RobotSearch::Genetic;
        let mut search = match saved {
            Some(Stage::Synthesis(search)) => *search,
            saved if genetic => {
                let bred = self.breed(saved, starts)?;
                let leaders = bred.leaders(&self.problem, settings.runs as usize);
                Synthesis::of_drafts(settings, self.study.seed, &leaders, bred.evaluations())
            }
            _ => Synthesis::new(settings, self.study.seed, starts),
        };
        let store = &self.ready.session.store;
        while !search.is_done() {
            if self.check_interrupt().is_err() {
                store.save(Stage::Synthesis(Box::new(search)))?;
                return Err(RunError::Interrupted);
            }
            search.advance(&self.problem);
            let (share, best) = search.progress();
            self.tell(0.8 * share, best, "searching robots");
            store.save_if_due(|| Stage::Synthesis(Box::new(search.clone())))?;
        }
        // A kill while the report is made loses the report alone.
        store.save(Stage::Synthesis(Box::new(search.clone())))?;
        let searched = store.seconds();
        let Some(finalist) = search.winner() else {
            return Err(anyhow::anyhow!(
                "no robot of this space has a fault-tolerant workspace: widen the bounds, or \
                 raise `screened`"
            )
            .into());
        };
        let winner = self.winner(&finalist.draft)?;
        self.check_interrupt()?;
        let reference = self.reference()?;
        let finding = SynthesisFinding {
            study: self.study,
            question: self.question,
            search: Some(&search),
            pareto: None,
            winner: Some(&winner),
            reference: reference.as_ref(),
            searched,
            seconds: store.seconds(),
        };
        finding.write(self.options, &self.ready.study_toml)
    }

    /// Runs the genetic algorithm to its end.
    fn breed(&self, saved: Option<Stage>, starts: Vec<Links>) -> Result<ParetoSearch, RunError> {
        let asked = &self.question.search;
        let mut search = match saved {
            Some(Stage::Pareto(search)) => *search,
            _ => ParetoSearch::new(
                asked.pareto_settings(),
                asked.objectives.clone(),
                self.study.seed,
                starts,
            ),
        };
        let store = &self.ready.session.store;
        while !search.is_done() {
            if self.check_interrupt().is_err() {
                store.save(Stage::Pareto(Box::new(search)))?;
                return Err(RunError::Interrupted);
            }
            search.advance(&self.problem);
            self.tell(0.9 * search.progress(), f64::NAN, "searching robots");
            store.save_if_due(|| Stage::Pareto(Box::new(search.clone())))?;
        }
        store.save(Stage::Pareto(Box::new(search.clone())))?;
        Ok(search)
    }

    /// Searches a front.
    fn front(&self, saved: Option<Stage>, starts: Vec<Links>) -> Result<Value, RunError> {
        let search = self.breed(saved, starts)?;
        let store = &self.ready.session.store;
        let searched = store.seconds();
        let reference = self.reference()?;
        let finding = SynthesisFinding {
            study: self.study,
            question: self.question,
            search: None,
            pareto: Some(&search),
            winner: None,
            reference: reference.as_ref(),
            searched,
            seconds: store.seconds(),
        };
        finding.write(self.options, &self.ready.study_toml)
    }

    fn report_look(&self) -> Look {
        Look {
            samples: self.question.search.effort.report_samples as u32,
            seed: sample_seed(self.study.seed, Purpose::Report, 0),
            replicates: REPLICATES,
        }
    }

    /// The winner measured on samples that nothing was fitted to or chosen by.
    fn winner(&self, draft: &Draft) -> Result<Winner, RunError> {
        self.tell(0.82, draft.score, "measuring the winner on fresh samples");
        let problem = &self.problem.with_all_merits();
        let nothing = || anyhow::anyhow!("the winner reaches nothing");
        let robot = problem.links.robot(&draft.links, 1.0, "winner");
        let arm = Arm::of_robot(&robot, self.study.task).ok_or_else(nothing)?;
        let atlas = problem
            .atlas(&arm, self.report_look(), Some(&draft.limits))
            .ok_or_else(nothing)?;
        let measures = problem.measures(&arm, &atlas, &draft.limits);
        self.check_interrupt()?;
        let margins = problem.margin_curve(&arm, &atlas, &draft.limits, &margins());
        let counts = atlas.counts();
        let map = atlas.share_map(&draft.limits, &problem.failures);
        drop(atlas);
        Ok(Winner {
            draft: draft.clone(),
            counts,
            map,
            reach: arm.extent.reach,
            measures,
            margins,
            check: self.check(&arm, draft)?,
            sensitivity: self.sensitivity(draft)?,
        })
    }

    /// The same share by another way: inverse kinematics with locked joints on random task points.
    fn check(&self, arm: &Arm, draft: &Draft) -> Result<Option<LockedJointEstimate>, RunError> {
        let watch = |done: u64, of: u64| {
            let share = done as f64 / of.max(1) as f64;
            self.tell(
                0.85 + 0.05 * share,
                f64::NAN,
                "checking by inverse kinematics",
            );
        };
        let stop = || self.ready.session.interrupt.load(Ordering::SeqCst);
        let checked = Checked {
            study: self.study,
            robot: &arm.robot,
            limits: &draft.limits,
            failures: &self.problem.failures,
            poses: self.question.search.effort.check_poses,
        };
        let estimate = checked.count(&watch, &stop);
        self.check_interrupt()?;
        Ok(estimate)
    }

    fn sensitivity(&self, draft: &Draft) -> Result<Vec<ParameterSensitivity>, RunError> {
        let asked = &self.question.search;
        let samples = asked.effort.sensitivity_samples;
        if samples == 0 {
            return Ok(Vec::new());
        }
        self.tell(0.91, f64::NAN, "moving every parameter by its tolerance");
        let tolerances = Tolerances {
            length: asked.tolerance / asked.reach,
            angle: asked.tolerance_deg.to_radians(),
        };
        let seed = self.study.seed;
        let found = self
            .problem
            .sensitivity(draft, tolerances, samples as u32, seed);
        self.check_interrupt()?;
        Ok(found)
    }

    /// The design that the winner is compared with, with its own limits or the best found for it.
    fn reference(&self) -> Result<Option<Reference>, RunError> {
        self.tell(0.95, f64::NAN, "measuring the design for comparison");
        let (study, problem) = (self.study, &self.problem);
        let robot = &study.design.robot;
        let problem = DesignProblem {
            failures: study.failures.clone(),
            ..problem.with_all_merits()
        };
        let prone = |joint| study.failures.contains(joint);
        let verdict = crate::manifold::Intolerance::of(robot, study.task, prone);
        let Some(arm) = Arm::of_robot(robot, study.task) else {
            return Ok(None);
        };
        let limits = match &self.question.limits {
            Some(limits) => limits.to_limits(robot),
            None if verdict.is_some() => ArtificialLimits::free(robot.joints()),
            None => {
                let look = Look {
                    samples: self.question.search.effort.fit_samples as u32,
                    seed: sample_seed(study.seed, Purpose::Fit, 1),
                    replicates: 1,
                };
                match problem.atlas(&arm, look, None) {
                    Some(atlas) => {
                        // Twice: what is found from scratch is then climbed with care.
                        let found = problem.fit(&arm, &atlas, &[], Care::Scratch, study.seed);
                        problem.fit(&arm, &atlas, &[found], Care::Last, study.seed)
                    }
                    None => return Ok(None),
                }
            }
        };
        let Some(atlas) = problem.atlas(&arm, self.report_look(), Some(&limits)) else {
            return Ok(None);
        };
        let measures = problem.measures(&arm, &atlas, &limits);
        Ok(Some(Reference {
            given: self.question.limits.is_some(),
            measures,
            map: atlas.share_map(&limits, &study.failures),
            limits,
            verdict,
            arm,
        }))
    }
}
