//! Exact beside predicted workspaces of some designs [S3 Fig. 5–8].

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::number::{plain, unit};
use super::panel::{BOTTOM, LEFT, Panel};
use super::polar;
use super::ring_picture;
use super::rings;
use super::slices::slices;
use super::style::{COLUMN, DOUBLE_COLUMN, GREY, INK, MARGIN, PALE, SKY, SMALL};
use super::table::{Table, column};
use super::ticks;
use crate::workspace::RingMap;
use plotters::style::text_anchor::HPos;

/// Exact and predicted fault-tolerant workspaces of position tasks, a row per design.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PredictedWorkspaces {
    /// The designs in order; at most eight are drawn.
    pub cases: Vec<WorkspaceCase>,
    /// Unit of the sizes, as in "m^2".
    pub unit: String,
}

/// One design.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkspaceCase {
    /// Why it is shown, as in "best", "median" or "worst".
    pub label: String,
    /// Its artificial limits in words.
    pub limits_label: String,
    /// The exact workspace, metres.
    pub exact: RingMap,
    /// The predicted workspace, metres.
    pub predicted: RingMap,
    /// Exact size S_F, in the figure's unit.
    pub exact_size: f64,
    /// Predicted size S_F, in the figure's unit.
    pub predicted_size: f64,
    /// Intersection over union of both workspaces, in [0, 1].
    pub overlap: f64,
}

/// No more designs than these are drawn; the table has all.
const MOST: usize = 8;
/// Designs up to this number are drawn one below the other, more of them two in a row.
const SINGLE: usize = 3;
/// Space between the two workspaces of a design, points.
const GAP: f64 = 8.0;
/// Space above a pair for three lines of text, points.
const TEXT: f64 = 28.0;
/// Space between rows, points.
const BETWEEN: f64 = 8.0;

impl Figure for PredictedWorkspaces {
    fn name(&self) -> &str {
        "predicted_workspaces"
    }

    fn caption(&self) -> String {
        let more = match self.cases.len() > MOST {
            true => format!(" The first {MOST} of {} designs.", self.cases.len()),
            false => String::new(),
        };
        format!(
            "Fault-tolerant workspaces W_F (blue) within the unrestricted workspace (grey): \
             exact (left) and predicted (right, with the edge of the exact one). Overlap: \
             intersection over union of both.{more}"
        )
    }

    fn size(&self) -> Size {
        let rows = self.rows() as f64;
        Size {
            width: self.width(),
            height: HEAD + rows * self.pitch() - BETWEEN + BOTTOM - 12.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        self.draw_legend(canvas);
        for (place, case) in self.cases.iter().take(MOST).enumerate() {
            self.draw_case(canvas, place, case);
        }
        if self.cases.is_empty() {
            Label::new("no designs", SMALL).draw(canvas, [LEFT, HEAD + TEXT]);
        }
    }

    fn table(&self) -> Table {
        let sizes = ["size_exact", "size_predicted"].map(|name| column(name, &self.unit));
        let mut header = vec!["case", "limits", "overlap"];
        header.extend(sizes.iter().map(String::as_str));
        header.push("workspace");
        header.extend(ring_picture::COLUMNS);
        let mut table = Table::new(&header);
        for case in &self.cases {
            let numbers = [case.overlap, case.exact_size, case.predicted_size];
            let mut head = vec![case.label.clone(), case.limits_label.clone()];
            head.extend(numbers.map(super::table::cell));
            for (name, map) in [("exact", &case.exact), ("predicted", &case.predicted)] {
                let whole = |cells: Vec<String>| {
                    let row = head.iter().cloned().chain([name.to_string()]);
                    row.chain(cells).collect::<Vec<String>>()
                };
                let before = table.rows.len();
                let rows = ring_picture::rows(map).map(|cells| whole(cells.to_vec()));
                table.rows.extend(rows);
                // An empty workspace is a row without radii and angles.
                if table.rows.len() == before {
                    let blank = vec![String::new(); ring_picture::COLUMNS.len()];
                    table.rows.push(whole(blank));
                }
            }
        }
        table
    }
}

/// Height of the legend, points.
const HEAD: f64 = LEGEND_ROW + MARGIN + 2.0;

impl PredictedWorkspaces {
    fn shown(&self) -> usize {
        self.cases.len().clamp(1, MOST)
    }

    /// Number of designs beside each other.
    fn columns(&self) -> usize {
        if self.shown() <= SINGLE { 1 } else { 2 }
    }

    fn rows(&self) -> usize {
        self.shown().div_ceil(self.columns())
    }

    fn width(&self) -> f64 {
        if self.columns() == 1 {
            COLUMN
        } else {
            DOUBLE_COLUMN
        }
    }

