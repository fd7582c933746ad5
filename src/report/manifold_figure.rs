//! Self-motion manifolds: every joint's angle against the first one's, and the ranges of all
//! joints [S4 Fig. 2].

use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::joint_bars;
use super::label::{LEGEND_ROW, Label, Swatch, legend, rectangle};
use super::manifold::{CriticalPoint, ManifoldCurve, Piece, is_drawable, pieces, wrapped};
use super::number::joint_symbol;
use super::panel::{BOTTOM, Panel};
use super::style::{
    BLUE, DOUBLE_COLUMN, GREEN, INK, MARGIN, ORANGE, PURPLE, SKY, SMALL, TITLE, VERMILLION, WHITE,
    translucent,
};
use super::table::{Table, cell};
use super::ticks;
use crate::angle::{AngleSet, Arc, wrap};
use crate::workspace::ArtificialLimits;
use plotters::style::RGBAColor;
use plotters::style::text_anchor::HPos;

/// Projections of all self-motion manifolds of one task point.
#[derive(Clone, Debug)]
pub struct ManifoldFigure<'a> {
    /// The manifolds.
    pub curves: &'a [ManifoldCurve],
    /// For every joint the angles that occur on any manifold.
    pub joint_ranges: &'a [AngleSet],
    /// Artificial limits, if they are to be shown.
    pub limits: Option<&'a ArtificialLimits>,
    /// Critical points, shown where their joint or joint 1 is an axis.
    pub critical_points: &'a [CriticalPoint],
    /// Configurations at which a manifold enters or leaves the box of limits, radians.
    pub crossings: &'a [Vec<f64>],
    /// Whether the curves are slices of one surface: then they have one colour and no names.
    pub are_slices: bool,
    /// Title above the panels; none if empty.
    pub title: String,
}

/// Colours of the first, second … manifold.
pub(super) const COLOURS: [RGBAColor; 6] = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY];
/// The legend names no more manifolds than these.
pub(super) const NAMED: usize = 6;
/// Widths of lines outside and inside the limits, points.
pub(super) const WIDTHS: [f64; 2] = [0.7, 1.9];
/// Colour of the artificial limits.
pub(super) const BOX: RGBAColor = translucent(ORANGE, 0.25);

/// Space between panels, points.
const GAP: f64 = 24.0;
/// Space above a panel for its title, points.
const HEAD: f64 = 18.0;
/// Space left of the panels, points.
pub(super) const SIDE: f64 = 40.0;

impl Figure for ManifoldFigure<'_> {
    fn name(&self) -> &'static str {
        if self.are_slices {
            "slices"
        } else {
            "manifolds"
        }
    }

    fn caption(&self) -> String {
        let limits = match self.limits {
            Some(_) => {
                " Shaded: artificial limits, that of joint 1 released; lines are thick where all \
                 joints from the second on are within them."
            }
            None => "",
        };
        let critical = match self.critical_points.is_empty() {
            true => "",
            false => " Dots: critical points of the two joints of a panel.",
        };
        let crossings = match self.crossings.is_empty() {
            true => "",
            false => {
                " Crosses: where a manifold enters or leaves the box of all \
                 limits but joint 1's."
            }
        };
        if self.are_slices {
            return format!(
                "Curves on the surface of all configurations that hold the pose, along which some \
                 joints stand still (not its outline; of many, a selection): the angle of every joint against that of \
                 joint 1, and below the range of every joint over the whole surface.{limits}"
            );
        }
        format!(
            "Self-motion manifolds: the angle of every joint against that of joint 1, and below \
             the range of every joint over all manifolds.{limits}{critical}{crossings}"
        )
    }

    fn size(&self) -> Size {
        Size {
            width: DOUBLE_COLUMN,
            height: self.bars_top() + joint_bars::height(self.joint_ranges.len()) + BOTTOM + 2.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        let middle = 0.5 * DOUBLE_COLUMN;
        title.draw_within(canvas, [middle, 12.0], DOUBLE_COLUMN - 2.0 * MARGIN);
        self.draw_legend(canvas);
        let joints = self.joint_ranges.len();
        let cut = |curve| pieces(curve, joints, self.limits);
        let cut: Vec<Vec<Piece>> = self.curves.iter().map(cut).collect();
        for (place, joint) in (1..joints).enumerate() {
            self.draw_panel(canvas, place, joint, &cut);
        }
        let top = self.bars_top();
        let panel = joint_bars::panel(top, joints);
        let over = match self.are_slices {
            true => "the surface",
            false => "all manifolds",
        };
        joint_bars::draw(canvas, &panel, self.joint_ranges, over, self.limits);
    }

    fn table(&self) -> Table {
        table(
            self.curves,
            self.critical_points,
            self.crossings,
            self.joint_ranges.len(),
        )
    }
}

