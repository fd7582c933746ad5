//! A trained surrogate.

use super::arm::SurrogateArm;
use super::cell::{Cell, Quadrature};
use super::decode::Decoder;
use super::features::Features;
use super::mixture::Mixture;
use super::network::{Layers, Network};
use super::size::SizeHead;
use super::surrogate_net::{Architecture, ClosedForms, Head};
use crate::angle::AngleSet;
use crate::objective::Design;
use crate::sampling::stream;
use crate::workspace::planar::LockedJoints;

/// Nodes of the quadrature that turns sets into a size: radii inside the gate, radii over the
/// whole reach [S3 §V], and bearings of a pose task.
const GATE_RADII: usize = 96;
const REACH_RADII: usize = 100;
const POSE_RADII: usize = 20;
const POSE_BEARINGS: usize = 24;

/// Something that predicts fault-tolerant workspaces of one arm.
pub trait Surrogate: Sync {
    /// The arm.
    fn arm(&self) -> &SurrogateArm;

    /// The fault-tolerant set of every cell of a design, if this surrogate knows sets.
    fn sets(&self, design: &Design, cells: &[Cell]) -> Option<Vec<AngleSet>>;

    /// S_F of every design; finite and at least 0.
    fn sizes(&self, designs: &[Design]) -> Vec<f64>;
}

/// A network with all that is needed to use it.
#[derive(Clone, Debug)]
pub struct Model {
    arm: SurrogateArm,
    architecture: Architecture,
    features: Features,
    network: Network,
    layers: Layers,
    decoder: Decoder,
}

impl Model {
    /// # Errors
    /// candle's; none is expected on the CPU.
    pub fn new(
        arm: &SurrogateArm,
        architecture: &Architecture,
        network: Network,
        decoder: Decoder,
    ) -> candle_core::Result<Model> {
        Ok(Model {
            features: architecture.features(arm),
            layers: network.layers()?,
            arm: arm.clone(),
            architecture: architecture.clone(),
            network,
            decoder,
        })
    }

    /// What the network is made of.
    pub fn architecture(&self) -> &Architecture {
        &self.architecture
    }

    /// The layers and weights.
    pub fn network(&self) -> &Network {
        &self.network
    }

    /// How mixtures become sets.
    pub fn decoder(&self) -> &Decoder {
        &self.decoder
    }

    /// The same model with another decoder.
    pub fn with_decoder(&self, decoder: Decoder) -> Model {
        Model {
            decoder,
            ..self.clone()
        }
    }

    /// The quadrature with which sets become sizes.
    pub fn quadrature(&self, locked: &LockedJoints) -> Quadrature {
        let learnt_everywhere = self.architecture.closed_forms == ClosedForms::None;
        match (learnt_everywhere, self.arm.pose) {
            (true, false) => Quadrature::over_reach(&self.arm, locked, REACH_RADII, 1),
            (true, true) => {
                let radii = REACH_RADII / 2;
                Quadrature::over_reach(&self.arm, locked, radii, POSE_BEARINGS)
            }
            (false, false) => Quadrature::inside_gate(&self.arm, locked, GATE_RADII, 1),
            (false, true) => Quadrature::inside_gate(&self.arm, locked, POSE_RADII, POSE_BEARINGS),
        }
    }

    /// Outputs of the network, row by row; zeros should candle fail.
    fn outputs(&self, inputs: &[f32]) -> Vec<f32> {
        let rows = self.network.rows_at_once() * self.network.inputs();
        let mut outputs = Vec::with_capacity(inputs.len() / self.network.inputs());
        for chunk in inputs.chunks(rows) {
            match self.layers.apply(chunk) {
                Ok(part) => outputs.extend(part),
                Err(_) => {
                    let rows = chunk.len() / self.network.inputs();
                    outputs.extend(std::iter::repeat_n(0.0, rows * self.network.outputs()));
                }
            }
        }
        outputs
    }

    fn cell_outputs(&self, design: &Design, locked: &LockedJoints, cells: &[Cell]) -> Vec<f32> {
        let count = self.features.count();
        let mut inputs = vec![0.0; cells.len() * count];
        for (cell, row) in cells.iter().zip(inputs.chunks_exact_mut(count)) {
            self.features.write(design, locked, Some(cell), false, row);
        }
        self.outputs(&inputs)
    }

    /// The mixtures of the cells, if this is a mixture-density network.
    pub fn mixtures(&self, design: &Design, cells: &[Cell]) -> Option<Vec<Mixture>> {
        let Head::Mdn(head) = &self.architecture.head else {
            return None;
        };
        let locked = self.arm.locked_joints(design);
        let outputs = self.cell_outputs(design, &locked, cells);
        let rows = outputs.chunks_exact(head.outputs());
        Some(rows.map(|row| head.mixture(row)).collect())
    }

