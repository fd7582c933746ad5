//! Which joint costs the robot its workspace: every size beside the unrestricted one.

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::{Label, rectangle};
use super::number::{estimate, subscript, unit};
use super::panel::{BOTTOM, Panel};
use super::style::{
    BLUE, COLUMN, GREY, HALF_CAPITAL, INK, MARGIN, NORMAL, SKY, SMALL, VERMILLION, translucent,
};
use super::table::{Table, cell, column};
use super::ticks;
use crate::workspace::{Estimate, FailureSet, WorkspaceSizes};
use plotters::style::RGBAColor;
use plotters::style::text_anchor::HPos;

/// Sizes of all workspaces, as shares of the unrestricted one.
#[derive(Clone, Debug)]
pub struct SizesFigure<'a> {
    /// The sizes.
    pub sizes: &'a WorkspaceSizes,
    /// Joints prone to failure; the bars of the others are hollow.
    pub failures: &'a FailureSet,
    /// Unit of the sizes, as in "m^2".
    pub unit: &'a str,
}

/// A size with its name in figures and tables.
pub(super) struct NamedSize {
    pub name: String,
    pub symbol: String,
    pub size: Estimate,
    /// Whether the fault-tolerant workspace depends on it.
    pub counts: bool,
}

/// All sizes in the order of tables: S_0max, W₀, W₁ …, W_F.
pub(super) fn named(sizes: &WorkspaceSizes, failures: &FailureSet) -> Vec<NamedSize> {
    let named = |name: &str, symbol: &str, size: Estimate| NamedSize {
        name: name.into(),
        symbol: symbol.into(),
        size,
        counts: true,
    };
    let mut all = vec![
        named("unrestricted", "W₀ₘₐₓ", sizes.unrestricted),
        named("before failure", "W₀", sizes.pre_failure),
    ];
    let prone: Vec<usize> = failures.numbers().collect();
    for (k, size) in sizes.post_failure.iter().enumerate() {
        let joint = k + 1;
        let (name, symbol) = (
            format!("joint {joint} locked"),
            format!("W{}", subscript(joint)),
        );
        all.push(NamedSize {
            counts: prone.contains(&joint),
            ..named(&name, &symbol, *size)
        });
    }
    all.push(named("fault-tolerant", "W_F", sizes.fault_tolerant));
    all
}

const ROW: f64 = 14.0;
const NAMES: f64 = 84.0;
/// Space behind a full bar for its number, points.
const NUMBERS: f64 = 70.0;

impl Figure for SizesFigure<'_> {
    fn name(&self) -> &'static str {
        "sizes"
    }

    fn caption(&self) -> String {
        let hollow = match named(self.sizes, self.failures)
            .iter()
            .all(|size| size.counts)
        {
            true => "",
            false => " Hollow bars belong to joints that are not prone to failure.",
        };
        format!("Sizes of the workspaces relative to the unrestricted one.{hollow}")
    }

    fn size(&self) -> Size {
        let rows = self.sizes.post_failure.len() + 3;
        Size {
            width: COLUMN,
            height: MARGIN + rows as f64 * ROW + BOTTOM,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let all = named(self.sizes, self.failures);
        let panel = Panel {
            left: NAMES,
            top: MARGIN,
            width: COLUMN - NAMES - NUMBERS,
            height: all.len() as f64 * ROW,
            x: [0.0, 100.0],
            y: [0.0, 1.0],
        };
        for (k, size) in all.iter().enumerate() {
            let y = panel.top + (k as f64 + 0.5) * ROW;
            let is_last = k + 1 == all.len();
            self.draw_bar(canvas, &panel, y, size, is_last);
        }
        panel.axes(canvas, &ticks::round(0.0, 100.0, 5), &[], true);
        panel.x_label(canvas, "share of the unrestricted workspace (%)");
    }

    fn table(&self) -> Table {
        let columns = ["size", "error"].map(|name| column(name, self.unit));
        let mut table = Table::new(&["workspace", &columns[0], &columns[1], "share_percent"]);
        for size in named(self.sizes, self.failures) {
            let share = 100.0 * size.size.value / self.sizes.unrestricted.value;
            let numbers = [size.size.value, size.size.error, share].map(cell);
            table
                .rows
                .push([vec![size.name], numbers.to_vec()].concat());
        }
        table
    }
}

impl SizesFigure<'_> {
    fn draw_bar(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        y: f64,
        size: &NamedSize,
        is_last: bool,
    ) {
        draw_name(canvas, y, size, is_last);
        let place = |value: f64| panel.at(self.percent(value), 0.0)[0];
        let (value, error) = (size.size.value, size.size.error);
        let end = place(value);
        let bar = rectangle(panel.left, y - 4.0, end - panel.left, 8.0);
        let colour = bar_colour(&size.symbol, is_last);
        let strength = if size.counts { 1.0 } else { 0.15 };
        canvas.fill(&bar, translucent(colour, strength));
        canvas.outline(&bar, 0.4, colour);
        let ends = [place(value - error), place(value + error)];
        if error.is_finite() && ends[1] - ends[0] > 1.0 {
            canvas.stroke(&[[ends[0], y], [ends[1], y]], 0.7, INK);
        }
        let text = format!("{} {}", estimate(&size.size), unit(self.unit));
        let at = [end.max(ends[1]) + 3.0, y + HALF_CAPITAL * SMALL];
        Label::new(&text, SMALL).draw_within(canvas, at, COLUMN - MARGIN - at[0]);
    }

    /// Share of the unrestricted size, within 0 to 100 %.
    fn percent(&self, value: f64) -> f64 {
        let share = 100.0 * value / self.sizes.unrestricted.value;
        if share.is_finite() {
            share.clamp(0.0, 100.0)
        } else {
            0.0
        }
    }
}

fn draw_name(canvas: &mut Canvas, y: f64, size: &NamedSize, is_last: bool) {
    let name = format!("{} {}", size.name, size.symbol);
    let label = Label::new(&name, NORMAL).align(HPos::Right);
    let label = if is_last { label.bold() } else { label };
    let at = [NAMES - 4.0, y + HALF_CAPITAL * NORMAL];
    label.draw_within(canvas, at, NAMES - 4.0 - MARGIN);
}

fn bar_colour(symbol: &str, is_last: bool) -> RGBAColor {
    match symbol {
        _ if is_last => BLUE,
        "W₀ₘₐₓ" => GREY,
        "W₀" => SKY,
        _ => VERMILLION,
    }
}
