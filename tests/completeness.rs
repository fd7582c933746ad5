//! Are all self-motion manifolds of a task point found, and is every one that is found real?
//!
//! Each search is compared with one of twenty times the effort and other random starts, at task
//! points of random configurations. Run the long version with
//! `cargo test --release --test completeness -- --ignored --nocapture`.

mod arms;

use arms::Arm;
use faultspace::kinematics::Chain;
use faultspace::manifold::{
    Completeness, CurveStatus, PreImage, PreImageSearch, SearchSettings, SelfMotionManifold,
};
use faultspace::sampling::stream;
use nalgebra::Isometry3;
use rayon::prelude::*;
use std::time::Instant;

/// What is counted over the poses of one arm.
#[derive(Clone, Debug, Default)]
struct Tally {
    poses: usize,
    curves: usize,
    length: f64,
    /// Poses of which the search missed a manifold that the long one found.
    incomplete: usize,
    /// Manifolds that the long search does not know.
    unconfirmed: usize,
    /// Pairs of manifolds of one pose that are the same curve.
    twice: usize,
    /// Poses whose winding vectors do not sum to zero.
    winding: usize,
    /// Manifolds that neither closed nor ended at a stroke.
    open: usize,
    /// Manifolds that run through a singular configuration.
    crossed: usize,
    /// Worst residual at vertices and on the cubics between, relative to the reach.
    residual: f64,
    between: f64,
    seeds: usize,
    seconds: f64,
    /// Per decade of the estimate: poses, incomplete poses, sum of estimates.
    estimate: [(usize, usize, f64); 10],
    unknown: usize,
}

impl Tally {
    fn add(mut self, other: Tally) -> Tally {
        self.poses += other.poses;
        self.curves += other.curves;
        self.length += other.length;
        self.incomplete += other.incomplete;
        self.unconfirmed += other.unconfirmed;
        self.twice += other.twice;
        self.winding += other.winding;
        self.open += other.open;
        self.crossed += other.crossed;
        self.residual = self.residual.max(other.residual);
        self.between = self.between.max(other.between);
        self.seeds += other.seeds;
        self.seconds += other.seconds;
        for (mine, theirs) in self.estimate.iter_mut().zip(other.estimate) {
            *mine = (mine.0 + theirs.0, mine.1 + theirs.1, mine.2 + theirs.2);
        }
        self.unknown += other.unknown;
        self
    }

    fn print(&self, name: &str, label: &str) {
        let per_pose = |x: f64| x / self.poses as f64;
        println!(
            "{name:28} {label:8} {:5} poses  {:4.2} curves {:5.1} rad  incomplete {:3}  unconfirmed {:3}  \
             twice {:2}  winding {:2}  open {:3}  crossed {:3}  residual {:.1e} between {:.1e}  \
             seeds {:5.1}  {:.3} ms",
            self.poses,
            per_pose(self.curves as f64),
            per_pose(self.length),
            self.incomplete,
            self.unconfirmed,
            self.twice,
            self.winding,
            self.open,
            self.crossed,
            self.residual,
            self.between,
            per_pose(self.seeds as f64),
            per_pose(1e3 * self.seconds),
        );
    }
}

fn longer(settings: SearchSettings, times: usize) -> SearchSettings {
    SearchSettings {
        least_seeds: settings.least_seeds * times,
        most_seeds: settings.least_seeds * times,
        unreachable_after: settings.least_seeds * times,
        ..settings
    }
}

/// Whether both follow the same curve the same way.
fn same(a: &SelfMotionManifold, b: &SelfMotionManifold) -> bool {
    let alike = (a.length - b.length).abs() <= 2e-3 * a.length.max(b.length) + 1e-4;
    alike && a.winding == b.winding && covers(b, a)
}

/// Whether samples of `part` lie on `whole`, with the same orientation.
fn covers(whole: &SelfMotionManifold, part: &SelfMotionManifold) -> bool {
    let step = (part.vertices() / 16).max(1);
    (0..part.vertices()).step_by(step).all(|index| {
        let Some((segment, u)) = whole.locate(part.point(index), 4e-3) else {
            return false;
        };
        let nearest = (segment + (u > 0.5) as usize).min(whole.vertices() - 1);
        let pairs = whole.tangent(nearest).iter().zip(part.tangent(index));
        let crossed = !whole.crossings.is_empty() || !part.crossings.is_empty();
        let along: f64 = pairs.map(|(x, y)| x * y).sum();
        crossed || along > 0.0
    })
}

/// Distance between tool poses: position relative to the reach, and orientation in radians.
fn miss(arm: &Arm, theta: &[f64], pose: &Isometry3<f64>) -> f64 {
    let tool = arm.chain.tool(theta);
    let reach = reach(&arm.chain);
    let gap = tool.translation.vector - pose.translation.vector;
    let turn = tool.rotation.angle_to(&pose.rotation);
    match arm.task.dimension() {
        6 => (gap.norm() / reach).max(turn),
        3 if arm.task.is_planar() => (gap.norm() / reach).max(turn),
        _ => gap.norm() / reach,
    }
}

