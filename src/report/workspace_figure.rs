//! The fault-tolerant workspace seen from above, with the arm and its limits [S3 Fig. 5–8,
//! S4 Fig. 3b].

use super::arm::Arm;
use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::panel::{BOTTOM, LEFT, Panel};
use super::ring_picture;
use super::shares;
use super::style::{
    COLUMN, GREY, INK, MARGIN, ORANGE, PALE, SKY, TITLE, VERMILLION, WHITE, translucent,
};
use super::table::{Table, cell};
use super::ticks;
use crate::workspace::{ArtificialLimits, ShareMap, WorkspaceMap};
use plotters::style::RGBAColor;
use plotters::style::text_anchor::HPos;

/// Space right of the plot for the colour bar of a pose task, points.
const BAR: f64 = 47.0;

/// A planar robot's workspace map with the robot on it.
#[derive(Clone, Debug)]
pub struct WorkspaceFigure<'a> {
    /// The map to draw, metres.
    pub map: &'a WorkspaceMap,
    /// Artificial limits, drawn at the joints.
    pub limits: &'a ArtificialLimits,
    /// Lengths of the links, metres.
    pub links: &'a [f64],
    /// Joint angles at which the arm is drawn, radians.
    pub arm_angles: Vec<f64>,
    /// Title above the plot; none if empty.
    pub title: String,
}

impl Figure for WorkspaceFigure<'_> {
    fn name(&self) -> &'static str {
        "workspace"
    }

    fn caption(&self) -> String {
        let what = match self.map {
            WorkspaceMap::Rings(_) => {
                "Fault-tolerant workspace W_F (blue) within the unrestricted workspace (grey)"
            }
            WorkspaceMap::Shares(_) => {
                "Share of tool orientations that are fault tolerant at every tool position (colour) \
                 within the unrestricted workspace (grey)"
            }
        };
        format!(
            "{what}, seen from above. The wedges show the artificial joint limits, each about the \
             direction of the previous link."
        )
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: self.head() + self.side() + BOTTOM,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * COLUMN, 10.0], COLUMN - 2.0 * MARGIN);
        let top = self.head() - 1.5 * LEGEND_ROW - 4.0;
        let entries = self.legend_entries();
        legend(canvas, [14.0, top], COLUMN - 14.0 - MARGIN, 2, &entries);
        self.draw_in(canvas, [LEFT, self.head()], self.side(), self.reach());
    }

    fn table(&self) -> Table {
        match self.map {
            WorkspaceMap::Rings(map) => ring_picture::table(map),
            WorkspaceMap::Shares(map) => share_table(map),
        }
    }
}

impl WorkspaceFigure<'_> {
    /// Whether no point is fault tolerant.
    fn is_empty(&self) -> bool {
        match self.map {
            WorkspaceMap::Rings(map) => map.rings.iter().all(|ring| ring.rotation_set.is_empty()),
            WorkspaceMap::Shares(map) => !map.share.iter().any(|share| *share > 0.0),
        }
    }

    /// The workspace and the arm in a square of `side` points, axes beside it to ±`reach` metres, and
    /// a colour bar to the right where colours tell shares.
    pub(super) fn draw_in(&self, canvas: &mut Canvas, [left, top]: Point, side: f64, reach: f64) {
        let panel = Panel {
            left,
            top,
            width: side,
            height: side,
            x: [-reach, reach],
            y: [-reach, reach],
        };
        match self.map {
            WorkspaceMap::Rings(map) => ring_picture::draw(canvas, &panel, map),
            WorkspaceMap::Shares(map) => draw_shares(canvas, &panel, map),
        }
        if self.is_empty() {
            panel.remark(canvas, "W_F is empty");
        }
        let arm = Arm::new(self.links, &self.arm_angles);
        arm.draw(canvas, &panel, self.limits, self.wedge());
        let ticks = ticks::round(-reach, reach, 5);
        panel.axes(canvas, &ticks, &ticks, true);
        panel.x_label(canvas, "x (m)");
        panel.y_label(canvas, "y (m)", &ticks);
    }

    /// Space right of the plot, points.
    pub(super) fn right(&self) -> f64 {
        match self.map {
            WorkspaceMap::Rings(_) => MARGIN + 2.0,
            WorkspaceMap::Shares(_) => BAR,
        }
    }

    /// Side of the square plot, points.
    fn side(&self) -> f64 {
        COLUMN - LEFT - self.right()
    }

    /// Height of title and legend above the plot, points.
    fn head(&self) -> f64 {
        let title = if self.title.is_empty() { 0.0 } else { 12.0 };
        title + 2.0 * LEGEND_ROW + MARGIN + 2.0
    }

    /// Half the side of the plot, metres.
    pub(super) fn reach(&self) -> f64 {
        let [_, outer] = match self.map {
            WorkspaceMap::Rings(map) => map.unrestricted,
            WorkspaceMap::Shares(map) => map.unrestricted,
        };
        let links: f64 = self.links.iter().map(|link| link.abs()).sum();
        let reach = [outer, links].into_iter().filter(|r| r.is_finite());
        let reach = 1.05 * reach.fold(0.0, f64::max);
        if reach > 0.0 { reach } else { 1.0 }
    }

    /// Colour of the limits' wedges, visible on the map's colours.
    fn wedge(&self) -> RGBAColor {
        match self.map {
            WorkspaceMap::Rings(_) => translucent(ORANGE, 0.45),
            WorkspaceMap::Shares(_) => translucent(WHITE, 0.6),
        }
    }

    /// What the legend tells.
    pub(super) fn legend_entries(&self) -> Vec<(Swatch, &'static str)> {
        let mut entries = vec![
            (Swatch::Area(PALE, GREY), "unrestricted workspace"),
            (Swatch::Arm(INK), "arm"),
            (
                Swatch::Area(self.wedge(), VERMILLION),
                "artificial joint limits",
            ),
        ];
        if let WorkspaceMap::Rings(_) = self.map {
            entries.insert(0, (Swatch::Area(SKY, SKY), "fault-tolerant workspace W_F"));
            entries.swap(1, 2);
        }
        entries
    }
}

/// All cells as one picture.
fn draw_shares(canvas: &mut Canvas, panel: &Panel, map: &ShareMap) {
    let scale = (panel.x[1] - panel.x[0]) / panel.width;
    let corner = [panel.left, panel.top];
    canvas.picture(corner, [panel.width, panel.height], |x, y| {
        let x = panel.x[0] + (x - panel.left) * scale;
        let y = panel.y[1] - (y - panel.top) * scale;
        shares::colour_at(map, x, y)
    });
    ring_picture::draw_circles(canvas, panel, map.unrestricted);
    shares::colour_bar(
        canvas,
        [panel.left + panel.width + 6.0, panel.top],
        panel.height,
    );
}

/// One row per cell.
fn share_table(map: &ShareMap) -> Table {
    let columns = [
        "radius_inner_m",
        "radius_outer_m",
        "beta_lower_deg",
        "beta_upper_deg",
        "share",
    ];
    let mut table = Table::new(&columns);
    let step = 360.0 / map.angles.max(1) as f64;
    for (edges, row) in map
        .radius_edges
        .windows(2)
        .zip(map.share.chunks(map.angles.max(1)))
    {
        for (k, share) in row.iter().enumerate() {
            let start = -180.0 + step * k as f64;
            let numbers = [
                edges[0],
                edges[1],
                start,
                -180.0 + step * (k + 1) as f64,
                *share,
            ];
            table.rows.push(numbers.map(cell).to_vec());
        }
    }
    table
}
