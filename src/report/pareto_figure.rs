//! Size of a location against the best condition number on it [S1 Fig. 7d].

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::panel::{self, BOTTOM, Panel};
use super::style::{BLUE, COLUMN, GREY, MARGIN, ORANGE, TITLE, VERMILLION, translucent};
use super::table::{Table, cell};
use super::ticks::{self, Tick};
use plotters::style::RGBAColor;
use plotters::style::text_anchor::HPos;

/// One location.
#[derive(Clone, Debug, PartialEq)]
pub struct ParetoPoint {
    /// Sum of all joint ranges, radians.
    pub size: f64,
    /// Least condition number over its configurations.
    pub condition: f64,
    /// Greatest manipulability over its configurations.
    pub manipulability: f64,
    /// Greatest worst-case fault-tolerant manipulability over its configurations.
    pub fault_tolerant: f64,
    /// Where it came from, as in "random".
    pub origin: String,
    /// Whether no other location beats it in size and condition number.
    pub is_on_front: bool,
}

/// Locations and their front.
#[derive(Clone, Debug)]
pub struct ParetoFigure {
    /// The locations, those on the front in order of size.
    pub points: Vec<ParetoPoint>,
    /// Title above the plot; none if empty.
    pub title: String,
}

const HEAD: f64 = 18.0 + 2.0 * LEGEND_ROW;
const HEIGHT: f64 = 150.0;
/// Worse condition numbers are left out of the picture.
const WORST: f64 = 300.0;

fn colour(origin: &str) -> RGBAColor {
    match origin {
        "random" => translucent(GREY, 0.6),
        "singular" => translucent(BLUE, 0.6),
        _ => translucent(ORANGE, 0.9),
    }
}

impl Figure for ParetoFigure {
    fn name(&self) -> &'static str {
        "pareto"
    }

    fn caption(&self) -> String {
        format!(
            "Size of a location against the least condition number of the Jacobian over its \
             configurations. On the front (line) no location is beaten in both. Locations with \
             condition numbers above {WORST} are not shown."
        )
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: HEAD + HEIGHT + BOTTOM + 2.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * COLUMN, 12.0], COLUMN - 2.0 * MARGIN);
        let shown: Vec<&ParetoPoint> = self
            .points
            .iter()
            .filter(|p| p.condition < WORST && p.size.is_finite())
            .collect();
        let x = panel::range(shown.iter().map(|p| p.size), 0.04);
        let y = panel::range(shown.iter().map(|p| p.condition.log10()), 0.06);
        let x_ticks = ticks::round(x[0], x[1], 6);
        let y_ticks: Vec<Tick> = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0]
            .into_iter()
            .map(|value: f64| Tick {
                value: value.log10(),
                label: format!("{value}"),
            })
            .filter(|tick| (y[0]..=y[1]).contains(&tick.value))
            .collect();
        let left = panel::left(&y_ticks);
        let entries = [
            (Swatch::Dot(GREY), "random start"),
            (Swatch::Dot(BLUE), "singular configuration"),
            (Swatch::Dot(ORANGE), "refined, varied"),
            (Swatch::Line(VERMILLION), "Pareto front"),
        ];
        legend(canvas, [left, 22.0], COLUMN - left - MARGIN, 2, &entries);
        let panel = Panel {
            left,
            top: HEAD,
            width: COLUMN - left - MARGIN - 4.0,
            height: HEIGHT,
            x,
            y,
        };
        panel.grid(canvas, &y_ticks);
        let at = |p: &ParetoPoint| panel.at(p.size, p.condition.log10());
        for point in shown.iter().filter(|p| !p.is_on_front) {
            canvas.disc(at(point), 1.1, colour(&point.origin));
        }
        let front: Vec<&&ParetoPoint> = shown.iter().filter(|p| p.is_on_front).collect();
        let line: Vec<[f64; 2]> = front.iter().map(|p| at(p)).collect();
        canvas.stroke(&line, 0.9, VERMILLION);
        for point in front {
            canvas.disc(at(point), 1.1, VERMILLION);
        }
        panel.axes(canvas, &x_ticks, &y_ticks, true);
        panel.x_label(canvas, "size (rad)");
        panel.y_label(canvas, "least condition number", &y_ticks);
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&[
            "origin",
            "on_front",
            "size_rad",
            "condition",
            "manipulability",
            "fault_tolerant_manipulability",
        ]);
        for point in &self.points {
            let numbers = [
                point.size,
                point.condition,
                point.manipulability,
                point.fault_tolerant,
            ];
            let mut row = vec![point.origin.clone(), point.is_on_front.to_string()];
            row.extend(numbers.map(cell));
            table.rows.push(row);
        }
        table
    }
}
