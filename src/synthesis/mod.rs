//! The search for robots: link parameters and artificial limits together.
//!
//! A [`LinkSpace`] says which robots there are, a [`DesignProblem`] what is asked of them. One
//! robot is assessed by tracing a small atlas and fitting limits to it by exact line searches;
//! [`Synthesis`] searches the best robot by CMA-ES, [`ParetoSearch`] a front of robots by NSGA-II.
//! Scores of a search are noisy and its best are the luckiest, so samples for searching, choosing
//! and reporting have nothing in common ([`sample_seed`]).

mod arm;
mod assessment;
mod beyond_size;
mod finalists;
mod link_space;
mod margin;
mod measures;
mod off_reach;
mod pareto;
mod run;
mod search;
mod seeds;
mod sensitivity;
mod stages;

pub use arm::Arm;
pub use assessment::{Bounds, Care, DesignProblem, Draft, Look};
pub use beyond_size::MARGIN_SAMPLES;
pub use finalists::{Finalist, REPLICATES};
pub use link_space::{Column, Constants, LinkRow, LinkSpace, Links, Parameter, total_length};
pub use margin::{AtMargin, WIDEST_MARGIN};
pub use measures::{Measures, Merit};
pub use pareto::{FrontRobot, ParetoSearch, ParetoSettings, merit_values};
pub use run::{Generation, Stage};
pub use search::{Synthesis, SynthesisSettings};
pub use seeds::{Purpose, sample_seed};
pub use sensitivity::{ParameterSensitivity, Perturbed, Tolerances};
