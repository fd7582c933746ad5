//! Residual and Jacobian of a task for a chain of fixed size: the inner loop of everything.
//!
//! Lengths are divided by a typical link length (1.5 times the mean), so that rows of positions
//! and of orientations weigh alike. The residual of an orientation is 2 sin(φ/2) times the axis
//! of the rotation that is left, which has no branch and its derivative is the angular velocity
//! at φ = 0.

use super::chain::{Chain, ChainJoint};
use super::lane::Real;
use crate::design::TaskSpace;
use nalgebra::Isometry3;

/// A task of dimension M for a chain of N joints, in the chain's internal joint variables.
///
/// Works in the frame of joint 1: base and end of the chain are applied to the goal.
#[derive(Clone, Debug)]
pub struct Kernel<const N: usize, const M: usize> {
    joints: [ChainJoint; N],
    task: TaskSpace,
    /// One over the unit of length, 1/m.
    per_length: f64,
}

/// A goal as the kernel wants it: position and the columns of the rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal<T> {
    /// Position, metres, in the frame of joint 1.
    pub position: [T; 3],
    /// Columns of the rotation of the last canonical frame.
    pub axes: [[T; 3]; 3],
}

/// Residual f(θ) − x and its derivative, in the kernel's scaled rows.
#[derive(Clone, Copy, Debug)]
pub struct Linearisation<T, const N: usize, const M: usize> {
    /// Scaled difference between where the tool is and where it should be.
    pub residual: [T; M],
    /// Jacobian J, row by row.
    pub jacobian: [[T; N]; M],
}

impl<T: Real, const N: usize, const M: usize> Linearisation<T, N, M> {
    /// Zeros, to be overwritten.
    #[inline(always)]
    pub fn new() -> Linearisation<T, N, M> {
        Linearisation {
            residual: [T::constant(0.0); M],
            jacobian: [[T::constant(0.0); N]; M],
        }
    }
}

impl<T: Real, const N: usize, const M: usize> Default for Linearisation<T, N, M> {
    fn default() -> Linearisation<T, N, M> {
        Linearisation::new()
    }
}

impl<const N: usize, const M: usize> Kernel<N, M> {
    /// The kernel of `task` for `chain`; `None` if N or M do not fit.
    pub fn new(chain: &Chain, task: TaskSpace) -> Option<Kernel<N, M>> {
        let joints: [ChainJoint; N] = chain.joints.clone().try_into().ok()?;
        (task.dimension() == M).then(|| Kernel {
            joints,
            task,
            per_length: 1.0 / (1.5 * chain.mean_link()),
        })
    }

    /// Metres per scaled unit of the residual's position rows.
    pub fn length_unit(&self) -> f64 {
        1.0 / self.per_length
    }

    /// The task's space.
    pub fn task(&self) -> TaskSpace {
        self.task
    }

    /// Whether joint `joint` (from 0) turns.
    pub fn is_revolute(&self, joint: usize) -> bool {
        self.joints[joint].turn != 0.0
    }

    /// Residual and Jacobian at `theta`.
    #[inline(always)]
    pub fn linearise<T: Real>(&self, theta: &[T; N], goal: &Goal<T>) -> Linearisation<T, N, M> {
        let mut result = Linearisation::new();
        self.linearise_into(theta, goal, &mut result);
        result
    }

    /// Residual and Jacobian at `theta`, written to `out`: eight of them are too large to be moved.
    #[inline(always)]
    pub fn linearise_into<T: Real>(
        &self,
        theta: &[T; N],
        goal: &Goal<T>,
        out: &mut Linearisation<T, N, M>,
    ) {
        let zero = T::constant(0.0);
        let one = T::constant(1.0);
        let (mut x, mut y, mut z) = ([one, zero, zero], [zero, one, zero], [zero, zero, one]);
        let mut p = [zero; 3];
        let mut axes = [[zero; 3]; N];
        let mut origins = [[zero; 3]; N];
        // All sines and cosines first, which the compiler can turn into vectors.
        let (mut sines, mut cosines) = ([zero; N], [zero; N]);
        for (k, joint) in self.joints.iter().enumerate() {
            T::keep_loop();
            let angle = theta[k] * T::constant(joint.turn) + T::constant(joint.offset);
            (sines[k], cosines[k]) = angle.sin_cos();
        }
        for (k, joint) in self.joints.iter().enumerate() {
            T::keep_loop();
            axes[k] = z;
            origins[k] = p;
            let (s, c) = (sines[k], cosines[k]);
            let [a, b, d] = joint.arm;
            let (a, b, d) = (T::constant(a), T::constant(b), T::constant(d));
            let d = d + theta[k] * T::constant(joint.slide);
            let (cos, sin) = (T::constant(joint.twist[0]), T::constant(joint.twist[1]));
            for i in 0..3 {
                T::keep_loop();
                let turned = c * x[i] + s * y[i];
                let across = c * y[i] - s * x[i];
                x[i] = turned;
                p[i] = p[i] + turned * a + across * b + z[i] * d;
                y[i] = cos * across + sin * z[i];
                z[i] = cos * z[i] - sin * across;
            }
        }
        self.fill(out, goal, &axes, &origins, &p, &[x, y, z]);
    }

