//! Any serial robot in space: links, joints along their axes, base and tool frame, shadow.

use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::free_place::FreePlaces;
use super::joint_mark::{self, Mark};
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::link_rod::{BODY, BODY_WIDTH, RIM_WIDTH, arrow, rod};
use super::projection::{Space, centred};
use super::robot_view::{ARROW, best_view, bounds, sides};
use super::scene::{Scene, Shape};
use super::style::{
    BLUE, COLUMN, GREEN, GREY, INK, MARGIN, ORANGE, SKY, SMALL, TITLE, VERMILLION, WHITE,
    translucent,
};
use super::table::{Table, cell};
use nalgebra::{Isometry3, Vector3};
use plotters::style::RGBAColor;
use plotters::style::text_anchor::HPos;

/// A joint of a robot in the posture that is drawn.
#[derive(Clone, Debug)]
pub struct JointMark {
    /// Prismatic: it slides along its axis instead of turning about it.
    pub slides: bool,
    /// The frame in which it moves, about or along its z axis; metres, in the base frame.
    pub frame: Isometry3<f64>,
    /// The point of the axis where the link before comes in, metres.
    pub entry: Vector3<f64>,
    /// The point of the axis where the link leaves it, metres.
    pub foot: Vector3<f64>,
}

/// A serial robot in space.
#[derive(Clone, Debug)]
pub struct SpatialRobotFigure {
    /// Name above the plot.
    pub title: String,
    /// The joints, base first.
    pub joints: Vec<JointMark>,
    /// The tool's frame, metres, in the base frame.
    pub tool: Isometry3<f64>,
}

/// Height of the picture, at most, in its width.
const TALLEST: f64 = 1.05;
/// Radius of a joint in the robot's size.
const RADIUS: f64 = 0.038;
/// Colours of the arrows along x, y and z.
const AXES: [RGBAColor; 3] = [VERMILLION, GREEN, BLUE];
const SHADOW: RGBAColor = RGBAColor(0xcc, 0xcc, 0xcc, 1.0);

/// The robot placed on the sheet.
pub(super) struct Drawing {
    space: Space,
    corner: Point,
    width: f64,
    marks: Vec<Mark>,
    /// Lines from mark to mark, from the base to the tool.
    links: Vec<Vec<Vector3<f64>>>,
    frames: [Isometry3<f64>; 2],
    radius: f64,
    /// Height that is used, points.
    pub height: f64,
}

/// What a legend tells about robots in space with these kinds of joints.
pub(super) fn legend_entries(turns: bool, slides: bool) -> Vec<(Swatch, &'static str)> {
    let mut entries = Vec::new();
    if turns {
        entries.push((Swatch::Area(SKY, INK), "revolute joint"));
    }
    if slides {
        entries.push((Swatch::Area(ORANGE, INK), "prismatic joint"));
    }
    entries.push((Swatch::Area(BODY, INK), "link"));
    if entries.len() < 3 {
        entries.push((Swatch::Area(SHADOW, SHADOW), "shadow on the floor"));
    }
    let names = ["x axis", "y axis", "z axis (base, tool)"];
    entries.extend(AXES.map(Swatch::Line).into_iter().zip(names));
    entries
}

impl SpatialRobotFigure {
    fn head() -> f64 {
        12.0 + 2.0 * LEGEND_ROW + MARGIN
    }

    fn place(&self) -> Drawing {
        self.place_in([MARGIN, Self::head()], COLUMN - 2.0 * MARGIN)
    }

    /// Whether any joint turns, and whether any slides.
    pub(super) fn kinds(&self) -> [bool; 2] {
        [false, true].map(|kind| self.joints.iter().any(|joint| joint.slides == kind))
    }

