//! Trains a surrogate and writes its files and report.

use super::checkpoint::Stage;
use super::run::{Ready, RunError, RunOptions};
use super::settings::Study;
use super::surrogate_check;
use super::surrogate_settings::{DatasetSettings, DecoderKind, SurrogateMethod, Train};
use super::train_report::{Lesson, write};
use crate::report;
use crate::surrogate::validation::{cases, score};
use crate::surrogate::{
    self, Architecture, ArcsHead, BuildError, BuildOptions, Card, DataCard, Dataset, Decoder, Draw,
    Head, KeptBack, MixtureHead, Model, Origin, Parts, Recipe, SizeHead, SurrogateArm, Training,
    TrainingCard, TrainingError, TrainingSettings, UNIT, card_path, data_hash, weights_file,
};
use serde_json::{Value, json};
use std::sync::atomic::Ordering;
use std::time::Instant;

/// The weights' file in the report folder.
pub(super) const MODEL: &str = "model.safetensors";

/// Decoders before they are fitted.
const LEVEL: Decoder = Decoder::Level { share: 0.35 };

/// Runs `study` and returns the content of `result.json`.
///
/// # Errors
/// The run was interrupted, training diverged, or a file could not be written.
pub(super) fn run(
    study: &Study,
    train: &Train,
    options: &RunOptions,
    mut ready: Ready,
) -> Result<Value, RunError> {
    ready.begin(options)?;
    let saved = match ready.saved.take() {
        Some(Stage::Training(training)) => Some(*training),
        _ => None,
    };
    let session = &ready.session;
    let links = train.dataset.links.as_ref();
    let arm = surrogate_check::arm(&study.design, study.task, &study.failures, links)
        .ok_or_else(|| anyhow::anyhow!("surrogates are for planar arms"))?;
    let architecture = architecture(train, &arm);
    let recipe = recipe(&train.dataset, &architecture, study.seed);
    let started = Instant::now();
    let parts = designs(&arm, &recipe, options, &ready)?;
    let built = started.elapsed().as_secs_f64();
    let architecture = scaled(architecture, &parts.training);
    let settings = settings(train, study.seed);
    let lesson = surrogate::Lesson::new(&arm, &architecture, settings, &parts)
        .map_err(anyhow::Error::from)?;
    let training = learn(&lesson, saved, &ready)?;
    let learnt = started.elapsed().as_secs_f64() - built;
    session
        .progress
        .update(0, 1, f64::NAN, "judging on kept-back designs");
    let model = model(train, &arm, &architecture, &training, &parts)?;
    let card = card(study, &model, &training, settings, &recipe, &parts)?;
    let seconds = json!({
        "total": session.store.seconds(),
        "labels": built,
        "training": learnt,
    });
    let bytes = weights_file(model.network())?;
    let path = options.out.join(MODEL);
    report::write_bytes(&path, &bytes).map_err(anyhow::Error::from)?;
    let text = toml::to_string(&card).map_err(anyhow::Error::from)?;
    report::write_text(&card_path(&path), &text).map_err(anyhow::Error::from)?;
    let lesson = Lesson {
        study,
        card: &card,
        training: &training,
        seconds,
        threads: rayon::current_num_threads(),
    };
    let result = lesson.to_json();
    write(&lesson, &result, options, &ready.study_toml).map_err(anyhow::Error::from)?;
    session.store.remove();
    Ok(result)
}

fn architecture(train: &Train, arm: &SurrogateArm) -> Architecture {
    let settings = &train.surrogate;
    let head = match (settings.method, &settings.mdn, &settings.arcs) {
        (SurrogateMethod::Mdn, Some(mdn), _) => Head::Mdn(MixtureHead {
            components: mdn.components as usize,
            wrapped: mdn.wrapped,
            emptiness: mdn.emptiness,
        }),
        (SurrogateMethod::Arcs, _, Some(arcs)) => Head::Arcs(ArcsHead {
            harmonics: arcs.harmonics as usize,
        }),
        _ => Head::Size(SizeHead {
            pose: arm.pose,
            scale: 1.0,
        }),
    };
    Architecture {
        head,
        widths: settings
            .widths
            .iter()
            .map(|&width| width as usize)
            .collect(),
        encoding: settings.encoding,
        closed_forms: settings.closed_forms,
    }
}

/// The architecture with the unit of errors that the data suggests.
fn scaled(architecture: Architecture, training: &Dataset) -> Architecture {
    let head = match architecture.head {
        Head::Size(head) => Head::Size(SizeHead {
            scale: largest(training).map_or(1.0, |(size, _)| size),
            ..head
        }),
        other => other,
    };
    Architecture {
        head,
        ..architecture
    }
}

/// The largest S_F with its design's index, if any is positive.
fn largest(dataset: &Dataset) -> Option<(f64, usize)> {
    let sizes = dataset.designs().iter().map(|design| design.size).zip(0..);
    let best = sizes.max_by(|a, b| a.0.total_cmp(&b.0));
    best.filter(|(size, _)| *size > 0.0)
}

fn recipe(dataset: &DatasetSettings, architecture: &Architecture, seed: u64) -> Recipe {
    let units = dataset.designs.div_ceil(UNIT as u64);
    let walk_units = (units as f64 * dataset.walk_share).round() as u64;
    Recipe {
        seed,
        draw: Draw::Training,
        uniform_units: units - walk_units,
        walk_units,
        cells: match architecture.has_cells() {
            true => dataset.cells as usize,
            false => 0,
        },
        region: architecture.region(),
    }
}

