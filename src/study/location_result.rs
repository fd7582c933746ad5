//! A location in results and pictures: its manifolds, singular configurations and joint ranges.

use super::manifold_report::drawn;
use super::manifold_result::Joints;
use super::settings::Study;
use crate::angle::{AngleSet, Arc};
use crate::design::{JointKind, Robot};
use crate::kinematics::{joint_places, joint_scales, tool_frame};
use crate::manifold::{Completeness, CurveStatus, SelfMotionManifold};
use crate::report::{ArmPose, ManifoldCurve, ProjectionsFigure, Table};
use crate::singularity::{Location, LocationSearch};
use anyhow::anyhow;
use nalgebra::{Isometry3, Vector3};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// The search for locations of the study's robot.
///
/// # Errors
/// The robot cannot do the task, or has another degree of redundancy.
pub(super) fn location_search(study: &Study) -> anyhow::Result<LocationSearch> {
    let robot = &study.design.robot;
    let chain = crate::kinematics::Chain::new(robot)
        .ok_or_else(|| anyhow!("a prismatic joint without physical limits"))?;
    let physical = crate::manifold::physical_arcs(robot);
    Ok(LocationSearch::new(&chain, study.task, physical)?)
}

/// How far a joint's range falls short of what its physical limits allow, radians.
fn shortfall(range: &AngleSet, physical: &Arc) -> f64 {
    (physical.width() - range.measure()).max(0.0)
}

/// Joints (from 0) whose range falls short of what is possible, the worst first.
pub(super) fn limiting(location: &Location, physical: &[Arc]) -> Vec<(usize, f64)> {
    let pairs = location.ranges.iter().zip(physical).enumerate();
    let short = pairs.map(|(joint, (range, arc))| (joint, shortfall(range, arc)));
    let mut short: Vec<(usize, f64)> = short.filter(|(_, short)| *short > 1e-3).collect();
    short.sort_by(|a, b| b.1.total_cmp(&a.1));
    short
}

/// A location as `result.json` has it.
pub(super) fn location_json(location: &Location, study: &Study, physical: &[Arc]) -> Value {
    let joints = Joints::of(&study.design.robot);
    let rank = study.task.dimension();
    let rotation = location.tool.rotation.to_rotation_matrix();
    let rows: Vec<[f64; 3]> = (0..3)
        .map(|r| [0, 1, 2].map(|c| rotation[(r, c)]))
        .collect();
    let p = location.tool.translation.vector;
    let mut value = json!({
        "position": [p.x, p.y, p.z],
        "rotation": rows,
        "size": location.size,
    });
    joints.put_ranges(&mut value, &location.ranges);
    let short = limiting(location, physical).into_iter();
    value["limiting_joints"] = short
        .map(|(joint, short)| json!({ "joint": joint + 1, "missing_rad": short }))
        .collect();
    value["connected_sets"] = connected_sets(location, &joints);
    value["manifolds"] = location.manifolds.iter().map(manifold_json).collect();
    put_singular(&mut value, location, &joints, rank);
    value["completeness"] = match location.completeness {
        Completeness::Proved => json!({ "kind": "proved" }),
        Completeness::Evidence(missed) => json!({ "kind": "evidence", "missed": missed }),
        Completeness::Unknown => json!({ "kind": "unknown" }),
    };
    value
}

fn connected_sets(location: &Location, joints: &Joints) -> Value {
    let sets = location.sets.iter().map(|set| {
        let mut value = json!({
            "size": set.size,
            "manifolds": set.manifolds.iter().map(|k| k + 1).collect::<Vec<_>>(),
            "singular_configurations": set.nodes.len(),
        });
        joints.put_ranges(&mut value, &set.ranges);
        value
    });
    sets.collect()
}

fn manifold_json(manifold: &SelfMotionManifold) -> Value {
    json!({
        "status": manifold.status,
        "open": is_open(manifold),
        "length": manifold.length,
        "winding": manifold.winding,
    })
}

fn put_singular(target: &mut Value, location: &Location, joints: &Joints, rank: usize) {
    let nodes = location.nodes.iter().map(|node| {
        let mut value = json!({
            "rank": rank - node.loss,
            "branches": node.branches,
            "singular_values": node.sigma,
        });
        joints.put_theta(&mut value, &node.theta);
        value
    });
    target["singular_configurations"] = nodes.collect();
    let surfaces = location.surfaces.iter().map(|surface| {
        let mut value = json!({ "rank": rank - surface.loss, "dimension": surface.dimension });
        joints.put_theta(&mut value, &surface.theta);
        joints.put_ranges(&mut value, &surface.ranges);
        value
    });
    target["singular_surfaces"] = surfaces.collect();
}

/// Whether a closed curve winds round the torus of joint angles: it is then open in the sense of
/// [S1 Fig. 1].
fn is_open(manifold: &SelfMotionManifold) -> bool {
    manifold.winding.iter().any(|turns| *turns != 0)
}

/// What is known of the manifolds in a sentence.
pub(super) fn manifolds_sentence(location: &Location) -> String {
    let open = location.manifolds.iter().filter(|m| is_open(m)).count();
    let ended = |m: &&SelfMotionManifold| m.status != CurveStatus::Closed;
    let ended = location.manifolds.iter().filter(ended).count();
    let contractible = location.manifolds.len() - open - ended;
    let mut text = format!(
        "It has {} self-motion manifolds in {} connected sets: {open} open ones (some joint turns \
         fully along them) and {contractible} closed ones",
        location.manifolds.len(),
        location.sets.len(),
    );
    if ended > 0 {
        text += &format!("; {ended} end at a stroke or a singular configuration");
    }
    text += &format!(
        ". {} singular configurations lie on them",
        location.nodes.len()
    );
    if !location.surfaces.is_empty() {
        text += &format!(
            ", and {} parts of the pre-image are singular throughout",
            location.surfaces.len()
        );
    }
    text + "."
}