impl ManifoldFigure<'_> {
    /// Number of panels in a row.
    fn columns(&self) -> usize {
        match self.panels() {
            0 | 1 => 1,
            2 => 2,
            3 | 5 | 6 | 9 => 3,
            _ => 4,
        }
    }

    fn panels(&self) -> usize {
        self.joint_ranges.len().saturating_sub(1)
    }

    fn rows(&self) -> usize {
        self.panels().div_ceil(self.columns())
    }

    /// Side of a square panel, points.
    fn side(&self) -> f64 {
        let columns = self.columns() as f64;
        let room = DOUBLE_COLUMN - SIDE - MARGIN - 4.0 - (columns - 1.0) * GAP;
        (room / columns).min(170.0)
    }

    fn entries(&self) -> Vec<(Swatch, String)> {
        let marks = Marks {
            limits: self.limits,
            critical_points: self.critical_points,
            crossings: self.crossings,
        };
        let mut entries = entries(self.curves.len(), &marks);
        if self.are_slices {
            let first_mark = self.curves.len().min(NAMED);
            let first_mark = if self.curves.len() > NAMED {
                1
            } else {
                first_mark
            };
            let curve = (Swatch::Line(COLOURS[0]), "curves on slices".to_owned());
            entries.splice(..first_mark, [curve]);
        }
        entries
    }

    /// Height of title and legend, points.
    fn head(&self) -> f64 {
        let title = if self.title.is_empty() { 0.0 } else { 14.0 };
        let rows = self.entries().len().div_ceil(LEGEND_COLUMNS);
        title + rows as f64 * LEGEND_ROW + MARGIN
    }

    fn bars_top(&self) -> f64 {
        let rows = self.rows() as f64;
        let below = if self.rows() > 0 { BOTTOM + 2.0 } else { 0.0 };
        self.head() + rows * (self.side() + HEAD) + below + HEAD - 2.0
    }

    fn draw_legend(&self, canvas: &mut Canvas) {
        let entries = self.entries();
        let entries: Vec<(Swatch, &str)> = entries
            .iter()
            .map(|(swatch, text)| (*swatch, text.as_str()))
            .collect();
        let rows = entries.len().div_ceil(LEGEND_COLUMNS) as f64;
        let top = self.head() - (rows - 0.5) * LEGEND_ROW + 1.0;
        let width = DOUBLE_COLUMN - SIDE - MARGIN;
        legend(canvas, [SIDE, top], width, LEGEND_COLUMNS, &entries);
    }

    /// The panel of joint `joint` (index) against joint 1.
    fn draw_panel(&self, canvas: &mut Canvas, place: usize, joint: usize, cut: &[Vec<Piece>]) {
        let columns = self.columns();
        let (column, row) = (place % columns, place / columns);
        let side = self.side();
        let panel = Panel {
            left: SIDE + column as f64 * (side + GAP),
            top: self.head() + row as f64 * (side + HEAD) + HEAD,
            width: side,
            height: side,
            x: [-180.0, 180.0],
            y: [-180.0, 180.0],
        };
        let name = format!("{} against {}", joint_symbol(joint + 1), joint_symbol(1));
        Label::new(&name, SMALL)
            .bold()
            .draw(canvas, [panel.left, panel.top - 4.5]);
        let quarters = ticks::quarters();
        panel.grid(canvas, &quarters);
        panel.upright_grid(canvas, &quarters);
        self.draw_box(canvas, &panel, joint);
        draw_lines(canvas, cut, self.are_slices, |points| {
            let lines = wrapped(points, [0, joint]);
            lines.iter().map(|line| panel.path(line)).collect()
        });
        self.draw_marks(canvas, &panel, joint);
        let is_last = place + columns >= self.panels();
        let x_ticks = if is_last {
            quarters.clone()
        } else {
            ticks::unlabelled(&quarters)
        };
        panel.axes(canvas, &x_ticks, &quarters, column == 0);
        if is_last {
            panel.x_label(canvas, &format!("{} (deg)", joint_symbol(1)));
        }
        if column == 0 {
            panel.y_label(canvas, "joint angle (deg)", &quarters);
        }
    }

    fn draw_box(&self, canvas: &mut Canvas, panel: &Panel, joint: usize) {
        for [low, high] in limit_parts(self.limits, joint) {
            let corners = [[-180.0, low], [180.0, low], [180.0, high], [-180.0, high]];
            canvas.fill(&panel.path(&corners), BOX);
        }
    }

    fn draw_marks(&self, canvas: &mut Canvas, panel: &Panel, joint: usize) {
        let joints = self.joint_ranges.len();
        let at = |q: &[f64]| panel.at(wrap(q[0]).to_degrees(), wrap(q[joint]).to_degrees());
        for point in self.critical_points {
            let is_shown = point.joint == 1 || point.joint == joint + 1;
            if is_shown && is_drawable(&point.configuration, joints) {
                dot(canvas, at(&point.configuration), 1.0);
            }
        }
        for configuration in self.crossings.iter().filter(|q| is_drawable(q, joints)) {
            cross(canvas, at(configuration));
        }
    }
}

/// What is marked on the curves.
pub(super) struct Marks<'a> {
    pub limits: Option<&'a ArtificialLimits>,
    pub critical_points: &'a [CriticalPoint],
    pub crossings: &'a [Vec<f64>],
}

/// Columns of the legend.
pub(super) const LEGEND_COLUMNS: usize = 4;

