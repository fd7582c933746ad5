//! Where the tool is: maps from configurations to task points.
//!
//! Knows nothing of artificial limits or failures.

mod extent;
mod fixed;
mod forward;
mod posture;

pub use extent::{Extent, workspace_extent};
pub use fixed::{fixed_transforms, joint_motion};
pub use forward::{joint_frames, reach_bound, tool_frame};
pub use posture::{JointPlace, display_posture, joint_places};
