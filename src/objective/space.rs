//! A box of search variables, with what a search method may want to know about its shape.

use rand::Rng;
use serde::{Deserialize, Serialize};

/// One search variable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variable {
    /// Smallest value.
    pub lower: f64,
    /// Largest value.
    pub upper: f64,
    /// Whether `lower` and `upper` are the same place, as for an angle.
    pub periodic: bool,
    /// Probability that a random point takes one of the two ends. Optima often lie there (a joint
    /// free or held still), where uniform draws never fall.
    pub end_bias: f64,
}

/// The box that an optimiser searches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SearchSpace {
    /// The box, one entry per coordinate.
    pub variables: Vec<Variable>,
    /// Directions along which a coordinate search moves, each of the box's dimension. They need
    /// not be unit vectors: one unit along a direction is one unit of what it stands for.
    pub directions: Vec<Vec<f64>>,
    /// Coordinates that belong together and are replaced together, e.g. one joint's limits.
    pub blocks: Vec<Vec<usize>>,
}

impl SearchSpace {
    /// Number of coordinates.
    pub fn dimension(&self) -> usize {
        self.variables.len()
    }

    /// A random point: uniform, but for the ends that `end_bias` asks for.
    pub fn random(&self, generator: &mut impl Rng) -> Vec<f64> {
        let draw = |v: &Variable| {
            // Both numbers are always drawn, so that one variable's bias does not shift the rest.
            let (at_end, share) = (generator.random::<f64>(), generator.random::<f64>());
            if at_end < v.end_bias {
                if share < 0.5 { v.lower } else { v.upper }
            } else {
                v.lower + (v.upper - v.lower) * share
            }
        };
        self.variables.iter().map(draw).collect()
    }

    /// Puts a point back into the box: periodic coordinates wrap, the others stop at the wall.
    pub fn confine(&self, x: &mut [f64]) {
        for (value, variable) in x.iter_mut().zip(&self.variables) {
            let span = variable.upper - variable.lower;
            if variable.periodic && span > 0.0 {
                if !(variable.lower..=variable.upper).contains(value) {
                    *value = variable.lower + (*value - variable.lower).rem_euclid(span);
                }
            } else {
                *value = value.clamp(variable.lower, variable.upper);
            }
        }
    }

    /// Range of t for which x + t·direction stays in the box; periodic coordinates allow half a
    /// period to either side.
    pub fn travel(&self, x: &[f64], direction: &[f64]) -> [f64; 2] {
        let mut range = [f64::NEG_INFINITY, f64::INFINITY];
        for ((&value, variable), &step) in x.iter().zip(&self.variables).zip(direction) {
            if step == 0.0 {
                continue;
            }
            let (lower, upper) = if variable.periodic {
                let half = 0.5 * (variable.upper - variable.lower);
                (value - half, value + half)
            } else {
                (variable.lower, variable.upper)
            };
            let ends = [(lower - value) / step, (upper - value) / step];
            range[0] = range[0].max(ends[0].min(ends[1]).min(0.0));
            range[1] = range[1].min(ends[0].max(ends[1]).max(0.0));
        }
        if range[0].is_finite() && range[1].is_finite() {
            range
        } else {
            [0.0, 0.0]
        }
    }

    /// The point x + t·direction, put back into the box.
    pub fn along(&self, x: &[f64], direction: &[f64], t: f64) -> Vec<f64> {
        let mut moved: Vec<f64> = x.iter().zip(direction).map(|(a, d)| a + t * d).collect();
        self.confine(&mut moved);
        moved
    }

    /// The shortest difference b − a, through the wall for periodic coordinates.
    pub fn difference(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        let each = a.iter().zip(b).zip(&self.variables);
        each.map(|((a, b), variable)| {
            let span = variable.upper - variable.lower;
            if variable.periodic && span > 0.0 {
                (b - a + 0.5 * span).rem_euclid(span) - 0.5 * span
            } else {
                b - a
            }
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring_and_segment() -> SearchSpace {
        let variable = |periodic| Variable {
            lower: -1.0,
            upper: 1.0,
            periodic,
            end_bias: 0.0,
        };
        SearchSpace {
            variables: vec![variable(true), variable(false)],
            directions: Vec::new(),
            blocks: Vec::new(),
        }
    }

    #[test]
    fn periodic_coordinates_wrap_and_others_stop() {
        let space = ring_and_segment();
        let moved = space.along(&[0.9, 0.9], &[1.0, 1.0], 0.4);
        assert!((moved[0] + 0.7).abs() < 1e-12 && moved[1] == 1.0);
        let gap = space.difference(&[0.9, 0.9], &[-0.9, -0.9]);
        assert!((gap[0] - 0.2).abs() < 1e-12 && (gap[1] + 1.8).abs() < 1e-12);
    }

    #[test]
    fn ends_are_drawn_as_often_as_asked() {
        let mut space = ring_and_segment();
        space.variables[1].end_bias = 0.4;
        let mut generator = crate::sampling::stream(3, 0);
        let draws: Vec<f64> = (0..4000).map(|_| space.random(&mut generator)[1]).collect();
        let share = |end: f64| draws.iter().filter(|x| **x == end).count() as f64 / 4000.0;
        assert!((share(-1.0) - 0.2).abs() < 0.03 && (share(1.0) - 0.2).abs() < 0.03);
    }

    #[test]
    fn travel_ends_at_the_first_wall() {
        let space = ring_and_segment();
        assert_eq!(space.travel(&[0.0, 0.5], &[0.0, -1.0]), [-0.5, 1.5]);
        assert_eq!(space.travel(&[0.0, 0.5], &[0.0, 0.0]), [0.0, 0.0]);
    }
}
