//! A Pareto front over several objectives, two of them in every panel.

use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::figure_of::stem;
use super::label::Label;
use super::number::with_unit;
use super::panel::{self, BOTTOM, Panel};
use super::style::{COLUMN, DOUBLE_COLUMN, GREY, MARGIN, NORMAL, SMALL, TITLE};
use super::symbol::{Symbol, legend_height, symbol_legend};
use super::table::{Table, cell};
use super::ticks;
use plotters::style::text_anchor::HPos;

/// One of the objectives.
#[derive(Clone, Debug, PartialEq)]
pub struct TradeOffObjective {
    /// What it is, as in "ball share" or "S_F / S_0max".
    pub name: String,
    /// Unit of the values, as in "%" or "m"; may be empty.
    pub unit: String,
    /// Whether large values are good.
    pub is_larger_better: bool,
}

/// A robot of the front, or one that is named beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct TradeOffPoint {
    /// Name in the legend or the table; may be empty for points of the front.
    pub label: String,
    /// One value per objective, scored on samples that the search has not seen.
    pub values: Vec<f64>,
    /// Standard errors of the values; missing ones are 0.
    pub errors: Vec<f64>,
    /// Whether no other point beats it in all objectives when scored anew.
    pub is_on_front: bool,
}

/// A front of robots between two to five objectives.
#[derive(Clone, Debug, PartialEq)]
pub struct TradeOffFigure {
    /// The objectives; further ones than five are left out of the picture.
    pub objectives: Vec<TradeOffObjective>,
    /// The front of the search, scored anew.
    pub points: Vec<TradeOffPoint>,
    /// Robots to be told apart, as in "start" and "chosen"; each gets a symbol of its own.
    pub named: Vec<TradeOffPoint>,
    /// Other robots that were searched: one value per objective each.
    pub searched: Vec<Vec<f64>>,
    /// Title above the plots; none if empty.
    pub title: String,
}

const HEIGHT: f64 = 132.0;
/// Space right of a panel, points.
const GAP: f64 = 9.0;
/// Space for a panel's letter and arrow above it, points.
const ABOVE: f64 = 14.0;
/// Robots of the search are drawn up to this far beyond the front, in its width.
const BEYOND: f64 = 0.8;

impl TradeOffFigure {
    /// Objectives on the horizontal and vertical axis of every panel.
    fn pairs(&self) -> Vec<[usize; 2]> {
        match self.objectives.len().min(5) {
            0 | 1 => Vec::new(),
            2 => vec![[1, 0]],
            3 => vec![[1, 0], [2, 0], [2, 1]],
            count => (1..count).map(|other| [other, 0]).collect(),
        }
    }

    fn columns(&self) -> usize {
        match self.pairs().len() {
            4 => 2,
            count => count.clamp(1, 3),
        }
    }

    fn rows(&self) -> usize {
        self.pairs().len().div_ceil(self.columns()).max(1)
    }

    fn width(&self) -> f64 {
        match self.columns() {
            1 => COLUMN,
            _ => DOUBLE_COLUMN,
        }
    }

    fn legend_entries(&self) -> Vec<(Symbol, String)> {
        let mut entries = Vec::new();
        let has = |is_on_front| self.points.iter().any(|p| p.is_on_front == is_on_front);
        if has(true) {
            entries.push((Symbol::Full, "Pareto front".into()));
        }
        if has(false) {
            entries.push((Symbol::Hollow, "beaten when scored anew".into()));
        }
        if !self.searched.is_empty() {
            entries.push((Symbol::Faint, "other robots of the search".into()));
        }
        let names = self.named.iter().enumerate();
        // An underscore in a text makes an index of what follows.
        entries.extend(names.map(|(k, p)| (Symbol::Named(k), p.label.replace('_', "-"))));
        entries
    }

    fn title_height(&self) -> f64 {
        if self.title.is_empty() { 0.0 } else { 14.0 }
    }

    fn head(&self) -> f64 {
        let legend = legend_height(&self.legend_entries(), self.width() - 3.0 * MARGIN);
        self.title_height() + legend + MARGIN + ABOVE
    }

    /// The drawn range of an objective: all of the front with its errors, and what of the search
    /// is not far from it.
    fn range(&self, objective: usize) -> [f64; 2] {
        let ends = |point: &TradeOffPoint| {
            let (value, error) = point.at(objective);
            [value - error, value + error]
        };
        let front = self.points.iter().chain(&self.named).flat_map(ends);
        let searched = self.searched.iter();
        let searched = searched.filter_map(|values| values.get(objective).copied());
        let finite = |v: &f64| v.is_finite() && v.abs() < 1e150;
        if !front.clone().any(|end| finite(&end)) {
            return panel::range(searched, 0.06);
        }
        let [low, high] = panel::range(front.clone(), 0.0);
        let beyond = BEYOND * (high - low);
        let near = searched.filter(|v| (low - beyond..=high + beyond).contains(v));
        panel::range(front.chain(near), 0.06)
    }

