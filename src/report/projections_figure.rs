//! All self-motion manifolds of one location in the spaces of several triples of joints, coloured by
//! a further joint [S1 Figs. 3–5].

use super::axonometry::{Axis, AxisBox, Camera, Point3};
use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::label::{Label, Swatch, legend, rectangle};
use super::manifold::{ManifoldCurve, is_drawable, pieces, wrapped};
use super::number::joint_symbol;
use super::singularity_figure::loss_colour;
use super::style::{
    DOUBLE_COLUMN, GREY, GRID, HALF_CAPITAL, INK, MARGIN, NORMAL, SMALL, TITLE, WHITE, translucent,
};
use super::table::{Table, cell};
use super::ticks;
use super::ticks::quarters;
use crate::angle::wrap;
use plotters::prelude::ViridisRGB;
use plotters::style::text_anchor::HPos;
use plotters::style::{Color, RGBAColor};

/// The manifolds of one location.
#[derive(Clone, Debug)]
pub struct ProjectionsFigure<'a> {
    /// The manifolds.
    pub curves: &'a [ManifoldCurve],
    /// Singular configurations on them, with the rank that is lost there.
    pub nodes: &'a [(Vec<f64>, usize)],
    /// Number of joints of the robot.
    pub joint_count: usize,
    /// Full rank m.
    pub rank: usize,
    /// Numbers of the joints of each panel's axes, from 1.
    pub panels: Vec<[usize; 3]>,
    /// Number of the joint that gives the colour, from 1.
    pub colour: usize,
    /// Title above the panels; none if empty.
    pub title: String,
}

const HEAD: f64 = 18.0;
const PANEL: f64 = 190.0;
const FOOT: f64 = 26.0;
const WIDTH: f64 = 0.9;

