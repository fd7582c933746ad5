//! The outline of a position task's workspace, as few smooth polygons.
//!
//! The workspace is known ring by ring, and finer where its shape changes. Where an arc of one ring continues as exactly one arc of
//! the next, both belong to one strand; a strand's sides run through the ends of its arcs at the
//! rings' middle radii. Where arcs split, merge, appear or end, strands begin and end on the
//! circle between the two rings.

use super::canvas::Point;
use super::polar::spiral;
use super::slices::{Slice, meet, slices};
use crate::angle::Arc;
use crate::workspace::RingMap;
use std::f64::consts::TAU;

/// Arcs that follow each other outwards without changing neighbours.
struct Strand {
    inner: f64,
    outer: f64,
    /// Radius, first and last angle, unwrapped along the strand.
    rows: Vec<[f64; 3]>,
    last: Arc,
    /// Whether nothing precedes its inner end and nothing follows its outer end.
    is_capped: [bool; 2],
}

/// The polygons about the origin, in metres, that make up the rings.
pub(super) fn polygons(map: &RingMap) -> Vec<Vec<Point>> {
    strands(&slices(map)).iter().map(Strand::polygon).collect()
}

/// The edges of sets of angles over the radius: lines of [radius, angle], the angle unwrapped along each line.
///
/// Sides run through the ends of the arcs; where all of an arc appears or ends at once, a line
/// across closes it.
pub(super) fn edges(slices: &[Slice]) -> Vec<Vec<Point>> {
    strands(slices).iter().flat_map(Strand::edges).collect()
}

fn strands(slices: &[Slice]) -> Vec<Strand> {
    let mut done = Vec::new();
    let mut open: Vec<Strand> = Vec::new();
    let mut edge = f64::NEG_INFINITY;
    for ring in slices {
        let is_adjacent = (ring.inner - edge).abs() <= 1e-6 * ring.outer;
        if !is_adjacent {
            done.extend(open.drain(..).map(Strand::ended));
        }
        open = continued(open, ring, &mut done);
        edge = ring.outer;
    }
    done.extend(open.into_iter().map(Strand::ended));
    done
}

/// Carries the open strands over to `ring`; those that do not go on move to `done`.
fn continued(open: Vec<Strand>, ring: &Slice, done: &mut Vec<Strand>) -> Vec<Strand> {
    let arcs = ring.set.arcs();
    let touching = |strand: &Strand| -> Vec<usize> {
        let meets = |k: &usize| meet(&strand.last, &arcs[*k]);
        (0..arcs.len()).filter(meets).collect()
    };
    let partners: Vec<Vec<usize>> = open.iter().map(touching).collect();
    let claims = |k: usize| partners.iter().filter(|p| p.contains(&k)).count();
    let mut next: Vec<Strand> = Vec::new();
    let mut taken = vec![false; arcs.len()];
    for (mut strand, partners) in open.into_iter().zip(&partners) {
        match partners.as_slice() {
            &[k] if claims(k) == 1 && arcs[k].is_full() == strand.last.is_full() => {
                strand.push(ring, &arcs[k]);
                taken[k] = true;
                next.push(strand);
            }
            [] => done.push(strand.ended()),
            _ => done.push(strand),
        }
    }
    let fresh = (0..arcs.len()).filter(|k| !taken[*k]);
    next.extend(fresh.map(|k| Strand::new(ring, &arcs[k], claims(k) == 0)));
    next
}

impl Strand {
    fn new(ring: &Slice, arc: &Arc, is_capped: bool) -> Strand {
        let mut strand = Strand {
            inner: ring.inner,
            outer: ring.outer,
            rows: Vec::new(),
            last: *arc,
            is_capped: [is_capped, false],
        };
        strand.push(ring, arc);
        strand
    }

    fn push(&mut self, ring: &Slice, arc: &Arc) {
        let middle = 0.5 * (arc.start() + arc.end());
        let previous = self
            .rows
            .last()
            .map_or(middle, |row| 0.5 * (row[1] + row[2]));
        let turns = TAU * ((previous - middle) / TAU).round();
        self.rows
            .push([ring.at, arc.start() + turns, arc.end() + turns]);
        self.outer = ring.outer;
        self.last = *arc;
    }

