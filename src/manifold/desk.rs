//! Eight searches of different task points at once, with their Newton steps in lanes.
//!
//! A search that asks for a Newton step waits until the seven others have asked as well; then all
//! eight are answered together. Lanes compute bit for bit what a single number would, so a search
//! finds what it would find alone, whichever its neighbours are.

use super::prober::{Prober, resume};
use crate::kinematics::{
    Goal, Kernel, LANES, Lanes, Linearisation, NewtonStep, PivotedStep, Real, newton_steps,
};
use multiversion::multiversion;
use std::cell::RefCell;
use std::future::Future;
use std::mem::replace;
use std::pin::Pin;
use std::task::{Context, Poll};

/// Questions of eight searches, and the answers.
pub(super) struct Desk<'a, const N: usize, const M: usize> {
    kernel: &'a Kernel<N, M>,
    page: RefCell<Page<N, M>>,
}

struct Page<const N: usize, const M: usize> {
    goal: Goal<Lanes>,
    point: [Lanes; N],
    /// Room to work in.
    linear: Linearisation<Lanes, N, M>,
    step: PivotedStep<Lanes, N>,
}

/// The place of one search.
pub(super) struct Seat<'a, const N: usize, const M: usize> {
    desk: &'a Desk<'a, N, M>,
    lane: usize,
}

impl<'a, const N: usize, const M: usize> Desk<'a, N, M> {
    pub fn new(kernel: &'a Kernel<N, M>) -> Desk<'a, N, M> {
        let zero = Lanes::constant(0.0);
        let goal = Goal {
            position: [zero; 3],
            axes: [[zero; 3]; 3],
        };
        let point = [zero; N];
        let mut linear = Linearisation::new();
        let step = newton_steps(&mut linear);
        let page = RefCell::new(Page {
            goal,
            point,
            linear,
            step,
        });
        Desk { kernel, page }
    }

    /// Runs a search on each of the eight seats until all have ended.
    pub fn run<'d, F: Future<Output = ()>>(&'d self, search: impl Fn(Seat<'d, N, M>) -> F)
    where
        'a: 'd,
    {
        let place = |lane| Some(Box::pin(search(Seat { desk: self, lane })));
        let mut searches: [_; LANES] = std::array::from_fn(place);
        loop {
            let mut waiting = false;
            for place in &mut searches {
                if let Some(search) = place {
                    match resume(search.as_mut()) {
                        Some(()) => *place = None,
                        None => waiting = true,
                    }
                }
            }
            if !waiting {
                return;
            }
            answer(self.kernel, &mut self.page.borrow_mut());
        }
    }
}

impl<const N: usize, const M: usize> Seat<'_, N, M> {
    /// Sets the task point of the questions that follow.
    pub fn aim(&self, goal: &Goal<f64>) {
        let page = &mut *self.desk.page.borrow_mut();
        for i in 0..3 {
            page.goal.position[i].0[self.lane] = goal.position[i];
            for k in 0..3 {
                page.goal.axes[k][i].0[self.lane] = goal.axes[k][i];
            }
        }
    }
}

impl<const N: usize, const M: usize> Prober<N, M> for Seat<'_, N, M> {
    fn kernel(&self) -> &Kernel<N, M> {
        self.desk.kernel
    }

    #[inline]
    fn probe(&self, point: &[f64; N]) -> impl Future<Output = Option<NewtonStep<N>>> {
        let mut page = self.desk.page.borrow_mut();
        for (lanes, coordinate) in page.point.iter_mut().zip(point) {
            lanes.0[self.lane] = *coordinate;
        }
        Answer {
            seat: self,
            is_due: false,
        }
    }
}

/// The answer to a question that has been put: due when the search is resumed.
struct Answer<'a, const N: usize, const M: usize> {
    seat: &'a Seat<'a, N, M>,
    is_due: bool,
}

impl<const N: usize, const M: usize> Future for Answer<'_, N, M> {
    type Output = Option<NewtonStep<N>>;

    #[inline(always)]
    fn poll(mut self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<Self::Output> {
        if !replace(&mut self.is_due, true) {
            return Poll::Pending;
        }
        let Seat { desk, lane } = self.seat;
        Poll::Ready(desk.page.borrow().step.lane(*lane))
    }
}

/// The Newton steps of all lanes.
#[multiversion(
    targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"),
    dispatcher = "direct"
)]
fn answer<const N: usize, const M: usize>(kernel: &Kernel<N, M>, page: &mut Page<N, M>) {
    kernel.linearise_into(&page.point, &page.goal, &mut page.linear);
    page.step = newton_steps(&mut page.linear);
}
