//! Singular configurations joint by joint: where each rank is lost.

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend};
use super::number::joint_symbol;
use super::panel::{BOTTOM, Panel};
use super::style::{
    BLUE, DOUBLE_COLUMN, GRID, HALF_CAPITAL, MARGIN, NORMAL, ORANGE, PURPLE, TITLE, VERMILLION,
    WHITE,
};
use super::table::{Table, cell};
use super::ticks::quarters;
use crate::angle::wrap;
use plotters::style::RGBAColor;
use plotters::style::text_anchor::HPos;

/// A singular configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct SingularPoint {
    /// Angles of all joints, radians.
    pub configuration: Vec<f64>,
    /// By how much the Jacobian falls short of full rank.
    pub loss: usize,
    /// Singular values, greatest first.
    pub sigma: Vec<f64>,
    /// Starts that ended there.
    pub hits: usize,
    /// Number of its family, from 1.
    pub family: usize,
}

/// All singular configurations that were found.
#[derive(Clone, Debug)]
pub struct SingularityFigure<'a> {
    /// The configurations.
    pub points: &'a [SingularPoint],
    /// Number of joints.
    pub joint_count: usize,
    /// Full rank m.
    pub rank: usize,
    /// Title above the plot; none if empty.
    pub title: String,
}

/// Colours of rank losses 1, 2 …
pub(super) const LOSSES: [RGBAColor; 4] = [BLUE, VERMILLION, PURPLE, ORANGE];
/// Height of a rank's lane in a joint's row, points.
const LANE: f64 = 6.5;

/// The colour of a rank loss.
pub(super) fn loss_colour(loss: usize) -> RGBAColor {
    LOSSES[loss.saturating_sub(1).min(LOSSES.len() - 1)]
}

impl SingularityFigure<'_> {
    fn losses(&self) -> Vec<usize> {
        let mut losses: Vec<usize> = self.points.iter().map(|point| point.loss).collect();
        losses.sort_unstable();
        losses.dedup();
        losses
    }

    fn row(&self) -> f64 {
        self.losses().len().max(1) as f64 * LANE + 3.0
    }

    fn head() -> f64 {
        16.0 + LEGEND_ROW + MARGIN
    }
}

impl Figure for SingularityFigure<'_> {
    fn name(&self) -> &'static str {
        "singularities"
    }

    fn caption(&self) -> String {
        format!(
            "Singular configurations, one mark for each in every row: the angle of the joint at \
             which the Jacobian has lost rank (full rank {}). A row whose marks stand at a few \
             angles belongs to a joint that makes the arm singular; one whose marks spread does \
             not matter.",
            self.rank
        )
    }

    fn size(&self) -> Size {
        Size {
            width: DOUBLE_COLUMN,
            height: Self::head() + self.joint_count as f64 * self.row() + BOTTOM + 2.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        let middle = [0.5 * DOUBLE_COLUMN, 12.0];
        title.draw_within(canvas, middle, DOUBLE_COLUMN - 2.0 * MARGIN);
        let losses = self.losses();
        let entry = |loss: &usize| {
            let count = self.points.iter().filter(|p| p.loss == *loss).count();
            let text = format!("rank {} ({count} found)", self.rank.saturating_sub(*loss));
            (Swatch::Dot(loss_colour(*loss)), text)
        };
        let entries: Vec<(Swatch, String)> = losses.iter().map(entry).collect();
        let entries: Vec<(Swatch, &str)> = entries.iter().map(|(s, t)| (*s, t.as_str())).collect();
        let left = 40.0;
        legend(canvas, [left, 22.0], 360.0, entries.len(), &entries);
        let panel = Panel {
            left,
            top: Self::head(),
            width: DOUBLE_COLUMN - left - MARGIN - 8.0,
            height: self.joint_count as f64 * self.row(),
            x: [-180.0, 180.0],
            y: [0.0, 1.0],
        };
        panel.upright_grid(canvas, &quarters());
        for joint in 0..self.joint_count {
            let top = panel.top + joint as f64 * self.row();
            if joint > 0 {
                canvas.stroke(&[[left, top], [left + panel.width, top]], 0.4, GRID);
            }
            let at = [left - 5.0, top + 0.5 * self.row() + HALF_CAPITAL * NORMAL];
            let symbol = joint_symbol(joint + 1);
            Label::new(&symbol, NORMAL)
                .align(HPos::Right)
                .draw(canvas, at);
            for point in self.points {
                let Some(angle) = point.configuration.get(joint).filter(|a| a.is_finite()) else {
                    continue;
                };
                let lane = losses.iter().position(|loss| *loss == point.loss);
                let y = top + 1.5 + (lane.unwrap_or(0) as f64 + 0.5) * LANE;
                let x = panel.at(wrap(*angle).to_degrees(), 0.0)[0];
                canvas.disc([x, y], 1.9, WHITE);
                canvas.disc([x, y], 1.5, loss_colour(point.loss));
            }
        }
        panel.axes(canvas, &quarters(), &[], true);
        panel.x_label(canvas, "joint angle (deg)");
        if self.points.is_empty() {
            panel.remark(canvas, "no singular configuration was found");
        }
    }

    fn table(&self) -> Table {
        let mut header = vec!["rank".to_owned(), "family".into(), "starts".into()];
        header.extend((1..=self.joint_count).map(|k| format!("theta_{k}_deg")));
        header.extend((1..=self.rank).map(|k| format!("sigma_{k}")));
        let row = |point: &SingularPoint| {
            let mut row = vec![
                self.rank.saturating_sub(point.loss).to_string(),
                point.family.to_string(),
                point.hits.to_string(),
            ];
            row.extend(point.configuration.iter().map(|a| cell(a.to_degrees())));
            row.extend(point.sigma.iter().map(|s| cell(*s)));
            row
        };
        Table {
            header,
            rows: self.points.iter().map(row).collect(),
        }
    }
}
