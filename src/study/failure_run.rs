//! Runs `kind = "failure-experiment"`: joints lock on the way to goals [S1 §IV.D].

use super::location_result::{arm_pose, location_json, location_search};
use super::manifold_result::Joints;
use super::report_parts::{failures_label, formats, provenance_rows};
use super::result::{SCHEMA, provenance};
use super::run::{Ready, RunError, RunOptions};
use super::settings::Study;
use super::singular_settings::FailureStudy;
use crate::angle::Arc;
use crate::report::{
    ArmPosesFigure, Figure, FindingReport, GoalLocks, LockMark, LocksFigure, ReportError, Section,
    Table, write_finding_report,
};
use crate::singularity::{FailureExperiment, Lock};
use serde_json::{Value, json};
use std::sync::atomic::Ordering;

/// Runs `study` and returns the content of `result.json`.
///
/// # Errors
/// A file could not be written, the run was interrupted, or the robot cannot do the task.
pub(super) fn run(
    study: &Study,
    asked: &FailureStudy,
    options: &RunOptions,
    ready: Ready,
) -> Result<Value, RunError> {
    ready.begin(options)?;
    let progress = &ready.session.progress;
    let search = location_search(study)?;
    let robot = &study.design.robot;
    let start = asked.start().inner(robot);
    let failing: Vec<usize> = study.failures.numbers().map(|joint| joint - 1).collect();
    let mut experiments = Vec::new();
    for (index, goal) in asked.goals.iter().enumerate() {
        if ready.session.interrupt.load(Ordering::SeqCst) {
            return Err(RunError::Interrupted);
        }
        let message = format!("locking joints on the way to {}", goal.name);
        progress.update(index as u64, asked.goals.len() as u64, f64::NAN, &message);
        let theta = goal.configuration.inner(robot);
        let seed = study.seed.wrapping_add(index as u64);
        experiments.push(FailureExperiment::run(
            &search,
            (&start, &theta),
            &failing,
            &asked.settings(),
            seed,
        ));
    }
    let finding = FailureFinding {
        study,
        asked,
        experiments: &experiments,
        physical: search.physical(),
        start: &start,
    };
    let seconds = json!({ "total": ready.session.store.seconds() });
    let result = finding.to_json(seconds);
    finding
        .write(&result, options, &ready.study_toml)
        .map_err(anyhow::Error::from)?;
    ready.session.store.remove();
    Ok(result)
}

struct FailureFinding<'a> {
    study: &'a Study,
    asked: &'a FailureStudy,
    experiments: &'a [FailureExperiment],
    physical: &'a [Arc],
    start: &'a [f64],
}

