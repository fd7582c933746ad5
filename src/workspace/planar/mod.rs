//! Exact workspaces of planar revolute arms.

mod chain;
mod circle;
mod maps;
mod orientation;
mod pose;
mod position;
mod post_failure;
mod quadrature;
mod reach;
mod region;
mod sweep;
mod wrist_slice;

pub use pose::{PlanarPose, PoseResolution};
pub use position::{PlanarArm, PlanarPosition};
