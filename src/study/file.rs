//! The study file as written: known keys of the right type, each with its place.
//!
//! Values that only make sense beside others (limits beside the robot, `elite` beside
//! `population`) are checked later, in `validate`.

use super::hybrid_table::{self, HybridTable};
use super::pose_table::{self, ManifoldsTable, PoseTable};
use super::search::{self, OptimiserTable, SearchTable};
use super::settings::{EstimatorMethod, FigureFormat};
use super::singular_settings::{LargestSearch, SingularitySearch};
use super::singular_table::{self, FailureTable};
use super::surrogate_table::{self, SurrogateEstimatorTable, TrainTable, ValidateTable};
use super::synthesis_table::{self, SynthesisTable};
use crate::design::TaskSpace;
use crate::diagnostic::{Document, InputError, Item, Place, Source, Table, nearest};

/// Keys of a study file.
const KEYS: &[&str] = &[
    "kind",
    "title",
    "design",
    "seed",
    "task",
    "limits",
    "estimator",
    "estimate",
    "search",
    "optimiser",
    "pose",
    "manifolds",
    "dataset",
    "surrogate",
    "training",
    "validate",
    "singularities",
    "largest-manifold",
    "failure-experiment",
    "synthesis",
    "report",
];

/// Kinds of studies that exist, and planned ones.
const KINDS: [(&str, Option<Kind>); 10] = [
    ("estimate", Some(Kind::Estimate)),
    ("optimise", Some(Kind::Optimise)),
    ("manifolds", Some(Kind::Manifolds)),
    ("singularities", Some(Kind::Singularities)),
    ("largest-manifold", Some(Kind::LargestManifold)),
    ("failure-experiment", Some(Kind::FailureExperiment)),
    ("synthesis", Some(Kind::Synthesis)),
    ("train", Some(Kind::Train)),
    ("validate", Some(Kind::Validate)),
    ("redundancy", None),
];

/// Largest angle in a file, degrees: ten turns. Beyond, the fraction of a turn loses its digits.
pub(super) const MAX_DEGREES: f64 = 3600.0;

/// Largest margin beyond artificial limits, degrees.
const MAX_MARGIN: f64 = 90.0;

/// Largest length in a file, metres; far above any arm, far below where squares overflow.
pub(super) const MAX_LENGTH: f64 = 1e6;

/// A study file as written.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyFile {
    pub(super) kind: Item<Kind>,
    pub(super) title: Option<String>,
    pub(super) design: Item<String>,
    pub(super) seed: Option<u64>,
    pub(super) space: Item<TaskSpace>,
    pub(super) failures: Option<Item<Failures>>,
    pub(super) margin_deg: Option<Item<f64>>,
    pub(super) limits: Option<LimitsTable>,
    pub(super) estimator: EstimatorTable,
    pub(super) estimate: Option<Item<EstimateTable>>,
    pub(super) search: Option<Item<SearchTable>>,
    pub(super) optimiser: Option<Item<OptimiserTable>>,
    pub(super) pose: Option<Item<PoseTable>>,
    pub(super) manifolds: Option<Item<ManifoldsTable>>,
    pub(super) train: Option<TrainTable>,
    /// Where the first of `[dataset]`, `[surrogate]` and `[training]` stands.
    pub(super) train_place: Option<Place>,
    pub(super) validate: Option<Item<ValidateTable>>,
    pub(super) singularities: Option<Item<SingularitySearch>>,
    pub(super) largest: Option<Item<LargestSearch>>,
    pub(super) failure: Option<Item<FailureTable>>,
    pub(super) synthesis: Option<Item<SynthesisTable>>,
    pub(super) formats: Option<Item<Vec<Item<FigureFormat>>>>,
    pub(super) figures: Option<bool>,
}

/// The study's `kind`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Estimate,
    Optimise,
    Manifolds,
    Train,
    Validate,
    Singularities,
    LargestManifold,
    FailureExperiment,
    Synthesis,
}

/// `failures = "any"` or a list of joint numbers from 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Failures {
    Any,
    Of(Vec<Item<u64>>),
}

/// The table `[limits]`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LimitsTable {
    pub lower_deg: Item<Vec<Item<f64>>>,
    pub upper_deg: Item<Vec<Item<f64>>>,
    /// Limits of prismatic joints.
    pub lower: Option<Item<Vec<Item<f64>>>>,
    pub upper: Option<Item<Vec<Item<f64>>>>,
}

/// The table `[estimator]`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EstimatorTable {
    pub method: Option<Item<EstimatorMethod>>,
    pub tolerance: Option<f64>,
    pub hybrid: Option<HybridTable>,
    pub surrogate: Option<SurrogateEstimatorTable>,
    /// Where the table stands, if it does.
    pub place: Option<Place>,
}

/// The table `[estimate]`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EstimateTable {
    pub radii: Option<Item<Vec<f64>>>,
}

