//! Size of a location against the best local measures on it [S1 Fig. 7d].

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::panel::{self, BOTTOM, Panel};
use super::style::{
    BLUE, DOUBLE_COLUMN, GREY, MARGIN, NORMAL, ORANGE, TITLE, VERMILLION, translucent,
};
use super::table::{Table, cell};
use super::ticks::{self, Tick};
use plotters::style::RGBAColor;
use plotters::style::text_anchor::HPos;

/// One location.
#[derive(Clone, Debug, PartialEq)]
pub struct ParetoPoint {
    /// Sum of all joint ranges, radians.
    pub size: f64,
    /// Over its configurations the least condition number, the greatest manipulability and the
    /// greatest worst-case fault-tolerant manipulability.
    pub measures: [f64; 3],
    /// Where it came from, as in "random".
    pub origin: String,
}

/// Locations and their fronts.
#[derive(Clone, Debug)]
pub struct ParetoFigure {
    /// The locations.
    pub points: Vec<ParetoPoint>,
    /// For every measure the locations that no other beats in size and measure, in order of size.
    pub fronts: [Vec<ParetoPoint>; 3],
    /// Title above the plots; none if empty.
    pub title: String,
}

const HEAD: f64 = 22.0 + LEGEND_ROW;
const HEIGHT: f64 = 140.0;
/// Space between panels beside their tick labels, points.
const GAP: f64 = 10.0;
/// Worse condition numbers are left out of the picture.
const WORST: f64 = 300.0;
const NAMES: [&str; 3] = [
    "least condition number",
    "greatest manipulability",
    "greatest fault-tol. manipulability",
];

fn colour(origin: &str) -> RGBAColor {
    match origin {
        "random" => translucent(GREY, 0.6),
        "singular" => translucent(BLUE, 0.6),
        _ => translucent(ORANGE, 0.9),
    }
}

/// Where a measure stands on its axis: condition numbers by their logarithm.
fn height(measure: usize, value: f64) -> f64 {
    if measure == 0 { value.log10() } else { value }
}

impl ParetoFigure {
    fn draw_panel(&self, canvas: &mut Canvas, measure: usize) {
        let is_shown = |p: &&ParetoPoint| {
            let value = p.measures[measure];
            p.size.is_finite() && value.is_finite() && (measure > 0 || value < WORST)
        };
        let all = || {
            self.points
                .iter()
                .chain(&self.fronts[measure])
                .filter(is_shown)
        };
        let x = panel::range(all().map(|p| p.size), 0.04);
        let y = panel::range(all().map(|p| height(measure, p.measures[measure])), 0.06);
        let x_ticks = ticks::round(x[0], x[1], 5);
        let y_ticks: Vec<Tick> = match measure {
            0 => [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0]
                .into_iter()
                .map(|value: f64| Tick {
                    value: value.log10(),
                    label: format!("{value}"),
                })
                .filter(|tick| (y[0]..=y[1]).contains(&tick.value))
                .collect(),
            _ => ticks::round(y[0], y[1], 5),
        };
        let share = (DOUBLE_COLUMN - 2.0 * MARGIN) / 3.0;
        let inset = 36.0;
        let panel = Panel {
            left: MARGIN + measure as f64 * share + inset,
            top: HEAD,
            width: share - inset - GAP,
            height: HEIGHT,
            x,
            y,
        };
        panel.grid(canvas, &y_ticks);
        let at = |p: &ParetoPoint| panel.at(p.size, height(measure, p.measures[measure]));
        for point in self.points.iter().filter(is_shown) {
            canvas.disc(at(point), 1.0, colour(&point.origin));
        }
        let front: Vec<&ParetoPoint> = self.fronts[measure].iter().filter(is_shown).collect();
        let line: Vec<[f64; 2]> = front.iter().map(|p| at(p)).collect();
        canvas.stroke(&line, 0.9, VERMILLION);
        for point in &line {
            canvas.disc(*point, 1.1, VERMILLION);
        }
        panel.axes(canvas, &x_ticks, &y_ticks, true);
        panel.x_label(canvas, "size (rad)");
        panel.y_label(canvas, NAMES[measure], &y_ticks);
        let letter = format!("({})", (b'a' + measure as u8) as char);
        let corner = [panel.left + panel.width - 12.0, HEAD + 8.0];
        Label::new(&letter, NORMAL).bold().draw(canvas, corner);
    }
}

impl Figure for ParetoFigure {
    fn name(&self) -> &'static str {
        "pareto"
    }

    fn caption(&self) -> String {
        format!(
            "Size of a location against the best measures over its configurations: (a) condition \
             number, (b) manipulability, (c) worst-case fault-tolerant manipulability over the \
             joints that move. On the fronts (lines) no location is beaten in both. Condition \
             numbers above {WORST} are not shown."
        )
    }

    fn size(&self) -> Size {
        Size {
            width: DOUBLE_COLUMN,
            height: HEAD + HEIGHT + BOTTOM + 2.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        let middle = [0.5 * DOUBLE_COLUMN, 12.0];
        title.draw_within(canvas, middle, DOUBLE_COLUMN - 2.0 * MARGIN);
        let entries = [
            (Swatch::Dot(GREY), "random start"),
            (Swatch::Dot(BLUE), "singular configuration"),
            (Swatch::Dot(ORANGE), "refined"),
            (Swatch::Line(VERMILLION), "Pareto front"),
        ];
        legend(canvas, [MARGIN + 36.0, 23.0], 400.0, 4, &entries);
        (0..3).for_each(|measure| self.draw_panel(canvas, measure));
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&[
            "origin",
            "front",
            "size_rad",
            "condition",
            "manipulability",
            "fault_tolerant_manipulability",
        ]);
        let mut add = |front: &str, point: &ParetoPoint| {
            let mut row = vec![point.origin.clone(), front.to_owned(), cell(point.size)];
            row.extend(point.measures.map(cell));
            table.rows.push(row);
        };
        for point in &self.points {
            add("", point);
        }
        let names = ["condition", "manipulability", "fault_tolerant"];
        for (name, front) in names.into_iter().zip(&self.fronts) {
            for point in front {
                add(name, point);
            }
        }
        table
    }
}
