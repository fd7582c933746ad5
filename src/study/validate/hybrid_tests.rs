use super::tests::{HEAD, R3, ROBOT, parse, planar};
use super::*;
use crate::design::TaskSpace;
use crate::diagnostic::InputError;
use crate::study::{DegreeLimits, Hybrid, HybridSampling};

const R4: &str = "[1, 1, 1, 1]";

fn arm(n: usize) -> String {
    format!("{ROBOT}{:?}", vec![1.0; n])
}

fn rows(rows: &[&str]) -> String {
    format!(
        "name = 'r'\nconvention = 'standard'\njoints = [{}]",
        rows.join(", ")
    )
}

const BENT: &str = "{ kind = 'revolute', alpha_deg = 90, a = 1 }";
const SLIDE: &str = "{ kind = 'prismatic', alpha_deg = 90 }";

#[test]
fn too_few_joints_are_refused_by_every_estimator() {
    for (n, task) in [
        (2, "planar-position"),
        (3, "planar-pose"),
        (6, "spatial-pose"),
    ] {
        for method in ["", "\n[estimator]\nmethod = 'hybrid'"] {
            let error = parse(&arm(n), &format!("'{task}'{method}")).unwrap_err();
            let text = error.render(false);
            assert!(error.key() == "task.space" && text.contains("more joints than"));
        }
    }
}

#[test]
fn what_exact_cannot_serve_is_refused_by_name() {
    let limited = format!(
        "{}\n[physical_limits]\nlower_deg = [-180, 0, 0]\nupper_deg = [180, 9, 9]",
        arm(3)
    );
    let cases = [
        (
            rows(&[BENT; 7]),
            "spatial-pose",
            "use `method = \"hybrid\"`",
        ),
        (limited, "planar-position", "use `method = \"hybrid\"`"),
        (arm(7), "planar-pose", "cannot either"),
        (rows(&[BENT; 3]), "planar-position", "cannot either"),
    ];
    for (robot, task, hint) in cases {
        let text = format!("'{task}'\n[estimator]\nmethod = 'exact'");
        let error = parse(&robot, &text).unwrap_err();
        assert_eq!(error.key(), "estimator.method");
        let help = &error.problem().help;
        assert!(help.contains(hint) && help.contains("hybrid"), "{help}");
    }
}

#[test]
fn without_a_method_the_exact_estimator_comes_first() {
    let method = |robot: &str, text: &str| parse(robot, text).unwrap().estimator;
    let exact = Estimator::default();
    assert_eq!(method(&arm(4), "'planar-pose'"), exact);
    let hybrid = |task| Estimator::Hybrid {
        hybrid: Hybrid::for_task(task),
    };
    let found = method(&rows(&[BENT; 7]), "'spatial-pose'");
    assert_eq!(found, hybrid(TaskSpace::SpatialPose));
    let table = "'planar-pose'\n[estimator.hybrid]\nsampling = 'lattice'";
    assert_eq!(method(&arm(4), table), hybrid(TaskSpace::PlanarPose));
    let exact_all_the_same = "'planar-pose'\n[estimator]\nmethod = 'exact'\n[estimator.hybrid]";
    assert_eq!(method(&arm(4), exact_all_the_same), exact);
}

#[test]
fn what_hybrid_cannot_serve_is_refused_by_name() {
    let sliding = [BENT, BENT, SLIDE, BENT];
    let first = format!(
        "{}\n[physical_limits]\nlower_deg = [0, 0, 0]\nupper_deg = [1, 1, 1]\n\
         lower = [0]\nupper = [1]",
        rows(&[SLIDE, BENT, BENT, BENT])
    );
    let stroke = "\n[physical_limits]\nlower = [0]\nupper = [1]\nlower_deg";
    let longer = format!(
        "{}{stroke} = [0, 0, 0, 0]\nupper_deg = [1, 1, 1, 1]",
        rows(&[SLIDE, BENT, BENT, BENT, BENT])
    );
    let limited = format!(
        "{}\n[physical_limits]\nlower_deg = [-170, 0, 0]\nupper_deg = [170, 9, 9]",
        arm(3)
    );
    let cases = [
        (
            rows(&[BENT; 10]),
            "spatial-pose",
            "task.space",
            "degree of redundancy of 4",
        ),
        (arm(5), "planar-pose", "", ""),
        (arm(6), "planar-pose", "", ""),
        (
            arm(7),
            "planar-pose",
            "task.space",
            "degree of redundancy of 4",
        ),
        (arm(4), "spatial-position", "design", "moves in a plane"),
        (
            rows(&[BENT; 3]),
            "planar-position",
            "design",
            "twist of row 1",
        ),
        (
            rows(&sliding),
            "spatial-position",
            "design",
            "joint 3 of `r`, which slides",
        ),
        (first.clone(), "spatial-position", "", ""),
        (first, "planar-position", "design", "joint 1 is prismatic"),
        (longer, "spatial-position", "design", "joint 1 is prismatic"),
        (limited, "planar-position", "", ""),
    ];
    for (robot, task, key, found) in cases {
        let Err(error) = parse(&robot, &format!("'{task}'")) else {
            assert_eq!(key, "", "{task} is served");
            continue;
        };
        assert_eq!(error.key(), key);
        assert!(error.problem().found.contains(found), "{error}");
    }
    let served = format!(
        "{}\n[physical_limits]\nlower_deg = [-180, 0, 0]\nupper_deg = [180, 9, 9]\n\
         lower = [0]\nupper = [1]",
        rows(&sliding)
    );
    parse(&served, "'spatial-position'").unwrap();
}

