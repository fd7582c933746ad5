//! The angles of joint 1 over the parts of polylines inside a box, as connected runs.

use super::clip::Box16;
use super::cover::Cells;
use super::hull::{Chunk, Strand};
use super::lanes::Place;
use super::turn16::STEP;
use crate::angle::{AngleSet, Arc};
use smallvec::SmallVec;

/// Intervals of θ₁, steps, unwrapped within each connected part.
#[derive(Clone, Debug, Default)]
pub(super) struct Runs {
    pub all: SmallVec<[[f64; 2]; 4]>,
    /// Edge, parameter and unwrapped θ₁ (steps) at which the last part ended.
    ended: (usize, f64, i32),
    /// Some part goes round the whole circle.
    is_full: bool,
}

impl Runs {
    /// The parts of `piece` inside `limits`.
    pub fn of(limits: &Box16, piece: &[u16], joints: usize) -> Runs {
        let mut runs = Runs::default();
        runs.break_off();
        let edges = (piece.len() / joints).saturating_sub(1);
        runs.walk(limits, (piece, edges), 0, joints);
        runs
    }

    /// The next part does not go on from the last one.
    fn break_off(&mut self) {
        self.ended = (usize::MAX, 0.0, 0);
    }

    /// Whether a part that begins with edge `edge` goes on from the last one.
    fn goes_on(&self, edge: usize, begin: f64) -> bool {
        begin == 0.0 && self.ended.1 == 1.0 && self.ended.0.wrapping_add(1) == edge
    }

    /// Adds the parts of edges in a row, of which `first` is the number of the first.
    fn walk(&mut self, limits: &Box16, edges: (&[u16], usize), first: usize, joints: usize) {
        limits.walk_edges(edges, joints, |index, part, from, to| {
            let edge = first + index;
            let step = i32::from(to[0].wrapping_sub(from[0]) as i16);
            let continues = self.goes_on(edge, part[0]);
            let at = match continues {
                true => self.ended.2,
                false => i32::from(from[0]),
            };
            let value = |u: f64| f64::from(at) + u * f64::from(step);
            let (a, b) = (value(part[0]), value(part[1]));
            self.add(continues, [a.min(b), a.max(b)]);
            self.ended = (edge, part[1], at + step);
        });
    }

    /// Adds edges in a row that are inside as a whole.
    fn add_whole(&mut self, chunk: &Chunk) {
        let (start, width) = chunk.arc(0);
        if width == u16::MAX {
            self.is_full = true;
            return;
        }
        let n = chunk.joints();
        let (first, last) = (chunk.vertices[0], chunk.vertices[chunk.edges * n]);
        let continues = self.goes_on(chunk.edge, 0.0);
        let at = match continues {
            true => self.ended.2,
            false => i32::from(first),
        };
        let low = at - i32::from(first.wrapping_sub(start));
        self.add(continues, [low, low + i32::from(width)].map(f64::from));
        let end = low + i32::from(last.wrapping_sub(start));
        self.ended = (chunk.edge + chunk.edges.saturating_sub(1), 1.0, end);
    }

    fn add(&mut self, continues: bool, [low, high]: [f64; 2]) {
        match self.all.last_mut() {
            Some(run) if continues => *run = [run[0].min(low), run[1].max(high)],
            _ => self.all.push([low, high]),
        }
    }

    /// The union.
    pub fn set(&self) -> AngleSet {
        match self.is_full {
            true => AngleSet::full(),
            false => AngleSet::from_arcs(self.all.iter().map(arc)),
        }
    }
}

/// A run as an arc.
pub(super) fn arc(run: &[f64; 2]) -> Arc {
    Arc::from_interval(run[0] * STEP, run[1] * STEP)
}

/// The θ₁ values of all `strands` inside `limits`.
pub(super) fn image<'a>(limits: &Box16, strands: impl Iterator<Item = Strand<'a>>) -> AngleSet {
    let mut runs = Runs::default();
    let mut cells = Cells::default();
    for strand in strands {
        runs.break_off();
        for chunk in strand.chunks() {
            let place = limits.place_hull(&chunk);
            if place == Place::Outside || cells.hold(chunk.arc(0)) {
                continue;
            }
            let before = runs.all.len().saturating_sub(1);
            match place {
                Place::Inside => runs.add_whole(&chunk),
                _ => runs.walk(limits, chunk.row(), chunk.edge, strand.joints),
            }
            for &[low, high] in &runs.all[before..] {
                cells.take(low, high);
            }
            if runs.is_full || cells.are_all_taken() {
                return AngleSet::full();
            }
        }
    }
    runs.set()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::hybrid::hull::append_hulls;
    use crate::workspace::hybrid::turn16::Arc16;
    use rand::Rng;
    use rand_chacha::ChaCha8Rng;

    /// A random polyline of `joints` angles; the first joint may go round.
    fn piece(joints: usize, rng: &mut ChaCha8Rng) -> Vec<u16> {
        let reach: i32 = [60, 900, 9_000][rng.random_range(0..3)];
        let mut at: Vec<u16> = (0..joints).map(|_| rng.random()).collect();
        let drift: Vec<i32> = (0..joints)
            .map(|_| rng.random_range(-reach..=reach))
            .collect();
        let mut piece = at.clone();
        for _ in 0..rng.random_range(0..60) {
            for (value, drift) in at.iter_mut().zip(&drift) {
                *value = value.wrapping_add((drift + rng.random_range(-reach..=reach)) as u16);
            }
            piece.extend(&at);
        }
        piece
    }

    /// Hulls and cells taken before change nothing: the image is that of every single edge.
    #[test]
    fn the_image_is_that_of_all_edges() {
        let mut rng = crate::sampling::stream(11, 0);
        let mut seen = [0, 0];
        for joints in [2, 3, 5, 7, 8, 9] {
            for _ in 0..300 {
                let limits = (1..joints).map(|joint| {
                    let width = [700, 20_000, 50_000, 65_535][rng.random_range(0..4)];
                    let start = rng.random();
                    (joint, Arc16 { start, width })
                });
                let limits = Box16::new(limits.collect::<Vec<_>>());
                let pieces: Vec<Vec<u16>> = (0..12).map(|_| piece(joints, &mut rng)).collect();
                let hulls: Vec<Vec<u16>> = pieces
                    .iter()
                    .map(|piece| {
                        let mut hulls = Vec::new();
                        append_hulls(piece, joints, &mut hulls);
                        hulls
                    })
                    .collect();
                let strands = pieces.iter().zip(&hulls).map(|(vertices, hulls)| Strand {
                    vertices,
                    hulls,
                    joints,
                });
                let quick = image(&limits, strands.clone());
                let runs = pieces.iter().map(|piece| Runs::of(&limits, piece, joints));
                let slow = AngleSet::from_arcs(runs.flat_map(|runs| runs.all).map(|run| arc(&run)));
                assert_eq!(quick.arcs().len(), slow.arcs().len(), "{quick:?} {slow:?}");
                for (a, b) in quick.arcs().iter().zip(slow.arcs()) {
                    let off = (a.start() - b.start()).abs() + (a.width() - b.width()).abs();
                    assert!(off < 1e-9, "{a:?} {b:?}");
                }
                let meets = strands.clone().any(|strand| limits.meets(strand));
                assert_eq!(meets, !slow.is_empty());
                seen[usize::from(meets)] += 1;
            }
        }
        assert!(seen.iter().all(|&count| count > 50), "{seen:?}");
    }
}