    fn sets_with(
        &self,
        design: &Design,
        locked: &LockedJoints,
        cells: &[Cell],
    ) -> Option<Vec<AngleSet>> {
        let count = self.network.outputs();
        if let Head::Size(_) = self.architecture.head {
            return None;
        }
        let outputs = self.cell_outputs(design, locked, cells);
        let rows = outputs.chunks_exact(count).zip(cells).enumerate();
        let set = |(k, (row, cell)): (usize, (&[f32], &Cell))| {
            let decoded = match &self.architecture.head {
                Head::Mdn(head) => {
                    // One stream per place in the list: the same call gives the same sets.
                    let generator = &mut stream(0, k as u64);
                    self.decoder.decode(&head.mixture(row), generator)
                }
                Head::Arcs(head) => head.decode(row),
                Head::Size(_) => AngleSet::empty(),
            };
            match self.architecture.closed_forms {
                ClosedForms::None => decoded,
                _ => decoded.intersection(&self.allowed(locked, cell)),
            }
        };
        Some(rows.map(set).collect())
    }

    /// What the closed forms that this model uses leave of a cell.
    pub(super) fn allowed(&self, locked: &LockedJoints, cell: &Cell) -> AngleSet {
        let [inner, outer] = locked.radii();
        match self.architecture.closed_forms {
            ClosedForms::None => AngleSet::full(),
            ClosedForms::Gate if inner <= cell.radius && cell.radius <= outer => AngleSet::full(),
            ClosedForms::Gate => AngleSet::empty(),
            ClosedForms::PostFailure => self.arm.post_failure_set(locked, cell),
        }
    }

    /// Whether the closed forms that this model uses leave nothing of a cell.
    pub fn is_ruled_out(&self, locked: &LockedJoints, cell: &Cell) -> bool {
        self.allowed(locked, cell).is_empty()
    }

    /// Outputs of the network for cells of a design, row by row.
    pub(super) fn rows(&self, design: &Design, cells: &[Cell]) -> Vec<f32> {
        self.cell_outputs(design, &self.arm.locked_joints(design), cells)
    }

    /// Appends the sizes of as many designs as are computed at once.
    fn add_sizes(&self, head: &SizeHead, designs: &[Design], sizes: &mut Vec<f64>) {
        let count = self.features.count();
        let mut inputs = vec![0.0; designs.len() * count];
        let mut bounds = Vec::with_capacity(designs.len());
        for (design, row) in designs.iter().zip(inputs.chunks_exact_mut(count)) {
            let locked = self.arm.locked_joints(design);
            self.features.write(design, &locked, None, false, row);
            bounds.push(head.bound(&locked));
        }
        let outputs = self.outputs(&inputs);
        let pairs = outputs.iter().zip(&bounds);
        sizes.extend(pairs.map(|(&output, &bound)| head.size(output, bound)));
    }

    fn size_from_sets(&self, design: &Design) -> f64 {
        let locked = self.arm.locked_joints(design);
        let rule = self.quadrature(&locked);
        let sets = self.sets_with(design, &locked, &rule.cells);
        sets.map_or(0.0, |sets| rule.sum(&sets))
    }
}

impl Surrogate for Model {
    fn arm(&self) -> &SurrogateArm {
        &self.arm
    }

    fn sets(&self, design: &Design, cells: &[Cell]) -> Option<Vec<AngleSet>> {
        let locked = self.arm.locked_joints(design);
        self.sets_with(design, &locked, cells)
    }

    fn sizes(&self, designs: &[Design]) -> Vec<f64> {
        let Head::Size(head) = &self.architecture.head else {
            return designs.iter().map(|d| self.size_from_sets(d)).collect();
        };
        let mut sizes = Vec::with_capacity(designs.len());
        for together in designs.chunks(self.network.rows_at_once()) {
            self.add_sizes(head, together, &mut sizes);
        }
        sizes
    }
}

/// The exact workspaces in the place of a surrogate.
impl Surrogate for SurrogateArm {
    fn arm(&self) -> &SurrogateArm {
        self
    }

    fn sets(&self, design: &Design, cells: &[Cell]) -> Option<Vec<AngleSet>> {
        Some(self.fault_tolerant_sets(design, cells))
    }

    fn sizes(&self, designs: &[Design]) -> Vec<f64> {
        designs.iter().map(|design| self.size(design)).collect()
    }
}