/// Joint ranges as a table: every joint's arcs, measure and what is missing.
pub(super) fn ranges_table(location: &Location, robot: &Robot, physical: &[Arc]) -> Table {
    let scales = joint_scales(robot).unwrap_or_default();
    let mut table = Table::new(&["joint", "range", "measure (rad)", "missing (rad)"]);
    for (joint, range) in location.ranges.iter().enumerate() {
        let ends = |arc: &Arc| match (robot.joint_kind(joint), scales.get(joint)) {
            (JointKind::Prismatic, Some(scale)) => {
                let [a, b] = [arc.start(), arc.end()].map(|end| scale.outer(end));
                format!("{a:.4} m to {b:.4} m")
            }
            _ if arc.is_full() => "full circle".into(),
            _ => format!(
                "{:.3}° to {:.3}°",
                arc.start().to_degrees(),
                arc.end().to_degrees()
            ),
        };
        let arcs: Vec<String> = range.arcs().iter().map(ends).collect();
        table.rows.push(vec![
            format!("{}", joint + 1),
            arcs.join("; "),
            format!("{:.6}", range.measure()),
            format!("{:.6}", shortfall(range, &physical[joint])),
        ]);
    }
    table
}

/// The curves of a location, nodes and panels for the figure of projections.
pub(super) struct Projections {
    pub curves: Vec<ManifoldCurve>,
    pub nodes: Vec<(Vec<f64>, usize)>,
    panels: Vec<[usize; 3]>,
    colour: usize,
    joints: usize,
    rank: usize,
}

impl Projections {
    pub fn of(location: &Location, study: &Study, physical: &[Arc]) -> Option<Projections> {
        if location.manifolds.is_empty() {
            return None;
        }
        let joints = location.ranges.len();
        let moves = |joint: &usize| location.ranges[*joint].measure() > 0.05;
        let mut moving: Vec<usize> = (0..joints).filter(moves).collect();
        // Joints that stand still fill up what is missing.
        moving.extend((0..joints).filter(|joint| !moves(joint)).take(3));
        moving.truncate(moving.len().max(3).min(joints));
        let at = |k: usize| moving[k.min(moving.len() - 1)] + 1;
        let mut panels: Vec<[usize; 3]> = Vec::new();
        for [a, b, c] in [[0, 1, 2], [3, 4, 5], [2, 3, 4], [1, 2, 4]] {
            let fits = c < moving.len();
            let panel = [at(a), at(b), at(c)];
            if fits && !panels.contains(&panel) {
                panels.push(panel);
            }
        }
        let narrow = |joint: &&usize| {
            let measure = location.ranges[**joint].measure();
            measure > 0.3 && measure < TAU - 0.1
        };
        let colour = moving.iter().rev().find(narrow).or(moving.last())?;
        Some(Projections {
            curves: location
                .manifolds
                .iter()
                .flat_map(|manifold| parts_inside(drawn(manifold), physical))
                .collect(),
            nodes: location
                .nodes
                .iter()
                .map(|node| (node.theta.clone(), node.loss))
                .collect(),
            panels,
            colour: colour + 1,
            joints,
            rank: study.task.dimension(),
        })
    }

    pub fn figure(&self, title: &str) -> ProjectionsFigure<'_> {
        ProjectionsFigure {
            curves: &self.curves,
            nodes: &self.nodes,
            joint_count: self.joints,
            rank: self.rank,
            panels: self.panels.clone(),
            colour: self.colour,
            title: title.to_owned(),
        }
    }
}

/// The parts of a curve inside the physical limits.
fn parts_inside(curve: ManifoldCurve, physical: &[Arc]) -> Vec<ManifoldCurve> {
    if physical.iter().all(Arc::is_full) {
        return vec![curve];
    }
    let inside = |theta: &Vec<f64>| {
        let mut pairs = theta.iter().zip(physical);
        pairs.all(|(&angle, arc)| arc.contains(angle))
    };
    let runs = curve.points.chunk_by(|a, b| inside(a) && inside(b));
    let runs = runs.filter(|run| run.len() > 1);
    runs.map(|run| ManifoldCurve {
        points: run.to_vec(),
        closed: false,
    })
    .collect()
}

/// The skeleton of the robot in a configuration (internal joint variables).
pub(super) fn arm_pose(robot: &Robot, theta: &[f64], name: String) -> ArmPose {
    let scales = joint_scales(robot).unwrap_or_default();
    let outer: Vec<f64> = theta
        .iter()
        .zip(&scales)
        .map(|(value, scale)| scale.outer(*value))
        .collect();
    let tool: Isometry3<f64> = tool_frame(robot, &outer);
    let places = joint_places(robot, &outer);
    let ends = places.iter().flat_map(|place| [place.entry, place.foot]);
    let mut corners: Vec<Vector3<f64>> = vec![Vector3::zeros()];
    let places: Vec<Vector3<f64>> = ends.collect();
    corners.extend(places.iter().copied().chain([tool.translation.vector]));
    corners.dedup_by(|a, b| (*a - *b).norm() < 1e-6);
    ArmPose {
        name,
        corners,
        places,
        tool,
    }
}
