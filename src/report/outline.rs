//! The smooth outline of the unrestricted workspace in a plane through joint 1's axis.
//!
//! The map only knows which cells are reachable. A field that is above 0.5 in the middles of
//! reachable cells and below in the others has its level 0.5 between them; blurring the field
//! first makes that level smooth instead of stepped, never farther off than a neighbour's middle.

use super::canvas::Point;
use crate::workspace::{SpatialShareMap, interval};
use contour::ContourBuilder;

/// Blurs of the field.
const PASSES: usize = 8;
/// How far the field stays from 0.5 in the middles of cells.
const LEAST: f64 = 0.02;

/// The field in the (x, z) plane, x < 0 behind the axis.
#[derive(Clone, Debug)]
pub(super) struct Outline {
    /// Middles of columns, ascending, empty columns at both ends.
    x: Vec<f64>,
    /// Middles of rows, ascending, empty rows at both ends.
    z: Vec<f64>,
    /// Row by row of z.
    level: Vec<f64>,
}

impl Outline {
    pub(super) fn new(map: &SpatialShareMap) -> Outline {
        let (x, radii) = columns(map);
        let (z, heights): (Vec<f64>, Vec<_>) = padded(&map.height_edges).into_iter().unzip();
        let mut inside = Vec::with_capacity(x.len() * z.len());
        for iz in &heights {
            for ir in &radii {
                let is_reachable = |(ir, iz): (usize, usize)| map.unrestricted_at(ir, iz) > 0.0;
                inside.push(ir.zip(*iz).is_some_and(is_reachable));
            }
        }
        let level = field(&inside, x.len());
        Outline { x, z, level }
    }

    /// Whether (x, z) metres is within the outline.
    pub(super) fn contains(&self, x: f64, z: f64) -> bool {
        let (Some((i, s)), Some((j, t))) = (place(&self.x, x), place(&self.z, z)) else {
            return false;
        };
        let at = |i, j| self.level[j * self.x.len() + i];
        let low = at(i, j) + s * (at(i + 1, j) - at(i, j));
        let high = at(i, j + 1) + s * (at(i + 1, j + 1) - at(i, j + 1));
        low + t * (high - low) >= 0.5
    }

    /// The closed curves around the workspace and its holes, (x, z) in metres; first and last
    /// points agree.
    pub(super) fn curves(&self) -> Vec<Vec<Point>> {
        let (columns, rows) = (self.x.len(), self.z.len());
        if columns < 2 || rows < 2 {
            // The crate panics on such grids.
            return Vec::new();
        }
        let lines = ContourBuilder::new(columns, rows, true).lines(&self.level, &[0.5]);
        let line = lines.ok().and_then(|lines| lines.into_iter().next());
        let rings = line.map_or(Vec::new(), |line| line.into_inner().0.0);
        // The crate counts middles of cells from 0.5.
        let metres =
            |at: &contour::Pt| [between(&self.x, at.x - 0.5), between(&self.z, at.y - 0.5)];
        let curves = rings.into_iter();
        curves
            .map(|ring| ring.0.iter().map(metres).collect())
            .collect()
    }

    /// Radii at which a horizontal plane at height `z` crosses the outline, ascending, metres.
    pub(super) fn radii(&self, z: f64) -> Vec<f64> {
        let Some((j, t)) = place(&self.z, z) else {
            return Vec::new();
        };
        let row = |j: usize, i: usize| self.level[j * self.x.len() + i];
        let level = |i: usize| row(j, i) + t * (row(j + 1, i) - row(j, i)) - 0.5;
        let mut radii = Vec::new();
        for i in 1..self.x.len() {
            let (a, b) = (level(i - 1), level(i));
            let x = self.x[i - 1] + a / (a - b) * (self.x[i] - self.x[i - 1]);
            if (a < 0.0) != (b < 0.0) && x > 0.0 {
                radii.push(x);
            }
        }
        radii
    }
}

/// Middles of all columns left and right of the axis and the radius index of each.
fn columns(map: &SpatialShareMap) -> (Vec<f64>, Vec<Option<usize>>) {
    let right: Vec<_> = padded(&map.radius_edges)
        .into_iter()
        .filter(|(r, _)| *r > 0.0)
        .collect();
    let left = right.iter().rev().map(|(r, ir)| (-r, *ir));
    left.chain(right.iter().copied()).unzip()
}

/// The middles of cells with their indices, and empty cells of the same width beyond both ends,
/// so that the blurred field fades out.
fn padded(edges: &[f64]) -> Vec<(f64, Option<usize>)> {
    let ([first, second, ..], [.., before, last]) = (edges, edges) else {
        return Vec::new();
    };
    let beyond = |k: usize| k as f64 + 0.5;
    let low = (0..=PASSES)
        .rev()
        .map(|k| (first - beyond(k) * (second - first), None));
    let high = (0..=PASSES).map(|k| (last + beyond(k) * (last - before), None));
    let middle = |(k, pair): (usize, &[f64])| (0.5 * (pair[0] + pair[1]), Some(k));
    low.chain(edges.windows(2).enumerate().map(middle))
        .chain(high)
        .collect()
}

