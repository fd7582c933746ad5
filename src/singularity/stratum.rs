//! The set of configurations at which J loses rank k: Newton steps onto it, and its tangent space.
//!
//! With U₀ the last k output and V₀ the last k + n − m input singular vectors, J has lost rank k
//! exactly where E = U₀ᵀ J V₀ vanishes; to first order E changes by U₀ᵀ ∂J/∂θ_j V₀ per unit of
//! θ_j. These are smooth equations where the singular values themselves have kinks.

use super::decomposition::Decomposition;
use crate::design::TaskSpace;
use crate::kinematics::{Chain, Differential};
use nalgebra::{DMatrix, DVector, Isometry3};

/// Singular values at most this large, metres or radians per radian, count as 0.
pub const SINGULAR: f64 = 1e-8;
/// Largest change of a joint in a step, radians.
const LONGEST: f64 = 0.3;
/// Newton steps.
const STEPS: usize = 40;
/// Eigenvalues of the equations' Gram matrix below this share of the greatest are 0.
const FLAT: f64 = 1e-9;

/// A robot's task as this module asks for it.
#[derive(Clone, Copy, Debug)]
pub struct Arm<'a> {
    /// The chain whose internal joint variables configurations have.
    pub chain: &'a Chain,
    /// What the tool is asked to reach.
    pub task: TaskSpace,
}

impl Arm<'_> {
    pub(super) fn at(&self, theta: &[f64]) -> Differential {
        Differential::new(self.chain, self.task, theta)
    }

    pub(super) fn parts(&self, theta: &[f64]) -> Decomposition {
        Decomposition::new(&self.at(theta).jacobian())
    }

    /// Singular values of J at `theta`, greatest first; metres and radians mixed, as in [S1].
    pub fn singular_values(&self, theta: &[f64]) -> Vec<f64> {
        self.parts(theta).sigma
    }

    /// n − m.
    pub(super) fn surplus(&self) -> usize {
        self.chain.len() - self.task.dimension()
    }

    /// The difference of two tool poses in the rows of the task, for small ones.
    pub(super) fn difference(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> Vec<f64> {
        let v = to.translation.vector - from.translation.vector;
        let w = (to.rotation * from.rotation.inverse()).scaled_axis();
        match self.task {
            TaskSpace::PlanarPosition => vec![v.x, v.y],
            TaskSpace::PlanarPose => vec![v.x, v.y, w.z],
            TaskSpace::SpatialPosition => vec![v.x, v.y, v.z],
            TaskSpace::SpatialPose => vec![v.x, v.y, v.z, w.x, w.y, w.z],
        }
    }

    /// E as a vector, and its derivative with n columns, for rank loss `loss`.
    fn equations(&self, theta: &[f64], loss: usize) -> (DVector<f64>, DMatrix<f64>) {
        let here = self.at(theta);
        let parts = Decomposition::new(&here.jacobian());
        let (u, v) = (parts.lost(loss), parts.still(loss + self.surplus()));
        let flat = |m: DMatrix<f64>| DVector::from_column_slice(m.as_slice());
        let value = flat(u.transpose() * here.jacobian() * &v);
        let mut slope = DMatrix::zeros(value.len(), here.joints());
        for k in 0..here.joints() {
            slope.set_column(k, &flat(u.transpose() * here.derivative(k) * &v));
        }
        (value, slope)
    }

    /// The nearest configuration with rank loss `loss` (at least 1); with `tool`, on the pre-image
    /// of that pose. `None` if the steps do not lead to one.
    pub(super) fn settle(
        &self,
        theta: &[f64],
        loss: usize,
        tool: Option<&Isometry3<f64>>,
    ) -> Option<Vec<f64>> {
        self.settle_within(theta, loss, tool, 1e-10)
    }

    /// As [`Arm::settle`], with `slack` (metres and radians) in the equations where no
    /// configuration solves them all.
    pub(super) fn settle_within(
        &self,
        theta: &[f64],
        loss: usize,
        tool: Option<&Isometry3<f64>>,
        slack: f64,
    ) -> Option<Vec<f64>> {
        let mut theta = theta.to_vec();
        let mut least = f64::INFINITY;
        for step in 0..STEPS {
            let (mut value, mut slope) = self.equations(&theta, loss);
            if let Some(goal) = tool {
                let miss = self.difference(goal, &self.chain.tool(&theta));
                let below = value.len();
                value = value.resize_vertically(below + miss.len(), 0.0);
                value.rows_mut(below, miss.len()).copy_from_slice(&miss);
                slope = slope.resize_vertically(below + miss.len(), 0.0);
                slope
                    .rows_mut(below, miss.len())
                    .copy_from(&self.at(&theta).jacobian());
            }
            let norm = value.norm();
            if norm < 1e-13 || (norm < slack && norm > 0.5 * least) {
                return Some(theta);
            }
            least = least.min(norm);
            // Steps that gain nothing over a while lead nowhere.
            if !norm.is_finite() || (step > 12 && norm > 1e-2) {
                return None;
            }
            let gram = slope.tr_mul(&slope);
            let damping = 1e-2 * norm.powi(2) + 1e-15 * gram.trace().max(1e-9);
            let damped = gram + DMatrix::identity(theta.len(), theta.len()) * damping;
            let mut delta = damped.cholesky()?.solve(&slope.tr_mul(&value));
            let longest = delta.amax();
            if longest > LONGEST {
                delta *= LONGEST / longest;
            }
            for (angle, change) in theta.iter_mut().zip(delta.iter()) {
                *angle -= change;
            }
        }
        None
    }

    /// An orthonormal basis of the directions in which the rank loss stays, n × dimension.
    pub(super) fn tangent_space(&self, theta: &[f64], loss: usize) -> DMatrix<f64> {
        let n = theta.len();
        if loss == 0 {
            return DMatrix::identity(n, n);
        }
        let (_, slope) = self.equations(theta, loss);
        kernel(&slope.tr_mul(&slope), FLAT)
    }
}

/// Eigenvectors of a symmetric matrix with eigenvalues below `share` of the greatest, in columns.
pub(super) fn kernel(gram: &DMatrix<f64>, share: f64) -> DMatrix<f64> {
    let eigen = gram.clone().symmetric_eigen();
    let most = eigen.eigenvalues.max().max(1e-30);
    let flat: Vec<_> = (0..gram.nrows())
        .filter(|&k| eigen.eigenvalues[k] <= share * most)
        .map(|k| eigen.eigenvectors.column(k).into_owned())
        .collect();
    match flat.is_empty() {
        true => DMatrix::zeros(gram.nrows(), 0),
        false => DMatrix::from_columns(&flat),
    }
}
