//! Which angles of joint 1 are known to be taken, in cells: what shows them once more need not be
//! looked at.
//!
//! The slices of a surface show most angles many times over.

/// Cells of the circle.
const CELLS: usize = 256;

/// Steps of a cell.
const SPAN: i32 = 65_536 / CELLS as i32;

/// Cells wholly between two unwrapped angles, steps: the first and the one after the last.
#[inline]
fn whole_cells(low: f64, high: f64) -> (i64, i64) {
    let [low, high] = [low, high].map(|angle| angle / f64::from(SPAN));
    // Casts cut towards 0.
    let (first, end) = (low as i64, high as i64);
    (
        first + i64::from((first as f64) < low),
        end - i64::from(high < end as f64),
    )
}

/// The cells that are known to be taken whole.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    words: [u64; WORDS],
}

/// Words of 64 cells.
const WORDS: usize = CELLS / 64;

impl Cells {
    /// Whether all angles of the arc are taken.
    #[inline]
    pub fn hold(&self, (start, width): (u16, u16)) -> bool {
        let first = i32::from(start) / SPAN;
        let last = (i32::from(start) + i32::from(width)) / SPAN;
        let count = (last - first + 1).min(CELLS as i32);
        let mask = mask(first as usize, count as usize);
        self.words
            .iter()
            .zip(mask)
            .all(|(own, mask)| own & mask == mask)
    }

    /// Takes the angles from `low` to `high`, steps, unwrapped.
    #[inline]
    pub fn take(&mut self, low: f64, high: f64) {
        let (first, end) = whole_cells(low, high);
        if end > first {
            let count = ((end - first) as usize).min(CELLS);
            let mask = mask(first.rem_euclid(CELLS as i64) as usize, count);
            self.words
                .iter_mut()
                .zip(mask)
                .for_each(|(own, mask)| *own |= mask);
        }
    }

    /// Whether the whole circle is taken.
    pub fn are_all_taken(&self) -> bool {
        self.words.iter().all(|word| *word == u64::MAX)
    }
}

/// `count` cells from `first` on, around the circle.
#[inline]
fn mask(first: usize, count: usize) -> [u64; WORDS] {
    // Bits below `cell`, of the word that begins with cell 64 k.
    let below = |k: usize, cell: usize| match cell.saturating_sub(64 * k) {
        64.. => u64::MAX,
        bits => (1u64 << bits) - 1,
    };
    let end = first + count;
    let rest = end.saturating_sub(CELLS);
    std::array::from_fn(|k| below(k, end) & !below(k, first) | below(k, rest))
}

/// For every cell the least grade at which it is known to be taken whole. Grades count the widths
/// of a family.
#[derive(Clone, Debug)]
pub(super) struct Cover {
    grades: [u16; CELLS],
}

impl Cover {
    /// Nothing is taken.
    pub fn new() -> Cover {
        Cover {
            grades: [u16::MAX; CELLS],
        }
    }

    /// Whether all angles of the arc are taken at `grade`.
    #[inline]
    pub fn holds(&self, (start, width): (u16, u16), grade: u16) -> bool {
        let first = i32::from(start) / SPAN;
        let end = (i32::from(start) + i32::from(width)) / SPAN + 1;
        let [own, wrapped] = self.spans(first, end);
        let taken = |cells: &[u16]| cells.iter().fold(0, |a, &b| a.max(b)) <= grade;
        taken(own) && taken(wrapped)
    }

    fn spans(&self, first: i32, end: i32) -> [&[u16]; 2] {
        let (first, end) = (first as usize, end as usize);
        match end.checked_sub(CELLS) {
            None | Some(0) => [&self.grades[first..end], &[]],
            Some(rest) => [&self.grades[first..], &self.grades[..rest.min(first)]],
        }
    }

    /// Takes the angles from `low` to `high`, steps, unwrapped, at `grade`.
    #[inline]
    pub fn take(&mut self, low: f64, high: f64, grade: u16) {
        let (first, end) = whole_cells(low, high);
        if end <= first {
            return;
        }
        let count = ((end - first) as usize).min(CELLS);
        let first = first.rem_euclid(CELLS as i64) as usize;
        let own = count.min(CELLS - first);
        let lower = |cells: &mut [u16]| {
            cells.iter_mut().for_each(|cell| *cell = (*cell).min(grade));
        };
        lower(&mut self.grades[first..first + own]);
        lower(&mut self.grades[..count - own]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;

    /// What is said to be taken has been taken, and long arcs well inside are seen.
    #[test]
    fn agrees_with_the_arcs_taken() {
        let mut rng = crate::sampling::stream(8, 0);
        for _ in 0..300 {
            let mut cover = Cover::new();
            let mut cells = Cells::default();
            let mut arcs: Vec<(f64, f64, u16)> = Vec::new();
            for _ in 0..rng.random_range(0..6) {
                let low: f64 = rng.random_range(-1.5e5..1.5e5);
                let high = low + rng.random_range(0.0..40_000.0);
                let grade = rng.random_range(0..3);
                cover.take(low, high, grade);
                if grade == 0 {
                    cells.take(low, high);
                }
                arcs.push((low, high, grade));
            }
            for _ in 0..40 {
                let (start, width) = (rng.random(), rng.random_range(0..30_000));
                let grade = rng.random_range(0..3);
                let inside = |at: f64| {
                    arcs.iter().any(|&(low, high, own)| {
                        own <= grade && low + (at - low).rem_euclid(65_536.0) <= high
                    })
                };
                let at = |k: u16| f64::from(start) + f64::from(width) * f64::from(k) / 50.0;
                assert_eq!(cells.hold((start, width)), cover.holds((start, width), 0));
                if cover.holds((start, width), grade) {
                    assert!((0..=50).all(|k| inside(at(k))));
                }
                let whole = arcs.iter().any(|&(low, high, own)| {
                    let lead = (f64::from(start) - 256.0 - low).rem_euclid(65_536.0);
                    own <= grade && lead + f64::from(width) + 512.0 <= high - low
                });
                assert!(!whole || cover.holds((start, width), grade));
            }
        }
    }
}
