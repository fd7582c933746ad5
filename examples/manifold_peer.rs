//! Self-motion manifolds of many poses, for comparison with other programs.
//!
//! `manifold_peer ROBOT.toml` reads one pose per JSON line on stdin: `pose` (4 × 4, metres) and
//! `points`, configurations (radians) that another program says hold it. It prints one JSON line per
//! pose: `spans` (least and greatest angle of every joint on every curve, unwrapped), `windings`,
//! `measures` (size of the union of every joint's ranges), per point the `curve` it lies on (null if
//! none) and its `distance` to the polished curve, and `seconds` per search on one core, with
//! the settings for single poses and with the coarse ones of atlases.

use faultspace::design::{Robot, TaskSpace, read_design};
use faultspace::kinematics::{Goal, Kernel, newton_step};
use faultspace::manifold::{PreImage, PreImageSearch, SearchSettings};
use faultspace::sampling::stream;
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion};
use serde::Deserialize;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::io::BufRead;
use std::path::Path;
use std::time::Instant;

/// A point lies on a curve if the cubic between vertices passes it this near, radians.
const ON_CURVE: f64 = 1e-2;
/// Timed searches per pose, of which the fastest counts.
const ROUNDS: usize = 3;

#[derive(Deserialize)]
struct Question {
    pose: [[f64; 4]; 4],
    points: Vec<[f64; 7]>,
}

fn main() -> anyhow::Result<()> {
    let file = std::env::args().nth(1);
    let file = file.ok_or_else(|| anyhow::anyhow!("usage: manifold_peer ROBOT.toml < POSES"))?;
    let robot =
        read_design(Path::new(&file)).map_err(|error| anyhow::anyhow!(error.render(false)))?;
    let mut fine = search(&robot, SearchSettings::default())?;
    let mut coarse = search(&robot, SearchSettings::coarse())?;
    for (number, line) in std::io::stdin().lock().lines().enumerate() {
        let question: Question = serde_json::from_str(&line?)?;
        let pose = pose(&question.pose);
        let (found, seconds) = timed(&mut fine, &pose, number as u64);
        let (_, seconds_coarse) = timed(&mut coarse, &pose, number as u64);
        let mut answer = answer(&fine, &found, &pose, &question.points)?;
        answer["seconds"] = json!({ "default": seconds, "coarse": seconds_coarse });
        println!("{answer}");
    }
    Ok(())
}

fn search(robot: &Robot, settings: SearchSettings) -> anyhow::Result<PreImageSearch> {
    Ok(PreImageSearch::new(
        robot,
        TaskSpace::SpatialPose,
        settings,
    )?)
}

fn pose(rows: &[[f64; 4]; 4]) -> Isometry3<f64> {
    let matrix = Matrix3::from_fn(|i, j| rows[i][j]);
    let rotation = Rotation3::from_matrix_unchecked(matrix);
    let place = Translation3::new(rows[0][3], rows[1][3], rows[2][3]);
    Isometry3::from_parts(place, UnitQuaternion::from_rotation_matrix(&rotation))
}

fn timed(search: &mut PreImageSearch, pose: &Isometry3<f64>, number: u64) -> (PreImage, f64) {
    let mut round = || {
        let mut generator = stream(1, number);
        let started = Instant::now();
        let found = search.find(pose, &mut generator);
        (found, started.elapsed().as_secs_f64())
    };
    let (found, mut seconds) = round();
    for _ in 1..ROUNDS {
        seconds = seconds.min(round().1);
    }
    (found, seconds)
}

fn answer(
    search: &PreImageSearch,
    found: &PreImage,
    pose: &Isometry3<f64>,
    points: &[[f64; 7]],
) -> anyhow::Result<Value> {
    let kernel = Kernel::<7, 6>::new(search.chain(), TaskSpace::SpatialPose)
        .ok_or_else(|| anyhow::anyhow!("the robot needs 7 joints"))?;
    let goal = Goal::new(search.chain(), pose);
    let placed: Vec<Value> = points
        .iter()
        .map(|point| place(found, &kernel, &goal, point))
        .collect();
    let spans = found.manifolds.iter();
    let spans: Vec<Vec<[f64; 2]>> = spans.map(|m| (0..7).map(|k| m.span(k)).collect()).collect();
    let windings: Vec<&[i32]> = found
        .manifolds
        .iter()
        .map(|m| m.winding.as_slice())
        .collect();
    let measures: Vec<f64> = found
        .joint_ranges()
        .iter()
        .map(|set| set.measure())
        .collect();
    Ok(json!({
        "spans": spans,
        "windings": windings,
        "measures": measures,
        "points": placed,
        "completeness": found.completeness,
    }))
}

/// The curve nearest to `point`, followed from the foot on its cubic to the nearest exact solution.
fn place(found: &PreImage, kernel: &Kernel<7, 6>, goal: &Goal<f64>, point: &[f64; 7]) -> Value {
    let feet = found
        .manifolds
        .iter()
        .enumerate()
        .filter_map(|(curve, manifold)| {
            let (segment, u) = manifold.locate(point, ON_CURVE)?;
            let foot: [f64; 7] = manifold.at(segment, u).try_into().ok()?;
            let foot = polished(kernel, goal, foot, point);
            Some((curve, norm(&difference(point, &foot))))
        });
    match feet.min_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((curve, distance)) => json!({ "curve": curve, "distance": distance }),
        None => json!({ "curve": null, "distance": null }),
    }
}

/// Newton's method onto the pre-image, and along its tangent to where `point` is beside it.
fn polished(
    kernel: &Kernel<7, 6>,
    goal: &Goal<f64>,
    mut theta: [f64; 7],
    point: &[f64; 7],
) -> [f64; 7] {
    for _ in 0..6 {
        let Some(step) = newton_step(&kernel.linearise(&theta, goal)) else {
            return theta;
        };
        let gap = difference(point, &theta);
        let along: f64 = gap.iter().zip(&step.tangent).map(|(g, t)| g * t).sum();
        for (k, angle) in theta.iter_mut().enumerate() {
            *angle += step.correction[k] + along * step.tangent[k];
        }
    }
    theta
}

/// `a` − `b`, every angle the short way.
fn difference(a: &[f64; 7], b: &[f64; 7]) -> [f64; 7] {
    std::array::from_fn(|k| (a[k] - b[k]) - TAU * ((a[k] - b[k]) / TAU).round())
}

fn norm(vector: &[f64; 7]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}
