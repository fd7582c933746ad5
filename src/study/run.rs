//! Runs a validated study.

use super::checkpoint::Store;
use super::optimise::{Optimum, Session, search};
use super::planar_arm::PlanarStudy;
use super::result::Finding;
use super::settings::{FigureFormat, Question, Study};
use super::{check_folder, picture};
use crate::diagnostic::{InputError, Problem};
use crate::report::{
    self, Convergence, ConvergencePoint, Format, Report, WorkspaceFigure, write_report,
};
use crate::workspace::{ArtificialLimits, WorkspaceMap, WorkspaceSizes};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Where and how a study runs; nothing here changes its result.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// The report folder.
    pub out: PathBuf,
    /// Continue from the folder's checkpoint, if there is one.
    pub resume: bool,
    /// Replace a report that is already there.
    pub overwrite: bool,
    /// Number of threads; one per core if none is given.
    pub threads: Option<usize>,
    /// Set from outside to stop at the next checkpoint.
    pub interrupt: Arc<AtomicBool>,
}

/// Watches a run.
pub trait Progress: Send + Sync {
    /// `done` of `total` steps are done and the best score so far is `best` (not finite if there
    /// is none); `message` says what is going on.
    fn update(&self, done: u64, total: u64, best: f64, message: &str);
}

/// Why a run has no result.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The input or the report folder is at fault.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The interrupt flag was set; a checkpoint is in the report folder.
    #[error("interrupted")]
    Interrupted,
    /// Something else went wrong.
    #[error(transparent)]
    Failed(#[from] anyhow::Error),
}

/// Runs `study` and returns the content of `result.json`.
///
/// # Errors
/// The report folder is at fault, the run was interrupted, or it failed.
pub fn run(
    study: &Study,
    options: &RunOptions,
    progress: Arc<dyn Progress>,
) -> Result<Value, RunError> {
    check_folder(options)?;
    let threads = options.threads.unwrap_or(0);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(anyhow::Error::from)?;
    pool.install(|| run_in_pool(study, options, progress))
}

fn run_in_pool(
    study: &Study,
    options: &RunOptions,
    progress: Arc<dyn Progress>,
) -> Result<Value, RunError> {
    let mut store = Store::new(&options.out, study);
    let saved = if options.resume { store.load()? } else { None };
    let study_toml = study.to_toml(&options.out).map_err(anyhow::Error::from)?;
    if saved.is_none() {
        if options.resume
            && let Some(result) = finished(study, options, &study_toml)?
        {
            return Ok(result);
        }
        store.remove();
    }
    report::write_text(&options.out.join("study.toml"), &study_toml)
        .map_err(anyhow::Error::from)?;
    let arm = PlanarStudy::new(study)?;
    let session = Session {
        store: Arc::new(store),
        progress,
        interrupt: options.interrupt.clone(),
    };
    let (arm, limits, joint_limits, optimum, radii) = match &study.question {
        Question::Estimate(estimate) => {
            let given = estimate.limits.to_limits();
            let limits = arm.to_links(&given);
            (arm, limits, given, None, estimate.radii.clone())
        }
        Question::Optimise(optimise) => {
            let optimum = search(optimise, &arm, study.seed, saved, &session)?;
            let arm = arm.with_lengths(optimum.design.lengths.clone());
            let limits = optimum.design.limits.clone();
            let joint_limits = arm.to_joints(&limits);
            (arm, limits, joint_limits, Some(optimum), Vec::new())
        }
    };
    let outcome = Outcome {
        study,
        arm,
        limits,
        joint_limits,
        optimum,
        radii,
        study_toml,
        searched: session.store.seconds(),
    };
    let result = outcome.write(options, &session)?;
    session.store.remove();
    Ok(result)
}

/// The result of a run that needs no resuming, because it has ended.
fn finished(
    study: &Study,
    options: &RunOptions,
    study_toml: &str,
) -> Result<Option<Value>, RunError> {
    let read = |name: &str| std::fs::read_to_string(options.out.join(name)).ok();
    let Some(text) = read("result.json") else {
        return Ok(None);
    };
    let result: Value = serde_json::from_str(&text).unwrap_or_default();
    let same_robot = result["provenance"]["design_sha256"] == study.design.sha256.as_str();
    if !same_robot || read("study.toml").as_deref() != Some(study_toml) {
        let problem = Problem {
            message: "the run cannot be resumed".into(),
            found: "the finished report of another study, robot or seed".into(),
            expected: "the checkpoint of this study".into(),
            help: "add `--overwrite` to replace it, or choose another `--out`".into(),
        };
        return Err(InputError::in_file(&options.out.display().to_string(), problem).into());
    }
    Ok(Some(result))
}

/// A study whose search, if any, is over.
struct Outcome<'a> {
    study: &'a Study,
    arm: PlanarStudy,
    /// Limits between links, as the arm's workspaces have them.
    limits: ArtificialLimits,
    /// The same limits of the joint variables, as tables have them.
    joint_limits: ArtificialLimits,
    optimum: Option<Optimum>,
    radii: Vec<f64>,
    study_toml: String,
    searched: f64,
}

