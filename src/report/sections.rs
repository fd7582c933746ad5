//! Three cross-sections of a spatial workspace: the horizontal plane in which it is largest, and
//! the x–z and y–z planes through joint 1's axis.

use super::axonometry::Point3;
use super::canvas::Point;
use super::outline::Outline;
use super::polar;
use super::share_scale::{Palette, ShareScale};
use crate::workspace::SpatialShareMap;
use std::f64::consts::TAU;

/// What is at a point of the workspace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Layer {
    Outside,
    /// Reachable, but nothing is fault tolerant.
    Reachable,
    /// The share that is fault tolerant, above 0.
    Share(f64),
}

/// A map made ready for drawing.
#[derive(Debug)]
pub(super) struct Sections<'a> {
    pub map: &'a SpatialShareMap,
    pub outline: Outline,
    pub scale: ShareScale,
    /// Index of the horizontal section's cells.
    pub layer: Option<usize>,
    /// Height of the horizontal section, metres.
    pub height: f64,
    /// Half the width of the drawn range of x and y, metres.
    pub reach: f64,
    /// Drawn range of z, metres.
    pub z: [f64; 2],
}

/// A plane on which the coordinate of number `axis` is `value` metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    pub axis: usize,
    pub value: f64,
}

impl Plane {
    /// The coordinates that run to the right and up.
    pub(super) fn across(&self) -> [usize; 2] {
        [[1, 2], [0, 2], [0, 1]][self.axis.min(2)]
    }

    /// The point in space for a point of the plane.
    pub(super) fn lift(&self, [right, up]: Point) -> Point3 {
        let mut p = [self.value; 3];
        let [first, second] = self.across();
        p[first] = right;
        p[second] = up;
        p
    }
}

impl Sections<'_> {
    pub(super) fn new(map: &SpatialShareMap) -> Sections<'_> {
        let layer = map.fullest_height().or_else(|| widest_height(map));
        let (reach, z) = ranges(map);
        let shares = map.share.iter().filter(|share| share.is_finite());
        let most = shares.fold(0.0f32, |most, share| most.max(*share));
        Sections {
            map,
            outline: Outline::new(map),
            scale: ShareScale::fitting(f64::from(most), Palette::of(map)),
            layer,
            height: layer.map_or(0.5 * (z[0] + z[1]), |iz| map.height(iz)),
            reach,
            z,
        }
    }

    /// The horizontal plane, then x–z, then y–z.
    pub(super) fn planes(&self) -> [Plane; 3] {
        let plane = |axis, value| Plane { axis, value };
        [plane(2, self.height), plane(1, 0.0), plane(0, 0.0)]
    }

    /// What is at a point, metres.
    pub(super) fn layer_at(&self, p: Point3) -> Layer {
        if !self.outline.contains(p[0].hypot(p[1]), p[2]) {
            return Layer::Outside;
        }
        match self.map.sample(p) {
            Some(share) if share > 0.0 => Layer::Share(share),
            _ => Layer::Reachable,
        }
    }

    /// Closed curves around the unrestricted workspace in a plane, in the plane's coordinates.
    pub(super) fn curves(&self, plane: Plane) -> Vec<Vec<Point>> {
        if plane.axis != 2 {
            return self.outline.curves();
        }
        let radii = self.outline.radii(plane.value).into_iter();
        radii.map(|r| polar::arc([0.0, 0.0], r, 0.0, TAU)).collect()
    }

    /// Whether no cell is fault tolerant.
    pub(super) fn is_empty(&self) -> bool {
        !self.map.share.iter().any(|share| *share > 0.0)
    }
}

/// The height at which the unrestricted workspace is widest.
fn widest_height(map: &SpatialShareMap) -> Option<usize> {
    let reachable = |iz: &usize| (0..map.radii()).rfind(|ir| map.unrestricted_at(*ir, *iz) > 0.0);
    // `max_by_key` takes the last of equals.
    (0..map.heights()).rev().max_by_key(reachable)
}

/// Half the width and the range of z to be drawn: all cells with anything in them, some margin,
/// and no range so narrow that a panel would be a line. All cells if they are empty.
fn ranges(map: &SpatialShareMap) -> (f64, [f64; 2]) {
    let mut found: Option<(f64, [f64; 2])> = None;
    let is_used = |ir, iz| map.unrestricted_at(ir, iz) > 0.0 || map.mean(ir, iz) > 0.0;
    for ir in 0..map.radii() {
        for iz in (0..map.heights()).filter(|iz| is_used(ir, *iz)) {
            let edge = map.radius_edges[ir + 1];
            let [low, high] = [map.height_edges[iz], map.height_edges[iz + 1]];
            let (most, z) = found.unwrap_or((edge, [low, high]));
            found = Some((most.max(edge), [z[0].min(low), z[1].max(high)]));
        }
    }
    let whole = || {
        Some((
            *map.radius_edges.last()?,
            [*map.height_edges.first()?, *map.height_edges.last()?],
        ))
    };
    let (reach, z) = found.or_else(whole).unwrap_or((1.0, [0.0, 1.0]));
    let is_drawable = |v: f64| v.is_finite() && v.abs() < 1e150;
    if !(is_drawable(reach) && reach > 0.0 && z.iter().all(|v| is_drawable(*v)) && z[0] < z[1]) {
        return (1.0, [-1.0, 1.0]);
    }
    let height = z[1] - z[0];
    let reach = 1.05 * reach.max(0.15 * height);
    let half = (0.52 * height).max(0.25 * reach);
    let middle = 0.5 * (z[0] + z[1]);
    (reach, [middle - half, middle + half])
}