    /// The robot as large as it fits below `corner` into `width` points.
    pub(super) fn place_in(&self, corner: Point, width: f64) -> Drawing {
        let ends = self.joints.iter().flat_map(|j| [j.entry, j.foot]);
        let points: Vec<Vector3<f64>> = ends
            .chain([Vector3::zeros(), self.tool.translation.vector])
            .collect();
        let [low, high] = bounds(points.iter().map(|point| (*point, 0.0)));
        let radius = RADIUS * (high - low).max().max(1e-6);
        let marks = joint_mark::place(&self.joints, radius);
        let view = best_view(&points, &marks, radius);
        let frames = [Isometry3::identity(), self.tool];
        let sides = sides(&points, &marks, &frames, radius);
        let (space, height) = Space::fit(view, sides, corner, [width, TALLEST * width]);
        Drawing {
            space,
            corner,
            width,
            links: self.links(&marks),
            marks,
            frames,
            radius,
            height,
        }
    }

    /// Corners of each link: out of its joint's mark, along the axis, across to the next axis and
    /// along it to the next mark.
    fn links(&self, marks: &[Mark]) -> Vec<Vec<Vector3<f64>>> {
        let mut links = Vec::with_capacity(marks.len() + 1);
        let mut corners = vec![Vector3::zeros()];
        for (joint, mark) in self.joints.iter().zip(marks) {
            corners.extend([joint.entry, mark.centre]);
            links.push(std::mem::replace(
                &mut corners,
                vec![mark.centre, joint.foot],
            ));
        }
        corners.push(self.tool.translation.vector);
        links.push(corners);
        for link in &mut links {
            link.dedup_by(|a, b| (*a - *b).norm() < 1e-9);
        }
        links
    }

    fn draw_legend(&self, canvas: &mut Canvas) {
        let [turns, slides] = self.kinds();
        let entries = legend_entries(turns, slides);
        let at = [14.0, 12.0 + 0.5 * LEGEND_ROW + 2.0];
        legend(canvas, at, COLUMN - 14.0 - MARGIN, 3, &entries);
    }
}

impl Drawing {
    pub(super) fn draw(&self, canvas: &mut Canvas) {
        self.space.draw_axes(canvas);
        self.draw_shadow(canvas);
        let mut scene = Scene::default();
        let nearness = |point: &Vector3<f64>| self.space.view.nearness(point);
        for mark in &self.marks {
            scene.add(nearness(&mark.centre), mark.shapes(&self.space));
        }
        for link in &self.links {
            self.add_link(&mut scene, link);
        }
        for frame in &self.frames {
            self.add_frame(&mut scene, frame);
        }
        scene.draw(canvas);
        self.draw_names(canvas);
    }

    fn draw_shadow(&self, canvas: &mut Canvas) {
        let floor = |p: &Vector3<f64>| self.space.at(&self.space.on_floor(p));
        let path: Vec<Point> = self.links.iter().flatten().map(floor).collect();
        canvas.stroke(&path, RIM_WIDTH, SHADOW);
        for frame in &self.frames {
            let at = frame.translation.vector;
            let line = [self.space.at(&at), floor(&at)];
            super::label::dashed(canvas, line[0], line[1], 0.5, GREY);
            canvas.disc(line[1], 1.2, GREY);
        }
    }

    /// A link in short pieces, each at its own distance; inside joints nothing is drawn.
    fn add_link(&self, scene: &mut Scene, corners: &[Vector3<f64>]) {
        for pair in corners.windows(2) {
            let pieces = ((pair[1] - pair[0]).norm() / (0.35 * self.radius)).ceil();
            let pieces = pieces.clamp(1.0, 200.0) as usize;
            let at = |k: usize| pair[0] + (k as f64 / pieces as f64) * (pair[1] - pair[0]);
            for k in 0..pieces {
                let middle = 0.5 * (at(k) + at(k + 1));
                if !self.is_inside(&middle) {
                    let shapes = rod(self.space.at(&at(k)), self.space.at(&at(k + 1)));
                    scene.add(self.space.view.nearness(&middle), shapes);
                }
            }
        }
        for corner in corners.iter().filter(|corner| !self.is_inside(corner)) {
            let at = self.space.at(corner);
            let discs = vec![
                Shape::Disc(at, 0.5 * RIM_WIDTH, INK),
                Shape::Disc(at, 0.5 * BODY_WIDTH, BODY),
            ];
            scene.add(self.space.view.nearness(corner), discs);
        }
    }

