//! Planar workspaces against brute force: membership from the definitions, with inverse kinematics
//! of its own and grids over joint angles, for random robots, limits and failure sets.
//!
//! A point is in W₀ if some θ within all limits reaches it; in W_i if it is reached with joint i
//! locked at *every* angle of A_i, the other joints released; in W_F if it is in W₀ and in W_i for
//! every i ∈ F.

use faultspace::sampling::stream;
use faultspace::workspace::planar::{PlanarArm, PlanarPose, PlanarPosition, PoseResolution};
use faultspace::workspace::{ArtificialLimits, FailureSet};
use nalgebra::Complex;
use rand::Rng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};

type Point = Complex<f64>;

/// Round-off allowed in an angle computed by inverse kinematics.
const ROUND_OFF: f64 = 1e-9;

// --- Random cases ---------------------------------------------------------------------------

/// A robot, limits (radians, lower and upper) and joints prone to failure.
#[derive(Clone, Debug)]
struct Case {
    lengths: Vec<f64>,
    limits: Vec<[f64; 2]>,
    failures: Vec<usize>,
}

impl Case {
    fn random(joints: usize, generator: &mut ChaCha8Rng) -> Case {
        let lengths = (0..joints).map(|_| generator.random_range(0.4..1.6));
        let mut case = Case {
            lengths: lengths.collect(),
            limits: (0..joints).map(|_| random_limit(generator)).collect(),
            failures: (1..=joints)
                .filter(|_| generator.random_bool(0.5))
                .collect(),
        };
        // Equal links and W_F with every joint prone to failure are what people study most.
        if generator.random_bool(0.3) {
            case.lengths.fill(1.0);
        }
        if generator.random_bool(0.3) {
            case.failures = (1..=joints).collect();
        }
        case
    }

