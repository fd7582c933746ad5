//! Directions in which self-motion leaves a singular configuration.
//!
//! A curve θ(t) that keeps the tool still has J θ' = 0, and one more derivative gives
//! J θ'' + (Σ_k θ'_k ∂J/∂θ_k) θ' = 0. With θ' = N a, N a basis of the null space, and U₀ the output
//! directions that J has lost, a curve exists only if the quadratic forms
//!
//! q_j(a) = û_jᵀ (Σ_k (N a)_k ∂J/∂θ_k) N a
//!
//! all vanish: two crossing lines at a rank loss of 1 where the form is indefinite (the node of
//! [S1 Fig. 1]), up to four at a loss of 2 ([S1 Fig. 2]). Not every singular vector of the null
//! space is such a direction, as [S1 eq. 17] has it.

use super::stratum::Arm;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Directions nearer to each other than this are one, radians.
const APART: f64 = 1e-2;
/// Starts on the sphere of directions.
const STARTS: usize = 240;

/// Unit directions, n numbers each, of all branches through `theta`, where J has lost rank `loss`;
/// both senses of a branch share one. If the second order leaves all directions open, a sample of
/// all of them.
pub(super) fn directions(arm: &Arm, theta: &[f64], loss: usize) -> Vec<Vec<f64>> {
    let here = arm.at(theta);
    let parts = arm.parts(theta);
    let (u, null) = (parts.lost(loss), parts.still(loss + arm.surplus()));
    let forms: Vec<DMatrix<f64>> = (0..loss)
        .map(|j| {
            let row = |r: usize| {
                let turned = here.along(null.column(r).as_slice());
                u.column(j).transpose() * turned * &null
            };
            let rows: Vec<_> = (0..null.ncols()).map(row).collect();
            let form = DMatrix::from_rows(&rows);
            0.5 * (&form + form.transpose())
        })
        .collect();
    let scale = forms.iter().map(|form| form.amax()).fold(0.0, f64::max);
    let mut found: Vec<DVector<f64>> = Vec::new();
    for k in 0..STARTS {
        let start = spread(k, null.ncols());
        let direction = match scale < 1e-9 {
            true => Some(start),
            false => root(&forms, start, scale),
        };
        let Some(direction) = direction else { continue };
        let known = |other: &DVector<f64>| other.dot(&direction).abs() > APART.cos();
        if !found.iter().any(known) {
            found.push(direction);
        }
    }
    let lifted = found.iter().map(|a| (&null * a).as_slice().to_vec());
    lifted.collect()
}

/// Newton steps for q_j(a) = 0, |a| = 1.
fn root(forms: &[DMatrix<f64>], start: DVector<f64>, scale: f64) -> Option<DVector<f64>> {
    let mut a = start;
    for _ in 0..30 {
        let mut value = DVector::zeros(forms.len());
        let mut slope = DMatrix::zeros(forms.len(), a.len());
        for (j, form) in forms.iter().enumerate() {
            let image = form * &a;
            value[j] = a.dot(&image);
            slope.set_row(j, &(2.0 * image.transpose()));
        }
        if value.amax() < 1e-12 * scale {
            return Some(a);
        }
        // Damped, so that double roots are found as well.
        let gram = &slope * slope.transpose();
        let damping = 1e-9 * scale * scale;
        let damped = gram + DMatrix::identity(forms.len(), forms.len()) * damping;
        a -= slope.tr_mul(&damped.cholesky()?.solve(&value));
        let norm = a.norm();
        if norm < 1e-3 || !norm.is_finite() {
            return None;
        }
        a /= norm;
    }
    None
}

/// Direction number `k` of an even spread over half the sphere in `size` dimensions.
fn spread(k: usize, size: usize) -> DVector<f64> {
    let share = (k as f64 + 0.5) / STARTS as f64;
    let direction = match size {
        0 | 1 => vec![1.0; size],
        2 => vec![(PI * share).cos(), (PI * share).sin()],
        _ => {
            // A Kronecker sequence in the cube around the sphere.
            let place = |axis: usize| {
                let step = (axis as f64 + 2.0).sqrt() * 1.618_033_988_749_895;
                2.0 * ((k as f64 + 0.5) * step).fract() - 1.0
            };
            (0..size).map(place).collect()
        }
    };
    DVector::from_vec(direction).normalize()
}
