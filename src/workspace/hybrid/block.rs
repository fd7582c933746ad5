//! Pre-images of a range of samples, packed into one run of bytes that needs no unpacking.
//!
//! Layout, everything little-endian and aligned to 8 bytes:
//! header | poses | arc counts (n bytes a pose) | arcs | pieces | hulls (2n steps each) | vertices (n steps each).

use super::hull::{Strand, append_hulls, hulls_of};
use super::turn16::Arc16;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// One reachable sample.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub(super) struct PoseRecord {
    /// The sample's weight.
    pub weight: f64,
    /// Number of the sample in the plan.
    pub sample: u32,
    /// Its stratum.
    pub stratum: u32,
    /// Where its arcs begin.
    pub first_arc: u32,
    /// Where its pieces begin.
    pub first_piece: u32,
    /// Number of pieces.
    pub pieces: u32,
    /// 1 if every check of completeness passed.
    pub sound: u32,
}

/// A connected polyline: a closed curve, or a part of one inside physical limits.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub(super) struct PieceRecord {
    /// Where its vertices begin.
    pub first_vertex: u32,
    /// Number of vertices.
    pub vertices: u32,
    /// Where its hulls begin.
    pub first_hull: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
struct Header {
    joints: u32,
    poses: u32,
    arcs: u32,
    pieces: u32,
    vertices: u32,
    hulls: u32,
    /// Samples of the block, reachable or not.
    samples: u32,
    unused: u32,
    /// Random starts made.
    seeds: u64,
}

/// A block being filled.
#[derive(Clone, Debug, Default)]
pub(super) struct BlockBuilder {
    joints: usize,
    poses: Vec<PoseRecord>,
    counts: Vec<u8>,
    arcs: Vec<Arc16>,
    pieces: Vec<PieceRecord>,
    hulls: Vec<u16>,
    vertices: Vec<u16>,
    pub samples: u32,
    pub seeds: u64,
}

impl BlockBuilder {
    pub fn new(joints: usize) -> BlockBuilder {
        BlockBuilder {
            joints,
            ..BlockBuilder::default()
        }
    }

    /// Appends a polyline of the pose that [`BlockBuilder::finish_pose`] will close.
    pub fn push_piece(&mut self, points: impl Iterator<Item = u16>) {
        let first_vertex = (self.vertices.len() / self.joints) as u32;
        self.vertices.extend(points);
        let vertices = (self.vertices.len() / self.joints) as u32 - first_vertex;
        self.pieces.push(PieceRecord {
            first_vertex,
            vertices,
            first_hull: (self.hulls.len() / (2 * self.joints)) as u32,
        });
        let piece = &self.vertices[first_vertex as usize * self.joints..];
        append_hulls(piece, self.joints, &mut self.hulls);
    }

    /// Closes a pose: `ranges` yields the arcs of every joint.
    pub fn finish_pose(
        &mut self,
        sample: u32,
        stratum: u32,
        weight: f64,
        sound: bool,
        ranges: impl Iterator<Item = Vec<Arc16>>,
    ) {
        let before = self.poses.last();
        let first_piece = before.map_or(0, |pose| pose.first_piece + pose.pieces);
        let first_arc = self.arcs.len() as u32;
        for mut arcs in ranges {
            // More arcs than a byte counts: unheard of, but then the widest ones stay.
            arcs.truncate(usize::from(u8::MAX));
            self.counts.push(arcs.len() as u8);
            self.arcs.extend(arcs);
        }
        self.poses.push(PoseRecord {
            weight,
            sample,
            stratum,
            first_arc,
            first_piece,
            pieces: self.pieces.len() as u32 - first_piece,
            sound: u32::from(sound),
        });
    }

    /// The packed bytes, a multiple of 8 of them.
    pub fn to_bytes(&self) -> Vec<u8> {
        let header = Header {
            joints: self.joints as u32,
            poses: self.poses.len() as u32,
            arcs: self.arcs.len() as u32,
            pieces: self.pieces.len() as u32,
            vertices: (self.vertices.len() / self.joints) as u32,
            hulls: (self.hulls.len() / (2 * self.joints)) as u32,
            samples: self.samples,
            unused: 0,
            seeds: self.seeds,
        };
        let mut bytes = Vec::new();
        let mut append = |part: &[u8]| {
            bytes.extend_from_slice(part);
            bytes.resize(bytes.len().next_multiple_of(8), 0);
        };
        append(header.as_bytes());
        append(self.poses.as_bytes());
        append(&self.counts);
        append(self.arcs.as_bytes());
        append(self.pieces.as_bytes());
        append(self.hulls.as_bytes());
        append(self.vertices.as_bytes());
        bytes
    }
}

/// A packed block, read in place.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockView<'a> {
    pub joints: usize,
    pub poses: &'a [PoseRecord],
    counts: &'a [u8],
    arcs: &'a [Arc16],
    pieces: &'a [PieceRecord],
    hulls: &'a [u16],
    vertices: &'a [u16],
    pub samples: u32,
    pub seeds: u64,
}