    /// Calls `look` with the library's view of the case.
    fn with_arm<T>(&self, look: impl FnOnce(PlanarArm<'_>) -> T) -> T {
        let degrees: Vec<[f64; 2]> = self
            .limits
            .iter()
            .map(|limit| limit.map(f64::to_degrees))
            .collect();
        let limits = ArtificialLimits::from_degrees(&degrees);
        let failures = FailureSet::of(self.lengths.len(), &self.failures);
        look(PlanarArm {
            lengths: &self.lengths,
            limits: &limits,
            failures: &failures,
        })
    }

    fn reach(&self) -> f64 {
        self.lengths.iter().sum()
    }
}

/// Symmetric, asymmetric, written beyond ±180°, held, narrow, nearly full and full limits.
fn random_limit(generator: &mut ChaCha8Rng) -> [f64; 2] {
    let width = match generator.random_range(0..20) {
        0 => 0.0,
        1 => generator.random_range(0.005..0.05),
        2..5 => TAU,
        5 => TAU - generator.random_range(0.01..0.2),
        6..12 => generator.random_range(0.05..1.5),
        _ => generator.random_range(0.5..5.5),
    };
    let centre = match generator.random_range(0..4) {
        0 => 0.0,
        1 => PI,
        _ => generator.random_range(-6.0..6.0),
    };
    [centre - 0.5 * width, centre + 0.5 * width]
}

// --- Membership by the definitions ----------------------------------------------------------

fn is_full(limit: [f64; 2]) -> bool {
    limit[1] - limit[0] >= TAU - ROUND_OFF
}

/// Whether `angle`, on whatever turn, lies within the limit.
fn allows(limit: [f64; 2], angle: f64) -> bool {
    let past_lower = (angle - limit[0] + ROUND_OFF).rem_euclid(TAU);
    is_full(limit) || past_lower <= limit[1] - limit[0] + 2.0 * ROUND_OFF
}

/// `count` angles of the limit, both ends among them, and the stretched and the folded one if allowed.
fn grid(limit: [f64; 2], count: usize) -> impl Iterator<Item = f64> {
    let width = limit[1] - limit[0];
    let straight = [0.0, PI].into_iter().filter(move |&q| allows(limit, q));
    let count = if width < ROUND_OFF { 1 } else { count };
    let step = width / (count.max(2) - 1) as f64;
    let even = (0..count).map(move |k| limit[0] + step * k as f64);
    straight.chain(even)
}

/// A moving joint of a chain in which other joints may be locked: the limits of its angle, and the
/// rigid body it turns, which carries the next moving joint at polar coordinates (`length`, `bend`)
/// of its own frame. Angles count from frame to frame.
#[derive(Clone, Copy)]
struct Moving {
    limit: [f64; 2],
    length: f64,
    bend: f64,
}

/// A chain of links whose joints all move.
fn chain(lengths: &[f64], limits: &[[f64; 2]]) -> Vec<Moving> {
    lengths
        .iter()
        .zip(limits)
        .map(|(&length, &limit)| Moving {
            limit,
            length,
            bend: 0.0,
        })
        .collect()
}

/// The chain with joint `k` ≥ 1 (from 0) locked at `q`.
fn locked(chain: &[Moving], k: usize, q: f64) -> Vec<Moving> {
    let (before, body) = (chain[k - 1], chain[k]);
    // In the frame of the body before: its end, and from there the locked body, turned by q.
    let end = Point::from_polar(before.length, before.bend);
    let merged = end + Point::from_polar(body.length, q + body.bend);
    let mut shorter = chain.to_vec();
    shorter[k - 1] = Moving {
        limit: before.limit,
        length: merged.norm(),
        bend: merged.arg(),
    };
    shorter.remove(k);
    // The next joint's angle counted from the locked body's frame, which is q ahead.
    if let Some(next) = shorter.get_mut(k) {
        next.limit = next.limit.map(|angle| angle + q);
    }
    shorter
}

/// Both solutions of a chain of two moving joints that reaches `target`: joint angles.
fn two_joint_solutions(chain: &[Moving], target: Point) -> Option<[[f64; 2]; 2]> {
    let [a, b] = [chain[0].length, chain[1].length];
    let r = target.norm();
    let cosine = (r * r - a * a - b * b) / (2.0 * a * b);
    if cosine.abs() > 1.0 {
        return None;
    }
    let bend = cosine.acos();
    Some([bend, -bend].map(|turn| {
        // Direction of the second body's end relative to the line to the first body's end.
        let line = target.arg() - (a + Point::from_polar(b, turn)).arg();
        let first = line - chain[0].bend;
        let second = line + turn - chain[1].bend - first;
        [first, second]
    }))
}

/// Whether the chain reaches `target` within its limits and `accepts` the sum of its joint
/// angles; one joint after the other is swept with `count` angles until two are left.
///
/// The solutions of a chain with one redundant joint are curves. Limits cut them into pieces, each
/// of which ends where some joint is at a limit. Since the grid of that joint holds its
/// limits, the piece is found however short; only closed curves within all limits can slip through,
/// and those are long where `target` is off the boundary.
fn reaches(
    chain: &[Moving],
    target: Point,
    count: usize,
    accepts: &dyn Fn(f64) -> bool,
    sweep_from: usize,
) -> bool {
    if chain.len() == 2 {
        let inside = |&[first, second]: &[f64; 2]| {
            allows(chain[0].limit, first)
                && allows(chain[1].limit, second)
                && accepts(first + second)
        };
        return two_joint_solutions(chain, target).is_some_and(|both| both.iter().any(inside));
    }
    (sweep_from..chain.len()).any(|k| {
        grid(chain[k].limit, count).any(|q| {
            if k == 0 {
                // Stand on joint 2, in the frame of body 1.
                let end = Point::from_polar(chain[0].length, chain[0].bend);
                let rest = target * Point::from_polar(1.0, -q) - end;
                let whole = |sum: f64| accepts(sum + q);
                reaches(&chain[1..], rest, count, &whole, 0)
            } else {
                // Joint k's angle is inside the limits of the joint after it already; the sum of
                // angles loses it only if joint k was the last.
                let last = if k + 1 == chain.len() { q } else { 0.0 };
                let whole = |sum: f64| accepts(sum + last);
                reaches(&locked(chain, k, q), target, count, &whole, k)
            }
        })
    })
}

/// Whether the chain reaches `wrist` so that a last joint within `last` turns the tool to `phi`.
/// With the last joint swept, too, the link before it has a known direction, which leaves a pose
/// task for one joint fewer.
fn reaches_pose(chain: &[Moving], last: [f64; 2], wrist: Point, phi: f64, count: usize) -> bool {
    let turns = |sum: f64| allows(last, phi - sum);
    if reaches(chain, wrist, count, &turns, 0) {
        return true;
    }
    let Some((link, before)) = chain.split_last().filter(|_| chain.len() > 2) else {
        return false;
    };
    grid(last, count).any(|q| {
        let rest = wrist - Point::from_polar(link.length, phi - q);
        reaches_pose(before, link.limit, rest, phi - q, count)
    })
}

/// Whether links of these lengths, free to turn, span the distance `d`: the polygon inequality.
fn spans(lengths: impl Iterator<Item = f64> + Clone, d: f64) -> bool {
    let sum: f64 = lengths.clone().sum();
    let longest = lengths.fold(0.0, f64::max);
    d <= sum && d >= 2.0 * longest - sum
}

/// Whether `target` is reached with joint `joint` (from 1) locked at `q`, the others free.
fn survives(lengths: &[f64], joint: usize, q: f64, target: Point) -> bool {
    if joint == 1 {
        let rest = target - Point::from_polar(lengths[0], q);
        return spans(lengths[1..].iter().copied(), rest.norm());
    }
    let rigid = lengths[joint - 2] + Point::from_polar(lengths[joint - 1], q);
    let others = lengths[..joint - 2].iter().chain(&lengths[joint..]);
    spans(others.copied().chain([rigid.norm()]), target.norm())
}

/// Whether a position is in W_F.
fn position_is_tolerant(case: &Case, target: Point, count: usize, lock_count: usize) -> bool {
    let failures = case.failures.iter();
    let lock = |&&joint: &&usize| {
        let limit = case.limits[joint - 1];
        grid(limit, lock_count).all(|q| survives(&case.lengths, joint, q, target))
    };
    let moving = chain(&case.lengths, &case.limits);
    failures.clone().all(|joint| lock(&joint)) && reaches(&moving, target, count, &|_| true, 0)
}

/// Whether a wrist and a direction of the last link (the tool) are in W_F.
fn pose_is_tolerant(case: &Case, wrist: Point, phi: f64, count: usize, lock_count: usize) -> bool {
    let n = case.lengths.len();
    let lengths = &case.lengths[..n - 1];
    let lock = |&joint: &usize| {
        grid(case.limits[joint - 1], lock_count).all(|q| {
            if joint < n {
                // The free joint n gives the tool its direction.
                return survives(lengths, joint, q, wrist);
            }
            // Joint n locked: the link before it points along φ − q.
            let rest = wrist - Point::from_polar(lengths[n - 2], phi - q);
            spans(lengths[..n - 2].iter().copied(), rest.norm())
        })
    };
    if !case.failures.iter().all(lock) {
        return false;
    }
    let moving = chain(lengths, &case.limits[..n - 1]);
    reaches_pose(&moving, case.limits[n - 1], wrist, phi, count)
}

// --- Position tasks -------------------------------------------------------------------------

/// Compares the rotation sets with brute force at random points whose neighbours, within
/// `margin` of the reach in r and `margin` radians in β, are all inside or all outside. Returns
/// how many points were compared inside and outside W_F and how many were left out.
fn compare_positions(
    case: &Case,
    generator: &mut ChaCha8Rng,
    points: usize,
    margin: f64,
    counts: [usize; 2],
) -> [usize; 3] {
    let mut seen = [0; 3];
    for _ in 0..points {
        let r = case.reach() * generator.random_range(0.02..1.0);
        let beta = generator.random_range(-PI..PI);
        let radii = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|k| r + k * margin * case.reach());
        let sets = case.with_arm(|arm| PlanarPosition::new().rotation_sets(arm, &radii));
        let inside = sets[2].contains(beta);
        let settled = sets.iter().all(|set| {
            let wide = faultspace::angle::Arc::new(beta - margin, 2.0 * margin);
            if inside {
                set.contains_arc(&wide)
            } else {
                set.intersection(&wide.into()).is_empty()
            }
        });
        if !settled {
            seen[2] += 1;
            continue;
        }
        seen[usize::from(!inside)] += 1;
        let target = Point::from_polar(r, beta);
        assert_eq!(
            position_is_tolerant(case, target, counts[0], counts[1]),
            inside,
            "r = {r}, beta = {beta}, {case:?}"
        );
    }
    seen
}

