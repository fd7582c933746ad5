//! Designs redundant robot arms whose workspace survives a locked joint.

pub mod angle;
pub mod workspace;
