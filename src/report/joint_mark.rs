//! A joint in space: a drum about its axis if it turns, a box along its axis if it slides.

use super::canvas::Point;
use super::projection::Space;
use super::robot_3d::JointMark;
use super::scene::{Shape, hull};
use super::style::{GREY, INK, ORANGE, SKY};
use nalgebra::Vector3;
use plotters::style::RGBAColor;
use std::f64::consts::TAU;

/// Half the height of a drum, in radii.
const HALF_HEIGHT: f64 = 0.75;
/// Corners of a drum's rim.
const CORNERS: usize = 40;
/// Least distance between the centres of two marks, in radii.
const APART: f64 = 1.75;

/// Where and how a joint is drawn.
#[derive(Clone, Debug)]
pub(super) struct Mark {
    /// Middle of the drum or box, a point of the joint's axis.
    pub centre: Vector3<f64>,
    /// Unit vectors along the axis and across it.
    axes: [Vector3<f64>; 3],
    pub slides: bool,
    /// Radius of a drum, half the width of a box; metres.
    pub radius: f64,
}

/// Chooses where on its axis each joint is drawn, so that no two are in one place: in the middle
/// between where links come in and leave, or moved along the axis.
pub(super) fn place(joints: &[JointMark], radius: f64) -> Vec<Mark> {
    let mut marks: Vec<Mark> = Vec::with_capacity(joints.len());
    // From the tool on: it is best joint 1 that gives way, downwards like a pedestal.
    for joint in joints.iter().rev() {
        let mut mark = Mark::new(joint, radius);
        let back = (joint.entry - mark.centre).dot(&mark.axes[2]);
        let sign = if back > 0.1 * radius { 1.0 } else { -1.0 };
        let start = mark.centre;
        // 0, then one step back, one forth, two back, …
        let moves = (0..16).map(|k| if k % 2 == 1 { sign } else { -sign } * f64::from((k + 1) / 2));
        let is_free = |at: &Vector3<f64>| {
            let apart = |mark: &Mark| (mark.centre - at).norm() > APART * radius;
            marks.iter().all(apart)
        };
        let mut places = moves.map(|step| start + 0.8 * radius * step * mark.axes[2]);
        mark.centre = places.find(is_free).unwrap_or(start);
        marks.push(mark);
    }
    marks.reverse();
    marks
}

impl Mark {
    fn new(joint: &JointMark, radius: f64) -> Mark {
        let axes = [0, 1, 2].map(|k| joint.frame.rotation * Vector3::ith(k, 1.0));
        // A box guides the slide: it stays where the link comes in.
        let is_long = !joint.slides && (joint.foot - joint.entry).norm() > 2.0 * radius;
        Mark {
            centre: if is_long {
                0.5 * (joint.entry + joint.foot)
            } else {
                joint.entry
            },
            axes,
            slides: joint.slides,
            radius,
        }
    }

    fn half_height(&self) -> f64 {
        self.radius * if self.slides { 1.3 } else { HALF_HEIGHT }
    }

    /// Whether a point is inside the drum or box.
    pub(super) fn holds(&self, point: &Vector3<f64>) -> bool {
        let offset = point - self.centre;
        let along = offset.dot(&self.axes[2]);
        let across = (offset - along * self.axes[2]).norm();
        along.abs() < self.half_height() && across < self.radius
    }

    /// The end of the mark on the given side of its axis.
    pub(super) fn end(&self, side: f64) -> Vector3<f64> {
        self.centre + side * self.half_height() * self.axes[2]
    }

    /// The corners of both ends.
    fn ends(&self) -> [Vec<Vector3<f64>>; 2] {
        let (corners, start, stretch) = match self.slides {
            true => (4, TAU / 8.0, 1.25),
            false => (CORNERS, 0.0, 1.0),
        };
        [-1.0, 1.0].map(|side| {
            let corner = |k: usize| {
                let (sine, cosine) = (start + TAU * k as f64 / corners as f64).sin_cos();
                let across = cosine * self.axes[0] + sine * self.axes[1];
                self.end(side) + stretch * self.radius * across
            };
            (0..corners).map(corner).collect()
        })
    }

    /// The drum or box with a piece of its axis.
    pub(super) fn shapes(&self, space: &Space) -> Vec<Shape> {
        let (body, cap) = match self.slides {
            true => (ORANGE, lighter(ORANGE)),
            false => (SKY, lighter(SKY)),
        };
        let ends = self.ends();
        let axis = [-1.0, 1.0].map(|side| {
            let beyond = side * (self.half_height() + 1.1 * self.radius);
            space.at(&(self.centre + beyond * self.axes[2]))
        });
        let around = hull(&space.path(&ends.concat()));
        let mut shapes = vec![
            Shape::Line(axis.to_vec(), 0.5, GREY),
            Shape::Area(around.clone(), body),
        ];
        if self.slides {
            shapes.extend(self.edges(space, &ends));
        }
        let nearer = usize::from(space.view.nearness(&self.axes[2]) > 0.0);
        let near = space.path(&ends[nearer]);
        shapes.push(Shape::Area(near.clone(), cap));
        shapes.push(closed(near));
        shapes.push(closed(around));
        // The near half of the axis is before the drum.
        let top = space.at(&self.end([-1.0, 1.0][nearer]));
        shapes.push(Shape::Line(vec![top, axis[nearer]], 0.5, GREY));
        shapes
    }

    /// The long edges of a box that can be seen.
    fn edges(&self, space: &Space, ends: &[Vec<Vector3<f64>>; 2]) -> Vec<Shape> {
        let visible = |k: &usize| {
            let across = ends[0][*k] - self.end(-1.0);
            space.view.nearness(&across) > 0.0
        };
        let edge = |k: usize| Shape::Line(space.path(&[ends[0][k], ends[1][k]]), 0.5, INK);
        (0..ends[0].len()).filter(visible).map(edge).collect()
    }
}

fn closed(mut corners: Vec<Point>) -> Shape {
    corners.extend(corners.first().copied());
    Shape::Line(corners, 0.6, INK)
}

fn lighter(colour: RGBAColor) -> RGBAColor {
    let half = |c: u8| c / 2 + 127;
    RGBAColor(half(colour.0), half(colour.1), half(colour.2), 1.0)
}
