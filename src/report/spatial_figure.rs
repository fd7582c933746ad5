//! The fault-tolerant workspace of a spatial task in cross-sections [S4 Fig. 3–6].

use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, dashed, legend};
use super::number::rounded;
use super::panel::{BOTTOM, LEFT, Panel};
use super::section_view::SectionView;
use super::sections::{Layer, Plane, Sections};
use super::style::{DOUBLE_COLUMN, GREY, INK, MARGIN, REACHABLE, SMALL, TITLE};
use super::table::{Table, cell};
use super::ticks;
use crate::workspace::SpatialShareMap;
use plotters::style::text_anchor::HPos;

/// Three cross-sections of a spatial workspace, in space and flat.
#[derive(Clone, Debug)]
pub struct SpatialWorkspaceFigure<'a> {
    /// The map to draw.
    pub map: &'a SpatialShareMap,
    /// Title above the panels; none if empty.
    pub title: String,
}

/// Space above a panel for its title, points.
pub(super) const PANEL_TITLE: f64 = 13.0;

/// Places of the four panels, points.
struct Layout {
    /// Width of the flat panels and heights of the two rows.
    width: f64,
    heights: [f64; 2],
    /// Left edges of the two columns of flat panels.
    left: [f64; 2],
    top: [f64; 2],
    /// Where the colour bar starts.
    bar: f64,
}

impl Figure for SpatialWorkspaceFigure<'_> {
    fn name(&self) -> &'static str {
        "workspace_spatial"
    }

    fn caption(&self) -> String {
        let sections = Sections::new(self.map);
        let what = match self.map.orientations {
            true => "Share of tool orientations that are fault tolerant",
            false => "Fault-tolerant workspace, as the share of every cell that is in it",
        };
        format!(
            "{what} (colour) within the unrestricted workspace (grey) of a spatial task. \
             (a) Three cross-sections in space, the front quarter of the horizontal one cut away (colours \
             behind grey look paler); \
             (b) the horizontal section at z = {} m, where the fault-tolerant workspace is \
             largest; (c, d) sections through the axis of joint 1, the z axis.",
            rounded(sections.height, -2)
        )
    }

    fn size(&self) -> Size {
        let layout = self.layout(&Sections::new(self.map));
        Size {
            width: DOUBLE_COLUMN,
            height: layout.top[1] + layout.heights[1] + BOTTOM + 2.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let sections = Sections::new(self.map);
        let layout = self.layout(&sections);
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        let middle = 0.5 * DOUBLE_COLUMN;
        title.draw_within(canvas, [middle, 12.0], DOUBLE_COLUMN - 2.0 * MARGIN);
        self.draw_legend(canvas);
        self.draw_view(canvas, &sections, &layout);
        let [horizontal, xz, yz] = sections.planes();
        let height = rounded(sections.height, -2);
        let name = format!("(b) x–y section, z = {height} m");
        draw_flat(
            canvas,
            &sections,
            horizontal,
            &layout.panel(&sections, 1, 0),
            &name,
        );
        let names = ["(c) x–z section, y = 0", "(d) y–z section, x = 0"];
        draw_flat(
            canvas,
            &sections,
            xz,
            &layout.panel(&sections, 0, 1),
            names[0],
        );
        draw_flat(
            canvas,
            &sections,
            yz,
            &layout.panel(&sections, 1, 1),
            names[1],
        );
        let bottom = layout.top[1] + layout.heights[1];
        sections.scale.draw_bar(
            canvas,
            [layout.bar, layout.top[0]],
            bottom - layout.top[0],
            bar_label(self.map.orientations),
        );
    }

    fn table(&self) -> Table {
        let columns = ["section", "x_m", "y_m", "z_m", "share", "unrestricted"];
        let mut table = Table::new(&columns);
        let map = self.map;
        let cells = |iz: usize, k: usize| (0..map.radii()).map(move |ir| [ir, iz, k]);
        let (layer, last) = (Sections::new(map).layer, map.azimuths.saturating_sub(1));
        for k in (0..map.azimuths).filter(|_| map.azimuths > 0) {
            for at in layer.into_iter().flat_map(|iz| cells(iz, k)) {
                push(&mut table, map, "xy", at, map.azimuth(k));
            }
        }
        let quarter = std::f64::consts::FRAC_PI_2;
        for (section, start) in [("xz", 0.0), ("yz", quarter)] {
            for azimuth in [start, start - 2.0 * quarter] {
                let around = (azimuth + 2.0 * quarter) / (4.0 * quarter) * map.azimuths as f64;
                let k = (around as usize).min(last);
                for at in (0..map.heights()).flat_map(|iz| cells(iz, k)) {
                    push(&mut table, map, section, at, azimuth);
                }
            }
        }
        table
    }
}

