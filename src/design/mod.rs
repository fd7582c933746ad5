//! Robots: links, joints, physical limits, task spaces, and the files that describe them.
//!
//! Knows no algorithm. Lengths are in metres and angles in radians, except in files, whose keys
//! name the unit.

mod decimal;
mod file;
mod frames;
mod physical_limits;
mod planar;
mod robot;
mod roll_pitch_yaw;
mod rows;
mod task;
mod tool;
mod urdf;
mod write;

pub use file::{ParsedDesign, parse_design, parse_design_files, read_design};
pub use frames::{FrameChain, FrameJoint};
pub use planar::{NotPlanar, PlanarChain};
pub use robot::{Convention, Geometry, Joint, JointKind, Link, PhysicalLimits, Robot};
pub use task::TaskSpace;
pub use urdf::robot_to_urdf;
pub use write::robot_to_toml;
