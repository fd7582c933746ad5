//! Random configurations that solve the task: Levenberg–Marquardt from uniform starts, eight at a
//! time.
//!
//! A start that has found the task is replaced by the next one at once, so that all lanes stay
//! busy. Which start lands where depends only on the random stream: lanes compute bit for bit
//! what a single one would, on every machine.

use crate::kinematics::{Goal, Kernel, LANES, Lanes, Linearisation, Real, damped_step};
use multiversion::multiversion;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

/// Squared scaled residual at which a start has found the task. Looser, starts stall on folds
/// just outside a manifold and pass for members.
const FOUND: f64 = 1e-15;
/// Iterations after which a start is given up.
const MOST_ITERATIONS: u32 = 40;
/// A start must halve its squared residual within this many iterations, while it is far.
const PATIENCE: u32 = 10;

/// A stream of solutions of one task point.
#[derive(Clone, Debug)]
pub(crate) struct Seeder<const N: usize, const M: usize> {
    theta: [Lanes; N],
    /// Room to work in.
    linear: Linearisation<Lanes, N, M>,
    /// Iterations of every lane's start.
    age: [u32; LANES],
    /// Squared residual when the start was last checked for progress.
    mark: [f64; LANES],
    /// Starts that have ended, with or without a solution.
    pub tried: usize,
}

/// A start that ended.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Seed<const N: usize> {
    Found([f64; N]),
    Failed,
}

impl<const N: usize, const M: usize> Seeder<N, M> {
    pub fn new(kernel: &Kernel<N, M>, rng: &mut ChaCha8Rng) -> Seeder<N, M> {
        let mut seeder = Seeder {
            theta: [Lanes::constant(0.0); N],
            linear: Linearisation::new(),
            age: [0; LANES],
            mark: [f64::INFINITY; LANES],
            tried: 0,
        };
        for lane in 0..LANES {
            seeder.draw(kernel, lane, rng);
        }
        seeder
    }

    /// A uniform start: on the circle, or in the stroke.
    fn draw(&mut self, kernel: &Kernel<N, M>, lane: usize, rng: &mut ChaCha8Rng) {
        for (k, coordinate) in self.theta.iter_mut().enumerate() {
            let half = if kernel.is_revolute(k) { PI } else { 0.5 * PI };
            coordinate.0[lane] = rng.random_range(-half..half);
        }
        self.age[lane] = 0;
        self.mark[lane] = f64::INFINITY;
    }

    /// Iterates until at least one start has ended; hands every ended one to `take`.
    pub fn next(
        &mut self,
        kernel: &Kernel<N, M>,
        goal: &Goal<Lanes>,
        rng: &mut ChaCha8Rng,
        mut take: impl FnMut(Seed<N>),
    ) {
        loop {
            let before = self.theta;
            let square = iterate(kernel, goal, &mut self.theta, &mut self.linear);
            let mut ended = false;
            for lane in 0..LANES {
                self.age[lane] += 1;
                let r2 = square.0[lane];
                let found = r2 < FOUND;
                if !found && !self.hopeless(lane, r2) {
                    continue;
                }
                // The residual belongs to the configuration before the step.
                let point = before.map(|coordinate| coordinate.0[lane]);
                take(if found && self.in_stroke(kernel, &point) {
                    Seed::Found(point)
                } else {
                    Seed::Failed
                });
                self.tried += 1;
                ended = true;
                self.draw(kernel, lane, rng);
            }
            if ended {
                return;
            }
        }
    }

    fn in_stroke(&self, kernel: &Kernel<N, M>, point: &[f64; N]) -> bool {
        (0..N).all(|k| kernel.is_revolute(k) || point[k].abs() <= 0.5 * PI)
    }

    /// Whether the lane's start is given up. Also true for NaN.
    fn hopeless(&mut self, lane: usize, r2: f64) -> bool {
        if self.age[lane] >= MOST_ITERATIONS || !r2.is_finite() {
            return true;
        }
        if self.age[lane].is_multiple_of(PATIENCE) {
            let stalled = r2 > 1e-4 && r2 > 0.5 * self.mark[lane];
            self.mark[lane] = r2;
            return stalled;
        }
        false
    }
}

/// One damped step of every lane; returns the squared residuals before it.
#[multiversion(
    targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"),
    dispatcher = "direct"
)]
fn iterate<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<Lanes>,
    theta: &mut [Lanes; N],
    linear: &mut Linearisation<Lanes, N, M>,
) -> Lanes {
    kernel.linearise_into(theta, goal, linear);
    let mut square = Lanes::constant(0.0);
    for residual in linear.residual {
        Lanes::keep_loop();
        square = square + residual * residual;
    }
    let mut lambda = square;
    for lane in 0..LANES {
        let r2 = square.0[lane];
        lambda.0[lane] = if r2 < 1e-4 {
            1e-3 * r2 + 1e-12
        } else {
            0.02 * r2 + 1e-4
        };
    }
    let step = damped_step(linear, lambda);
    for k in 0..N {
        Lanes::keep_loop();
        let bounded = step[k].max(Lanes::constant(-1.0)).min(Lanes::constant(1.0));
        theta[k] = theta[k] + bounded;
    }
    square
}
