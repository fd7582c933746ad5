//! The colours of a pose task's workspace: the share of fault-tolerant orientations at a point.

use super::canvas::Canvas;
use super::share_scale::ShareScale;
use super::style::PALE;
use crate::workspace::ShareMap;
use std::f64::consts::{PI, TAU};

/// Share of the cell at (x, y) metres; none outside the map or where it is not a number.
pub(super) fn share_at(map: &ShareMap, x: f64, y: f64) -> Option<f64> {
    let r = x.hypot(y);
    let row = map
        .radius_edges
        .partition_point(|edge| *edge <= r)
        .checked_sub(1)?;
    if row + 1 >= map.radius_edges.len() || map.angles == 0 {
        return None;
    }
    let around = (y.atan2(x) + PI) / TAU * map.angles as f64;
    let cell = row * map.angles + (around as usize).min(map.angles - 1);
    map.share
        .get(cell)
        .copied()
        .filter(|share| share.is_finite())
}

/// The RGB colour at (x, y) metres: viridis where some orientation is fault tolerant, pale grey
/// elsewhere in the unrestricted workspace, white outside.
pub(super) fn colour_at(map: &ShareMap, x: f64, y: f64) -> [u8; 3] {
    let r = x.hypot(y);
    let colour = match share_at(map, x, y) {
        Some(share) if share > 0.0 => ShareScale::FULL.colour(share),
        _ if map.unrestricted[0] <= r && r <= map.unrestricted[1] => PALE,
        _ => return [255; 3],
    };
    [colour.0, colour.1, colour.2]
}

/// Draws the colour bar for shares of 0 to 100 % with its left upper corner at (x, y).
pub(super) fn colour_bar(canvas: &mut Canvas, corner: [f64; 2], height: f64) {
    let text = "fault-tolerant share of orientations (%)";
    ShareScale::FULL.draw_bar(canvas, corner, height, text);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map() -> ShareMap {
        ShareMap {
            unrestricted: [0.0, 3.0],
            radius_edges: vec![1.0, 2.0, 3.0],
            angles: 4,
            share: vec![0.0, 0.25, 0.5, 0.75, 1.0, f64::NAN],
        }
    }

    #[test]
    fn cells_are_found_by_radius_and_angle() {
        assert_eq!(share_at(&map(), -1.0, -1.0), Some(0.0));
        assert_eq!(share_at(&map(), 1.0, 1.0), Some(0.5));
        assert_eq!(share_at(&map(), -2.5, -0.1), Some(1.0));
        assert_eq!(share_at(&map(), -1.5, 0.0), Some(0.75));
        assert_eq!(share_at(&map(), 0.5, 0.0), None);
        assert_eq!(share_at(&map(), 3.0, 0.1), None);
    }

    #[test]
    fn cells_without_a_number_are_grey() {
        let pale = [PALE.0, PALE.1, PALE.2];
        assert_eq!(share_at(&map(), 0.1, -2.5), None);
        assert_eq!(colour_at(&map(), 0.1, -2.5), pale);
        assert_eq!(colour_at(&map(), 2.5, 0.1), pale);
        assert_eq!(colour_at(&map(), 3.5, 0.1), [255; 3]);
        assert_ne!(colour_at(&map(), 1.0, 1.0), pale);
    }
}
