//! Runs a study with the hybrid estimator: traces an atlas, then scores limits over it.

use super::first_candidates::beginning;
use super::hybrid_arm::{Needed, Samples, check_cache};
use super::hybrid_result::HybridFinding;
use super::hybrid_sensitivity::sensitivity;
use super::hybrid_settings::Hybrid;
use super::locked_check::{self, Checked};
use super::optimise::{Coarse, Optimum, Terms, search};
use super::parts::parts;
use super::report_parts::{convergence, failures_label, formats, provenance_rows, size_notes};
use super::result::status;
use super::run::{Ready, RunError, RunOptions};
use super::settings::{DegreeLimits, Optimise, Question, Study};
use super::spatial_picture::Picture;
use super::structure;
use crate::design::JointKind;
use crate::manifold::Intolerance;
use crate::objective::{DesignSpace, HybridObjective};
use crate::report::{self, Report, Sensitivity, write_report};
use crate::workspace::hybrid::{Atlas, Rule};
use crate::workspace::{ArtificialLimits, Estimate, LockedJointEstimate, WorkspaceSizes};
use serde_json::{Value, json};
use std::sync::atomic::Ordering;
use std::time::Instant;

/// Most sweeps of a search over an atlas.
const SWEEPS: usize = 12;

/// Relative gain of a sweep below which a search over an atlas has converged: far below the
/// standard error of any affordable atlas.
const TOLERANCE: f64 = 1e-4;

/// Length up to which steps over an atlas are short, radians.
const SHORT_STEP: f64 = 0.01;

/// Runs `study` to its report and returns the content of `result.json`.
///
/// # Errors
/// The atlas is too large, the run was interrupted, or a file could not be written.
pub(super) fn run(
    study: &Study,
    hybrid: &Hybrid,
    options: &RunOptions,
    ready: Ready,
) -> Result<Value, RunError> {
    let verdict = structure::verdict(study);
    if let (Question::Optimise(_), Some(verdict)) = (&study.question, &verdict) {
        return structure::without_search(study, verdict, options, &ready);
    }
    check_cache(options.cache.as_deref())?;
    let given = match &study.question {
        Question::Estimate(estimate) => Some(estimate.limits.to_limits(&study.design.robot)),
        _ => None,
    };
    let needed = Needed::new(study, hybrid, Samples::OfTheSeed, given.as_ref())?;
    let mut run = Run {
        study,
        hybrid,
        options,
        ready,
        verdict,
        tracing: 0.0,
        searching: 0.0,
    };
    // The report folder stays untouched until there is something to report on: a run that is
    // killed while it traces starts again without `--overwrite`, from the cache.
    let atlas = run.trace(&needed)?;
    run.ready.begin(options)?;
    let result = match &study.question {
        Question::Estimate(estimate) => {
            let limits = estimate.limits.to_limits(&study.design.robot);
            run.write(&atlas, &estimate.limits, &limits, None)
        }
        Question::Optimise(optimise) => run.optimise(optimise, atlas),
        _ => Err(anyhow::anyhow!("this kind of study measures no workspace").into()),
    }?;
    run.ready.session.store.remove();
    Ok(result)
}

/// The state of a run.
struct Run<'a> {
    study: &'a Study,
    hybrid: &'a Hybrid,
    options: &'a RunOptions,
    ready: Ready,
    /// Why S_F is 0 for all limits, if it is.
    verdict: Option<Intolerance>,
    /// Seconds spent so far.
    tracing: f64,
    searching: f64,
}

/// An optimum and its size on the samples that it was searched on.
struct Searched {
    optimum: Optimum,
    size: Estimate,
    sensitivity: Option<Sensitivity>,
}

