//! One joint's limits with all their widths: when they take in an angle, and how wide they may be.

use super::turn16::{Arc16, STEP, quantise};
use crate::workspace::ArtificialLimits;

/// How limits grow with their width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Growth {
    /// The upper limit stays: [ā − w, ā].
    Lower,
    /// The lower limit stays: [a̲, a̲ + w].
    Upper,
    /// The middle stays: [m − w/2, m + w/2].
    Both,
}

/// One joint's limits with all their widths.
pub(super) struct Family {
    /// The joint, from 0.
    pub joint: usize,
    growth: Growth,
    /// The end or middle that stays, steps.
    anchor: u16,
    /// Half the distance between slices along the joint, steps. The joint is constant on a
    /// slice, so the width of entry stays linear.
    slab: f64,
    /// How far beyond its limits the joint may lock, steps.
    margin: i32,
    /// Widths in steps, ascending.
    pub widths: Vec<i32>,
}

impl Family {
    pub fn new(
        limits: &ArtificialLimits,
        joint: usize,
        growth: Growth,
        widths: &[f64],
        slab: f64,
    ) -> Family {
        let limit = limits.joints()[joint];
        let anchor = match growth {
            Growth::Lower => limit.upper,
            Growth::Upper => limit.lower,
            Growth::Both => limit.centre(),
        };
        Family {
            joint,
            growth,
            anchor: quantise(anchor),
            slab: slab / STEP,
            margin: 0,
            widths: widths
                .iter()
                .map(|width| (width / STEP).round() as i32)
                .collect(),
        }
    }

    /// The same limits of a joint that may lock up to `margin` radians beyond them.
    pub fn with_margin(self, margin: f64) -> Family {
        Family {
            margin: (margin / STEP).round() as i32,
            ..self
        }
    }

    /// Number of widths up to and with the largest at which the limits, with the margin at both
    /// ends, still lie in `range`.
    pub fn fitting(&self, range: &[Arc16]) -> usize {
        let largest = range.iter().filter_map(|arc| self.room(*arc)).max();
        largest.map_or(0, |room| {
            self.widths.partition_point(|&width| width <= room)
        })
    }

    /// The largest width at which the limits, with the margin at both ends, lie in `arc`.
    fn room(&self, arc: Arc16) -> Option<i32> {
        if arc.is_full() {
            return Some(65_536);
        }
        // Steps from the anchor to the ends of the arc that are left inside the margin. The anchor
        // lies `below + margin` behind the arc's start, and in the arc if that is within its width.
        let below = i32::from(self.anchor.wrapping_sub(arc.start)) - self.margin;
        let above = i32::from(arc.width) - below - 2 * self.margin;
        (below.min(above) >= 0).then(|| match self.growth {
            Growth::Lower => below,
            Growth::Upper => above,
            Growth::Both => 2 * below.min(above),
        })
    }

    /// The width at which a slice enters that would enter at `width` if it had no thickness.
    fn thick(&self, width: f64) -> f64 {
        let sides = if self.growth == Growth::Both {
            2.0
        } else {
            1.0
        };
        if self.slab > 0.0 {
            (width - sides * self.slab).max(0.0)
        } else {
            width
        }
    }

    /// The least and the greatest width at which an angle of an arc may enter.
    #[inline]
    pub fn span(&self, (start, width): (u16, u16)) -> [f64; 2] {
        let turn = 65_536;
        if width == u16::MAX {
            return [0.0, f64::from(turn)];
        }
        let width = i32::from(width);
        let ahead = i32::from(start.wrapping_sub(self.anchor));
        // The anchor, at which the limits have width 0, lies in the arc.
        let passes = ahead + width >= turn;
        let (near, far) = match self.growth {
            Growth::Upper => match passes {
                true => (0, turn),
                false => (ahead, ahead + width),
            },
            Growth::Lower => match passes || ahead == 0 {
                true => (0, turn),
                false => (turn - ahead - width, turn - ahead),
            },
            Growth::Both => {
                let half = turn / 2;
                let distance = |x: i32| x.min((turn - x).abs());
                let (a, b) = (distance(ahead), distance(ahead + width));
                let opposite =
                    ahead <= half && ahead + width >= half || ahead + width >= turn + half;
                (
                    if passes { 0 } else { 2 * a.min(b) },
                    if opposite { turn } else { 2 * a.max(b) },
                )
            }
        };
        let (near, far) = (f64::from(near), f64::from(far));
        // Within a slab behind the anchor a slice enters at once.
        let one_sided = self.growth != Growth::Both;
        let at_once = one_sided && far > f64::from(turn) - self.slab;
        [
            if at_once { 0.0 } else { self.thick(near) },
            self.thick(far),
        ]
    }

