//! Runs a study with the exact estimator of planar arms.

use super::optimise::{Optimum, Session, Terms, search};
use super::picture;
use super::planar_arm::PlanarStudy;
use super::planar_winner::PlanarWinner;
use super::report_parts::{convergence, failures_label, formats, provenance_rows, size_notes};
use super::result::Finding;
use super::run::{Ready, RunError, RunOptions};
use super::settings::{Estimator, Optimise, Question, Study};
use super::surrogate_search::{SurrogateTrace, search_through};
use crate::optimiser::CoordinateAscentSettings;
use crate::report::{self, Figure, Report, WorkspaceFigure, write_report};
use crate::workspace::{ArtificialLimits, WorkspaceMap, WorkspaceSizes};
use serde_json::{Value, json};
use std::time::Instant;

/// Most sweeps for pose tasks, whose score costs milliseconds.
pub(super) const POSE_SWEEPS: usize = 25;

/// Relative gain of a sweep below which pose tasks have converged: their score is good to 1e-3.
pub(super) const POSE_TOLERANCE: f64 = 1e-5;

/// Runs `study` to its report and returns the content of `result.json`.
///
/// # Errors
/// The run was interrupted, or a file could not be written.
pub(super) fn run(study: &Study, options: &RunOptions, ready: Ready) -> Result<Value, RunError> {
    let arm = PlanarStudy::new(study)?;
    ready.begin(options)?;
    let session = ready.session;
    let mut surrogate = None;
    let (arm, limits, joint_limits, optimum, radii) = match &study.question {
        Question::Estimate(estimate) => {
            let given = estimate.limits.to_limits(&study.design.robot);
            let limits = arm.to_links(&given);
            (arm, limits, given, None, estimate.radii.clone())
        }
        Question::Optimise(optimise) => {
            let saved = ready.saved;
            let (optimum, trace) = find(study, optimise, &arm, saved, &session)?;
            surrogate = trace;
            let arm = arm.with_lengths(optimum.design.lengths.clone());
            let limits = optimum.design.limits.clone();
            let joint_limits = arm.to_joints(&limits);
            (arm, limits, joint_limits, Some(optimum), Vec::new())
        }
        _ => return Err(anyhow::anyhow!("this kind of study measures no workspace").into()),
    };
    let outcome = Outcome {
        study,
        arm,
        limits,
        joint_limits,
        optimum,
        surrogate,
        radii,
        study_toml: ready.study_toml,
        searched: session.store.seconds(),
    };
    let result = outcome.write(options, &session)?;
    session.store.remove();
    Ok(result)
}

fn find(
    study: &Study,
    optimise: &Optimise,
    arm: &PlanarStudy,
    saved: Option<super::checkpoint::Stage>,
    session: &Session,
) -> Result<(Optimum, Option<SurrogateTrace>), RunError> {
    let space = arm.design_space(optimise);
    let objective = arm.objective(space.clone(), optimise.search.links.is_some());
    let start = optimise.start.as_ref();
    let limits = start.map(|start| arm.to_links(&start.to_limits(&study.design.robot)));
    let pose = arm.is_pose();
    let starts = limits.iter().map(|limits| space.point(limits)).collect();
    let terms = Terms {
        space: &space,
        objective: &objective,
        starts,
        samples: None,
        coarse: Vec::new(),
        short_step: CoordinateAscentSettings::default().short_step,
        max_sweeps: if pose { POSE_SWEEPS } else { usize::MAX },
        tolerance: if pose { POSE_TOLERANCE } else { 0.0 },
        truth: None,
    };
    if let Estimator::Surrogate { surrogate } = &study.estimator {
        let found = search_through(study, optimise, surrogate, &terms, saved, session)?;
        return Ok((found.0, Some(found.1)));
    }
    let optimum = search(optimise, &terms, study.seed, saved, session)?;
    Ok((optimum, None))
}

/// Links this far apart, as a share of the total length, are different robots.
const APART: f64 = 0.03;

