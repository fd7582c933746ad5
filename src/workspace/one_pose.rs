//! Whether one pose is fault tolerant, from its whole pre-image [S4 §III.C].
//!
//! The same sets as in the estimates of sizes, for a single pre-image at full accuracy: with M the
//! pre-image inside the physical limits, Θ_i its joint ranges and T the θ₁-image of its part inside
//! A₂ × … × A_n, a pose turned by β about joint 1 is reached before a failure if β ∈ A₁ − T, after
//! a lock of joint 1 if A₁ − β ⊂ Θ₁, and after a lock of joint i ≥ 2 if A_i ⊂ Θ_i; a margin enlarges
//! the A_i of the latter two, where joints lock.
//!
//! Physical limits P₁ of joint 1 make the last condition depend on β: after the turn joint i may
//! lock at a exactly if T_i(a) + β meets P₁, with T_i(a) the θ₁ values at which θ_i = a.

use super::{ArtificialLimits, FailureSet};
use crate::angle::{AngleSet, Arc};
use crate::manifold::{
    PreImage, SelfMotionManifold, Surface, SurfaceEvidence, runs_in_box, runs_inside,
};
use rayon::prelude::*;

/// Parts of a segment between which a curve is looked at. A segment is at most 0.4 rad long, so
/// that what is overlooked inside a part is below 1e-5 rad.
const PARTS: usize = 64;

/// Where joint 1 has physical limits, locks at angles this far apart are examined, radians: on
/// curves; on surfaces, where each one takes slices of its own.
const LOCK_STEPS: [f64; 2] = [0.005, 0.02];

/// Parts of a segment between which a curve is looked at for one of these locks.
const LOCK_PARTS: usize = 8;

/// Which failures a pose survives.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseTolerance {
    /// Rotations β about joint 1 after which the pose is reached inside the limits.
    pub before_failure: AngleSet,
    /// Rotations β after which the pose is reached wherever joint 1 locks inside its limits.
    pub after_lock_of_1: AngleSet,
    /// Whether the pose is reached wherever each joint locks inside its limits, joint 1 first;
    /// without a rotation.
    pub survives: Vec<bool>,
    /// Rotations β after which the pose belongs to the fault-tolerant workspace.
    pub rotation_set: AngleSet,
}

/// The sets of one pre-image that its tolerance follows from.
struct Sets<'a> {
    /// Θ, inside the physical limits of the joints from 2 on.
    ranges: &'a [AngleSet],
    /// The same inside those of joint 1 as well.
    at_rest: &'a [AngleSet],
    /// T.
    image: &'a AngleSet,
    /// T_i(a) of joint i (from 0).
    image_where: &'a (dyn Fn(usize, f64) -> AngleSet + Sync),
    /// Distance of the a that are examined.
    lock_step: f64,
}

impl PoseTolerance {
    /// Judges the pose with the given pre-image. `physical` holds the physical limits of every
    /// joint as arcs of internal joint variables; artificial limits are cut to them.
    pub fn of(
        pre_image: &PreImage,
        physical: &[Arc],
        limits: &ArtificialLimits,
        failures: &FailureSet,
    ) -> PoseTolerance {
        let manifolds = &pre_image.manifolds;
        let turning = but_joint_1(physical);
        let image = ranges_within(manifolds, &box_of(&limits.within(physical)));
        let sets = Sets {
            ranges: &ranges_within(manifolds, &turning),
            at_rest: &ranges_within(manifolds, physical),
            image: &image[0],
            image_where: &|joint, value| image_where(manifolds, joint, value, &turning),
            lock_step: LOCK_STEPS[0],
        };
        judge(&sets, physical, limits, failures)
    }

    /// Judges the pose whose pre-image is `surface` and whose joints have the ranges `at_rest`
    /// inside the physical limits; tells also what random starts inside the artificial limits say
    /// about T.
    pub fn of_surface(
        surface: &mut Surface<'_>,
        at_rest: &[AngleSet],
        limits: &ArtificialLimits,
        failures: &FailureSet,
    ) -> (PoseTolerance, SurfaceEvidence) {
        let physical = surface.physical();
        let turning = but_joint_1(physical);
        let ranges = match physical[0].is_full() {
            true => at_rest.to_vec(),
            false => surface.ranges(&turning),
        };
        let inner = box_of(&limits.within(physical));
        let image = surface.range(0, &inner);
        let evidence = surface.evidence(&[0], std::slice::from_ref(&image), &inner);
        let surface = &*surface;
        let sets = Sets {
            ranges: &ranges,
            at_rest,
            image: &image,
            image_where: &|joint, value| surface.range_where(0, (joint, value), &turning),
            lock_step: LOCK_STEPS[1],
        };
        (judge(&sets, physical, limits, failures), evidence)
    }
}

