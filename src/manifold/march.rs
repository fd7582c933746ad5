//! Marches along a manifold, one way.
//!
//! Predictor: the quadratic through the last three tangents, integrated over the step. Corrector:
//! one least-norm Newton step, whose size steers the step. The tangent's sign is intrinsic (see
//! [`crate::kinematics::newton_step`]), so a jump to another strand nearby, which is oriented the
//! other way, shows as a tangent that points back.

use super::TraceSettings;
use super::correct::correct;
use super::curve::Curve;
use super::prober::Prober;
use crate::kinematics::{NewtonStep, dot};

/// First step of a curve; shorter loops than about three of these are not resolved.
const FIRST_STEP: f64 = 0.02;
/// Steps below which the configuration counts as singular.
const LEAST_STEP: f64 = 1e-7;

/// Singular configurations crossed after which a march ends: it then creeps along a set of them.
const MOST_CROSSINGS: usize = 64;

/// Why a march ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ending {
    Closed,
    Stroke,
    Singular,
    TooLong,
}

/// The state of a march.
pub(super) struct March<'a, P, const N: usize, const M: usize> {
    pub(super) prober: &'a P,
    settings: &'a TraceSettings,
    pub(super) point: [f64; N],
    /// Tangents at the last three vertices, newest first, and the two steps between them.
    pub(super) tangents: [[f64; N]; 3],
    steps: [f64; 2],
    /// +1 or −1: the march's direction relative to the cofactor field.
    pub(super) sense: f64,
    step: f64,
    /// Cosine of the largest turn within a step.
    least_cosine: f64,
}

pub(super) async fn march<const N: usize, const M: usize>(
    prober: &impl Prober<N, M>,
    start: &[f64; N],
    sense: f64,
    settings: &TraceSettings,
    curve: &mut Curve<N>,
) -> Ending {
    let Some(first) = prober.probe(start).await else {
        curve.push(*start, [0.0; N]);
        return Ending::Singular;
    };
    let tangent = first.tangent.map(|t| t * sense);
    curve.push(*start, tangent);
    let mut march = March {
        prober,
        settings,
        point: *start,
        tangents: [tangent; 3],
        steps: [FIRST_STEP; 2],
        sense,
        step: FIRST_STEP.min(settings.max_step),
        least_cosine: settings.max_turn.cos(),
    };
    let mut vertices = 1;
    for _ in 0..settings.max_steps {
        if !march.advance().await {
            if march.step >= LEAST_STEP {
                march.settle(curve).await;
                continue;
            }
            if !march.cross_singularity().await {
                return Ending::Singular;
            }
            curve.crossings.push(vertices);
            if curve.crossings.len() > MOST_CROSSINGS {
                return Ending::TooLong;
            }
        }
        vertices += 1;
        curve.push(march.point, march.tangents[0]);
        if vertices > 3
            && let Some(end) = march.back_at_start(curve).await
        {
            let last = curve.points.len() - 1;
            curve.points[last] = end;
            curve.tangents[last] = curve.tangents[0];
            return Ending::Closed;
        }
        if let Some((joint, outside)) = march.left_stroke(curve) {
            march.end_at_stroke(curve, joint, outside).await;
            return Ending::Stroke;
        }
    }
    Ending::TooLong
}

