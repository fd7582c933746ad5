//! Sizes that are known in closed form or were published, each with its source.
//!
//! \[S3\] Clark et al., *Predicting fault-tolerant workspace of planar 3R robots experiencing locked
//! joint failures using mixture density networks*. \[S4\] Bader & Maciejewski, *A hybrid approach
//! for estimating the failure-tolerant workspace size*, RA-L 2021.

use faultspace::workspace::planar::{PlanarArm, PlanarPose, PlanarPosition, PoseResolution};
use faultspace::workspace::{ArtificialLimits, Estimate, FailureSet, WorkspaceSizes};
use std::f64::consts::{PI, SQRT_2, TAU};

const FULL: [f64; 2] = [-180.0, 180.0];

fn position(lengths: &[f64], limits_deg: &[[f64; 2]]) -> WorkspaceSizes {
    let limits = ArtificialLimits::from_degrees(limits_deg);
    let failures = FailureSet::any(lengths.len());
    PlanarPosition::new().sizes(PlanarArm {
        lengths,
        limits: &limits,
        failures: &failures,
    })
}

fn pose(lengths: &[f64], limits_deg: &[[f64; 2]]) -> Estimate {
    let limits = ArtificialLimits::from_degrees(limits_deg);
    let failures = FailureSet::any(lengths.len());
    let arm = PlanarArm {
        lengths,
        limits: &limits,
        failures: &failures,
    };
    PlanarPose::new(PoseResolution::default())
        .sizes(arm)
        .fault_tolerant
}

fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} instead of {expected} ± {tolerance}"
    );
}

/// Area common to two discs whose centres are `d` apart.
fn lens(a: f64, b: f64, d: f64) -> f64 {
    if d >= a + b {
        return 0.0;
    }
    if d <= (a - b).abs() {
        return PI * a.min(b).powi(2);
    }
    let (x, y) = (
        (d * d + a * a - b * b) / (2.0 * d),
        (d * d + b * b - a * a) / (2.0 * d),
    );
    let segment = |radius: f64, height: f64| {
        radius * radius * (height / radius).acos()
            - height * (radius * radius - height * height).sqrt()
    };
    segment(a, x) + segment(b, y)
}

/// [S4] §V: 3.56 m², 12.6 % of 9π, for three unit links.
#[test]
fn equal_links_at_the_published_optimum() {
    let limits = [[-18.21, 18.21], [-111.322, 111.322], [-111.322, 111.322]];
    let sizes = position(&[1.0, 1.0, 1.0], &limits);
    assert_near(sizes.fault_tolerant.value, 3.562127, 2e-6);
    assert_near(sizes.unrestricted.value, 9.0 * PI, 1e-10);
    assert_near(sizes.normalised(), 0.126, 5e-4);
    // Rounded to whole degrees.
    let rounded = position(
        &[1.0, 1.0, 1.0],
        &[[-18.0, 18.0], [-111.0, 111.0], [-111.0, 111.0]],
    );
    assert_near(rounded.fault_tolerant.value, 3.56, 5e-3);
}

/// Joint 3 held where links 2 and 3 span 1.5 m. Locking joint 3 then leaves 1 ≤ r ≤ 2, and so does
/// locking joint 1 or 2 anywhere: W_F is that annulus.
#[test]
fn short_base_with_joint_3_held_is_an_annulus() {
    let held = (-1.0f64 / 3.0).acos().to_degrees();
    let links = [0.5, 1.0, 1.5];
    let sizes = position(&links, &[FULL, FULL, [held, held]]);
    assert_near(sizes.fault_tolerant.value, 3.0 * PI, 1e-9);
    for joint in sizes.post_failure {
        assert_near(joint.value, 3.0 * PI, 1e-9);
    }
    // Giving joint 3 room costs area; values of independent code.
    for (widened, expected) in [(1.0, 9.11), (5.0, 7.87), (10.0, 6.31)] {
        let found = position(&links, &[FULL, FULL, [held - widened, held + widened]]);
        assert_near(found.fault_tolerant.value, expected, 5e-3);
    }
}

