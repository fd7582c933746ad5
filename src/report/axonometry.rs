//! A box in space seen from far away: orthographic projection, axes with ticks, depth.

use super::canvas::{Canvas, Point};
use super::label::Label;
use super::style::{HALF_CAPITAL, INK, NORMAL, SMALL};
use super::ticks::Tick;
use plotters::style::text_anchor::HPos;

/// A point in space.
pub(super) type Point3 = [f64; 3];

/// An orthographic camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    right: Point3,
    up: Point3,
    /// Unit vector from the scene to the viewer.
    towards: Point3,
}

impl Camera {
    /// A viewer at `azimuth` about the z axis from the x axis and `elevation` above the xy plane,
    /// radians.
    pub(super) fn new(azimuth: f64, elevation: f64) -> Camera {
        let ((s, c), (se, ce)) = (azimuth.sin_cos(), elevation.sin_cos());
        Camera {
            right: [-s, c, 0.0],
            up: [-se * c, -se * s, ce],
            towards: [ce * c, ce * s, se],
        }
    }

    /// To the right, up and towards the viewer.
    fn coordinates(&self, p: Point3) -> Point3 {
        [dot(self.right, p), dot(self.up, p), dot(self.towards, p)]
    }
}

/// A box in space on a rectangle of the sheet.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxisBox {
    camera: Camera,
    low: Point3,
    high: Point3,
    /// Points of the sheet per unit.
    scale: f64,
    /// The sheet's point of the box's middle.
    centre: Point,
}

/// Label and ticks of one axis.
pub(super) struct Axis<'a> {
    pub label: &'a str,
    pub ticks: Vec<Tick>,
}

/// Space around the box for ticks and labels, points.
const LEFT: f64 = 32.0;
const RIGHT: f64 = 20.0;
const ABOVE: f64 = 3.0;
const BELOW: f64 = 18.0;

impl AxisBox {
    /// The box from `low` to `high` as large as fits with its labels into the rectangle from
    /// `corner` over `size` points.
    pub(super) fn fitting(
        camera: Camera,
        [low, high]: [Point3; 2],
        corner: Point,
        size: Point,
    ) -> AxisBox {
        let mut fitted = AxisBox {
            camera,
            low,
            high,
            scale: 1.0,
            centre: [0.0, 0.0],
        };
        let [from, to] = fitted.extent();
        let room = [size[0] - LEFT - RIGHT, size[1] - ABOVE - BELOW];
        fitted.scale = (room[0] / (to[0] - from[0]))
            .min(room[1] / (to[1] - from[1]))
            .max(0.0);
        fitted.centre = [
            corner[0] + LEFT + 0.5 * room[0],
            corner[1] + ABOVE + 0.5 * room[1],
        ];
        fitted
    }

    /// Corners [left upper, right lower] of the box's picture on the sheet.
    pub(super) fn extent(&self) -> [Point; 2] {
        let mut extent = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for k in 0..8 {
            let at = self.at(self.corner([k & 1, (k >> 1) & 1, k >> 2].map(|bit| bit == 1)));
            for c in 0..2 {
                extent[0][c] = extent[0][c].min(at[c]);
                extent[1][c] = extent[1][c].max(at[c]);
            }
        }
        extent
    }

    /// About how many ticks an axis has room for.
    pub(super) fn room(&self, axis: usize) -> usize {
        let mut end = self.low;
        end[axis] = self.high[axis];
        let [from, to] = [self.low, end].map(|p| self.at(p));
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        (length / 24.0).clamp(1.0, 5.0) as usize
    }

    /// A corner of the box; true for the higher end of an axis.
    fn corner(&self, is_high: [bool; 3]) -> Point3 {
        std::array::from_fn(|c| {
            if is_high[c] {
                self.high[c]
            } else {
                self.low[c]
            }
        })
    }

    fn middle(&self) -> Point3 {
        std::array::from_fn(|c| 0.5 * (self.low[c] + self.high[c]))
    }

    /// The point of the sheet for a point in space.
    pub(super) fn at(&self, p: Point3) -> Point {
        let [right, up, _] = self.camera.coordinates(difference(p, self.middle()));
        [
            self.centre[0] + self.scale * right,
            self.centre[1] - self.scale * up,
        ]
    }