/// The legend of curves and marks.
pub(super) fn entries(curves: usize, marks: &Marks) -> Vec<(Swatch, String)> {
    let mut entries = Vec::new();
    if curves <= NAMED {
        for k in 0..curves {
            entries.push((
                Swatch::Line(COLOURS[k % COLOURS.len()]),
                format!("manifold {}", k + 1),
            ));
        }
    } else {
        let text = format!("{curves} manifolds, six colours");
        entries.push((Swatch::Line(COLOURS[0]), text));
    }
    if marks.limits.is_some() {
        entries.push((Swatch::Area(BOX, ORANGE), "artificial limits".into()));
        entries.push((Swatch::Thick(INK), "within all limits".into()));
    }
    if !marks.critical_points.is_empty() {
        entries.push((Swatch::Dot(INK), "critical point".into()));
    }
    if !marks.crossings.is_empty() {
        entries.push((Swatch::Cross(INK), "crosses limit box".into()));
    }
    entries
}

/// Widths of the lines of slices, which are many, points.
const SLICE_WIDTHS: [f64; 2] = [0.3, 0.9];

/// Draws all curves, the parts within the limits thick and on top; slices in one colour.
pub(super) fn draw_lines(
    canvas: &mut Canvas,
    cut: &[Vec<Piece>],
    are_slices: bool,
    seen: impl Fn(&[Vec<f64>]) -> Vec<Vec<Point>>,
) {
    for is_inside in [false, true] {
        for (k, pieces) in cut.iter().enumerate() {
            let (colour, widths) = match are_slices {
                true => (COLOURS[0], SLICE_WIDTHS),
                false => (COLOURS[k % COLOURS.len()], WIDTHS),
            };
            for piece in pieces.iter().filter(|piece| piece.is_inside == is_inside) {
                for line in seen(&piece.points) {
                    canvas.stroke(&line, widths[usize::from(is_inside)], colour);
                }
            }
        }
    }
}

/// The parts of a joint's limits within [−180, 180] degrees; none if there are no limits.
pub(super) fn limit_parts(limits: Option<&ArtificialLimits>, joint: usize) -> Vec<[f64; 2]> {
    let limit = limits.and_then(|limits| limits.joints().get(joint));
    let finite = limit.filter(|l| l.lower.is_finite() && l.upper.is_finite());
    finite.map_or(Vec::new(), |limit| parts(&limit.arc()))
}

/// The parts of an arc within [−180, 180] degrees.
pub(super) fn parts(arc: &Arc) -> Vec<[f64; 2]> {
    let [start, end] = [arc.start(), arc.end()].map(f64::to_degrees);
    match end > 180.0 {
        true => vec![[start, 180.0], [-180.0, end - 360.0]],
        false => vec![[start, end]],
    }
}

/// A critical point, with the radius of a legend's dot times `scale`.
pub(super) fn dot(canvas: &mut Canvas, at: Point, scale: f64) {
    canvas.disc(at, 2.1 * scale, WHITE);
    canvas.disc(at, 1.5 * scale, INK);
}

/// A point at which a curve enters or leaves the limits.
pub(super) fn cross(canvas: &mut Canvas, [x, y]: Point) {
    for (width, colour) in [(1.9, WHITE), (0.9, INK)] {
        canvas.stroke(&[[x - 2.2, y - 2.2], [x + 2.2, y + 2.2]], width, colour);
        canvas.stroke(&[[x - 2.2, y + 2.2], [x + 2.2, y - 2.2]], width, colour);
    }
}

/// One row per vertex, critical point and crossing, all joint angles in degrees, not wrapped.
pub(super) fn table(
    curves: &[ManifoldCurve],
    critical_points: &[CriticalPoint],
    crossings: &[Vec<f64>],
    joints: usize,
) -> Table {
    let mut header: Vec<String> = ["kind", "number", "vertex"].map(String::from).to_vec();
    header.extend((1..=joints).map(|joint| format!("theta_{joint}_deg")));
    let mut table = Table {
        header,
        rows: Vec::new(),
    };
    let mut push = |kind: &str, number: usize, vertex: Option<usize>, angles: &[f64]| {
        let vertex = vertex.map_or(String::new(), |vertex| vertex.to_string());
        let mut row = vec![kind.to_string(), number.to_string(), vertex];
        let angle = |k| cell(angles.get(k).copied().unwrap_or(f64::NAN).to_degrees());
        row.extend((0..joints).map(angle));
        table.rows.push(row);
    };
    for (k, curve) in curves.iter().enumerate() {
        let kind = if curve.closed {
            "closed curve"
        } else {
            "open curve"
        };
        for (vertex, point) in curve.points.iter().enumerate() {
            push(kind, k + 1, Some(vertex + 1), point);
        }
    }
    for point in critical_points {
        push(
            "critical point of joint",
            point.joint,
            None,
            &point.configuration,
        );
    }
    for (k, configuration) in crossings.iter().enumerate() {
        push("crossing", k + 1, None, configuration);
    }
    table
}

/// The corners of a horizontal bar.
pub(super) fn bar(left: f64, right: f64, top: f64, height: f64) -> [Point; 4] {
    rectangle(left, top, right - left, height)
}
