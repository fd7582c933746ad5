//! Choosing and swapping columns, which may be different ones in every lane.

use super::lane::{LANES, Lanes, Real};

/// Numbers that an elimination with pivoting computes with.
pub trait Pivot: Real {
    /// An index, or one for every lane.
    type Index: Copy;
    /// The same index in every lane.
    fn index(index: usize) -> Self::Index;
    /// The index in lane `lane`.
    fn index_in(index: Self::Index, lane: usize) -> usize;
    /// The index, from `from` on, of the entry of greatest magnitude; of equal ones the first.
    fn greatest<const N: usize>(entries: &[Self; N], from: usize) -> Self::Index;
    /// Swaps column `one` with column `other` ≥ `one`.
    fn swap_columns<const N: usize, const M: usize>(
        rows: &mut [[Self; N]; M],
        one: usize,
        other: Self::Index,
    );
    /// Swaps index `one` with index `other` ≥ `one`.
    fn swap_indices<const N: usize>(indices: &mut [Self::Index; N], one: usize, other: Self::Index);
    /// The number, with the other sign unless `index` is `same`.
    fn negated_unless(self, index: Self::Index, same: usize) -> Self;
}

impl Pivot for f64 {
    type Index = usize;
    #[inline(always)]
    fn index(index: usize) -> usize {
        index
    }
    #[inline(always)]
    fn index_in(index: usize, _: usize) -> usize {
        index
    }
    #[inline(always)]
    fn greatest<const N: usize>(entries: &[f64; N], from: usize) -> usize {
        let mut best = from;
        for j in from + 1..N {
            if entries[j].abs() > entries[best].abs() {
                best = j;
            }
        }
        best
    }
    #[inline(always)]
    fn swap_columns<const N: usize, const M: usize>(
        rows: &mut [[f64; N]; M],
        one: usize,
        other: usize,
    ) {
        if one != other {
            for row in rows {
                row.swap(one, other);
            }
        }
    }
    #[inline(always)]
    fn swap_indices<const N: usize>(indices: &mut [usize; N], one: usize, other: usize) {
        indices.swap(one, other);
    }
    #[inline(always)]
    fn negated_unless(self, index: usize, same: usize) -> f64 {
        if index == same { self } else { -self }
    }
}

/// Indices are numbers, so that comparing them gives the masks that numbers are chosen with.
impl Pivot for Lanes {
    type Index = Lanes;
    #[inline(always)]
    fn index(index: usize) -> Lanes {
        Lanes::constant(index as f64)
    }
    #[inline(always)]
    fn index_in(index: Lanes, lane: usize) -> usize {
        index.0[lane] as usize
    }
    #[inline(always)]
    fn greatest<const N: usize>(entries: &[Lanes; N], from: usize) -> Lanes {
        let mut best = Lanes::index(from);
        let mut size = entries[from].abs();
        for (j, entry) in entries.iter().enumerate().skip(from + 1) {
            Lanes::keep_loop();
            let next = entry.abs();
            for lane in 0..LANES {
                let more = next.0[lane] > size.0[lane];
                best.0[lane] = if more { j as f64 } else { best.0[lane] };
                size.0[lane] = if more { next.0[lane] } else { size.0[lane] };
            }
        }
        best
    }
    #[inline(always)]
    fn swap_columns<const N: usize, const M: usize>(
        rows: &mut [[Lanes; N]; M],
        one: usize,
        other: Lanes,
    ) {
        for row in rows {
            Lanes::keep_loop();
            Lanes::swap_indices(row, one, other);
        }
    }
    #[inline(always)]
    fn swap_indices<const N: usize>(entries: &mut [Lanes; N], one: usize, other: Lanes) {
        let mut moved = entries[one];
        for (j, entry) in entries.iter_mut().enumerate().skip(one + 1) {
            Lanes::keep_loop();
            let (a, b) = (moved, *entry);
            for lane in 0..LANES {
                let here = other.0[lane] == j as f64;
                moved.0[lane] = if here { b.0[lane] } else { a.0[lane] };
                entry.0[lane] = if here { a.0[lane] } else { b.0[lane] };
            }
        }
        entries[one] = moved;
    }
    #[inline(always)]
    fn negated_unless(self, index: Lanes, same: usize) -> Lanes {
        let mut result = self;
        for lane in 0..LANES {
            let kept = index.0[lane] == same as f64;
            result.0[lane] = if kept { self.0[lane] } else { -self.0[lane] };
        }
        result
    }
}