fn reach(chain: &Chain) -> f64 {
    let norm = |arm: [f64; 3]| arm.iter().map(|x| x * x).sum::<f64>().sqrt();
    let slide = |slide: f64| 1.6 * slide;
    chain
        .joints
        .iter()
        .map(|j| norm(j.arm) + slide(j.slide))
        .sum()
}

fn compare(
    arm: &Arm,
    pose: &Isometry3<f64>,
    found: &PreImage,
    long: &PreImage,
    what: &str,
    tell: bool,
) -> Tally {
    let mut tally = Tally {
        poses: 1,
        curves: found.manifolds.len(),
        seeds: found.seeds,
        ..Tally::default()
    };
    let known = |m: &SelfMotionManifold, others: &[SelfMotionManifold]| {
        others.iter().any(|other| same(m, other))
    };
    for manifold in &found.manifolds {
        tally.length += manifold.length;
        let fine = matches!(manifold.status, CurveStatus::Closed | CurveStatus::Stroke);
        tally.open += !fine as usize;
        tally.crossed += !manifold.crossings.is_empty() as usize;
        tally.unconfirmed += !known(manifold, &long.manifolds) as usize;
        for index in 0..manifold.vertices() {
            let off = miss(arm, manifold.point(index), pose);
            tally.residual = tally.residual.max(off);
            if index + 1 < manifold.vertices() {
                let off = miss(arm, &manifold.at(index, 0.5), pose);
                tally.between = tally.between.max(off);
            }
        }
    }
    for (index, manifold) in found.manifolds.iter().enumerate() {
        tally.twice += known(manifold, &found.manifolds[..index]) as usize;
    }
    let missed = |m: &&SelfMotionManifold| !known(m, &found.manifolds);
    let missed: Vec<_> = long.manifolds.iter().filter(missed).collect();
    tally.incomplete = !missed.is_empty() as usize;
    let all_closed =
        |m: &SelfMotionManifold| m.status == CurveStatus::Closed && m.crossings.is_empty();
    let revolute = arm.chain.joints.iter().all(|joint| joint.turn == 1.0);
    if revolute && found.manifolds.iter().all(all_closed) {
        tally.winding = found.winding_sum().iter().any(|&sum| sum != 0) as usize;
    }
    match found.completeness {
        Completeness::Evidence(p) => {
            let decade = (-p.max(1e-12).log10() * 2.0).clamp(0.0, 9.0) as usize;
            tally.estimate[decade] = (1, tally.incomplete, p);
        }
        Completeness::Proved => {}
        Completeness::Unknown => tally.unknown = 1,
    }
    let bad = tally.incomplete + tally.unconfirmed + tally.twice + tally.winding + tally.open;
    if tell && bad > 0 {
        tell_all(what, found, long);
    }
    tally
}

fn tell_all(what: &str, found: &PreImage, long: &PreImage) {
    println!("  {what}: {:?}", found.completeness);
    for (label, set, other) in [("found", found, long), ("long", long, found)] {
        for m in &set.manifolds {
            let partner = other.manifolds.iter().any(|o| same(m, o));
            println!(
                "    {label:5} {:?} length {:.5} winding {:?} vertices {} hits {} of {} crossings {:?}{}",
                m.status,
                m.length,
                m.winding,
                m.vertices(),
                m.hits,
                set.landed,
                m.crossings,
                if partner { "" } else { "  <- alone" },
            );
        }
    }
}

fn study(arm: &Arm, settings: SearchSettings, times: usize, poses: u64, tell: bool) -> Tally {
    let search = |settings| {
        PreImageSearch::from_chain(arm.chain.clone(), arm.task, settings).expect("redundancy 1")
    };
    let (short, long) = (
        search(settings),
        search(longer(SearchSettings::default(), times)),
    );
    (0..poses)
        .into_par_iter()
        .map_init(
            || (short.clone(), long.clone()),
            |(short, long), index| {
                let pose = arm.random_pose(&mut stream(100, index));
                let clock = Instant::now();
                let found = short.find(&pose, &mut stream(200, index));
                let seconds = clock.elapsed().as_secs_f64();
                let more = long.find(&pose, &mut stream(300, index));
                let what = format!("{} pose {index}", arm.name);
                Tally {
                    seconds,
                    ..compare(arm, &pose, &found, &more, &what, tell)
                }
            },
        )
        .reduce(Tally::default, Tally::add)
}

/// What may be claimed of a search.
struct Promise {
    label: &'static str,
    settings: SearchSettings,
    /// Share of poses that may lack a manifold.
    incomplete: f64,
    /// Residual at vertices and between them, relative to the reach.
    residual: f64,
    between: f64,
}