impl ProjectionsFigure<'_> {
    fn rows(&self) -> usize {
        self.panels.len().div_ceil(2)
    }

    /// Least and greatest angle of the colouring joint, degrees in [−180, 180].
    fn range(&self) -> [f64; 2] {
        let joint = self.colour.saturating_sub(1);
        let angles = self.curves.iter().flat_map(|curve| &curve.points);
        let angles = angles.filter_map(|point| point.get(joint));
        let start = [f64::INFINITY, f64::NEG_INFINITY];
        let [low, high] = angles.fold(start, |[low, high], angle| {
            let angle = wrap(*angle).to_degrees();
            [low.min(angle), high.max(angle)]
        });
        if high - low < 1e-3 {
            [-180.0, 180.0]
        } else {
            [low, high]
        }
    }

    fn colour_of(&self, degrees: f64, [low, high]: [f64; 2]) -> RGBAColor {
        let share = ((degrees - low) / (high - low)).clamp(0.0, 1.0);
        if high - low > 300.0 {
            // The ends of a full turn are one angle.
            return turn_colour(share);
        }
        ViridisRGB::get_color(0.95 * share).to_rgba()
    }

    fn draw_panel(&self, canvas: &mut Canvas, joints: [usize; 3], corner: Point, width: f64) {
        let scene = AxisBox::fitting(
            Camera::new(-0.95, 0.42),
            [[-180.0; 3], [180.0; 3]],
            corner,
            [width, PANEL],
        );
        let names = joints.map(|joint| format!("{} (deg)", joint_symbol(joint)));
        let axes = names.each_ref().map(|label| Axis {
            label,
            ticks: quarters(),
        });
        for line in scene.back(&axes) {
            canvas.stroke(&line.map(|p| scene.at(p)), 0.4, GRID);
        }
        let indices = [joints[0] - 1, joints[1] - 1, joints[2] - 1, self.colour - 1];
        let range = self.range();
        let mut strokes: Vec<(f64, Vec<Point>, RGBAColor)> = Vec::new();
        for curve in self.curves {
            for piece in pieces(curve, self.joint_count, None) {
                for line in wrapped(&piece.points, indices) {
                    let floor: Vec<Point> = line
                        .iter()
                        .map(|p| scene.at([p[0], p[1], -180.0]))
                        .collect();
                    canvas.stroke(&thinned(&floor), 0.4, translucent(GREY, 0.35));
                    let seen: Vec<Point> =
                        line.iter().map(|p| scene.at([p[0], p[1], p[2]])).collect();
                    for pair in corners(&seen).windows(2) {
                        let [from, to] = [line[pair[0]], line[pair[1]]];
                        let middle = std::array::from_fn(|c| 0.5 * (from[c] + to[c]));
                        let colour = self.colour_of(0.5 * (from[3] + to[3]), range);
                        let path = seen[pair[0]..=pair[1]].to_vec();
                        strokes.push((scene.depth(middle), path, colour));
                    }
                }
            }
        }
        strokes.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, ends, colour) in &strokes {
            canvas.stroke(&thinned(ends), WIDTH, *colour);
        }
        for (theta, loss) in self
            .nodes
            .iter()
            .filter(|(q, _)| is_drawable(q, self.joint_count))
        {
            let angles = joints.map(|joint| wrap(theta[joint - 1]).to_degrees());
            for place in at_both_ends(angles) {
                let at = scene.at(place);
                canvas.disc(at, 2.5, WHITE);
                canvas.disc(at, 1.9, loss_colour(*loss));
            }
        }
        scene.draw_axes(canvas, &axes);
    }

    /// The colour bar below the panels, and the marks of nodes.
    fn draw_foot(&self, canvas: &mut Canvas) {
        let top = HEAD + self.rows() as f64 * PANEL + 3.0;
        let [low, high] = self.range();
        let (left, width) = (62.0, 170.0);
        for k in 0..85 {
            let share = k as f64 / 85.0;
            let colour = self.colour_of(low + (share + 0.5 / 85.0) * (high - low), [low, high]);
            canvas.fill(
                &rectangle(left + share * width, top, width / 85.0 + 0.3, 6.0),
                colour,
            );
        }
        canvas.outline(&rectangle(left, top, width, 6.0), 0.4, INK);
        let name = format!("{} (deg)", joint_symbol(self.colour));
        let at = [left - 6.0, top + 3.0 + HALF_CAPITAL * NORMAL];
        Label::new(&name, NORMAL)
            .align(HPos::Right)
            .draw(canvas, at);
        for tick in ticks::degrees(low, high, 5) {
            let x = left + width * (tick.value - low) / (high - low);
            canvas.stroke(&[[x, top + 6.0], [x, top + 8.5]], 0.6, INK);
            let label = Label::new(&tick.label, SMALL).align(HPos::Center);
            label.draw(canvas, [x, top + 10.0 + 0.76 * SMALL]);
        }
        let mut losses: Vec<usize> = self.nodes.iter().map(|(_, loss)| *loss).collect();
        losses.sort_unstable();
        losses.dedup();
        let entry = |loss: &usize| {
            let count = self.nodes.iter().filter(|(_, l)| l == loss).count();
            let rank = self.rank.saturating_sub(*loss);
            (
                Swatch::Dot(loss_colour(*loss)),
                match count {
                    1 => format!("singular configuration of rank {rank}"),
                    _ => format!("{count} singular configurations of rank {rank}"),
                },
            )
        };
        let entries: Vec<(Swatch, String)> = losses.iter().map(entry).collect();
        let entries: Vec<(Swatch, &str)> = entries.iter().map(|(s, t)| (*s, t.as_str())).collect();
        legend(
            canvas,
            [270.0, top + 3.0],
            DOUBLE_COLUMN - 270.0 - MARGIN,
            1,
            &entries,
        );
    }
}

/// A configuration next to ±180° of an axis stands at both of its ends.
fn at_both_ends(angles: Point3) -> Vec<Point3> {
    let mut places = vec![angles];
    for axis in 0..3 {
        if angles[axis].abs() > 179.5 {
            let mirrored = places.clone().into_iter().map(|mut place| {
                place[axis] = -place[axis];
                place
            });
            places.extend(mirrored);
        }
    }
    places
}

