//! Robots: links, joints, physical limits, task spaces, and the files that describe them.
//!
//! Knows no algorithm. Lengths are in metres and angles in radians, except in files, whose keys
//! name the unit.

mod file;
mod physical_limits;
mod planar;
mod robot;
mod rows;
mod task;

pub use file::{parse_design, read_design};
pub use planar::{NotPlanar, PlanarChain};
pub use robot::{Convention, Geometry, Joint, JointKind, Link, PhysicalLimits, Robot};
pub use task::TaskSpace;
