//! Low-discrepancy points: an additive lattice with a random shift.
//!
//! Point i has the coordinates frac(shift + i · g⁻¹), frac(shift + i · g⁻²), …, where g solves
//! g^(d+1) = g + 1 (the golden ratio for d = 1; M. Roberts, 2018). Any number of points can be
//! taken, and every shift gives an unbiased estimate of an integral, so that several independent
//! shifts give its standard error.

use rand::Rng;

/// A shifted additive lattice in the unit cube of dimension `D`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice<const D: usize> {
    shift: [f64; D],
    step: [f64; D],
}

impl<const D: usize> Lattice<D> {
    /// A lattice with a shift drawn from `rng`.
    pub fn random(rng: &mut impl Rng) -> Lattice<D> {
        let ratio = generalised_golden_ratio(D);
        Lattice {
            shift: std::array::from_fn(|_| rng.random()),
            step: std::array::from_fn(|k| ratio.powi(-(k as i32) - 1)),
        }
    }

    /// Point number `index`, every coordinate in [0, 1).
    pub fn point(&self, index: u64) -> [f64; D] {
        std::array::from_fn(|k| (self.shift[k] + index as f64 * self.step[k]).fract())
    }
}

/// The root g > 1 of g^(d+1) = g + 1.
fn generalised_golden_ratio(dimension: usize) -> f64 {
    let exponent = 1.0 / (dimension as f64 + 1.0);
    // The map contracts by less than a half: 64 rounds reach round-off.
    (0..64).fold(1.5, |g: f64, _| (g + 1.0).powf(exponent))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::stream;

    #[test]
    fn one_dimension_is_the_golden_ratio() {
        assert!((generalised_golden_ratio(1) - 1.618_033_988_749_895).abs() < 1e-14);
    }

    /// The mean of a smooth function converges much faster than by random points.
    #[test]
    fn integrates_a_smooth_function() {
        let lattice = Lattice::<5>::random(&mut stream(3, 0));
        let points = 20_000;
        let value = |x: [f64; 5]| x.iter().map(|x| x * (1.0 - x)).product::<f64>();
        let sum: f64 = (0..points).map(|i| value(lattice.point(i))).sum();
        let exact = 6f64.powi(-5);
        assert!((sum / points as f64 / exact - 1.0).abs() < 2e-3);
    }
}
