//! Follows one self-motion manifold from a configuration on it.
//!
//! Predictor: the quadratic through the last three tangents, integrated over the step. Corrector:
//! one least-norm Newton step, whose size steers the step. The tangent's sign is intrinsic (see
//! [`crate::kinematics::newton_step`]), so a jump to another strand nearby, which is oriented the
//! other way, shows as a tangent that points back.

use super::curve::{Curve, CurveStatus, short_way};
use super::segment::Segment;
use crate::kinematics::{Goal, Kernel, NewtonStep, dot, newton_step};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Accuracy and guards of tracing. Angles and distances are in (internal) radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraceSettings {
    /// Largest Newton correction of an accepted step; the residual left is about its square.
    /// Larger: less accurate ranges and more strand jumps to reject.
    pub correction: f64,
    /// Longest step. Larger: seeds and closures are harder to recognise.
    pub max_step: f64,
    /// Largest turn of the tangent within a step. Larger: sharp bends are cut.
    pub max_turn: f64,
    /// Steps that end a curve which does not close.
    pub max_steps: usize,
    /// Newton steps on every vertex after tracing, for residuals at round-off; 0 leaves the
    /// residual of the trace.
    pub polish: usize,
}

impl Default for TraceSettings {
    /// Residuals below 1e-6 of the reach; ranges to about 1e-6 rad.
    fn default() -> TraceSettings {
        TraceSettings {
            correction: 5e-4,
            max_step: 0.4,
            max_turn: 0.3,
            max_steps: 10_000,
            polish: 1,
        }
    }
}

impl TraceSettings {
    /// For many poses at once, where sampling errors rule: ranges to about 1e-5 rad.
    pub fn coarse() -> TraceSettings {
        TraceSettings {
            correction: 2e-3,
            max_step: 0.5,
            max_turn: 0.4,
            max_steps: 5_000,
            polish: 0,
        }
    }
}

impl TraceSettings {
    /// For a curve that did not close.
    fn finer(self) -> TraceSettings {
        TraceSettings {
            correction: 0.1 * self.correction,
            max_turn: 0.5 * self.max_turn,
            ..self
        }
    }
}

/// First step of a curve; shorter loops than about three of these are not resolved.
const FIRST_STEP: f64 = 0.02;
/// Steps below which the configuration counts as singular.
const LEAST_STEP: f64 = 1e-7;

/// Why a march ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ending {
    Closed,
    Stroke,
    Singular,
    TooLong,
}

/// How often a curve is traced again with finer steps if it does not close smoothly.
const RETRIES: usize = 2;

/// Traces the curve through `start`, which must solve the task, into `curve`.
///
/// The curve runs along the cofactor field at `start`. If it does not close, it is followed both
/// ways, and `start` lies inside it. A curve that ends at a singular configuration or runs
/// through one is traced again with finer steps, which tell a sharp bend from a node.
pub(crate) fn trace<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    start: &[f64; N],
    settings: &TraceSettings,
    curve: &mut Curve<N>,
) {
    let mut settings = *settings;
    for _ in 0..=RETRIES {
        trace_once(kernel, goal, start, &settings, curve);
        if curve.is_smooth() {
            break;
        }
        settings = settings.finer();
    }
    for _ in 0..settings.polish {
        polish(kernel, goal, settings.correction, curve);
    }
    curve.measure();
}

fn trace_once<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    start: &[f64; N],
    settings: &TraceSettings,
    curve: &mut Curve<N>,
) {
    curve.clear();
    let ending = march(kernel, goal, start, 1.0, settings, curve);
    curve.status = status_of(ending, None);
    if ending != Ending::Closed {
        let mut other = Curve::new();
        let back = march(kernel, goal, start, -1.0, settings, &mut other);
        curve.status = status_of(ending, Some(back));
        join(curve, other);
    }
}

fn status_of(forward: Ending, backward: Option<Ending>) -> CurveStatus {
    let both = [Some(forward), backward];
    let any = |ending| both.contains(&Some(ending));
    if any(Ending::Closed) {
        CurveStatus::Closed
    } else if any(Ending::Singular) {
        CurveStatus::Singular
    } else if any(Ending::TooLong) {
        CurveStatus::TooLong
    } else {
        CurveStatus::Stroke
    }
}

/// Puts the part before the start in front of the part behind it.
fn join<const N: usize>(curve: &mut Curve<N>, mut before: Curve<N>) {
    if curve.status == CurveStatus::Closed {
        // Only the backward march closed: it is the whole curve.
        before.status = CurveStatus::Closed;
        before.reverse();
        *curve = before;
        return;
    }
    before.reverse();
    before.status = curve.status;
    before.points.pop();
    before.tangents.pop();
    let shift = before.points.len();
    before.points.append(&mut curve.points);
    before.tangents.append(&mut curve.tangents);
    before
        .crossings
        .extend(curve.crossings.iter().map(|index| index + shift));
    *curve = before;
}

