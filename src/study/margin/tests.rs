use crate::diagnostic::Source;
use crate::study::settings::Design;
use crate::study::{Study, StudyFile};

const ARM: &str = "name = 'r'\nlinks = [1, 1, 1]";
const LIMITS: &str = "[limits]\nlower_deg = [0, 0, 0]\nupper_deg = [9, 9, 9]\n";

/// The study, or the key and the whole message of its first mistake.
fn study(robot: &str, text: &str) -> Result<Study, (String, String)> {
    let source = Source::new("s.toml", text);
    let read = || {
        let file = StudyFile::parse(&source)?;
        let design = Design::parse("/d.toml".into(), &Source::new("d.toml", robot))?;
        Study::validate("s", &file, &source, design)
    };
    read().map_err(|error| (error.key().to_owned(), error.to_string()))
}

fn text(kind: &str, margin: &str, rest: &str) -> String {
    format!(
        "kind = '{kind}'\ndesign = 'd.toml'\n[task]\nspace = 'planar-position'\n{margin}\n{rest}"
    )
}

#[test]
fn the_margin_reaches_the_failure_set() {
    let none = study(ARM, &text("estimate", "", LIMITS)).unwrap();
    assert_eq!((none.margin_deg, none.failures.margin()), (0.0, 0.0));
    let some = study(ARM, &text("estimate", "margin_deg = 2.5", LIMITS)).unwrap();
    assert_eq!(some.margin_deg, 2.5);
    assert_eq!(some.failures.margin(), 2.5f64.to_radians());
    let pose = format!("{LIMITS}[pose]\nposition = [1, 1]");
    for (kind, rest) in [("optimise", ""), ("manifolds", pose.as_str())] {
        let some = study(ARM, &text(kind, "margin_deg = 90", rest)).unwrap();
        assert_eq!(some.margin_deg, 90.0, "{kind}");
    }
}

#[test]
fn studies_without_artificial_limits_have_no_margin() {
    let surrogate = "[estimator]\nmethod = 'surrogate'\n";
    for (kind, rest, hint) in [
        ("train", "[surrogate]\nmethod = 'arcs'", "surrogate"),
        ("optimise", surrogate, "method = \"surrogate\""),
        ("singularities", "", "no artificial limits"),
        ("largest-manifold", "", "no artificial limits"),
        ("failure-experiment", "", "no artificial limits"),
    ] {
        let (key, message) = study(ARM, &text(kind, "margin_deg = 1", rest)).unwrap_err();
        assert_eq!(key, "task.margin_deg", "{kind}");
        assert!(message.contains(hint), "{message}");
    }
    let train = "[surrogate]\nmethod = 'arcs'";
    assert!(study(ARM, &text("train", "margin_deg = 0", train)).is_ok());
}

#[test]
fn prismatic_joints_have_no_margin() {
    let rows = "name = 'r'\nconvention = 'standard'\njoints = [\
        { kind = 'revolute', alpha_deg = 90, a = 1.0 }, { kind = 'prismatic', alpha_deg = 90 },\
        { kind = 'revolute', alpha_deg = 60, a = 1.0 }, { kind = 'revolute', a = 1.0 } ]\n\
        [physical_limits]\nlower_deg = [-180, -180, -180]\nupper_deg = [180, 180, 180]\n\
        lower = [0.0]\nupper = [1.0]\n";
    let limits = "[limits]\nlower_deg = [0, 0, 0]\nupper_deg = [9, 9, 9]\n\
        lower = [0.1]\nupper = [0.2]\n";
    let spatial = |margin| text("estimate", margin, limits).replace("planar", "spatial");
    assert!(study(rows, &spatial("margin_deg = 0")).is_ok());
    let (key, message) = study(rows, &spatial("margin_deg = 1")).unwrap_err();
    assert_eq!(key, "task.margin_deg", "{message}");
    assert!(message.contains("joint 2 is prismatic"), "{message}");
}