#[test]
fn three_joint_rotation_sets_agree_with_brute_force() {
    let mut seen = [0; 3];
    for k in 0..500 {
        let mut generator = stream(101, k);
        let case = Case::random(3, &mut generator);
        let found = compare_positions(&case, &mut generator, 30, 0.01, [400, 1000]);
        seen = std::array::from_fn(|i| seen[i] + found[i]);
    }
    assert!(seen[0] > 800 && seen[1] > 5000 && seen[2] < 500, "{seen:?}");
}

#[test]
fn four_joint_rotation_sets_agree_with_brute_force() {
    let mut seen = [0; 3];
    for k in 0..100 {
        let mut generator = stream(102, k);
        let case = Case::random(4, &mut generator);
        let found = compare_positions(&case, &mut generator, 20, 0.03, [60, 400]);
        seen = std::array::from_fn(|i| seen[i] + found[i]);
    }
    assert!(seen[0] > 300 && seen[1] > 500 && seen[2] < 600, "{seen:?}");
}

/// Whatever the limits, a configuration within them reaches a point of W₀. Round-off hides a cusp of
/// W₀ where it is less than 1e-12 rad wide, which for narrow limits is some 1e-5 m of radius.
#[test]
fn configurations_within_limits_land_in_the_pre_failure_workspace() {
    for joints in [3, 4, 5] {
        for k in 0..60 {
            let mut generator = stream(103 + joints as u64, k);
            let mut case = Case::random(joints, &mut generator);
            case.failures.clear();
            // With all but one joint held, W₀ has no area and no rotation set.
            for limit in &mut case.limits {
                limit[1] = limit[1].max(limit[0] + 1e-3);
            }
            let mut estimator = PlanarPosition::new();
            for _ in 0..40 {
                let mut direction = 0.0;
                let mut end = Point::new(0.0, 0.0);
                for (length, [lower, upper]) in case.lengths.iter().zip(&case.limits) {
                    // A few at a limit: the corners of the box.
                    direction += match generator.random_range(0..6) {
                        0 => lower + 1e-6,
                        1 => upper - 1e-6,
                        _ => generator.random_range(*lower..*upper),
                    };
                    end += Point::from_polar(*length, direction);
                }
                let near = [1.0, 1.0 - 2e-5, 1.0 + 2e-5].map(|k| k * end.norm());
                let sets = case.with_arm(|arm| estimator.rotation_sets(arm, &near));
                let mut arcs = sets.iter().flat_map(|set| set.arcs());
                let member = arcs.any(|arc| arc.contains_within(end.arg(), 1e-4));
                assert!(member, "{end} is not in {sets:?}, {case:?}");
            }
        }
    }
}

