//! `faultspace show`: every kind of robot has a table and a picture.

use assert_cmd::Command;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

fn show(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_faultspace"));
    command.arg("show").args(arguments).output().unwrap()
}

fn text(output: &Output) -> String {
    let bytes = if output.status.success() {
        &output.stdout
    } else {
        &output.stderr
    };
    String::from_utf8(bytes.clone()).unwrap()
}

fn design(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("designs");
    folder.join(name).to_string_lossy().into_owned()
}

/// A crane: a turning column, a slide up, a telescope without limits, and a swivelling hook.
const CRANE: &str = r#"<robot name="crane">
  <link name="base"/><link name="column"/><link name="carriage"/><link name="boom"/><link name="hook"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="column"/><axis xyz="0 0 1"/></joint>
  <joint name="lift" type="prismatic"><parent link="column"/><child link="carriage"/><axis xyz="0 0 1"/>
    <limit lower="0.2" upper="1.5"/></joint>
  <joint name="reach out" type="prismatic"><parent link="carriage"/><child link="boom"/><axis xyz="1 0 0"/>
    <limit lower="0.5" upper="2"/></joint>
  <joint name="swivel" type="revolute"><parent link="boom"/><child link="hook"/><axis xyz="0 -1 0"/>
    <limit lower="-1" upper="1"/></joint>
</robot>"#;

fn write_crane(folder: &Path, keys: &str) -> PathBuf {
    fs::write(folder.join("crane.urdf"), CRANE).unwrap();
    let path = folder.join("crane.toml");
    fs::write(
        &path,
        format!("name = \"crane_1\"\nurdf = \"crane.urdf\"\n{keys}"),
    )
    .unwrap();
    path
}

#[test]
fn urdf_robots_have_a_table() {
    let folder = tempfile::tempdir().unwrap();
    let tool = "[tool]\nposition = [0, 0, -0.3]\n";
    let path = write_crane(folder.path(), tool);
    let shown = text(&show(&[path.to_str().unwrap()]));
    for part in [
        "reach out  prismatic",
        "0.5 m to 2 m",
        "turn       revolute",
        "  none",
        "tool   at 0.0000 0.0000 -0.3000 m",
        "degree of redundancy, spatial-position:  1",
        // 2 m of boom and the hook's cable swung out to 57.3°: 2 + 0.3 sin 1.
        "radius about the axis of joint 1:        2.25244 m",
        // From 0.2 − 0.3 to 1.5 − 0.3 cos 1.
        "height along the axis of joint 1:        −0.1 to 1.33791 m",
    ] {
        assert!(shown.contains(part), "{part} is not in\n{shown}");
    }
    let unlimited = write_crane(folder.path(), "use_urdf_limits = false\n");
    let shown = text(&show(&[unlimited.to_str().unwrap()]));
    assert!(shown.contains("not limited"), "{shown}");
}

#[test]
fn every_kind_of_robot_is_drawn_the_same_each_time() {
    let folder = tempfile::tempdir().unwrap();
    let crane = write_crane(folder.path(), "use_urdf_limits = false\n");
    let still = folder.path().join("still.toml");
    let rows = "name = 'still'\nconvention = 'modified'\njoints = [\
        { kind = 'revolute' }, { kind = 'revolute', alpha_deg = 90 }]";
    fs::write(&still, rows).unwrap();
    let mut robots = ["pa10", "spatial_8r", "planar_4r"]
        .map(|name| design(&format!("{name}.toml")))
        .to_vec();
    robots.extend([&crane, &still].map(|path| path.to_string_lossy().into_owned()));
    for robot in robots {
        let files = ["a.png", "b.png", "a.svg", "b.svg"].map(|name| folder.path().join(name));
        for file in &files {
            let output = show(&[&robot, "--out", file.to_str().unwrap()]);
            assert!(output.status.success(), "{}", text(&output));
        }
        let bytes = files.map(|file| fs::read(file).unwrap());
        assert!(bytes[0] == bytes[1] && bytes[2] == bytes[3], "{robot}");
        assert!(bytes[0].starts_with(b"\x89PNG") && bytes[0].len() > 10_000);
        let svg = String::from_utf8(bytes[2].clone()).unwrap();
        assert!(svg.contains("x (m)") && !svg.contains("NaN"));
    }
}

#[test]
fn pictures_of_arms_in_space_name_joints_frames_and_axes() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("robot.svg");
    let crane = write_crane(folder.path(), "");
    show(&[crane.to_str().unwrap(), "--out", file.to_str().unwrap()]);
    let svg = fs::read_to_string(file).unwrap();
    let words = [
        "crane-1",
        "1",
        "2",
        "3",
        "4",
        "base",
        "tool",
        "y (m)",
        "z (m)",
        "prismatic joint",
    ];
    for word in words {
        assert!(svg.contains(&format!("\n{word}\n")), "{word}");
    }
}

#[test]
fn a_picture_needs_a_format() {
    let output = show(&[&design("pa10.toml"), "--out", "robot.jpg"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output).contains(".png or .svg"));
}
