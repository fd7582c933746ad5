//! Files of a robot that a search has found: to be used elsewhere, and to be measured anew.

use super::settings::{DegreeLimits, Study};
use crate::design::{Robot, robot_to_toml, robot_to_urdf};
use crate::workspace::{ArtificialLimits, FailureSet};

/// Who found it.
pub(super) fn source(study: &Study) -> String {
    format!(
        "found by faultspace {} from the study {}, seed {}",
        env!("CARGO_PKG_VERSION"),
        study.name,
        study.seed
    )
}

/// The robot file and the URDF file of `robot`, named after it, with its limits in a comment.
pub(super) fn robot_files(robot: &Robot, limits: &ArtificialLimits) -> Vec<(String, String)> {
    let written = DegreeLimits::from_limits(limits, robot);
    let comments = [
        format!(
            "Lower limits before a failure (deg): {:.4?}",
            written.lower_deg
        ),
        format!(
            "Upper limits before a failure (deg): {:.4?}",
            written.upper_deg
        ),
    ];
    let name = &robot.name;
    let mut files = Vec::new();
    if let Ok(text) = robot_to_toml(robot, &comments) {
        files.push((format!("{name}.toml"), text));
    }
    files.push((format!("{name}.urdf"), robot_to_urdf(robot)));
    files
}

/// A study that measures the robot of `robot.toml` anew, by the estimator of this name.
pub(super) fn robot_study(
    study: &Study,
    robot: &Robot,
    limits: &ArtificialLimits,
    failures: &FailureSet,
    estimator: &str,
) -> (String, String) {
    let limits = DegreeLimits::from_limits(limits, robot);
    let numbers: Vec<usize> = failures.numbers().collect();
    let failures = match numbers.len() == robot.joints() {
        true => "\"any\"".into(),
        false => format!("{numbers:?}"),
    };
    let samples = match estimator {
        "exact" => "",
        _ => ", on other samples",
    };
    // Two neighbouring seeds have no samples in common; a study file holds none above 2^63 - 1.
    let seed = study.seed % i64::MAX as u64 + 1;
    let check = match estimator {
        "exact" => "",
        _ => "\n[estimator.hybrid]\ncheck_poses = 10000\n",
    };
    // Degrees come from radians: 69 is not to be 69.00000000000001.
    let tidy =
        |ends: &[f64]| -> Vec<f64> { ends.iter().map(|x| (x * 1e9).round() / 1e9).collect() };
    let text = format!(
        "# Measures the robot found anew{samples}.\nkind = \"estimate\"\ndesign = \
         \"robot.toml\"\nseed = {seed}\n\n[task]\nspace = \"{}\"\nfailures = {failures}\nmargin_deg = \
         {}\n\n[limits]\nlower_deg = {:?}\nupper_deg = {:?}\n\n[estimator]\nmethod = \
         \"{estimator}\"\n{check}",
        study.task,
        study.margin_deg,
        tidy(&limits.lower_deg),
        tidy(&limits.upper_deg)
    );
    ("robot_study.toml".into(), text)
}
