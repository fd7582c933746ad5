//! Designs redundant robot arms whose workspace survives a locked joint.
//!
//! Data flows through the modules in this order, and a module imports only from those before it:
//! [`design`] → [`kinematics`] → [`manifold`] → [`singularity`] → [`workspace`] → [`objective`] →
//! [`optimiser`] → [`synthesis`] → [`report`] → [`study`] → [`cli`]. [`angle`], [`sampling`] and [`diagnostic`] serve all of them.

pub mod angle;
pub mod cli;
pub mod design;
pub mod diagnostic;
pub mod kinematics;
pub mod manifold;
pub mod objective;
pub mod optimiser;
pub mod report;
pub mod sampling;
pub mod singularity;
pub mod study;
pub mod surrogate;
pub mod synthesis;
pub mod workspace;
