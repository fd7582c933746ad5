//! Whether one pose is fault tolerant, from its whole pre-image [S4 §III.C].
//!
//! The same sets as in the estimates of sizes, for a single pre-image at full accuracy: with M the
//! pre-image inside the physical limits, Θ_i its joint ranges and T the θ₁-image of its part inside
//! A₂ × … × A_n, a pose turned by β about joint 1 is reached before a failure if β ∈ A₁ − T, after
//! a lock of joint 1 if A₁ − β ⊂ Θ₁, and after a lock of joint i ≥ 2 if A_i ⊂ Θ_i; a margin enlarges
//! the A_i of the latter two, where joints lock.

use super::{ArtificialLimits, FailureSet};
use crate::angle::{AngleSet, Arc};
use crate::manifold::{PreImage, SelfMotionManifold, runs_inside};

/// Parts of a segment between which a curve is looked at. A segment is at most 0.4 rad long, so
/// that what is overlooked inside a part is below 1e-5 rad.
const PARTS: usize = 64;

/// Which failures a pose survives.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseTolerance {
    /// Rotations β about joint 1 after which the pose is reached inside the limits.
    pub before_failure: AngleSet,
    /// Rotations β after which the pose is reached wherever joint 1 locks inside its limits.
    pub after_lock_of_1: AngleSet,
    /// Whether the pose is reached wherever each joint locks inside its limits, joint 1 first;
    /// that of joint 1 without a rotation.
    pub survives: Vec<bool>,
    /// Rotations β after which the pose belongs to the fault-tolerant workspace.
    pub rotation_set: AngleSet,
}

impl PoseTolerance {
    /// Judges the pose with the given pre-image. `physical` holds the physical limits of every
    /// joint as arcs of internal joint variables; those of joint 1 only bound where it may lock.
    pub fn of(
        pre_image: &PreImage,
        physical: &[Arc],
        limits: &ArtificialLimits,
        failures: &FailureSet,
    ) -> PoseTolerance {
        let arcs: Vec<Arc> = limits.joints().iter().map(|limit| limit.arc()).collect();
        let locks: Vec<Arc> = limits
            .joints()
            .iter()
            .zip(physical)
            .map(|(limit, physical)| limit.enlarged_within(failures.margin(), physical).arc())
            .collect();
        let ranges = ranges_within(&pre_image.manifolds, physical);
        let both: Vec<[Arc; 2]> = arcs.iter().zip(physical).map(|(a, p)| [*a, *p]).collect();
        let inside = images(&pre_image.manifolds, &both);
        let before_failure = inside[0].mirrored().sum(&arcs[0]);
        let after_lock_of_1 = ranges[0].erosion(&locks[0]).mirrored();
        let mut survives: Vec<bool> = ranges
            .iter()
            .zip(&locks)
            .map(|(range, arc)| range.contains_arc(arc))
            .collect();
        survives[0] = after_lock_of_1.contains(0.0);
        let rest = (1..survives.len()).all(|k| survives[k] || !failures.contains(k + 1));
        let rotation_set = match (rest, failures.contains(1)) {
            (false, _) => AngleSet::empty(),
            (true, true) => before_failure.intersection(&after_lock_of_1),
            (true, false) => before_failure.clone(),
        };
        PoseTolerance {
            before_failure,
            after_lock_of_1,
            survives,
            rotation_set,
        }
    }
}

/// Whether all joints from 2 on lie in all their arcs.
fn is_inside<const K: usize>(theta: &[f64], arcs: &[[Arc; K]]) -> bool {
    let joints = theta.iter().zip(arcs).skip(1);
    joints
        .flat_map(|(angle, arcs)| arcs.iter().map(move |arc| (angle, arc)))
        .all(|(angle, arc)| arc.contains(*angle))
}

/// Θ: the angles of every joint over the parts of `manifolds` inside the physical limits of the
/// joints from 2 on, given as arcs of internal joint variables, one per joint.
pub fn ranges_within(manifolds: &[SelfMotionManifold], physical: &[Arc]) -> Vec<AngleSet> {
    let bounds: Vec<[Arc; 1]> = physical.iter().map(|arc| [*arc]).collect();
    images(manifolds, &bounds)
}

