//! A robot in several configurations at once.

use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, dashed, legend};
use super::link_rod::arrow;
use super::projection::{Space, View, centred};
use super::style::{
    BLUE, COLUMN, GREEN, GREY, INK, MARGIN, ORANGE, PURPLE, SMALL, TITLE, VERMILLION, WHITE,
    translucent,
};
use super::table::{Table, cell};
use nalgebra::{Isometry3, Vector3};
use plotters::style::RGBAColor;
use plotters::style::text_anchor::HPos;

/// One configuration: the corners of the robot's skeleton from base to tool, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct ArmPose {
    /// What it is, for the legend.
    pub name: String,
    /// Corners of the skeleton.
    pub corners: Vec<Vector3<f64>>,
    /// Where its joints are, base first, metres: corners with none left out.
    pub places: Vec<Vector3<f64>>,
    /// The tool's frame.
    pub tool: Isometry3<f64>,
}

/// Several configurations of a robot.
#[derive(Clone, Debug)]
pub struct ArmPosesFigure {
    /// Stem of the figure's files.
    pub name: &'static str,
    /// The configurations.
    pub poses: Vec<ArmPose>,
    /// What is to be seen.
    pub caption: String,
    /// Title above the picture; none if empty.
    pub title: String,
}

const COLOURS: [RGBAColor; 5] = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE];
const TALLEST: f64 = 1.05;
const COLUMNS: usize = 2;

impl ArmPosesFigure {
    fn head(&self) -> f64 {
        16.0 + self.poses.len().div_ceil(COLUMNS) as f64 * LEGEND_ROW + MARGIN
    }

    fn place(&self) -> (Space, f64) {
        let points: Vec<Vector3<f64>> = self
            .poses
            .iter()
            .flat_map(|pose| pose.corners.iter().copied())
            .filter(|p| p.iter().all(|c| c.is_finite()))
            .chain([Vector3::zeros()])
            .collect();
        let mut low = points
            .iter()
            .fold(Vector3::repeat(f64::INFINITY), |a, p| a.inf(p));
        let mut high = points
            .iter()
            .fold(Vector3::repeat(f64::NEG_INFINITY), |a, p| a.sup(p));
        let size = (high - low).max().max(1e-6);
        for axis in 0..3 {
            let missing = 0.5 * (0.8 * size - (high[axis] - low[axis])).max(0.0) + 0.06 * size;
            low[axis] -= missing;
            high[axis] += missing;
        }
        let width = COLUMN - 2.0 * MARGIN;
        let corner = [MARGIN, self.head()];
        let view = self.view(&points, size);
        Space::fit(
            view,
            [low.into(), high.into()],
            corner,
            [width, TALLEST * width],
        )
    }

    /// The view in which the corners are farthest apart.
    fn view(&self, points: &[Vector3<f64>], size: f64) -> View {
        let mut best = (f64::NEG_INFINITY, View::new(-0.9, 0.42));
        for degrees in (20..=70).step_by(10).flat_map(|d| [d, -d]) {
            let view = View::new(f64::from(degrees).to_radians(), 0.42);
            let flat: Vec<Point> = points.iter().map(|p| view.flat(p)).collect();
            let mut score = 0.0;
            for (index, a) in flat.iter().enumerate() {
                for b in &flat[..index] {
                    let distance = (a[0] - b[0]).hypot(a[1] - b[1]) / size;
                    score += (distance * distance + 1e-3).ln();
                }
            }
            if score > best.0 {
                best = (score, view);
            }
        }
        best.1
    }

    fn draw_shadows(&self, canvas: &mut Canvas, space: &Space) {
        for pose in &self.poses {
            let floor = |p: &Vector3<f64>| space.at(&space.on_floor(p));
            let path: Vec<Point> = pose.corners.iter().map(floor).collect();
            canvas.stroke(&path, 1.6, translucent(GREY, 0.3));
        }
    }

    /// From the farthest to the nearest configuration.
    fn draw_arms(&self, canvas: &mut Canvas, space: &Space) {
        let mut order: Vec<usize> = (0..self.poses.len()).collect();
        let nearness = |k: &usize| {
            let corners = &self.poses[*k].corners;
            let sum: f64 = corners.iter().map(|p| space.view.nearness(p)).sum();
            sum / corners.len().max(1) as f64
        };
        order.sort_by(|a, b| nearness(a).total_cmp(&nearness(b)));
        for k in order {
            let (pose, colour) = (&self.poses[k], COLOURS[k % COLOURS.len()]);
            let path = space.path(&pose.corners);
            canvas.stroke(&path, 3.4, WHITE);
            canvas.stroke(&path, 2.2, colour);
            for at in &path {
                canvas.disc(*at, 2.5, colour);
                canvas.disc(*at, 1.4, WHITE);
            }
        }
    }

    /// The tool's frame wherever it is, once, and the base.
    fn draw_frames(&self, canvas: &mut Canvas, space: &Space) {
        let mut named: Vec<Point> = Vec::new();
        for pose in &self.poses {
            let origin = pose.tool.translation.vector;
            let at = space.at(&origin);
            let is_new = |other: &Point| (other[0] - at[0]).hypot(other[1] - at[1]) > 2.0;
            if !named.iter().all(is_new) {
                continue;
            }
            named.push(at);
            let length = 17.0 / space.scale;
            for (axis, colour) in [VERMILLION, GREEN, BLUE].into_iter().enumerate() {
                let tip = origin + pose.tool.rotation * Vector3::ith(axis, length);
                for shape in arrow([at, space.at(&tip)], colour) {
                    draw_shape(canvas, shape);
                }
            }
            centred(canvas, "tool", SMALL, [at[0] + 12.0, at[1] - 9.0]);
        }
        let base = space.at(&Vector3::zeros());
        let foot = space.at(&space.on_floor(&Vector3::zeros()));
        dashed(canvas, base, foot, 0.5, GREY);
        canvas.disc(base, 3.0, INK);
        centred(canvas, "base", SMALL, [base[0] + 13.0, base[1] + 6.0]);
    }
}

impl Figure for ArmPosesFigure {
    fn name(&self) -> &'static str {
        self.name
    }

    fn caption(&self) -> String {
        self.caption.clone()
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: self.head() + self.place().1 + MARGIN,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * COLUMN, 12.0], COLUMN - 2.0 * MARGIN);
        let names = self.poses.iter().enumerate();
        let entries: Vec<(Swatch, &str)> = names
            .map(|(k, pose)| (Swatch::Arm(COLOURS[k % COLOURS.len()]), pose.name.as_str()))
            .collect();
        legend(
            canvas,
            [14.0, 22.0],
            COLUMN - 14.0 - MARGIN,
            COLUMNS,
            &entries,
        );
        let (space, _) = self.place();
        space.draw_axes(canvas);
        self.draw_shadows(canvas, &space);
        self.draw_arms(canvas, &space);
        self.draw_frames(canvas, &space);
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&["configuration", "corner", "x_m", "y_m", "z_m"]);
        for pose in &self.poses {
            for (number, corner) in (1..).zip(&pose.corners) {
                let mut row = vec![pose.name.clone(), format!("{number}")];
                row.extend(corner.iter().map(|c| cell(*c)));
                table.rows.push(row);
            }
        }
        table
    }
}

fn draw_shape(canvas: &mut Canvas, shape: super::scene::Shape) {
    let mut scene = super::scene::Scene::default();
    scene.add(0.0, vec![shape]);
    scene.draw(canvas);
}