fn promises() -> [Promise; 3] {
    let mut polished = SearchSettings::default();
    polished.trace.polish = 2;
    [
        Promise {
            label: "default",
            settings: SearchSettings::default(),
            incomplete: 0.001,
            residual: 1e-6,
            between: 5e-5,
        },
        Promise {
            label: "polished",
            settings: polished,
            incomplete: 0.001,
            residual: 1e-9,
            between: 5e-5,
        },
        Promise {
            label: "coarse",
            settings: SearchSettings::coarse(),
            incomplete: 0.005,
            residual: 1e-5,
            between: 5e-4,
        },
    ]
}

impl Tally {
    fn assert_keeps(&self, promise: &Promise, what: &str) {
        let allowed = (promise.incomplete * self.poses as f64).max(1.0);
        assert!(self.incomplete as f64 <= allowed, "{what}: {self:?}");
        // Both searches would have to be wrong for a false manifold to be confirmed.
        assert_eq!(self.unconfirmed, 0, "{what}: false manifolds");
        assert_eq!(self.twice, 0, "{what}: manifolds found twice");
        assert_eq!(
            self.winding, 0,
            "{what}: winding vectors that do not cancel"
        );
        assert_eq!(self.open, 0, "{what}: curves that do not close");
        assert_eq!(self.unknown, 0, "{what}: checks that failed");
        assert!(
            self.residual <= promise.residual,
            "{what}: {:e}",
            self.residual
        );
        assert!(
            self.between <= promise.between,
            "{what}: {:e}",
            self.between
        );
    }
}

fn environment(name: &str, default: u64) -> u64 {
    let value = std::env::var(name).ok().and_then(|text| text.parse().ok());
    value.unwrap_or(default)
}

/// `ARM`, `POSES`, `TIMES` and `TELL` in the environment choose arms by a part of their name, the
/// number of poses, the effort of the long search, and a listing of all that is amiss.
#[test]
#[ignore = "takes minutes"]
fn every_manifold_of_every_arm() {
    let poses = environment("POSES", 1000);
    let times = environment("TIMES", 20) as usize;
    let only = std::env::var("ARM").unwrap_or_default();
    let tell = std::env::var("TELL").is_ok();
    for arm in arms::all().iter().filter(|arm| arm.name.contains(&only)) {
        for promise in promises() {
            let tally = study(arm, promise.settings, times, poses, tell);
            tally.print(arm.name, promise.label);
            tally.assert_keeps(&promise, &format!("{}, {}", arm.name, promise.label));
        }
    }
}

#[test]
fn a_few_poses_of_every_arm() {
    for arm in arms::all() {
        let poses = if arm.chain.len() == 7 { 12 } else { 24 };
        for promise in promises() {
            let tally = study(&arm, promise.settings, 4, poses, true);
            tally.assert_keeps(&promise, &format!("{}, {}", arm.name, promise.label));
        }
    }
}

/// A pre-image depends on the pose and its random stream alone, not on what was found before.
#[test]
fn searches_can_be_repeated() {
    let mut rng = stream(5, 0);
    for arm in arms::all() {
        let search = |settings| {
            PreImageSearch::from_chain(arm.chain.clone(), arm.task, settings).expect("redundancy 1")
        };
        let mut used = search(SearchSettings::coarse());
        for index in 0..5 {
            let pose = arm.random_pose(&mut rng);
            let fresh = search(SearchSettings::coarse()).find(&pose, &mut stream(6, index));
            assert_eq!(
                used.find(&pose, &mut stream(6, index)),
                fresh,
                "{}",
                arm.name
            );
        }
    }
}

/// Are estimates of completeness right to an order of magnitude, in the mean? Searches of far
/// too little effort make the misses that are counted.
#[test]
#[ignore = "takes minutes"]
fn estimates_of_completeness_hold() {
    let poses = environment("POSES", 1000);
    let effort = |least_seeds, seeds_per_manifold, least_hits| SearchSettings {
        least_seeds,
        seeds_per_manifold,
        least_hits,
        ..SearchSettings::coarse()
    };
    let efforts = [
        ("hasty", effort(12, 2, 2)),
        ("quick", effort(20, 4, 3)),
        ("coarse", SearchSettings::coarse()),
    ];
    for (label, settings) in efforts {
        let arms = arms::all();
        let tallies = arms
            .iter()
            .map(|arm| study(arm, settings, 10, poses, false));
        let sum = tallies.fold(Tally::default(), Tally::add);
        for &(poses, incomplete, estimates) in sum.estimate.iter().filter(|bin| bin.0 > 0) {
            let mean = estimates / poses as f64;
            let share = incomplete as f64 / poses as f64;
            println!(
                "{label}: estimate {mean:.2e}, {incomplete} of {poses} incomplete ({share:.1e})"
            );
            let expected = mean * poses as f64;
            assert!(
                incomplete as f64 <= 10.0 * expected + 3.0,
                "{label}: {mean:e}"
            );
            // Cautious it may be: for arms of few joints it is.
            assert!(
                incomplete as f64 + 3.0 >= expected / 30.0,
                "{label}: {mean:e}"
            );
        }
    }
}