/// S_F is ∫ r·|B(r)| dr: the closed form of the areas against the rotation sets compared above.
#[test]
fn areas_are_integrals_of_rotation_sets() {
    for joints in [3, 4, 5] {
        for k in 0..30 {
            let mut generator = stream(110 + joints as u64, k);
            let case = Case::random(joints, &mut generator);
            let count = 4000;
            let step = case.reach() / f64::from(count);
            let radii: Vec<f64> = (0..count).map(|k| step * (f64::from(k) + 0.5)).collect();
            let (sets, sizes) = case.with_arm(|arm| {
                let mut estimator = PlanarPosition::new();
                (
                    estimator.rotation_sets(arm, &radii),
                    estimator.sizes(arm).fault_tolerant,
                )
            });
            let rings = radii.iter().zip(&sets);
            let area: f64 = rings.map(|(r, set)| r * set.measure() * step).sum();
            // Each jump of |B| costs at most half a ring.
            let tolerance = 6.0 * TAU * case.reach() * step * 0.5;
            assert!(
                (area - sizes.value).abs() < tolerance.min(0.02 + 1e-3 * sizes.value),
                "{area} instead of {sizes:?}, {case:?}"
            );
        }
    }
}

// --- Pose tasks -----------------------------------------------------------------------------

/// Compares `wrist_measure` with the share of random (β, γ) that brute force finds in W_F.
/// `grid_error` is the share of 4π² that the grids of brute force may miss.
fn compare_poses(
    case: &Case,
    generator: &mut ChaCha8Rng,
    points: usize,
    counts: [usize; 2],
    grid_error: f64,
) -> f64 {
    let reach: f64 = case.lengths[..case.lengths.len() - 1].iter().sum();
    let r = reach * generator.random_range(0.1..0.9);
    let found = case
        .with_arm(|arm| PlanarPose::new(PoseResolution::for_tolerance(2e-4)).wrist_measure(arm, r));
    let hits = (0..points).filter(|_| {
        let (beta, gamma) = (
            generator.random_range(-PI..PI),
            generator.random_range(-PI..PI),
        );
        let wrist = Point::from_polar(r, beta);
        pose_is_tolerant(case, wrist, beta + gamma, counts[0], counts[1])
    });
    let share = hits.count() as f64 / points as f64;
    let expected = found / (TAU * TAU);
    let spread = (expected * (1.0 - expected) / points as f64)
        .max(0.0)
        .sqrt();
    // One point more or less is no news even where the share is zero.
    let tolerance = 4.0 * spread + grid_error + 1.0 / points as f64;
    assert!(
        (share - expected).abs() <= tolerance,
        "{share} instead of {expected} ± {tolerance} at r = {r}, {case:?}"
    );
    expected
}

