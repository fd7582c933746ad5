//! The study as run: the study file with every default filled in.

use super::folder::resolve;
use super::settings::{
    CoordinateAscent, DegreeLimits, Estimator, Genetic, ManifoldSearch, OptimiserSettings, Pose,
    Question, ReportSettings, Study,
};
use super::singular_settings::{FailureStudy, LargestSearch, SingularitySearch};
use super::surrogate_settings::{SurrogateSettings, Train, Training, Validate};
use super::synthesis_settings::SynthesisStudy;
use crate::design::TaskSpace;
use crate::surrogate::Draw;
use crate::workspace::FailureSet;
use serde::Serialize;
use std::path::{Component, Path};

impl Study {
    /// The study as a TOML text that means the same when it is saved as a file in `folder`, with
    /// every default written out. The robot's path is relative to `folder`.
    ///
    /// # Errors
    /// None is known; the TOML writer reserves the right.
    pub fn to_toml(&self, folder: &Path) -> Result<String, toml::ser::Error> {
        toml::to_string(&AsRun::new(self, folder))
    }
}

#[derive(Serialize)]
#[serde(rename_all = "kebab-case")]
struct AsRun<'a> {
    kind: &'static str,
    title: Option<&'a str>,
    design: String,
    seed: u64,
    task: Task,
    limits: Option<&'a DegreeLimits>,
    estimator: Option<EstimatorTable<'a>>,
    estimate: Option<EstimateTable<'a>>,
    search: Option<SearchTable<'a>>,
    optimiser: Option<OptimiserTable<'a>>,
    pose: Option<&'a Pose>,
    manifolds: Option<&'a ManifoldSearch>,
    dataset: Option<DatasetTable<'a>>,
    surrogate: Option<&'a SurrogateSettings>,
    training: Option<&'a Training>,
    validate: Option<ValidateTable>,
    singularities: Option<&'a SingularitySearch>,
    largest_manifold: Option<&'a LargestSearch>,
    failure_experiment: Option<&'a FailureStudy>,
    synthesis: Option<&'a SynthesisStudy>,
    report: &'a ReportSettings,
}

#[derive(Serialize)]
#[serde(untagged)]
enum EstimatorTable<'a> {
    Own(&'a Estimator),
    Surrogate {
        method: &'static str,
        surrogate: SurrogateTable,
    },
}

#[derive(Serialize)]
struct SurrogateTable {
    model: String,
    polish: bool,
    compare: bool,
}

#[derive(Serialize)]
struct DatasetTable<'a> {
    designs: u64,
    walk_share: f64,
    cells: u64,
    link_lower: Option<&'a [f64]>,
    link_upper: Option<&'a [f64]>,
}

#[derive(Serialize)]
struct ValidateTable {
    models: Vec<String>,
    designs: u64,
    draw: Draw,
}

#[derive(Serialize)]
struct Task {
    space: TaskSpace,
    failures: Failures,
    margin_deg: Option<f64>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Failures {
    Any(&'static str),
    Of(Vec<usize>),
}

#[derive(Serialize)]
struct EstimateTable<'a> {
    radii: &'a [f64],
}

#[derive(Serialize)]
struct SearchTable<'a> {
    min_width_deg: f64,
    link_lower: Option<&'a [f64]>,
    link_upper: Option<&'a [f64]>,
}

#[derive(Serialize)]
#[serde(rename_all = "kebab-case")]
struct OptimiserTable<'a> {
    method: &'static str,
    coordinate_ascent: Option<&'a CoordinateAscent>,
    genetic: Option<&'a Genetic>,
}

