//! Which locks on the way to a goal still let the robot reach it [S1 §IV.D].

use super::canvas::{Canvas, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend, rectangle};
use super::number::joint_symbol;
use super::panel::{BOTTOM, Panel};
use super::style::{BLUE, COLUMN, HALF_CAPITAL, INK, MARGIN, SMALL, TITLE, VERMILLION};
use super::table::{Table, cell};
use super::ticks;
use plotters::style::text_anchor::HPos;

/// One lock.
#[derive(Clone, Debug, PartialEq)]
pub struct LockMark {
    /// Number of the joint, from 1.
    pub joint: usize,
    /// Share of the way at which it locked.
    pub share: f64,
    /// Its angle there, radians (metres for prismatic joints).
    pub angle: f64,
    /// Whether the goal was reached.
    pub is_reached: bool,
    /// Distance of the nearest pose from the goal, metres.
    pub position_error: f64,
    /// Its difference in orientation, radians.
    pub orientation_error: f64,
}

/// The locks on the way to one goal.
#[derive(Clone, Debug, PartialEq)]
pub struct GoalLocks {
    /// The goal's name.
    pub name: String,
    /// Its locks, joint by joint along the way.
    pub locks: Vec<LockMark>,
}

/// The locks of all goals.
#[derive(Clone, Debug)]
pub struct LocksFigure {
    /// The goals.
    pub goals: Vec<GoalLocks>,
    /// Title above the plot; none if empty.
    pub title: String,
}

const ROW: f64 = 9.0;
const GROUP: f64 = 15.0;
const NAMES: f64 = 30.0;

impl LocksFigure {
    fn joints(goal: &GoalLocks) -> Vec<usize> {
        let mut joints: Vec<usize> = goal.locks.iter().map(|lock| lock.joint).collect();
        joints.dedup();
        joints
    }

    fn head() -> f64 {
        18.0 + LEGEND_ROW
    }

    fn height(&self) -> f64 {
        let rows = |goal: &GoalLocks| Self::joints(goal).len() as f64 * ROW + GROUP;
        self.goals.iter().map(rows).sum()
    }
}

/// The row of one joint: its name, its locks and how many are survived.
fn draw_row(canvas: &mut Canvas, panel: &Panel, y: f64, goal: &GoalLocks, joint: usize) {
    let own: Vec<&LockMark> = goal
        .locks
        .iter()
        .filter(|lock| lock.joint == joint)
        .collect();
    let base = y + 0.5 * ROW + HALF_CAPITAL * SMALL;
    let symbol = joint_symbol(joint);
    Label::new(&symbol, SMALL)
        .align(HPos::Right)
        .draw(canvas, [NAMES - 4.0, base]);
    let last = own.len().saturating_sub(1);
    for (k, lock) in own.iter().enumerate() {
        // Each lock stands for the part of the way nearest to it.
        let from = if k == 0 {
            0.0
        } else {
            0.5 * (own[k - 1].share + lock.share)
        };
        let to = if k == last {
            1.0
        } else {
            0.5 * (own[k + 1].share + lock.share)
        };
        let [left, right] = [from, to].map(|share| panel.at(100.0 * share, 0.0)[0]);
        let colour = if lock.is_reached { BLUE } else { VERMILLION };
        canvas.fill(
            &rectangle(left, y + 1.5, right - left + 0.1, ROW - 3.0),
            colour,
        );
    }
    let reached = own.iter().filter(|lock| lock.is_reached).count();
    let text = format!("{:.0} %", 100.0 * reached as f64 / own.len().max(1) as f64);
    let at = [panel.left + panel.width + 30.0, base];
    Label::new(&text, SMALL).align(HPos::Right).draw(canvas, at);
}

impl Figure for LocksFigure {
    fn name(&self) -> &'static str {
        "locks"
    }

    fn caption(&self) -> String {
        "Locks on the straight way in joint space from the start to each goal: whether the other \
         joints still reach the goal after the joint of the row has locked at that point of the \
         way. Percentages: share of a joint's locks that are survived."
            .into()
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: Self::head() + self.height() + BOTTOM + 4.0,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * COLUMN, 12.0], COLUMN - 2.0 * MARGIN);
        let entries = [
            (Swatch::Area(BLUE, INK), "goal reached"),
            (Swatch::Area(VERMILLION, INK), "goal out of reach"),
        ];
        legend(canvas, [NAMES, 22.0], COLUMN - NAMES - MARGIN, 2, &entries);
        let panel = Panel {
            left: NAMES,
            top: Self::head(),
            width: COLUMN - NAMES - 34.0,
            height: self.height() + 2.0,
            x: [0.0, 100.0],
            y: [0.0, 1.0],
        };
        let mut y = panel.top;
        for goal in &self.goals {
            Label::new(&goal.name, SMALL).bold().draw_within(
                canvas,
                [NAMES + 3.0, y + 11.0],
                COLUMN - NAMES - MARGIN,
            );
            y += GROUP;
            for joint in Self::joints(goal) {
                draw_row(canvas, &panel, y, goal, joint);
                y += ROW;
            }
        }
        panel.axes(canvas, &ticks::round(0.0, 100.0, 5), &[], true);
        panel.x_label(canvas, "share of the way at which the joint locks (%)");
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&[
            "goal",
            "joint",
            "share",
            "angle_deg_or_m",
            "reached",
            "position_error_m",
            "orientation_error_deg",
        ]);
        for goal in &self.goals {
            for lock in &goal.locks {
                table.rows.push(vec![
                    goal.name.clone(),
                    lock.joint.to_string(),
                    cell(lock.share),
                    cell(lock.angle),
                    lock.is_reached.to_string(),
                    cell(lock.position_error),
                    cell(lock.orientation_error.to_degrees()),
                ]);
            }
        }
        table
    }
}
