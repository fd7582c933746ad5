//! The parts of a polyline inside a box of joint limits.

use super::hull::{Chunk, Strand};
use super::lanes::{Lanes, Place, vertex};
use super::turn16::Arc16;
use smallvec::{SmallVec, smallvec};

/// Joints that a box restricts, with their arcs; joints with the full circle are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Box16 {
    active: SmallVec<[(usize, Arc16); 8]>,
    /// The same joints, ready for the quick test; `None` if they are too many.
    lanes: Option<Lanes>,
}

/// Parameters [from, to] of an edge that lie inside the box, in order.
pub(super) type Inside = SmallVec<[[f64; 2]; 2]>;

impl Box16 {
    /// The box of the given arcs, `(joint, arc)` with joints counted from 0.
    pub fn new(arcs: impl IntoIterator<Item = (usize, Arc16)>) -> Box16 {
        let restricts = |(_, arc): &(usize, Arc16)| !arc.is_full();
        let active: SmallVec<[(usize, Arc16); 8]> = arcs.into_iter().filter(restricts).collect();
        Box16 {
            lanes: Lanes::new(&active),
            active,
        }
    }

    /// The same without the limits of `joint`.
    pub fn without(&self, joint: usize) -> Box16 {
        Box16::new(
            self.active
                .iter()
                .copied()
                .filter(|(other, _)| *other != joint),
        )
    }

    /// Whether no joint is restricted.
    pub fn is_everything(&self) -> bool {
        self.active.is_empty()
    }

    #[inline]
    fn holds(&self, vertex: &[u16]) -> bool {
        self.active
            .iter()
            .all(|&(joint, arc)| arc.contains(vertex[joint]))
    }

    /// The part of the straight edge from `from` to `to` (each joint goes the short way) inside
    /// the box. Limits are closed: touching counts, with equal ends.
    #[inline]
    pub fn edge(&self, from: &[u16], to: &[u16]) -> Inside {
        let mut inside: Inside = smallvec![[0.0, 1.0]];
        for &(joint, arc) in &self.active {
            let x = i32::from(from[joint].wrapping_sub(arc.start));
            let step = i32::from(to[joint].wrapping_sub(from[joint]) as i16);
            let width = i32::from(arc.width);
            // The usual cases: the joint stays inside, or stays in the gap.
            let end = x + step;
            if x <= width && (0..=width).contains(&end) {
                continue;
            }
            if x > width && end > width && end < 65536 {
                return Inside::new();
            }
            intersect(&mut inside, &crossings(x, step, width));
            if inside.is_empty() {
                return inside;
            }
        }
        inside
    }

    /// Where an edge lies, as far as a look at its ends tells.
    #[inline]
    fn place(&self, from: &[u16; 8], to: &[u16; 8]) -> Place {
        self.lanes
            .as_ref()
            .map_or(Place::Unsure, |lanes| lanes.place(from, to))
    }

    /// Where the edges of a chunk lie, as far as their hull tells.
    #[inline]
    pub fn place_hull(&self, chunk: &Chunk) -> Place {
        match &self.lanes {
            Some(lanes) => lanes.place_hull(&chunk.start, &chunk.width),
            None => Place::Unsure,
        }
    }

    /// Calls `emit` with the number of every edge of `piece` that has a part inside, that part,
    /// and the edge's ends.
    #[inline]
    pub fn walk<'a>(
        &self,
        piece: &'a [u16],
        joints: usize,
        emit: impl FnMut(usize, [f64; 2], &'a [u16], &'a [u16]),
    ) {
        let edges = (piece.len() / joints).saturating_sub(1);
        self.walk_edges((piece, edges), joints, emit);
    }

    /// The same for the first `edges` edges of `piece`.
    #[inline]
    pub fn walk_edges<'a>(
        &self,
        (piece, edges): (&'a [u16], usize),
        joints: usize,
        mut emit: impl FnMut(usize, [f64; 2], &'a [u16], &'a [u16]),
    ) {
        let mut before = vertex(piece, 0);
        for index in 0..edges {
            let at = (index + 1) * joints;
            let after = vertex(piece, at);
            let place = self.place(&before, &after);
            before = after;
            if place == Place::Outside {
                continue;
            }
            let (from, to) = (&piece[at - joints..at], &piece[at..at + joints]);
            if place == Place::Inside {
                emit(index, [0.0, 1.0], from, to);
                continue;
            }
            for part in self.edge(from, to) {
                emit(index, part, from, to);
            }
        }
        // A piece of a single vertex has no edge.
        if piece.len() == joints && self.holds(piece) {
            emit(0, [0.0, 0.0], piece, piece);
        }
    }

    /// Whether any part of `strand` lies inside.
    pub fn meets(&self, strand: Strand) -> bool {
        strand.chunks().any(|chunk| match self.place_hull(&chunk) {
            Place::Inside => true,
            Place::Outside => false,
            Place::Unsure => self.meets_edges(chunk.row(), strand.joints),
        })
    }

    fn meets_edges(&self, (piece, edges): (&[u16], usize), joints: usize) -> bool {
        let mut before = vertex(piece, 0);
        let meets = |index: usize| {
            let at = (index + 1) * joints;
            let after = vertex(piece, at);
            let place = self.place(&before, &after);
            before = after;
            match place {
                Place::Inside => true,
                Place::Outside => false,
                Place::Unsure => {
                    let (from, to) = (&piece[at - joints..at], &piece[at..at + joints]);
                    !self.edge(from, to).is_empty()
                }
            }
        };
        (0..edges).any(meets) || piece.len() == joints && self.holds(piece)
    }
}

