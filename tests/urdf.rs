//! Robots from URDF files: what is read, what is ignored and what is refused.

use faultspace::design::{Geometry, JointKind, Robot, parse_design, read_design};
use faultspace::diagnostic::{InputError, Source};
use faultspace::kinematics::{joint_frames, tool_frame};
use faultspace::study::Design;
use nalgebra::{Isometry3, Translation3, Vector3};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fs;
use std::path::PathBuf;

/// Two revolute joints with a fixed one before, between and after them.
const ARM: &str = r#"<?xml version="1.0"?>
<robot name="arm" xmlns:xacro="http://ros.org/xacro">
  <link name="world"/>
  <link name="base"><visual><geometry><mesh filename="package://no/such.dae"/></geometry></visual></link>
  <link name="upper"/> <link name="mount"/> <link name="fore"/> <link name="flange"/>
  <joint name="stand" type="fixed"><parent link="world"/><child link="base"/><origin xyz="0 0 0.5"/></joint>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 0.1"/><axis xyz="0 0 2"/><limit lower="-1" upper="2" effort="1" velocity="1"/></joint>
  <joint name="clamp" type="fixed"><parent link="upper"/><child link="mount"/>
    <origin xyz="1 0 0" rpy="1.5707963267948966 0 0"/></joint>
  <joint name="elbow" type="continuous"><parent link="mount"/><child link="fore"/><axis xyz="0 0 1"/></joint>
  <joint name="wrist" type="fixed"><parent link="fore"/><child link="flange"/><origin xyz="0.5 0 0"/></joint>
</robot>"#;

fn read_with(urdf: &str, keys: &str) -> Result<Robot, InputError> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("arm.urdf"), urdf).unwrap();
    let file = folder.path().join("robot.toml");
    fs::write(&file, format!("name = 'arm'\nurdf = 'arm.urdf'\n{keys}")).unwrap();
    let robot = read_design(&file)?;
    assert_eq!(robot.check(), Ok(()));
    assert!(robot.planar_chain().is_err());
    Ok(robot)
}

fn read(urdf: &str) -> Robot {
    read_with(urdf, "").unwrap_or_else(|error| panic!("{}", error.render(false)))
}

/// The error of a file in which `old` is replaced by `new`; it must name the file and `word`.
fn refuse(old: &str, new: &str, word: &str) -> InputError {
    assert!(ARM.contains(old), "{old}");
    let error = read_with(&ARM.replace(old, new), "").unwrap_err();
    let text = error.render(false);
    assert!(text.contains("arm.urdf") && text.contains(word), "{text}");
    error
}

#[test]
fn fixed_joints_are_folded_and_meshes_ignored() {
    let robot = read(ARM);
    let Geometry::Frames(chain) = &robot.geometry else {
        panic!("a chain of frames expected");
    };
    let names: Vec<&str> = chain
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    assert_eq!(names, ["shoulder", "elbow"]);
    assert_eq!(*chain.joints[0].axis, Vector3::z());
    let (a, b) = (0.3f64, 0.8f64);
    let tool = tool_frame(&robot, &[a, b]).translation.vector;
    let out = 1.0 + 0.5 * b.cos();
    let expected = Vector3::new(out * a.cos(), out * a.sin(), 0.6 + 0.5 * b.sin());
    assert!((tool - expected).norm() < 1e-14, "{tool}");
    let frames = joint_frames(&robot, &[a, b]);
    assert_eq!(frames.len(), 3);
    assert!((frames[1].translation.vector - Vector3::new(0.0, 0.0, 0.6)).norm() < 1e-15);
}

