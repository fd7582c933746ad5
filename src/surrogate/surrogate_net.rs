//! What a network is made of around its layers: inputs, outputs and their loss.

use super::arcs::ArcsHead;
use super::arm::SurrogateArm;
use super::cell::Region;
use super::dataset::Dataset;
use super::features::{Encoding, Features};
use super::mixture::MixtureHead;
use super::size::SizeHead;
use crate::angle::AngleSet;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

/// The meaning of a network's outputs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Head {
    /// A mixture density of the fault-tolerant angles of a cell.
    Mdn(MixtureHead),
    /// A logit over the angles of a cell.
    Arcs(ArcsHead),
    /// The size of the workspace.
    Size(SizeHead),
}

/// How much of the answer is taken from closed forms instead of the network.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClosedForms {
    /// Nothing, as in [S3]: the network learns the fault-tolerant sets over the whole reach.
    None,
    /// Sets are empty outside the radii common to W₂ … W_n.
    Gate,
    /// The network learns the pre-failure sets inside these radii; W₁ (and W_n of poses) are
    /// intersected in closed form.
    PostFailure,
}

/// A network's inputs, hidden layers and outputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Architecture {
    /// The outputs.
    pub head: Head,
    /// Widths of the hidden layers.
    pub widths: Vec<usize>,
    /// The inputs.
    pub encoding: Encoding,
    /// What is not learnt.
    pub closed_forms: ClosedForms,
}

/// A design and, unless the size alone is learnt, one of its cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Example {
    design: u32,
    cell: u32,
}

/// What the outputs should be.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// A set of angles, and the angles that matter.
    Set(AngleSet, AngleSet),
    /// A size and its bound in closed form.
    Size { size: f64, bound: f64 },
}

/// Inputs and targets of some examples.
pub struct Prepared {
    /// Row by row.
    pub inputs: Vec<f32>,
    /// One for every row.
    pub targets: Vec<Target>,
}

impl Architecture {
    /// Whether the network sees cells.
    pub fn has_cells(&self) -> bool {
        !matches!(self.head, Head::Size(_))
    }

    /// Where cells to learn from lie.
    pub fn region(&self) -> Region {
        match self.closed_forms {
            ClosedForms::None => Region::Reach,
            _ => Region::Gate,
        }
    }

    /// The inputs.
    pub fn features(&self, arm: &SurrogateArm) -> Features {
        Features::new(arm, self.encoding, self.has_cells())
    }

    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        match &self.head {
            Head::Mdn(head) => head.outputs(),
            Head::Arcs(head) => head.outputs(),
            Head::Size(_) => 1,
        }
    }

    /// Sizes of all layers, inputs first.
    pub fn sizes(&self, arm: &SurrogateArm) -> Vec<usize> {
        let mut sizes = vec![self.features(arm).count()];
        sizes.extend(&self.widths);
        sizes.push(self.outputs());
        sizes
    }

    /// All examples of a dataset.
    pub fn examples(&self, dataset: &Dataset) -> Vec<Example> {
        let designs = 0..dataset.designs().len();
        if !self.has_cells() {
            let example = |design| Example {
                design: design as u32,
                cell: 0,
            };
            return designs.map(example).collect();
        }
        let cells_of = |design: usize| {
            dataset.cells_of(design).map(move |cell| Example {
                design: design as u32,
                cell: cell as u32,
            })
        };
        designs.flat_map(cells_of).collect()
    }

    /// Inputs and targets, every other example mirrored at random if asked to.
    pub(super) fn prepare(
        &self,
        arm: &SurrogateArm,
        dataset: &Dataset,
        examples: &[Example],
        mirror: bool,
        generator: &mut ChaCha8Rng,
    ) -> Prepared {
        let features = self.features(arm);
        let count = features.count();
        let mut inputs = vec![0.0; examples.len() * count];
        let mut targets = Vec::with_capacity(examples.len());
        for (example, row) in examples.iter().zip(inputs.chunks_exact_mut(count)) {
            let labelled = &dataset.designs()[example.design as usize];
            let design = labelled.design();
            let locked = arm.locked_joints(&design);
            let mirrored = mirror && generator.random();
            let cell = self
                .has_cells()
                .then(|| dataset.cells()[example.cell as usize]);
            features.write(&design, &locked, cell.as_ref(), mirrored, row);
            targets.push(match (&self.head, cell) {
                (Head::Size(head), _) => Target::Size {
                    size: labelled.size,
                    bound: head.bound(&locked),
                },
                (_, None) => Target::Set(AngleSet::empty(), AngleSet::full()),
                (_, Some(cell)) => {
                    let pre = dataset.pre_failure_set(example.cell as usize);
                    let post = arm.post_failure_set(&locked, &cell);
                    let (set, matters) = match self.closed_forms {
                        ClosedForms::PostFailure => (pre, post),
                        _ => (
                            pre.intersection(&post).without_narrow_arcs(0.0),
                            AngleSet::full(),
                        ),
                    };
                    match mirrored {
                        true => Target::Set(set.mirrored(), matters.mirrored()),
                        false => Target::Set(set, matters),
                    }
                }
            });
        }
        Prepared { inputs, targets }
    }

    /// Summed loss of rows of outputs. Adds its derivatives by the outputs to `by_outputs`.
    pub(super) fn loss(
        &self,
        outputs: &[f32],
        targets: &[Target],
        generator: &mut ChaCha8Rng,
        by_outputs: &mut [f32],
    ) -> f64 {
        let count = self.outputs();
        let rows = outputs.chunks_exact(count);
        let rows = rows.zip(by_outputs.chunks_exact_mut(count)).zip(targets);
        let mut total = 0.0;
        for ((row, by_row), target) in rows {
            total += match (&self.head, target) {
                (Head::Mdn(head), Target::Set(set, _)) => head.loss(row, set, generator, by_row),
                (Head::Arcs(head), Target::Set(set, matters)) => {
                    head.loss(row, set, matters, generator, by_row)
                }
                (Head::Size(head), &Target::Size { size, bound }) => {
                    head.loss(row[0], bound, size, &mut by_row[0])
                }
                _ => 0.0,
            };
        }
        total
    }
}
