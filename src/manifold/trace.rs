//! Follows one self-motion manifold from a configuration on it, both ways if need be, and again
//! with finer steps where it does not close.

use super::correct::polish;
use super::curve::{Curve, CurveStatus};
use super::extrema::resolve;
use super::march::{Ending, march};
use super::prober::Prober;

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

/// How often a curve is traced again with finer steps if it does not close smoothly.
const RETRIES: usize = 2;

/// Traces the curve through `start`, which must solve the task, into `curve`.
///
/// The curve runs along the cofactor field at `start`. If it does not close, it is followed both
/// ways, and `start` lies inside it. A curve that ends at a singular configuration or runs
/// through one is traced again with finer steps, which tell a sharp bend from a node.
pub(super) async fn trace<const N: usize, const M: usize>(
    prober: &impl Prober<N, M>,
    start: &[f64; N],
    settings: &TraceSettings,
    curve: &mut Curve<N>,
) {
    let mut settings = *settings;
    for _ in 0..=RETRIES {
        trace_once(prober, start, &settings, curve).await;
        // A curve that is too long would only become longer.
        if curve.is_smooth() || curve.status == CurveStatus::TooLong {
            break;
        }
        settings = settings.finer();
    }
    for _ in 0..settings.polish {
        polish(prober, settings.correction, curve).await;
    }
    if settings.polish > 0 {
        resolve(prober, curve).await;
    }
    curve.measure();
}

async fn trace_once<const N: usize, const M: usize>(
    prober: &impl Prober<N, M>,
    start: &[f64; N],
    settings: &TraceSettings,
    curve: &mut Curve<N>,
) {
    curve.clear();
    let ending = march(prober, start, 1.0, settings, curve).await;
    curve.status = status_of(ending, None);
    if ending != Ending::Closed {
        let mut other = Curve::new();
        let back = march(prober, start, -1.0, settings, &mut other).await;
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
