//! Hulls of runs of edges: the arcs that every joint sweeps along a few edges in a row.
//!
//! A box of limits takes in or leaves out most of them whole, so that their edges need not be
//! looked at: what counts most for pre-images cut into many slices.

use super::lanes::vertex;

/// Edges behind a hull. Fewer: more hulls are looked at; more: fewer of them settle anything.
const EDGES: usize = 8;

/// Number of hulls of a polyline of `vertices` vertices.
pub(super) fn hulls_of(vertices: usize) -> usize {
    vertices.saturating_sub(1).div_ceil(EDGES).max(1)
}

/// Appends the hulls of `piece`: for each the n starts of its arcs, then their n widths, in steps;
/// a width of 65535 stands for a turn and more.
pub(super) fn append_hulls(piece: &[u16], joints: usize, out: &mut Vec<u16>) {
    for first in 0..hulls_of(piece.len() / joints) {
        let edges = edges_behind(first, piece, joints);
        let begin = out.len();
        out.resize(begin + 2 * joints, 0);
        for joint in 0..joints {
            let (start, width) = swept(edges, joints, joint);
            out[begin + joint] = start;
            out[begin + joints + joint] = width;
        }
    }
}

/// The vertices of the edges behind hull number `hull` of `piece`.
fn edges_behind(hull: usize, piece: &[u16], joints: usize) -> &[u16] {
    let first = hull * EDGES * joints;
    let end = first + (EDGES + 1) * joints;
    &piece[first..end.min(piece.len())]
}

/// Start and width of the arc that `joint` sweeps.
fn swept(edges: &[u16], joints: usize, joint: usize) -> (u16, u16) {
    let mut vertices = edges[joint..].iter().step_by(joints);
    let first = vertices.next().copied().unwrap_or_default();
    let (mut before, mut at, mut low, mut high) = (first, 0, 0, 0);
    for &value in vertices {
        at += i32::from(value.wrapping_sub(before) as i16);
        before = value;
        low = low.min(at);
        high = high.max(at);
    }
    let width = (high - low).min(i32::from(u16::MAX));
    (first.wrapping_add(low as u16), width as u16)
}

/// A polyline with its hulls.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strand<'a> {
    pub vertices: &'a [u16],
    /// Its hulls, and whatever follows them.
    pub hulls: &'a [u16],
    pub joints: usize,
}

/// Edges in a row with their hull.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chunk<'a> {
    /// Number of the first edge.
    pub edge: usize,
    /// Number of edges; 0 if the polyline has a single vertex.
    pub edges: usize,
    /// The edges' vertices and all that follow: whole steps of the processor reach beyond.
    pub vertices: &'a [u16],
    /// Starts of the arcs of the first eight joints.
    pub start: [u16; 8],
    /// Their widths.
    pub width: [u16; 8],
    hull: &'a [u16],
}

impl<'a> Strand<'a> {
    /// The polyline, a few edges at a time.
    pub fn chunks(self) -> impl Iterator<Item = Chunk<'a>> {
        let n = self.joints;
        let edges = (self.vertices.len() / n).saturating_sub(1);
        (0..hulls_of(edges + 1)).map(move |number| {
            let at = 2 * n * number;
            let edge = number * EDGES;
            Chunk {
                edge,
                edges: EDGES.min(edges - edge),
                vertices: &self.vertices[edge * n..],
                start: vertex(self.hulls, at),
                width: vertex(self.hulls, at + n),
                hull: &self.hulls[at..at + 2 * n],
            }
        })
    }
}

impl<'a> Chunk<'a> {
    /// The arc that `joint` sweeps, as its start and width.
    pub fn arc(&self, joint: usize) -> (u16, u16) {
        (self.hull[joint], self.hull[self.hull.len() / 2 + joint])
    }

    /// The vertices with the number of edges.
    pub fn row(&self) -> (&'a [u16], usize) {
        (self.vertices, self.edges)
    }

    /// Number of joints n.
    pub fn joints(&self) -> usize {
        self.hull.len() / 2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::hybrid::turn16::Arc16;
    use rand::Rng;

    /// Every edge lies in its hull, whose ends are reached; chunks make up the polyline.
    #[test]
    fn hulls_hold_their_edges() {
        let mut rng = crate::sampling::stream(12, 0);
        for vertices in (1..40).chain([100]) {
            let joints = 3;
            let mut piece: Vec<u16> = vec![5, 65_000, 30_000];
            for k in joints..vertices * joints {
                let step: i16 = rng.random_range(-900..1_500);
                piece.push(piece[k - joints].wrapping_add(step as u16));
            }
            let mut hulls = Vec::new();
            append_hulls(&piece, joints, &mut hulls);
            let strand = Strand {
                vertices: &piece,
                hulls: &hulls,
                joints,
            };
            let mut edges = 0;
            for chunk in strand.chunks() {
                assert_eq!(chunk.edge, edges);
                edges += chunk.edges;
                for joint in 0..joints {
                    let (start, width) = chunk.arc(joint);
                    assert_eq!((chunk.start[joint], chunk.width[joint]), (start, width));
                    let arc = Arc16 { start, width };
                    let own = &chunk.vertices[..(chunk.edges + 1) * joints];
                    let values = || own.iter().skip(joint).step_by(joints);
                    assert!(values().all(|&value| arc.contains(value)));
                    assert!(values().any(|&value| value == start));
                    assert!(values().any(|&value| value == start.wrapping_add(width)));
                }
            }
            assert_eq!(edges, vertices - 1);
        }
    }

    #[test]
    fn a_turn_is_full() {
        let piece: Vec<u16> = (0..9).map(|k: u16| k.wrapping_mul(9_000)).collect();
        let mut hulls = Vec::new();
        append_hulls(&piece, 1, &mut hulls);
        assert_eq!(hulls[1], u16::MAX);
    }
}
