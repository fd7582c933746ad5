//! How self-motion manifolds join at a singular configuration and part again [S1 Fig. 1].

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::Label;
use super::manifold::{ManifoldCurve, pieces, wrapped};
use super::manifold_figure::COLOURS;
use super::number::joint_symbol;
use super::panel::{BOTTOM, LEFT, Panel};
use super::style::{DOUBLE_COLUMN, INK, MARGIN, SMALL, TITLE, WHITE};
use super::table::{Table, cell};
use super::ticks::quarters;
use crate::angle::wrap;
use plotters::style::text_anchor::HPos;

/// The manifolds of one location.
#[derive(Clone, Debug)]
pub struct SplitPanel {
    /// What tells the location from the others, as in "1 mm beside".
    pub title: String,
    /// Its manifolds.
    pub curves: Vec<ManifoldCurve>,
    /// Sum of all joint ranges, radians.
    pub size: f64,
}

/// The manifolds before, at and behind a singular configuration.
#[derive(Clone, Debug)]
pub struct SplitFigure {
    /// The locations in order.
    pub panels: Vec<SplitPanel>,
    /// The singular configuration.
    pub node: Vec<f64>,
    /// Numbers of the joints of the axes, from 1.
    pub joints: [usize; 2],
    /// Number of joints of the robot.
    pub joint_count: usize,
    /// Title above the panels; none if empty.
    pub title: String,
}

const GAP: f64 = 24.0;
const HEAD: f64 = 34.0;

impl SplitFigure {
    fn side(&self) -> f64 {
        let count = self.panels.len().max(1) as f64;
        (DOUBLE_COLUMN - LEFT - MARGIN - 6.0 - (count - 1.0) * GAP) / count
    }
}

impl Figure for SplitFigure {
    fn name(&self) -> &'static str {
        "split"
    }

    fn caption(&self) -> String {
        "Self-motion manifolds of three neighbouring locations: in the middle the one of a singular \
         configuration (dot), at which manifolds meet; to either side the tool is moved along the \
         direction that is lost there, and the manifolds part in one way or the other. Colours \
         tell the manifolds of a panel apart."
            .into()
    }

    fn size(&self) -> Size {
        Size {
            width: DOUBLE_COLUMN,
            height: HEAD + self.side() + BOTTOM + 2.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        let middle = [0.5 * DOUBLE_COLUMN, 12.0];
        title.draw_within(canvas, middle, DOUBLE_COLUMN - 2.0 * MARGIN);
        let [a, b] = self.joints.map(|joint| joint.saturating_sub(1));
        let ticks = quarters();
        for (place, part) in self.panels.iter().enumerate() {
            let side = self.side();
            let panel = Panel {
                left: LEFT + place as f64 * (side + GAP),
                top: HEAD,
                width: side,
                height: side,
                x: [-180.0, 180.0],
                y: [-180.0, 180.0],
            };
            let text = match part.size.is_finite() {
                true => format!("{}: {:.2} rad", part.title, part.size),
                false => part.title.clone(),
            };
            Label::new(&text, SMALL).bold().draw_within(
                canvas,
                [panel.left, panel.top - 5.0],
                side,
            );
            panel.grid(canvas, &ticks);
            panel.upright_grid(canvas, &ticks);
            for (k, curve) in part.curves.iter().enumerate() {
                for piece in pieces(curve, self.joint_count, None) {
                    for line in wrapped(&piece.points, [a, b]) {
                        canvas.stroke(&panel.path(&line), 1.1, COLOURS[k % COLOURS.len()]);
                    }
                }
            }
            if 2 * place + 1 == self.panels.len()
                && let (Some(x), Some(y)) = (self.node.get(a), self.node.get(b))
            {
                let at = panel.at(wrap(*x).to_degrees(), wrap(*y).to_degrees());
                canvas.disc(at, 3.0, WHITE);
                canvas.disc(at, 2.2, INK);
            }
            panel.axes(canvas, &ticks, &ticks, place == 0);
            panel.x_label(canvas, &format!("{} (deg)", joint_symbol(self.joints[0])));
            if place == 0 {
                panel.y_label(
                    canvas,
                    &format!("{} (deg)", joint_symbol(self.joints[1])),
                    &ticks,
                );
            }
        }
    }

    fn table(&self) -> Table {
        let mut header = vec!["location".to_owned(), "curve".into(), "vertex".into()];
        header.extend((1..=self.joint_count).map(|k| format!("theta_{k}_deg")));
        let mut table = Table {
            header,
            rows: Vec::new(),
        };
        for (place, panel) in (1..).zip(&self.panels) {
            for (number, curve) in (1..).zip(&panel.curves) {
                for (vertex, point) in (1..).zip(&curve.points) {
                    let mut row =
                        vec![format!("{place}"), format!("{number}"), format!("{vertex}")];
                    row.extend(point.iter().map(|angle| cell(angle.to_degrees())));
                    table.rows.push(row);
                }
            }
        }
        table
    }
}
