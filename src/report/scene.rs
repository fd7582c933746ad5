//! Flat shapes at distances from the viewer, drawn from the farthest to the nearest.

use super::canvas::{Canvas, Point};
use plotters::style::RGBAColor;

/// A flat part of a scene, in points of the sheet.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    Area(Vec<Point>, RGBAColor),
    Line(Vec<Point>, f64, RGBAColor),
    Disc(Point, f64, RGBAColor),
}

/// Shapes in groups, each at one distance from the viewer.
#[derive(Default)]
pub(super) struct Scene {
    groups: Vec<(f64, Vec<Shape>)>,
}

impl Scene {
    /// Adds shapes that are drawn in the given order, `nearness` metres towards the viewer.
    pub(super) fn add(&mut self, nearness: f64, shapes: Vec<Shape>) {
        self.groups.push((nearness, shapes));
    }

    /// Draws everything, the farthest first; groups of one distance in the order they came.
    pub(super) fn draw(mut self, canvas: &mut Canvas) {
        self.groups.sort_by(|a, b| a.0.total_cmp(&b.0));
        for shape in self.groups.into_iter().flat_map(|(_, shapes)| shapes) {
            match shape {
                Shape::Area(points, colour) => canvas.fill(&points, colour),
                Shape::Line(points, width, colour) => canvas.stroke(&points, width, colour),
                Shape::Disc(centre, radius, colour) => canvas.disc(centre, radius, colour),
            }
        }
    }
}

/// The corners of the convex hull of points, in order around it.
pub(super) fn hull(points: &[Point]) -> Vec<Point> {
    let mut sorted: Vec<Point> = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let turn = |a: &Point, b: &Point, c: &Point| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let half = |order: &mut dyn Iterator<Item = &Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for point in order {
            while chain.len() >= 2
                && turn(&chain[chain.len() - 2], &chain[chain.len() - 1], point) <= 0.0
            {
                chain.pop();
            }
            chain.push(*point);
        }
        chain.pop();
        chain
    };
    let mut around = half(&mut sorted.iter());
    around.extend(half(&mut sorted.iter().rev()));
    around
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hulls_keep_the_outer_points() {
        let points = [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.5, 0.5],
            [1.0, 1.0],
            [0.0, 1.0],
            [0.5, 0.0],
        ];
        assert_eq!(
            hull(&points),
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        );
        assert!(hull(&[]).is_empty() && hull(&[[1.0, 1.0]]).len() <= 1);
    }
}
