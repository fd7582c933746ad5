//! Predicted against exact sizes, a panel per surrogate.

use super::agreement;
use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, draw_swatch, legend};
use super::number::with_unit;
use super::panel::{BOTTOM, Panel, left};
use super::style::{BLUE, COLUMN, DOUBLE_COLUMN, GREY, MARGIN, ORANGE, SMALL};
use super::table::{Table, cell, column};
use super::ticks::{self, Tick};
use std::collections::BTreeSet;

/// Sizes S_F of designs as some surrogates predict them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SizeScatter {
    /// One series per surrogate and kind of designs.
    pub series: Vec<SizeSeries>,
    /// Unit of the sizes, as in "m^2".
    pub unit: String,
    /// The largest size of any design, in that unit: both axes end a little beyond it.
    pub largest: f64,
}

/// Designs of one kind as one surrogate sees them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SizeSeries {
    /// Name of the surrogate; series of the same name share a panel.
    pub label: String,
    /// Kind of the designs, as in "walk" or "uniform": tells the marker.
    pub kind: String,
    /// Exact sizes, in the figure's unit.
    pub exact: Vec<f64>,
    /// Predicted sizes, in the same order.
    pub predicted: Vec<f64>,
}

/// No more panels than these are drawn; the table has all.
const MOST: usize = 6;
/// Space above a panel for its title, points.
const TITLE_ROW: f64 = 13.0;
/// Space between panels, points.
const GAP: f64 = 18.0;
/// The axes end at this multiple of the largest size.
const BEYOND: f64 = 1.08;
/// Markers closer than this are drawn once, points.
const SAME: f64 = 0.3;
/// Swatches of the first kinds of designs; further kinds start again.
const MARKS: [Swatch; 4] = [
    Swatch::Dot(BLUE),
    Swatch::Diamond(ORANGE),
    Swatch::Cross(super::style::GREEN),
    Swatch::Dot(super::style::PURPLE),
];

impl Figure for SizeScatter {
    fn name(&self) -> &str {
        "predicted_sizes"
    }

    fn caption(&self) -> String {
        let labels = self.labels().len();
        let more = match labels > MOST {
            true => format!(" The first {MOST} of {labels} surrogates."),
            false => String::new(),
        };
        let outside: usize = self.series.iter().map(|series| self.outside(series)).sum();
        let outside = match outside {
            0 => String::new(),
            1 => " One prediction beyond the axes is drawn at their edge.".into(),
            _ => format!(" {outside} predictions beyond the axes are drawn at their edge."),
        };
        format!(
            "Predicted against exact size of the fault-tolerant workspace; on the dashed line \
             both are equal.{outside}{more}"
        )
    }

    fn size(&self) -> Size {
        let layout = self.layout();
        Size {
            width: layout.width,
            height: layout.head
                + layout.rows as f64 * (layout.side + TITLE_ROW)
                + 12.0 * (layout.rows - 1) as f64
                + BOTTOM,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let layout = self.layout();
        let kinds = self.kinds();
        let mut entries: Vec<(Swatch, &str)> = kinds
            .iter()
            .enumerate()
            .map(|(k, kind)| (MARKS[k % MARKS.len()], kind.as_str()))
            .collect();
        entries.push((Swatch::Dashed(GREY), "predicted = exact"));
        let room = COLUMN - layout.left - MARGIN;
        legend(
            canvas,
            [layout.left, MARGIN + 2.0],
            room,
            LEGEND_COLUMNS,
            &entries,
        );
        for (place, label) in self.labels().iter().take(MOST).enumerate() {
            self.draw_panel(canvas, &layout, place, label);
        }
        if self.series.is_empty() {
            let panel = self.panel(&layout, 0);
            agreement::draw(canvas, &panel, &layout.ticks, &layout.ticks, true);
            panel.remark(canvas, "no data");
        }
        self.draw_labels(canvas, &layout);
    }

    fn table(&self) -> Table {
        let sizes = ["exact", "predicted"].map(|name| column(name, &self.unit));
        let mut table = Table::new(&["surrogate", "designs", &sizes[0], &sizes[1]]);
        for series in &self.series {
            for (exact, predicted) in series.exact.iter().zip(&series.predicted) {
                let names = [series.label.clone(), series.kind.clone()];
                let numbers = [*exact, *predicted].map(cell);
                table.rows.push(names.into_iter().chain(numbers).collect());
            }
        }
        table
    }
}

/// Columns of the legend.
const LEGEND_COLUMNS: usize = 4;

/// Places of the panels, points.
struct Layout {
    width: f64,
    head: f64,
    left: f64,
    side: f64,
    columns: usize,
    rows: usize,
    range: [f64; 2],
    ticks: Vec<Tick>,
}

impl SizeScatter {
    /// Names of the surrogates in order.
    fn labels(&self) -> Vec<String> {
        distinct(self.series.iter().map(|series| &series.label))
    }

    /// Kinds of designs in order.
    fn kinds(&self) -> Vec<String> {
        distinct(self.series.iter().map(|series| &series.kind))
    }

