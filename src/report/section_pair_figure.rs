//! The workspaces of two robots in the half-plane that joint 1's axis bounds, in units of each
//! robot's reach and in the same colours.

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::half_plane_figure::{draw_axes, draw_cells};
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::panel::{BOTTOM, LEFT, Panel};
use super::sections::Sections;
use super::share_scale::{Palette, ShareScale};
use super::style::{COLUMN, DOUBLE_COLUMN, GREY, MARGIN, NORMAL, REACHABLE};
use super::table::{Table, cell};
use crate::workspace::SpatialShareMap;

/// Where the fault-tolerant workspaces of two robots lie.
#[derive(Clone, Debug)]
pub struct SectionPairFigure<'a> {
    /// What is shown of each robot, left and right.
    pub robots: [SectionOf<'a>; 2],
}

/// The workspace of one of two robots.
#[derive(Clone, Debug)]
pub struct SectionOf<'a> {
    /// Title above the panel, as in "found: 18.7 %".
    pub title: String,
    /// Where its workspace lies.
    pub map: &'a SpatialShareMap,
    /// Reach of the robot, metres: the unit of the axes.
    pub reach: f64,
}

/// Greatest width and height of a panel, points.
const MOST: [f64; 2] = [185.0, 230.0];
/// Height above the panels, points.
const HEAD: f64 = MARGIN + LEGEND_ROW + 17.0;

impl SectionOf<'_> {
    /// The map with lengths in units of the reach.
    fn scaled(&self) -> SpatialShareMap {
        let is_length = self.reach.is_finite() && self.reach > 0.0;
        let unit = if is_length { self.reach } else { 1.0 };
        let scaled = |edges: &[f64]| edges.iter().map(|edge| edge / unit).collect();
        SpatialShareMap {
            radius_edges: scaled(&self.map.radius_edges),
            height_edges: scaled(&self.map.height_edges),
            ..self.map.clone()
        }
    }
}

/// Both maps made ready, and the panel that shows either.
struct Layout<'m> {
    sections: [Sections<'m>; 2],
    scale: ShareScale,
    panel: Panel,
    width: f64,
}

impl<'m> Layout<'m> {
    fn new(maps: &'m [SpatialShareMap; 2]) -> Layout<'m> {
        let sections = maps.each_ref().map(Sections::new);
        let [a, b] = &sections;
        let x = [0.0, a.reach.max(b.reach)];
        let z = [a.z[0].min(b.z[0]), a.z[1].max(b.z[1])];
        let points = (MOST[0] / x[1]).min(MOST[1] / (z[1] - z[0]));
        let mean = |map: &SpatialShareMap, ir: usize| {
            (0..map.heights())
                .map(|iz| map.mean(ir, iz))
                .fold(0.0, f64::max)
        };
        let most =
            |map: &SpatialShareMap| (0..map.radii()).map(|ir| mean(map, ir)).fold(0.0, f64::max);
        let most = maps.iter().map(most).fold(0.0, f64::max);
        let scale = ShareScale::fitting(most, Palette::of(&maps[0]));
        let panel = Panel {
            left: LEFT,
            top: HEAD,
            width: points * x[1],
            height: points * (z[1] - z[0]),
            x,
            y: z,
        };
        let width = 2.0 * (LEFT + panel.width + 8.0) + scale.bar_width() + MARGIN;
        Layout {
            sections,
            scale,
            panel,
            width: width.clamp(COLUMN, DOUBLE_COLUMN),
        }
    }
}

impl SectionPairFigure<'_> {
    fn maps(&self) -> [SpatialShareMap; 2] {
        self.robots.each_ref().map(SectionOf::scaled)
    }

    fn has_orientations(&self) -> bool {
        self.robots[0].map.orientations
    }
}

impl Figure for SectionPairFigure<'_> {
    fn name(&self) -> &str {
        "sections"
    }

    fn caption(&self) -> String {
        let what = match self.has_orientations() {
            true => "share of fault-tolerant orientations, mean over the azimuth",
            false => "share of the azimuth that is fault tolerant",
        };
        let [left, right] = self.robots.each_ref().map(|robot| &robot.title);
        format!(
            "Colours: {what}, by distance r from the axis of joint 1 and height z, both in units of \
             the robot's reach R. Grey: reachable with all joints free, not fault tolerant. \
             (a) {left}; (b) {right}."
        )
    }

    fn size(&self) -> Size {
        let maps = self.maps();
        let layout = Layout::new(&maps);
        Size {
            width: layout.width,
            height: HEAD + layout.panel.height + BOTTOM + 2.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let maps = self.maps();
        let layout = Layout::new(&maps);
        let entries = [(
            Swatch::Area(REACHABLE, GREY),
            "reachable, not fault tolerant",
        )];
        legend(canvas, [LEFT, MARGIN + 3.0], 200.0, 1, &entries);
        let mut left = LEFT;
        for (number, sections) in layout.sections.iter().enumerate() {
            let panel = Panel {
                left,
                ..layout.panel
            };
            let letter = ["(a)", "(b)"][number];
            let title = self.robots[number].title.replace('_', "-");
            let title = format!("{letter} {title}");
            let label = Label::new(&title, NORMAL).bold();
            label.draw_within(canvas, [left, HEAD - 5.0], panel.width + 6.0);
            let share = |ir: usize, iz: usize| sections.map.mean(ir, iz);
            draw_cells(canvas, &panel, sections, &share, &layout.scale);
            draw_axes(canvas, &panel, ["r / R", "z / R"]);
            if sections.is_empty() {
                panel.remark(canvas, "W_F is empty");
            }
            left += panel.width + 8.0 + LEFT;
        }
        let text = match self.has_orientations() {
            true => "fault-tolerant orientations (%)",
            false => "fault-tolerant share (%)",
        };
        let corner = [left - LEFT, HEAD];
        layout
            .scale
            .draw_bar(canvas, corner, layout.panel.height, text);
    }

    fn table(&self) -> Table {
        let columns = [
            "robot",
            "radius_inner_reaches",
            "radius_outer_reaches",
            "height_lower_reaches",
            "height_upper_reaches",
            "share_mean",
            "unrestricted",
        ];
        let mut table = Table::new(&columns);
        for (robot, map) in self.robots.iter().zip(self.maps()) {
            for (ir, r) in map.radius_edges.windows(2).enumerate() {
                for (iz, z) in map.height_edges.windows(2).enumerate() {
                    let shares = [map.mean(ir, iz), map.unrestricted_at(ir, iz)];
                    if shares.iter().any(|share| *share > 0.0) {
                        let numbers = [r[0], r[1], z[0], z[1], shares[0], shares[1]];
                        let mut row = vec![robot.title.clone()];
                        row.extend(numbers.map(cell));
                        table.rows.push(row);
                    }
                }
            }
        }
        table
    }
}
