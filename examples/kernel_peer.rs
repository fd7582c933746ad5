//! Forward kinematics and Jacobian of a 7R robot, for comparison with other programs.
//!
//! `kernel_peer ROBOT.toml` reads configurations (arrays of radians) as JSON lines on stdin and
//! prints one JSON line for each: the tool's `pose` (4 × 4, metres) and its `jacobian` (6 × 7, linear
//! rows first, world frame, at the tool). The last line has `seconds` per call of
//! `Kernel::linearise`.

use faultspace::design::{TaskSpace, read_design};
use faultspace::kinematics::{Chain, Goal, Kernel};
use nalgebra::{Isometry3, SMatrix, Vector3};
use serde_json::{Value, json};
use std::hint::black_box;
use std::io::BufRead;
use std::path::Path;
use std::time::Instant;

/// Calls per round of timing.
const CALLS: usize = 1 << 16;
/// Rounds, of which the fastest counts.
const ROUNDS: usize = 15;

fn main() -> anyhow::Result<()> {
    let file = std::env::args().nth(1);
    let file =
        file.ok_or_else(|| anyhow::anyhow!("usage: kernel_peer ROBOT.toml < CONFIGURATIONS"))?;
    let robot =
        read_design(Path::new(&file)).map_err(|error| anyhow::anyhow!(error.render(false)))?;
    let chain = Chain::new(&robot).ok_or_else(|| anyhow::anyhow!("a stroke is missing"))?;
    let kernel = Kernel::<7, 6>::new(&chain, TaskSpace::SpatialPose)
        .ok_or_else(|| anyhow::anyhow!("the robot needs 7 joints"))?;
    let mut all: Vec<[f64; 7]> = Vec::new();
    for line in std::io::stdin().lock().lines() {
        let theta = serde_json::from_str(&line?)?;
        println!("{}", values(&chain, &kernel, &theta));
        all.push(theta);
    }
    anyhow::ensure!(!all.is_empty(), "no configurations on stdin");
    println!("{}", json!({ "seconds": time(&chain, &kernel, &all) }));
    Ok(())
}

fn values(chain: &Chain, kernel: &Kernel<7, 6>, theta: &[f64; 7]) -> Value {
    let tool = chain.tool(theta);
    let goal = Goal::new(chain, &tool);
    let linear = kernel.linearise(theta, &goal);
    // The kernel's rows are those of the last canonical frame, seen from joint 1.
    let base = chain.base.rotation;
    let last = tool * chain.end.inverse();
    let lever = tool.translation.vector - last.translation.vector;
    let mut jacobian = SMatrix::<f64, 6, 7>::zeros();
    for joint in 0..7 {
        let part = |first: usize| Vector3::from_fn(|i, _| linear.jacobian[first + i][joint]);
        let turning = base * part(3);
        let moving = base * part(0) * kernel.length_unit() + turning.cross(&lever);
        jacobian.fixed_view_mut::<3, 1>(0, joint).copy_from(&moving);
        jacobian
            .fixed_view_mut::<3, 1>(3, joint)
            .copy_from(&turning);
    }
    let pose = tool.to_homogeneous();
    let rows =
        |matrix: &dyn Fn(usize, usize) -> f64, rows: usize, columns: usize| -> Vec<Vec<f64>> {
            (0..rows)
                .map(|i| (0..columns).map(|j| matrix(i, j)).collect())
                .collect()
        };
    json!({
        "pose": rows(&|i, j| pose[(i, j)], 4, 4),
        "jacobian": rows(&|i, j| jacobian[(i, j)], 6, 7),
    })
}

/// Seconds per call, the fastest of several rounds.
fn time(chain: &Chain, kernel: &Kernel<7, 6>, all: &[[f64; 7]]) -> f64 {
    let goal = Goal::new(chain, &Isometry3::identity());
    let round = |_| {
        let started = Instant::now();
        for theta in all.iter().cycle().take(CALLS) {
            black_box(kernel.linearise(black_box(theta), black_box(&goal)));
        }
        started.elapsed().as_secs_f64() / CALLS as f64
    };
    (0..ROUNDS).map(round).fold(f64::INFINITY, f64::min)
}
