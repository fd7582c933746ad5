//! Walks on a pre-image of two or more dimensions to where one joint's angle is stationary
//! [S4 eq. 18].

use super::seeds::{Seed, Seeder};
use super::summit::to_summit;
use crate::angle::wrap;
use crate::design::TaskSpace;
use crate::kinematics::{Chain, Goal, Kernel, Lanes, damped_step, dot};
use rand_chacha::ChaCha8Rng;

/// Largest slope of the joint's angle at which the walk ends: the angle is then within about
/// its square, divided by the curvature, of the extremum.
const LEVEL: f64 = 0.02;
/// Most steps of a walk.
const MOST_STEPS: usize = 60;
/// The same two for walks on the pre-image of a single task point, which may take their time.
const FLAT: f64 = 1e-4;
const MANY_STEPS: usize = 300;
/// Longest step of a walk, radians; shorter where it must not cut corners.
const LONGEST: f64 = 0.4;
const CAREFUL: f64 = 0.1;
/// Damping of corrections, far below the square of any regular singular value.
const DAMPING: f64 = 1e-10;

/// Kernels of all joints, for degrees of redundancy 2 and 3.
#[derive(Clone, Debug)]
pub(super) enum Ascent {
    Two4(Kernel<4, 2>),
    Two5(Kernel<5, 2>),
    Three5(Kernel<5, 3>),
    Three6(Kernel<6, 3>),
    Six8(Kernel<8, 6>),
    Six9(Kernel<9, 6>),
}

impl Ascent {
    pub fn new(chain: &Chain, task: TaskSpace) -> Option<Ascent> {
        Some(match (task.dimension(), chain.len()) {
            (2, 4) => Ascent::Two4(Kernel::new(chain, task)?),
            (2, 5) => Ascent::Two5(Kernel::new(chain, task)?),
            (3, 5) => Ascent::Three5(Kernel::new(chain, task)?),
            (3, 6) => Ascent::Three6(Kernel::new(chain, task)?),
            (6, 8) => Ascent::Six8(Kernel::new(chain, task)?),
            (6, 9) => Ascent::Six9(Kernel::new(chain, task)?),
            _ => return None,
        })
    }

    /// Whether any of some random starts reaches the task: the configuration where the first one
    /// lands.
    pub fn land(&self, goal: &Goal<f64>, starts: usize, rng: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        match self {
            Ascent::Two4(kernel) => land(kernel, goal, starts, rng),
            Ascent::Two5(kernel) => land(kernel, goal, starts, rng),
            Ascent::Three5(kernel) => land(kernel, goal, starts, rng),
            Ascent::Three6(kernel) => land(kernel, goal, starts, rng),
            Ascent::Six8(kernel) => land(kernel, goal, starts, rng),
            Ascent::Six9(kernel) => land(kernel, goal, starts, rng),
        }
    }

    /// The configurations in which at least `starts` random starts land on the task.
    pub fn landings(&self, goal: &Goal<f64>, starts: usize, rng: &mut ChaCha8Rng) -> Vec<Vec<f64>> {
        match self {
            Ascent::Two4(kernel) => landings(kernel, goal, starts, rng),
            Ascent::Two5(kernel) => landings(kernel, goal, starts, rng),
            Ascent::Three5(kernel) => landings(kernel, goal, starts, rng),
            Ascent::Three6(kernel) => landings(kernel, goal, starts, rng),
            Ascent::Six8(kernel) => landings(kernel, goal, starts, rng),
            Ascent::Six9(kernel) => landings(kernel, goal, starts, rng),
        }
    }

    /// As [`Ascent::extremum`], but a walk that takes all the steps it needs and never leaves the
    /// configurations at which `inside` holds.
    pub fn extremum_inside(
        &self,
        goal: &Goal<f64>,
        start: &[f64],
        (joint, sign): (usize, f64),
        inside: &dyn Fn(&[f64]) -> bool,
    ) -> Option<Vec<f64>> {
        let aim = Aim {
            joint,
            sign,
            level: FLAT,
            most_steps: MANY_STEPS,
            longest: CAREFUL,
            inside,
        };
        match self {
            Ascent::Two4(kernel) => climb(kernel, goal, start, &aim),
            Ascent::Two5(kernel) => climb(kernel, goal, start, &aim),
            Ascent::Three5(kernel) => climb(kernel, goal, start, &aim),
            Ascent::Three6(kernel) => climb(kernel, goal, start, &aim),
            Ascent::Six8(kernel) => climb(kernel, goal, start, &aim),
            Ascent::Six9(kernel) => climb(kernel, goal, start, &aim),
        }
    }