/// A row for a cell in which there is something, its middle turned to `azimuth`.
fn push(
    table: &mut Table,
    map: &SpatialShareMap,
    section: &str,
    [ir, iz, k]: [usize; 3],
    azimuth: f64,
) {
    let shares = [map.share_at(ir, iz, k), map.unrestricted_at(ir, iz)];
    if shares.iter().any(|share| *share > 0.0) {
        let r = map.radius(ir);
        // Rounded to 1e-12 m: cos 90° is not exactly 0.
        let place = [r * azimuth.cos(), r * azimuth.sin(), map.height(iz)];
        let place = place.map(|c| cell((c * 1e12).round() / 1e12));
        let mut row = vec![section.to_string()];
        row.extend(place);
        row.extend(shares.map(cell));
        table.rows.push(row);
    }
}

/// What a colour bar of fault-tolerant shares says.
pub(super) fn bar_label(orientations: bool) -> &'static str {
    match orientations {
        true => "fault-tolerant orientations (%)",
        false => "fault-tolerant share of the cell (%)",
    }
}

impl SpatialWorkspaceFigure<'_> {
    /// Height of title and legend, points.
    fn head(&self) -> f64 {
        let title = if self.title.is_empty() { 0.0 } else { 12.0 };
        title + LEGEND_ROW + MARGIN + 2.0
    }

    fn layout(&self, sections: &Sections) -> Layout {
        let bar = DOUBLE_COLUMN - MARGIN - sections.scale.bar_width();
        let room = 0.5 * (bar - 8.0 - 2.0 * LEFT - 6.0);
        let (across, up) = (2.0 * sections.reach, sections.z[1] - sections.z[0]);
        let scale = (room / across).min(1.25 * room / up);
        let width = scale * across;
        let heights = [width, scale * up];
        let top = self.head() + PANEL_TITLE;
        let spare = 0.5 * (room - width);
        // The view in space needs some height even where the sections are narrow.
        let first = heights[0].max(0.8 * room);
        Layout {
            width,
            heights,
            left: [LEFT + spare, 2.0 * LEFT + 6.0 + room + spare],
            top: [top, top + first + BOTTOM + PANEL_TITLE + 4.0],
            bar,
        }
    }

    fn draw_legend(&self, canvas: &mut Canvas) {
        let entries = [
            (Swatch::Area(REACHABLE, GREY), "unrestricted workspace"),
            (Swatch::Dashed(INK), "plane of section (b)"),
        ];
        let at = [LEFT, self.head() - LEGEND_ROW + 1.0];
        legend(canvas, at, 250.0, 2, &entries);
    }

    fn draw_view(&self, canvas: &mut Canvas, sections: &Sections, layout: &Layout) {
        panel_title(canvas, [LEFT, layout.top[0]], "(a) sections in space");
        let right = layout.left[1] - LEFT - 4.0;
        let corner = [MARGIN, layout.top[0]];
        let size = [
            right - MARGIN,
            layout.top[1] - PANEL_TITLE - 6.0 - layout.top[0],
        ];
        SectionView::new(sections, corner, size).draw(canvas);
    }
}

impl Layout {
    fn panel(&self, sections: &Sections, column: usize, row: usize) -> Panel {
        let reach = [-sections.reach, sections.reach];
        Panel {
            left: self.left[column],
            top: self.top[row],
            width: self.width,
            height: self.heights[row],
            x: reach,
            y: if row == 0 { reach } else { sections.z },
        }
    }
}

/// A title above a panel whose left upper corner is at `corner`.
pub(super) fn panel_title(canvas: &mut Canvas, corner: Point, text: &str) {
    let at = [corner[0], corner[1] - 5.0];
    Label::new(text, SMALL).bold().draw(canvas, at);
}

/// One section with its axes.
fn draw_flat(canvas: &mut Canvas, sections: &Sections, plane: Plane, panel: &Panel, name: &str) {
    panel_title(canvas, [panel.left, panel.top], name);
    let scale = (panel.x[1] - panel.x[0]) / panel.width;
    canvas.picture(
        [panel.left, panel.top],
        [panel.width, panel.height],
        |x, y| {
            let right = panel.x[0] + (x - panel.left) * scale;
            let up = panel.y[1] - (y - panel.top) * scale;
            let colour = match sections.layer_at(plane.lift([right, up])) {
                Layer::Outside => return [255; 3],
                Layer::Reachable => REACHABLE,
                Layer::Share(share) => sections.scale.colour(share),
            };
            [colour.0, colour.1, colour.2]
        },
    );
    for curve in sections.curves(plane) {
        canvas.stroke(&panel.path(&curve), 0.6, GREY);
    }
    if plane.axis != 2 {
        let ends = panel.x.map(|x| panel.at(x, sections.height));
        dashed(canvas, ends[0], ends[1], 0.5, INK);
    }
    if sections.is_empty() {
        panel.remark(canvas, "W_F is empty");
    }
    let count = |length: f64| (length / 36.0).round().max(2.0) as usize;
    let x_ticks = ticks::round(panel.x[0], panel.x[1], count(panel.width));
    let y_ticks = ticks::round(panel.y[0], panel.y[1], count(panel.height));
    panel.axes(canvas, &x_ticks, &y_ticks, true);
    let labels = ["x (m)", "y (m)", "z (m)"];
    let [right, up] = plane.across();
    panel.x_label(canvas, labels[right]);
    panel.y_label(canvas, labels[up], &y_ticks);
}
