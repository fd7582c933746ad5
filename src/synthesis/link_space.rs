//! Which robots are searched: for every Denavit–Hartenberg parameter a value, bounds or a list.
//!
//! Scaling a robot changes none of its shares, so robots are searched at one size: the reach R,
//! the largest distance of the tool from the origin of joint 1's frame. Lengths are shares of R
//! in here; [`LinkSpace::robot`] gives them the wanted reach in metres.

use crate::design::{Convention, Geometry, Joint, JointKind, Link, Robot, TaskSpace};
use crate::kinematics::rough_reach;
use nalgebra::Isometry3;
use rand::Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, TAU};

/// What is known of one parameter beforehand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Parameter {
    /// It has this value.
    Fixed(f64),
    /// It lies between these, both included.
    Bounded([f64; 2]),
    /// It is one of these, at least one.
    OneOf(Vec<f64>),
}

/// A row of the search space: twist α (radians), length a and offset d (shares of the reach).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LinkRow {
    /// α.
    pub twist: Parameter,
    /// a.
    pub length: Parameter,
    /// d.
    pub offset: Parameter,
}

/// One of the three constants of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Column {
    /// Twist α, radians.
    Twist,
    /// Length a, shares of the reach.
    Length,
    /// Offset d, shares of the reach.
    Offset,
}

/// The constants of one row of a candidate: twist in radians, lengths as shares of the reach.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Constants {
    /// α, radians.
    pub twist: f64,
    /// a.
    pub length: f64,
    /// d.
    pub offset: f64,
}

/// A candidate's links, joint 1 first.
pub type Links = Vec<Constants>;

/// Robots of n revolute joints in standard Denavit–Hartenberg rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LinkSpace {
    rows: Vec<LinkRow>,
    task: TaskSpace,
}

/// One unit of a search variable: a radian for twists, this share of the reach for lengths, so
/// that a step changes the workspace about as much along each.
const LENGTH_UNIT: f64 = 0.35;

/// Probability that a random parameter is 0 where its bounds allow it: the best robots have axes
/// that intersect, which uniform draws never hit.
const ZERO: f64 = 0.2;

/// Probability that all twists with bounds are drawn from the right angles inside them: such
/// robots are far better than others on average.
const RIGHT_ANGLES: f64 = 0.7;

/// Robots of a smaller reach are points.
const LEAST_REACH: f64 = 1e-6;

/// A reach this near to 1 is 1: the reach itself is not known better.
const SETTLED: f64 = 1e-4;

/// Rounds of scaling and putting back into bounds; each changes the reach less.
const ROUNDS: usize = 6;

impl LinkSpace {
    /// The space of the given rows. Parameters that change no share are set to 0, whatever is said
    /// of them: d₁, the last twist and, for poses, the last length and offset; see
    /// [`LinkSpace::idle`].
    pub fn new(mut rows: Vec<LinkRow>, task: TaskSpace) -> LinkSpace {
        let n = rows.len();
        for (index, column) in idle(n, task) {
            *rows[index].parameter_mut(column) = Parameter::Fixed(0.0);
        }
        LinkSpace { rows, task }
    }

    /// Parameters (row from 0) of an arm of n joints that change neither S_F nor S_0max.
    pub fn idle(n: usize, task: TaskSpace) -> Vec<(usize, Column)> {
        idle(n, task)
    }

    /// The number of joints n.
    pub fn joints(&self) -> usize {
        self.rows.len()
    }

    /// What the tool is asked to reach.
    pub fn task(&self) -> TaskSpace {
        self.task
    }

    /// The rows.
    pub fn rows(&self) -> &[LinkRow] {
        &self.rows
    }

    /// Parameters with bounds, row by row; twists only `with_twists`.
    pub fn variables(&self, with_twists: bool) -> Vec<(usize, Column)> {
        let is_searched = |&(row, column): &(usize, Column)| {
            let parameter = self.rows[row].parameter(column);
            matches!(parameter, Parameter::Bounded([low, high]) if low < high)
                && (with_twists || column != Column::Twist)
        };
        let all = (0..self.rows.len()).flat_map(|row| COLUMNS.map(|column| (row, column)));
        all.filter(is_searched).collect()
    }

    /// A random robot of this space.
    pub fn random(&self, rng: &mut impl Rng) -> Links {
        let right = rng.random::<f64>() < RIGHT_ANGLES;
        let mut draw = |parameter: &Parameter, is_twist: bool| match parameter {
            Parameter::Fixed(value) => *value,
            Parameter::OneOf(values) => values[rng.random_range(0..values.len())],
            Parameter::Bounded([low, high]) => {
                let at = low + (high - low) * rng.random::<f64>();
                let zero = rng.random::<f64>() < ZERO && (*low..=*high).contains(&0.0);
                let sign = if rng.random::<bool>() { 1.0 } else { -1.0 };
                let corner = [sign, -sign].map(|s| s * FRAC_PI_2);
                let corner = corner.into_iter().find(|x| (*low..=*high).contains(x));
                match (is_twist, corner) {
                    (true, Some(corner)) if right => corner,
                    (false, _) if zero => 0.0,
                    _ => at,
                }
            }
        };
        let mut row = |row: &LinkRow| Constants {
            twist: draw(&row.twist, true),
            length: draw(&row.length, false),
            offset: draw(&row.offset, false),
        };
        let mut links: Links = self.rows.iter().map(&mut row).collect();
        self.settle(&mut links);
        links
    }