    /// Space for one design across, points.
    fn share(&self) -> f64 {
        self.width() / self.columns() as f64
    }

    /// Side of a square plot, points.
    fn side(&self) -> f64 {
        0.5 * (self.share() - LEFT - GAP - 2.0 * MARGIN)
    }

    /// From one row to the next, points.
    fn pitch(&self) -> f64 {
        TEXT + self.side() + 12.0 + BETWEEN
    }

    fn draw_legend(&self, canvas: &mut Canvas) {
        let entries = [
            (Swatch::Area(SKY, SKY), "W_F"),
            (Swatch::Area(PALE, GREY), "unrestricted workspace"),
            (Swatch::Line(INK), "exact edge"),
        ];
        let width = COLUMN - 20.0 - MARGIN;
        legend(canvas, [20.0, MARGIN + 2.0], width, 3, &entries);
    }

    fn draw_case(&self, canvas: &mut Canvas, place: usize, case: &WorkspaceCase) {
        let (column, row) = (place % self.columns(), place / self.columns());
        let left = column as f64 * self.share() + LEFT;
        let top = HEAD + row as f64 * self.pitch();
        let is_last = place + self.columns() >= self.shown();
        let width = self.share() - LEFT - MARGIN;
        let title = match case.overlap.is_finite() {
            true => format!("{}: overlap {:.3}", case.label, case.overlap),
            false => case.label.clone(),
        };
        let title = Label::new(&title, SMALL).bold();
        title.draw_within(canvas, [left, top + 8.0], width);
        let limits = Label::new(&case.limits_label, SMALL);
        limits.draw_within(canvas, [left, top + 16.0], width);
        let reach = reach(case);
        for (k, map) in [&case.exact, &case.predicted].into_iter().enumerate() {
            let side = self.side();
            let panel = Panel {
                left: left + k as f64 * (side + GAP),
                top: top + TEXT,
                width: side,
                height: side,
                x: [-reach, reach],
                y: [-reach, reach],
            };
            ring_picture::draw(canvas, &panel, map);
            if k == 1 {
                draw_edge(canvas, &panel, &case.exact);
            }
            if map.rings.iter().all(|ring| ring.rotation_set.is_empty()) {
                panel.remark(canvas, "W_F is empty");
            }
            self.draw_axes(canvas, &panel, k == 0, is_last);
            let name = self.name_of(case, k);
            let name = Label::new(&name, SMALL).align(HPos::Center);
            let at = [panel.left + 0.5 * side, panel.top - 4.0];
            name.draw_within(canvas, at, side + GAP - 2.0);
        }
    }

    /// Title of the exact (0) or the predicted (1) workspace.
    fn name_of(&self, case: &WorkspaceCase, which: usize) -> String {
        let (name, size) = match which {
            0 => ("exact", case.exact_size),
            _ => ("predicted", case.predicted_size),
        };
        match size.is_finite() {
            true => {
                let size = short(size);
                let text = format!("{name}, S_F = {size} {}", unit(&self.unit));
                text.trim_end().to_string()
            }
            false => name.to_string(),
        }
    }

    fn draw_axes(&self, canvas: &mut Canvas, panel: &Panel, is_left: bool, is_last: bool) {
        let ticks = ticks::round(panel.x[0], panel.x[1], 3);
        let x_ticks = match is_last {
            true => ticks.clone(),
            false => ticks::unlabelled(&ticks),
        };
        panel.axes(canvas, &x_ticks, &ticks, is_left);
        if is_last {
            panel.x_label(canvas, "x (m)");
        }
        if is_left {
            panel.y_label(canvas, "y (m)", &ticks);
        }
    }
}

/// A size with four significant digits.
fn short(size: f64) -> String {
    let power = size.abs().log10().floor();
    match (-3.0..=3.0).contains(&power) {
        true => super::number::rounded(size, power as i32 - 3),
        false => plain(size),
    }
}

/// Half the side of a plot, metres.
fn reach(case: &WorkspaceCase) -> f64 {
    let outer = |map: &RingMap| map.unrestricted[1];
    let both = [outer(&case.exact), outer(&case.predicted)];
    let finite = both.into_iter().filter(|r| r.is_finite());
    let reach = 1.05 * finite.fold(0.0, f64::max);
    if reach > 0.0 { reach } else { 1.0 }
}

/// The edge of a workspace as lines.
fn draw_edge(canvas: &mut Canvas, panel: &Panel, map: &RingMap) {
    for line in rings::edges(&slices(map)) {
        for pair in line.windows(2) {
            let part = polar::spiral([0.0, 0.0], pair[0], pair[1]);
            canvas.stroke(&panel.path(&part), 0.5, INK);
        }
    }
}