impl<P: Prober<N, M>, const N: usize, const M: usize> March<'_, P, N, M> {
    /// Tries one step; on failure the step is halved.
    async fn advance(&mut self) -> bool {
        let h = self.step;
        let guess = self.predict(h);
        let newton = self.prober.probe(&guess).await;
        let accepted = newton.and_then(|newton| self.judge(h, &guess, &newton));
        let Some((point, tangent, correction)) = accepted else {
            self.step = 0.5 * h;
            return false;
        };
        self.point = point;
        self.tangents = [tangent, self.tangents[0], self.tangents[1]];
        self.steps = [h, self.steps[0]];
        self.step = (h * growth(correction, self.settings.correction))
            .min(self.settings.max_step)
            .min(self.turn_limit(h));
        true
    }

    /// Corrects the vertex at which a step has failed once more.
    ///
    /// What the first correction left is negligible for the vertex but not for the ever smaller
    /// steps around a sharp bend, where it would pass for the step's own error.
    async fn settle(&mut self, curve: &mut Curve<N>) {
        let Some(newton) = self.prober.probe(&self.point).await else {
            return;
        };
        let correction = dot(&newton.correction, &newton.correction).sqrt();
        let tangent = newton.tangent.map(|t| t * self.sense);
        let small = correction <= self.settings.correction;
        let last = curve.points.len() - 1;
        if last == 0 || !small || dot(&tangent, &self.tangents[0]) < self.least_cosine {
            return;
        }
        for k in 0..N {
            self.point[k] += newton.correction[k];
        }
        self.tangents[0] = tangent;
        curve.points[last] = self.point;
        curve.tangents[last] = tangent;
    }

    /// The step at which the tangent would turn by three quarters of what is allowed.
    fn turn_limit(&self, h: f64) -> f64 {
        let turn = 1.0 - dot(&self.tangents[0], &self.tangents[1]);
        let angle = (2.0 * turn.max(0.0)).sqrt();
        0.75 * self.settings.max_turn * h / angle.max(1e-9)
    }

    /// Third-order predictor: ∫ of the quadratic through the last three tangents.
    fn predict(&self, h: f64) -> [f64; N] {
        let [t0, t1, t2] = &self.tangents;
        let [h1, h2] = self.steps;
        let (half, cube) = (0.5 * h * h, h * h * (h / 3.0 + 0.5 * h1));
        let (per_1, per_2, per_12) = (1.0 / h1, 1.0 / h2, 1.0 / (h1 + h2));
        std::array::from_fn(|k| {
            let first = (t0[k] - t1[k]) * per_1;
            let second = (first - (t1[k] - t2[k]) * per_2) * per_12;
            self.point[k] + h * t0[k] + half * first + cube * second
        })
    }

    /// The corrected vertex, its tangent and the size of the correction, if the step is sound.
    fn judge(
        &self,
        h: f64,
        guess: &[f64; N],
        newton: &NewtonStep<N>,
    ) -> Option<([f64; N], [f64; N], f64)> {
        let settings = self.settings;
        let correction = dot(&newton.correction, &newton.correction).sqrt();
        // The negated comparison also refuses NaN.
        if !(correction <= settings.correction && correction <= 0.1 * h) {
            return None;
        }
        let tangent = newton.tangent.map(|t| t * self.sense);
        if dot(&tangent, &self.tangents[0]) < self.least_cosine {
            return None;
        }
        let point: [f64; N] = std::array::from_fn(|k| guess[k] + newton.correction[k]);
        // The chord must be what both tangents say.
        let (mut length, mut error) = (0.0, 0.0);
        for k in 0..N {
            let chord = point[k] - self.point[k];
            length += chord * chord;
            let mean = 0.5 * h * (tangent[k] + self.tangents[0][k]);
            error += (chord - mean) * (chord - mean);
        }
        let sound = error <= (0.055 * h).powi(2) && length <= (1.5 * h).powi(2);
        sound.then_some((point, tangent, correction))
    }

    /// Steps straight across a singular configuration where two strands meet.
    ///
    /// There the cofactor field vanishes and points the other way behind; the march keeps the
    /// direction closest to the incoming one.
    async fn cross_singularity(&mut self) -> bool {
        for h in [1e-4, 1e-3, 1e-2, 3e-2] {
            let guess: [f64; N] = std::array::from_fn(|k| self.point[k] + h * self.tangents[0][k]);
            let Some((point, newton)) = correct(self.prober, &guess).await else {
                continue;
            };
            // At a simple node the field turns round, at others it need not.
            let along = dot(&newton.tangent, &self.tangents[0]);
            let tangent = newton.tangent.map(|t| t * along.signum());
            let moved: [f64; N] = std::array::from_fn(|k| point[k] - guess[k]);
            if along.abs() > 0.95 && dot(&moved, &moved).sqrt() < 0.2 * h {
                self.point = point;
                self.sense = along.signum();
                self.tangents = [tangent; 3];
                self.steps = [h; 2];
                self.step = h;
                return true;
            }
        }
        false
    }
}

/// The factor by which the step may change, from the size of the last correction, which grows
/// with the fourth power of the step.
fn growth(correction: f64, allowed: f64) -> f64 {
    let ratio = 0.5 * allowed / correction.max(1e-12);
    ratio.sqrt().sqrt().clamp(0.5, 1.7)
}