fn settings(train: &Train, seed: u64) -> TrainingSettings {
    let training = &train.training;
    TrainingSettings {
        seed,
        epochs: training.epochs,
        batch: training.batch as usize,
        learning_rate: training.learning_rate,
        weight_decay: training.weight_decay,
        patience: training.patience,
        mirror: training.mirror,
    }
}

/// The labelled designs, from the cache as far as they are there.
pub(super) fn designs(
    arm: &SurrogateArm,
    recipe: &Recipe,
    options: &RunOptions,
    ready: &Ready,
) -> Result<Parts, RunError> {
    let session = &ready.session;
    let tell = |done, all| {
        session
            .progress
            .update(done, all, f64::NAN, "labelling designs");
    };
    let options = BuildOptions {
        cache: options.cache.as_deref(),
        interrupt: &session.interrupt,
        on_progress: &tell,
    };
    surrogate::load_or_build(arm, recipe, &options).map_err(|error| match error {
        BuildError::Interrupted => RunError::Interrupted,
        error => RunError::Failed(error.into()),
    })
}

/// Trains until all epochs are done or patience ends; the state is stored after every epoch.
fn learn(
    lesson: &surrogate::Lesson,
    saved: Option<Training>,
    ready: &Ready,
) -> Result<Training, RunError> {
    let session = &ready.session;
    let mut training = saved.unwrap_or_else(|| Training::new(lesson));
    while !training.is_done(lesson) {
        if session.interrupt.load(Ordering::Relaxed) {
            session.store.save(stage(&training))?;
            return Err(RunError::Interrupted);
        }
        let loss = training.history().last().map(|epoch| epoch.kept_back_loss);
        let done = training.history().len() as u64;
        let message = match loss {
            Some(loss) => format!("training, loss on kept-back designs {loss:.6}"),
            None => "training".into(),
        };
        let tell = &session.progress;
        tell.update(done, lesson.epochs(), f64::NAN, &message);
        match training.epoch(lesson) {
            Ok(_) => session.store.save_if_due(|| stage(&training))?,
            Err(error @ TrainingError::Diverged { .. }) => {
                session.store.save(stage(&training))?;
                return Err(anyhow::anyhow!(
                    "{error}: the loss is no longer finite. The state before it is kept in the \
                     checkpoint; lower `learning_rate` in `[training]` and start again with \
                     `--overwrite`"
                )
                .into());
            }
            Err(error) => return Err(anyhow::Error::from(error).into()),
        }
    }
    Ok(training)
}

fn stage(training: &Training) -> Stage {
    Stage::Training(Box::new(training.clone()))
}

/// The model of the best epoch with a fitted decoder.
fn model(
    train: &Train,
    arm: &SurrogateArm,
    architecture: &Architecture,
    training: &Training,
    parts: &Parts,
) -> Result<Model, RunError> {
    let kind = train.surrogate.mdn.map(|mdn| mdn.decoder);
    let decoder = match kind {
        Some(DecoderKind::Sampling) => Decoder::Sampling(Default::default()),
        _ => LEVEL,
    };
    let network = training.best().clone();
    let model = Model::new(arm, architecture, network, decoder).map_err(anyhow::Error::from)?;
    let fitted = surrogate::fitted(&model, &parts.kept_back, &decoder);
    Ok(model.with_decoder(fitted))
}

fn card(
    study: &Study,
    model: &Model,
    training: &Training,
    settings: TrainingSettings,
    recipe: &Recipe,
    parts: &Parts,
) -> Result<Card, RunError> {
    let arm = surrogate::Surrogate::arm(model);
    let weights = weights_file(model.network())?;
    let (size, index) = largest(&parts.training).unwrap_or((0.0, 0));
    let best = parts.training.designs()[index].design();
    let ends = |of: fn(&crate::workspace::JointLimit) -> f64| -> Vec<f64> {
        let joints = best.limits.joints().iter();
        joints.map(|limit| of(limit).to_degrees()).collect()
    };
    let judged = cases(model, &parts.kept_back);
    let of = |origin| score(&judged, &parts.kept_back, origin, size);
    let empty = |origin| parts.training.emptiness(arm, origin).into();
    let best_epoch = training.best_epoch().copied();
    Ok(Card {
        format: Card::FORMAT,
        version: env!("CARGO_PKG_VERSION").into(),
        robot: study.design.robot.name.clone(),
        design_sha256: study.design.sha256.clone(),
        weights_sha256: surrogate::sha256(&weights),
        arm: arm.clone(),
        architecture: model.architecture().clone(),
        decoder: *model.decoder(),
        data: DataCard {
            hash: data_hash(arm, recipe),
            recipe: recipe.clone(),
            largest: size,
            largest_lower_deg: ends(|limit| limit.lower),
            largest_upper_deg: ends(|limit| limit.upper),
            largest_lengths: best.lengths.clone(),
            uniform: empty(Origin::Uniform),
            walk: empty(Origin::Walk),
        },
        training: TrainingCard {
            settings,
            epochs: training.history().len() as u64,
            best: best_epoch.ok_or_else(|| anyhow::anyhow!("no epoch was run"))?,
        },
        kept_back: KeptBack {
            uniform: of(Origin::Uniform),
            walk: of(Origin::Walk),
        },
    })
}
