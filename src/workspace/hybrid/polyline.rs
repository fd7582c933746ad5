//! Shortens traced curves to polylines of bounded error.
//!
//! The polyline stays within `tolerance` of the cubic curve: curved segments are split until the
//! sagitta is an eighth of it, then vertices are dropped while every dropped one stays within the
//! rest of the chord. No edge is longer than [`LONGEST`], so that differences of wrapped
//! angles are unambiguous.

/// Share of the tolerance that splitting uses up; dropping has the rest. The smaller it is, the
/// closer chords come to the longest that the tolerance allows, and the more points are looked at:
/// an eighth leaves 38 % fewer vertices than a half, a sixteenth 4 % less again.
const SAGITTA: f64 = 0.125;

/// Longest edge, radians.
const LONGEST: f64 = 2.0;

/// Most vertices dropped in a row: bounds the work, and longer runs hardly occur.
const WINDOW: usize = 16;

/// Splits and drops vertices. `points` are the vertices of a curve with n coordinates each,
/// `tangents` its unit tangents, and `out` receives the polyline's vertices.
pub(super) struct Polyline {
    joints: usize,
    tolerance: f64,
    /// Vertices after the last kept one.
    pending: Vec<f64>,
    kept: Vec<f64>,
}

impl Polyline {
    pub fn new(joints: usize, tolerance: f64) -> Polyline {
        Polyline {
            joints,
            tolerance,
            pending: Vec::new(),
            kept: Vec::new(),
        }
    }

    /// Sub-segments for a segment of arc length `length` whose tangent turns by `turn`.
    pub fn splits(&self, length: f64, turn: f64) -> usize {
        // Sagitta of a circular arc: length · turn / 8; it falls with the square of the number.
        let sagitta = length * turn / 8.0;
        let pieces = (sagitta / (SAGITTA * self.tolerance)).sqrt().ceil();
        (pieces.max((length / LONGEST).ceil()) as usize).max(1)
    }

    /// Starts a polyline at `point`.
    pub fn begin(&mut self, point: &[f64]) {
        self.kept.clear();
        self.kept.extend_from_slice(point);
        self.pending.clear();
    }

    /// Appends a vertex.
    pub fn push(&mut self, point: &[f64]) {
        let n = self.joints;
        let full = self.pending.len() >= WINDOW * n;
        if !self.pending.is_empty() && (full || !self.skips_to(point)) {
            let last = self.pending.len() - n;
            let vertex: &[f64] = &self.pending[last..];
            self.kept.extend_from_slice(vertex);
            self.pending.clear();
        }
        self.pending.extend_from_slice(point);
    }

    /// Whether all pending vertices lie near the chord from the last kept vertex to `point`.
    fn skips_to(&self, point: &[f64]) -> bool {
        let n = self.joints;
        let from = &self.kept[self.kept.len() - n..];
        let square: f64 = from.iter().zip(point).map(|(a, b)| (b - a) * (b - a)).sum();
        if square > LONGEST * LONGEST {
            return false;
        }
        let allowed = ((1.0 - SAGITTA) * self.tolerance).powi(2);
        self.pending.chunks_exact(n).all(|vertex| {
            let (mut along, mut distance) = (0.0, 0.0);
            for k in 0..n {
                let d = vertex[k] - from[k];
                along += d * (point[k] - from[k]);
                distance += d * d;
            }
            along >= 0.0 && distance - along * along / square.max(1e-300) <= allowed
        })
    }

    /// Ends the polyline; its vertices.
    pub fn finish(&mut self) -> &[f64] {
        let n = self.joints;
        if !self.pending.is_empty() {
            let last = self.pending.len() - n;
            self.kept.extend_from_slice(&self.pending[last..]);
            self.pending.clear();
        }
        &self.kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle of radius 1 sampled finely: few vertices stay, all within the tolerance.
    #[test]
    fn drops_vertices_within_the_tolerance() {
        let tolerance = 0.02;
        let mut line = Polyline::new(2, tolerance);
        let on = |k: usize| {
            let t = k as f64 * 0.01;
            [t.cos(), t.sin()]
        };
        line.begin(&on(0));
        for k in 1..=600 {
            line.push(&on(k));
        }
        let vertices: Vec<[f64; 2]> = line.finish().chunks(2).map(|v| [v[0], v[1]]).collect();
        assert!(vertices.len() < 45, "{}", vertices.len());
        assert_eq!(vertices.last(), Some(&on(600)));
        for pair in vertices.windows(2) {
            let middle: [f64; 2] = std::array::from_fn(|k| 0.5 * (pair[0][k] + pair[1][k]));
            assert!(1.0 - middle[0].hypot(middle[1]) < tolerance);
        }
    }
}
