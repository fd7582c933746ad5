//! Numbers that the kernels compute with: one `f64`, or eight at once.
//!
//! The same generic code serves both. Eight lanes are plain arrays; a caller that is compiled for
//! a wider instruction set turns every operation into one or two vector instructions. Nothing is
//! contracted or reordered, so every lane holds bit for bit what the scalar code would give, on
//! every machine.

use super::sine::sin_cos;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number, or a fixed number of independent ones.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The same constant in every lane.
    fn constant(value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// The larger value, lane by lane.
    fn max(self, other: Self) -> Self;
    /// The smaller value, lane by lane.
    fn min(self, other: Self) -> Self;
    /// The magnitude.
    fn abs(self) -> Self;
    /// 1 with the sign of the number.
    fn signum(self) -> Self;
    /// The number in lane `lane`; a single number is the same in all.
    fn lane(self, lane: usize) -> f64;
    /// Call it first in every loop over coordinates: keeps the compiler from turning that loop,
    /// rather than the lanes, into vectors, which costs a factor of three. Does nothing else.
    fn keep_loop();
}

impl Real for f64 {
    #[inline(always)]
    fn constant(value: f64) -> f64 {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        self.sqrt()
    }
    #[inline(always)]
    fn sin_cos(self) -> (f64, f64) {
        sin_cos(self)
    }
    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn abs(self) -> f64 {
        self.abs()
    }
    #[inline(always)]
    fn signum(self) -> f64 {
        self.signum()
    }
    #[inline(always)]
    fn lane(self, _: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn keep_loop() {}
}

/// Number of lanes of [`Lanes`].
pub const LANES: usize = 8;

/// Eight independent numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

macro_rules! lane_operation {
    ($operation:ident, $method:ident, $operator:tt) => {
        impl $operation for Lanes {
            type Output = Lanes;
            #[inline(always)]
            fn $method(self, other: Lanes) -> Lanes {
                let mut result = self;
                for lane in 0..LANES {
                    result.0[lane] = self.0[lane] $operator other.0[lane];
                }
                result
            }
        }
    };
}

lane_operation!(Add, add, +);
lane_operation!(Sub, sub, -);
lane_operation!(Mul, mul, *);
lane_operation!(Div, div, /);

impl Neg for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn neg(self) -> Lanes {
        self.map(|x| -x)
    }
}

impl Lanes {
    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Lanes {
        let mut result = self;
        for lane in 0..LANES {
            result.0[lane] = function(self.0[lane]);
        }
        result
    }
}

impl Real for Lanes {
    #[inline(always)]
    fn constant(value: f64) -> Lanes {
        Lanes([value; LANES])
    }
    #[inline(always)]
    fn sqrt(self) -> Lanes {
        self.map(f64::sqrt)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Lanes, Lanes) {
        let (mut sine, mut cosine) = (self, self);
        for lane in 0..LANES {
            (sine.0[lane], cosine.0[lane]) = sin_cos(self.0[lane]);
        }
        (sine, cosine)
    }
    #[inline(always)]
    fn max(self, other: Lanes) -> Lanes {
        let mut result = self;
        for lane in 0..LANES {
            result.0[lane] = Real::max(self.0[lane], other.0[lane]);
        }
        result
    }
    #[inline(always)]
    fn min(self, other: Lanes) -> Lanes {
        let mut result = self;
        for lane in 0..LANES {
            result.0[lane] = Real::min(self.0[lane], other.0[lane]);
        }
        result
    }
    #[inline(always)]
    fn abs(self) -> Lanes {
        self.map(f64::abs)
    }
    #[inline(always)]
    fn signum(self) -> Lanes {
        self.map(f64::signum)
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.0[lane]
    }
    #[inline(always)]
    fn keep_loop() {
        // SAFETY: no instruction at all. Loops that contain inline assembly are not vectorised.
        unsafe { std::arch::asm!("", options(nomem, nostack, preserves_flags)) }
    }
}
