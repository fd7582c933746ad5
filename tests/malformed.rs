//! Mutated study and design files: the readers may refuse them, but never panic, and whatever they
//! accept keeps the laws of its type.

use faultspace::design::{Robot, parse_design};
use faultspace::diagnostic::{InputError, Source};
use faultspace::study::{Design, Study, StudyFile};
use proptest::prelude::*;
use std::path::{Path, PathBuf};

const ROBOTS: [&str; 3] = [
    "name = \"arm\"\nsource = \"§V.B\"\nlinks = [1.0, 0.5, 1.5]\n",
    "name = \"planar rows\"\nconvention = \"standard\"\njoints = [\n\
     { kind = \"revolute\", alpha_deg = 0.0, a = 1.0, d = 0.0, theta_deg = 0.0 },\n\
     { kind = \"revolute\", alpha_deg = 360, a = -0.5, theta_deg = 90.0 },\n\
     { kind = \"revolute\", a = 0x2 },\n]\n",
    "name = \"mixed\"\nconvention = \"modified\"\njoints = [\n\
     { kind = \"revolute\", alpha_deg = -90.0, a = 0.1, d = 0.2, theta_deg = 45.0 },\n\
     { kind = \"prismatic\", alpha_deg = 90.0 },\n]\n\
     [physical_limits]\nlower_deg = [-170.0]\nupper_deg = [170.0]\nlower = [0]\nupper = [0.5]\n",
];

const STUDIES: [&str; 5] = [
    "kind = \"estimate\"\ntitle = \"Título\"\ndesign = \"arm.toml\"\nseed = 7\n[task]\n\
     space = \"planar-position\"\nfailures = [1, 3]\n[limits]\nlower_deg = [-18, -111, -111]\n\
     upper_deg = [18.0, 111, 249]\n[estimator]\nmethod = \"exact\"\ntolerance = 1e-3\n\
     [estimate]\nradii = [0.8, 1.2]\n[report]\nformats = [\"png\", \"svg\"]\nfigures = true\n",
    "kind = \"optimise\"\ndesign = \"arm.toml\"\n[task]\nspace = \"planar-position\"\n\
     failures = \"any\"\n[search]\nmin_width_deg = 5\nlink_lower = [0.5, 0.5, 0.5]\n\
     link_upper = [2.0, 2.0, 2.0]\n[optimiser]\nmethod = \"genetic\"\n\
     [optimiser.coordinate-ascent]\nrestarts = 32\nline_samples = 24\nmax_sweeps = 100\n\
     tolerance = 1e-9\n[optimiser.genetic]\npopulation = 100\ngenerations = 200\nelite = 2\n\
     tournament = 3\ncrossover_rate = 0.9\nmutation_rate = 0.3\npatience = 50\npolish = true\n",
    "kind = \"estimate\"\ndesign = \"arm.toml\"\n[task]\nspace = \"planar-position\"\n[limits]\n\
     lower_deg = [-18, -111, -111]\nupper_deg = [18.0, 111, 249]\n[estimator]\n\
     method = \"hybrid\"\n[estimator.hybrid]\nsampling = \"lattice\"\nsamples = 1000\n\
     replicates = 8\ntolerance_rad = 0.02\nmemory_limit_mb = 100\nrule = \"definition\"\ncheck_poses = 20\n",
    "kind = \"optimise\"\ndesign = \"arm.toml\"\n[task]\nspace = \"planar-position\"\n\
     [estimator]\nmethod = \"hybrid\"\n[estimator.hybrid]\nsampling = \"grid\"\ncell = 0.05\n\
     orientations = 1\ncentres = true\nrule = \"paper\"\n",
    "kind = \"manifolds\"\ndesign = \"arm.toml\"\n[task]\nspace = \"planar-position\"\n[pose]\n\
     position = [1.0, 0.5]\n[limits]\nlower_deg = [-18, -111, -111]\n\
     upper_deg = [18.0, 111, 249]\n[manifolds]\nseeds = 64\nresidual = 1e-9\n",
];

/// Numbers, and things in place of numbers, that readers stumble over.
const ODD: [&str; 22] = [
    "nan",
    "-nan",
    "inf",
    "-inf",
    "-1",
    "0",
    "-0.0",
    "1e308",
    "-1e308",
    "1e999",
    "5e-324",
    "18446744073709551615",
    "99999999999999999999999999999999999999999999999",
    "0xFFFFFFFFFFFFFFFFFFFFFFFFFFFFFFFFFFFF",
    "\"\"",
    "[]",
    "{}",
    "[[[[1]]]]",
    "true",
    "1979-05-27T07:32:00Z",
    "3600",
    "\"\\u001b[31m\"",
];

#[derive(Clone, Debug)]
enum Mutation {
    SetByte(usize, u8),
    Delete(usize, usize),
    Insert(usize, String),
    DuplicateLine(usize, usize),
    ReplaceNumber(usize, usize),
    Truncate(usize),
}

