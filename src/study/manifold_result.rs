//! The content of `result.json` and `manifolds.csv` of a study of one pose, described in
//! `docs/result.md`.

use super::result::{SCHEMA, limits_deg, provenance};
use super::settings::{Manifolds, Study};
use crate::angle::{AngleSet, Arc, degree_pairs};
use crate::design::{JointKind, Robot, TaskSpace};
use crate::kinematics::{JointScale, joint_scales};
use crate::manifold::{Completeness, CriticalPoint, PreImage, SelfMotionManifold};
use crate::report::Table;
use crate::workspace::{PoseTolerance, ranges_within};
use serde_json::{Value, json};

/// Everything that a finished study of one pose knows.
pub(super) struct ManifoldFinding<'a> {
    pub study: &'a Study,
    pub manifolds: &'a Manifolds,
    pub pre_image: &'a PreImage,
    /// Physical limits as arcs of internal joint variables.
    pub physical: &'a [Arc],
    pub tolerance: Option<&'a PoseTolerance>,
    /// Per manifold, where it enters or leaves the artificial limits; empty without limits.
    pub crossings: &'a [Vec<Vec<f64>>],
    /// Metres, and radians of orientation.
    pub residual: [f64; 2],
    pub seconds: Value,
    pub threads: usize,
}

impl ManifoldFinding<'_> {
    pub fn to_json(&self) -> Value {
        let (study, found) = (self.study, self.pre_image);
        let joints = Joints::of(&study.design.robot);
        let each = found.manifolds.iter().zip(self.crossings);
        let each = each.map(|(manifold, crossings)| {
            let own = self.ranges(std::slice::from_ref(manifold));
            let mut value = joints.manifold(manifold, &own);
            if self.manifolds.limits.is_some() {
                let points = crossings.iter().map(|theta| joints.configuration(theta));
                value["limit_crossings"] = points.collect();
            }
            value
        });
        let manifolds: Vec<Value> = each.collect();
        let mut result = json!({
            "schema": SCHEMA,
            "study": study.name,
            "kind": study.question.kind(),
            "status": "done",
            "pose": self.manifolds.pose,
            "degree_of_redundancy": 1,
            "manifolds": manifolds,
        });
        joints.put_ranges(&mut result, &self.ranges(&found.manifolds));
        result["winding_sum"] = json!(found.winding_sum());
        result["completeness"] = match found.completeness {
            Completeness::Proved => json!({ "kind": "proved" }),
            Completeness::Evidence(missed) => json!({ "kind": "evidence", "missed": missed }),
            Completeness::Unknown => json!({ "kind": "unknown" }),
        };
        result["seeds"] = json!(found.seeds);
        result["landed"] = json!(found.landed);
        result["residual"] = residual(study.task, self.residual);
        if let Some(tolerance) = self.tolerance {
            put_tolerance(&mut result, study, self.manifolds, tolerance);
        }
        result["notes"] = json!(self.notes());
        result["seconds"] = self.seconds.clone();
        result["provenance"] = provenance(study, self.threads);
        result
    }

    /// Angles of every joint over `manifolds`, inside the physical limits if the robot has any.
    pub fn ranges(&self, manifolds: &[SelfMotionManifold]) -> Vec<AngleSet> {
        if self.physical.iter().any(|arc| !arc.is_full()) {
            return ranges_within(manifolds, self.physical);
        }
        let joint = |joint| AngleSet::from_arcs(manifolds.iter().map(|m| m.joint_range(joint)));
        (0..self.physical.len()).map(joint).collect()
    }

    /// What a reader of the numbers must not miss.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        match (self.pre_image.completeness, self.pre_image.manifolds.len()) {
            (Completeness::Proved, 0) => {
                notes.push("The pose is farther away than the robot can reach.".into());
            }
            (_, 0) => notes.push("No random start found the pose: it is out of reach.".into()),
            (Completeness::Unknown, _) => notes.push(
                "A check failed: a curve did not close, or the winding numbers do not sum to zero. \
                 The pose may be a singular one; move it a little, or raise `seeds`."
                    .into(),
            ),
            _ => {}
        }
        notes.extend(robot_notes(
            &self.study.design.robot,
            "Figures and curves.vtk show",
        ));
        notes
    }
}

/// What a reader must know of prismatic joints and physical limits; `shown` begins the sentence on
/// what shows prismatic joints as angles.
pub(super) fn robot_notes(robot: &Robot, shown: &str) -> Vec<String> {
    let mut notes = Vec::new();
    for index in (0..robot.joints()).filter(|&k| robot.joint_kind(k) == JointKind::Prismatic) {
        notes.push(format!(
            "{shown} prismatic joint {} with its stroke as half a turn; result.json has metres.",
            index + 1
        ));
    }
    if robot.physical_limits.is_some() {
        notes.push(
                "Joint ranges are those inside the physical limits; lengths, windings, critical points \
                 and vertices are of the whole curves."
                    .into(),
            );
    }
    notes
}

/// Largest distance from the pose as `result.json` has it.
pub(super) fn residual(task: TaskSpace, [metres, radians]: [f64; 2]) -> Value {
    match task {
        TaskSpace::PlanarPose | TaskSpace::SpatialPose => json!({ "m": metres, "rad": radians }),
        _ => json!({ "m": metres }),
    }
}