/// Limits that matter for poses: joint 1 or n free (closed forms), held and narrow joints.
fn pose_case(joints: usize, k: u64, generator: &mut ChaCha8Rng) -> Case {
    let mut case = Case::random(joints, generator);
    let free = [-PI, PI];
    let narrow = [0.7, 0.7 + 0.5f64.to_radians()];
    match k % 8 {
        0 => case.limits[0] = free,
        1 => case.limits[joints - 1] = free,
        2 => case.limits[generator.random_range(0..joints)] = [1.1, 1.1],
        3 => case.limits[generator.random_range(0..joints)] = narrow,
        4 => case.limits[1..joints - 1].fill(free),
        _ => {}
    }
    // Most random sets of failures leave nothing: prefer small ones.
    case.failures.shuffle(generator);
    case.failures.truncate(generator.random_range(0..=2));
    case
}

#[test]
fn four_joint_poses_agree_with_brute_force() {
    let mut sizeable = 0;
    for k in 0..80 {
        let mut generator = stream(120, k);
        let case = pose_case(4, k, &mut generator);
        let share = compare_poses(&case, &mut generator, 3000, [60, 300], 2e-3);
        sizeable += usize::from(share > 0.02);
    }
    assert!(sizeable > 20, "only {sizeable} cases with a workspace");
}

#[test]
fn five_joint_poses_agree_with_brute_force() {
    let mut sizeable = 0;
    for k in 0..24 {
        let mut generator = stream(121, k);
        let case = pose_case(5, k, &mut generator);
        let share = compare_poses(&case, &mut generator, 800, [18, 200], 1e-2);
        sizeable += usize::from(share > 0.02);
    }
    assert!(sizeable > 6, "only {sizeable} cases with a workspace");
}

/// Joint 3 may lock stretched or folded, and no wrist radius survives both; W₀ itself, with joint 2
/// held and joint 1 free, has every direction there.
#[test]
fn a_radius_that_a_failure_forbids_has_no_measure() {
    let free = [-PI, PI];
    let case = Case {
        lengths: vec![1.05, 1.3, 1.6, 0.7],
        limits: vec![free, [1.1, 1.1], free, [1.0, 5.0]],
        failures: vec![3],
    };
    let found =
        case.with_arm(|arm| PlanarPose::new(PoseResolution::default()).wrist_measure(arm, 1.2));
    assert!(!pose_is_tolerant(&case, Point::new(1.2, 0.0), 0.3, 60, 300));
    assert_eq!(found, 0.0);
}

// --- Laws of sizes --------------------------------------------------------------------------

/// S_F, |W₀|, |W_i| and S_0max with their errors.
struct Sizes {
    tolerant: f64,
    pre_failure: f64,
    post_failure: Vec<f64>,
    unrestricted: f64,
    error: f64,
}

fn sizes(case: &Case, pose: bool) -> Sizes {
    let found = case.with_arm(|arm| {
        if pose {
            PlanarPose::new(PoseResolution::coarse()).sizes(arm)
        } else {
            PlanarPosition::new().sizes(arm)
        }
    });
    let mut errors = vec![found.fault_tolerant.error, found.pre_failure.error];
    errors.extend(found.post_failure.iter().map(|size| size.error));
    let worst = errors.into_iter().fold(0.0, f64::max);
    Sizes {
        tolerant: found.fault_tolerant.value,
        pre_failure: found.pre_failure.value,
        post_failure: found.post_failure.iter().map(|size| size.value).collect(),
        unrestricted: found.unrestricted.value,
        error: worst + 1e-9 * found.unrestricted.value,
    }
}

