//! Gradients of singular values, and the direction in which a group of nearly equal ones falls.
//!
//! ∂σ_i/∂θ_k = û_iᵀ ∂J/∂θ_k v̂_i [S1 eq. 12]. Where singular values nearly meet, the vectors of
//! the group are defined up to a common rotation Q of both subspaces, and every choice of Q and of
//! weights β gives a gradient g(W)_k = tr(W S_k), W = Q diag(β) Qᵀ, with S_k the symmetric part
//! of U_gᵀ ∂J/∂θ_k V_g. The paper rotates until the angles between the gradients are least and
//! then searches for β. Both are one convex problem: the W (W ≥ 0, tr W = 1) whose gradient is
//! shortest. Along −g(W) the greatest value of the group falls fastest, and if g(W) = 0 no
//! direction lowers it: a local minimum.

use super::decomposition::Decomposition;
use crate::kinematics::Differential;
use nalgebra::{DMatrix, DVector};

/// Steps of the convex problem.
const STEPS: usize = 80;

/// The gradient of the group of singular values with indices `group` (consecutive, from 0), as
/// described above; n numbers.
pub(super) fn gradient(
    here: &Differential,
    parts: &Decomposition,
    group: std::ops::Range<usize>,
) -> DVector<f64> {
    let u = parts.u.columns(group.start, group.len()).into_owned();
    let v = parts.v.columns(group.start, group.len()).into_owned();
    let slope = |k: usize| {
        let s = u.transpose() * here.derivative(k) * &v;
        0.5 * (&s + s.transpose())
    };
    let slopes: Vec<DMatrix<f64>> = (0..here.joints()).map(slope).collect();
    shortest(&slopes)
}

/// The shortest g(W), by steps towards single eigenvectors (Frank and Wolfe).
fn shortest(slopes: &[DMatrix<f64>]) -> DVector<f64> {
    let size = slopes.first().map_or(1, |s| s.nrows());
    let of =
        |w: &DMatrix<f64>| DVector::from_iterator(slopes.len(), slopes.iter().map(|s| s.dot(w)));
    let mut g = of(&(DMatrix::identity(size, size) / size as f64));
    if size == 1 {
        return g;
    }
    for _ in 0..STEPS {
        let zero = DMatrix::zeros(size, size);
        let m = slopes
            .iter()
            .zip(g.iter())
            .fold(zero, |sum, (s, &share)| sum + s * share);
        let eigen = m.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        let w = eigen.eigenvectors.column(least).into_owned();
        let corner = of(&(&w * w.transpose()));
        let gap = g.dot(&(&g - &corner));
        if gap <= 1e-9 * g.norm_squared() {
            break;
        }
        let way = &g - &corner;
        let share = (gap / way.norm_squared().max(1e-300)).min(1.0);
        g -= share * way;
    }
    g
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two singular values with gradients at an angle: the shortest combination is at a right
    /// angle to their difference.
    #[test]
    fn the_combination_lowers_both() {
        let slopes = [
            DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 0.2]),
            DMatrix::from_row_slice(2, 2, &[0.0, 0.0, 0.0, 1.0]),
        ];
        let g = shortest(&slopes);
        // Gradients (1, 0) and (0.2, 1): their combination nearest to 0.
        let (a, b) = ([1.0, 0.0], [0.2, 1.0]);
        assert!((g[0] * (a[0] - b[0]) + g[1] * (a[1] - b[1])).abs() < 1e-3);
        assert!(g[0] > 0.0 && g[1] > 0.0);
    }

    #[test]
    fn opposite_gradients_are_a_minimum() {
        let slopes = [DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, -1.0])];
        assert!(shortest(&slopes).norm() < 1e-6);
    }
}