impl Outcome<'_> {
    /// Measures the workspaces, draws the figures and writes the report.
    fn write(&self, options: &RunOptions, session: &Session) -> Result<Value, RunError> {
        let best = self.optimum.as_ref().map_or(f64::NAN, Optimum::score);
        let tell = |done, message: &str| session.progress.update(done, 4, best, message);
        tell(0, "measuring workspaces");
        let started = Instant::now();
        let sizes = self.arm.sizes(&self.limits);
        let measured = started.elapsed().as_secs_f64();
        tell(1, "drawing the workspace");
        let map = self.arm.map(&self.limits);
        tell(2, "varying the limits");
        let unit = self.study.task.unit();
        let mark = match self.optimum {
            Some(_) => "optimum",
            None => "given limits",
        };
        let figures = self.study.report.figures;
        let sensitivity =
            figures.then(|| picture::sensitivity(&self.arm, &self.limits, unit, mark));
        tell(3, "writing the report");
        let notes = self.notes(&sizes);
        let finding = Finding {
            study: self.study,
            arm: &self.arm,
            limits: &self.limits,
            sizes: &sizes,
            optimum: self.optimum.as_ref(),
            radii: &self.radii,
            seconds: json!({
                "total": session.store.seconds(),
                "atlas": 0.0,
                "search": if self.optimum.is_some() { self.searched } else { 0.0 },
                "measure": measured,
            }),
            threads: rayon::current_num_threads(),
            notes: &notes,
        };
        let mut report = self.report(&finding, &map, &sizes);
        report.sensitivity = sensitivity;
        let result = report.result_json.clone();
        let formats: Vec<Format> = self.study.report.formats.iter().map(format_of).collect();
        if figures {
            write_report(&report, &options.out, &formats).map_err(anyhow::Error::from)?;
        } else {
            let path = options.out.join("result.json");
            report::write_json(&path, &result).map_err(anyhow::Error::from)?;
        }
        Ok(result)
    }

    fn report<'r>(
        &'r self,
        finding: &Finding<'r>,
        map: &'r WorkspaceMap,
        sizes: &'r WorkspaceSizes,
    ) -> Report<'r> {
        let study = self.study;
        let robot = &study.design.robot;
        let title = study.title.clone().unwrap_or_else(|| study.name.clone());
        Report {
            study: study.name.clone(),
            robot: robot.name.clone(),
            source: robot.source.clone().unwrap_or_default(),
            task: study.task.to_string(),
            failures_label: self.failures_label(),
            status: finding.status().into(),
            failures: self.arm.failures(),
            sizes,
            unit: study.task.unit().into(),
            limits: &self.joint_limits,
            links: &self.arm.lengths,
            workspace: Some(WorkspaceFigure {
                map,
                limits: &self.limits,
                links: &self.arm.lengths,
                arm_angles: picture::posture(&self.arm, &self.limits, map),
                title: robot.name.clone(),
            }),
            figures: Vec::new(),
            points: None,
            convergence: self
                .optimum
                .as_ref()
                .map(|optimum| self.convergence(optimum)),
            sensitivity: None,
            result_json: finding.to_json(),
            study_toml: self.study_toml.clone(),
            provenance: self.provenance(finding.threads),
            notes: finding.notes.to_vec(),
            title,
        }
    }

    fn failures_label(&self) -> String {
        let numbers: Vec<String> = self
            .study
            .failures
            .numbers()
            .map(|j| j.to_string())
            .collect();
        if numbers.len() == self.study.design.robot.joints() {
            "any single joint".into()
        } else {
            format!("one of the joints {}", numbers.join(", "))
        }
    }

    fn convergence(&self, optimum: &Optimum) -> Convergence {
        let links = match &self.study.question {
            Question::Optimise(optimise) => optimise.search.links.is_some(),
            Question::Estimate(_) => false,
        };
        let points = optimum.history().into_iter().map(|point| ConvergencePoint {
            evaluations: point.evaluations,
            best: point.best,
            mean: point.mean,
        });
        Convergence {
            method: match &self.study.question {
                Question::Optimise(optimise) => optimise.optimiser.method().replace('-', " "),
                Question::Estimate(_) => String::new(),
            },
            score_label: if links { "S_F / S_0max" } else { "S_F" }.into(),
            unit: if links { "" } else { self.study.task.unit() }.into(),
            points: points.collect(),
            seconds: Some(self.searched),
        }
    }

    fn provenance(&self, threads: usize) -> Vec<(String, String)> {
        let study = self.study;
        let row = |name: &str, value: String| (name.to_owned(), value);
        vec![
            row("faultspace", env!("CARGO_PKG_VERSION").into()),
            row("seed", study.seed.to_string()),
            row("threads", threads.to_string()),
            row("robot file, SHA-256", study.design.sha256.clone()),
        ]
    }

    /// What a reader of the numbers must not miss.
    fn notes(&self, sizes: &WorkspaceSizes) -> Vec<String> {
        let mut notes = Vec::new();
        if sizes.fault_tolerant.value == 0.0 {
            notes.push(match &self.optimum {
                None => "The fault-tolerant workspace is empty for these limits.".into(),
                Some(_) => "No limits with a fault-tolerant workspace were found.".into(),
            });
        }
        for (number, limit) in (1..).zip(self.joint_limits.joints()) {
            // Narrower than a control system resolves.
            if limit.width() < 1e-4 {
                let angle = limit.centre().to_degrees();
                notes.push(format!(
                    "Joint {number} is held still at {angle:.4}° before a failure. Set \
                     `min_width_deg` in `[search]` to ask for limits that leave it room."
                ));
            }
        }
        notes
    }
}

fn format_of(format: &FigureFormat) -> Format {
    match format {
        FigureFormat::Png => Format::Png,
        FigureFormat::Svg => Format::Svg,
    }
}
