//! Angles drawn from a mixture density before and after the difference filter [S3 Fig. 4].

use super::angle_axes::{self, EDGE, SIDE};
use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::panel::{BOTTOM, Panel, range};
use super::point_cloud;
use super::spatial_figure::{PANEL_TITLE, panel_title};
use super::style::{BLUE, COLUMN, MARGIN, SMALL};
use super::table::{Table, cell};
use crate::angle::{AngleSet, wrap};
use plotters::style::text_anchor::HPos;

/// Drawn angles over the radius, before and after the filter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilterFigure {
    /// Radius in metres and polar angle in radians of every drawn angle.
    pub before: Vec<[f64; 2]>,
    /// Those that the filter keeps.
    pub after: Vec<[f64; 2]>,
    /// Radii in metres with the exact rotation sets: their edges are drawn.
    pub exact: Vec<(f64, AngleSet)>,
    /// Settings of the filter, as in "α = 3, ε = 10⁻⁵, once".
    pub filter_label: String,
}

/// Height of the plots, points.
const HEIGHT: f64 = 125.0;
/// Height of the legend above the titles of the plots, points.
const HEAD: f64 = LEGEND_ROW + MARGIN + PANEL_TITLE;
/// Space between the plots, points.
const GAP: f64 = 18.0;
/// Radius of a dot, points.
const DOT: f64 = 0.45;

impl Figure for FilterFigure {
    fn name(&self) -> &str {
        "filter"
    }

    fn caption(&self) -> String {
        let label = match self.filter_label.is_empty() {
            true => String::new(),
            false => format!(" ({})", self.filter_label),
        };
        format!(
            "Polar angles β drawn from the predicted density at every radius r, (a) before and \
             (b) after the difference filter{label}: {} of {} angles are kept. Lines: edges of \
             the exact rotation sets.",
            self.after.len(),
            self.before.len()
        )
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: HEAD + HEIGHT + BOTTOM,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        self.draw_legend(canvas);
        let width = 0.5 * (COLUMN - SIDE - GAP - 2.0 * MARGIN);
        let drawn = self.before.iter().chain(&self.after).map(|point| point[0]);
        let radii = drawn.chain(self.exact.iter().map(|(r, _)| *r));
        let radii = range(radii, 0.01).map(|r| r.max(0.0));
        let panels = [("(a) before", &self.before), ("(b) after", &self.after)];
        for (k, (name, points)) in panels.into_iter().enumerate() {
            let left = SIDE + k as f64 * (width + GAP);
            let radii = radii.into_iter();
            let panel = angle_axes::panel([left, HEAD], [width, HEIGHT], radii);
            let place = |p: &[f64; 2]| [p[0], wrap(p[1]).to_degrees()];
            let finite = points.iter().filter(|p| p.iter().all(|c| c.is_finite()));
            point_cloud::draw(canvas, &panel, finite.map(place), DOT, BLUE);
            angle_axes::draw_edges(canvas, &panel, &self.exact);
            panel_title(canvas, [panel.left, panel.top], name);
            if k == 1 {
                self.draw_settings(canvas, &panel);
            }
            if points.is_empty() {
                panel.remark(canvas, "no angles");
            }
            angle_axes::draw(canvas, &panel, k == 0);
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&["kind", "radius_m", "beta_deg", "beta_upper_deg"]);
        for (kind, points) in [("before", &self.before), ("after", &self.after)] {
            let row = |p: &[f64; 2]| [cell(p[0]), cell(p[1].to_degrees()), String::new()];
            let rows = points.iter().map(row);
            table.rows.extend(rows.map(|row| with_kind(kind, row)));
        }
        for (radius, set) in &self.exact {
            for arc in set.arcs() {
                let ends = [arc.start(), arc.end()].map(f64::to_degrees);
                let row = [*radius, ends[0], ends[1]].map(cell);
                table.rows.push(with_kind("exact", row));
            }
        }
        table
    }
}

fn with_kind(kind: &str, row: [String; 3]) -> Vec<String> {
    std::iter::once(kind.to_string()).chain(row).collect()
}

impl FilterFigure {
    fn draw_legend(&self, canvas: &mut Canvas) {
        let mut entries = vec![(Swatch::Dot(BLUE), "drawn angle")];
        if angle_axes::is_any(&self.exact) {
            entries.push((Swatch::Line(EDGE), "exact edge"));
        }
        let width = COLUMN - SIDE - MARGIN;
        legend(canvas, [SIDE, MARGIN + 2.0], width, 2, &entries);
    }

    /// The filter's settings above the second plot, right of its title.
    fn draw_settings(&self, canvas: &mut Canvas, panel: &Panel) {
        let at = [panel.left + panel.width, panel.top - 5.0];
        let label = Label::new(&self.filter_label, SMALL).align(HPos::Right);
        label.draw_within(canvas, at, panel.width - 36.0);
    }
}