impl StudyFile {
    /// Reads a study from the text of its file.
    ///
    /// # Errors
    /// The text is not TOML, or a key is unknown, missing, of the wrong type or out of range by
    /// itself: the first mistake in file order.
    pub fn parse(source: &Source) -> Result<StudyFile, InputError> {
        let document = Document::parse(source)?;
        let file = read(&document.root(KEYS));
        document.finish(file)
    }

    /// The path of the robot file as written: relative to the study file.
    pub fn design(&self) -> &str {
        &self.design.value
    }
}

fn read(root: &Table) -> Option<StudyFile> {
    root.require("kind", "kind = \"optimise\"");
    root.require("design", "design = \"../designs/planar_3r_equal.toml\"");
    root.require("task", "[task]` with `space = \"planar-position\"");
    let kind = read_kind(root);
    let design = root.text("design");
    let task = root.table("task", &["space", "failures", "margin_deg"]);
    let space = task.as_ref().and_then(read_space);
    let estimator = root.table("estimator", &["method", "tolerance", "hybrid", "surrogate"]);
    let report = root.table("report", &["formats", "figures"]);
    let file = StudyFile {
        title: root.text("title").map(|item| item.value),
        seed: root.integer("seed", 0..=u64::MAX).map(|item| item.value),
        failures: task.as_ref().and_then(read_failures),
        margin_deg: task
            .as_ref()
            .and_then(|table| table.number("margin_deg", 0.0..=MAX_MARGIN, " degrees")),
        limits: read_limits(root),
        estimator: EstimatorTable {
            method: estimator.as_ref().and_then(read_method),
            tolerance: estimator
                .as_ref()
                .and_then(|table| table.number("tolerance", 1e-6..=1e-1, ""))
                .map(|item| item.value),
            hybrid: estimator.as_ref().and_then(hybrid_table::read),
            surrogate: estimator.as_ref().and_then(surrogate_table::read_estimator),
            place: root.key_place("estimator"),
        },
        estimate: read_estimate(root),
        search: search::read_search(root),
        optimiser: search::read_optimiser(root),
        pose: pose_table::read_pose(root),
        manifolds: pose_table::read_manifolds(root),
        train: match kind.as_ref().map(|kind| kind.value) {
            Some(Kind::Train) => surrogate_table::read_train(root),
            _ => None,
        },
        train_place: ["dataset", "surrogate", "training"]
            .into_iter()
            .find_map(|key| root.key_place(key)),
        validate: surrogate_table::read_validate(root),
        singularities: singular_table::read_singularities(root),
        largest: singular_table::read_largest(root),
        failure: singular_table::read_failure(root),
        synthesis: synthesis_table::read(root),
        formats: report.as_ref().and_then(read_formats),
        figures: report
            .and_then(|table| table.boolean("figures"))
            .map(|item| item.value),
        kind: kind?,
        design: design?,
        space: space?,
    };
    Some(file)
}

fn read_kind(root: &Table) -> Option<Item<Kind>> {
    let text = root.text("kind")?;
    let written = text.value.as_str();
    let known = KINDS.iter().find(|(name, _)| *name == written);
    let Some(kind) = known.and_then(|(_, kind)| *kind) else {
        let names = KINDS.map(|(name, _)| name);
        let served = KINDS.iter().filter(|(_, kind)| kind.is_some());
        let served: Vec<String> = served.map(|(name, _)| format!("\"{name}\"")).collect();
        let expected = format!("one of {}", served.join(", "));
        let (message, help) = match (known, nearest(written, &names)) {
            (Some(_), _) => (
                "this version does not serve this kind of study",
                "ask for one of the kinds that are served".to_owned(),
            ),
            (None, Some(meant)) => (
                "unknown kind of study",
                format!("did you mean \"{meant}\"?"),
            ),
            (None, None) => ("unknown kind of study", String::new()),
        };
        root.problems()
            .reject(&text.place, message, &expected, &help);
        return None;
    };
    Some(Item {
        value: kind,
        place: text.place,
    })
}

fn read_space(task: &Table) -> Option<Item<TaskSpace>> {
    task.require("space", "space = \"planar-position\"");
    task.choice("space", &TaskSpace::ALL.map(|space| (space.name(), space)))
}

fn read_failures(task: &Table) -> Option<Item<Failures>> {
    let entry = task.entry("failures")?;
    if entry.is_text() {
        return entry.choice(&[("any", Failures::Any)]);
    }
    let entries = entry.array("\"any\" or an array of joint numbers, e.g. `[1, 3]`")?;
    let read: Vec<_> = entries.iter().map(|e| e.integer(1..=u64::MAX)).collect();
    let numbers = read.into_iter().collect::<Option<Vec<_>>>()?;
    Some(entry.item(Failures::Of(numbers)))
}