/// The state of a march.
struct March<'a, const N: usize, const M: usize> {
    kernel: &'a Kernel<N, M>,
    goal: &'a Goal<f64>,
    settings: &'a TraceSettings,
    point: [f64; N],
    /// Tangents at the last three vertices, newest first, and the two steps between them.
    tangents: [[f64; N]; 3],
    steps: [f64; 2],
    /// +1 or −1: the march's direction relative to the cofactor field.
    sense: f64,
    step: f64,
}

fn march<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    start: &[f64; N],
    sense: f64,
    settings: &TraceSettings,
    curve: &mut Curve<N>,
) -> Ending {
    let Some(first) = probe(kernel, start, goal) else {
        curve.push(*start, [0.0; N]);
        return Ending::Singular;
    };
    let tangent = first.tangent.map(|t| t * sense);
    curve.push(*start, tangent);
    let mut march = March {
        kernel,
        goal,
        settings,
        point: *start,
        tangents: [tangent; 3],
        steps: [FIRST_STEP; 2],
        sense,
        step: FIRST_STEP.min(settings.max_step),
    };
    let mut vertices = 1;
    for _ in 0..settings.max_steps {
        if !march.advance() {
            if march.step >= LEAST_STEP {
                march.settle(curve);
                continue;
            }
            if !march.cross_singularity() {
                return Ending::Singular;
            }
            curve.crossings.push(vertices);
        }
        vertices += 1;
        curve.push(march.point, march.tangents[0]);
        if vertices > 3
            && let Some(end) = march.back_at_start(curve)
        {
            let last = curve.points.len() - 1;
            curve.points[last] = end;
            curve.tangents[last] = curve.tangents[0];
            return Ending::Closed;
        }
        if let Some(joint) = march.left_stroke() {
            march.end_at_stroke(curve, joint);
            return Ending::Stroke;
        }
    }
    Ending::TooLong
}

/// If the start lies on the newest segment (modulo full turns): the start, unwrapped.
fn closure<const N: usize>(curve: &Curve<N>) -> Option<(Segment<N>, f64, [f64; N])> {
    let (start, last) = (&curve.points[0], curve.points.len() - 1);
    let (from, to) = (&curve.points[last - 1], &curve.points[last]);
    let mut gap = 0.0;
    let mut chord = 0.0;
    for k in 0..N {
        let d = short_way(start[k] - to[k]);
        gap += d * d;
        let c = to[k] - from[k];
        chord += c * c;
    }
    if gap > 1.7 * chord || dot(&curve.tangents[0], &curve.tangents[last]) < 0.5 {
        return None;
    }
    let lifted: [f64; N] = std::array::from_fn(|k| to[k] + short_way(start[k] - to[k]));
    let segment = Segment::new(from, to, &curve.tangents[last - 1], &curve.tangents[last]);
    let (u, miss) = segment.project(&lifted)?;
    (miss < 2e-3 + 0.005 * chord.sqrt()).then_some((segment, u, lifted))
}

