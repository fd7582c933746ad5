//! Arms on the market: their rows against the joint origins of the makers' URDF files, their
//! elbows, and that a search finds their narrow mountains.

use faultspace::design::{Robot, TaskSpace, read_design};
use faultspace::kinematics::tool_frame;
use faultspace::manifold::{Intolerance, SelfMotionShares};
use faultspace::study::{Progress, RunOptions, Study, run};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::{Path, PathBuf};
use std::sync::Arc;

fn designs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("designs")
}

fn design(name: &str) -> Robot {
    let path = designs().join(name).with_extension("toml");
    read_design(&path).unwrap_or_else(|error| panic!("{}", error.render(false)))
}

/// A URDF file of continuous joints about z with the given origins (xyz, rpy) and a fixed tip.
fn urdf_arm(origins: &[[&str; 2]]) -> Robot {
    let last = origins.len() - 1;
    let mut text = String::from("<robot name=\"arm\"><link name=\"l0\"/>");
    for (k, [xyz, rpy]) in origins.iter().enumerate() {
        let kind = if k == last { "fixed" } else { "continuous" };
        text += &format!(
            "<link name=\"l{}\"/><joint name=\"j{k}\" type=\"{kind}\"><parent link=\"l{k}\"/>\
             <child link=\"l{}\"/><origin xyz=\"{xyz}\" rpy=\"{rpy}\"/><axis xyz=\"0 0 1\"/></joint>",
            k + 1,
            k + 1
        );
    }
    text += "</robot>";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arm.urdf"), text).unwrap();
    let file = folder.path().join("arm.toml");
    std::fs::write(&file, "name = 'arm'\nurdf = 'arm.urdf'\n").unwrap();
    read_design(&file).unwrap_or_else(|error| panic!("{}", error.render(false)))
}

/// Both robots hold the same pose at random joint angles, within `most` (metres, and entries of
/// the rotation matrix).
fn agree(name: &str, origins: &[[&str; 2]], most: f64) {
    let (rows, urdf) = (design(name), urdf_arm(origins));
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for _ in 0..20 {
        let theta: Vec<f64> = (0..7).map(|_| rng.random_range(-3.0..3.0)).collect();
        let [a, b] = [&rows, &urdf].map(|robot| tool_frame(robot, &theta).to_homogeneous());
        assert!((a - b).amax() < most, "{name}: {}", (a - b).amax());
    }
}

const TURN: &str = "1.57079632679 0 0";
const BACK: &str = "-1.57079632679 0 0";
const NONE: &str = "0 0 0";

#[test]
fn rows_agree_with_the_makers_joint_origins() {
    let panda = [
        ["0 0 0.333", NONE],
        [NONE, BACK],
        ["0 -0.316 0", TURN],
        ["0.0825 0 0", TURN],
        ["-0.0825 0.384 0", BACK],
        [NONE, TURN],
        ["0.088 0 0", TURN],
        ["0 0 0.107", NONE],
    ];
    agree("franka_panda", &panda, 1e-9);
    let xarm = [
        ["0 0 0.267", NONE],
        [NONE, BACK],
        ["0 -0.293 0", TURN],
        ["0.0525 0 0", TURN],
        ["0.0775 -0.3425 0", TURN],
        [NONE, TURN],
        ["0.076 0.097 0", BACK],
        [NONE, NONE],
    ];
    agree("ufactory_xarm7", &xarm, 1e-9);
    let sawyer = [
        ["0 0 0.08", NONE],
        ["0.081 0.05 0.237", "-1.57079632679 1.57079632679 0"],
        ["0 -0.14 0.1425", TURN],
        ["0 -0.042 0.26", BACK],
        ["0 -0.125 -0.1265", TURN],
        ["0 0.031 0.275", BACK],
        ["0 -0.11 0.1053", "-1.57079632679 -0.17453 3.1416"],
        ["0 0 0.0245", NONE],
    ];
    // The file gives 10° and 180° to five digits.
    agree("rethink_sawyer", &sawyer, 2e-5);
}

/// Limits do not change the arm, and the elbows of these arms do move, if little.
#[test]
fn elbows_move_a_little() {
    for (name, least, most) in [
        ("franka_panda", 0.02, 0.05),
        ("ufactory_xarm7", 0.02, 0.05),
        ("kinova_gen3", 0.002, 0.02),
        ("rethink_sawyer", 0.1, 0.7),
    ] {
        let arm = design(name);
        let shares = SelfMotionShares::of(&arm, TaskSpace::SpatialPose).unwrap();
        let elbow = (shares.median[3], shares.largest[3]);
        println!(
            "{name:16} joint 4: median {:.3}, largest {:.3}",
            elbow.0, elbow.1
        );
        assert!((least..most).contains(&elbow.0), "{name} {elbow:?}");
        let limited = design(&format!("{name}_limits"));
        assert!(limited.physical_limits.is_some());
        assert_eq!(limited.geometry, arm.geometry);
        let verdict = Intolerance::of(&limited, TaskSpace::SpatialPose, |_| true);
        assert_eq!(verdict, None, "{name}");
    }
}

struct Quiet;

impl Progress for Quiet {
    fn update(&self, _: u64, _: u64, _: f64, _: &str) {}
}

/// The Panda's S_F is 0 for nearly all limits: random starts see no slope. The search begins at
/// limits that some sample survives.
#[test]
fn a_search_finds_the_narrow_mountain_of_the_panda() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!(
        "kind = 'optimise'\ndesign = '{}'\n[task]\nspace = 'spatial-pose'\n\
         [estimator.hybrid]\nsamples = 4000\n[optimiser.coordinate-ascent]\nrestarts = 2\n\
         [report]\nfigures = false\n",
        designs().join("franka_panda.toml").display()
    );
    std::fs::write(folder.path().join("study.toml"), text).unwrap();
    let options = RunOptions {
        out: folder.path().join("out"),
        resume: false,
        overwrite: false,
        threads: None,
        interrupt: Arc::default(),
        cache: None,
    };
    let study = Study::load(&folder.path().join("study.toml")).unwrap();
    let result = run(&study, &options, Arc::new(Quiet)).unwrap();
    let share = result["size"]["normalised"].as_f64().unwrap();
    println!("{:.3} % of the workspace", 100.0 * share);
    // 1.0 % with 100 000 samples; so few flatter the limits, which costs on other samples.
    assert!((0.001..0.02).contains(&share), "{share}");
}
