//! Fully connected networks: weights of our own, products and derivatives by candle.
//!
//! Weights live in one flat list, layer by layer: the in × out matrix row by row, then the
//! biases. That makes them easy to store, to average and to update the same way on any number of
//! threads.

use candle_core::{
    CpuStorage, CustomOp1, CustomOp2, DType, Device, Layout, Result, Shape, Tensor, Var,
};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

/// Slope of the activation for negative arguments.
const LEAK: f32 = 0.01;

/// Rows × widest layer stay below this: above, candle hands elementwise operations to a
/// spin-waiting pool of its own, which costs more than it gains.
const MOST_ENTRIES: usize = 65_535;

/// Rows × widest layer of a forward pass: larger results would be mapped and unmapped by the
/// allocator each time, which takes longer than the products.
const FORWARD_ENTRIES: usize = 12_000;

/// A network: sizes of all layers, inputs first, and its weights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Network {
    sizes: Vec<usize>,
    weights: Vec<f32>,
}

impl Network {
    /// A network with random weights, uniform within ±√(3/inputs) of each layer and a tenth of
    /// that in the last one; biases are zero.
    pub fn random(sizes: &[usize], generator: &mut ChaCha8Rng) -> Network {
        let mut weights = Vec::with_capacity(count(sizes));
        let last = sizes.len() - 2;
        for (layer, pair) in sizes.windows(2).enumerate() {
            let scale = if layer == last { 0.1 } else { 1.0 };
            let bound = scale * (3.0 / pair[0] as f32).sqrt();
            let drawn = (0..pair[0] * pair[1]).map(|_| generator.random_range(-bound..=bound));
            weights.extend(drawn);
            weights.extend(std::iter::repeat_n(0.0, pair[1]));
        }
        Network {
            sizes: sizes.to_vec(),
            weights,
        }
    }

    /// A network of given weights, unless their number or a value is wrong.
    pub fn from_weights(sizes: &[usize], weights: Vec<f32>) -> Option<Network> {
        let sound = sizes.len() >= 2
            && weights.len() == count(sizes)
            && weights.iter().all(|weight| weight.is_finite());
        sound.then(|| Network {
            sizes: sizes.to_vec(),
            weights,
        })
    }

    /// Sizes of all layers, inputs first.
    pub fn sizes(&self) -> &[usize] {
        &self.sizes
    }

    /// All weights.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// All weights, to change them.
    pub fn weights_mut(&mut self) -> &mut [f32] {
        &mut self.weights
    }

    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.sizes[0]
    }

    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        self.sizes[self.sizes.len() - 1]
    }

    /// Rows of a forward pass.
    pub fn rows_at_once(&self) -> usize {
        (FORWARD_ENTRIES / self.widest()).clamp(1, 512)
    }

    /// Most rows of a chunk that is learnt from.
    pub(super) fn rows_of_chunk(&self) -> usize {
        (MOST_ENTRIES / self.widest()).clamp(1, 512)
    }

    fn widest(&self) -> usize {
        self.sizes.iter().copied().max().unwrap_or(1)
    }

    /// The layers as tensors, for many forward passes.
    ///
    /// # Errors
    /// candle's; none is expected on the CPU.
    pub fn layers(&self) -> Result<Layers> {
        self.build(|values, shape| Tensor::from_slice(values, shape, &Device::Cpu))
    }

    /// The layers as variables to differentiate by.
    pub(super) fn variables(&self) -> Result<Layers> {
        self.build(|values, shape| {
            Ok(Var::from_slice(values, shape, &Device::Cpu)?
                .as_tensor()
                .clone())
        })
    }

    fn build(&self, tensor: impl Fn(&[f32], (usize, usize)) -> Result<Tensor>) -> Result<Layers> {
        let mut layers = Vec::new();
        let mut rest = &self.weights[..];
        for pair in self.sizes.windows(2) {
            let (matrix, after) = rest.split_at(pair[0] * pair[1]);
            let (bias, after) = after.split_at(pair[1]);
            rest = after;
            layers.push([
                tensor(matrix, (pair[0], pair[1]))?,
                tensor(bias, (1, pair[1]))?,
            ]);
        }
        Ok(Layers {
            layers,
            inputs: self.inputs(),
        })
    }
}

fn count(sizes: &[usize]) -> usize {
    sizes.windows(2).map(|p| p[0] * p[1] + p[1]).sum()
}

/// A network as tensors.
#[derive(Clone, Debug)]
pub struct Layers {
    layers: Vec<[Tensor; 2]>,
    inputs: usize,
}

impl Layers {
    /// Outputs for rows of inputs, row by row.
    ///
    /// # Errors
    /// candle's; none is expected on the CPU.
    pub fn apply(&self, inputs: &[f32]) -> Result<Vec<f32>> {
        let rows = inputs.len() / self.inputs;
        let x = Tensor::from_slice(inputs, (rows, self.inputs), &Device::Cpu)?;
        self.forward(&x)?.flatten_all()?.to_vec1()
    }