/// What artificial limits make of the pose.
pub(super) fn put_tolerance(
    result: &mut Value,
    study: &Study,
    manifolds: &Manifolds,
    tolerance: &PoseTolerance,
) {
    if let Some(limits) = &manifolds.limits {
        result["limits_deg"] = limits_deg(limits);
        if !limits.lower.is_empty() {
            result["limits_m"] = json!({ "lower": limits.lower, "upper": limits.upper });
        }
    }
    let locks = (1..).zip(&tolerance.survives).map(|(joint, survives)| {
        let prone = study.failures.contains(joint);
        json!({ "joint": joint, "prone": prone, "tolerated": survives })
    });
    result["margin_deg"] = json!(study.margin_deg);
    result["locks"] = locks.collect();
    result["reached_within_limits"] = json!(tolerance.before_failure.contains(0.0));
    result["fault_tolerant"] = json!(tolerance.rotation_set.contains(0.0));
    result["rotation_set_deg"] = json!(degree_pairs(&tolerance.rotation_set));
}

/// How joint variables are written: revolute joints in degrees, prismatic ones in metres.
pub(super) struct Joints {
    scales: Vec<JointScale>,
    pub slides: Vec<bool>,
}

impl Joints {
    pub fn of(robot: &Robot) -> Joints {
        let slides = |joint| robot.joint_kind(joint) == JointKind::Prismatic;
        Joints {
            scales: joint_scales(robot).unwrap_or_default(),
            slides: (0..robot.joints()).map(slides).collect(),
        }
    }

    fn manifold(&self, manifold: &SelfMotionManifold, ranges: &[AngleSet]) -> Value {
        let mut value = json!({
            "status": manifold.status,
            "length": manifold.length,
            "winding": manifold.winding,
        });
        self.put_ranges(&mut value, ranges);
        let points = (0..manifold.joints).flat_map(|joint| manifold.critical_points(joint));
        value["critical_points"] = points.map(|point| self.critical_point(&point)).collect();
        value["crossings"] = json!(manifold.crossings.len());
        value["hits"] = json!(manifold.hits);
        value
    }

    fn critical_point(&self, point: &CriticalPoint) -> Value {
        let kind = match point.is_maximum {
            true => "maximum",
            false => "minimum",
        };
        let mut value = json!({ "joint": point.joint + 1, "kind": kind });
        self.put_theta(&mut value, &point.theta);
        value
    }

    pub fn configuration(&self, theta: &[f64]) -> Value {
        let mut value = json!({});
        self.put_theta(&mut value, theta);
        value
    }

    pub fn put_theta(&self, target: &mut Value, theta: &[f64]) {
        let of = |slides: bool| self.each(slides, |joint| json!(self.outer(joint, theta)));
        self.put(target, "theta", of);
    }

    /// Variable of `joint` in the unit of files.
    pub fn outer(&self, joint: usize, theta: &[f64]) -> f64 {
        let value = theta[joint];
        match (self.slides[joint], self.scales.get(joint)) {
            (true, Some(scale)) => scale.outer(value),
            _ => value.to_degrees(),
        }
    }

    pub fn put_ranges(&self, target: &mut Value, ranges: &[AngleSet]) {
        let of = |slides: bool| {
            self.each(slides, |joint| match (slides, self.scales.get(joint)) {
                (true, Some(scale)) => {
                    let arcs = ranges[joint].arcs().iter();
                    arcs.map(|arc| json!([scale.outer(arc.start()), scale.outer(arc.end())]))
                        .collect()
                }
                _ => json!(degree_pairs(&ranges[joint])),
            })
        };
        self.put(target, "joint_ranges", of);
    }

    /// One entry per joint, null for joints of the other kind.
    fn each(&self, slides: bool, value: impl Fn(usize) -> Value) -> Value {
        let entry = |(joint, &own): (usize, &bool)| match own == slides {
            true => value(joint),
            false => Value::Null,
        };
        self.slides.iter().enumerate().map(entry).collect()
    }

    /// Puts `name_deg` and, if there are prismatic joints, `name_m` into `target`.
    fn put(&self, target: &mut Value, name: &str, of: impl Fn(bool) -> Value) {
        target[format!("{name}_deg")] = of(false);
        if self.slides.contains(&true) {
            target[format!("{name}_m")] = of(true);
        }
    }
}

/// The vertices of every curve, unwrapped along it.
pub(super) fn curves(pre_image: &PreImage, robot: &Robot) -> Table {
    let joints = Joints::of(robot);
    let mut header: Vec<String> = ["curve", "vertex", "arc_length"].map(String::from).to_vec();
    header.extend((1..).zip(&joints.slides).map(|(number, &slides)| {
        let unit = if slides { "m" } else { "deg" };
        format!("theta_{number}_{unit}")
    }));
    let mut table = Table {
        header,
        rows: Vec::new(),
    };
    for (curve, manifold) in (1..).zip(&pre_image.manifolds) {
        let mut length = 0.0;
        for vertex in 0..manifold.vertices() {
            let theta = manifold.point(vertex);
            if vertex > 0 {
                length += manifold.segment_length(vertex - 1);
            }
            let mut row = vec![
                curve.to_string(),
                (vertex + 1).to_string(),
                length.to_string(),
            ];
            row.extend((0..theta.len()).map(|joint| joints.outer(joint, theta).to_string()));
            table.rows.push(row);
        }
    }
    table
}