    /// How many robots of the search have a value outside the drawn ranges.
    fn outside(&self) -> usize {
        let used = self.objectives.len().min(5);
        let ranges: Vec<[f64; 2]> = (0..used).map(|k| self.range(k)).collect();
        let is_inside = |values: &Vec<f64>| {
            let mut pairs = ranges.iter().zip(values);
            values.len() >= used && pairs.all(|([low, high], v)| low <= v && v <= high)
        };
        self.searched.iter().filter(|v| !is_inside(v)).count()
    }

    fn panel(&self, place: usize, [x, y]: [usize; 2]) -> Panel {
        let columns = self.columns();
        let step = (self.width() - MARGIN) / columns as f64;
        let y_range = self.range(y);
        let inset = panel::left(&ticks::round(y_range[0], y_range[1], 5)) + 2.0;
        let row = (place / columns) as f64;
        Panel {
            left: 2.0 + (place % columns) as f64 * step + inset,
            top: self.head() + row * (HEIGHT + BOTTOM + ABOVE),
            width: step - inset - GAP,
            height: HEIGHT,
            x: self.range(x),
            y: y_range,
        }
    }

    fn draw_panel(&self, canvas: &mut Canvas, place: usize, pair: [usize; 2]) {
        let panel = self.panel(place, pair);
        let x_ticks = ticks::round(panel.x[0], panel.x[1], 4);
        let y_ticks = ticks::round(panel.y[0], panel.y[1], 5);
        panel.grid(canvas, &y_ticks);
        panel.upright_grid(canvas, &x_ticks);
        self.draw_better(canvas, &panel, pair);
        for values in &self.searched {
            if let (Some(&x), Some(&y)) = (values.get(pair[0]), values.get(pair[1]))
                && within(panel.x, x)
                && within(panel.y, y)
            {
                Symbol::Faint.draw(canvas, panel.at(x, y));
            }
        }
        self.draw_points(canvas, &panel, pair);
        panel.axes(canvas, &x_ticks, &y_ticks, true);
        let [x, y] = pair.map(|k| &self.objectives[k]);
        panel.x_label(canvas, &with_unit(&x.name, &x.unit));
        panel.y_label(canvas, &with_unit(&y.name, &y.unit), &y_ticks);
        if self.pairs().len() > 1 {
            let letter = format!("({})", (b'a' + place as u8) as char);
            let corner = [panel.left, panel.top - 5.0];
            Label::new(&letter, NORMAL).bold().draw(canvas, corner);
        }
    }

    /// An arrow above the panel, in the direction in which both objectives get better.
    fn draw_better(&self, canvas: &mut Canvas, panel: &Panel, pair: [usize; 2]) {
        let [x, y] = pair.map(|k| self.objectives[k].is_larger_better);
        let [across, down] = [x, !y].map(|is_far| if is_far { 1.0 } else { -1.0 });
        let middle = [panel.left + panel.width - 5.0, panel.top - 7.5];
        let at = |by: Point| [middle[0] + across * by[0], middle[1] + down * by[1]];
        canvas.stroke(&[at([-3.5, -3.5]), at([3.5, 3.5])], 0.9, GREY);
        canvas.stroke(
            &[at([-0.3, 2.9]), at([3.5, 3.5]), at([2.9, -0.3])],
            0.9,
            GREY,
        );
        let text = Label::new("better", SMALL).colour(GREY).align(HPos::Right);
        text.draw(canvas, [middle[0] - 6.5, panel.top - 5.0]);
    }

