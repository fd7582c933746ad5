//! Neural surrogates of fault-tolerant workspaces of planar arms [S3], and how far to trust them.
//!
//! 1. `arm`: the exact workspaces that are learnt. `cell`: where.
//! 2. `limit_sets`, `dataset`, `dataset_store`: labelled designs.
//! 3. `features`, `network`, `mixture`, `arcs`, `size`, `surrogate_net`: inputs, layers, outputs.
//! 4. `adamw`, `training`: epochs.
//! 5. `difference_filter`, `decode`: from densities to sets of angles.
//! 6. `model`, `fit`, `model_file`: a trained surrogate, its decoder, its files.
//! 7. `objective`: its S_F as a score. `validation`: how far it is from the truth.

mod adamw;
mod arcs;
mod arm;
mod cell;
mod dataset;
mod dataset_store;
mod decode;
mod difference_filter;
mod features;
mod fit;
mod limit_sets;
mod mixture;
mod model;
mod model_file;
mod network;
mod objective;
mod size;
mod surrogate_net;
mod training;
pub mod validation;

pub use arcs::ArcsHead;
pub use arm::SurrogateArm;
pub use cell::{Cell, Quadrature, Region};
pub use dataset::{Dataset, Draw, Emptiness, Labelled, Origin, Recipe, UNIT};
pub use dataset_store::{BuildError, BuildOptions, Parts, data_hash, load_or_build};
pub use decode::Decoder;
pub use difference_filter::DifferenceFilter;
pub use features::Encoding;
pub use fit::fitted;
pub use mixture::{Mixture, MixtureHead};
pub use model::{Model, Surrogate};
pub use model_file::{
    Card, DataCard, KeptBack, ModelError, TrainingCard, card_path, sha256, weights_file,
};
pub use network::Network;
pub use objective::SurrogateObjective;
pub use size::SizeHead;
pub use surrogate_net::{Architecture, ClosedForms, Head};
pub use training::{Epoch, Lesson, Training, TrainingError, TrainingSettings};
