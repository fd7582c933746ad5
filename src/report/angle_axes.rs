//! Polar angle over radius: the axes, and the edges of exact rotation sets on them.

use super::canvas::{Canvas, Point};
use super::label::dashed;
use super::manifold::wrapped_angles;
use super::panel::{LEFT, Panel, range};
use super::rings;
use super::slices::{Slice, refined};
use super::style::{INK, VERMILLION};
use super::ticks;
use crate::angle::AngleSet;
use plotters::style::RGBAColor;

/// Colour of the edges of exact sets.
pub(super) const EDGE: RGBAColor = VERMILLION;

/// Space left of a panel for the angles and their label, points.
pub(super) const SIDE: f64 = LEFT + 4.0;

/// A panel for radii (metres) against polar angles (degrees).
pub(super) fn panel(corner: Point, size: Point, radii: impl Iterator<Item = f64>) -> Panel {
    Panel {
        left: corner[0],
        top: corner[1],
        width: size[0],
        height: size[1],
        x: range(radii, 0.0),
        y: [-180.0, 180.0],
    }
}

/// Draws the axes; `labels_left` is false where a neighbour shows the angles.
pub(super) fn draw(canvas: &mut Canvas, panel: &Panel, labels_left: bool) {
    let count = (panel.width / 26.0).clamp(2.0, 8.0) as usize;
    let x_ticks = ticks::round(panel.x[0], panel.x[1], count);
    let y_ticks = ticks::quarters();
    panel.axes(canvas, &x_ticks, &y_ticks, labels_left);
    panel.x_label(canvas, "r (m)");
    if labels_left {
        panel.y_label(canvas, "β (deg)", &y_ticks);
    }
}

/// Draws dashed lines at the radii of a gate that lie in the panel.
pub(super) fn draw_gate(canvas: &mut Canvas, panel: &Panel, gate: [f64; 2]) {
    let [low, high] = panel.x;
    for radius in gate.into_iter().filter(|r| low <= *r && *r <= high) {
        let ends = panel.y.map(|y| panel.at(radius, y));
        dashed(canvas, ends[0], ends[1], 0.8, INK);
    }
}

/// Draws the edges of sets known at some radii (metres) within the panel's range of radii.
pub(super) fn draw_edges(canvas: &mut Canvas, panel: &Panel, exact: &[(f64, AngleSet)]) {
    for line in edges(exact) {
        for pair in line.windows(2) {
            let [low, high] = panel.x;
            if let Some(part) = within(pair[0], pair[1], low, high) {
                canvas.stroke(&panel.path(&part), 1.0, EDGE);
            }
        }
    }
}

/// Whether any of the sets has an angle.
pub(super) fn is_any(exact: &[(f64, AngleSet)]) -> bool {
    exact.iter().any(|(_, set)| !set.is_empty())
}

/// Lines of radius and angle in degrees within [−180, 180].
fn edges(exact: &[(f64, AngleSet)]) -> Vec<Vec<Point>> {
    let slices = refined(slices(exact));
    let unwrapped = rings::edges(&slices);
    let lines = unwrapped.iter().flat_map(|line| {
        let line: Vec<Vec<f64>> = line.iter().map(|point| point.to_vec()).collect();
        wrapped_angles(&line, [(0, false), (1, true)])
    });
    lines.collect()
}

/// Every radius with its set, from halfway to the last one to halfway to the next one.
fn slices(exact: &[(f64, AngleSet)]) -> Vec<Slice> {
    let fine = exact.iter().filter(|(r, _)| r.is_finite() && *r >= 0.0);
    let mut rows: Vec<&(f64, AngleSet)> = fine.collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.dedup_by(|a, b| a.0 == b.0);
    let edge = |k: usize| {
        let at = |k: usize| rows[k].0;
        match k {
            _ if rows.len() < 2 => at(0) * if k == 0 { 0.98 } else { 1.02 },
            0 => (1.5 * at(0) - 0.5 * at(1)).max(0.0),
            k if k == rows.len() => 1.5 * at(k - 1) - 0.5 * at(k - 2),
            _ => 0.5 * (at(k - 1) + at(k)),
        }
    };
    let slice = |k: usize| Slice {
        inner: edge(k),
        outer: edge(k + 1),
        at: rows[k].0,
        set: rows[k].1.clone(),
    };
    (0..rows.len()).map(slice).collect()
}

/// The part of the segment from `a` to `b` whose first coordinate is in [`low`, `high`].
fn within(a: Point, b: Point, low: f64, high: f64) -> Option<[Point; 2]> {
    let at = |t: f64| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
    let run = b[0] - a[0];
    if run == 0.0 {
        return (low <= a[0] && a[0] <= high).then_some([a, b]);
    }
    let mut shares = [low, high].map(|level| ((level - a[0]) / run).clamp(0.0, 1.0));
    shares.sort_by(f64::total_cmp);
    (shares[0] < shares[1]).then(|| shares.map(at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angle::Arc;

    fn arc(low: f64, high: f64) -> AngleSet {
        AngleSet::from_arcs([Arc::from_interval(low.to_radians(), high.to_radians())])
    }

    #[test]
    fn edges_run_through_the_ends_of_the_arcs() {
        let exact: Vec<(f64, AngleSet)> = (0..5)
            .map(|k| (1.0 + 0.1 * f64::from(k), arc(-20.0, 30.0)))
            .collect();
        let lines = edges(&exact);
        // Two sides, and a line across at both ends.
        assert_eq!(lines.len(), 4);
        let angle = |p: &Point| (p[1] + 20.0).abs() < 1e-9 || (p[1] - 30.0).abs() < 1e-9;
        assert!(lines.iter().flatten().all(angle));
        let radii = range(lines.iter().flatten().map(|p| p[0]), 0.0);
        assert!((radii[0] - 0.95).abs() < 1e-9 && (radii[1] - 1.45).abs() < 1e-9);
    }

    #[test]
    fn edges_break_at_180_degrees() {
        let exact = [(1.0, arc(170.0, 178.0)), (2.0, arc(170.0, 190.0))];
        let lines = edges(&exact);
        assert!(lines.iter().flatten().all(|p| p[1].abs() <= 180.0));
        let leaps = |line: &Vec<Point>| line.windows(2).any(|p| (p[0][1] - p[1][1]).abs() > 90.0);
        assert!(!lines.iter().any(leaps));
    }

    #[test]
    fn full_circles_have_no_sides_and_nothing_has_no_edges() {
        let full = [(1.0, AngleSet::full()), (1.1, AngleSet::full())];
        assert!(
            edges(&full)
                .iter()
                .flatten()
                .all(|p| p[0] < 0.96 || p[0] > 1.14)
        );
        assert!(edges(&[]).is_empty());
        assert!(edges(&[(1.0, AngleSet::empty()), (f64::NAN, arc(0.0, 1.0))]).is_empty());
        assert!(!edges(&[(1.0, arc(0.0, 1.0))]).is_empty());
    }

    #[test]
    fn segments_are_cut_to_the_range() {
        let cut = within([0.0, 0.0], [2.0, 4.0], 0.5, 1.0);
        assert_eq!(cut, Some([[0.5, 1.0], [1.0, 2.0]]));
        assert_eq!(within([0.0, 0.0], [1.0, 1.0], 2.0, 3.0), None);
    }
}