/// The warning that the optimum is one of a whole family of robots.
fn ridge(optimum: &Optimum) -> Option<String> {
    let best = &optimum.design.lengths;
    let total: f64 = best.iter().sum();
    let range = |link: usize| {
        let lengths = optimum.equals.iter().map(|design| design.lengths[link]);
        lengths.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], length| {
            [low.min(length), high.max(length)]
        })
    };
    let ranges: Vec<[f64; 2]> = (0..best.len()).map(range).collect();
    let is_apart = |[low, high]: &[f64; 2]| high - low > APART * total;
    if !ranges.iter().any(is_apart) {
        return None;
    }
    let all = (1..)
        .zip(&ranges)
        .map(|(link, [low, high])| format!("l_{link} from {low:.2} to {high:.2} m"));
    Some(format!(
        "The optimum is a flat ridge: {} robots with the same score to 0.1 % were found ({}). Along \
         such a ridge robots may degenerate, down to workspaces of no area. Ask for limits with a \
         least width (`min_width_deg`), or choose among them by another measure.",
        optimum.equals.len(),
        all.collect::<Vec<String>>().join(", ")
    ))
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
    surrogate: Option<SurrogateTrace>,
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
        let found = self.optimum.is_some();
        let mut notes = size_notes(&sizes, &self.joint_limits, &self.study.design.robot, found);
        notes.extend(self.optimum.as_ref().and_then(ridge));
        notes.extend(self.surrogate.iter().flat_map(SurrogateTrace::notes));
        let finding = Finding {
            study: self.study,
            arm: &self.arm,
            limits: &self.limits,
            sizes: &sizes,
            optimum: self.optimum.as_ref(),
            surrogate: self.surrogate.as_ref(),
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
        let winner = self.winner(session)?;
        let pair = winner.as_ref().map(|winner| winner.pair(&map, &sizes));
        let tolerances = winner
            .as_ref()
            .map(|w| w.tolerances.figure(finding.title()));
        let mut report = self.report(&finding, &map, &sizes);
        report.sensitivity = sensitivity;
        report.figures = pair.iter().map(|figure| figure as &dyn Figure).collect();
        let last = tolerances.iter().map(|figure| figure as &dyn Figure);
        report.figures.extend(last);
        if let Some(winner) = &winner {
            report.files = winner.files();
            winner.add_to(&mut report.result_json);
        }
        let result = report.result_json.clone();
        if figures {
            write_report(&report, &options.out, &formats(self.study))
                .map_err(anyhow::Error::from)?;
        } else {
            for (name, text) in &report.files {
                let path = options.out.join(name);
                report::write_text(&path, text).map_err(anyhow::Error::from)?;
            }
            let path = options.out.join("result.json");
            report::write_json(&path, &result).map_err(anyhow::Error::from)?;
        }
        Ok(result)
    }

    /// The robot found, if links were searched.
    fn winner(&self, session: &Session) -> Result<Option<PlanarWinner<'_>>, RunError> {
        let optimise = match &self.study.question {
            Question::Optimise(optimise) if optimise.search.links.is_some() => optimise,
            _ => return Ok(None),
        };
        let (arm, limits) = (&self.arm, &self.limits);
        PlanarWinner::new(self.study, optimise, arm, limits, session).map(Some)
    }

    fn report<'r>(
        &'r self,
        finding: &Finding<'r>,
        map: &'r WorkspaceMap,
        sizes: &'r WorkspaceSizes,
    ) -> Report<'r> {
        let study = self.study;
        let robot = &study.design.robot;
        Report {
            study: study.name.clone(),
            robot: robot.name.clone(),
            source: robot.source.clone().unwrap_or_default(),
            task: study.task.to_string(),
            failures_label: failures_label(self.study),
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
                title: match finding.has_new_links() {
                    true => format!("found, from {}", robot.name),
                    false => robot.name.clone(),
                },
            }),
            convergence: self
                .optimum
                .as_ref()
                .map(|optimum| convergence(self.study, optimum, self.searched)),
            sensitivity: None,
            figures: Vec::new(),
            points: None,
            files: Vec::new(),
            result_json: finding.to_json(),
            study_toml: self.study_toml.clone(),
            provenance: provenance_rows(self.study, finding.threads),
            notes: finding.notes.to_vec(),
            title: finding.title(),
        }
    }
}
