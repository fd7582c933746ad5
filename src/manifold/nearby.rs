//! Which vertices of a curve lie near a configuration: eight at a time.

use super::curve::short_way;
use crate::kinematics::{LANES, Lanes, Real, dot};
use multiversion::multiversion;
use smallvec::SmallVec;

/// A curve's vertices, eight in the lanes of every block.
#[derive(Clone, Debug, Default)]
pub(super) struct Blocks<const N: usize>(Vec<[Lanes; N]>);

/// Indices of vertices, ascending.
pub(super) type Near = SmallVec<[usize; 16]>;

impl<const N: usize> Blocks<N> {
    /// Replaces the vertices.
    pub fn set(&mut self, points: &[[f64; N]]) {
        self.0.clear();
        for chunk in points.chunks(LANES) {
            // Nothing is near to a lane without a vertex.
            let mut block = [Lanes::constant(f64::NAN); N];
            for (lane, point) in chunk.iter().enumerate() {
                for (lanes, coordinate) in block.iter_mut().zip(point) {
                    lanes.0[lane] = *coordinate;
                }
            }
            self.0.push(block);
        }
    }

    /// The vertices at most `distance` from `point`, modulo full turns.
    pub fn near(&self, point: &[f64; N], distance: f64) -> Near {
        let mut near = Near::new();
        collect(&self.0, point, distance * distance, &mut near);
        near
    }
}

#[multiversion(
    targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"),
    dispatcher = "direct"
)]
fn collect<const N: usize>(blocks: &[[Lanes; N]], point: &[f64; N], square: f64, near: &mut Near) {
    for (index, block) in blocks.iter().enumerate() {
        let mut gap = [Lanes::constant(0.0); N];
        for k in 0..N {
            Lanes::keep_loop();
            gap[k] = short_way(Lanes::constant(point[k]) - block[k]);
        }
        let squares = dot(&gap, &gap);
        let mut any = false;
        for lane in 0..LANES {
            any |= squares.0[lane] <= square;
        }
        if any {
            let lanes = (0..LANES).filter(|&lane| squares.0[lane] <= square);
            near.extend(lanes.map(|lane| index * LANES + lane));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::curve::distance;
    use super::*;
    use crate::sampling::stream;
    use rand::Rng;

    #[test]
    fn finds_the_vertices_that_one_by_one_are_near() {
        let mut rng = stream(5, 0);
        let mut draw = || -> [f64; 3] { std::array::from_fn(|_| rng.random_range(-9.0..9.0)) };
        let mut blocks = Blocks::default();
        // The second set is shorter: nothing of the first may be left.
        for count in [83, 21, 8, 1] {
            let points: Vec<[f64; 3]> = (0..count).map(|_| draw()).collect();
            blocks.set(&points);
            for _ in 0..50 {
                let point = draw();
                let near = |&index: &usize| distance(&points[index], &point) <= 2.5;
                let expected: Vec<usize> = (0..count).filter(near).collect();
                assert_eq!(blocks.near(&point, 2.5).to_vec(), expected);
            }
        }
    }
}
