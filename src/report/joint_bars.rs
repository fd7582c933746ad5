//! The ranges of all joints over all self-motion manifolds as bars, and the artificial limits
//! under them.

use super::canvas::Canvas;
use super::label::Label;
use super::manifold_figure::{SIDE, bar, limit_parts, parts};
use super::number::joint_symbol;
use super::panel::Panel;
use super::style::{BLUE, DOUBLE_COLUMN, HALF_CAPITAL, MARGIN, ORANGE, SMALL};
use super::ticks;
use crate::angle::AngleSet;
use crate::workspace::ArtificialLimits;
use plotters::style::text_anchor::HPos;

/// Height of a joint's row, points.
const ROW: f64 = 12.0;

/// Half the width of the narrowest bar, points.
const LEAST: f64 = 0.6;

/// Height of all rows, points.
pub(super) fn height(joints: usize) -> f64 {
    joints.max(1) as f64 * ROW
}

/// The axes for the bars of `joints` joints.
pub(super) fn panel(top: f64, joints: usize) -> Panel {
    Panel {
        left: SIDE,
        top,
        width: DOUBLE_COLUMN - SIDE - MARGIN - 4.0,
        height: height(joints),
        x: [-180.0, 180.0],
        y: [0.0, 1.0],
    }
}

/// Draws the bars with their axis; `over` names what the ranges are taken over.
pub(super) fn draw(
    canvas: &mut Canvas,
    panel: &Panel,
    ranges: &[AngleSet],
    over: &str,
    limits: Option<&ArtificialLimits>,
) {
    let name = match limits {
        Some(_) => format!("Joint ranges over {over} (blue) and artificial limits (orange)"),
        None => format!("Joint ranges over {over}"),
    };
    Label::new(&name, SMALL)
        .bold()
        .draw(canvas, [panel.left, panel.top - 4.5]);
    panel.upright_grid(canvas, &ticks::quarters());
    for (joint, range) in ranges.iter().enumerate() {
        let top = panel.top + joint as f64 * ROW;
        let symbol = joint_symbol(joint + 1);
        let at = [panel.left - 4.5, top + 0.5 * ROW + HALF_CAPITAL * SMALL];
        Label::new(&symbol, SMALL)
            .align(HPos::Right)
            .draw(canvas, at);
        let place = |angle: f64| panel.at(angle, 0.0)[0];
        for [low, high] in range.arcs().iter().flat_map(parts) {
            // A joint that stands still is seen all the same.
            let middle = 0.5 * (place(low) + place(high));
            let half = (0.5 * (place(high) - place(low))).max(LEAST);
            let corners = bar(middle - half, middle + half, top + 1.8, 4.6);
            canvas.fill(&corners, BLUE);
            canvas.outline(&corners, 0.4, BLUE);
        }
        for [low, high] in limit_parts(limits, joint) {
            let corners = bar(place(low), place(high), top + 7.2, 2.6);
            canvas.fill(&corners, ORANGE);
            canvas.outline(&corners, 0.4, ORANGE);
        }
    }
    panel.axes(canvas, &ticks::quarters(), &[], true);
    panel.x_label(canvas, "joint angle (deg)");
}
