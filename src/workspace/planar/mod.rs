//! Exact workspaces of planar revolute arms.

mod chain;
mod circle;
mod position;
mod post_failure;
mod reach;
mod region;
mod sweep;

pub use position::{PlanarArm, PlanarPosition};