impl FailureFinding<'_> {
    fn to_json(&self, seconds: Value) -> Value {
        let study = self.study;
        let joints = Joints::of(&study.design.robot);
        let mut result = json!({
            "schema": SCHEMA,
            "study": study.name,
            "kind": study.question.kind(),
            "status": "done",
            "failures": study.failures.numbers().collect::<Vec<_>>(),
            "locks_per_joint": self.asked.locks,
        });
        result["start"] = joints.configuration(self.start);
        let each = self.asked.goals.iter().zip(self.experiments);
        result["goals"] = each
            .map(|(goal, experiment)| self.goal(&goal.name, experiment, &joints))
            .collect();
        result["notes"] = json!(self.notes());
        result["seconds"] = seconds;
        result["provenance"] = provenance(study, rayon::current_num_threads());
        result
    }

    fn goal(&self, name: &str, experiment: &FailureExperiment, joints: &Joints) -> Value {
        let outcomes = experiment.joints.iter().map(|outcome| {
            json!({
                "joint": outcome.joint + 1,
                "locks": outcome.tried,
                "reached": outcome.reached,
                "share_of_angles": outcome.share,
                "worst_position_error_m": outcome.worst_position_error,
                "worst_orientation_error_deg": outcome.worst_orientation_error.to_degrees(),
            })
        });
        let failed = experiment.locks.iter().filter(|lock| !lock.reached);
        let failed = failed.map(|lock| {
            let mut theta = vec![0.0; lock.theta.len()];
            theta[lock.joint] = lock.angle;
            let unit = if joints.slides[lock.joint] {
                "m"
            } else {
                "deg"
            };
            let mut value = json!({
                "joint": lock.joint + 1,
                "share": lock.share,
                format!("locked_at_{unit}"): joints.outer(lock.joint, &theta),
                "solution_exists": lock.exists,
                "position_error_m": lock.position_error,
                "offset_m": lock.offset,
                "orientation_error_deg": lock.orientation_error.to_degrees(),
            });
            value["nearest"] = joints.configuration(&lock.theta);
            value
        });
        let worst =
            |error: fn(&Lock) -> f64| experiment.locks.iter().map(error).fold(0.0, f64::max);
        let mut value = json!({
            "name": name,
            "success": experiment.success(),
            "worst_position_error_m": worst(|lock| lock.position_error),
            "worst_orientation_error_deg": worst(|lock| lock.orientation_error).to_degrees(),
        });
        value["joints"] = outcomes.collect();
        value["failed_locks"] = failed.collect();
        value["location"] = location_json(&experiment.location, self.study, self.physical);
        value
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        for (goal, experiment) in self.asked.goals.iter().zip(self.experiments) {
            let odd = experiment
                .locks
                .iter()
                .filter(|l| l.exists != l.reached)
                .count();
            if odd > 0 {
                notes.push(format!(
                    "Goal {}: inverse kinematics and the joint ranges of the goal's manifolds \
                     disagree on {odd} of the locks; the goal is counted as reached only where inverse \
                     kinematics reached it.",
                    goal.name
                ));
            }
        }
        if self.study.design.robot.physical_limits.is_some() {
            notes.push(
                "Configurations before and after a failure stay inside the physical limits.".into(),
            );
        }
        notes
    }

    fn summary(&self) -> Vec<String> {
        let each = self.asked.goals.iter().zip(self.experiments);
        let mut lines = vec![format!(
            "The robot moves straight in joint space from its start to each goal; on the way {} \
             locks where it stands, and the other joints try to reach the goal.",
            failures_label(self.study)
        )];
        lines.extend(each.map(|(goal, experiment)| {
            format!(
                "{}: reached after {:.1} % of the locks (size of the location {:.4} rad).",
                goal.name,
                100.0 * experiment.success(),
                experiment.location.size
            )
        }));
        lines
    }

    fn sections(&self) -> Vec<Section> {
        let each = self.asked.goals.iter().zip(self.experiments);
        let section =
            |(goal, experiment): (&super::singular_settings::NamedGoal, &FailureExperiment)| {
                let mut table = Table::new(&[
                    "joint",
                    "locks",
                    "goal reached",
                    "share of angles",
                    "worst position error (m)",
                    "worst orientation error (deg)",
                ]);
                for outcome in &experiment.joints {
                    let orientation = outcome.worst_orientation_error.to_degrees();
                    table.rows.push(vec![
                        (outcome.joint + 1).to_string(),
                        outcome.tried.to_string(),
                        outcome.reached.to_string(),
                        format!("{:.4}", outcome.share),
                        error_cell(outcome.worst_position_error, 1e-6),
                        error_cell(orientation, 1e-4),
                    ]);
                }
                Section {
                    heading: format!("Goal: {}", goal.name),
                    text:
                        "Share of angles: the part of the angles the joint sweeps on its way from \
                       which the goal can be reached, from the joint's range over the goal's \
                       manifolds."
                            .into(),
                    table,
                }
            };
        each.map(section).collect()
    }

    fn write(
        &self,
        result: &Value,
        options: &RunOptions,
        study_toml: &str,
    ) -> Result<(), ReportError> {
        let study = self.study;
        let robot = &study.design.robot;
        let locks = self.locks_figure();
        let arms = self.worst_figure();
        let mut figures: Vec<&dyn Figure> = vec![&locks];
        figures.extend(arms.as_ref().map(|figure| figure as &dyn Figure));
        let report = FindingReport {
            title: study.title.clone().unwrap_or_else(|| study.name.clone()),
            study: study.name.clone(),
            robot: robot.name.clone(),
            source: robot.source.clone().unwrap_or_default(),
            summary: self.summary(),
            sections: self.sections(),
            figures,
            files: Vec::new(),
            tables: vec![("locks.csv", locks.table())],
            result_json: result.clone(),
            study_toml: study_toml.to_owned(),
            provenance: provenance_rows(study, rayon::current_num_threads()),
            notes: self.notes(),
        };
        write_finding_report(&report, &options.out, &formats(study), study.report.figures)?;
        Ok(())
    }

    fn locks_figure(&self) -> LocksFigure {
        let joints = Joints::of(&self.study.design.robot);
        let mark = |lock: &Lock| {
            let mut theta = vec![0.0; lock.theta.len()];
            theta[lock.joint] = lock.angle;
            LockMark {
                joint: lock.joint + 1,
                share: lock.share,
                angle: joints.outer(lock.joint, &theta),
                is_reached: lock.reached,
                position_error: lock.position_error,
                orientation_error: lock.orientation_error,
            }
        };
        let each = self.asked.goals.iter().zip(self.experiments);
        let goal = each.map(|(goal, experiment)| GoalLocks {
            name: goal.name.clone(),
            locks: experiment.locks.iter().map(mark).collect(),
        });
        LocksFigure {
            goals: goal.collect(),
            title: self.study.design.robot.name.clone(),
        }
    }

    /// The arm at the lock that leaves it farthest from its goal, beside the goal [S1 Fig. 8].
    fn worst_figure(&self) -> Option<ArmPosesFigure> {
        if self.study.task.is_planar() {
            return None;
        }
        let each = self.asked.goals.iter().zip(self.experiments);
        let failed = each.flat_map(|(goal, experiment)| {
            let failed = experiment.locks.iter().filter(|lock| !lock.reached);
            failed.map(move |lock| (goal, lock))
        });
        let (goal, lock) =
            failed.max_by(|a, b| a.1.position_error.total_cmp(&b.1.position_error))?;
        let robot = &self.study.design.robot;
        let wanted = arm_pose(robot, &goal.configuration.inner(robot), "goal".into());
        let joint = lock.joint + 1;
        let nearest = arm_pose(robot, &lock.theta, format!("joint {joint} locked"));
        Some(ArmPosesFigure {
            name: "worst_lock",
            poses: vec![wanted, nearest],
            caption: format!(
                "The worst failure: the goal {} in a configuration of the unharmed arm, and the \
                 nearest the arm gets with joint {joint} locked, {:.3} m away with the right \
                 orientation.",
                goal.name, lock.position_error
            ),
            title: robot.name.clone(),
        })
    }
}

/// An error with as many digits as mean something.
fn error_cell(value: f64, nothing: f64) -> String {
    if value < nothing {
        "0".into()
    } else {
        format!("{value:.4}")
    }
}
