//! Singular configurations of every rank, and the largest self-motion manifolds [S1].
//!
//! Where J loses rank, self-motion manifolds meet, join or tear apart, and the largest ones run
//! through such configurations. [`descend`] and [`find_singularities`] find singular configurations
//! ([S1 Algorithm 1]); [`LocationSearch`] finds every manifold of a location, with the branches
//! through its singular configurations ([S1 Algorithm 2]); [`find_largest`] looks for the location
//! whose manifolds are largest, and [`FailureExperiment`] tries whether it can be reached after
//! any one joint has locked [S1 §IV.D].
//!
//! Knows nothing of workspaces, artificial limits or surrogates.

mod branches;
mod catalogue;
mod comparison;
mod connected;
mod decomposition;
mod descent;
mod dexterity;
mod failure;
mod gradient;
mod largest;
mod location;
mod pareto;
mod ranges;
mod refine;
mod same_motion;
mod split;
mod stratum;
mod surface;

pub use catalogue::{
    Catalogue, RankTally, SingularFamily, Singularity, SingularitySettings, find_singularities,
    random_configuration,
};
pub use comparison::{Comparison, compare};
pub use descent::{Descent, DescentSettings, DescentStatus, descend};
pub use dexterity::{Dexterity, measures};
pub use failure::{FailureExperiment, FailureSettings, JointOutcome, Lock, REACHED};
pub use largest::{Candidate, Largest, LargestSettings, Origin, Watch, find_largest};
pub use location::{ConnectedSet, Location, LocationSearch, Node};
pub use pareto::{Measure, front};
pub use ranges::{joint_ranges, size};
pub use refine::{RefineSettings, Refined, refine};
pub use split::{Split, find_split};
pub use stratum::{Arm, SINGULAR};
pub use surface::SingularSurface;
