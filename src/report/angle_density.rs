//! A network's density of fault-tolerant angles, with the exact edges [S3 Fig. 3].

use super::angle_axes::{self, EDGE, SIDE};
use super::canvas::{Canvas, Size};
use super::colour_bar::ColourBar;
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::number::plain;
use super::panel::{BOTTOM, Panel};
use super::share_scale::Palette;
use super::style::{COLUMN, GREY, INK, MARGIN, PALE, TITLE};
use super::table::{Table, cell};
use crate::angle::AngleSet;
use plotters::style::text_anchor::HPos;

/// Density over radius and polar angle as a heat map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AngleDensity {
    /// Radii of the cells' edges, ascending, metres; one more than rows of cells.
    pub radii: Vec<f64>,
    /// Number of cells around the circle; cell k covers polar angles
    /// −π + 2πk/`angles` … −π + 2π(k+1)/`angles`.
    pub angles: usize,
    /// Density per radian, row by row of radius. A cell that is not a number is grey.
    pub density: Vec<f64>,
    /// Radii in metres with the exact rotation sets: their edges are drawn.
    pub exact: Vec<(f64, AngleSet)>,
    /// Radii between which fault-tolerant points may lie, metres; not drawn unless the first is
    /// the smaller one.
    pub gate: [f64; 2],
    /// Title above the plot; none if empty.
    pub title: String,
}

/// Height of the plot, points.
const HEIGHT: f64 = 130.0;

/// Peaks above this many times the 99.5 % quantile do not stretch the colours.
const PEAK: f64 = 1.5;

impl Figure for AngleDensity {
    fn name(&self) -> &str {
        "angle_density"
    }

    fn caption(&self) -> String {
        let top = self.top();
        let cut = match self.most() > top {
            true => format!(
                " The darkest colour stands for {} rad⁻¹ and more.",
                plain(top)
            ),
            false => String::new(),
        };
        format!(
            "Predicted density of fault-tolerant polar angles β over the radius r (colour), and \
             the edges of the exact rotation sets (lines).{cut}"
        )
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: self.head() + HEIGHT + BOTTOM,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * COLUMN, 10.0], COLUMN - 2.0 * MARGIN);
        let bar = ColourBar::new(self.top(), Palette::Density);
        let width = COLUMN - SIDE - 6.0 - bar.width() - MARGIN;
        let size = [width, HEIGHT];
        let panel = angle_axes::panel([SIDE, self.head()], size, self.radii.iter().copied());
        self.draw_legend(canvas);
        self.draw_cells(canvas, &panel);
        angle_axes::draw_edges(canvas, &panel, &self.exact);
        if self.has_gate() {
            angle_axes::draw_gate(canvas, &panel, self.gate);
        }
        if self.most() <= 0.0 {
            panel.remark(canvas, "no density anywhere");
        }
        angle_axes::draw(canvas, &panel, true);
        let corner = [SIDE + width + 6.0, panel.top];
        bar.draw(canvas, corner, HEIGHT, "density of β (rad⁻¹)");
    }

    fn table(&self) -> Table {
        let columns = [
            "kind",
            "radius_inner_m",
            "radius_outer_m",
            "beta_lower_deg",
            "beta_upper_deg",
            "density_per_rad",
        ];
        let mut table = Table::new(&columns);
        let mut push = |kind: &str, numbers: [f64; 5]| {
            let cells = numbers.map(cell);
            let row = std::iter::once(kind.to_string()).chain(cells);
            table.rows.push(row.collect());
        };
        let angles = self.angles.max(1);
        let start = |k: usize| -180.0 + 360.0 * k as f64 / angles as f64;
        for (edges, row) in self.radii.windows(2).zip(self.density.chunks(angles)) {
            for (k, density) in row.iter().enumerate() {
                let ends = [start(k), start(k + 1)];
                push("cell", [edges[0], edges[1], ends[0], ends[1], *density]);
            }
        }
        for (radius, set) in &self.exact {
            for arc in set.arcs() {
                let ends = [arc.start(), arc.end()].map(f64::to_degrees);
                push("exact", [*radius, *radius, ends[0], ends[1], f64::NAN]);
            }
        }
        table
    }
}

impl AngleDensity {
    /// Height of title and legend, points.
    fn head(&self) -> f64 {
        let title = if self.title.is_empty() { 0.0 } else { 12.0 };
        title + LEGEND_ROW + MARGIN + 2.0
    }

    fn has_gate(&self) -> bool {
        let [low, high] = self.gate;
        low.is_finite() && high.is_finite() && low < high
    }

    /// The greatest density, at least 0.
    fn most(&self) -> f64 {
        let finite = self.density.iter().filter(|density| density.is_finite());
        finite.copied().fold(0.0, f64::max)
    }

    /// The density of the darkest colour.
    fn top(&self) -> f64 {
        let positive = self.density.iter().filter(|d| d.is_finite() && **d > 0.0);
        let mut positive: Vec<f64> = positive.copied().collect();
        positive.sort_by(f64::total_cmp);
        let quantile = positive.get(positive.len().saturating_sub(1) * 199 / 200);
        match quantile {
            Some(quantile) if self.most() > PEAK * quantile => *quantile,
            Some(_) => self.most(),
            None => 1.0,
        }
    }

    fn draw_legend(&self, canvas: &mut Canvas) {
        let mut entries = Vec::new();
        if angle_axes::is_any(&self.exact) {
            entries.push((Swatch::Line(EDGE), "exact edge"));
        }
        if self.has_gate() {
            entries.push((Swatch::Dashed(INK), "reachable gate"));
        }
        if self.density.iter().any(|density| !density.is_finite()) {
            entries.push((Swatch::Area(PALE, GREY), "no density"));
        }
        let at = [SIDE, self.head() - LEGEND_ROW + 2.0];
        legend(canvas, at, COLUMN - SIDE - 2.0 * MARGIN, 3, &entries);
    }

    fn draw_cells(&self, canvas: &mut Canvas, panel: &Panel) {
        let top = self.top();
        let metres = (panel.x[1] - panel.x[0]) / panel.width;
        let corner = [panel.left, panel.top];
        canvas.picture(corner, [panel.width, panel.height], |x, y| {
            let r = panel.x[0] + (x - panel.left) * metres;
            let around = 1.0 - (y - panel.top) / panel.height;
            let colour = match self.density_at(r, around) {
                Some(density) if density.is_finite() => {
                    Palette::Density.colour((density / top).clamp(0.0, 1.0))
                }
                Some(_) => PALE,
                None => return [255; 3],
            };
            [colour.0, colour.1, colour.2]
        });
    }

    /// Density of the cell at radius `r`, a share `around` of the way from −180° to 180°.
    fn density_at(&self, r: f64, around: f64) -> Option<f64> {
        let last = self.radii.len().checked_sub(2)?;
        let row = self.radii.partition_point(|edge| *edge <= r);
        let row = row.saturating_sub(1).min(last);
        let column = (around.max(0.0) * self.angles as f64) as usize;
        let column = column.min(self.angles.checked_sub(1)?);
        self.density.get(row * self.angles + column).copied()
    }
}