    /// How far towards the viewer a point is, in units of the box.
    pub(super) fn depth(&self, p: Point3) -> f64 {
        self.camera.coordinates(difference(p, self.middle()))[2]
    }

    /// Where the line of sight through a point of the sheet meets the plane on which coordinate
    /// `axis` is `value`; none for planes seen edge on.
    pub(super) fn on_plane(&self, sheet: Point, axis: usize, value: f64) -> Option<Point3> {
        let [right, up] = [
            (sheet[0] - self.centre[0]) / self.scale,
            (self.centre[1] - sheet[1]) / self.scale,
        ];
        let camera = &self.camera;
        let middle = self.middle();
        let base: Point3 =
            std::array::from_fn(|c| middle[c] + right * camera.right[c] + up * camera.up[c]);
        let t = (value - base[axis]) / camera.towards[axis];
        let hit: Point3 = std::array::from_fn(|c| base[c] + t * camera.towards[c]);
        hit.iter().all(|c| c.is_finite()).then_some(hit)
    }

    /// Which end of each axis is the viewer's.
    pub(super) fn near(&self) -> [bool; 3] {
        self.camera.towards.map(|c| c > 0.0)
    }

    /// The twelve edges of the box of which the three at the far corner, hidden by what is in the
    /// box, come first.
    pub(super) fn edges(&self, [low, high]: [Point3; 2]) -> Vec<[Point3; 2]> {
        let near = self.near();
        let corner = |flags: [bool; 3]| -> Point3 {
            std::array::from_fn(|c| if flags[c] { high[c] } else { low[c] })
        };
        let mut edges = Vec::new();
        for turn in 0..4 {
            for axis in 0..3 {
                let mut from = near.map(|is_near| !is_near);
                from[(axis + 1) % 3] ^= turn & 1 == 1;
                from[(axis + 2) % 3] ^= turn & 2 == 2;
                let mut to = from;
                to[axis] = !to[axis];
                edges.push([corner(from), corner(to)]);
            }
        }
        edges
    }

    /// Light lines at the ticks on the three faces behind the box, and these faces' edges.
    pub(super) fn back(&self, axes: &[Axis; 3]) -> Vec<[Point3; 2]> {
        let far = self.corner(self.near().map(|is_near| !is_near));
        let mut lines = Vec::new();
        for (axis, Axis { ticks, .. }) in axes.iter().enumerate() {
            for value in ticks.iter().map(|tick| tick.value) {
                for along in (0..3).filter(|c| *c != axis) {
                    let mut line = [far, far];
                    line[0][along] = self.low[along];
                    line[1][along] = self.high[along];
                    line[0][axis] = value;
                    line[1][axis] = value;
                    lines.push(line);
                }
            }
        }
        lines.extend(self.edges([self.low, self.high]).into_iter().take(9));
        lines
    }

    /// Axes with ticks and labels on the box's outer edges: x and y at its foot, z at its left.
    pub(super) fn draw_axes(&self, canvas: &mut Canvas, axes: &[Axis; 3]) {
        let near = self.near();
        let x_edge = self.corner([false, near[1], false]);
        let y_edge = self.corner([near[0], false, false]);
        let sides = [[!near[0], near[1], false], [near[0], !near[1], false]];
        let is_first = self.at(self.corner(sides[0]))[0] < self.at(self.corner(sides[1]))[0];
        let z_edge = self.corner(if is_first { sides[0] } else { sides[1] });
        let z_out = [-1.0, 0.0];
        let outward = |axis: usize| {
            let mut step = [0.0; 3];
            step[axis] = if near[axis] { 1.0 } else { -1.0 };
            let at = [self.at(self.middle()), self.at(sum(self.middle(), step))];
            unit([at[1][0] - at[0][0], at[1][1] - at[0][1]])
        };
        for (axis, edge, out) in [
            (0, x_edge, outward(1)),
            (1, y_edge, outward(0)),
            (2, z_edge, z_out),
        ] {
            self.draw_axis(canvas, axis, edge, out, &axes[axis]);
        }
    }

