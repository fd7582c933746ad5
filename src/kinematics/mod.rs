//! Where the tool is: maps from configurations to task points.
//!
//! Knows nothing of artificial limits or failures.

mod forward;

pub use forward::{joint_frames, reach, tool_frame};
