//! From space to the sheet: an orthographic view from a given azimuth and elevation, and a box
//! of axes around what is shown. What is in the box goes to a [`Scene`](super::scene::Scene).

use super::canvas::{Canvas, Point};
use super::label::Label;
use super::style::{GREY, GRID, HALF_CAPITAL, INK, NORMAL, SMALL, translucent};
use super::ticks::{self, Tick};
use nalgebra::Vector3;
use plotters::style::text_anchor::HPos;

/// The direction from which a scene is seen, parallel rays.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    right: Vector3<f64>,
    up: Vector3<f64>,
    towards: Vector3<f64>,
}

impl View {
    /// The viewer stands at `azimuth` (radians, from x towards y) and `elevation` (radians, from
    /// 0 to π/2).
    pub(super) fn new(azimuth: f64, elevation: f64) -> View {
        let (sine, cosine) = azimuth.sin_cos();
        let (rise, flat) = elevation.sin_cos();
        View {
            right: Vector3::new(-sine, cosine, 0.0),
            up: Vector3::new(-rise * cosine, -rise * sine, flat),
            towards: Vector3::new(flat * cosine, flat * sine, rise),
        }
    }

    /// Right and up on the picture, metres.
    pub(super) fn flat(&self, point: &Vector3<f64>) -> Point {
        [self.right.dot(point), self.up.dot(point)]
    }

    /// How near a point is to the viewer, metres.
    pub(super) fn nearness(&self, point: &Vector3<f64>) -> f64 {
        self.towards.dot(point)
    }
}

/// A box of space seen on a rectangle of the sheet, at one scale for all directions.
#[derive(Clone, Debug)]
pub(super) struct Space {
    pub view: View,
    /// Least x, y and z, metres.
    pub low: [f64; 3],
    /// Largest x, y and z, metres.
    pub high: [f64; 3],
    /// Points of the sheet per metre.
    pub scale: f64,
    /// Where the origin is on the sheet.
    origin: Point,
}

/// Space for tick labels and titles beside the box, points.
const SIDE: f64 = 28.0;
/// Length of a tick and from its end to its label, points.
const TICK: f64 = 2.5;
const GAP: f64 = 2.0;
/// Space that tick labels and titles below the box may need, points.
const BELOW: f64 = 30.0;

/// Half of the width and height of a text.
type Half = [f64; 2];

/// A text of an axis with its middle on the sheet.
struct Text {
    text: String,
    size: f64,
    at: Point,
    upright: bool,
}

impl Space {
    /// The box from `low` to `high` as large as it fits into a rectangle of `width` and at most
    /// `tallest` points, whose upper left corner is `corner`; with it the height that is used.
    /// Labels of the axes lie within the rectangle.
    pub(super) fn fit(
        view: View,
        [low, high]: [[f64; 3]; 2],
        corner: Point,
        [width, tallest]: [f64; 2],
    ) -> (Space, f64) {
        let mut space = Space {
            view,
            low,
            high,
            scale: 1.0,
            origin: [0.0, 0.0],
        };
        let [left, top, right, bottom] = space.bounds();
        let wide = (width - 2.0 * SIDE) / (right - left).max(f64::MIN_POSITIVE);
        let high = (tallest - BELOW - 4.0) / (bottom - top).max(f64::MIN_POSITIVE);
        let scale = wide.min(high);
        let spare = width - 2.0 * SIDE - scale * (right - left);
        space.scale = scale;
        space.origin = [
            corner[0] + SIDE + 0.5 * spare - scale * left,
            corner[1] + 4.0 - scale * top,
        ];
        let texts = (0..3).flat_map(|axis| space.texts(axis));
        let lowest = texts.map(|text| text.at[1] + 0.5 * text.size);
        let lowest = lowest.fold(space.bounds()[3], f64::max);
        (space, lowest - corner[1])
    }

    /// Left, top, right and bottom of the box on the sheet.
    fn bounds(&self) -> [f64; 4] {
        let corners = (0..8).map(|k| self.at(&self.corner([k & 1 > 0, k & 2 > 0, k & 4 > 0])));
        let start = [
            f64::INFINITY,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NEG_INFINITY,
        ];
        corners.fold(start, |[a, b, c, d], [x, y]| {
            [a.min(x), b.min(y), c.max(x), d.max(y)]
        })
    }

    /// The point of the sheet for a point of space.
    pub(super) fn at(&self, point: &Vector3<f64>) -> Point {
        let [right, up] = self.view.flat(point);
        [
            self.origin[0] + self.scale * right,
            self.origin[1] - self.scale * up,
        ]
    }