    fn draw_axis(
        &self,
        canvas: &mut Canvas,
        axis: usize,
        edge: Point3,
        out: Point,
        Axis { label, ticks }: &Axis,
    ) {
        let along = |value: f64| {
            let mut p = edge;
            p[axis] = value;
            self.at(p)
        };
        let [from, to] = [along(self.low[axis]), along(self.high[axis])];
        canvas.stroke(&[from, to], 0.6, INK);
        let away = |at: Point, by: f64| [at[0] + by * out[0], at[1] + by * out[1]];
        let align = match out[0] {
            x if x < -0.2 => HPos::Right,
            x if x > 0.2 => HPos::Left,
            _ => HPos::Center,
        };
        let mut widest: f64 = 0.0;
        for tick in ticks {
            let at = along(tick.value);
            canvas.stroke(&[at, away(at, 2.5)], 0.6, INK);
            let text = Label::new(&tick.label, SMALL).align(align);
            widest = widest.max(text.width());
            let mut base = lettered(away(at, 4.5), out, SMALL);
            // At its foot the upright axis shares a corner with another one's label.
            let is_foot = tick.value - self.low[2] < 0.01 * (self.high[2] - self.low[2]);
            base[1] -= if axis == 2 && is_foot { 3.5 } else { 0.0 };
            text.draw(canvas, base);
        }
        let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
        let by = 4.5 + widest * out[0].abs() + SMALL * out[1].abs() + 4.0;
        let name = Label::new(label, NORMAL).align(align);
        if axis == 2 {
            let at = [away(middle, by)[0], middle[1]];
            name.align(HPos::Center).upright().draw(canvas, at);
        } else {
            name.draw(canvas, lettered(away(middle, by), out, NORMAL));
        }
    }
}

/// The base line of letters that hang from `at` in direction `out`.
fn lettered(at: Point, out: Point, size: f64) -> Point {
    [at[0], at[1] + HALF_CAPITAL * size * (1.0 + out[1])]
}

fn dot(a: Point3, b: Point3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn difference(a: Point3, b: Point3) -> Point3 {
    std::array::from_fn(|c| a[c] - b[c])
}

fn sum(a: Point3, b: Point3) -> Point3 {
    std::array::from_fn(|c| a[c] + b[c])
}

fn unit([x, y]: Point) -> Point {
    let length = x.hypot(y);
    if length > 0.0 {
        [x / length, y / length]
    } else {
        [0.0, 1.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit_box() -> AxisBox {
        let camera = Camera::new(-0.9, 0.4);
        AxisBox::fitting(
            camera,
            [[-1.0; 3], [1.0, 2.0, 3.0]],
            [10.0, 20.0],
            [200.0, 150.0],
        )
    }

    #[test]
    fn the_box_fits_with_its_labels() {
        let [from, to] = unit_box().extent();
        assert!(from[0] >= 10.0 + LEFT - 1e-9 && to[0] <= 210.0 - RIGHT + 1e-9);
        assert!(from[1] >= 20.0 + ABOVE - 1e-9 && to[1] <= 170.0 - BELOW + 1e-9);
        assert!(to[1] - from[1] > 128.0);
    }

    #[test]
    fn lines_of_sight_go_back_to_their_points() {
        let scene = unit_box();
        let p = [0.3, -0.4, 1.2];
        for axis in 0..3 {
            let back = scene.on_plane(scene.at(p), axis, p[axis]).unwrap();
            assert!((0..3).all(|c| (back[c] - p[c]).abs() < 1e-12), "{back:?}");
        }
        let above = AxisBox::fitting(
            Camera::new(0.0, 0.0),
            [[0.0; 3], [1.0; 3]],
            [0.0; 2],
            [99.0; 2],
        );
        assert_eq!(above.on_plane([50.0, 50.0], 2, 0.2), None);
    }

    #[test]
    fn the_viewer_sees_the_near_corner() {
        let scene = unit_box();
        assert_eq!(scene.near(), [true, false, true]);
        let far = scene.depth([-1.0, 2.0, -1.0]);
        let edges = scene.edges([[-1.0; 3], [1.0, 2.0, 3.0]]);
        assert_eq!(edges.len(), 12);
        assert!(edges[..3].iter().all(|edge| scene.depth(edge[0]) == far));
        assert!(
            edges[9..]
                .iter()
                .all(|edge| scene.depth(edge[1]) > far + 1.0)
        );
        // x runs to the right, z up.
        assert!(scene.at([1.0, 0.0, 0.0])[0] > scene.at([0.0; 3])[0]);
        assert!(scene.at([0.0, 0.0, 1.0])[1] < scene.at([0.0; 3])[1]);
    }
}