/// Where x + u · step, u in [0, 1], lies in [0, width] modulo a turn.
fn crossings(x: i32, step: i32, width: i32) -> Inside {
    let mut found = Inside::new();
    if step == 0 {
        if x <= width {
            found.push([0.0, 1.0]);
        }
        return found;
    }
    let turns = if step > 0 {
        [0, 65536, 131_072]
    } else {
        [65536, 0, -65536]
    };
    for turn in turns {
        let at = |value: i32| f64::from(value - x) / f64::from(step);
        let (low, high) = (at(turn), at(turn + width));
        let part = [low.min(high).max(0.0), low.max(high).min(1.0)];
        if part[0] <= part[1] {
            found.push(part);
        }
    }
    found
}

fn intersect(parts: &mut Inside, others: &Inside) {
    let mut common = Inside::new();
    for a in parts.iter() {
        for b in others {
            let part = [a[0].max(b[0]), a[1].min(b[1])];
            if part[0] <= part[1] {
                common.push(part);
            }
        }
    }
    *parts = common;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arc(start: u16, width: u16) -> Arc16 {
        Arc16 { start, width }
    }

    #[test]
    fn an_edge_is_cut_at_both_limits() {
        let limits = Box16::new([(0, arc(100, 50)), (1, Arc16::full())]);
        assert_eq!(limits.edge(&[0, 7], &[200, 7])[..], [[0.5, 0.75]]);
        assert_eq!(limits.edge(&[200, 7], &[0, 7])[..], [[0.25, 0.5]]);
        assert!(limits.edge(&[0, 7], &[90, 7]).is_empty());
        assert_eq!(limits.edge(&[110, 7], &[130, 7])[..], [[0.0, 1.0]]);
    }

    /// Through the gap of a nearly full circle: inside, outside, inside again.
    #[test]
    fn an_edge_may_cross_a_narrow_gap() {
        let limits = Box16::new([(0, arc(10, 65_515))]);
        let parts = limits.edge(&[65_500, 0], &[40, 0]);
        assert_eq!(parts.len(), 2);
        assert_eq!((parts[0][0], parts[1][1]), (0.0, 1.0));
        assert!(parts[0][1] < parts[1][0]);
    }

    #[test]
    fn limits_of_width_zero_are_hit_in_a_point() {
        let limits = Box16::new([(0, arc(50, 0))]);
        assert_eq!(limits.edge(&[0], &[100])[..], [[0.5, 0.5]]);
        assert_eq!(limits.edge(&[50], &[50])[..], [[0.0, 1.0]]);
    }

    /// Against sampling, for random edges and arcs.
    #[test]
    fn agrees_with_sampling() {
        use rand::Rng;
        let mut rng = crate::sampling::stream(5, 0);
        for _ in 0..2000 {
            let limit = arc(rng.random(), rng.random_range(0..65_535));
            let limits = Box16::new([(0, limit)]);
            let (from, step): (u16, i16) = (rng.random(), rng.random());
            let to = from.wrapping_add(step as u16);
            let parts = limits.edge(&[from], &[to]);
            let inside = (0..=1000).filter(|k| {
                let offset = (f64::from(step) * f64::from(*k) / 1000.0).round() as i32;
                limit.contains(from.wrapping_add(offset as u16))
            });
            let measure: f64 = parts.iter().map(|p| p[1] - p[0]).sum();
            let sampled = inside.count() as f64 / 1001.0;
            assert!((measure - sampled).abs() < 5e-3, "{measure} {sampled}");
        }
    }

    /// The quick test of eight joints at once never changes what the exact one says.
    #[test]
    fn the_quick_test_changes_nothing() {
        use rand::Rng;
        let mut rng = crate::sampling::stream(6, 0);
        for joints in [1, 3, 7, 8, 9] {
            for _ in 0..400 {
                let limits = (0..joints).map(|joint| {
                    let width = [0, 900, 40_000, 65_530, 65_535][rng.random_range(0..5)];
                    (joint, arc(rng.random(), width))
                });
                let limits = Box16::new(limits.collect::<Vec<_>>());
                let slow = Box16 {
                    lanes: None,
                    ..limits.clone()
                };
                let reach: i32 = [100, 5_000, 32_768][rng.random_range(0..3)];
                let mut at: Vec<u16> = (0..joints).map(|_| rng.random()).collect();
                let mut piece = at.clone();
                for _ in 0..rng.random_range(0..12) {
                    for value in &mut at {
                        *value = value.wrapping_add(rng.random_range(-reach..reach) as u16);
                    }
                    piece.extend(&at);
                }
                let parts = |limits: &Box16| {
                    let mut all = Vec::new();
                    limits.walk(&piece, joints, |k, part, from, to| {
                        all.push((k, part, from.to_vec(), to.to_vec()));
                    });
                    all
                };
                assert_eq!(parts(&limits), parts(&slow));
                let edges = piece.len() / joints - 1;
                assert_eq!(
                    limits.meets_edges((&piece, edges), joints),
                    !parts(&slow).is_empty()
                );
            }
        }
    }
}