impl<const N: usize, const M: usize> March<'_, N, M> {
    /// Tries one step; on failure the step is halved.
    fn advance(&mut self) -> bool {
        let h = self.step;
        let guess = self.predict(h);
        let accepted =
            probe(self.kernel, &guess, self.goal).and_then(|newton| self.judge(h, &guess, &newton));
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
    fn settle(&mut self, curve: &mut Curve<N>) {
        let Some(newton) = probe(self.kernel, &self.point, self.goal) else {
            return;
        };
        let correction = dot(&newton.correction, &newton.correction).sqrt();
        let tangent = newton.tangent.map(|t| t * self.sense);
        let small = correction <= self.settings.correction;
        let last = curve.points.len() - 1;
        if last == 0 || !small || dot(&tangent, &self.tangents[0]) < self.settings.max_turn.cos() {
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
        if dot(&tangent, &self.tangents[0]) < settings.max_turn.cos() {
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
    fn cross_singularity(&mut self) -> bool {
        for h in [1e-4, 1e-3, 1e-2, 3e-2] {
            let guess: [f64; N] = std::array::from_fn(|k| self.point[k] + h * self.tangents[0][k]);
            let Some((point, newton)) = correct(self.kernel, self.goal, &guess) else {
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

    /// The start, unwrapped, if the newest segment runs through it.
    ///
    /// Another strand may pass so near that only the manifold itself tells: from the segment,
    /// Newton steps within the plane across the start must lead to the start.
    fn back_at_start(&self, curve: &Curve<N>) -> Option<[f64; N]> {
        let (segment, u, start) = closure(curve)?;
        let across = &curve.tangents[0];
        let mut point = segment.at(u);
        for _ in 0..5 {
            let Some(newton) = probe(self.kernel, &point, self.goal) else {
                break;
            };
            let tangent = newton.tangent.map(|t| t * self.sense);
            let along = dot(&tangent, across);
            if along < 0.5 {
                return None;
            }
            let moved: [f64; N] = std::array::from_fn(|k| point[k] + newton.correction[k]);
            let ahead: f64 = (0..N).map(|k| (start[k] - moved[k]) * across[k]).sum();
            point = std::array::from_fn(|k| moved[k] + tangent[k] * ahead / along);
        }
        let miss: [f64; N] = std::array::from_fn(|k| point[k] - start[k]);
        let first = &curve.points[0];
        (dot(&miss, &miss) < 1e-10)
            .then(|| std::array::from_fn(|k| first[k] + full_turns(start[k] - first[k])))
    }

    /// The prismatic joint that has left its stroke.
    fn left_stroke(&self) -> Option<usize> {
        (0..N).find(|&k| !self.kernel.is_revolute(k) && self.point[k].abs() > FRAC_PI_2)
    }

    /// Moves the newest vertex, beyond the stroke of `joint`, back to its end.
    fn end_at_stroke(&mut self, curve: &mut Curve<N>, joint: usize) {
        let last = curve.points.len() - 1;
        let limit = FRAC_PI_2.copysign(self.point[joint]);
        let segment = curve.segment(last - 1);
        let (mut inside, mut outside) = (0.0, 1.0);
        for _ in 0..40 {
            let middle = 0.5 * (inside + outside);
            if segment.coordinate(joint, middle).abs() < FRAC_PI_2 {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        let mut point = segment.at(inside);
        let mut tangent = self.tangents[0];
        for _ in 0..4 {
            let Some(newton) = probe(self.kernel, &point, self.goal) else {
                break;
            };
            tangent = newton.tangent.map(|t| t * self.sense);
            let ahead = limit - point[joint] - newton.correction[joint];
            let step = (ahead / tangent[joint]).clamp(-0.1, 0.1);
            for k in 0..N {
                point[k] += newton.correction[k] + step * tangent[k];
            }
        }
        // Where the joint turns round just at its end, the steps may not converge.
        if (point[joint] - limit).abs() < 1e-9 && dot(&tangent, &self.tangents[0]) > 0.5 {
            point[joint] = limit;
            curve.points[last] = point;
            curve.tangents[last] = tangent;
        }
    }
}

/// The multiple of a full turn next to `angle`.
fn full_turns(angle: f64) -> f64 {
    (angle / TAU).round() * TAU
}

/// The factor by which the step may change, from the size of the last correction, which grows
/// with the fourth power of the step.
fn growth(correction: f64, allowed: f64) -> f64 {
    let ratio = 0.5 * allowed / correction.max(1e-12);
    ratio.sqrt().sqrt().clamp(0.5, 1.7)
}

/// Newton steps from `guess` onto the manifold; `None` if they do not converge.
pub(crate) fn correct<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    guess: &[f64; N],
) -> Option<([f64; N], NewtonStep<N>)> {
    let mut point = *guess;
    for _ in 0..12 {
        let newton = probe(kernel, &point, goal)?;
        let size = dot(&newton.correction, &newton.correction).sqrt();
        // NaN and runaway corrections alike.
        if !(size < 0.1) {
            return None;
        }
        for k in 0..N {
            point[k] += newton.correction[k];
        }
        // The next one would be about the square.
        if size < 1e-6 {
            return Some((point, newton));
        }
    }
    None
}

/// One Newton step at every vertex.
fn polish<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    goal: &Goal<f64>,
    allowed: f64,
    curve: &mut Curve<N>,
) {
    let ends = if curve.status == CurveStatus::Stroke {
        1
    } else {
        0
    };
    for index in ends..curve.points.len() - ends {
        let point = curve.points[index];
        let Some(newton) = probe(kernel, &point, goal) else {
            continue;
        };
        let size = dot(&newton.correction, &newton.correction);
        if !(size <= allowed * allowed) {
            continue;
        }
        let old = curve.tangents[index];
        let sense = dot(&newton.tangent, &old).signum();
        if sense < 0.0 && curve.crossings.is_empty() {
            // The step led to a neighbouring strand.
            continue;
        }
        curve.points[index] = std::array::from_fn(|k| point[k] + newton.correction[k]);
        curve.tangents[index] = newton.tangent.map(|t| t * sense);
    }
    if curve.status == CurveStatus::Closed {
        // Both ends are the same configuration; keep them equal to the last bit but the turns.
        let last = curve.points.len() - 1;
        let (first, end) = (curve.points[0], curve.points[last]);
        curve.points[last] = std::array::from_fn(|k| first[k] + full_turns(end[k] - first[k]));
        curve.tangents[last] = curve.tangents[0];
    }
}

/// Linearisation and Newton step in one.
#[inline]
fn probe<const N: usize, const M: usize>(
    kernel: &Kernel<N, M>,
    point: &[f64; N],
    goal: &Goal<f64>,
) -> Option<NewtonStep<N>> {
    newton_step(&kernel.linearise(point, goal))
}
