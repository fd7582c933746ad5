//! The content of `result.json` of a study of one pose whose pre-image is a surface, described in
//! `docs/result.md`, and what its report shows.

use super::manifold_report::{joint_rows, pose_rows, verdict};
use super::manifold_result::{Joints, put_tolerance, residual, robot_notes};
use super::report_parts::{failures_label, provenance_rows};
use super::result::{SCHEMA, provenance};
use super::settings::{Manifolds, Study};
use crate::angle::AngleSet;
use crate::manifold::{Surface, SurfaceEvidence};
use crate::report::{ManifoldCurve, ManifoldFigure, ManifoldReport, SurfaceSummary};
use crate::workspace::{ArtificialLimits, PoseTolerance};
use serde_json::{Value, json};

/// Everything that a finished study of a surface knows.
pub(super) struct SurfaceFinding<'a> {
    pub study: &'a Study,
    pub manifolds: &'a Manifolds,
    pub surface: &'a Surface<'a>,
    /// Joints (from 0) that slices of the grid hold.
    pub held: &'a [usize],
    /// Values of each.
    pub values: usize,
    pub joint_ranges: &'a [AngleSet],
    /// Of the joint ranges, and with limits of T.
    pub evidence: Vec<SurfaceEvidence>,
    pub tolerance: Option<&'a PoseTolerance>,
    /// The artificial limits in internal variables, if there are any.
    pub limits: Option<&'a ArtificialLimits>,
    /// Metres, and radians of orientation.
    pub residual: [f64; 2],
    pub seconds: Value,
    pub threads: usize,
}

/// How sure it is that the sets are whole.
enum Evidence {
    Proved,
    /// A part on which a larger share of random starts would land is excluded with 95 %
    /// confidence.
    Sampled(f64),
    Unknown,
}

