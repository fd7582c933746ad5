//! The workspace of a position task seen from above: filled rings on the unrestricted annulus.

use super::canvas::Canvas;
use super::panel::Panel;
use super::polar;
use super::rings;
use super::style::{GREY, PALE, SKY};
use super::table::{Table, cell};
use crate::workspace::RingMap;
use std::f64::consts::TAU;

/// The unrestricted annulus and on it the rings as vector polygons, on axes in metres.
pub(super) fn draw(canvas: &mut Canvas, panel: &Panel, map: &RingMap) {
    if is_annulus(map.unrestricted) {
        let annulus = polar::sector([0.0, 0.0], map.unrestricted, 0.0, TAU);
        canvas.fill(&panel.path(&annulus), PALE);
    }
    for polygon in rings::polygons(map) {
        let polygon = panel.path(&polygon);
        canvas.fill(&polygon, SKY);
        // Closes the hairline that antialiasing leaves between neighbours.
        canvas.outline(&polygon, 0.35, SKY);
    }
    draw_circles(canvas, panel, map.unrestricted);
}

/// The circles around the unrestricted workspace.
pub(super) fn draw_circles(canvas: &mut Canvas, panel: &Panel, unrestricted: [f64; 2]) {
    if is_annulus(unrestricted) {
        for radius in unrestricted.into_iter().filter(|r| *r > 0.0) {
            let circle = polar::arc([0.0, 0.0], radius, 0.0, TAU);
            canvas.stroke(&panel.path(&circle), 0.5, GREY);
        }
    }
}

fn is_annulus([inner, outer]: [f64; 2]) -> bool {
    inner.is_finite() && outer.is_finite() && 0.0 <= inner && inner < outer
}

/// One row per arc of every ring.
pub(super) fn table(map: &RingMap) -> Table {
    let mut table = Table::new(&COLUMNS);
    table.rows = rows(map).map(|row| row.to_vec()).collect();
    table
}

/// Columns of [`rows`].
pub(super) const COLUMNS: [&str; 4] = [
    "radius_inner_m",
    "radius_outer_m",
    "beta_lower_deg",
    "beta_upper_deg",
];

/// The arcs of all rings.
pub(super) fn rows(map: &RingMap) -> impl Iterator<Item = [String; 4]> {
    map.rings.iter().flat_map(|ring| {
        let arcs = ring.rotation_set.arcs().iter();
        arcs.map(|arc| {
            let ends = [arc.start(), arc.end()].map(f64::to_degrees);
            [ring.inner, ring.outer, ends[0], ends[1]].map(cell)
        })
    })
}