/// With joint 3 at an angle q, links 2 and 3 span L(q) and r lies within L ± 0.5. So A₃ costs
/// both ends: a closed form for the widened limits above.
#[test]
fn short_base_with_joint_3_widened_is_a_thinner_annulus() {
    let held = (-1.0f64 / 3.0).acos();
    for widened in [1.0f64, 5.0, 10.0] {
        let w = widened.to_radians();
        let span = |q: f64| (3.25 + 3.0 * q.cos()).sqrt();
        let (longest, shortest) = (span(held - w), span(held + w));
        let (inner, outer) = (longest - 0.5, shortest + 0.5);
        let expected = PI * (outer * outer - inner * inner);
        let limit = [(held - w).to_degrees(), (held + w).to_degrees()];
        let found = position(&[0.5, 1.0, 1.5], &[FULL, FULL, limit]);
        assert_near(found.fault_tolerant.value, expected, 1e-9);
    }
}

/// [S3] Figs. 6–8 show 4.65 m² for two of these; by the definition no radius survives every
/// failure of joint 3.
#[test]
fn published_limits_of_the_short_base_leave_nothing() {
    let figures = [
        [[-68.8, 68.8], [-126.1, 126.1], [-114.6, 114.6]],
        [[-11.4, 11.4], [-126.1, 126.1], [-137.5, 137.5]],
        [[-21.0, 21.0], [-96.5, 101.1], [-111.2, 108.9]],
    ];
    for limits in figures {
        let sizes = position(&[0.5, 1.0, 1.5], &limits);
        assert_eq!(sizes.fault_tolerant.value, 0.0, "{limits:?}");
        assert!(sizes.pre_failure.value > 1.0);
        assert!(sizes.post_failure[2].value == 0.0);
    }
}

/// [S3] Fig. 5: joint 1 held, joints 2 and 3 free. W_F is an annulus around the base cut with an
/// annulus around joint 2: four lenses.
#[test]
fn short_middle_with_joint_1_held_is_two_annuli() {
    let sizes = position(&[1.25, 0.5, 1.25], &[[0.0, 0.0], FULL, FULL]);
    let expected = lens(2.0, 1.75, 1.25) - lens(2.0, 0.75, 1.25) - lens(0.5, 1.75, 1.25)
        + lens(0.5, 0.75, 1.25);
    assert_near(expected, 3.842744, 1e-6);
    assert_near(sizes.fault_tolerant.value, expected, 1e-9);
}

/// Everything free: an arm of three unit links survives nowhere, for joint 2 may lock folded (r = 1
/// is all that is left).
#[test]
fn free_joints_of_equal_links_leave_nothing() {
    let sizes = position(&[1.0, 1.0, 1.0], &[FULL; 3]);
    assert_near(sizes.fault_tolerant.value, 0.0, 1e-9);
    assert_near(sizes.pre_failure.value, 9.0 * PI, 1e-9);
    assert_near(sizes.post_failure[0].value, PI, 1e-9);
}

/// A long link 1 leaves a hole: S_0max is the area of an annulus.
#[test]
fn unrestricted_sizes() {
    assert_near(
        PlanarPosition::unrestricted_size(&[3.0, 1.0, 1.0]),
        PI * (25.0 - 1.0),
        1e-10,
    );
    // [S4] Figs. 3 and 4: 178 and 317 m² rad.
    assert_near(
        PlanarPose::unrestricted_size(&[1.0; 4]),
        18.0 * PI * PI,
        1e-10,
    );
    assert_near(
        PlanarPose::unrestricted_size(&[1.0; 5]),
        32.0 * PI * PI,
        1e-10,
    );
    // The last link of a pose task turns the tool, it does not move the wrist.
    assert_near(
        PlanarPose::unrestricted_size(&[1.0, 1.0, 1.0, 7.0]),
        18.0 * PI * PI,
        1e-10,
    );
}

/// [S4] Fig. 3 gives 16.5 m² rad. Joints 2 and 3 fold links to spans between √2 and less; joints 1
/// and 4 are free, so r ≤ 1 (joint 1, joint 4) and √2 − 1 ≤ r: 2π · π(1 − (√2 − 1)²).
#[test]
fn four_joint_pose_at_the_published_limits() {
    let expected = 4.0 * PI * PI * (SQRT_2 - 1.0);
    assert_near(TAU * PI * (1.0 - (SQRT_2 - 1.0).powi(2)), expected, 1e-12);
    let limits = [FULL, [90.0, 143.0], [90.0, 143.0], FULL];
    let found = pose(&[1.0; 4], &limits);
    assert_near(found.value, expected, 1e-4 * expected);
    assert!((found.value - expected).abs() <= found.error.max(1e-9));
}