    fn layout(&self) -> Layout {
        let panels = self.labels().len().clamp(1, MOST);
        let columns = match panels {
            1 => 1,
            2 | 4 => 2,
            _ => 3,
        };
        let width = if columns < 3 { COLUMN } else { DOUBLE_COLUMN };
        let range = self.range();
        let count = if columns == 1 { 5 } else { 4 };
        let ticks = ticks::round(range[0], range[1], count);
        let left = left(&ticks);
        let room = width - left - MARGIN - 4.0 - (columns - 1) as f64 * GAP;
        Layout {
            width,
            head: (self.kinds().len() + 1).div_ceil(LEGEND_COLUMNS) as f64 * LEGEND_ROW + MARGIN,
            left,
            side: (room / columns as f64).min(170.0),
            columns,
            rows: panels.div_ceil(columns),
            range,
            ticks,
        }
    }

    /// The range of both axes: 0, or the least prediction, to a little beyond the largest size.
    fn range(&self) -> [f64; 2] {
        let exact = self.series.iter().flat_map(|series| &series.exact);
        let sizes = exact.copied().chain([self.largest]);
        let sizes = sizes.filter(|size| size.is_finite() && *size < 1e150);
        let largest = sizes.fold(0.0, f64::max);
        if largest <= 0.0 {
            return [0.0, 1.0];
        }
        let predicted = self.series.iter().flat_map(|series| &series.predicted);
        let predicted = predicted.filter(|size| size.is_finite());
        // A little below 0 or above the largest size is shown as it is, but no more than that.
        let [low, high] = predicted.fold([0.0, largest], |[low, high]: [f64; 2], size| {
            [low.min(*size), high.max(*size)]
        });
        let low = low.max(-0.1 * largest);
        [low * BEYOND, high.min(1.2 * largest) * BEYOND]
    }

    /// Number of predictions of a series that are beyond the axes.
    fn outside(&self, series: &SizeSeries) -> usize {
        let [low, high] = self.range();
        let pairs = series.exact.iter().zip(&series.predicted);
        let finite = pairs.filter(|(exact, predicted)| exact.is_finite() && predicted.is_finite());
        finite
            .filter(|(_, size)| !(low..=high).contains(*size))
            .count()
    }

    fn panel(&self, layout: &Layout, place: usize) -> Panel {
        let (column, row) = (place % layout.columns, place / layout.columns);
        Panel {
            left: layout.left + column as f64 * (layout.side + GAP),
            top: layout.head + row as f64 * (layout.side + TITLE_ROW + 12.0) + TITLE_ROW,
            width: layout.side,
            height: layout.side,
            x: layout.range,
            y: layout.range,
        }
    }

    fn draw_panel(&self, canvas: &mut Canvas, layout: &Layout, place: usize, label: &str) {
        let panel = self.panel(layout, place);
        agreement::draw(
            canvas,
            &panel,
            &layout.ticks,
            &layout.ticks,
            place.is_multiple_of(layout.columns),
        );
        let kinds = self.kinds();
        for series in self.series.iter().filter(|series| series.label == label) {
            let kind = kinds.iter().position(|kind| *kind == series.kind);
            let mark = MARKS[kind.unwrap_or(0) % MARKS.len()];
            for at in marks(&panel, series) {
                // A swatch is drawn 6 points right of its place.
                draw_swatch(canvas, mark, [at[0] - 6.0, at[1]]);
            }
        }
        let title = agreement::spaced(label);
        let title = Label::new(&title, SMALL).bold();
        title.draw_within(canvas, [panel.left, panel.top - 4.5], panel.width);
    }

    /// The names of the axes, once for all panels.
    fn draw_labels(&self, canvas: &mut Canvas, layout: &Layout) {
        let last = self.panel(layout, (layout.rows - 1) * layout.columns);
        let whole = Panel {
            top: layout.head + TITLE_ROW,
            width: (layout.side + GAP) * layout.columns as f64 - GAP,
            height: last.top + last.height - layout.head - TITLE_ROW,
            ..last
        };
        whole.x_label(canvas, &with_unit("exact S_F", &self.unit));
        whole.y_label(
            canvas,
            &with_unit("predicted S_F", &self.unit),
            &layout.ticks,
        );
    }
}

/// The different names in the order of their first use.
fn distinct<'n>(names: impl Iterator<Item = &'n String>) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for name in names {
        if !all.contains(name) {
            all.push(name.clone());
        }
    }
    all
}

/// Where a series has its markers on the sheet; those that hide each other are drawn once.
fn marks(panel: &Panel, series: &SizeSeries) -> Vec<Point> {
    let mut taken = BTreeSet::new();
    let pairs = series.exact.iter().zip(&series.predicted);
    let finite = pairs.filter(|(exact, predicted)| exact.is_finite() && predicted.is_finite());
    let places = finite.map(|(exact, predicted)| {
        let inside = |size: f64, [low, high]: [f64; 2]| size.clamp(low, high);
        panel.at(inside(*exact, panel.x), inside(*predicted, panel.y))
    });
    places
        .filter(|at| taken.insert(at.map(|c| (c / SAME).round() as i64)))
        .collect()
}