    /// Fills residual and Jacobian from the frames.
    #[expect(clippy::needless_range_loop, reason = "one index for several arrays")]
    #[inline(always)]
    fn fill<T: Real>(
        &self,
        out: &mut Linearisation<T, N, M>,
        goal: &Goal<T>,
        axes: &[[T; 3]; N],
        origins: &[[T; 3]; N],
        p: &[T; 3],
        frame: &[[T; 3]; 3],
    ) {
        let unit = T::constant(self.per_length);
        let planar = self.task.is_planar();
        let rows = if planar { 2 } else { 3 };
        for i in 0..rows {
            out.residual[i] = (p[i] - goal.position[i]) * unit;
        }
        for (k, joint) in self.joints.iter().enumerate() {
            T::keep_loop();
            let (turn, slide) = (T::constant(joint.turn), T::constant(joint.slide));
            let z = axes[k];
            let o = origins[k];
            // Written out: a closure over wide numbers is called, not inlined.
            let lever = [p[0] - o[0], p[1] - o[1], p[2] - o[2]];
            let swing = cross(&z, &lever);
            for i in 0..rows {
                out.jacobian[i][k] = (swing[i] * turn + z[i] * slide) * unit;
            }
            match self.task {
                TaskSpace::SpatialPose => {
                    for i in 0..3 {
                        out.jacobian[(3 + i) % M][k] = z[i] * turn;
                    }
                }
                TaskSpace::PlanarPose => out.jacobian[2 % M][k] = z[2] * turn,
                _ => {}
            }
        }
        match self.task {
            TaskSpace::SpatialPose => {
                let left = rotation_left(&goal.axes, frame);
                for i in 0..3 {
                    out.residual[(3 + i) % M] = left[i];
                }
            }
            TaskSpace::PlanarPose => {
                let (g, f) = (&goal.axes[0], &frame[0]);
                let sine = g[0] * f[1] - g[1] * f[0];
                let cosine = g[0] * f[0] + g[1] * f[1];
                let half = T::constant(2.0) + T::constant(2.0) * cosine;
                let root = half.max(T::constant(1e-12)).sqrt();
                out.residual[2 % M] = sine * T::constant(2.0) / root;
            }
            _ => {}
        }
    }
}

/// 2 sin(φ/2) times the axis of the rotation from the goal to the frame.
#[inline(always)]
fn rotation_left<T: Real>(goal: &[[T; 3]; 3], frame: &[[T; 3]; 3]) -> [T; 3] {
    let mut sum = [T::constant(0.0); 3];
    let mut trace = T::constant(1.0);
    for k in 0..3 {
        let c = cross(&goal[k], &frame[k]);
        for i in 0..3 {
            sum[i] = sum[i] + c[i];
            trace = trace + goal[k][i] * frame[k][i];
        }
    }
    let scale = T::constant(1.0) / trace.max(T::constant(1e-12)).sqrt();
    [sum[0] * scale, sum[1] * scale, sum[2] * scale]
}

#[inline(always)]
fn cross<T: Real>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

impl Goal<f64> {
    /// The goal of a tool pose in the world, for the given chain.
    ///
    /// Planar tasks use x, y and the rotation about z; position tasks ignore the rotation.
    pub fn new(chain: &Chain, tool: &Isometry3<f64>) -> Goal<f64> {
        let frame = chain.base.inverse() * tool * chain.end.inverse();
        let rotation = frame.rotation.to_rotation_matrix();
        let column = |k: usize| [0, 1, 2].map(|i| rotation[(i, k)]);
        let p = frame.translation;
        Goal {
            position: [p.x, p.y, p.z],
            axes: [column(0), column(1), column(2)],
        }
    }

    /// The same goal in every lane.
    pub fn splat<T: Real>(&self) -> Goal<T> {
        Goal {
            position: self.position.map(T::constant),
            axes: self.axes.map(|axis| axis.map(T::constant)),
        }
    }
}