    /// The strand whose outer end nothing follows.
    fn ended(mut self) -> Strand {
        self.is_capped[1] = true;
        self
    }

    /// Its sides and, where it is capped, its ends. A full circle has no sides.
    fn edges(&self) -> Vec<Vec<Point>> {
        let (first, last) = (self.rows[0], self.rows[self.rows.len() - 1]);
        let ends = [(self.inner, first), (self.outer, last)];
        let capped = ends.iter().zip(self.is_capped).filter(|(_, is)| *is);
        let across = capped.map(|((r, row), _)| vec![[*r, row[1]], [*r, row[2]]]);
        let side = |which: usize| {
            let rows = self.rows.iter().map(|row| [row[0], row[which]]);
            let [from, to] = ends.map(|(r, row)| [r, row[which]]);
            [from].into_iter().chain(rows).chain([to]).collect()
        };
        let sides = [1, 2].into_iter().filter(|_| !self.last.is_full());
        across.chain(sides.map(side)).collect()
    }

    /// Up the first side, along the outer circle, down the other side, along the inner circle.
    fn polygon(&self) -> Vec<Point> {
        let (first, last) = (self.rows[0], self.rows[self.rows.len() - 1]);
        let mut corners = vec![[self.inner, first[1]]];
        if !self.last.is_full() {
            corners.extend(self.rows.iter().map(|row| [row[0], row[1]]));
        }
        corners.extend([[self.outer, last[1]], [self.outer, last[2]]]);
        if !self.last.is_full() {
            corners.extend(self.rows.iter().rev().map(|row| [row[0], row[2]]));
        }
        corners.extend([[self.inner, first[2]], [self.inner, first[1]]]);
        let sides = corners.windows(2);
        sides
            .flat_map(|pair| spiral([0.0, 0.0], pair[0], pair[1]))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angle::AngleSet;
    use crate::workspace::Ring;

    fn ring(k: usize, arcs: &[[f64; 2]]) -> Ring {
        let inner = 1.0 + 0.1 * k as f64;
        let arcs = arcs.iter().map(|a| Arc::from_interval(a[0], a[1]));
        Ring {
            inner,
            outer: inner + 0.1,
            rotation_set: AngleSet::from_arcs(arcs),
        }
    }

    fn area(polygon: &[Point]) -> f64 {
        let next = polygon.iter().cycle().skip(1);
        let sum: f64 = polygon
            .iter()
            .zip(next)
            .map(|(p, q)| p[0] * q[1] - q[0] * p[1])
            .sum();
        0.5 * sum.abs()
    }

    #[test]
    fn strands_part_where_arcs_split() {
        let rings = vec![
            ring(0, &[[-1.0, 1.0]]),
            ring(1, &[[-1.1, 1.1]]),
            ring(2, &[[-1.0, -0.1], [0.1, 1.0]]),
            ring(3, &[[-0.9, -0.2], [0.2, 0.9]]),
            ring(5, &[[2.9, 3.5]]),
            ring(6, &[[3.2, 3.6]]),
        ];
        let map = RingMap {
            unrestricted: [0.0, 3.0],
            rings,
        };
        assert_eq!(polygons(&map).len(), 4);
    }

    #[test]
    fn areas_are_kept() {
        let rings: Vec<Ring> = (0..10).map(|k| ring(k, &[[3.0, 4.0]])).collect();
        let map = RingMap {
            unrestricted: [0.0, 3.0],
            rings,
        };
        let areas: Vec<f64> = polygons(&map).iter().map(|p| area(p)).collect();
        assert_eq!(areas.len(), 1);
        assert!((areas[0] - 0.5 * (4.0 - 1.0)).abs() < 1e-3);

        let full = Ring {
            inner: 1.0,
            outer: 2.0,
            rotation_set: AngleSet::full(),
        };
        let map = RingMap {
            unrestricted: [0.0, 3.0],
            rings: vec![full],
        };
        assert!((area(&polygons(&map)[0]) - 3.0 * std::f64::consts::PI).abs() < 1e-3);
    }
}
