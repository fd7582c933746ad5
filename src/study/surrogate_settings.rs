//! Settings of studies with neural surrogates: `[dataset]`, `[surrogate]`, `[training]`,
//! `[validate]` and `[estimator.surrogate]`, validated.

use super::settings::LinkBounds;
use crate::surrogate::{ClosedForms, Draw, Encoding};
use serde::Serialize;
use std::path::PathBuf;

/// Settings of `kind = "train"`.
#[derive(Clone, Debug, PartialEq)]
pub struct Train {
    /// What is learnt from.
    pub dataset: DatasetSettings,
    /// What learns.
    pub surrogate: SurrogateSettings,
    /// How it learns.
    pub training: Training,
}

/// `[dataset]`.
#[derive(Clone, Debug, PartialEq)]
pub struct DatasetSettings {
    /// Number of designs, rounded up to units of 64; default by method.
    pub designs: u64,
    /// Share of them that comes from threshold walks, default 0.5.
    pub walk_share: f64,
    /// Cells per design, default 24; unused by the method "size".
    pub cells: u64,
    /// Bounds of the link lengths, if the surrogate is to know all within them.
    pub links: Option<LinkBounds>,
}

/// `[surrogate]`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct SurrogateSettings {
    /// The outputs.
    pub method: SurrogateMethod,
    /// Widths of the hidden layers.
    pub widths: Vec<u64>,
    /// The inputs, default "trigonometric".
    pub encoding: Encoding,
    /// What is not learnt but known in closed form.
    #[serde(rename = "closed_forms")]
    pub closed_forms: ClosedForms,
    /// Settings of the method "mdn".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mdn: Option<Mdn>,
    /// Settings of the method "arcs".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arcs: Option<Arcs>,
}

/// The surrogates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SurrogateMethod {
    /// A mixture-density network [S3].
    Mdn,
    /// The coefficients of a trigonometric polynomial that is positive on the set.
    Arcs,
    /// The size alone.
    Size,
}

/// `[surrogate.mdn]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mdn {
    /// Number K of components, default 5.
    pub components: u64,
    /// Whether they wrap around the circle, default true.
    pub wrapped: bool,
    /// Whether a further output tells empty sets, default true.
    pub emptiness: bool,
    /// How densities become sets, default "level".
    pub decoder: DecoderKind,
}

/// How densities become sets; what either needs is fitted on kept-back designs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DecoderKind {
    /// Angles above a share of the density's height.
    Level,
    /// Random draws, filtered and grouped [S3].
    Sampling,
}

/// `[surrogate.arcs]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Arcs {
    /// Highest frequency, default 12.
    pub harmonics: u64,
}

/// `[training]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Training {
    /// Passes over the training data; default by method.
    pub epochs: u64,
    /// Examples per step, default 1024.
    pub batch: u64,
    /// Largest learning rate, default 0.003.
    pub learning_rate: f64,
    /// Decoupled weight decay, default 1e-5.
    pub weight_decay: f64,
    /// Epochs without improvement after which training ends, default 20.
    pub patience: u64,
    /// Whether every other example is mirrored, default true.
    pub mirror: bool,
}

/// Settings of `kind = "validate"`.
#[derive(Clone, Debug, PartialEq)]
pub struct Validate {
    /// Files of weights, each with its card beside it.
    pub models: Vec<ModelFile>,
    /// Designs of either origin, rounded up to units of 64; default 448.
    pub designs: u64,
    /// Which random streams they come from, default held-out.
    pub draw: Draw,
}

/// A surrogate's file.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelFile {
    /// Absolute path of the weights.
    pub path: PathBuf,
    /// Hash of the weights.
    pub sha256: String,
}

/// `[estimator.surrogate]`.
#[derive(Clone, Debug, PartialEq)]
pub struct SurrogateEstimator {
    /// The surrogate that scores the search.
    pub model: ModelFile,
    /// Whether the best of the final population is refined exactly, default true.
    pub polish: bool,
    /// Whether an exact search of equal wall time is run beside it, default true. Its result
    /// depends on the machine.
    pub compare: bool,
}

impl Train {
    /// Settings of `method` where the file names none.
    pub(super) fn defaults(method: SurrogateMethod) -> Train {
        let (designs, widths, epochs, closed_forms) = match method {
            SurrogateMethod::Mdn => (40_000, vec![128; 3], 30, ClosedForms::Gate),
            SurrogateMethod::Arcs => (40_000, vec![128; 3], 30, ClosedForms::PostFailure),
            SurrogateMethod::Size => (256_000, vec![96; 3], 60, ClosedForms::Gate),
        };
        Train {
            dataset: DatasetSettings {
                designs,
                walk_share: 0.5,
                cells: 24,
                links: None,
            },
            surrogate: SurrogateSettings {
                method,
                widths,
                encoding: Encoding::Trigonometric,
                closed_forms,
                mdn: (method == SurrogateMethod::Mdn).then_some(Mdn {
                    components: 5,
                    wrapped: true,
                    emptiness: true,
                    decoder: DecoderKind::Level,
                }),
                arcs: (method == SurrogateMethod::Arcs).then_some(Arcs { harmonics: 12 }),
            },
            training: Training {
                epochs,
                batch: 1024,
                learning_rate: 3e-3,
                weight_decay: 1e-5,
                patience: 20,
                mirror: true,
            },
        }
    }
}
