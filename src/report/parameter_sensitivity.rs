//! What manufacturing tolerances of every link parameter and limit cost.

use super::canvas::{Canvas, Size};
use super::design_parameter::DesignParameter;
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend, rectangle};
use super::panel::{BOTTOM, Panel, range};
use super::style::{
    BLUE, COLUMN, DOUBLE_COLUMN, HALF_CAPITAL, INK, MARGIN, NORMAL, ORANGE, SMALL, TITLE,
};
use super::table::{Table, cell};
use super::ticks;
use plotters::style::RGBAColor;
use plotters::style::text_anchor::HPos;

/// Change of the score at both ends of every parameter's tolerance, the other parameters held.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParameterSensitivityFigure {
    /// What changes, as in "S_F / S_0max".
    pub score_label: String,
    /// The tolerances in words, as in "lengths ±0.5 % of the reach, angles ±0.5°".
    pub tolerance: String,
    /// Any number of parameters; the largest changes come first.
    pub parameters: Vec<ParameterSensitivity>,
    /// Title above the plots; none if empty.
    pub title: String,
}

/// The changes for one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterSensitivity {
    /// Which one.
    pub parameter: DesignParameter,
    /// Change of the score at the lower and at the upper end of the tolerance, percentage points.
    pub change: [f64; 2],
    /// Standard errors of the changes, percentage points.
    pub error: [f64; 2],
}

/// Height of a parameter's row, points.
const ROW: f64 = 9.6;
/// Height of one of its two bars, points.
const BAR: f64 = 3.4;
/// More parameters than this stand in two panels.
const ONE_PANEL: usize = 14;
/// Space between two panels and right of the last, points.
const GAP: f64 = 12.0;
const COLOURS: [RGBAColor; 2] = [BLUE, ORANGE];

impl ParameterSensitivity {
    fn size(&self) -> f64 {
        let finite = self.change.iter().filter(|change| change.is_finite());
        finite.fold(0.0, |most, change| most.max(change.abs()))
    }

    /// Ends of a bar with its whisker.
    fn ends(&self) -> [f64; 4] {
        let end = |k: usize, sign: f64| {
            let error = if self.error[k].is_finite() {
                self.error[k]
            } else {
                0.0
            };
            self.change[k] + sign * error
        };
        [end(0, -1.0), end(0, 1.0), end(1, -1.0), end(1, 1.0)]
    }
}

type Part<'p> = (&'static str, Vec<&'p ParameterSensitivity>);