#[test]
fn limits_come_from_the_file_unless_the_robot_says_otherwise() {
    let limits = read(ARM).physical_limits.unwrap();
    assert_eq!(
        (limits.lower, limits.upper),
        (vec![-1.0, -PI], vec![2.0, PI])
    );
    let off = read_with(ARM, "use_urdf_limits = false").unwrap();
    assert!(off.physical_limits.is_none());
    let own = "[physical_limits]\nlower_deg = [-90, -90]\nupper_deg = [90, 90]";
    let own = read_with(ARM, own).unwrap().physical_limits.unwrap();
    assert_eq!(own.upper, [FRAC_PI_2, FRAC_PI_2]);
    let limit = r#"<limit lower="-1" upper="2" effort="1" velocity="1"/>"#;
    refuse(limit, "", "`shoulder` has no limits");
    refuse(limit, r#"<limit effort="1" velocity="1"/>"#, "go nowhere");
    refuse(limit, r#"<limit lower="2" upper="1"/>"#, "go nowhere");
    refuse(limit, r#"<limit lower="nan" upper="1"/>"#, "shoulder");
    refuse(limit, r#"<limit lower="-inf" upper="1"/>"#, "shoulder");
    // Without any use for them, limits may be missing.
    assert!(read_with(&ARM.replace(limit, ""), "use_urdf_limits = false").is_ok());
}

#[test]
fn prismatic_joints_slide() {
    let slide = ARM.replace(
        r#"name="shoulder" type="revolute""#,
        r#"name="shoulder" type="prismatic""#,
    );
    let robot = read(&slide);
    assert_eq!(robot.joint_kind(0), JointKind::Prismatic);
    assert_eq!(robot.physical_limits.clone().unwrap().upper[0], 2.0);
    let up = tool_frame(&robot, &[0.7, 0.0]).translation.vector;
    assert!((up - Vector3::new(1.5, 0.0, 1.3)).norm() < 1e-14);
    let text = read_with(&slide.replace("upper=\"2\"", "upper=\"2e9\""), "").unwrap_err();
    assert!(text.render(false).contains("finite"));
}

const FINGERS: &str = r#"<link name="left"/><link name="right"/>
  <joint name="left" type="prismatic"><parent link="flange"/><child link="left"/><axis xyz="0 0 0"/></joint>
  <joint name="right" type="prismatic"><parent link="flange"/><child link="right"/><mimic joint="left"/></joint>
</robot>"#;

#[test]
fn branches_need_a_tip_and_are_ignored_off_the_chain() {
    let branched = ARM.replace("</robot>", FINGERS);
    let error = read_with(&branched, "").unwrap_err();
    let text = error.render(false);
    assert_eq!(error.key(), "urdf");
    assert!(
        text.contains("`left`, `right`") && text.contains("tip ="),
        "{text}"
    );
    // Neither the zero axis nor the mimic joint of a finger matters to an arm that ends before.
    let arm = read_with(&branched, "tip = 'flange'").unwrap();
    assert_eq!(arm.geometry, read(ARM).geometry);
    let mimic = read_with(&branched, "tip = 'right'")
        .unwrap_err()
        .render(false);
    assert!(
        mimic.contains("`right`") && mimic.contains("mimics"),
        "{mimic}"
    );
    let short = read_with(&branched, "base = 'upper'\ntip = 'flange'").unwrap_err();
    assert!(short.problem().message.contains("number of joints"));
}

#[test]
fn base_and_tip_are_checked() {
    let error = |keys: &str| read_with(ARM, keys).unwrap_err();
    let tip = error("tip = 'flansch'");
    assert_eq!(
        (tip.key(), tip.problem().help.as_str()),
        ("tip", "did you mean `flange`?")
    );
    assert_eq!(error("base = 'bass'").key(), "base");
    let swapped = error("base = 'flange'\ntip = 'world'");
    assert!(swapped.problem().message.contains("not below"));
    let still = error("base = 'world'\ntip = 'base'");
    assert!(still.problem().message.contains("no joint that moves"));
    assert!(
        error("tip = 'world'")
            .problem()
            .message
            .contains("no joint that moves")
    );
    let from_upper = read_with(ARM, "base = 'base'").unwrap();
    let moved = tool_frame(&from_upper, &[0.0, 0.0]).translation.vector;
    assert!((moved - Vector3::new(1.5, 0.0, 0.1)).norm() < 1e-14);
}

#[test]
fn loops_are_refused() {
    let second = r#"<joint name="rod" type="fixed"><parent link="base"/><child link="flange"/></joint></robot>"#;
    let error = refuse("</robot>", second, "`flange` has two parents");
    assert!(error.problem().found.contains("`rod`") && error.line().is_some());
    // A ring has no root, and with a base named, no way out of it either.
    let ring = r#"<joint name="rod" type="fixed"><parent link="flange"/><child link="world"/></joint></robot>"#;
    refuse("</robot>", ring, "closed loop");
    let ring = ARM.replace("</robot>", ring);
    let text = read_with(&ring, "base = 'base'").unwrap_err().render(false);
    assert!(text.contains("closed loop"), "{text}");
    let island = r#"<link name="a"/><joint name="self" type="fixed"><parent link="a"/><child link="a"/></joint></robot>"#;
    let island = ARM.replace("</robot>", island);
    let text = read_with(&island, "tip = 'a'").unwrap_err().render(false);
    assert!(text.contains("closed loop"), "{text}");
}

#[test]
fn joints_that_make_no_sense_are_named() {
    let axis = refuse(
        r#"<axis xyz="0 0 2"/>"#,
        r#"<axis xyz="0 0 0"/>"#,
        "`shoulder` has no direction",
    );
    assert!(axis.line().is_some());
    for bad in ["nan 0 1", "0 0 inf", "0 0", "0 x 0 1", "", "1e300 0 0"] {
        refuse(r#"xyz="0 0 2""#, &format!("xyz=\"{bad}\""), "shoulder");
        refuse(r#"xyz="0 0 0.1""#, &format!("xyz=\"{bad}\""), "shoulder");
    }
    for kind in ["floating", "planar", "spherical", "hinge", ""] {
        refuse(
            r#"type="continuous""#,
            &format!("type=\"{kind}\""),
            "`elbow`",
        );
    }
    refuse(
        r#"<parent link="upper"/>"#,
        r#"<parent link="uper"/>"#,
        "`upper`",
    );
    refuse(
        r#"<parent link="upper"/>"#,
        "",
        "`clamp` has no parent link",
    );
    refuse(
        r#"<link name="upper"/>"#,
        r#"<link name="upper"/><link name="upper"/>"#,
        "two links",
    );
    refuse(
        "<axis xyz=\"0 0 1\"/>",
        "<origin quat_xyzw=\"0 0 0 1\"/>",
        "`quat_xyzw`",
    );
}

#[test]
fn text_that_is_no_urdf_is_refused() {
    let deep = format!("<robot>{}", "<a>".repeat(300_000));
    let nested = format!(
        "<robot>{}{}</robot>",
        "<a>".repeat(50_000),
        "</a>".repeat(50_000)
    );
    let many = format!("<robot>{}</robot>", "<link name='a'/>".repeat(100_000));
    let bomb = "<!DOCTYPE r [<!ENTITY a \"aaaa\">]><robot>&a;</robot>";
    let texts = [
        "",
        "<",
        "<robot",
        "<robot>",
        "<robot/>",
        "<arm/>",
        "name = 'arm'",
        "\u{feff}<robot/>",
        "<robot><link/></robot>",
        "<robot><joint/></robot>",
        "<x:robot/>",
        &deep,
        &nested,
        &many,
        bomb,
        "<robot><link name='a'/></robot>",
    ];
    for text in texts {
        let message = read_with(text, "").unwrap_err().render(false);
        assert!(
            message.contains("arm.urdf") && message.contains("help"),
            "{message}"
        );
    }
    let missing = Source::new("robot.toml", "name = 'r'\nurdf = 'no/such.urdf'");
    let error = parse_design(&missing).unwrap_err();
    assert_eq!((error.line(), error.key()), (Some(2), "urdf"));
}

/// A tool moves on from the tip, and the axis x is the default.
#[test]
fn tools_and_default_axes() {
    let tool = "[tool]\nposition = [0, 0, 0.2]\nrpy_deg = [0, 90, 0]";
    let robot = read_with(&ARM.replace(r#"<axis xyz="0 0 1"/>"#, ""), tool).unwrap();
    let plain = tool_frame(
        &read(&ARM.replace(r#"<axis xyz="0 0 1"/>"#, "")),
        &[0.3, 0.4],
    );
    let offset = Isometry3::rotation(Vector3::y() * FRAC_PI_2);
    let expected = plain * Translation3::new(0.0, 0.0, 0.2) * offset;
    let found = tool_frame(&robot, &[0.3, 0.4]);
    assert!((found.to_homogeneous() - expected.to_homogeneous()).amax() < 1e-14);
    let Geometry::Frames(chain) = &robot.geometry else {
        panic!("a chain of frames expected");
    };
    assert_eq!(*chain.joints[1].axis, Vector3::x());
}

/// The URDF of a robot of standard rows: a link's frame is turned and shifted as its row says.
#[test]
fn rows_written_as_urdf_are_the_same_robot() {
    let rows = [
        [-1.7, 0.17, 0.1],
        [0.6, -1.4, 1.67],
        [-1.15, 0.3, -0.69],
        [0.4, 0.56, 0.2],
    ];
    let mut urdf = String::from("<robot name='r'><link name='l0'/>");
    let mut toml = String::from("name = 'r'\nconvention = 'standard'\njoints = [");
    for (k, [alpha, a, d]) in (1..).zip(rows) {
        urdf += &format!(
            "<link name='m{k}'/><link name='l{k}'/>\
             <joint name='j{k}' type='continuous'><parent link='l{}'/><child link='m{k}'/>\
             <axis xyz='0 0 1'/></joint>\
             <joint name='f{k}' type='fixed'><parent link='m{k}'/><child link='l{k}'/>\
             <origin xyz='{a} 0 {d}' rpy='{alpha} 0 0'/></joint>",
            k - 1
        );
        let degrees = f64::to_degrees(alpha);
        toml += &format!("{{ kind = 'revolute', alpha_deg = {degrees}, a = {a}, d = {d} }},");
    }
    let from_urdf = read(&(urdf + "</robot>"));
    let from_rows = parse_design(&Source::new("r.toml", toml + "]")).unwrap();
    for theta in [[0.0; 4], [0.3, -1.2, 2.9, 0.4], [5.0, 1.0, -1.0, 2.0]] {
        let [a, b] = [&from_urdf, &from_rows].map(|r| tool_frame(r, &theta).to_homogeneous());
        assert!((a - b).amax() < 1e-14);
    }
}

#[test]
fn the_hash_covers_both_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("robot.toml");
    let hash = |urdf: &str, robot: &str| {
        fs::write(folder.path().join("arm.urdf"), urdf).unwrap();
        fs::write(&path, robot).unwrap();
        let source = Source::read(&path).unwrap();
        Design::parse(PathBuf::from(&path), &source).unwrap().sha256
    };
    let robot = "name = 'arm'\nurdf = 'arm.urdf'\n";
    let first = hash(ARM, robot);
    assert_eq!(first, hash(ARM, robot));
    assert_ne!(first, hash(&format!("{ARM}\n"), robot));
    assert_ne!(first, hash(ARM, &format!("{robot}\n")));
}

/// A joint of a robot cut into pieces and put together anew.
fn shuffled(cuts: &[usize], odd: &str) -> String {
    let mut text = ARM.replace("</robot>", FINGERS);
    for pair in cuts.chunks_exact(2) {
        let place = |at: usize| text.floor_char_boundary(at % (text.len() + 1));
        let (from, to) = (place(pair[0]), place(pair[0] + pair[1] % 12));
        let end = to.max(from);
        text.replace_range(from..end, odd);
    }
    text
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..Default::default() })]

    #[test]
    fn damaged_files_never_panic(
        cuts in prop::collection::vec(0..4000usize, 2..6),
        odd in prop_oneof![Just(""), Just("<"), Just("\""), Just("&#0;"), Just("nan"), Just("fixed"), Just("x:y"), Just("<joint/>"), Just("é")],
    ) {
        let text = shuffled(&cuts, odd);
        for keys in ["tip = 'flange'", ""] {
            if let Err(error) = read_with(&text, keys) {
                let message = error.render(false);
                prop_assert!(message.contains("arm.urdf") && message.contains("help"));
                prop_assert!(!message.contains("does not understand"), "{}", text);
            }
        }
    }
}
