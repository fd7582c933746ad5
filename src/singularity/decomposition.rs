//! Singular value decomposition of a Jacobian, J = U D Vᵀ [S1 eq. 7], by one-sided Jacobi
//! rotations.
//!
//! Small singular values keep their digits, which those from the eigenvalues of JJᵀ lose; and the
//! vectors are right for every matrix, which the general routine at hand does not promise.

use nalgebra::{DMatrix, DVector};

/// Rows are orthogonal to working precision below this cosine.
const ORTHOGONAL: f64 = 1e-15;
/// Sweeps over all pairs; six are usual.
const SWEEPS: usize = 60;
/// Singular values below this share of the greatest are round-off.
const NOTHING: f64 = 1e-14;

/// U, the singular values and V of an m × n matrix with m ≤ n.
#[derive(Clone, Debug)]
pub(crate) struct Decomposition {
    /// Output singular vectors, m × m, in columns.
    pub u: DMatrix<f64>,
    /// σ₁ ≥ … ≥ σ_m ≥ 0.
    pub sigma: Vec<f64>,
    /// Input singular vectors, n × n, in columns; those from m on span the null space.
    pub v: DMatrix<f64>,
}

impl Decomposition {
    pub fn new(j: &DMatrix<f64>) -> Decomposition {
        let (m, n) = j.shape();
        // Columns become σ v.
        let mut a = j.transpose();
        let mut w = DMatrix::<f64>::identity(m, m);
        for _ in 0..SWEEPS {
            let mut turned = false;
            for p in 0..m {
                for q in p + 1..m {
                    turned |= rotate(&mut a, &mut w, p, q);
                }
            }
            if !turned {
                break;
            }
        }
        let norms: Vec<f64> = (0..m).map(|i| a.column(i).norm()).collect();
        let mut order: Vec<usize> = (0..m).collect();
        order.sort_by(|&x, &y| norms[y].total_cmp(&norms[x]));
        let sigma: Vec<f64> = order.iter().map(|&i| norms[i]).collect();
        let least = NOTHING * sigma.first().copied().unwrap_or(0.0);
        let mut v = DMatrix::zeros(n, n);
        let mut known = 0;
        for &i in &order {
            if norms[i] > least {
                v.set_column(known, &(a.column(i) / norms[i]));
                known += 1;
            }
        }
        complete(&mut v, known);
        Decomposition {
            u: DMatrix::from_fn(m, m, |r, c| w[(r, order[c])]),
            sigma,
            v,
        }
    }

    /// The last `count` output singular vectors, m × count.
    pub fn lost(&self, count: usize) -> DMatrix<f64> {
        let m = self.u.ncols();
        self.u.columns(m - count, count).into_owned()
    }

    /// The last `count` input singular vectors, n × count.
    pub fn still(&self, count: usize) -> DMatrix<f64> {
        let n = self.v.ncols();
        self.v.columns(n - count, count).into_owned()
    }

    /// How many singular values are at most `threshold`.
    pub fn loss(&self, threshold: f64) -> usize {
        self.sigma.iter().filter(|s| **s <= threshold).count()
    }
}

/// Makes columns p and q of `a` orthogonal; whether they had to be turned.
fn rotate(a: &mut DMatrix<f64>, w: &mut DMatrix<f64>, p: usize, q: usize) -> bool {
    let (alpha, beta) = (a.column(p).norm_squared(), a.column(q).norm_squared());
    let gamma = a.column(p).dot(&a.column(q));
    if gamma.abs() <= ORTHOGONAL * (alpha * beta).sqrt() || gamma == 0.0 {
        return false;
    }
    let zeta = (beta - alpha) / (2.0 * gamma);
    let t = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
    let c = 1.0 / t.hypot(1.0);
    let s = c * t;
    for matrix in [a, w] {
        for row in 0..matrix.nrows() {
            let (x, y) = (matrix[(row, p)], matrix[(row, q)]);
            matrix[(row, p)] = c * x - s * y;
            matrix[(row, q)] = s * x + c * y;
        }
    }
    true
}

/// Fills the columns from `known` on with an orthonormal basis of what the ones before leave.
fn complete(v: &mut DMatrix<f64>, known: usize) {
    let n = v.nrows();
    for column in known..n {
        // Of all axes the one with the greatest part outside.
        let outside = |axis: usize| {
            let mut e = DVector::zeros(n);
            e[axis] = 1.0;
            // Twice is enough.
            for _ in 0..2 {
                for c in 0..column {
                    let part = v.column(c).dot(&e);
                    e.axpy(-part, &v.column(c), 1.0);
                }
            }
            e
        };
        let best = (0..n).map(outside);
        let best = best.max_by(|x, y| x.norm().total_cmp(&y.norm()));
        if let Some(best) = best {
            v.set_column(column, &best.normalize());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::stream;
    use rand::Rng;

    #[test]
    fn factors_multiply_back_and_small_values_keep_their_digits() {
        let mut rng = stream(5, 0);
        for rank in 1..=6 {
            for small in [1.0, 1e-6, 1e-12] {
                let mut j = DMatrix::zeros(6, 7);
                for k in 0..rank {
                    let x = DVector::from_fn(6, |_, _| rng.random_range(-1.0..1.0));
                    let y = DVector::from_fn(7, |_, _| rng.random_range(-1.0..1.0));
                    let scale = if k + 1 == rank { small } else { 1.0 };
                    j += scale * x * y.transpose();
                }
                let found = Decomposition::new(&j);
                let d = DMatrix::from_fn(6, 7, |r, c| if r == c { found.sigma[r] } else { 0.0 });
                let error = (&found.u * d * found.v.transpose() - &j).amax();
                assert!(error < 1e-13, "rank {rank}, {small}: {error}");
                let unit = |q: &DMatrix<f64>| {
                    (q.transpose() * q - DMatrix::identity(q.ncols(), q.ncols())).amax()
                };
                assert!(unit(&found.u) < 1e-13 && unit(&found.v) < 1e-10);
                assert_eq!(found.loss(1e-14), 6 - rank);
            }
        }
    }
}