impl Run<'_> {
    fn trace(&mut self, needed: &Needed) -> Result<Atlas, RunError> {
        let started = Instant::now();
        let session = &self.ready.session;
        let cache = self.options.cache.as_deref();
        let progress = session.progress.as_ref();
        let atlas = needed.build(self.study, cache, &session.interrupt, progress)?;
        self.tracing += started.elapsed().as_secs_f64();
        Ok(atlas)
    }

    /// Searches on one atlas and measures on another: the maximum of noisy scores is too high.
    fn optimise(&mut self, optimise: &Optimise, atlas: Atlas) -> Result<Value, RunError> {
        let started = Instant::now();
        let searched = self.search(optimise, &atlas)?;
        self.searching = started.elapsed().as_secs_f64();
        drop(atlas);
        let limits = searched.optimum.design.limits.clone();
        let needed = Needed::new(self.study, self.hybrid, Samples::Independent, Some(&limits))?;
        let atlas = self.trace(&needed)?;
        let written = DegreeLimits::from_limits(&limits, &self.study.design.robot);
        self.write(&atlas, &written, &limits, Some(&searched))
    }

    fn search(&mut self, optimise: &Optimise, atlas: &Atlas) -> Result<Searched, RunError> {
        let study = self.study;
        let robot = &study.design.robot;
        let min_width = optimise.search.min_width_deg.to_radians();
        let space = DesignSpace::of_robot(robot, study.task, min_width);
        let rule = self.hybrid.rule;
        let score =
            |atlas| HybridObjective::new(space.clone(), atlas, study.failures.clone(), rule);
        let parts = parts(optimise, atlas);
        let scores: Vec<HybridObjective> = parts.iter().map(|part| score(&part.atlas)).collect();
        let coarse = parts.iter().zip(&scores).map(|(part, score)| Coarse {
            objective: score,
            samples: part.samples,
            finalists: part.finalists,
        });
        let objective = score(atlas);
        let first = scores.first().unwrap_or(&objective);
        let begin = beginning(study, optimise, &space, [first, &objective], atlas);
        let terms = Terms {
            space: &space,
            objective: &objective,
            samples: Some(atlas.plan().len()),
            coarse: match begin.on_all_samples {
                true => Vec::new(),
                false => coarse.collect(),
            },
            starts: begin.starts,
            max_sweeps: SWEEPS,
            tolerance: TOLERANCE,
            short_step: SHORT_STEP,
            truth: None,
        };
        let saved = self.ready.saved.take();
        let optimum = search(optimise, &terms, study.seed, saved, &self.ready.session)?;
        let sizes = atlas.sizes(&optimum.design.limits, &study.failures, rule);
        let draw = || {
            let (limits, unit) = (&optimum.design.limits, study.task.unit());
            sensitivity(atlas, &space, limits, &study.failures, unit)
        };
        let draws = study.report.figures && rule == Rule::Definition;
        Ok(Searched {
            sensitivity: draws.then(draw).flatten(),
            optimum,
            size: sizes.fault_tolerant,
        })
    }

    /// Measures the workspaces, draws the figures and writes the report.
    fn write(
        &self,
        atlas: &Atlas,
        written: &DegreeLimits,
        limits: &ArtificialLimits,
        searched: Option<&Searched>,
    ) -> Result<Value, RunError> {
        let study = self.study;
        let session = &self.ready.session;
        let optimum = searched.map(|searched| &searched.optimum);
        let best = optimum.map_or(f64::NAN, Optimum::score);
        session.progress.update(0, 2, best, "measuring workspaces");
        let started = Instant::now();
        let sizes = atlas.sizes(limits, &study.failures, self.hybrid.rule);
        let measured = started.elapsed().as_secs_f64();
        let started = Instant::now();
        let check = self.check(limits, best)?;
        let checked = started.elapsed().as_secs_f64();
        session.progress.update(1, 2, best, "writing the report");
        let mut notes = self.notes(atlas, &sizes, limits, optimum.is_some());
        notes.extend(check.iter().flat_map(|check| check_notes(check, &sizes)));
        let finding = HybridFinding {
            study,
            limits: written,
            sizes: &sizes,
            atlas,
            optimum,
            structure: self.verdict.as_ref(),
            searched_error: searched.map(|searched| searched.size.error),
            check: check.as_ref(),
            seconds: json!({
                "total": session.store.seconds(),
                "atlas": self.tracing,
                "search": self.searching,
                "measure": measured,
                "check": checked,
            }),
            threads: rayon::current_num_threads(),
            notes: &notes,
        };
        let result = finding.to_json();
        if study.report.figures {
            let robot = &study.design.robot;
            let picture = Picture::of(atlas, robot, limits, &study.failures);
            let picture = picture.as_ref();
            let figures = picture.map_or(Vec::new(), |picture| picture.figures(&robot.name));
            let mut report = self.report(&finding, limits, result.clone());
            report.workspace = picture.and_then(|picture| picture.planar(&robot.name));
            report.figures = figures.iter().map(|figure| figure.as_ref()).collect();
            report.points = picture.and_then(Picture::spatial);
            report.sensitivity = searched.and_then(|searched| searched.sensitivity.clone());
            write_report(&report, &self.options.out, &formats(study))
                .map_err(anyhow::Error::from)?;
        } else {
            let path = self.options.out.join("result.json");
            report::write_json(&path, &result).map_err(anyhow::Error::from)?;
        }
        Ok(result)
    }

    /// The workspaces by inverse kinematics, if the study asks for it.
    fn check(
        &self,
        limits: &ArtificialLimits,
        best: f64,
    ) -> Result<Option<LockedJointEstimate>, RunError> {
        let session = &self.ready.session;
        let checked = Checked {
            study: self.study,
            robot: &self.study.design.robot,
            limits,
            failures: &self.study.failures,
            poses: self.hybrid.check_poses,
        };
        let watch = |done: u64, of: u64| {
            let what = "checking by inverse kinematics";
            session.progress.update(done, of, best, what);
        };
        let stop = || session.interrupt.load(Ordering::SeqCst);
        let counted = checked.count(&watch, &stop);
        match stop() {
            true => Err(RunError::Interrupted),
            false => Ok(counted),
        }
    }

    fn report<'r>(
        &'r self,
        finding: &HybridFinding<'r>,
        limits: &'r ArtificialLimits,
        result_json: Value,
    ) -> Report<'r> {
        let study = self.study;
        let robot = &study.design.robot;
        let optimum = finding.optimum;
        Report {
            title: study.title.clone().unwrap_or_else(|| study.name.clone()),
            study: study.name.clone(),
            robot: robot.name.clone(),
            source: robot.source.clone().unwrap_or_default(),
            task: study.task.to_string(),
            failures_label: failures_label(study),
            status: status(optimum).into(),
            failures: &study.failures,
            sizes: finding.sizes,
            unit: study.task.unit().into(),
            limits,
            links: &[],
            workspace: None,
            figures: Vec::new(),
            points: None,
            files: Vec::new(),
            convergence: optimum.map(|optimum| convergence(study, optimum, self.searching)),
            sensitivity: None,
            result_json,
            study_toml: self.ready.study_toml.clone(),
            provenance: provenance_rows(study, finding.threads),
            notes: finding.notes.to_vec(),
        }
    }

    /// What a reader of the numbers must not miss.
    fn notes(
        &self,
        atlas: &Atlas,
        sizes: &WorkspaceSizes,
        limits: &ArtificialLimits,
        searched: bool,
    ) -> Vec<String> {
        let robot = &self.study.design.robot;
        let mut notes: Vec<String> = self.verdict.iter().map(structure::note).collect();
        notes.extend(size_notes(sizes, limits, robot, searched));
        let counts = atlas.counts();
        if counts.failed > 0 {
            notes.push(format!(
                "The pre-images of {} of {} reachable samples failed a check of completeness; they \
                 count with what was found.",
                counts.failed, counts.reachable
            ));
        }
        if !atlas.plan().sampling.uses_turns() {
            notes.push(
                "Joint 1 slides, so task points at all azimuths were sampled. No map is drawn: maps \
                 show workspaces that turn with joint 1."
                    .into(),
            );
        }
        let slides = |index: &usize| robot.joint_kind(*index) == JointKind::Prismatic;
        for index in (0..robot.joints()).filter(slides) {
            notes.push(format!(
                "Figures and tables of limits show prismatic joint {} with its stroke as half a \
                 turn; result.json has metres.",
                index + 1
            ));
        }
        notes
    }
}

/// What the check says about the number that it checks.
fn check_notes(check: &LockedJointEstimate, sizes: &WorkspaceSizes) -> Vec<String> {
    let reported = locked_check::share(sizes);
    let said = locked_check::sentence(check, &reported);
    let contradiction = locked_check::contradiction(check, &reported);
    [said].into_iter().chain(contradiction).collect()
}
