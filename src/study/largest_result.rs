//! The content of `result.json` of a search for the largest manifold, and what its page says.

use super::location_result::{limiting, location_json, manifolds_sentence, ranges_table};
use super::manifold_result::Joints;
use super::result::{SCHEMA, provenance};
use super::settings::Study;
use super::singular_settings::LargestManifold;
use crate::angle::Arc;
use crate::report::{Section, Table, joint_symbol};
use crate::singularity::{Candidate, Comparison, Largest, Measure};
use serde_json::{Value, json};

/// Everything that a finished search knows.
pub(super) struct LargestFinding<'a> {
    pub study: &'a Study,
    pub asked: &'a LargestManifold,
    /// Physical limits as arcs of internal joint variables.
    pub physical: &'a [Arc],
    pub found: &'a Largest,
    pub comparison: Option<&'a Comparison>,
    pub seconds: Value,
}

/// Numbers of starts at which the course of the search is reported.
const COURSE: [usize; 10] = [10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10_000];
/// A size within this of what is possible is as large as can be, radians.
const FULL: f64 = 1e-6;

impl LargestFinding<'_> {
    pub fn to_json(&self) -> Value {
        let (study, found) = (self.study, self.found);
        let joints = Joints::of(&study.design.robot);
        let mut result = json!({
            "schema": SCHEMA,
            "study": study.name,
            "kind": study.question.kind(),
            "status": "done",
            "largest_size": found.largest.size,
            "smallest_size": found.smallest.0.size,
            "most_possible": self.most(),
            "unit": "rad",
        });
        result["largest"] = self.located(&found.best, &found.largest, &joints);
        let mut smallest = location_json(&found.smallest.0, study, self.physical);
        joints.put_theta(&mut smallest, &found.smallest.1);
        result["smallest"] = smallest;
        let course = self.course().into_iter().map(|[starts, random, singular]| {
            json!({ "starts": starts as u64, "random": random, "singular": singular })
        });
        result["course"] = course.collect();
        let refined = found.refined.iter().zip(&found.evaluations);
        let refined = refined.map(|(candidate, evaluations)| {
            let mut value = self.candidate(candidate, &joints);
            value["evaluations"] = json!(evaluations);
            value
        });
        result["refined"] = refined.collect();
        let fronts = Measure::ALL.iter().zip(&found.pareto);
        let fronts = fronts.map(|(measure, front)| {
            let members = front.iter().map(|c| self.candidate(c, &joints));
            json!({ "measure": measure, "locations": members.collect::<Vec<Value>>() })
        });
        result["pareto"] = fronts.collect();
        if let Some(comparison) = self.comparison {
            result["distributions"] = json!({
                "random": quantiles(&comparison.random),
                "best_manipulability": quantiles(&comparison.manipulability),
                "best_fault_tolerant_manipulability": quantiles(&comparison.fault_tolerant),
            });
        }
        result["notes"] = json!(self.notes());
        result["seconds"] = self.seconds.clone();
        result["provenance"] = provenance(study, rayon::current_num_threads());
        result
    }

    /// The size of a location at which every joint moves as far as its limits let it.
    fn most(&self) -> f64 {
        self.physical.iter().map(Arc::width).sum()
    }

    fn located(
        &self,
        best: &Candidate,
        location: &crate::singularity::Location,
        joints: &Joints,
    ) -> Value {
        let mut value = location_json(location, self.study, self.physical);
        joints.put_theta(&mut value, &best.theta);
        value["dexterity"] = dexterity(best, joints);
        value
    }

    fn candidate(&self, candidate: &Candidate, joints: &Joints) -> Value {
        let mut value = json!({
            "size": candidate.size,
            "origin": candidate.origin,
            "rank": self.study.task.dimension() - candidate.loss,
        });
        joints.put_theta(&mut value, &candidate.theta);
        value["dexterity"] = dexterity(candidate, joints);
        value
    }

    /// Largest sizes over the first starts: number, of random locations, of singular ones.
    fn course(&self) -> Vec<[f64; 3]> {
        let starts = self.found.random.iter().map(|c| c.start + 1).max();
        let starts = starts
            .unwrap_or(0)
            .max(self.asked.singularities.starts as usize);
        let mut counts: Vec<usize> = COURSE.into_iter().filter(|n| *n < starts).collect();
        counts.push(starts);
        let largest = |all: &[Candidate], n: usize| {
            let first = all.iter().filter(|c| c.start < n);
            first.map(|c| c.size).fold(0.0, f64::max)
        };
        let row = |n: usize| {
            let (random, singular) = (&self.found.random, &self.found.singular);
            [n as f64, largest(random, n), largest(singular, n)]
        };
        counts.into_iter().map(row).collect()
    }

    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.found.largest.size > self.most() - FULL {
            notes.push(
                "Every joint moves as far as it can at this location, so that no location is \
                 larger; among such locations the one with the least condition number is given."
                    .into(),
            );
        }
        if self.study.design.robot.physical_limits.is_some() {
            notes.push("Joint ranges and sizes are those inside the physical limits.".into());
        }
        notes
    }
}

