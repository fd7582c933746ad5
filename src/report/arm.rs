//! The arm in the plane, with its artificial limits as wedges at the joints.

use super::canvas::Canvas;
use super::canvas::Point;
use super::label::rectangle;
use super::panel::Panel;
use super::polar;
use super::style::{INK, VERMILLION, WHITE, translucent};
use crate::workspace::{ArtificialLimits, JointLimit};
use plotters::style::RGBAColor;

/// A planar arm standing at given joint angles.
pub(super) struct Arm {
    /// Joints from the base to the tip, metres; one more than links.
    joints: Vec<Point>,
    /// Direction of the link before each joint, radians; 0 before joint 1.
    before: Vec<f64>,
    /// The shortest link of length above zero, metres.
    shortest: f64,
}

impl Arm {
    /// The arm of `links` (metres) at joint angles `angles` (radians); missing angles are 0.
    pub(super) fn new(links: &[f64], angles: &[f64]) -> Arm {
        let (mut at, mut direction) = ([0.0, 0.0], 0.0);
        let (mut joints, mut before) = (vec![at], Vec::new());
        for (k, link) in links.iter().enumerate() {
            before.push(direction);
            direction += angles.get(k).copied().unwrap_or(0.0);
            at = polar::point(at, *link, direction);
            joints.push(at);
        }
        let lengths = links.iter().map(|l| l.abs()).filter(|l| *l > 0.0);
        Arm {
            joints,
            before,
            shortest: lengths.fold(f64::INFINITY, f64::min),
        }
    }

    /// Draws the arm with its limits: links with a white rim, joints as circles, the base as a
    /// square, the tip as a dot; the limits of every joint as a wedge about the direction of the
    /// previous link, a disc for a free joint, a ray for a joint held still.
    pub(super) fn draw(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        limits: &ArtificialLimits,
        wedge: RGBAColor,
    ) {
        let path = panel.path(&self.joints);
        let (Some(base), Some(tip)) = (path.first(), path.last()) else {
            return;
        };
        let wedges = self.wedges(panel, limits);
        for corners in &wedges {
            canvas.fill(corners, wedge);
        }
        canvas.stroke(&path, 3.0, translucent(WHITE, 0.9));
        canvas.stroke(&path, 1.7, INK);
        canvas.fill(&rectangle(base[0] - 3.5, base[1] - 3.5, 7.0, 7.0), INK);
        for corners in &wedges {
            canvas.outline(corners, 0.7, VERMILLION);
        }
        for joint in &path[..path.len() - 1] {
            canvas.disc(*joint, 2.7, INK);
            canvas.disc(*joint, 1.7, WHITE);
        }
        canvas.disc(*tip, 2.6, WHITE);
        canvas.disc(*tip, 2.1, INK);
    }

    /// The corners of the limits' wedges on the sheet.
    fn wedges(&self, panel: &Panel, limits: &ArtificialLimits) -> Vec<Vec<Point>> {
        let reach = panel.x[1];
        let radius = (0.45 * self.shortest).clamp(0.085 * reach, 0.13 * reach);
        let placed = limits.joints().iter().zip(&self.before).zip(&self.joints);
        let wedge = |((limit, before), joint): ((&JointLimit, &f64), &Point)| {
            let (start, width) = (before + limit.lower, limit.width());
            let is_drawable = start.is_finite() && width.is_finite();
            is_drawable.then(|| panel.path(&polar::sector(*joint, [0.0, radius], start, width)))
        };
        placed.filter_map(wedge).collect()
    }
}
