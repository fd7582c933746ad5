//! Self-motion manifolds as curves in the space of three joints [S4 Fig. 2a].

use super::axonometry::{Axis, AxisBox, Camera, Point3};
use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::manifold::{CriticalPoint, ManifoldCurve, Piece, is_drawable, pieces, wrapped};
use super::manifold_figure::{
    BOX, COLOURS, Marks, WIDTHS, cross, dot, entries, limit_parts, table,
};
use super::number::joint_symbol;
use super::style::{COLUMN, GREY, GRID, MARGIN, ORANGE, TITLE, WHITE, translucent};
use super::table::Table;
use super::ticks;
use crate::angle::wrap;
use crate::workspace::ArtificialLimits;
use plotters::style::RGBAColor;
use plotters::style::text_anchor::HPos;

/// All self-motion manifolds of one task point seen in three joints.
#[derive(Clone, Debug)]
pub struct ManifoldFigure3d<'a> {
    /// The manifolds.
    pub curves: &'a [ManifoldCurve],
    /// Number of joints of the robot.
    pub joint_count: usize,
    /// Numbers of the joints of the three axes, from 1.
    pub joints: [usize; 3],
    /// Artificial limits, if they are to be shown.
    pub limits: Option<&'a ArtificialLimits>,
    /// Critical points, shown where their joint is an axis.
    pub critical_points: &'a [CriticalPoint],
    /// Configurations at which a manifold enters or leaves the box of limits, radians.
    pub crossings: &'a [Vec<f64>],
    /// Title above the drawing; none if empty.
    pub title: String,
}

/// Columns of the legend.
const COLUMNS: usize = 3;
/// Height of the drawing without title and legend, points.
const HEIGHT: f64 = 196.0;
/// The viewer stands here, radians.
const AZIMUTH: f64 = -0.95;
const ELEVATION: f64 = 0.42;

/// A line is drawn in parts of this length, points, so that a part has one depth.
const PART: f64 = 6.0;
/// Parts overlap by this length, which is more than the rim of a line, points.
const OVERLAP: f64 = 2.0;

/// A short part of a curve or of the edges of the limits.
struct Stroke {
    depth: f64,
    /// On the sheet, with the overlap at both ends.
    path: Vec<Point>,
    width: f64,
    colour: RGBAColor,
    /// The part that is set off from what it passes in front of; not the ends of a line, which
    /// another one may go on.
    rim: Vec<Point>,
}

impl Figure for ManifoldFigure3d<'_> {
    fn name(&self) -> &'static str {
        "manifolds_3d"
    }

    fn caption(&self) -> String {
        let [a, b, c] = self.joints.map(joint_symbol);
        let limits = match self.limits {
            Some(_) => {
                " Orange: the box of artificial limits, that of joint 1 released; lines are thick \
                 where all joints from the second on are within them."
            }
            None => "",
        };
        let critical = match self.critical_points.is_empty() {
            true => "",
            false => " Dots: critical points of these joints.",
        };
        let crossings = match self.crossings.is_empty() {
            true => "",
            false => {
                " Crosses: where a manifold enters or leaves the box of all limits but joint 1's."
            }
        };
        format!(
            "Self-motion manifolds in the space of {a}, {b} and {c}, with their shadows on the \
             floor.{limits}{critical}{crossings}"
        )
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: self.head() + HEIGHT,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * COLUMN, 12.0], COLUMN - 2.0 * MARGIN);
        self.draw_legend(canvas);
        let scene = AxisBox::fitting(
            Camera::new(AZIMUTH, ELEVATION),
            [[-180.0; 3], [180.0; 3]],
            [0.0, self.head()],
            [COLUMN, HEIGHT - 4.0],
        );
        let names = self
            .joints
            .map(|joint| format!("{} (deg)", joint_symbol(joint)));
        let axes = names.each_ref().map(|label| Axis {
            label,
            ticks: ticks::quarters(),
        });
        for line in scene.back(&axes) {
            canvas.stroke(&line.map(|p| scene.at(p)), 0.4, GRID);
        }
        let cut = self.cut();
        self.draw_shadows(canvas, &scene, &cut);
        self.draw_strokes(canvas, &scene, &cut);
        self.draw_marks(canvas, &scene);
        scene.draw_axes(canvas, &axes);
    }

    fn table(&self) -> Table {
        table(
            self.curves,
            self.critical_points,
            self.crossings,
            self.joint_count,
        )
    }
}

