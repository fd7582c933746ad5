//! Workspaces before and after a failure: W₀, W_i, W_F, and their sizes with error bars.

pub mod hybrid;
mod limits;
mod locked_joint_check;
mod map;
mod one_pose;
pub mod planar;
mod size;
mod spatial_map;

pub use limits::{ArtificialLimits, FailureSet, JointLimit};
pub use locked_joint_check::{LockedJointCheck, LockedJointEstimate};
pub use map::{Ring, RingMap, ShareMap, WorkspaceMap};
pub use one_pose::{PoseTolerance, limit_crossings, ranges_within};
pub use size::{Estimate, WorkspaceSizes};
pub use spatial_map::SpatialShareMap;
pub(crate) use spatial_map::interval;