/// Parts of a line of one colour are at least this long, points.
const PART: f64 = 3.0;
/// Vertices nearer to each other are drawn as one, points.
const FINE: f64 = 0.25;

/// Indices of a path's points at distances of at least [`PART`], and its last one.
fn corners(path: &[Point]) -> Vec<usize> {
    let mut kept = vec![0];
    for (index, point) in path.iter().enumerate().skip(1) {
        let last = path[kept[kept.len() - 1]];
        let far = (point[0] - last[0]).hypot(point[1] - last[1]) > PART;
        if far || index + 1 == path.len() {
            kept.push(index);
        }
    }
    kept
}

/// The path without points that nobody could tell apart.
fn thinned(path: &[Point]) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for (index, point) in path.iter().enumerate() {
        let near = kept
            .last()
            .is_some_and(|last| (point[0] - last[0]).hypot(point[1] - last[1]) < FINE);
        if !near || index + 1 == path.len() {
            kept.push(*point);
        }
    }
    kept
}

/// Colours round a full turn, its ends alike.
fn turn_colour(share: f64) -> RGBAColor {
    let stops: [[f64; 3]; 6] = [
        [86.0, 60.0, 120.0],
        [0.0, 114.0, 178.0],
        [0.0, 158.0, 115.0],
        [222.0, 150.0, 0.0],
        [200.0, 60.0, 30.0],
        [150.0, 50.0, 100.0],
    ];
    let place = share * stops.len() as f64;
    let (from, part) = (place.floor() as usize % 6, place.fract());
    let to = stops[(from + 1) % 6];
    let mixed: [f64; 3] = std::array::from_fn(|c| stops[from][c] + part * (to[c] - stops[from][c]));
    RGBAColor(mixed[0] as u8, mixed[1] as u8, mixed[2] as u8, 1.0)
}

impl Figure for ProjectionsFigure<'_> {
    fn name(&self) -> &'static str {
        "projections"
    }

    fn caption(&self) -> String {
        let nodes = match self.nodes.is_empty() {
            true => "",
            false => " Dots: singular configurations, where manifolds meet.",
        };
        format!(
            "All self-motion manifolds of the location in the spaces of several joints, with their \
             shadows on the floor; the colour is the angle of {}.{nodes}",
            joint_symbol(self.colour)
        )
    }

    fn size(&self) -> Size {
        Size {
            width: DOUBLE_COLUMN,
            height: HEAD + self.rows() as f64 * PANEL + FOOT,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        let middle = [0.5 * DOUBLE_COLUMN, 12.0];
        title.draw_within(canvas, middle, DOUBLE_COLUMN - 2.0 * MARGIN);
        let width = 0.5 * (DOUBLE_COLUMN - 8.0);
        for (place, joints) in self.panels.iter().enumerate() {
            let known = joints.iter().chain([&self.colour]);
            if known
                .into_iter()
                .any(|joint| !(1..=self.joint_count).contains(joint))
            {
                continue;
            }
            let corner = [
                (place % 2) as f64 * (width + 8.0),
                HEAD + (place / 2) as f64 * PANEL,
            ];
            self.draw_panel(canvas, *joints, corner, width);
            let letter = format!("({})", (b'a' + (place % 26) as u8) as char);
            Label::new(&letter, NORMAL)
                .bold()
                .draw(canvas, [corner[0] + 8.0, corner[1] + 12.0]);
        }
        self.draw_foot(canvas);
    }

    fn table(&self) -> Table {
        let mut header = vec!["curve".to_owned(), "vertex".into()];
        header.extend((1..=self.joint_count).map(|k| format!("theta_{k}_deg")));
        let mut table = Table {
            header,
            rows: Vec::new(),
        };
        for (number, curve) in (1..).zip(self.curves) {
            for (vertex, point) in (1..).zip(&curve.points) {
                let mut row: Vec<String> = vec![format!("{number}"), format!("{vertex}")];
                row.extend(point.iter().map(|angle| cell(angle.to_degrees())));
                table.rows.push(row);
            }
        }
        table
    }
}
