//! The two linear-algebra steps of tracing: the oriented null vector with the least-norm Newton
//! correction, and the damped correction of a distant configuration.
//!
//! Both are written out for fixed sizes because they run millions of times a second; general
//! linear algebra goes through nalgebra.

use super::kernel::Linearisation;
use super::lane::Real;
use super::pivot::Pivot;

/// What one linearisation says about the manifold at a configuration.
#[derive(Clone, Copy, Debug)]
pub struct NewtonStep<const N: usize> {
    /// Unit null vector, oriented as the cofactor field n_i = (−1)^i det(J without column i).
    pub tangent: [f64; N],
    /// Least-norm correction −J⁺ residual.
    pub correction: [f64; N],
    /// √det(JJᵀ) up to the rows' scale: 0 at singular configurations.
    pub manipulability: f64,
}

/// Newton steps of one configuration or of eight, with their coordinates in the order in which the
/// elimination has left them.
#[derive(Clone, Copy, Debug)]
pub struct PivotedStep<T: Pivot, const N: usize> {
    tangent: [T; N],
    correction: [T; N],
    manipulability: T,
    /// Which coordinate every entry belongs to.
    order: [T::Index; N],
    /// The least pivot's magnitude.
    least: T,
}

impl<T: Pivot, const N: usize> PivotedStep<T, N> {
    /// The step in lane `lane`; `None` where the Jacobian has lost rank to working precision.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Option<NewtonStep<N>> {
        if self.least.lane(lane) < 1e-14 {
            return None;
        }
        let mut step = NewtonStep {
            tangent: [0.0; N],
            correction: [0.0; N],
            manipulability: self.manipulability.lane(lane),
        };
        for k in 0..N {
            let coordinate = T::index_in(self.order[k], lane);
            step.tangent[coordinate] = self.tangent[k].lane(lane);
            step.correction[coordinate] = self.correction[k].lane(lane);
        }
        Some(step)
    }
}

/// Null vector and correction for N = M + 1, see [`newton_steps`]; `None` where the Jacobian has
/// lost rank to working precision.
#[inline(always)]
pub fn newton_step<const N: usize, const M: usize>(
    linear: &Linearisation<f64, N, M>,
) -> Option<NewtonStep<N>> {
    newton_steps(&mut { *linear }).lane(0)
}

/// Null vectors and corrections for N = M + 1, by Gaussian elimination with column pivoting, which
/// overwrites `linear`.
///
/// The sign of a tangent is intrinsic, i.e. a property of the configuration alone: two strands
/// of a manifold that run past each other are oriented oppositely, so that a jump from one to the
/// other shows.
#[expect(clippy::needless_range_loop, reason = "indices as in the textbook")]
#[inline(always)]
pub fn newton_steps<T: Pivot, const N: usize, const M: usize>(
    linear: &mut Linearisation<T, N, M>,
) -> PivotedStep<T, N> {
    debug_assert_eq!(N, M + 1);
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let Linearisation {
        jacobian: a,
        residual: b,
    } = linear;
    let mut order = [T::index(0); N];
    for k in 0..N {
        order[k] = T::index(k);
    }
    let mut least = T::constant(f64::INFINITY);
    // Its sign changes with every swap.
    let mut determinant = if M.is_multiple_of(2) { one } else { -one };
    for k in 0..M {
        T::keep_loop();
        let pivot = T::greatest(&a[k], k);
        T::swap_columns(a, k, pivot);
        T::swap_indices(&mut order, k, pivot);
        let p = a[k][k];
        determinant = determinant.negated_unless(pivot, k) * p;
        least = p.abs().min(least);
        let inverse = one / p;
        for i in k + 1..M {
            T::keep_loop();
            let factor = a[i][k] * inverse;
            for j in k + 1..N {
                T::keep_loop();
                a[i][j] = a[i][j] - factor * a[k][j];
            }
            b[i] = b[i] - factor * b[k];
        }
    }
    // Back-substitution of both: the null vector with last entry 1, and a solution with last 0.
    let (mut null, mut solution) = ([zero; N], [zero; N]);
    null[M] = one;
    for k in (0..M).rev() {
        T::keep_loop();
        let (mut n, mut s) = (-a[k][M], -b[k]);
        for j in k + 1..M {
            T::keep_loop();
            n = n - a[k][j] * null[j];
            s = s - a[k][j] * solution[j];
        }
        let inverse = one / a[k][k];
        null[k] = n * inverse;
        solution[k] = s * inverse;
    }
    let norm = dot(&null, &null).sqrt();
    let scale = determinant.signum() / norm;
    let along = dot(&null, &solution) / (norm * norm);
    for k in 0..N {
        T::keep_loop();
        solution[k] = solution[k] - along * null[k];
        null[k] = null[k] * scale;
    }
    PivotedStep {
        tangent: null,
        correction: solution,
        manipulability: determinant.abs() * norm,
        order,
        least,
    }
}

/// Damped least-norm correction −Jᵀ (JJᵀ + λ)⁻¹ residual (Levenberg–Marquardt), by an unpivoted
/// Cholesky factorisation, which λ > 0 makes safe.
#[expect(clippy::needless_range_loop, reason = "indices as in the textbook")]
#[inline(always)]
pub fn damped_step<T: Real, const N: usize, const M: usize>(
    linear: &Linearisation<T, N, M>,
    lambda: T,
) -> [T; N] {
    let zero = T::constant(0.0);
    let j = &linear.jacobian;
    let mut l = [[zero; M]; M];
    let mut inverse = [zero; M];
    for i in 0..M {
        T::keep_loop();
        for k in 0..=i {
            T::keep_loop();
            let mut sum = if i == k { lambda } else { zero };
            for c in 0..N {
                T::keep_loop();
                sum = sum + j[i][c] * j[k][c];
            }
            for c in 0..k {
                T::keep_loop();
                sum = sum - l[i][c] * l[k][c];
            }
            if i == k {
                inverse[i] = T::constant(1.0) / sum.max(T::constant(1e-300)).sqrt();
            } else {
                l[i][k] = sum * inverse[k];
            }
        }
    }
    let mut w = [zero; M];
    for i in 0..M {
        T::keep_loop();
        let mut sum = zero - linear.residual[i];
        for c in 0..i {
            T::keep_loop();
            sum = sum - l[i][c] * w[c];
        }
        w[i] = sum * inverse[i];
    }
    for i in (0..M).rev() {
        T::keep_loop();
        let mut sum = w[i];
        for c in i + 1..M {
            T::keep_loop();
            sum = sum - l[c][i] * w[c];
        }
        w[i] = sum * inverse[i];
    }
    let mut step = [zero; N];
    for c in 0..N {
        T::keep_loop();
        for i in 0..M {
            T::keep_loop();
            step[c] = step[c] + j[i][c] * w[i];
        }
    }
    step
}

/// Inner product.
#[inline(always)]
pub(crate) fn dot<T: Real, const N: usize>(a: &[T; N], b: &[T; N]) -> T {
    let mut sum = T::constant(0.0);
    for k in 0..N {
        T::keep_loop();
        sum = sum + a[k] * b[k];
    }
    sum
}
