//! A piece of a traced curve between two vertices: a cubic Hermite segment in joint space.

use crate::kinematics::dot;

/// A cubic from one vertex to the next, with unit tangents at both ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment<const N: usize> {
    pub start: [f64; N],
    pub chord: [f64; N],
    pub first: [f64; N],
    pub last: [f64; N],
    /// Arc length, radians.
    pub length: f64,
}

/// Length of a circular arc from the squares of its chord and of the difference t of its unit
/// tangents: chord · asin(t/2) / (t/2), to O(t⁶).
pub(crate) fn arc_length(chord: f64, turn: f64) -> f64 {
    chord.sqrt() * (1.0 + turn * (1.0 / 24.0 + turn * (3.0 / 640.0)))
}

impl<const N: usize> Segment<N> {
    pub fn new(start: &[f64; N], end: &[f64; N], first: &[f64; N], last: &[f64; N]) -> Segment<N> {
        let chord: [f64; N] = std::array::from_fn(|k| end[k] - start[k]);
        let turn: [f64; N] = std::array::from_fn(|k| last[k] - first[k]);
        let length = arc_length(dot(&chord, &chord), dot(&turn, &turn));
        Segment {
            start: *start,
            chord,
            first: *first,
            last: *last,
            length,
        }
    }

    /// Coordinate `k` at parameter `u` in [0, 1].
    #[inline]
    pub fn coordinate(&self, k: usize, u: f64) -> f64 {
        let (v, uu) = (1.0 - u, u * u);
        self.start[k]
            + uu * (3.0 - 2.0 * u) * self.chord[k]
            + self.length * (u * v * v * self.first[k] - uu * v * self.last[k])
    }

    /// Derivative of coordinate `k` with respect to the parameter.
    #[inline]
    pub fn slope(&self, k: usize, u: f64) -> f64 {
        let v = 1.0 - u;
        6.0 * u * v * self.chord[k]
            + self.length
                * (v * (1.0 - 3.0 * u) * self.first[k] - u * (2.0 - 3.0 * u) * self.last[k])
    }

    pub fn at(&self, u: f64) -> [f64; N] {
        std::array::from_fn(|k| self.coordinate(k, u))
    }

    /// Parameters inside (0, 1) at which coordinate `k` has an extremum, in order.
    pub fn extrema(&self, k: usize) -> [Option<f64>; 2] {
        let (f, l, c) = (
            self.length * self.first[k],
            self.length * self.last[k],
            self.chord[k],
        );
        // The slope is f + 2 b u + a u².
        let a = 3.0 * (f + l - 2.0 * c);
        let b = 3.0 * c - 2.0 * f - l;
        let inside = |u: f64| (u > 0.0 && u < 1.0).then_some(u);
        let root = b * b - a * f;
        if root <= 0.0 {
            return [None, None];
        }
        // The stable pair of roots of a quadratic.
        let q = -(b + root.sqrt().copysign(b));
        let (one, two) = (f / q, q / a);
        let mut found = [inside(one), inside(two)];
        if let [Some(x), Some(y)] = found
            && x > y
        {
            found.swap(0, 1);
        }
        found
    }

    /// Parameter in [−0.03, 1.03] and distance of the point of the segment next to `point`,
    /// which must be given near the segment (not wrapped); `None` if it falls beyond the ends.
    pub fn project(&self, point: &[f64; N]) -> Option<(f64, f64)> {
        let offset: [f64; N] = std::array::from_fn(|k| point[k] - self.start[k]);
        let mut u = dot(&offset, &self.chord) / dot(&self.chord, &self.chord).max(1e-300);
        for _ in 0..4 {
            if !(-0.5..=1.5).contains(&u) {
                return None;
            }
            let (mut along, mut speed) = (0.0, 0.0);
            for (k, coordinate) in point.iter().enumerate() {
                let slope = self.slope(k, u);
                along += (coordinate - self.coordinate(k, u)) * slope;
                speed += slope * slope;
            }
            let step = along / speed.max(1e-300);
            u += step;
            if step.abs() < 1e-6 {
                break;
            }
        }
        if !(-0.03..=1.03).contains(&u) {
            return None;
        }
        let miss: [f64; N] = std::array::from_fn(|k| point[k] - self.coordinate(k, u));
        Some((u, dot(&miss, &miss).sqrt()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An arc of a circle: the cubic follows it to fourth order.
    #[test]
    fn follows_a_circle() {
        let (a, b) = (0.3f64, 0.5f64);
        let on = |t: f64| [t.cos(), t.sin()];
        let along = |t: f64| [-t.sin(), t.cos()];
        let segment = Segment::new(&on(a), &on(b), &along(a), &along(b));
        assert!((segment.length - 0.2).abs() < 1e-6);
        let (u, miss) = segment.project(&on(0.37)).unwrap();
        assert!((u - 0.35).abs() < 1e-4 && miss < 1e-5);
        assert!(segment.project(&on(0.6)).is_none());
    }

    #[test]
    fn finds_extrema_of_a_coordinate() {
        let on = |t: f64| [t.cos(), t.sin()];
        let along = |t: f64| [-t.sin(), t.cos()];
        let segment = Segment::new(&on(-0.1), &on(0.3), &along(-0.1), &along(0.3));
        let [Some(u), None] = segment.extrema(0) else {
            panic!("one extremum of the cosine");
        };
        // A step of 0.4 is the longest; the place is off by its cube, the value by its fourth power.
        assert!((u - 0.25).abs() < 2e-3, "{u}");
        assert!((segment.coordinate(0, u) - 1.0).abs() < 0.4f64.powi(4) / 384.0);
        assert_eq!(segment.extrema(1), [None, None]);
    }
}
