//! Where the tool is: maps from configurations to task points.
//!
//! Knows nothing of artificial limits or failures. [`joint_frames`] serves any robot;
//! [`Chain`] is the canonical form whose [`Kernel`] the inner loops evaluate.

mod chain;
mod derivative;
mod extent;
mod fixed;
mod forward;
mod kernel;
mod lane;
mod newton;
mod pivot;
mod posture;
mod sine;

pub use chain::{Chain, ChainJoint, JointScale, joint_scales};
pub use derivative::Differential;
pub use extent::{Extent, rough_extent, rough_reach, workspace_extent};
pub use fixed::{fixed_transforms, joint_motion};
pub use forward::{joint_frames, reach_bound, tool_frame};
pub use kernel::{Goal, Kernel, Linearisation};
pub use lane::{LANES, Lanes, Real};
pub(crate) use newton::dot;
pub use newton::{NewtonStep, PivotedStep, damped_step, newton_step, newton_steps};
pub use pivot::Pivot;
pub use posture::{JointPlace, display_posture, joint_places};
pub use sine::sin_cos;