fn judge(
    sets: &Sets<'_>,
    physical: &[Arc],
    limits: &ArtificialLimits,
    failures: &FailureSet,
) -> PoseTolerance {
    let limits = limits.within(physical);
    let first = limits.joints()[0].arc();
    let locks: Vec<Arc> = limits
        .joints()
        .iter()
        .zip(physical)
        .map(|(limit, physical)| limit.enlarged_within(failures.margin(), physical).arc())
        .collect();
    let before_failure = sets.image.mirrored().sum(&first);
    let after_lock_of_1 = sets.ranges[0].erosion(&locks[0]).mirrored();
    let survived_at = |joint: usize| match sets.ranges[joint].contains_arc(&locks[joint]) {
        false => AngleSet::empty(),
        true if physical[0].is_full() => AngleSet::full(),
        true => survived(sets, joint, &locks[joint], &physical[0]),
    };
    let mut survives = vec![after_lock_of_1.contains(0.0)];
    let mut rotation_set = match failures.contains(1) {
        true => before_failure.intersection(&after_lock_of_1),
        false => before_failure.clone(),
    };
    for (joint, lock) in locks.iter().enumerate().skip(1) {
        let set = survived_at(joint);
        survives.push(sets.at_rest[joint].contains_arc(lock) && set.contains(0.0));
        if failures.contains(joint + 1) {
            rotation_set = rotation_set.intersection(&set);
        }
    }
    PoseTolerance {
        before_failure,
        after_lock_of_1,
        survives,
        rotation_set,
    }
}

/// Rotations after which joint `joint` may lock anywhere in `lock` with joint 1 inside `allowed`.
fn survived(sets: &Sets<'_>, joint: usize, lock: &Arc, allowed: &Arc) -> AngleSet {
    let steps = (lock.width() / sets.lock_step).ceil().max(1.0) as usize;
    let survived_at = |k: usize| {
        let image =
            (sets.image_where)(joint, lock.start() + lock.width() * k as f64 / steps as f64);
        // A ⊂ Θ says that the angle is taken: at an end of Θ, the curve may turn within round-off
        // of it.
        match image.is_empty() {
            true => AngleSet::full(),
            false => image.mirrored().sum(allowed),
        }
    };
    let each: Vec<AngleSet> = (0..steps + 1).into_par_iter().map(survived_at).collect();
    each.iter()
        .fold(AngleSet::full(), |all, set| all.intersection(set))
}

/// All arcs, but joint 1's the full circle.
fn but_joint_1(arcs: &[Arc]) -> Vec<Arc> {
    let mut arcs = arcs.to_vec();
    arcs[0] = Arc::FULL;
    arcs
}

/// C′_A: the limits with joint 1 released.
fn box_of(limits: &ArtificialLimits) -> Vec<Arc> {
    let arcs: Vec<Arc> = limits.joints().iter().map(|limit| limit.arc()).collect();
    but_joint_1(&arcs)
}

fn is_inside(theta: &[f64], arcs: &[Arc]) -> bool {
    theta
        .iter()
        .zip(arcs)
        .all(|(angle, arc)| arc.contains(*angle))
}

/// Θ: the angles of every joint over the parts of `manifolds` inside `arcs` of internal joint
/// variables, one per joint.
pub fn ranges_within(manifolds: &[SelfMotionManifold], arcs: &[Arc]) -> Vec<AngleSet> {
    let mut swept: Vec<Vec<Arc>> = vec![Vec::new(); arcs.len()];
    for manifold in manifolds {
        for run in runs_in_box(manifold, PARTS, arcs) {
            let is_whole = run.ends.is_empty();
            for (joint, [low, high]) in run.spans.into_iter().enumerate() {
                swept[joint].push(match is_whole && manifold.winding[joint] != 0 {
                    true => Arc::FULL,
                    false => Arc::from_interval(low, high),
                });
            }
        }
    }
    swept.into_iter().map(AngleSet::from_arcs).collect()
}

/// T_joint(value): the θ₁ at which curves pass `value` inside `bounds`.
fn image_where(
    manifolds: &[SelfMotionManifold],
    joint: usize,
    value: f64,
    bounds: &[Arc],
) -> AngleSet {
    let half = Arc::new(value, std::f64::consts::PI);
    let mut found = Vec::new();
    for manifold in manifolds {
        let ahead = |theta: &[f64]| half.contains(theta[joint]);
        for end in runs_inside(manifold, LOCK_PARTS, &ahead)
            .into_iter()
            .flat_map(|run| run.ends)
        {
            // Half a turn away the curve leaves the half circle too.
            let is_here = Arc::point(value).contains_within(end[joint], 1e-6);
            if is_here && is_inside(&end, bounds) {
                found.push(Arc::point(end[0]));
            }
        }
    }
    AngleSet::from_arcs(found)
}

/// The configurations at which a self-motion manifold enters or leaves C′_A, the box of all limits
/// but joint 1's [S4 §III.B], in internal joint variables unwrapped along the curve.
pub fn limit_crossings(manifold: &SelfMotionManifold, limits: &ArtificialLimits) -> Vec<Vec<f64>> {
    let runs = runs_in_box(manifold, PARTS, &box_of(limits));
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
