//! The workspace of a spatial task in one half-plane that joint 1's axis bounds.

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::Label;
use super::panel::{BOTTOM, LEFT, Panel};
use super::sections::Sections;
use super::share_scale::{Palette, ShareScale};
use super::spatial_figure::{PANEL_TITLE, panel_title};
use super::style::{COLUMN, DOUBLE_COLUMN, GREY, MARGIN, REACHABLE, TITLE};
use super::table::{Table, cell};
use super::ticks;
use crate::workspace::SpatialShareMap;
use plotters::style::text_anchor::HPos;

/// Fault-tolerant and reachable shares by distance from joint 1's axis and height.
#[derive(Clone, Debug)]
pub struct HalfPlaneFigure<'a> {
    /// The map to draw.
    pub map: &'a SpatialShareMap,
    /// Title above the panels; none if empty.
    pub title: String,
}

/// Greatest height of a panel and greatest width, points.
const MOST: [f64; 2] = [170.0, 200.0];

/// A cell's number in one of the panels.
pub(super) type Value<'v> = &'v (dyn Fn(usize, usize) -> f64 + Sync);

impl Figure for HalfPlaneFigure<'_> {
    fn name(&self) -> &'static str {
        "half_plane"
    }

    fn caption(&self) -> String {
        let (what, reachable) = match self.map.orientations {
            true => (
                "share of fault-tolerant orientations, mean over the azimuth",
                "share of orientations in reach with all joints free",
            ),
            false => (
                "share of the azimuth that is fault tolerant",
                "share of every cell in reach with all joints free",
            ),
        };
        format!(
            "The workspace by distance r from the axis of joint 1 and height z: (a) {what}; \
             (b) {reachable}. Grey: the unrestricted workspace and its outline."
        )
    }

    fn size(&self) -> Size {
        let sections = Sections::new(self.map);
        let [width, height] = panel_size(&sections);
        let scales = self.scales();
        let bars = scales.map(|scale| scale.bar_width());
        let needed = 2.0 * (LEFT + width + 6.0) + bars[0] + bars[1] + 2.0 * MARGIN;
        Size {
            width: needed.clamp(COLUMN, DOUBLE_COLUMN),
            height: self.head() + height + BOTTOM + 2.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let sections = Sections::new(self.map);
        let width = self.size().width;
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * width, 12.0], width - 2.0 * MARGIN);
        let fault_tolerant = |ir: usize, iz: usize| self.map.mean(ir, iz);
        // The outline cuts corners of cells out of reach; they take a neighbour's colour.
        let unrestricted = |ir: usize, iz: usize| match self.map.unrestricted_at(ir, iz) {
            share if share > 0.0 => share,
            _ => least_around(self.map, ir, iz),
        };
        let texts = self.texts();
        let values: [Value; 2] = [&fault_tolerant, &unrestricted];
        let mut left = LEFT;
        for ((text, value), scale) in texts.iter().zip(values).zip(self.scales()) {
            let panel = self.panel(&sections, left);
            panel_title(canvas, [panel.left, panel.top], text[0]);
            draw_cells(canvas, &panel, &sections, value, &scale);
            draw_axes(canvas, &panel, ["r (m)", "z (m)"]);
            if sections.is_empty() && text[0].starts_with("(a)") {
                panel.remark(canvas, "W_F is empty");
            }
            let bar = [left + panel.width + 6.0, panel.top];
            scale.draw_bar(canvas, bar, panel.height, text[1]);
            left = bar[0] + scale.bar_width() + MARGIN + LEFT;
        }
    }

    fn table(&self) -> Table {
        let columns = [
            "radius_inner_m",
            "radius_outer_m",
            "height_lower_m",
            "height_upper_m",
            "share_mean",
            "unrestricted",
        ];
        let mut table = Table::new(&columns);
        let map = self.map;
        for (ir, r) in map.radius_edges.windows(2).enumerate() {
            for (iz, z) in map.height_edges.windows(2).enumerate() {
                let shares = [map.mean(ir, iz), map.unrestricted_at(ir, iz)];
                if shares.iter().any(|share| *share > 0.0) {
                    let row = [r[0], r[1], z[0], z[1], shares[0], shares[1]];
                    table.rows.push(row.map(cell).to_vec());
                }
            }
        }
        table
    }
}