fn read_limits(root: &Table) -> Option<LimitsTable> {
    let table = root.table("limits", &["lower_deg", "upper_deg", "lower", "upper"])?;
    let angles = |key| {
        table.require(key, &format!("{key} = [0.0, 0.0, 0.0]"));
        table.numbers(key, -MAX_DEGREES..=MAX_DEGREES, " degrees")
    };
    let lengths = |key| table.numbers(key, -MAX_LENGTH..=MAX_LENGTH, " m");
    let (lower_deg, upper_deg) = (angles("lower_deg"), angles("upper_deg"));
    let (lower, upper) = (lengths("lower"), lengths("upper"));
    Some(LimitsTable {
        lower_deg: lower_deg?,
        upper_deg: upper_deg?,
        lower,
        upper,
    })
}

fn read_method(table: &Table) -> Option<Item<EstimatorMethod>> {
    let methods = [
        ("exact", EstimatorMethod::Exact),
        ("hybrid", EstimatorMethod::Hybrid),
        ("surrogate", EstimatorMethod::Surrogate),
    ];
    table.choice("method", &methods)
}

fn read_estimate(root: &Table) -> Option<Item<EstimateTable>> {
    let table = root.table("estimate", &["radii"])?;
    let radii = table.numbers("radii", 0.0..=MAX_LENGTH, " m");
    let radii = radii.map(|radii| Item {
        value: radii.value.iter().map(|radius| radius.value).collect(),
        place: radii.place,
    });
    Some(Item {
        value: EstimateTable { radii },
        place: root.key_place("estimate")?,
    })
}

fn read_formats(report: &Table) -> Option<Item<Vec<Item<FigureFormat>>>> {
    let entry = report.entry("formats")?;
    let choices = [("png", FigureFormat::Png), ("svg", FigureFormat::Svg)];
    let entries = entry.array("an array, e.g. `[\"png\", \"svg\"]`")?;
    let read: Vec<_> = entries.iter().map(|e| e.choice(&choices)).collect();
    Some(entry.item(read.into_iter().collect::<Option<_>>()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "kind = 'estimate'\ndesign = 'd.toml'\n[task]\nspace = 'planar-pose'\n";

    fn error(text: &str) -> InputError {
        StudyFile::parse(&Source::new("s.toml", text)).unwrap_err()
    }

    #[test]
    fn a_short_file_is_enough() {
        let file = StudyFile::parse(&Source::new("s.toml", HEAD)).unwrap();
        assert_eq!((file.design(), file.kind.value), ("d.toml", Kind::Estimate));
        assert_eq!(file.space.place.key, "task.space");
        assert_eq!(file.seed, None);
    }

    #[test]
    fn kinds_are_named() {
        let planned = error(&HEAD.replace("estimate", "redundancy"));
        assert!(planned.problem().message.contains("does not serve"));
        let misspelt = error(&HEAD.replace("estimate", "optimize"));
        assert!(misspelt.problem().help.contains("\"optimise\""));
        assert!(misspelt.problem().expected.contains("\"estimate\""));
    }

    #[test]
    fn missing_keys_are_named() {
        for (key, line) in [("kind", 0), ("design", 1), ("task.space", 3)] {
            let mut lines: Vec<&str> = HEAD.lines().collect();
            lines.remove(line);
            assert_eq!(error(&lines.join("\n")).key(), key);
        }
        assert_eq!(error("kind = 'estimate'\ndesign = 'd'").key(), "task");
    }

    #[test]
    fn values_are_checked_one_by_one() {
        let cases = [
            ("failures = 'some'", "task.failures"),
            ("failures = [0]", "task.failures"),
            ("failures = 3", "task.failures"),
            (
                "[limits]\nlower_deg = [nan]\nupper_deg = [1]",
                "limits.lower_deg",
            ),
            ("[limits]\nlower_deg = [1]", "limits.upper_deg"),
            ("[estimator]\nmethod = 'exakt'", "estimator.method"),
            ("[estimator]\ntolerance = 1.0", "estimator.tolerance"),
            (
                "[estimator.hybrid]\nsamples = 1",
                "estimator.hybrid.samples",
            ),
            ("[estimator.hybrid]\ncell = 0.6", "estimator.hybrid.cell"),
            ("[estimator.hybrid]\nrule = 'x'", "estimator.hybrid.rule"),
            ("[pose]\nposition = [nan]", "pose.position"),
            ("[pose]\nphi_deg = 1", "pose.position"),
            ("[pose]\nposition = [1, 1]\nrotation = [1]", "pose.rotation"),
            ("[manifolds]\nresidual = 1e-12", "manifolds.residual"),
            ("[estimate]\nradii = [-1]", "estimate.radii"),
            ("[search]\nmin_width_deg = 361", "search.min_width_deg"),
            ("[report]\nformats = ['pdf']", "report.formats"),
            ("[report]\nfigures = 1", "report.figures"),
            ("[limit]", "limit"),
        ];
        for (text, key) in cases {
            assert_eq!(error(&format!("{HEAD}{text}\n")).key(), key, "{text}");
        }
    }
}
