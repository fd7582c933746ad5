//! Where the tool is: maps from configurations to task points.
//!
//! Knows nothing of artificial limits or failures. [`joint_frames`] serves any robot;
//! [`Chain`] is the canonical form whose [`Kernel`] the inner loops evaluate.

mod chain;
mod forward;
mod kernel;
mod lane;
mod newton;
mod sine;

pub use chain::{Chain, ChainJoint, JointScale, joint_scales};
pub use forward::{fixed_transforms, joint_frames, reach, tool_frame};
pub use kernel::{Goal, Kernel, Linearisation};
pub use lane::{LANES, Lanes, Real};
pub(crate) use newton::dot;
pub use newton::{NewtonStep, damped_step, newton_step};
pub use sine::sin_cos;
