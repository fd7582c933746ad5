//! Uniform random rotations.

use nalgebra::{Quaternion, UnitQuaternion};
use std::f64::consts::TAU;

/// The rotation that belongs to a point of the unit cube; uniform on SO(3) if the point is
/// uniform in the cube (K. Shoemake, 1992).
pub fn rotation(u: [f64; 3]) -> UnitQuaternion<f64> {
    let (near, far) = ((1.0 - u[0]).max(0.0).sqrt(), u[0].max(0.0).sqrt());
    let (s, c) = (TAU * u[1]).sin_cos();
    let (t, d) = (TAU * u[2]).sin_cos();
    UnitQuaternion::new_normalize(Quaternion::new(far * d, near * s, near * c, far * t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{Lattice, stream};
    use nalgebra::Matrix3;

    /// Uniform rotations have mean zero, and every entry of the matrix the mean square 1/3.
    #[test]
    fn entries_have_the_moments_of_the_uniform_measure() {
        let lattice = Lattice::<3>::random(&mut stream(1, 0));
        let count = 20_000;
        let (mut mean, mut square) = (Matrix3::zeros(), Matrix3::zeros());
        for index in 0..count {
            let matrix = *rotation(lattice.point(index)).to_rotation_matrix().matrix();
            mean += matrix;
            square += matrix.component_mul(&matrix);
        }
        assert!((mean / count as f64).amax() < 3e-3);
        assert!((square / count as f64).add_scalar(-1.0 / 3.0).amax() < 3e-3);
    }
}
