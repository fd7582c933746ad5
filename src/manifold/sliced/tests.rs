use crate::design::{Geometry, Robot, TaskSpace};
use crate::manifold::{CurveSource, Pose, SearchSettings};
use crate::sampling::stream;
use nalgebra::Isometry3;
use rand::Rng;

fn source(lengths: &[f64]) -> CurveSource {
    let robot = Robot {
        name: "arm".into(),
        source: None,
        geometry: Geometry::Planar {
            lengths: lengths.to_vec(),
        },
        physical_limits: None,
        tool: Isometry3::identity(),
    };
    let settings = SearchSettings::coarse();
    CurveSource::new(&robot, TaskSpace::PlanarPosition, 8, settings).unwrap()
}

/// Every fifth pose is out of reach.
fn poses(count: u64) -> Vec<Pose> {
    let mut rng = stream(14, 0);
    let mut pose = |k: u64| {
        let r = if k % 5 == 2 {
            9.0
        } else {
            rng.random_range(0.1..3.9)
        };
        (Isometry3::translation(r, 0.0, 0.0), stream(15, k))
    };
    (0..count).map(&mut pose).collect()
}

/// Searched together or alone, on the surface and on the faces of a box: the same to the last bit.
#[test]
fn slices_do_not_depend_on_the_batch() {
    let limits = [None, Some([-1.0, 1.5]), None, Some([0.2, 0.9])];
    let answers = |batch: usize| {
        let mut source = source(&[1.0, 1.2, 1.1, 0.8]);
        let mut faces = source.faces(&limits).unwrap();
        let mut text = Vec::new();
        for poses in poses(12).chunks_mut(batch) {
            source.search_all(poses);
            for (nth, pose) in poses.iter_mut().enumerate() {
                let mut own = String::new();
                let ranges = source.show(nth, pose, |curve| {
                    let last = curve.point(curve.vertices() - 1);
                    own += &format!("{} {last:?}\n", curve.vertices());
                });
                own += &format!("{ranges:?} {} {}\n", source.seeds(), source.is_sound());
                text.push(own);
            }
            source.search_faces(poses.iter_mut(), &mut faces);
            for (nth, own) in text.iter_mut().rev().take(poses.len()).rev().enumerate() {
                let seeds = source.show_faces(nth, &mut faces, |curve| {
                    *own += &format!("{} {:?}\n", curve.vertices(), curve.point(0));
                });
                *own += &format!("{seeds}\n");
            }
        }
        text
    };
    let alone = answers(1);
    assert_eq!(alone, answers(12));
    assert_eq!(alone, answers(5));
    // Out of reach: no curve, no start.
    assert!(alone[2].contains(" 0 true"), "{}", alone[2]);
    assert!(alone[0].lines().count() > 8);
}