fn mutation() -> impl Strategy<Value = Mutation> {
    let at = 0..2000usize;
    prop_oneof![
        1 => (at.clone(), any::<u8>()).prop_map(|(at, byte)| Mutation::SetByte(at, byte)),
        1 => (at.clone(), 1..30usize).prop_map(|(at, length)| Mutation::Delete(at, length)),
        1 => (at.clone(), ".{0,4}").prop_map(|(at, text)| Mutation::Insert(at, text)),
        1 => (at.clone(), at.clone()).prop_map(|(from, to)| Mutation::DuplicateLine(from, to)),
        6 => (at.clone(), 0..ODD.len()).prop_map(|(at, odd)| Mutation::ReplaceNumber(at, odd)),
        1 => at.prop_map(Mutation::Truncate),
    ]
}

fn mutate(text: &str, mutations: &[Mutation]) -> String {
    let mut text = text.to_owned();
    for mutation in mutations {
        text = apply(&text, mutation);
    }
    text
}

fn apply(text: &str, mutation: &Mutation) -> String {
    let place = |at: &usize| at % (text.len() + 1);
    let mut bytes = text.as_bytes().to_vec();
    match mutation {
        Mutation::SetByte(at, byte) => {
            if let Some(old) = bytes.get_mut(place(at)) {
                *old = *byte;
            }
        }
        Mutation::Delete(at, length) => {
            let start = place(at);
            bytes.drain(start..(start + length).min(text.len()));
        }
        Mutation::Insert(at, new) => {
            let start = place(at);
            bytes.splice(start..start, new.bytes());
        }
        Mutation::DuplicateLine(from, to) => {
            let mut lines: Vec<&str> = text.lines().collect();
            if !lines.is_empty() {
                let line = lines[from % lines.len()];
                lines.insert(to % (lines.len() + 1), line);
            }
            bytes = lines.join("\n").into_bytes();
        }
        Mutation::ReplaceNumber(at, odd) => return replace_number(text, *at, ODD[*odd]),
        Mutation::Truncate(at) => bytes.truncate(place(at)),
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// `text` with one of its numbers replaced.
fn replace_number(text: &str, which: usize, new: &str) -> String {
    let digit = |c: char| c.is_ascii_digit() || "+-.e".contains(c);
    let starts: Vec<usize> = text
        .char_indices()
        .filter(|&(at, c)| c.is_ascii_digit() && !text[..at].ends_with(digit))
        .map(|(at, _)| at)
        .collect();
    if starts.is_empty() {
        return text.to_owned();
    }
    let start = starts[which % starts.len()];
    let rest = text[start..].trim_start_matches(digit);
    format!("{}{new}{rest}", &text[..start])
}

/// The message must come out whole, whatever the text around it.
fn check_message(error: &InputError) {
    assert!(error.render(true).contains("found"));
    let plain = error.render(false);
    assert!(plain.contains("help") && plain.contains(error.file()));
    assert!(!plain.contains('\u{1b}'), "a file steers the terminal");
    assert!(error.to_string().contains("expected"));
}

fn read_robot(text: &str) -> Option<Robot> {
    match parse_design(&Source::new("arm.toml", text)) {
        Ok(robot) => Some(robot),
        Err(error) => {
            check_message(&error);
            None
        }
    }
}

fn read_study(robot: &str, text: &str) -> Result<Study, InputError> {
    let source = Source::new("study.toml", text);
    let file = StudyFile::parse(&source)?;
    let design = Design::parse(PathBuf::from("/arm.toml"), &Source::new("arm.toml", robot))?;
    Study::validate("study", &file, &source, design)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..Default::default() })]

    #[test]
    fn robots(which in 0..ROBOTS.len(), mutations in prop::collection::vec(mutation(), 1..4)) {
        if let Some(robot) = read_robot(&mutate(ROBOTS[which], &mutations)) {
            prop_assert_eq!(robot.check(), Ok(()));
            prop_assert!(robot.joints() >= 2);
            if let Ok(chain) = robot.planar_chain() {
                prop_assert!(chain.total_length().is_finite() && chain.total_length() > 0.0);
            }
        }
    }

    #[test]
    fn studies(
        which in 0..STUDIES.len(),
        robot in 0..ROBOTS.len(),
        mutations in prop::collection::vec(mutation(), 0..4),
    ) {
        match read_study(ROBOTS[robot], &mutate(STUDIES[which], &mutations)) {
            Ok(study) => {
                let as_run = study.to_toml(Path::new("/")).unwrap();
                prop_assert_eq!(&read_study(ROBOTS[robot], &as_run).unwrap(), &study);
            }
            Err(error) => check_message(&error),
        }
    }

    #[test]
    fn any_text(text in "(?s).{0,200}") {
        read_robot(&text);
        if let Err(error) = read_study(ROBOTS[0], &text) {
            check_message(&error);
        }
    }
}

#[test]
fn the_files_are_good_before_they_are_mutated() {
    for robot in ROBOTS {
        assert!(read_robot(robot).is_some());
    }
    for study in STUDIES {
        read_study(ROBOTS[0], study).unwrap();
    }
}

#[test]
fn deep_nesting_is_refused() {
    for text in ["[", "{a=", "a.", "[["] {
        let text = format!("a = {}", text.repeat(20_000));
        assert!(read_robot(&text).is_none());
        assert!(read_robot(&text[4..]).is_none());
    }
}
