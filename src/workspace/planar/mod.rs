//! Exact workspaces of planar revolute arms.

mod chain;
mod circle;
mod locked_joints;
mod maps;
mod orientation;
mod pose;
mod position;
mod post_failure;
mod quadrature;
mod reach;
mod region;
mod resolution;
mod sweep;
mod wrist;
mod wrist_slice;

pub use locked_joints::LockedJoints;
pub use pose::PlanarPose;
pub use position::{PlanarArm, PlanarPosition};
pub use resolution::{Kronrod, PoseResolution};
