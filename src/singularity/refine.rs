//! Local refinement of a location: a continuous search for the largest size.
//!
//! The size has kinks where manifolds join, and its maxima lie on them. Descent to a singular
//! configuration already brings a candidate onto such a set; the search goes on within it: moves
//! along its tangent space, Newton steps back onto it, and a poll of random orthonormal
//! directions, which kinks that remain cannot all block. Turning joint 1 or the tool changes no
//! size, and self-motion no location: such directions are left out.

use super::catalogue::symmetric_joints;
use super::location::LocationSearch;
use super::stratum::kernel;
use crate::sampling::stream;
use nalgebra::DMatrix;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// How a location is refined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefineSettings {
    /// First step, radians.
    pub first_step: f64,
    /// Step at which the search ends, radians; the size is then good to about as much.
    pub last_step: f64,
    /// Most locations whose size is computed.
    pub evaluations: usize,
}

impl Default for RefineSettings {
    fn default() -> RefineSettings {
        RefineSettings {
            first_step: 0.3,
            last_step: 1e-7,
            evaluations: 250,
        }
    }
}

/// The end of a refinement.
#[derive(Clone, Debug, PartialEq)]
pub struct Refined {
    /// A configuration at the best location, n internal joint variables.
    pub theta: Vec<f64>,
    /// The rank loss that was kept.
    pub loss: usize,
    /// The location's size, radians.
    pub size: f64,
    /// Locations computed.
    pub evaluations: usize,
}

/// A gain in size that counts, radians: above the noise of traced ranges.
const GAIN: f64 = 2e-8;

/// Raises the size of the location of `theta`, at which J has lost rank `loss` (0: a regular
/// configuration), until steps of `last_step` bring nothing.
pub fn refine(
    search: &mut LocationSearch,
    theta: &[f64],
    loss: usize,
    settings: &RefineSettings,
    seed: u64,
) -> Refined {
    let mut rng = stream(seed, 0);
    let mut state = Refined {
        size: evaluate(search, theta, seed, 0),
        theta: theta.to_vec(),
        loss,
        evaluations: 1,
    };
    let most: f64 = search.physical().iter().map(|arc| arc.width()).sum();
    let mut step = settings.first_step;
    while step > settings.last_step && state.evaluations < settings.evaluations {
        if state.size >= most - 1e-9 {
            break;
        }
        let Some(directions) = directions(search, &state.theta, loss, &mut rng) else {
            break;
        };
        let mut improved = false;
        for direction in directions {
            let mut reach = step;
            while state.evaluations < settings.evaluations
                && attempt(search, &mut state, &direction, reach, seed)
            {
                improved = true;
                reach *= 2.0;
            }
            if improved {
                break;
            }
        }
        if !improved {
            step *= 0.35;
        }
    }
    state
}

/// Moves if that enlarges the location.
fn attempt(
    search: &mut LocationSearch,
    state: &mut Refined,
    direction: &[f64],
    reach: f64,
    seed: u64,
) -> bool {
    let moved = state.theta.iter().zip(direction);
    let moved: Vec<f64> = moved.map(|(a, d)| a + reach * d).collect();
    let settled = match state.loss {
        0 => Some(moved),
        loss => search.arm().settle(&moved, loss, None),
    };
    let Some(theta) = settled else {
        return false;
    };
    let size = evaluate(search, &theta, seed, state.evaluations);
    state.evaluations += 1;
    if size <= state.size + GAIN {
        return false;
    }
    state.size = size;
    state.theta = theta;
    true
}

fn evaluate(search: &mut LocationSearch, theta: &[f64], seed: u64, item: usize) -> f64 {
    let tool = search.arm().chain.tool(theta);
    let mut rng = stream(seed, 1 + item as u64);
    search.screen(&tool, true, &mut rng).1
}

/// Orthonormal directions, randomly turned, each with both senses, in which the location changes;
/// `None` if there is none.
fn directions(
    search: &LocationSearch,
    theta: &[f64],
    loss: usize,
    rng: &mut ChaCha8Rng,
) -> Option<Vec<Vec<f64>>> {
    let arm = search.arm();
    let mut free = arm.tangent_space(theta, loss);
    for joint in symmetric_joints(&arm) {
        if search.physical()[joint].is_full() {
            free.row_mut(joint).fill(0.0);
        }
    }
    // Directions that move the tool: what the kernel of J restricted to them leaves.
    let moved = arm.at(theta).jacobian() * &free;
    let gram = moved.tr_mul(&moved);
    let still = kernel(&gram, 1e-9);
    let size = free.ncols();
    let rest = kernel(&(&still * still.transpose()), 1e-9);
    let rest = if still.ncols() == 0 {
        DMatrix::identity(size, size)
    } else {
        rest
    };
    if rest.ncols() == 0 || gram.amax() < 1e-12 {
        return None;
    }
    let basis = free * rest;
    let turn = DMatrix::from_fn(basis.ncols(), basis.ncols(), |_, _| {
        // Sums of uniform numbers are normal enough for a random frame.
        (0..6).map(|_| rng.random_range(-1.0..1.0)).sum::<f64>()
    });
    let frame = basis * turn.qr().q();
    let both = frame.column_iter().flat_map(|column| {
        let norm = column.norm().max(1e-12);
        [1.0, -1.0].map(|sense| column.iter().map(|x| sense * x / norm).collect())
    });
    Some(both.collect())
}