impl ParameterSensitivityFigure {
    /// The panels: all in one if they are few, else links and limits or, if there is only one
    /// kind, two halves. Largest changes first.
    fn parts(&self) -> Vec<Part<'_>> {
        let mut all: Vec<&ParameterSensitivity> = self.parameters.iter().collect();
        all.sort_by(|a, b| b.size().total_cmp(&a.size()));
        if all.len() <= ONE_PANEL {
            return vec![("", all)];
        }
        let half = all.len().div_ceil(2);
        let (limits, links): (Vec<_>, Vec<_>) = all
            .iter()
            .partition(|parameter| parameter.parameter.is_limit());
        if limits.is_empty() || links.is_empty() {
            let rest = all.split_off(half);
            return vec![("", all), ("", rest)];
        }
        vec![
            ("(a) link parameters", links),
            ("(b) artificial limits", limits),
        ]
    }

    fn width(&self) -> f64 {
        match self.parameters.len() <= ONE_PANEL {
            true => COLUMN,
            false => DOUBLE_COLUMN,
        }
    }

    fn title_height(&self) -> f64 {
        if self.title.is_empty() { 0.0 } else { 13.0 }
    }

    fn head(&self) -> f64 {
        let part = if self.parts().len() > 1 { 11.0 } else { 0.0 };
        self.title_height() + MARGIN + LEGEND_ROW + part + 3.0
    }

    fn rows(&self) -> usize {
        let rows = self.parts().into_iter().map(|(_, rows)| rows.len());
        rows.max().unwrap_or(0).max(3)
    }

    /// Both panels have one range, so that their bars can be compared.
    fn range(&self) -> [f64; 2] {
        let ends = self.parameters.iter().flat_map(ParameterSensitivity::ends);
        range(ends.chain([0.0]), 0.04)
    }

    fn draw_part(&self, canvas: &mut Canvas, panel: &Panel, (name, rows): &Part) {
        let count = (panel.width / 34.0).max(2.0) as usize;
        let x_ticks = ticks::round(panel.x[0], panel.x[1], count);
        panel.upright_grid(canvas, &x_ticks);
        for (number, row) in rows.iter().enumerate() {
            self.draw_row(canvas, panel, number, row);
        }
        canvas.stroke(&panel.y.map(|y| panel.at(0.0, y)), 0.7, INK);
        panel.axes(canvas, &x_ticks, &[], false);
        let score = &self.score_label;
        panel.x_label(canvas, &format!("change of {score} (percentage points)"));
        let corner = [panel.left, panel.top - 4.0];
        Label::new(name, NORMAL).bold().draw(canvas, corner);
        if rows.is_empty() {
            panel.remark(canvas, "no data");
        }
    }

    /// Two bars, the lower end of the tolerance above, each with its error.
    fn draw_row(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        number: usize,
        row: &ParameterSensitivity,
    ) {
        let middle = panel.top + (number as f64 + 0.5) * ROW;
        let label = row.parameter.label();
        let label = Label::new(&label, SMALL).align(HPos::Right);
        label.draw(canvas, [panel.left - 3.5, middle + HALF_CAPITAL * SMALL]);
        let zero = panel.at(0.0, 0.0)[0];
        for (k, colour) in COLOURS.into_iter().enumerate() {
            if !row.change[k].is_finite() {
                continue;
            }
            let y = middle + (k as f64 - 0.5) * BAR;
            let end = panel.at(row.change[k], 0.0)[0];
            canvas.fill(&rectangle(zero, y - 0.5 * BAR, end - zero, BAR), colour);
            let [low, high] = [row.ends()[2 * k], row.ends()[2 * k + 1]];
            let whisker = [low, high].map(|value| [panel.at(value, 0.0)[0], y]);
            if high > low {
                canvas.stroke(&whisker, 0.6, INK);
                for [x, y] in whisker {
                    canvas.stroke(&[[x, y - 1.1], [x, y + 1.1]], 0.6, INK);
                }
            }
        }
    }

    /// Space that the names of the parameters need, points.
    fn names_width(&self) -> f64 {
        let labels = self.parameters.iter().map(|row| row.parameter.label());
        let widths = labels.map(|label| Label::new(&label, SMALL).width());
        widths.fold(0.0, f64::max)
    }
}

impl Figure for ParameterSensitivityFigure {
    fn name(&self) -> &str {
        "link-sensitivity"
    }

    fn caption(&self) -> String {
        format!(
            "What a parameter at the ends of its tolerance changes, the others held ({}). Limits are \
             those of joint variables θ. Lines: standard errors of the differences.",
            self.tolerance
        )
    }

    fn size(&self) -> Size {
        Size {
            width: self.width(),
            height: self.head() + self.rows() as f64 * ROW + 2.0 + BOTTOM,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let width = self.width();
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * width, 11.0], width - 2.0 * MARGIN);
        let entries = [
            (Swatch::Area(BLUE, BLUE), "at minus the tolerance"),
            (Swatch::Area(ORANGE, ORANGE), "at plus the tolerance"),
        ];
        let at = [14.0, self.title_height() + MARGIN + 3.0];
        legend(canvas, at, 220.0, 2, &entries);
        let parts = self.parts();
        let step = (width - MARGIN) / parts.len() as f64;
        // Equal for all panels, so that equal bars are equally long.
        let names = self.names_width() + 6.0;
        for (number, part) in parts.iter().enumerate() {
            let panel = Panel {
                left: MARGIN + number as f64 * step + names,
                top: self.head(),
                width: step - names - GAP,
                height: self.rows() as f64 * ROW + 2.0,
                x: self.range(),
                y: [0.0, 1.0],
            };
            self.draw_part(canvas, &panel, part);
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&[
            "parameter",
            "change_at_minus_points",
            "error_at_minus_points",
            "change_at_plus_points",
            "error_at_plus_points",
        ]);
        for row in &self.parameters {
            let numbers = [row.change[0], row.error[0], row.change[1], row.error[1]];
            let mut cells = vec![row.parameter.name()];
            cells.extend(numbers.map(cell));
            table.rows.push(cells);
        }
        table
    }
}
