//! Sizes of workspaces of any serial robot, from the self-motion manifolds of sampled task
//! points [S4].
//!
//! A [`SamplePlan`] says which task points are taken and how much each counts. Their pre-images,
//! which do not depend on artificial limits, are traced once into an [`Atlas`]; any limits are
//! then scored by interval arithmetic over it.

mod atlas;
mod block;
mod build;
mod clip;
mod cover;
mod coverage;
mod dexterity;
mod family;
mod first_joint;
mod hull;
mod lanes;
mod maps;
mod plan;
mod polyline;
mod profile;
mod runs;
mod score;
mod sizes;
mod store;
mod survivors;
mod thin;
mod turn16;

pub use atlas::{Atlas, AtlasError, AtlasRecipe, AtlasSettings, Prediction};
pub use dexterity::Dexterity;
pub use family::Growth;
pub use plan::{Region, Sample, SamplePlan, Sampling};
pub use score::Rule;
pub use sizes::SampleCounts;
pub use store::{AtlasKey, AtlasStore};
