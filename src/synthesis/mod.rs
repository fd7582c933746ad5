//! Robot design search: link parameters and artificial limits together.
mod arm;
mod assessment;
mod link_space;
mod margin;
mod measures;
mod pareto;
mod run;
mod search;
mod seeds;
mod sensitivity;

pub use arm::Arm;
pub use assessment::{Bounds, Care, DesignProblem, Draft, Look};
pub use link_space::{Column, Constants, LinkRow, LinkSpace, Links, Parameter, total_length};
pub use margin::{AtMargin, MarginCurve};
pub use measures::{Measures, Merit};
pub use pareto::{FrontRobot, ParetoSearch, ParetoSettings, merit_values};
pub use run::{Generation, Stage};
pub use search::{Finalist, REPLICATES, Synthesis, SynthesisSettings};
pub use seeds::{Purpose, sample_seed};
pub use sensitivity::{ParameterSensitivity, Perturbed, Tolerances};