    /// Outputs, and the gradient by all weights of a loss whose value and gradient by the outputs
    /// `loss` gives, in the order of [`Network::weights`].
    pub(super) fn gradient(
        &self,
        inputs: &[f32],
        loss: impl FnOnce(&[f32]) -> (f64, Vec<f32>),
    ) -> Result<(f64, Vec<f32>)> {
        let rows = inputs.len() / self.inputs;
        let x = Tensor::from_slice(inputs, (rows, self.inputs), &Device::Cpu)?;
        let y = self.forward(&x)?;
        let (value, by_outputs) = loss(&y.flatten_all()?.to_vec1::<f32>()?);
        let by_outputs = Tensor::from_vec(by_outputs, y.shape(), &Device::Cpu)?;
        // Its derivative by the weights is that of the loss: by_outputs is a constant.
        let gradients = (&y * by_outputs)?.sum_all()?.backward()?;
        let mut flat = Vec::new();
        for tensor in self.layers.iter().flatten() {
            match gradients.get(tensor) {
                Some(gradient) => flat.extend(gradient.flatten_all()?.to_vec1::<f32>()?),
                None => flat.extend(std::iter::repeat_n(0.0, tensor.elem_count())),
            }
        }
        Ok((value, flat))
    }

    fn forward(&self, x: &Tensor) -> Result<Tensor> {
        let last = self.layers.len() - 1;
        let mut x = x.clone();
        // The bias as a product: candle's derivative of a broadcast sum costs more than all else.
        let ones = Tensor::ones((x.dim(0)?, 1), DType::F32, &Device::Cpu)?;
        for (k, [matrix, bias]) in self.layers.iter().enumerate() {
            x = (x.matmul(matrix)? + ones.matmul(bias)?)?;
            if k < last {
                x = x.apply_op1(LeakyRelu)?;
            }
        }
        Ok(x)
    }
}

/// max(x, 0) + LEAK · min(x, 0), in one pass.
struct LeakyRelu;

/// Its derivative at the first argument, times the second.
struct LeakyReluGradient;

impl CustomOp1 for LeakyRelu {
    fn name(&self) -> &'static str {
        "leaky-relu"
    }

    fn cpu_fwd(&self, storage: &CpuStorage, layout: &Layout) -> Result<(CpuStorage, Shape)> {
        let x = contiguous(storage, layout)?;
        let y = x.iter().map(|&x| x.max(LEAK * x)).collect();
        Ok((CpuStorage::F32(y), layout.shape().clone()))
    }

    fn bwd(&self, arg: &Tensor, _res: &Tensor, grad: &Tensor) -> Result<Option<Tensor>> {
        let grad = grad.contiguous()?;
        Ok(Some(arg.apply_op2_no_bwd(&grad, &LeakyReluGradient)?))
    }
}

impl CustomOp2 for LeakyReluGradient {
    fn name(&self) -> &'static str {
        "leaky-relu-gradient"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        x_layout: &Layout,
        grad: &CpuStorage,
        grad_layout: &Layout,
    ) -> Result<(CpuStorage, Shape)> {
        let (x, grad) = (contiguous(x, x_layout)?, contiguous(grad, grad_layout)?);
        let pairs = x.iter().zip(grad);
        let y = pairs
            .map(|(&x, &grad)| if x > 0.0 { grad } else { LEAK * grad })
            .collect();
        Ok((CpuStorage::F32(y), x_layout.shape().clone()))
    }
}

fn contiguous<'s>(storage: &'s CpuStorage, layout: &Layout) -> Result<&'s [f32]> {
    let values = storage.as_slice::<f32>()?;
    match layout.contiguous_offsets() {
        Some((start, end)) => Ok(&values[start..end]),
        None => candle_core::bail!("a strided {:?} tensor", DType::F32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::stream;

    /// The derivative of ½|y|² by every weight, against differences.
    #[test]
    fn gradients_agree_with_differences() {
        let mut generator = stream(1, 0);
        let mut network = Network::random(&[3, 5, 4, 2], &mut generator);
        for weight in network.weights_mut() {
            *weight += generator.random_range(-0.3..0.3);
        }
        let inputs: Vec<f32> = (0..12).map(|_| generator.random_range(-1.0..1.0)).collect();
        let half_square = |y: &[f32]| {
            let value = y.iter().map(|y| 0.5 * f64::from(*y).powi(2)).sum::<f64>();
            (value, y.to_vec())
        };
        let (_, gradient) = network
            .variables()
            .and_then(|layers| layers.gradient(&inputs, half_square))
            .unwrap();
        let value = |network: &Network| {
            let y = network.layers().and_then(|l| l.apply(&inputs)).unwrap();
            half_square(&y).0
        };
        for (k, derivative) in gradient.iter().enumerate() {
            let step = 1e-2;
            let mut moved = network.clone();
            moved.weights_mut()[k] += step;
            let up = value(&moved);
            moved.weights_mut()[k] -= 2.0 * step;
            let difference = (up - value(&moved)) / f64::from(2.0 * step);
            let error = (difference - f64::from(*derivative)).abs();
            assert!(error < 2e-2 * (1.0 + difference.abs()), "{k}: {error}");
        }
    }

    #[test]
    fn weights_of_a_wrong_number_are_refused() {
        assert!(Network::from_weights(&[2, 3], vec![0.0; 9]).is_some());
        assert!(Network::from_weights(&[2, 3], vec![0.0; 8]).is_none());
        assert!(Network::from_weights(&[2, 3], vec![f32::NAN; 9]).is_none());
    }
}