    /// Maps a path of points of space.
    pub(super) fn path(&self, points: &[Vector3<f64>]) -> Vec<Point> {
        points.iter().map(|point| self.at(point)).collect()
    }

    /// The point's shadow on the floor of the box.
    pub(super) fn on_floor(&self, point: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(point.x, point.y, self.low[2])
    }

    fn corner(&self, is_high: [bool; 3]) -> Vector3<f64> {
        let side = |k: usize| {
            if is_high[k] {
                self.high[k]
            } else {
                self.low[k]
            }
        };
        Vector3::new(side(0), side(1), side(2))
    }

    /// Per direction, whether the side with the larger coordinate is the one farther away.
    fn far(&self) -> [bool; 3] {
        let towards = &self.view.towards;
        [towards.x < 0.0, towards.y < 0.0, towards.z < 0.0]
    }

    fn ticks(&self, axis: usize) -> Vec<Tick> {
        let size = self.high[axis] - self.low[axis];
        let points = self.scale * size * self.shortening(axis);
        let count = (points / 24.0).round().clamp(3.0, 6.0) as usize;
        ticks::round(self.low[axis], self.high[axis], count)
    }

    /// Length on the picture of a unit along an axis.
    fn shortening(&self, axis: usize) -> f64 {
        let [x, y] = self.view.flat(&Vector3::ith(axis, 1.0));
        x.hypot(y)
    }

    /// The edges that carry ticks: x and y along the front of the floor, z up the edge that is
    /// farthest left.
    pub(super) fn axis_edges(&self) -> [[Vector3<f64>; 2]; 3] {
        let far = self.far();
        let sides = [[far[0], !far[1]], [!far[0], far[1]]];
        let left = |side: &[bool; 2]| self.at(&self.corner([side[0], side[1], false]))[0];
        let [x, y] = match left(&sides[0]) <= left(&sides[1]) {
            true => sides[0],
            false => sides[1],
        };
        let starts = [
            [false, !far[1], false],
            [!far[0], false, false],
            [x, y, false],
        ];
        let mut edges = starts.map(|start| [self.corner(start); 2]);
        for (axis, edge) in edges.iter_mut().enumerate() {
            edge[1][axis] = self.high[axis];
        }
        edges
    }

    /// Floor and back walls with light lines at the ticks, and the labelled axes: what is behind
    /// the scene.
    pub(super) fn draw_axes(&self, canvas: &mut Canvas) {
        (0..3).for_each(|normal| self.wall(canvas, normal));
        for (axis, edge) in self.axis_edges().into_iter().enumerate() {
            let ends = edge.map(|end| self.at(&end));
            canvas.stroke(&ends, 0.7, INK);
            let out = self.outwards(ends);
            for tick in self.ticks(axis) {
                let foot = self.on_edge(axis, tick.value);
                canvas.stroke(&[foot, away(foot, out, TICK)], 0.6, INK);
            }
            for text in self.texts(axis) {
                text.draw(canvas);
            }
        }
    }

    /// Middles of all texts of the axes.
    pub(super) fn text_places(&self) -> Vec<Point> {
        let texts = (0..3).flat_map(|axis| self.texts(axis));
        texts.map(|text| text.at).collect()
    }

    /// The point of an axis' edge at a coordinate.
    fn on_edge(&self, axis: usize, value: f64) -> Point {
        let mut point = self.axis_edges()[axis][0];
        point[axis] = value;
        self.at(&point)
    }

    /// Whether a tick of the y axis at `foot` is so near to one of the x axis that their labels
    /// would meet.
    fn meets_x_label(&self, foot: Point) -> bool {
        let is_near = |tick: Tick| {
            let other = self.on_edge(0, tick.value);
            (foot[0] - other[0]).hypot(foot[1] - other[1]) < 11.0
        };
        self.ticks(0).into_iter().any(is_near)
    }

    /// Labels of the ticks of an axis and, farther out, its title.
    fn texts(&self, axis: usize) -> Vec<Text> {
        let ends = self.axis_edges()[axis].map(|end| self.at(&end));
        let out = self.outwards(ends);
        let reach = |half: Half| half[0] * out[0].abs() + half[1] * out[1].abs();
        let start = TICK + GAP;
        let mut widest: f64 = 0.0;
        let mut texts = Vec::new();
        for tick in self.ticks(axis) {
            let half = [0.5 * Label::new(&tick.label, SMALL).width(), 0.5 * SMALL];
            widest = widest.max(2.0 * reach(half));
            let foot = self.on_edge(axis, tick.value);
            if axis == 1 && self.meets_x_label(foot) {
                continue;
            }
            texts.push(Text {
                at: away(foot, out, start + reach(half)),
                text: tick.label,
                size: SMALL,
                upright: false,
            });
        }
        let title = ["x (m)", "y (m)", "z (m)"][axis];
        let long = 0.5 * Label::new(title, NORMAL).width();
        let half = if axis == 2 {
            [0.5 * NORMAL, long]
        } else {
            [long, 0.5 * NORMAL]
        };
        let middle = [0, 1].map(|k| 0.5 * (ends[0][k] + ends[1][k]));
        texts.push(Text {
            at: away(middle, out, start + widest + 3.0 + reach(half)),
            text: title.to_owned(),
            size: NORMAL,
            upright: axis == 2,
        });
        texts
    }