/// The angles of every joint over the parts of `manifolds` at which the joints from 2 on lie in
/// all their arcs.
fn images<const K: usize>(manifolds: &[SelfMotionManifold], bounds: &[[Arc; K]]) -> Vec<AngleSet> {
    let mut arcs: Vec<Vec<Arc>> = vec![Vec::new(); bounds.len()];
    for manifold in manifolds {
        for run in runs_inside(manifold, PARTS, &|theta: &[f64]| is_inside(theta, bounds)) {
            for (arcs, [low, high]) in arcs.iter_mut().zip(run.spans) {
                arcs.push(Arc::from_interval(low, high));
            }
        }
    }
    arcs.into_iter().map(AngleSet::from_arcs).collect()
}

/// The configurations at which a self-motion manifold enters or leaves C′_A, the box of all limits
/// but joint 1's [S4 §III.B], in internal joint variables unwrapped along the curve.
pub fn limit_crossings(manifold: &SelfMotionManifold, limits: &ArtificialLimits) -> Vec<Vec<f64>> {
    let bounds: Vec<[Arc; 1]> = limits.joints().iter().map(|l| [l.arc()]).collect();
    let runs = runs_inside(manifold, PARTS, &|theta: &[f64]| is_inside(theta, &bounds));
    runs.into_iter().flat_map(|run| run.ends).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Geometry, Robot, TaskSpace};
    use crate::manifold::{PreImageSearch, SearchSettings};
    use crate::workspace::planar::{PlanarArm, PlanarPosition};
    use nalgebra::Isometry3;

    /// Three unit links with their end at distance 0.5: 2 cos(θ₂/2) runs between 0.5 and 1.5, θ₂
    /// from 82.8° to 151.0° and back on one curve, from −151.0° to −82.8° on the other.
    #[test]
    fn curves_cross_limits_at_their_ends() {
        let mut search = search(&[1.0; 3]);
        let found = search.find(
            &Isometry3::translation(0.5, 0.0, 0.0),
            &mut crate::sampling::stream(1, 0),
        );
        let limits =
            ArtificialLimits::from_degrees(&[[-1.0, 1.0], [-180.0, 110.0], [-180.0, 180.0]]);
        let crossings: Vec<Vec<f64>> = found
            .manifolds
            .iter()
            .flat_map(|manifold| limit_crossings(manifold, &limits))
            .collect();
        assert_eq!(crossings.len(), 2);
        for theta in &crossings {
            assert!(crate::angle::wrap(theta[1] - 110f64.to_radians()).abs() < 1e-9);
            let tool = search.chain().tool(theta).translation;
            assert!((tool.x - 0.5).hypot(tool.y) < 1e-5);
        }
        let free = ArtificialLimits::free(3);
        assert!(
            found
                .manifolds
                .iter()
                .all(|m| limit_crossings(m, &free).is_empty())
        );
    }

    fn search(lengths: &[f64]) -> PreImageSearch {
        let robot = Robot {
            name: "r".into(),
            source: None,
            geometry: Geometry::Planar {
                lengths: lengths.to_vec(),
            },
            physical_limits: None,
            tool: Isometry3::identity(),
        };
        PreImageSearch::new(&robot, TaskSpace::PlanarPosition, SearchSettings::default()).unwrap()
    }

    /// Rotation sets of planar positions are known in closed form.
    #[test]
    fn agrees_with_the_closed_form_in_the_plane() {
        let lengths = vec![1.0; 3];
        let mut search = search(&lengths);
        let limits = [[-18.21, 18.21], [-111.322, 111.322], [-111.322, 111.322]];
        let limits = ArtificialLimits::from_degrees(&limits);
        for (k, r) in [0.3, 0.9, 1.0, 1.2, 1.5, 2.9].into_iter().enumerate() {
            let margin = 0.02 * (k % 3) as f64;
            let failures = FailureSet::any(3).with_margin(margin);
            let mut generator = crate::sampling::stream(1, k as u64);
            let pre_image = search.find(&Isometry3::translation(r, 0.0, 0.0), &mut generator);
            let found = PoseTolerance::of(&pre_image, &[Arc::FULL; 3], &limits, &failures);
            let arm = PlanarArm {
                lengths: &lengths,
                limits: &limits,
                failures: &failures,
            };
            let exact = PlanarPosition::new().rotation_set(arm, r);
            let (a, b) = (found.rotation_set.measure(), exact.measure());
            assert!((a - b).abs() < 1e-4, "r = {r}: {a} for {b}");
        }
    }
}
