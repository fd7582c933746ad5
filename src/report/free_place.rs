//! Finds a place for a short text beside its point, off everything else in the picture.

use super::canvas::Point;
use std::f64::consts::TAU;

/// Nearer than this (points) to something else, a text begins to be hard to read.
const CLEAR: f64 = 8.0;

/// Points of the sheet that texts keep clear of, and the rectangle they stay in.
pub(super) struct FreePlaces {
    occupied: Vec<Point>,
    corner: Point,
    size: Point,
}

impl FreePlaces {
    pub(super) fn new(occupied: Vec<Point>, corner: Point, size: Point) -> FreePlaces {
        FreePlaces {
            occupied,
            corner,
            size,
        }
    }

    /// The best place for the middle of a text `wide` times as wide as high, about `distance`
    /// points from `point`; it is occupied from now on.
    pub(super) fn take(&mut self, point: Point, distance: f64, wide: f64) -> Point {
        let mut best = (f64::INFINITY, point);
        for (ring, radius) in [1.0, 1.35, 1.8].into_iter().enumerate() {
            for step in 0..24 {
                let (sine, cosine) = (TAU * f64::from(step) / 24.0).sin_cos();
                let at = [
                    point[0] + (distance + 3.0 * (wide - 1.0)) * radius * cosine,
                    point[1] + distance * radius * sine,
                ];
                let cost = self.cost(at, wide) + 4.0 * ring as f64;
                if cost < best.0 {
                    best = (cost, at);
                }
            }
        }
        for k in -1..=1 {
            let shift = 3.0 * (wide - 1.0) * f64::from(k);
            self.occupied.push([best.1[0] + shift, best.1[1]]);
        }
        best.1
    }

    fn cost(&self, at: Point, wide: f64) -> f64 {
        let near = |p: &Point| {
            let distance = ((p[0] - at[0]) / wide.sqrt()).hypot(p[1] - at[1]);
            (CLEAR - distance).max(0.0).powi(2)
        };
        let beyond = |k: usize| {
            let margin = if k == 0 { 4.0 * wide } else { 5.0 };
            let [low, high] = [
                self.corner[k] + margin,
                self.corner[k] + self.size[k] - margin,
            ];
            (low - at[k]).max(at[k] - high).max(0.0)
        };
        let crowd: f64 = self.occupied.iter().map(near).sum();
        crowd + 100.0 * (beyond(0) + beyond(1))
    }
}