    /// The far side of the box across `normal`.
    fn wall(&self, canvas: &mut Canvas, normal: usize) {
        let far = self.far()[normal];
        let [u, v] = [(normal + 1) % 3, (normal + 2) % 3];
        let point = |a: f64, b: f64| {
            let mut at = self.corner([far; 3]);
            at[u] = a;
            at[v] = b;
            self.at(&at)
        };
        let ([u0, u1], [v0, v1]) = ([self.low[u], self.high[u]], [self.low[v], self.high[v]]);
        let corners = [point(u0, v0), point(u1, v0), point(u1, v1), point(u0, v1)];
        let shade = [0.10, 0.06, 0.16][normal];
        canvas.fill(&corners, translucent(GRID, shade * 2.0));
        for tick in self.ticks(u) {
            canvas.stroke(&[point(tick.value, v0), point(tick.value, v1)], 0.35, GRID);
        }
        for tick in self.ticks(v) {
            canvas.stroke(&[point(u0, tick.value), point(u1, tick.value)], 0.35, GRID);
        }
        canvas.outline(&corners, 0.4, GREY);
    }

    /// Unit direction on the sheet across the edge `ends`, away from the box.
    fn outwards(&self, ends: [Point; 2]) -> Point {
        let along = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
        let length = along[0].hypot(along[1]).max(f64::MIN_POSITIVE);
        let across = [-along[1] / length, along[0] / length];
        let [left, top, right, bottom] = self.bounds();
        let from_middle = [
            0.5 * (ends[0][0] + ends[1][0]) - 0.5 * (left + right),
            0.5 * (ends[0][1] + ends[1][1]) - 0.5 * (top + bottom),
        ];
        match across[0] * from_middle[0] + across[1] * from_middle[1] {
            side if side < 0.0 => across.map(|c| -c),
            _ => across,
        }
    }
}

impl Text {
    fn draw(&self, canvas: &mut Canvas) {
        if !self.upright {
            return centred(canvas, &self.text, self.size, self.at);
        }
        let label = Label::new(&self.text, self.size).align(HPos::Center);
        label
            .upright()
            .draw(canvas, [self.at[0] + HALF_CAPITAL * self.size, self.at[1]]);
    }
}

/// The point `by` points from `point` in the direction `out`.
fn away(point: Point, out: Point, by: f64) -> Point {
    [point[0] + by * out[0], point[1] + by * out[1]]
}

/// Draws a text with its middle at `at`.
pub(super) fn centred(canvas: &mut Canvas, text: &str, size: f64, at: Point) {
    let label = Label::new(text, size).align(HPos::Center);
    label.draw(canvas, [at[0], at[1] + HALF_CAPITAL * size]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn views_are_right_handed() {
        let view = View::new(-0.8, 0.5);
        assert!((view.right.cross(&view.up) - view.towards).norm() < 1e-15);
        // Seen from −y, x points right and z up.
        let front = View::new(-FRAC_PI_2, 0.0);
        let [x, y] = front.flat(&Vector3::new(2.0, 7.0, 3.0));
        assert!((x - 2.0).abs() < 1e-14 && (y - 3.0).abs() < 1e-14);
        assert!((front.nearness(&Vector3::y()) + 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_box_fits_with_its_labels() {
        for azimuth in [-2.9, -1.0, 0.3, 1.2, 2.8] {
            let view = View::new(azimuth, 0.4);
            let sides = [[-1.0, -2.0, 0.0], [1.0, 0.5, 9.0]];
            let (space, height) = Space::fit(view, sides, [10.0, 20.0], [200.0, 150.0]);
            let [left, top, right, bottom] = space.bounds();
            assert!(left >= 10.0 + SIDE - 1e-9 && right <= 210.0 - SIDE + 1e-9);
            assert!(top >= 20.0 && bottom <= 20.0 + height && height <= 150.0 + 1e-9);
        }
    }
}