/// The blurred field, still above 0.5 in `inside` and below elsewhere.
fn field(inside: &[bool], columns: usize) -> Vec<f64> {
    let mut level: Vec<f64> = inside.iter().map(|is| f64::from(u8::from(*is))).collect();
    for _ in 0..PASSES {
        level = blurred(&blurred(&level, columns, 1), columns, columns);
    }
    let kept = level.iter().zip(inside);
    kept.map(|(value, is_inside)| match is_inside {
        true => value.max(0.5 + LEAST),
        false => value.min(0.5 - LEAST),
    })
    .collect()
}

/// Each value averaged with its neighbours `step` apart, weights 1 2 1; nothing lies beyond.
fn blurred(level: &[f64], columns: usize, step: usize) -> Vec<f64> {
    let value = |k: usize| {
        let (place, count) = match step {
            1 => (k % columns, columns),
            _ => (k / columns, level.len() / columns),
        };
        let before = if place > 0 { level[k - step] } else { 0.0 };
        let after = if place + 1 < count {
            level[k + step]
        } else {
            0.0
        };
        0.25 * (before + 2.0 * level[k] + after)
    };
    (0..level.len()).map(value).collect()
}

/// The interval of `middles` that holds `value` and how far along.
fn place(middles: &[f64], value: f64) -> Option<(usize, f64)> {
    let k = interval(middles, value)?;
    Some((k, (value - middles[k]) / (middles[k + 1] - middles[k])))
}

/// The value at a fractional index.
fn between(middles: &[f64], index: f64) -> f64 {
    let last = middles.len().saturating_sub(2);
    let k = (index.max(0.0) as usize).min(last);
    match (middles.get(k), middles.get(k + 1)) {
        (Some(low), Some(high)) => low + (index - k as f64) * (high - low),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(edges: [f64; 2], inside: impl Fn(f64, f64) -> bool) -> SpatialShareMap {
        let count = 40;
        let edge = |k: usize| edges[0] + (edges[1] - edges[0]) * k as f64 / count as f64;
        let mut map = SpatialShareMap {
            radius_edges: (0..=count).map(edge).collect(),
            height_edges: (0..=count).map(|k| -1.0 + 0.05 * k as f64).collect(),
            azimuths: 1,
            ..SpatialShareMap::default()
        };
        for ir in 0..count {
            for iz in 0..count {
                let is = inside(map.radius(ir), map.height(iz));
                map.unrestricted.push(f32::from(u8::from(is)));
            }
        }
        map
    }

    #[test]
    fn a_ball_is_round() {
        let outline = Outline::new(&map([0.0, 1.0], |r, z| r.hypot(z) < 0.8));
        let curves = outline.curves();
        assert_eq!(curves.len(), 1);
        assert_eq!(curves[0].first(), curves[0].last());
        for [x, z] in &curves[0] {
            // Cells are 0.025 by 0.05 large.
            assert!((x.hypot(*z) - 0.8).abs() < 0.03, "{x} {z}");
        }
        let radii = outline.radii(0.0);
        assert!(
            radii.len() == 1 && (radii[0] - 0.8).abs() < 0.02,
            "{radii:?}"
        );
        assert!(outline.contains(-0.5, 0.5) && !outline.contains(0.6, 0.6));
    }

    #[test]
    fn holes_and_halves_are_closed_curves() {
        let ring = Outline::new(&map([0.0, 1.0], |r, z| (0.4..0.8).contains(&r.hypot(z))));
        assert_eq!((ring.curves().len(), ring.radii(0.0).len()), (2, 2));
        // Away from the axis the workspace is cut in two halves; the grid's edge is an edge.
        let halves = Outline::new(&map([0.2, 1.0], |_, _| true));
        assert_eq!(halves.curves().len(), 2);
        let [inner, outer] = halves.radii(0.0)[..] else {
            panic!()
        };
        assert!((inner - 0.2).abs() < 1e-3 && (outer - 1.0).abs() < 1e-3);
    }

    #[test]
    fn single_cells_and_nothing() {
        let single = map([0.0, 1.0], |r, z| (r - 0.5125).hypot(z - 0.025) < 1e-6);
        assert_eq!(Outline::new(&single).curves().len(), 2);
        let nothing = Outline::new(&SpatialShareMap::default());
        assert!(nothing.curves().is_empty() && nothing.radii(0.0).is_empty());
        assert!(!nothing.contains(0.0, 0.0));
    }
}