    /// Brings `links` to the reach 1 inside all bounds; fixed values and lists are set. Returns
    /// the scale that the lengths were divided by, and the reach that is left, 1 but for round-off
    /// or where the bounds allow no such robot.
    pub fn settle(&self, links: &mut Links) -> (f64, f64) {
        let mut scale = 1.0;
        for _ in 0..ROUNDS {
            self.confine(links);
            let reach = self.reach(links);
            if reach <= LEAST_REACH || (reach - 1.0).abs() < SETTLED {
                return (scale, reach);
            }
            scale *= reach;
            for link in links.iter_mut() {
                link.length /= reach;
                link.offset /= reach;
            }
        }
        self.confine(links);
        (scale, self.reach(links))
    }

    /// Puts every parameter back into its bounds, onto its value, or onto the nearest of its list.
    pub fn confine(&self, links: &mut Links) {
        for (link, row) in links.iter_mut().zip(&self.rows) {
            for column in COLUMNS {
                let value = link.get_mut(column);
                match row.parameter(column) {
                    Parameter::Fixed(fixed) => *value = *fixed,
                    Parameter::Bounded([low, high]) => {
                        let turns = match column {
                            Column::Twist if !(*low..=*high).contains(value) => {
                                ((0.5 * (low + high) - *value) / TAU).round() * TAU
                            }
                            _ => 0.0,
                        };
                        *value = (*value + turns).clamp(*low, *high);
                    }
                    Parameter::OneOf(values) => {
                        let near = |a: &&f64, b: &&f64| {
                            (*a - *value).abs().total_cmp(&(*b - *value).abs())
                        };
                        *value = values.iter().min_by(near).copied().unwrap_or(*value);
                    }
                }
            }
        }
    }

    /// Search coordinates of the parameters `variables`.
    pub fn coordinates(&self, links: &Links, variables: &[(usize, Column)]) -> Vec<f64> {
        let coordinate = |&(row, column): &(usize, Column)| links[row].get(column) / unit(column);
        variables.iter().map(coordinate).collect()
    }

    /// `links` with the parameters `variables` at coordinates `x`.
    pub fn at(&self, links: &Links, variables: &[(usize, Column)], x: &[f64]) -> Links {
        let mut links = links.clone();
        for (&(row, column), value) in variables.iter().zip(x) {
            *links[row].get_mut(column) = value * unit(column);
        }
        links
    }

    /// The robot of `links` with the lengths multiplied by `reach` (metres).
    pub fn robot(&self, links: &Links, reach: f64, name: &str) -> Robot {
        let joint = |link: &Constants| Joint {
            kind: JointKind::Revolute,
            link: Link {
                twist: link.twist,
                length: link.length * reach,
                offset: link.offset * reach,
                angle: 0.0,
            },
        };
        Robot {
            name: name.to_owned(),
            source: None,
            geometry: Geometry::Rows {
                convention: Convention::Standard,
                joints: links.iter().map(joint).collect(),
            },
            tool: Isometry3::identity(),
            physical_limits: None,
        }
    }

    /// The links of `robot` in metres, if it has revolute joints in standard rows and no tool
    /// frame that is not part of them.
    pub fn links_of(robot: &Robot) -> Option<Links> {
        let Geometry::Rows {
            convention: Convention::Standard,
            joints,
        } = &robot.geometry
        else {
            return None;
        };
        let constants = |joint: &Joint| {
            (joint.kind == JointKind::Revolute).then_some(Constants {
                twist: joint.link.twist,
                length: joint.link.length,
                offset: joint.link.offset,
            })
        };
        joints.iter().map(constants).collect()
    }

    /// The reach of `links`, in the unit of their lengths; 0 if it cannot be told.
    pub fn reach(&self, links: &Links) -> f64 {
        rough_reach(&self.robot(links, 1.0, "")).unwrap_or(0.0)
    }
}

/// L = Σ(|a_i| + |d_i|), in the unit of the lengths.
pub fn total_length(links: &Links) -> f64 {
    links.iter().map(|l| l.length.abs() + l.offset.abs()).sum()
}

const COLUMNS: [Column; 3] = [Column::Twist, Column::Length, Column::Offset];

fn unit(column: Column) -> f64 {
    match column {
        Column::Twist => 1.0,
        Column::Length | Column::Offset => LENGTH_UNIT,
    }
}

fn idle(n: usize, task: TaskSpace) -> Vec<(usize, Column)> {
    let last = n.saturating_sub(1);
    let mut idle = vec![(0, Column::Offset), (last, Column::Twist)];
    if task == TaskSpace::SpatialPose {
        idle.extend([(last, Column::Length), (last, Column::Offset)]);
    }
    idle
}

impl LinkRow {
    /// The parameter of a column.
    pub fn parameter(&self, column: Column) -> &Parameter {
        match column {
            Column::Twist => &self.twist,
            Column::Length => &self.length,
            Column::Offset => &self.offset,
        }
    }

    fn parameter_mut(&mut self, column: Column) -> &mut Parameter {
        match column {
            Column::Twist => &mut self.twist,
            Column::Length => &mut self.length,
            Column::Offset => &mut self.offset,
        }
    }
}

impl Constants {
    /// The constant of a column.
    pub fn get(&self, column: Column) -> f64 {
        match column {
            Column::Twist => self.twist,
            Column::Length => self.length,
            Column::Offset => self.offset,
        }
    }

    /// The constant of a column, to change it.
    pub fn get_mut(&mut self, column: Column) -> &mut f64 {
        match column {
            Column::Twist => &mut self.twist,
            Column::Length => &mut self.length,
            Column::Offset => &mut self.offset,
        }
    }
}

#[cfg(test)]
mod tests;