    /// Widths at which both ends of a whole edge enter, if it passes no kink: the usual case.
    #[inline]
    fn straight(&self, from: u16, to: u16, part: [f64; 2]) -> Option<[f64; 2]> {
        if part != [0.0, 1.0] || self.slab > 0.0 {
            return None;
        }
        let step = i32::from(to.wrapping_sub(from) as i16);
        let (x, end) = match self.growth {
            Growth::Lower => {
                let x = i32::from(self.anchor.wrapping_sub(from));
                (x, x - step)
            }
            _ => {
                let x = i32::from(from.wrapping_sub(self.anchor));
                (x, x + step)
            }
        };
        let widths = match (self.growth, x < 32_768 && end < 32_768) {
            (Growth::Both, true) => [2 * x, 2 * end],
            (Growth::Both, false) if x >= 32_768 && end >= 32_768 => {
                [2 * (65_536 - x), 2 * (65_536 - end)]
            }
            (Growth::Both, false) => return None,
            _ => [x, end],
        };
        (0..65_536).contains(&end).then(|| widths.map(f64::from))
    }

    /// Calls `take` with pieces of an edge part on which the width of entry is linear: parameters
    /// [u, v] of the edge and the widths at both.
    #[inline]
    pub fn entries(
        &self,
        from: u16,
        to: u16,
        part: [f64; 2],
        mut take: impl FnMut([f64; 2], [f64; 2]),
    ) {
        if let Some(widths) = self.straight(from, to, part) {
            take(part, widths);
            return;
        }
        let step = f64::from(to.wrapping_sub(from) as i16);
        // Distance from the anchor in the direction of growth, in [0, 65536) at the start.
        let (start, slope) = match self.growth {
            Growth::Lower => (self.anchor.wrapping_sub(from), -step),
            _ => (from.wrapping_sub(self.anchor), step),
        };
        let x = |u: f64| f64::from(start) + u * slope;
        // The entry width has kinks where x passes a multiple of a (half) turn.
        let kink = if self.growth == Growth::Both {
            32_768.0
        } else {
            65_536.0
        };
        let (mut u, end) = (part[0], part[1]);
        loop {
            let turn = (x(0.5 * (u + end.min(u + 1e-3))) / kink).floor();
            let next = if slope > 0.0 { turn + 1.0 } else { turn };
            let mut v = end;
            if slope != 0.0 {
                let crossing = (next * kink - f64::from(start)) / slope;
                if crossing > u && crossing < end {
                    v = crossing;
                }
            }
            let width = |u: f64| {
                // A kink is hit exactly: width 0 must be entered at width 0.
                let y = x(u) - turn * kink;
                let y = if (y - (y / kink).round() * kink).abs() < 1e-6 {
                    (y / kink).round() * kink
                } else {
                    y
                };
                match self.growth {
                    Growth::Both if turn.rem_euclid(2.0) == 0.0 => self.thick(2.0 * y),
                    Growth::Both => self.thick(2.0 * (kink - y)),
                    _ if self.slab > 0.0 && y > kink - self.slab => 0.0,
                    _ => self.thick(y),
                }
            };
            take([u, v], [width(u), width(v)]);
            if v >= end {
                return;
            }
            u = v;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::JointLimit;
    use rand::Rng;

    /// No edge along an arc enters before or after the widths that its span tells.
    #[test]
    fn a_span_holds_all_entries() {
        let mut rng = crate::sampling::stream(13, 0);
        for growth in [Growth::Lower, Growth::Upper, Growth::Both] {
            for k in 0..6000 {
                let slab = [0.0, 0.07, 0.4][k % 3];
                let limits = ArtificialLimits::new(vec![JointLimit::new(-0.3, 0.9)]);
                let family = Family::new(&limits, 0, growth, &[], slab);
                let width: u16 = rng.random_range(0..25_000);
                // Ends at the anchor and opposite to it are the cases that go wrong.
                let start: u16 = match k % 4 {
                    0 => family.anchor,
                    1 => family.anchor.wrapping_sub(width),
                    2 => family.anchor.wrapping_add(32_768),
                    _ => rng.random(),
                };
                let [near, far] = family.span((start, width));
                let end = start.wrapping_add(width);
                for [from, to] in [[start, end], [end, start]] {
                    family.entries(from, to, [0.0, 1.0], |_, widths| {
                        for width in widths {
                            let inside = near - 1e-6 <= width && width <= far + 1e-6;
                            assert!(inside, "{growth:?} {slab} {start} {width} {near} {far}");
                        }
                    });
                }
            }
        }
    }
}
