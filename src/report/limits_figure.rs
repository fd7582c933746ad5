//! The artificial limits as dials, one per joint.

use super::canvas::Point;
use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::Label;
use super::number::{degrees, joint_symbol};
use super::polar;
use super::style::{BLUE, COLUMN, GREY, HALF_CAPITAL, INK, MARGIN, NORMAL, PALE, SMALL, TITLE};
use super::table::{Table, cell};
use crate::workspace::{ArtificialLimits, JointLimit};
use plotters::style::text_anchor::HPos;
use std::f64::consts::{FRAC_PI_2, TAU};

/// One dial per joint, in rows of at most three.
#[derive(Clone, Debug)]
pub struct LimitsFigure<'a> {
    /// Limits to show.
    pub limits: &'a ArtificialLimits,
    /// Whether angles count from the previous link, as a planar arm's do, and not as the robot's
    /// Denavit–Hartenberg rows say.
    pub is_planar: bool,
}

/// Radii of the dial and of its coloured ring, points.
const DIAL: f64 = 21.0;
const RING: [f64; 2] = [15.0, 21.0];
/// Height of a row of dials, points.
const ROW: f64 = 88.0;

impl Figure for LimitsFigure<'_> {
    fn name(&self) -> &'static str {
        "limits"
    }

    fn caption(&self) -> String {
        let zero = match self.is_planar {
            true => "0° points along the previous link.",
            false => "Angles are the joint variables of the robot's file.",
        };
        format!("Artificial joint limits before a failure: the coloured arc is allowed. {zero}")
    }

    fn size(&self) -> Size {
        let rows = self.limits.joints().len().div_ceil(self.columns()).max(1);
        Size {
            width: COLUMN,
            height: rows as f64 * ROW + MARGIN,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let columns = self.columns();
        let width = (COLUMN - 2.0 * MARGIN) / columns as f64;
        for (k, limit) in self.limits.joints().iter().enumerate() {
            let left = MARGIN + (k % columns) as f64 * width;
            let top = (k / columns) as f64 * ROW + 0.5 * MARGIN;
            draw_dial(
                canvas,
                [left + 0.5 * width + 2.0, top + 45.0],
                width,
                k + 1,
                limit,
            );
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&["joint", "lower_deg", "upper_deg", "width_deg"]);
        for (k, limit) in self.limits.joints().iter().enumerate() {
            let angles = [limit.lower, limit.upper, limit.upper - limit.lower];
            let mut row = vec![(k + 1).to_string()];
            row.extend(angles.map(|angle| cell(angle.to_degrees())));
            table.rows.push(row);
        }
        table
    }
}

impl LimitsFigure<'_> {
    fn columns(&self) -> usize {
        match self.limits.joints().len() {
            4 => 2,
            joints => joints.clamp(1, 3),
        }
    }
}

fn draw_dial(canvas: &mut Canvas, centre: Point, width: f64, joint: usize, limit: &JointLimit) {
    let title = format!("joint {joint}, {}", joint_symbol(joint));
    let title = Label::new(&title, TITLE).bold().align(HPos::Center);
    title.draw_within(canvas, [centre[0], centre[1] - DIAL - 13.5], width);
    canvas.disc(centre, DIAL, PALE);
    canvas.disc(centre, RING[0], super::style::WHITE);
    let is_drawable = limit.lower.is_finite() && limit.upper.is_finite();
    if is_drawable {
        draw_allowed(canvas, centre, limit);
    }
    canvas.stroke(&circle(centre, DIAL), 0.5, GREY);
    canvas.stroke(&circle(centre, RING[0]), 0.5, GREY);
    draw_quarters(canvas, centre);
    let middle = match limit {
        _ if !is_drawable => String::new(),
        limit if limit.is_full() => "free".into(),
        limit if limit.lower == limit.upper => "held".into(),
        limit => degrees(limit.width()),
    };
    let place = [centre[0], centre[1] + HALF_CAPITAL * SMALL];
    Label::new(&middle, SMALL)
        .align(HPos::Center)
        .draw(canvas, place);
    let ends = match limit {
        limit if limit.lower == limit.upper => degrees(limit.lower),
        limit => format!("{} … {}", degrees(limit.lower), degrees(limit.upper)),
    };
    let ends = Label::new(&ends, NORMAL).align(HPos::Center);
    ends.draw_within(canvas, [centre[0], centre[1] + DIAL + 18.0], width - 3.0);
}

/// The allowed arc, with lines at its ends.
fn draw_allowed(canvas: &mut Canvas, centre: Point, limit: &JointLimit) {
    let (start, width) = (limit.lower, limit.width());
    let sector = polar::sector([0.0, 0.0], RING, start, width);
    let sector: Vec<Point> = sector.iter().map(|p| flipped(centre, *p)).collect();
    canvas.fill(&sector, BLUE);
    if !limit.is_full() {
        for angle in [start, start + width] {
            let ray = [RING[0] - 3.0, DIAL + 1.5].map(|r| on_dial(centre, r, angle));
            canvas.stroke(&ray, 1.2, BLUE);
        }
    }
}

fn draw_quarters(canvas: &mut Canvas, centre: Point) {
    let (left, right) = ((-1.0, HPos::Right), (1.0, HPos::Left));
    for (k, text) in ["0°", "90°", "180°", "−90°"].into_iter().enumerate() {
        let angle = k as f64 * FRAC_PI_2;
        let tick = [DIAL, DIAL + 2.0].map(|r| on_dial(centre, r, angle));
        canvas.stroke(&tick, 0.6, INK);
        let (across, align, base) = match k {
            0 => (right.0 * (DIAL + 3.5), right.1, HALF_CAPITAL * 5.5),
            2 => (left.0 * (DIAL + 3.5), left.1, HALF_CAPITAL * 5.5),
            1 => (0.0, HPos::Center, -DIAL - 4.0),
            _ => (0.0, HPos::Center, DIAL + 3.5 + 0.76 * 5.5),
        };
        let label = Label::new(text, 5.5).align(align).colour(GREY);
        label.draw(canvas, [centre[0] + across, centre[1] + base]);
    }
}

/// The point of the sheet at an angle counter-clockwise from the right.
fn on_dial(centre: Point, r: f64, angle: f64) -> Point {
    flipped(centre, polar::point([0.0, 0.0], r, angle))
}

fn flipped(centre: Point, p: Point) -> Point {
    [centre[0] + p[0], centre[1] - p[1]]
}

fn circle(centre: Point, r: f64) -> Vec<Point> {
    polar::arc(centre, r, 0.0, TAU)
}