    fn is_inside(&self, point: &Vector3<f64>) -> bool {
        self.marks.iter().any(|mark| mark.holds(point))
    }

    fn add_frame(&self, scene: &mut Scene, frame: &Isometry3<f64>) {
        for (axis, colour) in AXES.into_iter().enumerate() {
            let from = frame.translation.vector;
            let to = self.arrow_tip(frame, axis);
            let line = [self.space.at(&from), self.space.at(&to)];
            // Arrows start within links and joints and must come out on top of them.
            let nearness = self.space.view.nearness(&(0.5 * (from + to))) + 1.5 * self.radius;
            scene.add(nearness, arrow(line, colour));
        }
    }

    fn arrow_tip(&self, frame: &Isometry3<f64>, axis: usize) -> Vector3<f64> {
        let along = frame.rotation * Vector3::ith(axis, ARROW * self.radius);
        frame.translation.vector + along
    }

    /// Joint numbers and the names of the two frames, where there is room.
    fn draw_names(&self, canvas: &mut Canvas) {
        let size = [self.width, self.height];
        let mut places = FreePlaces::new(self.occupied(), self.corner, size);
        for (number, mark) in (1..).zip(&self.marks) {
            let distance = self.radius * self.space.scale + 5.5;
            let at = places.take(self.space.at(&mark.centre), distance, 1.0);
            canvas.disc(at, 4.0, translucent(WHITE, 0.75));
            let text = format!("{number}");
            let label = Label::new(&text, SMALL).bold().align(HPos::Center);
            label.draw(canvas, [at[0], at[1] + super::style::HALF_CAPITAL * SMALL]);
        }
        for (frame, name) in self.frames.iter().zip(["base", "tool"]) {
            let at = places.take(self.space.at(&frame.translation.vector), 9.0, 2.6);
            centred(canvas, name, SMALL, at);
        }
    }

    /// Points of everything that names should not cover.
    fn occupied(&self) -> Vec<Point> {
        let mut points = self.space.text_places();
        let mut line = |from: Vector3<f64>, to: Vector3<f64>| {
            for k in 0..=12 {
                points.push(self.space.at(&(from + (f64::from(k) / 12.0) * (to - from))));
            }
        };
        for link in &self.links {
            link.windows(2).for_each(|pair| line(pair[0], pair[1]));
        }
        for mark in &self.marks {
            line(mark.end(-2.0), mark.end(2.0));
        }
        for corner in self.links.iter().flatten() {
            let shadow = self.space.on_floor(corner);
            line(shadow, shadow);
        }
        for [from, to] in self.space.axis_edges() {
            line(from, to);
        }
        for frame in &self.frames {
            for axis in 0..3 {
                line(frame.translation.vector, self.arrow_tip(frame, axis));
            }
        }
        points
    }
}

impl Figure for SpatialRobotFigure {
    fn name(&self) -> &'static str {
        "robot"
    }

    fn caption(&self) -> String {
        "The robot in a posture that shows its joints, numbered from the base, with its shadow on \
         the floor."
            .into()
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: Self::head() + self.place().height + MARGIN,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        // An underscore in a text makes an index of what follows.
        let title = self.title.replace('_', "-");
        let title = Label::new(&title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * COLUMN, 10.0], COLUMN - 2.0 * MARGIN);
        self.draw_legend(canvas);
        self.place().draw(canvas);
    }

    fn table(&self) -> Table {
        let columns = [
            "joint", "kind", "x_m", "y_m", "z_m", "axis_x", "axis_y", "axis_z",
        ];
        let mut table = Table::new(&columns);
        for (number, joint) in (1..).zip(&self.joints) {
            let kind = if joint.slides {
                "prismatic"
            } else {
                "revolute"
            };
            let (at, axis) = (
                joint.frame.translation.vector,
                joint.frame.rotation * Vector3::z(),
            );
            let mut row = vec![format!("{number}"), kind.to_owned()];
            row.extend(at.iter().chain(axis.iter()).map(|value| cell(*value)));
            table.rows.push(row);
        }
        table
    }
}
