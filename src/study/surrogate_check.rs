//! Checks the tables of studies with neural surrogates against the robot and the files they name.

use super::file::StudyFile;
use super::limits;
use super::serve;
use super::settings::{Design, LinkBounds};
use super::surrogate_settings::{ModelFile, SurrogateEstimator, Train, Validate};
use crate::design::TaskSpace;
use crate::diagnostic::{Item, Place, Problem, Problems};
use crate::surrogate::{Card, Draw, ModelError, SurrogateArm, card_path};
use crate::workspace::FailureSet;
use std::path::Path;

/// What a study asks of surrogates is about this robot and task.
pub(super) struct Subject<'a> {
    pub file: &'a StudyFile,
    pub problems: &'a Problems<'a>,
    pub design: &'a Design,
    pub failures: &'a FailureSet,
}

/// The arm of a robot and task that the exact estimator serves.
pub(super) fn arm(
    design: &Design,
    task: TaskSpace,
    failures: &FailureSet,
    links: Option<&LinkBounds>,
) -> Option<SurrogateArm> {
    let bounds = |links: &LinkBounds| {
        let pairs = links.link_lower.iter().zip(&links.link_upper);
        pairs.map(|(&lower, &upper)| [lower, upper]).collect()
    };
    Some(SurrogateArm {
        lengths: design.robot.planar_chain().ok()?.lengths,
        link_bounds: links.map(bounds),
        pose: task == TaskSpace::PlanarPose,
        failures: failures.clone(),
    })
}

impl Subject<'_> {
    fn arm(&self, links: Option<&LinkBounds>) -> Option<SurrogateArm> {
        arm(self.design, self.file.space.value, self.failures, links)
    }

    /// The settings of a study that trains.
    pub fn train(&self) -> Option<Train> {
        serve::check_surrogate(self.file, self.problems, &self.design.robot);
        let table = self.file.train.as_ref()?;
        let mut train = table.settings.clone();
        train.dataset.links = limits::bounds(
            &table.link_lower,
            &table.link_upper,
            self.problems,
            &self.design.robot,
        );
        Some(train)
    }

    /// The settings of a study that validates.
    pub fn validate(&self) -> Option<Validate> {
        serve::check_surrogate(self.file, self.problems, &self.design.robot);
        let Some(item) = &self.file.validate else {
            let place = Place {
                key: "validate".into(),
                span: 0..0,
            };
            let problem = Problem {
                message: "a validation needs surrogates".into(),
                found: "no table `[validate]`".into(),
                expected: "`models`, the files of trained surrogates".into(),
                help: "add `[validate]` with `models = [\"../reports/x/model.safetensors\"]`"
                    .into(),
            };
            self.problems.report_absent(&place, problem);
            return None;
        };
        let table = &item.value;
        if table.models.value.is_empty() {
            self.problems.reject(
                &table.models.place,
                "there is no surrogate to validate",
                "at least one file",
                "name a file that `kind = \"train\"` has written",
            );
        }
        let draw = table.draw.as_ref();
        let mut models = Vec::new();
        for entry in &table.models.value {
            let (model, card) = self.model(entry)?;
            let training = draw.filter(|draw| draw.value == Draw::Training);
            let seed = self.file.seed.unwrap_or(1);
            if let Some(item) = training.filter(|_| card.data.recipe.seed == seed) {
                let problem = Problem {
                    message: "a surrogate cannot be validated on what it has learnt from".into(),
                    found: format!(
                        "the training designs of seed {seed}, with which `{}` was trained",
                        entry.value
                    ),
                    expected: "designs that it has not seen".into(),
                    help: "write `draw = \"held-out\"`, or choose another `seed`".into(),
                };
                self.problems.report(&item.place, problem);
            }
            models.push(model);
        }
        Some(Validate {
            models,
            designs: table.designs,
            draw: draw.map_or(Draw::HeldOut, |item| item.value),
        })
    }

    /// The surrogate that scores a search; `links` are the lengths that are searched too.
    pub fn estimator(&self, links: Option<&LinkBounds>) -> Option<SurrogateEstimator> {
        let Some(table) = &self.file.estimator.surrogate else {
            let place = Place {
                key: "estimator.surrogate".into(),
                span: 0..0,
            };
            let problem = Problem {
                message: "the estimator \"surrogate\" needs a trained surrogate".into(),
                found: "no table `[estimator.surrogate]`".into(),
                expected: "`model`, a file that `kind = \"train\"` has written".into(),
                help: "add `[estimator.surrogate]` with \
                       `model = \"../reports/x/model.safetensors\"`"
                    .into(),
            };
            self.problems.report_absent(&place, problem);
            return None;
        };
        let (model, card) = self.model(&table.model)?;
        if let Some(error) = self.arm(links).and_then(|arm| card.check_arm(&arm).err()) {
            self.report(&table.model, &error);
        }
        Some(SurrogateEstimator {
            model,
            polish: table.polish,
            compare: table.compare,
        })
    }

    /// A surrogate's file, checked to be whole and for this robot and task.
    fn model(&self, entry: &Item<String>) -> Option<(ModelFile, Card)> {
        let study = Path::new(self.problems.source().file());
        let folder = study.parent().unwrap_or(Path::new(""));
        let path = folder.join(&entry.value);
        let path = path.canonicalize().unwrap_or(path);
        let card = Card::load(&card_path(&path));
        let checked = card.and_then(|card| {
            if let Some(arm) = self.arm(None) {
                card.check_arm(&arm)?;
            }
            card.model(&path)?;
            Ok(card)
        });
        match checked {
            Ok(card) => {
                let sha256 = card.weights_sha256.clone();
                Some((ModelFile { path, sha256 }, card))
            }
            Err(error) => {
                self.report(entry, &error);
                None
            }
        }
    }

    fn report(&self, entry: &Item<String>, error: &ModelError) {
        let help = match error {
            ModelError::Unreadable { .. } => {
                "the path is relative to the study file; run the study that trains it first"
            }
            ModelError::NoCard { .. } | ModelError::Weights { .. } => {
                "run the study that trains it again"
            }
            ModelError::Version { .. } => "train it again with this version",
            ModelError::Foreign { .. } => "train one for this robot, task and failures",
        };
        let problem = Problem {
            message: "the surrogate cannot be used".into(),
            found: error.to_string(),
            expected: "the weights of a surrogate for this robot and task, with its card".into(),
            help: help.into(),
        };
        self.problems.report(&entry.place, problem);
    }
}