    fn draw_points(&self, canvas: &mut Canvas, panel: &Panel, pair: [usize; 2]) {
        let named = self.named.iter().enumerate();
        let named = named.map(|(k, point)| (point, Symbol::Named(k)));
        let front = self.points.iter().map(|point| match point.is_on_front {
            true => (point, Symbol::Full),
            false => (point, Symbol::Hollow),
        });
        let all: Vec<(&TradeOffPoint, Symbol)> = front.chain(named).collect();
        let drawn = |p: &TradeOffPoint| {
            let [(x, dx), (y, dy)] = pair.map(|k| p.at(k));
            (within(panel.x, x) && within(panel.y, y)).then_some([[x, dx], [y, dy]])
        };
        if self.objectives.len() == 2 {
            let front = self.points.iter().filter(|p| p.is_on_front);
            let mut line: Vec<Point> = front.filter_map(drawn).map(|[x, y]| [x[0], y[0]]).collect();
            line.sort_by(|a, b| a[0].total_cmp(&b[0]));
            canvas.stroke(&panel.path(&line), 0.7, Symbol::Full.colour());
        }
        let shown: Vec<_> = all
            .iter()
            .filter_map(|(p, s)| Some((drawn(p)?, *s)))
            .collect();
        for ([[x, dx], [y, dy]], symbol) in &shown {
            let bars = [[[x - dx, *y], [x + dx, *y]], [[*x, y - dy], [*x, y + dy]]];
            for bar in bars {
                canvas.stroke(&panel.path(&bar), 0.6, symbol.colour());
            }
        }
        for ([[x, _], [y, _]], symbol) in &shown {
            symbol.draw(canvas, panel.at(*x, *y));
        }
        if shown.is_empty() && self.searched.is_empty() {
            panel.remark(canvas, "no data");
        }
    }
}

impl TradeOffPoint {
    /// Value and standard error of an objective.
    fn at(&self, objective: usize) -> (f64, f64) {
        let value = self.values.get(objective).copied().unwrap_or(f64::NAN);
        let error = self.errors.get(objective).copied().unwrap_or(0.0);
        let is_error = error.is_finite() && (0.0..1e150).contains(&error);
        (value, if is_error { error } else { 0.0 })
    }
}

/// Whether a value is in a drawn range; no number is in none.
fn within([low, high]: [f64; 2], value: f64) -> bool {
    low <= value && value <= high
}

/// Name and unit of an objective as a table's column has them.
fn column_name(objective: &TradeOffObjective) -> String {
    let unit = match objective.unit.replace('%', "percent").replace('^', "") {
        unit if unit.is_empty() => unit,
        unit => format!("_{}", stem(&unit)),
    };
    format!("{}{unit}", stem(&objective.name))
}

impl Figure for TradeOffFigure {
    fn name(&self) -> &str {
        "trade-offs"
    }

    fn caption(&self) -> String {
        let names: Vec<String> = self
            .objectives
            .iter()
            .map(|o| o.name.replace('_', ""))
            .collect();
        let names = match names.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
            _ => names.join(""),
        };
        let mut text = format!(
            "Trade-offs between {names}. Points are scored on samples that the search has not seen; \
             bars are standard errors, arrows point to better values."
        );
        if self.points.iter().any(|point| !point.is_on_front) {
            text +=
                " Hollow points were on the front of the search and are beaten when scored anew.";
        }
        match self.outside() {
            0 => text,
            1 => text + " 1 robot of the search lies outside the frames.",
            count => text + &format!(" {count} robots of the search lie outside the frames."),
        }
    }

    fn size(&self) -> Size {
        let rows = self.rows() as f64;
        Size {
            width: self.width(),
            height: self.head() + rows * (HEIGHT + BOTTOM) + (rows - 1.0) * ABOVE + 2.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let width = self.width();
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * width, 12.0], width - 2.0 * MARGIN);
        let corner = [2.0 * MARGIN, self.title_height() + 4.0];
        symbol_legend(canvas, corner, width - 3.0 * MARGIN, &self.legend_entries());
        for (place, pair) in self.pairs().into_iter().enumerate() {
            self.draw_panel(canvas, place, pair);
        }
        if self.pairs().is_empty() {
            let at = [2.0 * MARGIN, self.head() + 0.5 * HEIGHT];
            let text = "fewer than two objectives";
            Label::new(text, SMALL).draw(canvas, at);
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&["kind", "label"]);
        for objective in &self.objectives {
            let name = column_name(objective);
            table.header.extend([name.clone(), format!("{name}_error")]);
        }
        let mut add = |kind: &str, label: &str, values: &dyn Fn(usize) -> [String; 2]| {
            let mut row = vec![kind.to_owned(), label.to_owned()];
            row.extend((0..self.objectives.len()).flat_map(values));
            table.rows.push(row);
        };
        let measured = |point: &TradeOffPoint, k: usize| {
            let (value, error) = point.at(k);
            [cell(value), cell(error)]
        };
        for point in &self.points {
            let kind = if point.is_on_front { "front" } else { "beaten" };
            add(kind, &point.label, &|k| measured(point, k));
        }
        for point in &self.named {
            add("named", &point.label, &|k| measured(point, k));
        }
        for values in &self.searched {
            let value = |k: usize| values.get(k).map_or(String::new(), |v| cell(*v));
            add("searched", "", &|k| [value(k), String::new()]);
        }
        table
    }
}