#[test]
fn settings_of_the_hybrid_estimator_are_checked_against_the_task() {
    let with = |task: &str, settings: &str| {
        let text = format!("'{task}'\n[estimator.hybrid]\n{settings}");
        let Estimator::Hybrid { hybrid } = planar(R4, &text)?.estimator else {
            panic!("hybrid expected");
        };
        Ok::<_, InputError>(hybrid)
    };
    let lattice = with("planar-pose", "samples = 160\nreplicates = 10").unwrap();
    let expected = HybridSampling::Lattice {
        samples: 160,
        replicates: 10,
    };
    assert_eq!(lattice.sampling, expected);
    let grid = with("planar-pose", "sampling = 'grid'\ncentres = true").unwrap();
    let expected = HybridSampling::Grid {
        cell: 0.04,
        orientations: 25,
        centres: true,
    };
    assert_eq!(grid.sampling, expected);
    for (settings, key) in [
        ("samples = 160\nreplicates = 11", "replicates"),
        ("replicates = 1", "replicates"),
        ("samples = 31", "samples"),
        ("cell = 0.1", "cell"),
        ("orientations = 2", "orientations"),
        ("centres = true", "centres"),
        ("sampling = 'grid'\nsamples = 1000", "samples"),
        ("sampling = 'grid'\nreplicates = 10", "replicates"),
        ("sampling = 'grid'\ncell = 0.001", "cell"),
        ("tolerance_rad = 0", "tolerance_rad"),
        ("memory_limit_mb = 0", "memory_limit_mb"),
        ("rule = 'papers'", "rule"),
        ("sampling = 'sobol'", "sampling"),
    ] {
        let error = with("planar-pose", settings).unwrap_err();
        assert_eq!(error.key(), format!("estimator.hybrid.{key}"), "{settings}");
    }
    let text = "'planar-position'\n[estimator.hybrid]\nsampling = 'grid'\norientations = 2";
    let error = planar(R3, text).unwrap_err();
    assert_eq!(error.key(), "estimator.hybrid.orientations");
}

#[test]
fn what_only_exact_can_do_is_refused_with_hybrid() {
    let hybrid = "[estimator]\nmethod = 'hybrid'\n";
    let links = "[search]\nlink_lower = [0.5, 0.5, 0.5]\nlink_upper = [2, 2, 2]\n";
    let error = planar(R3, &format!("'planar-position'\n{hybrid}{links}")).unwrap_err();
    assert_eq!(error.key(), "search.link_lower");
    let limits = "[limits]\nlower_deg = [0, 0, 0]\nupper_deg = [9, 9, 9]\n";
    let estimate = HEAD.replace("optimise", "estimate");
    let text = format!("{estimate}'planar-position'\n{limits}{hybrid}[estimate]\nradii = [1]\n");
    assert_eq!(planar(R3, &text).unwrap_err().key(), "estimate.radii");
}

#[test]
fn a_costly_score_gets_fewer_restarts() {
    let restarts = |text: &str| {
        let text = format!("'planar-position'\n{text}");
        match planar(R3, &text).unwrap().question {
            Question::Optimise(Optimise {
                optimiser: OptimiserSettings::CoordinateAscent(ascent),
                ..
            }) => ascent.restarts,
            _ => panic!("coordinate ascent expected"),
        }
    };
    assert_eq!(restarts(""), 32);
    assert_eq!(restarts("[estimator.hybrid]"), 8);
    let given = "[estimator.hybrid]\n[optimiser.coordinate-ascent]\nrestarts = 32";
    assert_eq!(restarts(given), 32);
}

