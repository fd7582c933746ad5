//! Designs redundant robot arms whose workspace survives a locked joint.

pub mod angle;
pub mod objective;
pub mod optimiser;
pub mod sampling;
pub mod workspace;
