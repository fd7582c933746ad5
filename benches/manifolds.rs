//! Time of one pre-image, for task points drawn uniformly in the task space, and of its parts.
//!
//! Compare the lines of one run with each other: absolute times depend on the machine.

#[path = "../tests/arms/mod.rs"]
#[allow(dead_code, reason = "the tests use more of the arms")]
mod arms;

use criterion::{Criterion, criterion_group, criterion_main};
use faultspace::design::{Robot, TaskSpace};
use faultspace::kinematics::{Chain, Goal, Kernel, newton_step, reach_bound};
use faultspace::manifold::{PreImageSearch, SearchSettings};
use faultspace::sampling::stream;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use rand::Rng;
use std::hint::black_box;

/// Poses uniform in the ball of the arm's reach and over all orientations, of which the first
/// `count` reachable ones.
fn reachable(search: &mut PreImageSearch, radius: f64, count: usize) -> Vec<Isometry3<f64>> {
    let mut rng = stream(1, 0);
    let mut poses = Vec::new();
    while poses.len() < count {
        let mut draw = || rng.random_range(-1.0..1.0);
        let place = Vector3::from_fn(|_, _| draw());
        let turn = Quaternion::new(draw(), draw(), draw(), draw());
        if place.norm() > 1.0 || turn.norm() > 1.0 {
            continue;
        }
        let pose = Isometry3::from_parts(
            Translation3::from(place * radius),
            UnitQuaternion::from_quaternion(turn),
        );
        if !search.find(&pose, &mut stream(2, 0)).manifolds.is_empty() {
            poses.push(pose);
        }
    }
    poses
}

fn pre_images(c: &mut Criterion) {
    let arms: [(&str, Robot, TaskSpace); 3] = [
        ("7R pose", arms::bader_7r(), TaskSpace::SpatialPose),
        (
            "4R position",
            arms::spatial_4r(),
            TaskSpace::SpatialPosition,
        ),
        ("PA-10 pose", arms::pa10(), TaskSpace::SpatialPose),
    ];
    for (name, robot, task) in arms {
        for (label, settings) in [
            ("coarse", SearchSettings::coarse()),
            ("default", SearchSettings::default()),
        ] {
            let mut search = PreImageSearch::new(&robot, task, settings).expect("redundancy 1");
            let poses = reachable(&mut search, reach_bound(&robot), 256);
            let draw = |(k, pose): (usize, &Isometry3<f64>)| (*pose, stream(3, k as u64));
            let jobs: Vec<_> = poses.iter().enumerate().map(draw).collect();
            let name = format!("pre-image {name}, {label}, 256 poses");
            c.bench_function(&name, |b| {
                b.iter(|| {
                    let mut jobs = black_box(jobs.clone());
                    let find = |(pose, rng): &mut (_, _)| search.find(pose, rng).manifolds.len();
                    jobs.iter_mut().map(find).sum::<usize>()
                })
            });
            c.bench_function(&format!("{name}, batch"), |b| {
                b.iter(|| search.find_all(&mut black_box(jobs.clone())))
            });
        }
    }
}

/// One thousand starts at a pose of one manifold: 1000 times a start and its recognition.
fn starts(c: &mut Criterion) {
    let robot = arms::bader_7r();
    let settings = SearchSettings {
        least_seeds: 1000,
        most_seeds: 1000,
        ..SearchSettings::coarse()
    };
    let mut search =
        PreImageSearch::new(&robot, TaskSpace::SpatialPose, settings).expect("redundancy 1");
    let pose = search.chain().tool(&[0.4, 1.1, -0.3, 0.9, 0.2, -1.4, 0.6]);
    c.bench_function("1000 starts 7R", |b| {
        b.iter(|| search.find(black_box(&pose), &mut stream(4, 0)).landed)
    });
}

fn steps(c: &mut Criterion) {
    let chain = Chain::new(&arms::bader_7r()).expect("revolute");
    let kernel = Kernel::<7, 6>::new(&chain, TaskSpace::SpatialPose).expect("7 joints");
    let theta = [0.4, 1.1, -0.3, 0.9, 0.2, -1.4, 0.6];
    let goal = Goal::new(&chain, &chain.tool(&[0.5; 7]));
    c.bench_function("residual and Jacobian 7R", |b| {
        b.iter(|| kernel.linearise(black_box(&theta), black_box(&goal)))
    });
    let linear = kernel.linearise(&theta, &goal);
    c.bench_function("tangent and Newton step 7R", |b| {
        b.iter(|| newton_step(black_box(&linear)))
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).measurement_time(std::time::Duration::from_secs(2));
    targets = pre_images, starts, steps
}
criterion_main!(benches);