impl HalfPlaneFigure<'_> {
    fn head(&self) -> f64 {
        let title = if self.title.is_empty() { 0.0 } else { 14.0 };
        title + PANEL_TITLE + 4.0
    }

    /// Scales of both panels, each as far as its numbers go.
    fn scales(&self) -> [ShareScale; 2] {
        let map = self.map;
        let cells = |ir| (0..map.heights()).map(move |iz| (ir, iz));
        let most = |value: Value| {
            let all = (0..map.radii()).flat_map(cells);
            all.map(|(ir, iz)| value(ir, iz)).fold(0.0, f64::max)
        };
        [
            ShareScale::fitting(most(&|ir, iz| map.mean(ir, iz)), Palette::of(map)),
            ShareScale::fitting(most(&|ir, iz| map.unrestricted_at(ir, iz)), Palette::Blues),
        ]
    }

    /// Title and colour bar's label of each panel.
    fn texts(&self) -> [[&'static str; 2]; 2] {
        match self.map.orientations {
            true => [
                ["(a) fault tolerant", "fault-tolerant orientations (%)"],
                ["(b) unrestricted", "reachable orientations (%)"],
            ],
            false => [
                ["(a) fault tolerant", "fault-tolerant share (%)"],
                ["(b) unrestricted", "reachable share (%)"],
            ],
        }
    }

    fn panel(&self, sections: &Sections, left: f64) -> Panel {
        let [width, height] = panel_size(sections);
        Panel {
            left,
            top: self.head(),
            width,
            height,
            x: [0.0, sections.reach],
            y: sections.z,
        }
    }
}

/// The least reachable share above 0 of the cells around a cell.
fn least_around(map: &SpatialShareMap, ir: usize, iz: usize) -> f64 {
    let range = |k: usize| k.saturating_sub(1)..=k + 1;
    let shares = range(ir).flat_map(|ir| range(iz).map(move |iz| map.unrestricted_at(ir, iz)));
    let least = shares.filter(|share| *share > 0.0).min_by(f64::total_cmp);
    least.unwrap_or(0.0)
}

/// Width and height of a panel, points, with equal scales on both axes.
fn panel_size(sections: &Sections) -> [f64; 2] {
    let extent = [sections.reach, sections.z[1] - sections.z[0]];
    let scale = (MOST[0] / extent[0]).min(MOST[1] / extent[1]);
    extent.map(|length| length * scale)
}

/// The cells within the outline, and the outline.
pub(super) fn draw_cells(
    canvas: &mut Canvas,
    panel: &Panel,
    sections: &Sections,
    value: Value,
    scale: &ShareScale,
) {
    let metres = (panel.x[1] - panel.x[0]) / panel.width;
    let map = sections.map;
    // Means over all azimuths are not taken anew for every pixel.
    let cells = (0..map.radii() * map.heights())
        .map(|cell| value(cell / map.heights(), cell % map.heights()));
    let values: Vec<f64> = cells.collect();
    canvas.picture(
        [panel.left, panel.top],
        [panel.width, panel.height],
        |x, y| {
            let r = (x - panel.left).max(0.0) * metres;
            let z = panel.y[1] - (y - panel.top) * metres;
            let share = map
                .cell([r, 0.0, z])
                .map_or(0.0, |[ir, iz, _]| values[ir * map.heights() + iz]);
            let colour = match sections.outline.contains(r, z) {
                true if share > 0.0 => scale.colour(share),
                true => REACHABLE,
                false => return [255; 3],
            };
            [colour.0, colour.1, colour.2]
        },
    );
    for curve in sections.outline.curves() {
        for part in right_of_axis(&curve) {
            canvas.stroke(&panel.path(&part), 0.6, GREY);
        }
    }
}

/// The axes of a half-plane with their names.
pub(super) fn draw_axes(canvas: &mut Canvas, panel: &Panel, [x_label, y_label]: [&str; 2]) {
    let x_ticks = ticks::round(
        panel.x[0],
        panel.x[1],
        (panel.width / 28.0).max(2.0) as usize,
    );
    let y_ticks = ticks::round(
        panel.y[0],
        panel.y[1],
        (panel.height / 28.0).max(2.0) as usize,
    );
    panel.axes(canvas, &x_ticks, &y_ticks, true);
    panel.x_label(canvas, x_label);
    panel.y_label(canvas, y_label, &y_ticks);
}

/// The parts of a curve with r ≥ 0.
fn right_of_axis(curve: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let mut parts = vec![Vec::new()];
    for pair in curve.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let t = a[0] / (a[0] - b[0]);
        let crossing = [0.0, a[1] + t * (b[1] - a[1])];
        let part = parts.last_mut().expect("never empty");
        match (a[0] >= 0.0, b[0] >= 0.0) {
            (true, true) => part.extend([a, b]),
            (true, false) => part.extend([a, crossing]),
            (false, true) => parts.push(vec![crossing, b]),
            (false, false) => {}
        }
    }
    parts
}