/// The laws that hold for any arm, checked on one case.
fn check_laws(case: &Case, pose: bool, generator: &mut ChaCha8Rng) {
    let own = sizes(case, pose);
    let at_most = |small: f64, large: f64, error: f64, law: &str| {
        assert!(
            small <= large + own.error + error,
            "{law}: {small} > {large}, {case:?}"
        );
    };
    // Inclusions: S_F ≤ |W₀| ≤ S_0max, S_F ≤ |W_i| for i ∈ F.
    at_most(own.tolerant, own.pre_failure, 0.0, "S_F <= W_0");
    at_most(own.pre_failure, own.unrestricted, 0.0, "W_0 <= S_0max");
    for &joint in &case.failures {
        at_most(own.tolerant, own.post_failure[joint - 1], 0.0, "S_F <= W_i");
    }
    for size in &own.post_failure {
        at_most(*size, own.unrestricted, 0.0, "W_i <= S_0max");
    }

    // Wider limits: more to reach before a failure, less that survives one.
    let mut wider = case.clone();
    for limit in &mut wider.limits {
        limit[0] -= generator.random_range(0.0..0.3);
        limit[1] += generator.random_range(0.0..0.3);
        limit[1] = limit[1].min(limit[0] + TAU);
    }
    let wide = sizes(&wider, pose);
    at_most(own.pre_failure, wide.pre_failure, wide.error, "wider W_0");
    for (own, wide_size) in own.post_failure.iter().zip(&wide.post_failure) {
        at_most(*wide_size, *own, wide.error, "wider W_i");
    }

    // More joints that may fail: less that is left.
    let mut frailer = case.clone();
    frailer.failures = (1..=case.lengths.len()).collect();
    let frail = sizes(&frailer, pose);
    at_most(frail.tolerant, own.tolerant, frail.error, "larger F");
    let mut safe = case.clone();
    safe.failures.clear();
    let safe = sizes(&safe, pose);
    at_most(own.tolerant, safe.tolerant, safe.error, "smaller F");
    assert!((safe.tolerant - safe.pre_failure).abs() <= 2.0 * safe.error);

    // The same workspace, turned, mirrored, written on another turn, or in another unit.
    let same = |other: &Case, scale: f64, law: &str| {
        let found = sizes(other, pose);
        let error = found.error / scale + own.error;
        let pairs = [
            (found.tolerant, own.tolerant),
            (found.pre_failure, own.pre_failure),
            (found.post_failure[0], own.post_failure[0]),
            (found.unrestricted, own.unrestricted),
        ];
        for (a, b) in pairs {
            assert!((a / scale - b).abs() <= error, "{law}: {a} {b}, {case:?}");
        }
    };
    let mut turned = case.clone();
    turned.limits[0] = turned.limits[0].map(|angle| angle + 1.234);
    same(&turned, 1.0, "joint 1 turned");
    if pose {
        let mut turned = case.clone();
        let last = turned.limits.last_mut().unwrap();
        *last = last.map(|angle| angle - 0.77);
        same(&turned, 1.0, "joint n turned");
    }
    let mut mirrored = case.clone();
    for limit in &mut mirrored.limits {
        *limit = [-limit[1], -limit[0]];
    }
    same(&mirrored, 1.0, "mirrored");
    let mut unwound = case.clone();
    let joint = generator.random_range(0..case.limits.len());
    unwound.limits[joint] = unwound.limits[joint].map(|angle| angle + TAU);
    same(&unwound, 1.0, "one turn more");
    let mut larger = case.clone();
    larger.lengths.iter_mut().for_each(|length| *length *= 2.5);
    same(&larger, 6.25, "scaled");
}

#[test]
fn position_sizes_obey_their_laws() {
    for joints in [2, 3, 4] {
        for k in 0..80 {
            let mut generator = stream(130 + joints as u64, k);
            let case = Case::random(joints, &mut generator);
            check_laws(&case, false, &mut generator);
        }
    }
}

#[test]
fn pose_sizes_obey_their_laws() {
    for (joints, cases) in [(4, 16), (5, 4)] {
        for k in 0..cases {
            let mut generator = stream(140 + joints as u64, k);
            let case = pose_case(joints, k, &mut generator);
            check_laws(&case, true, &mut generator);
        }
    }
}