impl ManifoldFigure3d<'_> {
    /// Indices of the joints, none if the robot has no such joint.
    fn indices(&self) -> Option<[usize; 3]> {
        let exist = self
            .joints
            .iter()
            .all(|joint| (1..=self.joint_count).contains(joint));
        exist.then(|| self.joints.map(|joint| joint - 1))
    }

    fn cut(&self) -> Vec<Vec<Piece>> {
        if self.indices().is_none() {
            return Vec::new();
        }
        let cut = |curve| pieces(curve, self.joint_count, self.limits);
        self.curves.iter().map(cut).collect()
    }

    fn entries(&self) -> Vec<(Swatch, String)> {
        let marks = Marks {
            limits: self.limits,
            critical_points: self.critical_points,
            crossings: self.crossings,
        };
        entries(self.curves.len(), &marks)
    }

    /// Height of title and legend, points.
    fn head(&self) -> f64 {
        let title = if self.title.is_empty() { 0.0 } else { 14.0 };
        title + self.entries().len().div_ceil(COLUMNS) as f64 * LEGEND_ROW + MARGIN
    }

    fn draw_legend(&self, canvas: &mut Canvas) {
        let entries = self.entries();
        let entries: Vec<(Swatch, &str)> = entries
            .iter()
            .map(|(swatch, text)| (*swatch, text.as_str()))
            .collect();
        let rows = entries.len().div_ceil(COLUMNS) as f64;
        let top = self.head() - (rows - 0.5) * LEGEND_ROW - 1.0;
        legend(
            canvas,
            [MARGIN + 4.0, top],
            COLUMN - 2.0 * MARGIN - 4.0,
            COLUMNS,
            &entries,
        );
    }

    fn draw_shadows(&self, canvas: &mut Canvas, scene: &AxisBox, cut: &[Vec<Piece>]) {
        let floor = |[a, b, _]: Point3| scene.at([a, b, -180.0]);
        for [low, high] in self.boxes() {
            let corners = [low, [high[0], low[1], 0.0], high, [low[0], high[1], 0.0]];
            canvas.fill(&corners.map(floor), BOX);
        }
        for line in cut.iter().flatten().flat_map(|piece| self.lines(piece)) {
            let line: Vec<_> = line.into_iter().map(floor).collect();
            canvas.stroke(&line, 0.5, translucent(GREY, 0.55));
        }
    }

    /// The lines of a piece within the box of the drawing, degrees.
    fn lines(&self, piece: &Piece) -> Vec<Vec<Point3>> {
        let joints = self.indices();
        joints.map_or(Vec::new(), |joints| wrapped(&piece.points, joints))
    }

    /// The boxes of limits, degrees; several where limits pass ±180°.
    fn boxes(&self) -> Vec<[Point3; 2]> {
        let Some(joints) = self.indices() else {
            return Vec::new();
        };
        let ranges = joints.map(|joint| match (joint, self.limits) {
            (_, None) => Vec::new(),
            (0, _) => vec![[-180.0, 180.0]],
            _ => limit_parts(self.limits, joint),
        });
        let mut boxes = Vec::new();
        for a in &ranges[0] {
            for b in &ranges[1] {
                for c in &ranges[2] {
                    boxes.push([[a[0], b[0], c[0]], [a[1], b[1], c[1]]]);
                }
            }
        }
        boxes
    }

    /// Curves and the edges of the limits from back to front, each set off from what is behind.
    fn draw_strokes(&self, canvas: &mut Canvas, scene: &AxisBox, cut: &[Vec<Piece>]) {
        let mut strokes = Vec::new();
        for edge in self.boxes().iter().flat_map(|range| scene.edges(*range)) {
            let parts = parts(scene, &edge, 0.6, ORANGE);
            strokes.extend(parts.into_iter().map(|part| Stroke {
                rim: Vec::new(),
                ..part
            }));
        }
        for (k, pieces) in cut.iter().enumerate() {
            for piece in pieces {
                let width = WIDTHS[usize::from(piece.is_inside)];
                for line in self.lines(piece) {
                    strokes.extend(parts(scene, &line, width, COLOURS[k % COLOURS.len()]));
                }
            }
        }
        strokes.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        for stroke in strokes {
            canvas.stroke(&stroke.rim, stroke.width + 1.2, WHITE);
            canvas.stroke(&stroke.path, stroke.width, stroke.colour);
        }
    }

    fn draw_marks(&self, canvas: &mut Canvas, scene: &AxisBox) {
        let Some(joints) = self.indices() else {
            return;
        };
        let at = |q: &[f64]| scene.at(joints.map(|joint| wrap(q[joint]).to_degrees()));
        for point in self.critical_points {
            let is_shown = self.joints.contains(&point.joint);
            if is_shown && is_drawable(&point.configuration, self.joint_count) {
                dot(canvas, at(&point.configuration), 0.75);
            }
        }
        for q in self
            .crossings
            .iter()
            .filter(|q| is_drawable(q, self.joint_count))
        {
            cross(canvas, at(q));
        }
    }
}

