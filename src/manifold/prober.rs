//! Where the Newton steps of a search come from.
//!
//! A search is written once, as a coroutine (an `async fn`) that asks a [`Prober`] for one Newton
//! step after the other. A search of its own is answered at once and never waits; those of many
//! task points ask together, see [`super::desk`].

use crate::kinematics::{Goal, Kernel, NewtonStep, newton_step};
use std::future::{Future, ready};
use std::pin::{Pin, pin};
use std::task::{Context, Poll, Waker};

/// Newton steps onto the pre-image of one task point.
pub(super) trait Prober<const N: usize, const M: usize> {
    /// What the robot does.
    fn kernel(&self) -> &Kernel<N, M>;
    /// Linearisation and Newton step at `point`; `None` where the Jacobian has lost rank.
    fn probe(&self, point: &[f64; N]) -> impl Future<Output = Option<NewtonStep<N>>>;
}

/// Answers one search at once.
pub(super) struct Alone<'a, const N: usize, const M: usize> {
    pub kernel: &'a Kernel<N, M>,
    pub goal: &'a Goal<f64>,
}

impl<const N: usize, const M: usize> Prober<N, M> for Alone<'_, N, M> {
    fn kernel(&self) -> &Kernel<N, M> {
        self.kernel
    }

    #[inline]
    fn probe(&self, point: &[f64; N]) -> impl Future<Output = Option<NewtonStep<N>>> {
        ready(newton_step(&self.kernel.linearise(point, self.goal)))
    }
}

/// The result of a search that never waits.
pub(super) fn at_once<T>(search: impl Future<Output = T>) -> T {
    let mut search = pin!(search);
    loop {
        if let Some(result) = resume(search.as_mut()) {
            return result;
        }
    }
}

/// Goes on with a search until it ends or waits. Nobody needs to be woken: whoever answers its
/// question resumes it.
pub(super) fn resume<T>(search: Pin<&mut impl Future<Output = T>>) -> Option<T> {
    match search.poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => Some(result),
        Poll::Pending => None,
    }
}
