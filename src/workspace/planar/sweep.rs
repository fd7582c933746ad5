//! Once round the circle |z| = r: which cells between candidate angles belong to a set.

use super::circle::{Circle, Side};
use std::f64::consts::{PI, TAU};

/// Polar angles closer than this (radians) are one: a cell between them is not tested.
const THIN_CELL: f64 = 1e-11;

/// One end of an arc: where a circle, named by its index in the owner's table, meets |z| = r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    pub circle: u32,
    pub side: Side,
}

/// An arc from one edge counter-clockwise to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EdgeArc {
    pub start: Edge,
    pub end: Edge,
    /// Multiple of 2π that makes end − start + turns the width of the arc.
    pub turns: f64,
}

impl EdgeArc {
    /// Start and width of the arc at radius `r`, for the circles its edges name.
    pub fn at(&self, circles: &[Circle], r: f64) -> (f64, f64) {
        let angle = |edge: Edge| circles[edge.circle as usize].polar_angle(r, edge.side);
        let start = angle(self.start);
        if self.start == self.end {
            return (start, 0.0);
        }
        (
            start,
            (angle(self.end) - start + self.turns).clamp(0.0, TAU),
        )
    }
}

/// Candidate ends of arcs on one circle |z| = r, and which cells between them are inside.
#[derive(Clone, Debug, Default)]
pub(super) struct CellSweep {
    marks: Vec<(f64, Edge)>,
    inside: Vec<bool>,
}

impl CellSweep {
    pub fn clear(&mut self) {
        self.marks.clear();
    }

    /// Adds a candidate end at `angle`, which may lie outside ±π by less than a turn or two.
    pub fn mark(&mut self, angle: f64, edge: Edge) {
        self.marks.push((crate::angle::wrap(angle), edge));
    }

    /// Sorts the marks and tests the middle of every cell between them.
    pub fn classify(&mut self, is_inside: impl Fn(f64) -> bool) {
        self.marks.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        self.marks
            .dedup_by(|next, kept| next.0 - kept.0 <= THIN_CELL);
        if let [first, .., last] = self.marks.as_slice()
            && first.0 + TAU - last.0 <= THIN_CELL
        {
            self.marks.pop();
        }
        self.inside.clear();
        for k in 0..self.marks.len() {
            let next = self.marks.get(k + 1).map(|mark| mark.0);
            let end = next.unwrap_or(self.marks[0].0 + TAU);
            self.inside.push(is_inside(0.5 * (self.marks[k].0 + end)));
        }
        if self.marks.is_empty() {
            self.inside.push(is_inside(-PI));
        }
    }

    /// Whether the set is the full circle.
    pub fn is_full(&self) -> bool {
        self.inside.iter().all(|&inside| inside)
    }

    /// Appends the maximal runs of inside cells, unless the set is the full circle.
    pub fn append_arcs(&self, circles: &[Circle], r: f64, out: &mut Vec<EdgeArc>) {
        let n = self.marks.len();
        for k in 0..n {
            if self.inside[k] && !self.inside[(k + n - 1) % n] {
                let run = (0..n).take_while(|j| self.inside[(k + j) % n]).count();
                out.push(self.arc_between(k, (k + run) % n, circles, r));
            }
        }
    }

    fn arc_between(&self, start: usize, end: usize, circles: &[Circle], r: f64) -> EdgeArc {
        let (start_angle, start) = self.marks[start];
        let (end_angle, end) = self.marks[end];
        let width = crate::angle::turn(start_angle, end_angle);
        let angle = |edge: Edge| circles[edge.circle as usize].polar_angle(r, edge.side);
        let turns = ((width - (angle(end) - angle(start))) / TAU).round() * TAU;
        EdgeArc { start, end, turns }
    }
}
