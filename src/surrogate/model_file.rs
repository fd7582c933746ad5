//! A trained surrogate on disk: weights as safetensors, everything else as a TOML card beside it.

use super::arm::SurrogateArm;
use super::dataset::{Emptiness, Recipe};
use super::decode::Decoder;
use super::model::Model;
use super::network::Network;
use super::surrogate_net::Architecture;
use super::training::{Epoch, TrainingSettings};
use super::validation::Score;
use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// Raise this when a file of before can no longer be used.
const FORMAT: u32 = 1;

/// Largest difference of a link length, share of the reach, at which a robot is still the same.
const SAME_LENGTH: f64 = 1e-9;

/// What a network is, what it learnt from and how well it did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Card {
    /// Version of the layout.
    pub format: u32,
    /// Version of the program.
    pub version: String,
    /// Name of the robot.
    pub robot: String,
    /// Hash of the robot's file.
    pub design_sha256: String,
    /// Hash of the weights' file.
    pub weights_sha256: String,
    /// The arm, in the angles between its links.
    pub arm: SurrogateArm,
    /// Inputs, layers, outputs.
    pub architecture: Architecture,
    /// How mixtures become sets.
    pub decoder: Decoder,
    /// What it learnt from.
    pub data: DataCard,
    /// How it learnt.
    pub training: TrainingCard,
    /// Scores on kept-back designs: uniform limits, threshold walks.
    pub kept_back: KeptBack,
}

/// The data of a network.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DataCard {
    /// Hash of all that the data depends on.
    pub hash: String,
    /// How the designs were drawn.
    pub recipe: Recipe,
    /// Largest S_F among the training designs, with its limits, degrees, and lengths, metres.
    pub largest: f64,
    /// Lower limits of that design, degrees.
    pub largest_lower_deg: Vec<f64>,
    /// Upper limits of that design, degrees.
    pub largest_upper_deg: Vec<f64>,
    /// Lengths of that design, metres.
    pub largest_lengths: Vec<f64>,
    /// Share of empty designs and cells among uniform limits.
    pub uniform: EmptinessCard,
    /// The same among threshold walks.
    pub walk: EmptinessCard,
}

/// How much of the data is empty.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EmptinessCard {
    /// Number of designs.
    pub designs: usize,
    /// Share with S_F = 0.
    pub empty_designs: f64,
    /// Share of cells without a fault-tolerant angle.
    pub empty_cells: f64,
}

impl From<Emptiness> for EmptinessCard {
    fn from(emptiness: Emptiness) -> EmptinessCard {
        EmptinessCard {
            designs: emptiness.designs,
            empty_designs: emptiness.empty_designs,
            empty_cells: emptiness.empty_cells,
        }
    }
}

/// How a network learnt.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrainingCard {
    /// Settings.
    pub settings: TrainingSettings,
    /// Epochs that were run.
    pub epochs: u64,
    /// The epoch whose weights these are.
    pub best: Epoch,
}

/// Scores on kept-back designs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct KeptBack {
    /// Uniform limits.
    pub uniform: Score,
    /// Threshold walks.
    pub walk: Score,
}

/// Why a model cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    /// A file cannot be read.
    #[error("`{}` cannot be read: {error}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        error: std::io::Error,
    },
    /// The card is no card.
    #[error("`{}` is no card of a surrogate: {reason}", path.display())]
    NoCard {
        /// The card.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The card is of another version.
    #[error("the surrogate has layout {found}, this version reads layout {FORMAT}")]
    Version {
        /// Its layout.
        found: u32,
    },
    /// The weights are not those that the card describes.
    #[error("the weights in `{}` {reason}", path.display())]
    Weights {
        /// The weights' file.
        path: PathBuf,
        /// What is wrong.
        reason: &'static str,
    },
    /// The surrogate stands for another robot or task.
    #[error("the surrogate is for {its}, the study has {ours}")]
    Foreign {
        /// What the surrogate is for.
        its: String,
        /// What the study asks for.
        ours: String,
    },
}

/// The card beside a file of weights.
pub fn card_path(model: &Path) -> PathBuf {
    model.with_extension("toml")
}

/// The weights of a network as the bytes of a safetensors file.
///
/// # Errors
/// The writer's; none is expected.
pub fn weights_file(network: &Network) -> anyhow::Result<Vec<u8>> {
    let bytes: Vec<u8> = network
        .weights()
        .iter()
        .flat_map(|w| w.to_le_bytes())
        .collect();
    let mut views = Vec::new();
    let mut start = 0;
    for (k, pair) in network.sizes().windows(2).enumerate() {
        for (name, shape) in [("weight", vec![pair[0], pair[1]]), ("bias", vec![pair[1]])] {
            let end = start + 4 * shape.iter().product::<usize>();
            let view = TensorView::new(Dtype::F32, shape, &bytes[start..end])?;
            views.push((format!("layer{k:02}.{name}"), view));
            start = end;
        }
    }
    Ok(safetensors::serialize(views, None)?)
}