    /// The configuration at the end of a walk from `start` that raises (`sign` = 1) or lowers (−1)
    /// `joint` (from 0); `None` if `start` does not lie on the pre-image.
    pub fn extremum(
        &self,
        goal: &Goal<f64>,
        start: &[f64],
        joint: usize,
        sign: f64,
    ) -> Option<Vec<f64>> {
        let aim = Aim {
            joint,
            sign,
            level: LEVEL,
            most_steps: MOST_STEPS,
            longest: LONGEST,
            inside: &|_| true,
        };
        match self {
            Ascent::Two4(kernel) => walk(kernel, goal, start, &aim),
            Ascent::Two5(kernel) => walk(kernel, goal, start, &aim),
            Ascent::Three5(kernel) => walk(kernel, goal, start, &aim),
            Ascent::Three6(kernel) => walk(kernel, goal, start, &aim),
            Ascent::Six8(kernel) => walk(kernel, goal, start, &aim),
            Ascent::Six9(kernel) => walk(kernel, goal, start, &aim),
        }
    }
}

fn land<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    starts: usize,
    rng: &mut ChaCha8Rng,
) -> Option<Vec<f64>> {
    let lanes: Goal<Lanes> = goal.splat();
    let mut seeder = Seeder::new(kernel, rng);
    let mut landed = None;
    while landed.is_none() && seeder.tried < starts {
        seeder.next(kernel, &lanes, rng, |seed| {
            if let Seed::Found(point) = seed {
                landed.get_or_insert(point.map(wrap).to_vec());
            }
        });
    }
    landed
}

fn landings<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    starts: usize,
    rng: &mut ChaCha8Rng,
) -> Vec<Vec<f64>> {
    let lanes: Goal<Lanes> = goal.splat();
    let mut seeder = Seeder::new(kernel, rng);
    let mut landed = Vec::new();
    while seeder.tried < starts {
        seeder.next(kernel, &lanes, rng, |seed| {
            if let Seed::Found(point) = seed {
                landed.push(point.map(wrap).to_vec());
            }
        });
    }
    landed
}

/// Where a walk goes and when it ends.
pub(super) struct Aim<'a> {
    pub joint: usize,
    pub sign: f64,
    /// Slope of the joint's angle at which it ends.
    level: f64,
    most_steps: usize,
    /// Longest step, radians.
    longest: f64,
    /// Where it may go.
    pub inside: &'a dyn Fn(&[f64]) -> bool,
}

/// A walk, and Newton steps at its end: on a ridge steps uphill go from side to side.
fn climb<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    start: &[f64],
    aim: &Aim<'_>,
) -> Option<Vec<f64>> {
    let end: [f64; N] = walk(kernel, goal, start, aim)?.try_into().ok()?;
    Some(to_summit(kernel, goal, end, aim).to_vec())
}

fn walk<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    start: &[f64],
    aim: &Aim<'_>,
) -> Option<Vec<f64>> {
    let (joint, sign) = (aim.joint, aim.sign);
    let start: [f64; N] = start.try_into().ok()?;
    let mut point = settle(kernel, goal, start)?;
    let mut step: f64 = 0.1;
    for _ in 0..aim.most_steps {
        let slope = uphill(kernel, goal, &point, joint, sign);
        let norm = dot(&slope, &slope).sqrt();
        // More than a turn away from the start the joint's range is full anyway.
        if norm < aim.level || (point[joint] - start[joint]).abs() > std::f64::consts::TAU {
            break;
        }
        let guess: [f64; N] = std::array::from_fn(|k| point[k] + step * slope[k] / norm);
        let next = settle(kernel, goal, guess);
        let rises =
            |next: &[f64; N]| sign * (next[joint] - point[joint]) > 0.0 && (aim.inside)(next);
        match next.filter(rises) {
            Some(next) => {
                // Ahead of the extremum the slope changes little; past it, it turns round.
                let ahead = uphill(kernel, goal, &next, joint, sign);
                let falls = dot(&ahead, &slope) < 0.5 * norm * norm;
                step = if falls {
                    0.5 * step
                } else {
                    (1.6 * step).min(aim.longest)
                };
                point = next;
            }
            None => step *= 0.3,
        }
        if step < 1e-4 {
            break;
        }
    }
    Some(point.to_vec())
}

/// The projection of ± the joint's axis onto the null space of J.
pub(super) fn uphill<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    point: &[f64; N],
    joint: usize,
    sign: f64,
) -> [f64; N] {
    let mut linear = kernel.linearise(point, goal);
    // −J⁺ (J e) plus e is the part of e that J does not see.
    linear.residual = std::array::from_fn(|row| sign * linear.jacobian[row][joint]);
    let mut slope = damped_step(&linear, DAMPING);
    slope[joint] += sign;
    slope
}

/// Newton steps onto the pre-image; `None` if they lead away.
pub(super) fn settle<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    guess: [f64; N],
) -> Option<[f64; N]> {
    let mut point = guess;
    for _ in 0..6 {
        let step = damped_step(&kernel.linearise(&point, goal), DAMPING);
        let size = dot(&step, &step);
        if size.is_nan() || size > 0.25 {
            return None;
        }
        for k in 0..N {
            point[k] += step[k];
        }
        if size < 1e-12 {
            return Some(point);
        }
    }
    None
}