impl<'a> AsRun<'a> {
    fn new(study: &'a Study, folder: &Path) -> AsRun<'a> {
        let mut as_run = AsRun {
            kind: study.question.kind(),
            title: study.title.as_deref(),
            design: relative(&study.design.path, &resolve(folder)),
            seed: study.seed,
            task: Task {
                space: study.task,
                failures: failures(&study.failures, study.design.robot.joints()),
                margin_deg: has_margin(&study.question).then_some(study.margin_deg),
            },
            limits: None,
            estimator: Some(EstimatorTable::new(&study.estimator, folder)),
            estimate: None,
            search: None,
            optimiser: None,
            pose: None,
            manifolds: None,
            dataset: None,
            surrogate: None,
            training: None,
            validate: None,
            singularities: None,
            largest_manifold: None,
            failure_experiment: None,
            synthesis: None,
            report: &study.report,
        };
        match &study.question {
            Question::Estimate(estimate) => {
                as_run.limits = Some(&estimate.limits);
                let exact = matches!(study.estimator, Estimator::Exact { .. });
                as_run.estimate = exact.then_some(EstimateTable {
                    radii: &estimate.radii,
                });
            }
            Question::Optimise(optimise) => {
                let links = optimise.search.links.as_ref();
                as_run.limits = optimise.start.as_ref();
                as_run.search = Some(SearchTable {
                    min_width_deg: optimise.search.min_width_deg,
                    link_lower: links.map(|links| links.link_lower.as_slice()),
                    link_upper: links.map(|links| links.link_upper.as_slice()),
                });
                as_run.optimiser = Some(OptimiserTable::new(&optimise.optimiser));
            }
            Question::Manifolds(manifolds) => {
                as_run.limits = manifolds.limits.as_ref();
                as_run.estimator = None;
                as_run.pose = Some(&manifolds.pose);
                as_run.manifolds = Some(&manifolds.search);
            }
            Question::Train(train) => as_run.add_training(train),
            Question::Validate(validate) => {
                as_run.estimator = None;
                as_run.validate = Some(ValidateTable::new(validate, folder));
            }
            Question::Singularities(search) => {
                as_run.estimator = None;
                as_run.singularities = Some(search);
            }
            Question::LargestManifold(largest) => {
                as_run.estimator = None;
                as_run.singularities = Some(&largest.singularities);
                as_run.largest_manifold = Some(&largest.largest);
            }
            Question::FailureExperiment(study) => {
                as_run.estimator = None;
                as_run.failure_experiment = Some(study);
            }
            Question::Synthesis(synthesis) => {
                as_run.estimator = None;
                as_run.limits = synthesis.limits.as_ref();
                as_run.synthesis = Some(&synthesis.search);
            }
        }
        as_run
    }

    fn add_training(&mut self, train: &'a Train) {
        let (data, links) = (&train.dataset, train.dataset.links.as_ref());
        self.estimator = None;
        self.dataset = Some(DatasetTable {
            designs: data.designs,
            walk_share: data.walk_share,
            cells: data.cells,
            link_lower: links.map(|links| links.link_lower.as_slice()),
            link_upper: links.map(|links| links.link_upper.as_slice()),
        });
        self.surrogate = Some(&train.surrogate);
        self.training = Some(&train.training);
    }
}

impl<'a> OptimiserTable<'a> {
    fn new(settings: &'a OptimiserSettings) -> OptimiserTable<'a> {
        let (coordinate_ascent, genetic) = match settings {
            OptimiserSettings::CoordinateAscent(ascent) => (Some(ascent), None),
            OptimiserSettings::Genetic(genetic) => (None, Some(genetic)),
        };
        OptimiserTable {
            method: settings.method(),
            coordinate_ascent,
            genetic,
        }
    }
}

impl<'a> EstimatorTable<'a> {
    fn new(estimator: &'a Estimator, folder: &Path) -> EstimatorTable<'a> {
        let Estimator::Surrogate { surrogate } = estimator else {
            return EstimatorTable::Own(estimator);
        };
        EstimatorTable::Surrogate {
            method: "surrogate",
            surrogate: SurrogateTable {
                model: relative(&surrogate.model.path, &resolve(folder)),
                polish: surrogate.polish,
                compare: surrogate.compare,
            },
        }
    }
}

impl ValidateTable {
    fn new(validate: &Validate, folder: &Path) -> ValidateTable {
        let models = validate.models.iter();
        ValidateTable {
            models: models
                .map(|model| relative(&model.path, &resolve(folder)))
                .collect(),
            designs: validate.designs,
            draw: validate.draw,
        }
    }
}

/// Whether what is asked depends on where joints lock beyond their limits.
fn has_margin(question: &Question) -> bool {
    matches!(
        question,
        Question::Estimate(_) | Question::Optimise(_) | Question::Manifolds(_)
    )
}

fn failures(set: &FailureSet, joints: usize) -> Failures {
    let numbers: Vec<usize> = set.numbers().collect();
    if numbers.len() == joints {
        Failures::Any("any")
    } else {
        Failures::Of(numbers)
    }
}

/// `path` as seen from `folder`, with forward slashes; both absolute and without `..`.
fn relative(path: &Path, folder: &Path) -> String {
    let (mut from, mut to) = (folder.components().peekable(), path.components().peekable());
    if from.peek() != to.peek() || from.peek() != Some(&Component::RootDir) {
        return path.to_string_lossy().into_owned();
    }
    while from.peek().is_some() && from.peek() == to.peek() {
        from.next();
        to.next();
    }
    let up = from.map(|_| "..".into());
    let down = to.map(|part| part.as_os_str().to_string_lossy());
    up.chain(down).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_relative_to_the_folder() {
        let seen = |path: &str, folder: &str| relative(Path::new(path), Path::new(folder));
        assert_eq!(
            seen("/a/designs/x.toml", "/a/reports/s"),
            "../../designs/x.toml"
        );
        assert_eq!(seen("/a/x.toml", "/a"), "x.toml");
        assert_eq!(seen("x.toml", "/a"), "x.toml");
    }

    const ESTIMATE: &str = "kind = 'estimate'\ntitle = 'A \"title\"'\ndesign = 'r.toml'\n\
        seed = 18446744073709551615\n[task]\nspace = 'planar-position'\nfailures = [3, 1]\nmargin_deg = 2.3\n\
        [limits]\nlower_deg = [-18.21, -180, 0.1]\nupper_deg = [18.21, 180, 0.1]\n\
        [estimate]\nradii = [0, 1e-3, 2.5]\n[report]\nformats = []\nfigures = false\n";
    const ASCENT: &str = "kind = 'optimise'\ndesign = 'r.toml'\n\
        [task]\nspace = 'planar-position'\n";
    const GENETIC: &str = "kind = 'optimise'\ndesign = 'r.toml'\n\
        [task]\nspace = 'planar-position'\n[limits]\nlower_deg = [0, 0, 0]\n\
        upper_deg = [90, 90, 90]\n[search]\nmin_width_deg = 0.1\n\
        link_lower = [0.5, 0.5, 0.5]\nlink_upper = [2, 2, 2]\n[optimiser]\n\
        method = 'genetic'\n[optimiser.genetic]\nmutation_rate = 0.1\n\
        [estimator]\ntolerance = 1e-5\n";
    const LATTICE: &str = "kind = 'estimate'\ndesign = 'r.toml'\n\
        [task]\nspace = 'planar-position'\n[limits]\nlower_deg = [0, 0, 0]\n\
        upper_deg = [90, 90, 90]\n[estimator]\nmethod = 'hybrid'\n";
    const GRID: &str = "kind = 'optimise'\ndesign = 'r.toml'\n\
        [task]\nspace = 'planar-position'\n[estimator]\nmethod = 'hybrid'\n\
        [estimator.hybrid]\nsampling = 'grid'\ncell = 0.1\ncentres = true\nrule = 'paper'\n\
        tolerance_rad = 0.02\nmemory_limit_mb = 7\n";
    const MANIFOLDS: &str = "kind = 'manifolds'\ndesign = 'r.toml'\n\
        [task]\nspace = 'planar-position'\n[pose]\nposition = [1, 0.5]\n\
        [manifolds]\nresidual = 1e-9\n";

    const SINGULARITIES: &str = "kind = 'singularities'\ndesign = 'r.toml'\n\
        [task]\nspace = 'planar-position'\n[singularities]\nstarts = 7\n";
    const LARGEST: &str = "kind = 'largest-manifold'\ndesign = 'r.toml'\n\
        [task]\nspace = 'planar-position'\n[largest-manifold]\ncomparison = 0\n";
    const FAILURE: &str = "kind = 'failure-experiment'\ndesign = 'r.toml'\n\
        [task]\nspace = 'planar-position'\n[failure-experiment]\nstart_deg = [0, 0.1, 1e-3]\n\
        goals = [ { name = 'A \"b\"', theta_deg = [1, 2, 3] }, { name = 'C', theta_deg = [0, 0, 0] } ]\n";

    const TRAIN: &str = "kind = 'train'\ndesign = 'r.toml'\nseed = 9\n\
        [task]\nspace = 'planar-position'\nfailures = [2]\n[dataset]\ndesigns = 512\n\
        walk_share = 0.25\ncells = 7\nlink_lower = [0.5, 0.5, 0.5]\nlink_upper = [2, 2, 2]\n\
        [surrogate]\nmethod = 'mdn'\nwidths = [8]\nencoding = 'raw'\nclosed_forms = 'none'\n\
        [surrogate.mdn]\ncomponents = 3\nwrapped = false\nemptiness = false\n\
        decoder = 'sampling'\n[training]\nepochs = 3\nbatch = 64\nlearning_rate = 0.01\n\
        weight_decay = 0.0\npatience = 2\nmirror = false\n";
    const TRAIN_DEFAULTS: &str = "kind = 'train'\ndesign = 'r.toml'\n\
        [task]\nspace = 'planar-position'\n[surrogate]\nmethod = 'arcs'\n";

    #[test]
    fn the_study_as_run_means_the_same_from_its_own_folder() {
        let dir = tempfile::tempdir().unwrap();
        let robot = dir.path().join("r.toml");
        std::fs::write(robot, "name = 'r'\nlinks = [1, 1, 1]").unwrap();
        for text in [
            ESTIMATE,
            ASCENT,
            GENETIC,
            LATTICE,
            GRID,
            MANIFOLDS,
            SINGULARITIES,
            LARGEST,
            FAILURE,
            TRAIN,
            TRAIN_DEFAULTS,
        ] {
            let written = dir.path().join("study.toml");
            std::fs::write(&written, text).unwrap();
            let study = Study::load(&written).unwrap();
            let folder = dir.path().join("reports/x");
            let as_run = study.to_toml(&folder).unwrap();
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(folder.join("study.toml"), &as_run).unwrap();
            let again = Study::load(&folder.join("study.toml")).unwrap();
            assert_eq!(again, study, "{as_run}");
            assert_eq!(again.to_toml(&folder).unwrap(), as_run);
        }
    }

    #[test]
    fn every_default_is_written_out() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("s.toml");
        std::fs::write(dir.path().join("r.toml"), "name = 'r'\nlinks = [1, 1, 1]").unwrap();
        std::fs::write(&file, ASCENT).unwrap();
        let text = Study::load(&file).unwrap().to_toml(dir.path()).unwrap();
        for key in [
            "seed = 1",
            "failures = \"any\"",
            "margin_deg = 0",
            "restarts = 32",
            "figures = true",
        ] {
            assert!(text.contains(key), "{key} is not in\n{text}");
        }
    }
}
