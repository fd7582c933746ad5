//! The two linear-algebra steps of tracing: the oriented null vector with the least-norm Newton
//! correction, and the damped correction of a distant configuration.
//!
//! Both are written out for fixed sizes because they run millions of times a second; general
//! linear algebra goes through nalgebra.

use super::kernel::Linearisation;
use super::lane::Real;

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

/// Null vector and correction for N = M + 1, by Gaussian elimination with column pivoting.
///
/// The sign of the tangent is intrinsic, i.e. a property of the configuration alone: two strands
/// of a manifold that run past each other are oriented oppositely, so that a jump from one to the
/// other shows. `None` where the Jacobian has lost rank to working precision.
#[expect(clippy::needless_range_loop, reason = "indices as in the textbook")]
#[inline(always)]
pub fn newton_step<const N: usize, const M: usize>(
    linear: &Linearisation<f64, N, M>,
) -> Option<NewtonStep<N>> {
    debug_assert_eq!(N, M + 1);
    let mut a = linear.jacobian;
    let mut b = linear.residual;
    let mut order: [usize; N] = std::array::from_fn(|i| i);
    let mut determinant = if M.is_multiple_of(2) { 1.0 } else { -1.0 };
    for k in 0..M {
        let mut pivot = k;
        for j in k + 1..N {
            if a[k][j].abs() > a[k][pivot].abs() {
                pivot = j;
            }
        }
        if pivot != k {
            for row in &mut a {
                row.swap(k, pivot);
            }
            order.swap(k, pivot);
            determinant = -determinant;
        }
        let p = a[k][k];
        determinant *= p;
        if p.abs() < 1e-14 {
            return None;
        }
        let inverse = 1.0 / p;
        for i in k + 1..M {
            let factor = a[i][k] * inverse;
            for j in k + 1..N {
                a[i][j] -= factor * a[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    // Back-substitution of both: the null vector with last entry 1, and a solution with last 0.
    let (mut null, mut solution) = ([0.0; N], [0.0; N]);
    null[M] = 1.0;
    for k in (0..M).rev() {
        let (mut n, mut s) = (-a[k][M], -b[k]);
        for j in k + 1..M {
            n -= a[k][j] * null[j];
            s -= a[k][j] * solution[j];
        }
        let inverse = 1.0 / a[k][k];
        null[k] = n * inverse;
        solution[k] = s * inverse;
    }
    let norm = dot(&null, &null).sqrt();
    let scale = determinant.signum() / norm;
    let along = dot(&null, &solution) / (norm * norm);
    let mut step = NewtonStep {
        tangent: [0.0; N],
        correction: [0.0; N],
        manipulability: determinant.abs() * norm,
    };
    for k in 0..N {
        step.tangent[order[k]] = null[k] * scale;
        step.correction[order[k]] = solution[k] - along * null[k];
    }
    Some(step)
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
pub(crate) fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let mut sum = 0.0;
    for k in 0..N {
        sum += a[k] * b[k];
    }
    sum
}