/// A line in space as short overlapping parts.
fn parts(scene: &AxisBox, line: &[Point3], width: f64, colour: RGBAColor) -> Vec<Stroke> {
    let sheet: Vec<Point> = line.iter().map(|p| scene.at(*p)).collect();
    let mut along = vec![0.0];
    for pair in sheet.windows(2) {
        let step = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
        along.push(along[along.len() - 1] + step);
    }
    let length = along[along.len() - 1];
    let count = (length / PART).ceil().clamp(1.0, 2e3) as usize;
    let part = |k: usize| {
        let [from, to] = [k, k + 1].map(|k| length * k as f64 / count as f64);
        let middle = at_length(&along, 0.5 * (from + to));
        Stroke {
            depth: scene.depth(between(line, middle)),
            path: path(&sheet, &along, [from - OVERLAP, to + OVERLAP]),
            width,
            colour,
            rim: path(
                &sheet,
                &along,
                [from.max(OVERLAP), to.min(length - OVERLAP)],
            ),
        }
    };
    (0..count).map(part).collect()
}

/// Index of the segment at a length along the path and the share of the segment before it.
fn at_length(along: &[f64], length: f64) -> (usize, f64) {
    let last = along.len().saturating_sub(2);
    let k = along
        .partition_point(|a| *a <= length)
        .saturating_sub(1)
        .min(last);
    let step = along[k + 1] - along[k];
    let share = if step > 0.0 {
        (length - along[k]) / step
    } else {
        0.0
    };
    (k, share.clamp(0.0, 1.0))
}

fn between<const N: usize>(points: &[[f64; N]], (k, t): (usize, f64)) -> [f64; N] {
    std::array::from_fn(|c| points[k][c] + t * (points[k + 1][c] - points[k][c]))
}

/// The part of a path between two lengths.
fn path(sheet: &[Point], along: &[f64], [from, to]: [f64; 2]) -> Vec<Point> {
    if from > to {
        return Vec::new();
    }
    let (start, end) = (at_length(along, from), at_length(along, to));
    let mut points = vec![between(sheet, start)];
    points.extend(&sheet[start.0 + 1..=end.0]);
    points.push(between(sheet, end));
    points
}