fn dexterity(candidate: &Candidate, joints: &Joints) -> Value {
    let found = &candidate.dexterity;
    let mut value = json!({
        "condition_number": found.condition,
        "manipulability": found.manipulability,
        "fault_tolerant_manipulability": found.fault_tolerant,
    });
    value["best_condition_at"] = joints.configuration(&found.theta);
    value
}

/// Least, quartiles and greatest.
fn quantiles(sizes: &[f64]) -> Value {
    let mut sorted = sizes.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let last = sorted.len().saturating_sub(1) as f64;
        sorted.get((last * share).round() as usize).copied()
    };
    json!({ "min": at(0.0), "q25": at(0.25), "median": at(0.5), "q75": at(0.75), "max": at(1.0) })
}

pub(super) fn summary(finding: &LargestFinding) -> Vec<String> {
    let found = finding.found;
    let short = limiting(&found.largest, finding.physical);
    let short: Vec<String> = short
        .iter()
        .map(|(joint, missing)| format!("{} (by {missing:.4} rad)", joint_symbol(joint + 1)))
        .collect();
    let limiting = match short.is_empty() {
        true => "No joint falls short of what its limits allow.".to_owned(),
        false => format!(
            "Joints that fall short of their whole range: {}.",
            short.join(", ")
        ),
    };
    vec![
        format!(
            "The largest location found has a size (sum of all joint ranges) of {:.6} rad, of {:.4} \
             rad that would be possible; the smallest found has {:.6} rad.",
            found.largest.size,
            finding.most(),
            found.smallest.0.size
        ),
        format!("{} {limiting}", manifolds_sentence(&found.largest)),
    ]
}

pub(super) fn sections(finding: &LargestFinding) -> Vec<Section> {
    let (study, found) = (finding.study, finding.found);
    let robot = &study.design.robot;
    let mut course = Table::new(&[
        "random starts",
        "largest random location (rad)",
        "largest singular location (rad)",
    ]);
    for [starts, random, singular] in finding.course() {
        let sizes = [random, singular].map(|size| format!("{size:.4}"));
        course
            .rows
            .push([vec![format!("{starts}")], sizes.to_vec()].concat());
    }
    let mut refined = Table::new(&[
        "rank",
        "size (rad)",
        "least condition number",
        "locations computed",
    ]);
    for (candidate, evaluations) in found.refined.iter().zip(&found.evaluations) {
        refined.rows.push(vec![
            (study.task.dimension() - candidate.loss).to_string(),
            format!("{:.6}", candidate.size),
            format!("{:.2}", candidate.dexterity.condition),
            evaluations.to_string(),
        ]);
    }
    let mut nodes = Table::new(&["rank", "branches", "configuration (deg)"]);
    let joints = Joints::of(robot);
    for node in &found.largest.nodes {
        let angle = |joint: usize| {
            let turns = if joints.slides[joint] { 0.0 } else { 360.0 };
            let value = joints.outer(joint, &node.theta);
            let value = match turns > 0.0 {
                true => value - turns * (value / turns).round(),
                false => value,
            };
            format!("{:.3}", if value.abs() < 5e-4 { 0.0 } else { value })
        };
        let angles: Vec<String> = (0..node.theta.len()).map(angle).collect();
        nodes.rows.push(vec![
            (study.task.dimension() - node.loss).to_string(),
            node.branches.to_string(),
            format!("({})", angles.join(", ")),
        ]);
    }
    vec![
        Section {
            heading: "Joint ranges at the largest location".into(),
            text: "Unions over all self-motion manifolds of the location.".into(),
            table: ranges_table(&found.largest, robot, finding.physical),
        },
        Section {
            heading: "Singular configurations on its manifolds".into(),
            text: String::new(),
            table: nodes,
        },
        Section {
            heading: "Course of the search".into(),
            text: "Largest sizes among the locations of the first random starts and of the \
                   singular configurations reached from them, before refinement [S1 Table II]."
                .into(),
            table: course,
        },
        Section {
            heading: "Refined candidates".into(),
            text: "Each candidate keeps its rank while its location is moved.".into(),
            table: refined,
        },
    ]
}