#[test]
fn poses_have_what_the_task_has() {
    let with = |robot: &str, task: &str, pose: &str| {
        let text = format!("kind = 'manifolds'\ndesign = 'd'\n[task]\nspace = '{task}'\n{pose}\n");
        parse(robot, &text).map(|study| study.question)
    };
    let spatial = rows(&[BENT; 7]);
    let identity = "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]";
    let pose = |rest: &str| format!("[pose]\nposition = [1, 2, 3]\n{rest}");
    with(
        &spatial,
        "spatial-pose",
        &pose(&format!("rotation = {identity}")),
    )
    .unwrap();
    with(&arm(3), "planar-position", "[pose]\nposition = [1, 2]").unwrap();
    with(
        &arm(4),
        "planar-pose",
        "[pose]\nposition = [1, 2]\nphi_deg = 30",
    )
    .unwrap();
    let cases = [
        (&spatial, "spatial-pose", pose(""), "pose.rotation"),
        (&spatial, "spatial-pose", String::new(), "pose"),
        (
            &spatial,
            "spatial-pose",
            pose("rotation = [[1, 0], [0, 1]]"),
            "pose.rotation",
        ),
        (
            &spatial,
            "spatial-pose",
            pose(&identity.replace("[[1", "rotation = [[-1")),
            "pose.rotation",
        ),
        (
            &spatial,
            "spatial-pose",
            pose(&identity.replace("[[1", "rotation = [[1.00001")),
            "pose.rotation",
        ),
        (
            &spatial,
            "spatial-pose",
            pose(&format!("phi_deg = 1\nrotation = {identity}")),
            "pose.phi_deg",
        ),
        (
            &spatial,
            "spatial-pose",
            "[estimator]\n[pose]\nposition = [1]".into(),
            "estimator",
        ),
        (
            &arm(4),
            "planar-pose",
            "[pose]\nposition = [1, 2]".into(),
            "pose.phi_deg",
        ),
        (&arm(3), "planar-position", pose(""), "pose.position"),
        (
            &arm(3),
            "planar-position",
            format!("[pose]\nposition = [1, 2]\nrotation = {identity}"),
            "pose.rotation",
        ),
        (
            &arm(6),
            "planar-position",
            "[pose]\nposition = [1, 2]".into(),
            "task.space",
        ),
        (
            &arm(3),
            "planar-position",
            "[pose]\nposition = [1, 2]\n[manifolds]\nslices = 8".into(),
            "manifolds.slices",
        ),
        (
            &arm(3),
            "planar-position",
            "[pose]\nposition = [1, 2]\n[limits]\nlower_deg = [1]\nupper_deg = [1]".into(),
            "limits.lower_deg",
        ),
    ];
    for (robot, task, text, key) in cases {
        let error = with(robot, task, &text).unwrap_err();
        assert_eq!(error.key(), key, "{text}");
    }
    let surface = "[pose]\nposition = [1, 2]\n[manifolds]\nslices = 8";
    assert!(with(&arm(4), "planar-position", surface).is_ok());
}

#[test]
fn limits_of_prismatic_joints_are_metres() {
    let robot = format!(
        "{}\n[physical_limits]\nlower_deg = [-180, -180, -180]\nupper_deg = [180, 180, 180]\n\
         lower = [0.5]\nupper = [1.5]",
        rows(&[BENT, BENT, SLIDE, BENT])
    );
    let with = |limits: &str| {
        let text = format!(
            "kind = 'estimate'\ndesign = 'd'\n[task]\nspace = 'spatial-position'\n\
             [limits]\nlower_deg = [0, 0, -90]\nupper_deg = [9, 9, 90]\n{limits}\n"
        );
        parse(&robot, &text)
    };
    let study = with("lower = [0.75]\nupper = [1.5]").unwrap();
    let Question::Estimate(estimate) = &study.question else {
        panic!("estimate expected");
    };
    let limits = estimate.limits.to_limits(&study.design.robot);
    let quarter = std::f64::consts::FRAC_PI_4;
    let [slide, last] = [limits.joints()[2], limits.joints()[3]];
    assert!((slide.lower + quarter).abs() < 1e-12 && (slide.width() - 3.0 * quarter).abs() < 1e-12);
    assert!((last.width() - 4.0 * quarter).abs() < 1e-12);
    let back = DegreeLimits::from_limits(&limits, &study.design.robot);
    assert!((back.lower[0] - 0.75).abs() < 1e-12 && (back.upper_deg[2] - 90.0).abs() < 1e-9);
    for (limits, key) in [
        ("", "limits.lower"),
        ("lower = [1]", "limits.upper"),
        ("lower = [1, 2]\nupper = [1, 2]", "limits.lower"),
        ("lower = [1]\nupper = [0.9]", "limits.upper"),
    ] {
        assert_eq!(with(limits).unwrap_err().key(), key, "{limits}");
    }
}