impl<'a> BlockView<'a> {
    /// A block without samples.
    pub fn empty() -> BlockView<'a> {
        BlockView {
            joints: 1,
            poses: &[],
            counts: &[],
            arcs: &[],
            pieces: &[],
            hulls: &[],
            vertices: &[],
            samples: 0,
            seeds: 0,
        }
    }

    /// `None` if the bytes have the wrong length for a block.
    pub fn new(bytes: &'a [u8]) -> Option<BlockView<'a>> {
        let (header, rest) = Header::ref_from_prefix(bytes).ok()?;
        let n = header.joints as usize;
        let mut rest = skip_padding(rest, size_of::<Header>())?;
        let poses = take::<PoseRecord>(&mut rest, header.poses as usize)?;
        let counts = take::<u8>(&mut rest, n.checked_mul(poses.len())?)?;
        let arcs = take::<Arc16>(&mut rest, header.arcs as usize)?;
        let pieces = take::<PieceRecord>(&mut rest, header.pieces as usize)?;
        let hulls = take::<u16>(&mut rest, (2 * n).checked_mul(header.hulls as usize)?)?;
        let vertices = take::<u16>(&mut rest, n.checked_mul(header.vertices as usize)?)?;
        let view = BlockView {
            joints: n,
            poses,
            counts,
            arcs,
            pieces,
            hulls,
            vertices,
            samples: header.samples,
            seeds: header.seeds,
        };
        (rest.is_empty() && n > 0).then_some(view)
    }

    /// Whether every index points inside.
    pub fn is_consistent(&self) -> bool {
        let vertices = self.vertices.len() / self.joints;
        let hulls = self.hulls.len() / (2 * self.joints);
        let inside = |first: u32, count: u32, end: usize| {
            (first as usize)
                .checked_add(count as usize)
                .is_some_and(|last| last <= end)
        };
        let pose_fits = |(index, pose): (usize, &PoseRecord)| {
            let counts = &self.counts[index * self.joints..][..self.joints];
            let arcs = counts.iter().map(|&count| u32::from(count)).sum();
            inside(pose.first_arc, arcs, self.arcs.len())
                && inside(pose.first_piece, pose.pieces, self.pieces.len())
                && pose.weight.is_finite()
        };
        let piece_fits = |piece: &PieceRecord| {
            let own = hulls_of(piece.vertices as usize) as u32;
            piece.vertices > 0
                && inside(piece.first_vertex, piece.vertices, vertices)
                && inside(piece.first_hull, own, hulls)
        };
        self.poses.iter().enumerate().all(pose_fits) && self.pieces.iter().all(piece_fits)
    }

    /// The arcs of every joint of pose `index`, joint 1 first.
    pub fn ranges(&self, index: usize) -> impl Iterator<Item = &'a [Arc16]> + use<'a> {
        let mut first = self.poses[index].first_arc as usize;
        let (counts, arcs) = (
            &self.counts[index * self.joints..][..self.joints],
            self.arcs,
        );
        counts.iter().map(move |&count| {
            let slice = &arcs[first..first + usize::from(count)];
            first += usize::from(count);
            slice
        })
    }

    /// The polylines of a pose: n steps for every vertex.
    pub fn pieces(&self, pose: &PoseRecord) -> impl Iterator<Item = &'a [u16]> + use<'a> {
        self.strands(pose).map(|strand| strand.vertices)
    }

    /// The polylines of a pose with their hulls.
    pub fn strands(&self, pose: &PoseRecord) -> impl Iterator<Item = Strand<'a>> + use<'a> {
        let range = pose.first_piece as usize..(pose.first_piece + pose.pieces) as usize;
        let (n, vertices, hulls) = (self.joints, self.vertices, self.hulls);
        self.pieces[range].iter().map(move |piece| Strand {
            vertices: &vertices[piece.first_vertex as usize * n..][..piece.vertices as usize * n],
            hulls: &hulls[piece.first_hull as usize * 2 * n..],
            joints: n,
        })
    }
}

fn skip_padding(bytes: &[u8], used: usize) -> Option<&[u8]> {
    bytes.get(used.next_multiple_of(8) - used..)
}

/// Splits `count` records off the front of `rest`.
fn take<'a, T>(rest: &mut &'a [u8], count: usize) -> Option<&'a [T]>
where
    T: FromBytes + Immutable + KnownLayout,
{
    let (records, tail) = <[T]>::ref_from_prefix_with_elems(rest, count).ok()?;
    *rest = skip_padding(tail, count * size_of::<T>())?;
    Some(records)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block() -> BlockBuilder {
        let mut block = BlockBuilder::new(3);
        block.push_piece([1, 2, 3, 4, 5, 6].into_iter());
        block.push_piece([7, 8, 9].into_iter());
        let arc = Arc16 { start: 1, width: 2 };
        let ranges = [vec![arc], vec![], vec![arc, Arc16::full()]];
        block.finish_pose(4, 2, 0.5, true, ranges.into_iter());
        block.samples = 9;
        block
    }

    /// Bytes with the alignment of a file's page.
    fn aligned(bytes: &[u8]) -> Vec<u64> {
        let words = bytes.chunks_exact(8).map(|c| {
            let mut word = [0; 8];
            word.copy_from_slice(c);
            u64::from_ne_bytes(word)
        });
        words.collect()
    }

    #[test]
    fn round_trip() {
        let words = aligned(&block().to_bytes());
        let view = BlockView::new(words.as_bytes()).unwrap();
        assert_eq!((view.poses.len(), view.samples), (1, 9));
        let ranges: Vec<_> = view.ranges(0).collect();
        assert_eq!(ranges[0].len(), 1);
        assert!(ranges[1].is_empty() && ranges[2][1].is_full());
        let pieces: Vec<_> = view.pieces(&view.poses[0]).collect();
        assert_eq!(pieces, [&[1, 2, 3, 4, 5, 6][..], &[7, 8, 9]]);
    }

    #[test]
    fn damaged_bytes_are_refused() {
        let bytes = block().to_bytes();
        for cut in (0..bytes.len()).step_by(8) {
            assert!(BlockView::new(aligned(&bytes[..cut]).as_bytes()).is_none());
        }
        let mut wrong = bytes.clone();
        // The pose's number of pieces.
        let at = size_of::<Header>() + 24;
        wrong[at] = 200;
        let words = aligned(&wrong);
        assert!(!BlockView::new(words.as_bytes()).unwrap().is_consistent());
    }
}
