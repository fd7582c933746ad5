//! The hot loop of an optimiser, S_F of a 3R arm, must not allocate once its buffers exist.
//!
//! Alone in its file: the counting allocator serves the whole process.

use faultspace::workspace::planar::{PlanarArm, PlanarPosition};
use faultspace::workspace::{ArtificialLimits, FailureSet};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

// SAFETY: every call is passed on unchanged to the system allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn evaluations_of_3r_and_4r_do_not_allocate() {
    let cases = [
        vec![[-18.21, 18.21], [-111.322, 111.322], [-111.322, 111.322]],
        vec![[-20.0, 35.0], [-80.0, 120.0], [-140.0, 95.0]],
        vec![[-180.0, 180.0], [100.0, 290.0], [109.0, 109.0]],
        vec![[-5.0, 8.0], [-80.0, 120.0], [-110.0, 95.0], [-70.0, 115.0]],
    ];
    for pairs in cases {
        let limits = ArtificialLimits::from_degrees(&pairs);
        let failures = FailureSet::any(pairs.len());
        let lengths = vec![1.0; pairs.len()];
        let arm = PlanarArm {
            lengths: &lengths,
            limits: &limits,
            failures: &failures,
        };
        let mut estimator = PlanarPosition::new();
        let first = estimator.fault_tolerant_size(arm);
        let before = ALLOCATIONS.get();
        let second = estimator.fault_tolerant_size(arm);
        assert_eq!(ALLOCATIONS.get() - before, 0, "{pairs:?}");
        assert_eq!(first.to_bits(), second.to_bits());
    }
    assert!(ALLOCATIONS.get() > 0, "the counter counts");
}
