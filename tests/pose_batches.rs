//! Pre-images of many poses at once: what each pose gives on its own, whatever its neighbours.

#[allow(dead_code, reason = "other tests use more of the arms")]
mod arms;

use faultspace::design::{Robot, TaskSpace};
use faultspace::kinematics::{Chain, newton_step, newton_steps};
use faultspace::kinematics::{Goal, Kernel, Lanes, Real};
use faultspace::manifold::{PreImage, PreImageSearch, SearchSettings};
use faultspace::sampling::stream;
use nalgebra::{Isometry3, Translation3, Vector3};
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// Poses of random configurations, with every seventh out of reach, and one that is no number.
fn poses(chain: &Chain, count: usize) -> Vec<(Isometry3<f64>, ChaCha8Rng)> {
    let mut rng = stream(11, 0);
    let pose = |k: usize| {
        let theta: Vec<f64> = (0..chain.len())
            .map(|_| rng.random_range(-1.5..1.5))
            .collect();
        let mut pose = chain.tool(&theta);
        match k {
            5 => pose.translation.vector = Vector3::repeat(f64::NAN),
            _ if k % 7 == 3 => pose = Translation3::new(1e3, 0.0, 0.0) * pose,
            // Perhaps within the links' lengths, but hardly within reach.
            _ if k % 7 == 4 => pose.translation.vector *= 1.9,
            _ => {}
        }
        (pose, stream(12, k as u64))
    };
    (0..count).map(pose).collect()
}

/// Everything of a pre-image, floats to the last bit.
fn bits(image: &PreImage) -> String {
    let bits = |numbers: &[f64]| -> Vec<u64> { numbers.iter().map(|x| x.to_bits()).collect() };
    let mut text = format!(
        "{:?} {} {}\n",
        image.completeness, image.seeds, image.landed
    );
    for m in &image.manifolds {
        text += &format!(
            "{:?} {:?} {:?} {:?} {} {:?} {:?}\n",
            m.status,
            m.winding,
            m.crossings,
            m.length.to_bits(),
            m.hits,
            bits(&m.points),
            bits(&m.tangents)
        );
    }
    text
}

fn check(mut search: PreImageSearch, count: usize) {
    let jobs = poses(search.chain(), count);
    let alone: Vec<(String, u64)> = jobs
        .iter()
        .map(|(pose, rng)| {
            let mut rng = rng.clone();
            (bits(&search.find(pose, &mut rng)), rng.random())
        })
        .collect();
    assert!(
        alone
            .iter()
            .any(|(text, _)| text.contains("Closed") || text.contains("Stroke"))
    );
    for size in [1, 3, 8, 13, count] {
        let mut together = Vec::new();
        for batch in jobs.chunks(size) {
            let mut batch = batch.to_vec();
            let images = search.find_all(&mut batch);
            assert_eq!(images.len(), batch.len());
            for (image, (_, mut rng)) in images.iter().zip(batch) {
                together.push((bits(image), rng.random()));
            }
        }
        for (k, (one, other)) in alone.iter().zip(&together).enumerate() {
            assert!(one == other, "pose {k} in batches of {size}");
        }
    }
}

fn check_robot(robot: &Robot, task: TaskSpace, settings: SearchSettings, count: usize) {
    let search = PreImageSearch::new(robot, task, settings).expect("redundancy 1");
    check(search, count);
}

#[test]
fn four_joints_in_space() {
    let task = TaskSpace::SpatialPosition;
    check_robot(&arms::spatial_4r(), task, SearchSettings::coarse(), 70);
    check_robot(&arms::spatial_4r(), task, SearchSettings::default(), 20);
}

#[test]
fn three_joints_in_the_plane() {
    let arm = arms::planar(&[1.0, 0.8, 0.5]);
    let task = TaskSpace::PlanarPosition;
    check_robot(&arm, task, SearchSettings::coarse(), 70);
}

#[test]
fn seven_joints() {
    let task = TaskSpace::SpatialPose;
    check_robot(&arms::bader_7r(), task, SearchSettings::coarse(), 70);
    check_robot(&arms::bader_7r(), task, SearchSettings::default(), 20);
}

#[test]
fn an_arm_with_spherical_wrist() {
    let task = TaskSpace::SpatialPose;
    check_robot(&arms::pa10(), task, SearchSettings::coarse(), 30);
}

#[test]
fn strokes_end_curves() {
    let arm = arms::sliding();
    let task = TaskSpace::SpatialPosition;
    check_robot(&arm, task, SearchSettings::coarse(), 70);
}

#[test]
fn the_panda() {
    let task = TaskSpace::SpatialPose;
    check_robot(&arms::panda(), task, SearchSettings::coarse(), 30);
}

#[test]
fn eight_joints_of_which_one_is_held() {
    let chain = Chain::new(&arms::bader_8r()).expect("revolute joints");
    let settings = SearchSettings::coarse();
    for joint in [0, 3, 7] {
        let held = chain.locked(joint, 0.4);
        let search = PreImageSearch::from_chain(held, TaskSpace::SpatialPose, settings);
        check(search.expect("redundancy 1"), 16);
    }
}

#[test]
fn an_empty_batch_is_empty() {
    let arm = arms::bader_7r();
    let settings = SearchSettings::coarse();
    let mut search = PreImageSearch::new(&arm, TaskSpace::SpatialPose, settings).expect("7R");
    assert!(search.find_all(&mut []).is_empty());
}

/// Newton steps in lanes are those of single numbers, singular configurations included.
#[test]
fn eight_newton_steps_are_eight_times_one() {
    let chain = Chain::new(&arms::bader_7r()).expect("revolute joints");
    let kernel = Kernel::<7, 6>::new(&chain, TaskSpace::SpatialPose).expect("7 joints");
    let goal = Goal::new(&chain, &chain.tool(&[0.5; 7]));
    let mut rng = stream(13, 0);
    for round in 0..200 {
        let mut theta = [Lanes::constant(0.0); 7];
        for coordinate in &mut theta {
            for lane in &mut coordinate.0 {
                *lane = if round == 0 {
                    0.0
                } else {
                    rng.random_range(-3.0..3.0)
                };
            }
        }
        let steps = newton_steps(&mut kernel.linearise(&theta, &goal.splat()));
        for lane in 0..8 {
            let one = newton_step(&kernel.linearise(&theta.map(|x| x.0[lane]), &goal));
            match (one, steps.lane(lane)) {
                (None, None) => {}
                (Some(one), Some(other)) => {
                    let bits = |x: [f64; 7]| x.map(f64::to_bits);
                    assert_eq!(bits(one.tangent), bits(other.tangent));
                    assert_eq!(bits(one.correction), bits(other.correction));
                    assert_eq!(one.manipulability.to_bits(), other.manipulability.to_bits());
                }
                other => panic!("{other:?}"),
            }
        }
    }
}