impl SurfaceFinding<'_> {
    pub fn to_json(&self) -> Value {
        let (study, surface) = (self.study, self.surface);
        let mut result = json!({
            "schema": SCHEMA,
            "study": study.name,
            "kind": study.question.kind(),
            "status": "done",
            "pose": self.manifolds.pose,
            "degree_of_redundancy": study.design.robot.degree_of_redundancy(study.task),
            "manifolds": [],
            "slices": {
                "joints": self.held_numbers(),
                "values_per_joint": self.values,
                "count": surface.grid,
                "added": surface.slices.len() - surface.grid,
                "with_curves": self.met(),
                "curves": self.curves(),
                "failed": surface.failed,
            },
        });
        let joints = Joints::of(&study.design.robot);
        joints.put_ranges(&mut result, self.joint_ranges);
        result["completeness"] = match self.completeness() {
            Evidence::Proved => json!({ "kind": "proved" }),
            Evidence::Sampled(share) => json!({ "kind": "sampled", "missed_share": share }),
            Evidence::Unknown => json!({ "kind": "unknown" }),
        };
        result["seeds"] = json!(surface.seeds + surface.starts);
        result["landed"] = json!(surface.landings.len());
        result["residual"] = residual(study.task, self.residual);
        if let Some(tolerance) = self.tolerance {
            put_tolerance(&mut result, study, self.manifolds, tolerance);
        }
        result["notes"] = json!(self.notes());
        result["seconds"] = self.seconds.clone();
        result["provenance"] = provenance(study, self.threads);
        result
    }

    fn held_numbers(&self) -> Vec<usize> {
        self.held.iter().map(|joint| joint + 1).collect()
    }

    /// Slices with curves.
    fn met(&self) -> usize {
        let slices = self.surface.slices.iter();
        slices.filter(|slice| !slice.curves.is_empty()).count()
    }

    fn curves(&self) -> usize {
        self.surface
            .slices
            .iter()
            .map(|slice| slice.curves.len())
            .sum()
    }

    fn completeness(&self) -> Evidence {
        let surface = self.surface;
        if surface.is_out_of_reach {
            return Evidence::Proved;
        }
        if surface.starts == 0 || self.evidence.iter().any(|evidence| evidence.outside > 0) {
            return Evidence::Unknown;
        }
        // The rule of three: of n tries without a miss, with a share of 3/n there would have been
        // one with a probability of 95 %.
        let tries = match surface.landings.is_empty() {
            true => surface.starts,
            false => self.evidence.first().map_or(0, |evidence| evidence.landed),
        };
        match tries {
            0 => Evidence::Unknown,
            tries => Evidence::Sampled((3.0 / tries as f64).min(1.0)),
        }
    }

    /// What a reader of the numbers must not miss.
    fn notes(&self) -> Vec<String> {
        let surface = self.surface;
        let mut notes = Vec::new();
        match (surface.is_out_of_reach, surface.landings.is_empty()) {
            (true, _) => {
                notes.push("The pose is farther away than the robot can reach.".to_owned());
            }
            (_, true) => notes.push("No random start found the pose: it is out of reach.".into()),
            _ => notes.push(
                "The pre-image is a surface, of which curves on slices are known and no mesh: the \
                 number of its connected parts and their windings are not. A part that lies between \
                 all slices and on which no random start landed would be missing from the sets."
                    .into(),
            ),
        }
        let outside: usize = self.evidence.iter().map(|evidence| evidence.outside).sum();
        if outside > 0 {
            notes.push(format!(
                "{outside} random starts landed outside the sets, which are therefore incomplete: \
                 raise `slices`."
            ));
        }
        if surface.failed > 0 {
            notes.push(format!(
                "On {} slices a check failed: a curve did not close, or winding numbers do not sum \
                 to zero. They count with what was found, beside their neighbours.",
                surface.failed
            ));
        }
        let robot = &self.study.design.robot;
        notes.extend(robot_notes(robot, "Figures show"));
        if robot.physical_limits.is_some() {
            notes.push("Joint ranges are those inside the physical limits.".into());
        }
        notes
    }

    /// The report with `result.json`; `curves` are what its figure shows.
    pub fn report<'c>(
        &'c self,
        curves: &'c [ManifoldCurve],
        result: &Value,
        study_toml: &str,
    ) -> ManifoldReport<'c> {
        let study = self.study;
        let robot = &study.design.robot;
        let limits = self.limits;
        let figure = ManifoldFigure {
            curves,
            joint_ranges: self.joint_ranges,
            limits,
            critical_points: &[],
            crossings: &[],
            are_slices: true,
            title: robot.name.clone(),
        };
        ManifoldReport {
            title: study.title.clone().unwrap_or_else(|| study.name.clone()),
            study: study.name.clone(),
            robot: robot.name.clone(),
            source: robot.source.clone().unwrap_or_default(),
            task: study.task.to_string(),
            failures_label: failures_label(study),
            pose: pose_rows(&self.manifolds.pose),
            completeness: self.completeness_told(),
            winding_sum: Vec::new(),
            manifolds: Vec::new(),
            surface: Some(SurfaceSummary {
                dimension: self.held.len() + 1,
                held: self.held_numbers(),
                values: self.values,
                slices: self.met(),
                curves: self.curves(),
            }),
            joints: joint_rows(study, self.joint_ranges, limits, self.tolerance),
            verdict: self.tolerance.map(verdict),
            figure: (!curves.is_empty()).then_some(figure),
            view: None,
            vertices: None,
            result_json: result.clone(),
            study_toml: study_toml.to_owned(),
            provenance: provenance_rows(study, self.threads),
            notes: self.notes(),
        }
    }

    fn completeness_told(&self) -> String {
        match self.completeness() {
            Evidence::Proved => "proved".into(),
            Evidence::Sampled(share) => format!(
                "supported by evidence: no random start landed outside the ranges, so that parts on \
                 which more than {:.1} % of them would land are excluded with 95 % confidence",
                100.0 * share
            ),
            Evidence::Unknown => "not certain (see the notes)".into(),
        }
    }
}
