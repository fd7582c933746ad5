//! A quick look at an edge: eight joints in one step of the processor.
//!
//! Most edges of a pre-image lie wholly inside a box of limits or wholly outside of one joint's.
//! Comparisons of 16-bit angles tell which without a branch per joint; only the rest is cut.

use super::turn16::Arc16;

/// Limits of up to eight joints side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lanes {
    start: [u16; 8],
    width: [u16; 8],
    /// All ones for joints that are restricted, else 0.
    active: [u16; 8],
}

/// Where an edge, or a few in a row, lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Every joint stays in its limits.
    Inside,
    /// Some joint stays outside.
    Outside,
    /// Its ends do not tell.
    Unsure,
}

impl Lanes {
    /// `None` if a restricted joint has no lane.
    pub fn new(active: &[(usize, Arc16)]) -> Option<Lanes> {
        let mut lanes = Lanes {
            start: [0; 8],
            width: [u16::MAX; 8],
            active: [0; 8],
        };
        for &(joint, arc) in active {
            *lanes.active.get_mut(joint)? = u16::MAX;
            lanes.start[joint] = arc.start;
            lanes.width[joint] = arc.width;
        }
        Some(lanes)
    }

    /// Where the edge lies whose ends have the joint angles `from` and `to`.
    #[inline(always)]
    pub fn place(&self, from: &[u16; 8], to: &[u16; 8]) -> Place {
        let mask = |is: bool| 0u16.wrapping_sub(u16::from(is));
        let (mut outside, mut unsure) = (0, 0);
        for k in 0..8 {
            let x = from[k].wrapping_sub(self.start[k]);
            let y = to[k].wrapping_sub(self.start[k]);
            let falls = mask((to[k].wrapping_sub(from[k]) as i16) < 0);
            // The edge passes the lower limit, where offsets begin anew.
            let passes = mask(y < x) ^ falls;
            let (a, b) = (mask(x > self.width[k]), mask(y > self.width[k]));
            outside |= self.active[k] & !passes & a & b;
            unsure |= self.active[k] & (passes | a | b);
        }
        match (outside, unsure) {
            (0, 0) => Place::Inside,
            (0, _) => Place::Unsure,
            _ => Place::Outside,
        }
    }
}

impl Lanes {
    /// Where edges lie whose joints sweep the arcs with the given starts and widths.
    #[inline(always)]
    pub fn place_hull(&self, start: &[u16; 8], width: &[u16; 8]) -> Place {
        let mask = |is: bool| 0u16.wrapping_sub(u16::from(is));
        let (mut outside, mut unsure) = (0, 0);
        for k in 0..8 {
            let lead = start[k].wrapping_sub(self.start[k]);
            let lag = self.start[k].wrapping_sub(start[k]);
            let begins_outside = mask(lead > self.width[k]);
            let room = self.width[k].wrapping_sub(lead);
            outside |= self.active[k] & begins_outside & mask(lag > width[k]);
            unsure |= self.active[k] & (begins_outside | mask(width[k] > room));
        }
        match (outside, unsure) {
            (0, 0) => Place::Inside,
            (0, _) => Place::Unsure,
            _ => Place::Outside,
        }
    }
}

/// Eight joint angles from `at` on; what lies beyond the vertex or the piece has no meaning.
#[inline(always)]
pub(super) fn vertex(piece: &[u16], at: usize) -> [u16; 8] {
    let rest = piece.get(at..).unwrap_or_default();
    match rest.first_chunk() {
        Some(angles) => *angles,
        None => last_vertex(rest),
    }
}

/// Apart, so that the usual case stays a single load.
#[cold]
#[inline(never)]
fn last_vertex(rest: &[u16]) -> [u16; 8] {
    std::array::from_fn(|k| rest.get(k).copied().unwrap_or_default())
}
