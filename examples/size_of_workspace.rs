//! The size of the fault-tolerant workspace of a planar arm, and what each joint costs.

use faultspace::angle::degree_pairs;
use faultspace::workspace::planar::{PlanarArm, PlanarPosition};
use faultspace::workspace::{ArtificialLimits, FailureSet};

fn main() {
    let limits = ArtificialLimits::from_degrees(&[
        [-18.21, 18.21],
        [-111.322, 111.322],
        [-111.322, 111.322],
    ]);
    let failures = FailureSet::any(3);
    let arm = PlanarArm {
        lengths: &[1.0, 1.0, 1.0],
        limits: &limits,
        failures: &failures,
    };
    let mut estimator = PlanarPosition::new();
    let sizes = estimator.sizes(arm);
    println!("before a failure      {:.6} m²", sizes.pre_failure.value);
    for (joint, size) in (1..).zip(&sizes.post_failure) {
        println!("joint {joint} locked        {:.6} m²", size.value);
    }
    println!("before and after      {:.6} m²", sizes.fault_tolerant.value);
    println!(
        "polar angles at 1.5 m {:?} deg",
        degree_pairs(&estimator.rotation_set(arm, 1.5))
    );
}