/// SHA-256 of bytes, lower-case hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}

impl Card {
    /// The layout that this version writes.
    pub const FORMAT: u32 = FORMAT;

    /// Reads a card.
    ///
    /// # Errors
    /// The file is missing, no card, or of another layout.
    pub fn load(path: &Path) -> Result<Card, ModelError> {
        let text = std::fs::read_to_string(path).map_err(|error| ModelError::Unreadable {
            path: path.to_owned(),
            error,
        })?;
        let no_card = |error: toml::de::Error| ModelError::NoCard {
            path: path.to_owned(),
            reason: error.message().to_owned(),
        };
        let layout: Layout = toml::from_str(&text).map_err(no_card)?;
        if layout.format != FORMAT {
            return Err(ModelError::Version {
                found: layout.format,
            });
        }
        toml::from_str(&text).map_err(no_card)
    }

    /// Whether the surrogate stands for this arm.
    ///
    /// # Errors
    /// It stands for another robot, task or set of failures.
    pub fn check_arm(&self, arm: &SurrogateArm) -> Result<(), ModelError> {
        let own = &self.arm;
        let reach: f64 = arm.lengths.iter().sum();
        let near = |a: &f64, b: &f64| (a - b).abs() <= SAME_LENGTH * reach;
        let mut pairs = own.lengths.iter().zip(&arm.lengths);
        let same_lengths = own.lengths.len() == arm.lengths.len()
            && match (&own.link_bounds, &arm.link_bounds) {
                // Knowing all lengths within bounds, it knows these.
                (Some(bounds), _) => {
                    let sum: f64 = own.lengths.iter().sum();
                    let within = |(l, b): (&f64, &[f64; 2])| b[0] <= *l && *l <= b[1];
                    let searched = arm.link_bounds.as_ref().is_none_or(|asked| {
                        let inside = |(a, b): (&[f64; 2], &[f64; 2])| b[0] <= a[0] && a[1] <= b[1];
                        asked.iter().zip(bounds).all(inside)
                    });
                    near(&sum, &reach) && searched && arm.lengths.iter().zip(bounds).all(within)
                }
                (None, None) => pairs.all(|(a, b)| near(a, b)),
                (None, Some(_)) => false,
            };
        if same_lengths && own.pose == arm.pose && own.failures == arm.failures {
            return Ok(());
        }
        Err(ModelError::Foreign {
            its: described(own),
            ours: described(arm),
        })
    }

    /// The model whose card this is, with the weights of `path`.
    ///
    /// # Errors
    /// The weights are missing, damaged or not those of the card.
    pub fn model(&self, path: &Path) -> Result<Model, ModelError> {
        let bytes = std::fs::read(path).map_err(|error| ModelError::Unreadable {
            path: path.to_owned(),
            error,
        })?;
        let wrong = |reason| ModelError::Weights {
            path: path.to_owned(),
            reason,
        };
        if sha256(&bytes) != self.weights_sha256 {
            return Err(wrong("are damaged or not those of its card"));
        }
        let sizes = self.architecture.sizes(&self.arm);
        let network = read_weights(&bytes)
            .and_then(|weights| Network::from_weights(&sizes, weights))
            .ok_or_else(|| wrong("do not fit the layers of its card"))?;
        Model::new(&self.arm, &self.architecture, network, self.decoder)
            .map_err(|_| wrong("cannot be loaded"))
    }
}

/// The part of a card by which its version is known.
#[derive(Deserialize)]
struct Layout {
    format: u32,
}

fn read_weights(bytes: &[u8]) -> Option<Vec<f32>> {
    let file = SafeTensors::deserialize(bytes).ok()?;
    let mut weights = Vec::new();
    for k in 0..file.len() / 2 {
        for name in ["weight", "bias"] {
            let view = file.tensor(&format!("layer{k:02}.{name}")).ok()?;
            let values = view.data().chunks_exact(4);
            weights.extend(values.map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])));
        }
    }
    Some(weights)
}

fn described(arm: &SurrogateArm) -> String {
    let task = if arm.pose { "pose" } else { "position" };
    let failures: Vec<String> = arm.failures.numbers().map(|j| j.to_string()).collect();
    let lengths = match &arm.link_bounds {
        None => format!("links {:?}", arm.lengths),
        Some(bounds) => format!("links within {bounds:?}"),
    };
    format!(
        "{lengths}, task {task}, failures of {}",
        failures.join(", ")
    )
}
