//! Cross-sections of a spatial workspace in space, the quarter of the horizontal one that is
//! turned to the viewer cut away.

use super::axonometry::{Axis, AxisBox, Camera, Point3};
use super::canvas::{Canvas, Point};
use super::sections::{Layer, Plane, Sections};
use super::style::{GREY, INK, REACHABLE};
use super::ticks;
use plotters::style::RGBAColor;
use smallvec::SmallVec;

/// The viewer stands here, radians.
const AZIMUTH: f64 = -0.95;
const ELEVATION: f64 = 0.45;

/// How much of what lies behind the grey of the unrestricted workspace is hidden.
const VEIL: f64 = 0.4;

/// Sections in a box.
pub(super) struct SectionView<'a> {
    sections: &'a Sections<'a>,
    scene: AxisBox,
    planes: [Plane; 3],
}

impl<'a> SectionView<'a> {
    /// A view that fills the rectangle from `corner` over `size` points.
    pub(super) fn new(sections: &'a Sections<'a>, corner: Point, size: Point) -> SectionView<'a> {
        let reach = sections.reach;
        let range = [
            [-reach, -reach, sections.z[0]],
            [reach, reach, sections.z[1]],
        ];
        let camera = Camera::new(AZIMUTH, ELEVATION);
        SectionView {
            sections,
            scene: AxisBox::fitting(camera, range, corner, size),
            planes: sections.planes(),
        }
    }

    pub(super) fn draw(&self, canvas: &mut Canvas) {
        let [from, to] = self.scene.extent();
        let size = [to[0] - from[0], to[1] - from[1]];
        canvas.picture(from, size, |x, y| self.colour([x, y]));
        let (reach, z) = (self.sections.reach, self.sections.z);
        let axis = |label, axis, [low, high]: [f64; 2]| Axis {
            label,
            ticks: ticks::round(low, high, self.scene.room(axis)),
        };
        let axes = [
            axis("x (m)", 0, [-reach, reach]),
            axis("y (m)", 1, [-reach, reach]),
            axis("z (m)", 2, z),
        ];
        for line in self.scene.back(&axes) {
            self.draw_hidden(canvas, &line, 0.4, super::style::GRID);
        }
        for plane in self.planes {
            for curve in self.sections.curves(plane) {
                let curve: Vec<Point3> = curve.iter().map(|p| plane.lift(*p)).collect();
                self.draw_hidden(canvas, &curve, 0.6, GREY);
            }
        }
        let height = self.sections.height;
        for line in [
            [[-reach, 0.0, height], [reach, 0.0, height]],
            [[0.0, -reach, height], [0.0, reach, height]],
            [[0.0, 0.0, z[0]], [0.0, 0.0, z[1]]],
        ] {
            self.draw_hidden(canvas, &line, 0.3, INK);
        }
        self.scene.draw_axes(canvas, &axes);
    }

    /// What the line of sight through a point of the sheet meets, nearest first; with its depth.
    fn hits(&self, sheet: Point) -> SmallVec<[(f64, Layer); 3]> {
        let mut hits: SmallVec<[(f64, Layer); 3]> = SmallVec::new();
        for plane in self.planes {
            let Some(p) = self.scene.on_plane(sheet, plane.axis, plane.value) else {
                continue;
            };
            let layer = self.layer_at(plane, p);
            if layer != Layer::Outside {
                hits.push((self.scene.depth(p), layer));
            }
        }
        hits.sort_by(|a, b| b.0.total_cmp(&a.0));
        hits
    }

    /// What is at a point of a plane, nothing in the quarter that is cut away.
    fn layer_at(&self, plane: Plane, p: Point3) -> Layer {
        let near = self.scene.near();
        let is_cut = plane.axis == 2 && (0..2).all(|c| (p[c] > 0.0) == near[c]);
        match is_cut {
            true => Layer::Outside,
            false => self.sections.layer_at(p),
        }
    }

    /// Colours are opaque, grey is a veil: what lies behind it shows through.
    fn colour(&self, sheet: Point) -> [u8; 3] {
        let mut sum = [0.0; 3];
        let mut left = 1.0;
        for (_, layer) in self.hits(sheet) {
            let (colour, share) = match layer {
                Layer::Share(share) => (self.sections.scale.colour(share), 1.0),
                _ => (REACHABLE, VEIL),
            };
            let parts = [colour.0, colour.1, colour.2];
            sum = std::array::from_fn(|c| sum[c] + left * share * f64::from(parts[c]));
            left *= 1.0 - share;
        }
        sum.map(|part| (part + 255.0 * left).round() as u8)
    }

    /// Draws the parts of a line that no colour hides.
    fn draw_hidden(&self, canvas: &mut Canvas, line: &[Point3], width: f64, colour: RGBAColor) {
        let mut run: Vec<Point> = Vec::new();
        for pair in line.windows(2) {
            let ends = [pair[0], pair[1]].map(|p| self.scene.at(p));
            let length = (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]);
            let steps = (length / 0.5).ceil().clamp(1.0, 2e3) as usize;
            for k in 0..steps {
                let at = |t: f64| -> Point3 {
                    std::array::from_fn(|c| pair[0][c] + t * (pair[1][c] - pair[0][c]))
                };
                let [t, next] = [k, k + 1].map(|k| k as f64 / steps as f64);
                if self.is_visible(at(0.5 * (t + next))) {
                    if run.is_empty() {
                        run.push(self.scene.at(at(t)));
                    }
                    run.push(self.scene.at(at(next)));
                } else if !run.is_empty() {
                    canvas.stroke(&run, width, colour);
                    run.clear();
                }
            }
        }
        canvas.stroke(&run, width, colour);
    }

    fn is_visible(&self, p: Point3) -> bool {
        let own = self.scene.depth(p) + 1e-6 * self.sections.reach;
        let mut hits = self.hits(self.scene.at(p)).into_iter();
        !hits.any(|(depth, layer)| depth > own && layer != Layer::Reachable)
    }
}
