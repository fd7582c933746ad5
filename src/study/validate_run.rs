//! Validates surrogates against exact workspaces, on designs that none of them has seen.

use super::run::{Ready, RunError, RunOptions};
use super::settings::Study;
use super::surrogate_settings::{ModelFile, Validate};
use super::train_report::{described, method};
use super::train_run::designs;
use super::validate_report::{Comparison, Judged, write};
use crate::diagnostic::{InputError, Problem};
use crate::surrogate::validation::{calibration, cases, score};
use crate::surrogate::{
    Card, Dataset, Draw, Model, Origin, Recipe, Region, Surrogate, SurrogateArm, UNIT, card_path,
};
use serde_json::{Value, json};
use std::hint::black_box;
use std::time::Instant;

/// Designs that are evaluated one by one to time a surrogate, and repetitions of a batch at least
/// this long.
const TIMED_ALONE: usize = 64;
const TIMED_SECONDS: f64 = 0.2;

/// Runs `study` and returns the content of `result.json`.
///
/// # Errors
/// The run was interrupted, the designs are training designs, or a file could not be written.
pub(super) fn run(
    study: &Study,
    validate: &Validate,
    options: &RunOptions,
    ready: Ready,
) -> Result<Value, RunError> {
    let mut surrogates = Vec::new();
    for file in &validate.models {
        surrogates.push(load(study, validate, file)?);
    }
    ready.begin(options)?;
    let session = &ready.session;
    let mut held_out: Vec<(SurrogateArm, Dataset)> = Vec::new();
    let mut judged = Vec::new();
    for (done, (name, card, model)) in surrogates.into_iter().enumerate() {
        let arm = model.arm().clone();
        if !held_out.iter().any(|(known, _)| *known == arm) {
            let recipe = recipe(validate, study.seed);
            let data = designs(&arm, &recipe, options, &ready)?.all();
            held_out.push((arm.clone(), data));
        }
        let Some((_, data)) = held_out.iter().find(|(known, _)| *known == arm) else {
            continue;
        };
        let all = validate.models.len() as u64;
        session.progress.update(done as u64, all, f64::NAN, &name);
        judged.push(judge(name, card, model, data));
    }
    let comparison = Comparison {
        study,
        validate,
        held_out: &held_out,
        judged: &judged,
        seconds: json!({ "total": session.store.seconds() }),
        threads: rayon::current_num_threads(),
    };
    let result = comparison.to_json();
    let written = write(&comparison, &result, options, &ready.study_toml);
    written.map_err(anyhow::Error::from)?;
    session.store.remove();
    Ok(result)
}

/// A surrogate by the name of its file, or of its report folder.
fn load(
    study: &Study,
    validate: &Validate,
    file: &ModelFile,
) -> Result<(String, Card, Model), RunError> {
    let card = Card::load(&card_path(&file.path)).map_err(anyhow::Error::from)?;
    let model = card.model(&file.path).map_err(anyhow::Error::from)?;
    // The seed may have been changed since the study was checked.
    if validate.draw == Draw::Training && card.data.recipe.seed == study.seed {
        let problem = Problem {
            message: "a surrogate cannot be validated on what it has learnt from".into(),
            found: format!("the training designs of seed {}", study.seed),
            expected: "designs that it has not seen".into(),
            help: "write `draw = \"held-out\"`, or choose another seed".into(),
        };
        return Err(InputError::in_file(&file.path.display().to_string(), problem).into());
    }
    let stem = file.path.file_stem().filter(|stem| *stem != "model");
    let folder = file.path.parent().and_then(|folder| folder.file_name());
    let name = stem.or(folder).map_or_else(
        || method(&card.architecture).to_owned(),
        |name| name.to_string_lossy().into_owned(),
    );
    Ok((name, card, model))
}

fn recipe(validate: &Validate, seed: u64) -> Recipe {
    let units = validate.designs.div_ceil(UNIT as u64);
    Recipe {
        seed,
        draw: validate.draw,
        uniform_units: units,
        walk_units: units,
        cells: 0,
        region: Region::Gate,
    }
}

fn judge(name: String, card: Card, model: Model, data: &Dataset) -> Judged {
    let judged = cases(&model, data);
    let largest = judged.iter().map(|case| case.exact);
    let largest = largest.fold(card.data.largest, f64::max);
    let of = |origin| score(&judged, data, origin, largest);
    Judged {
        uniform: of(Origin::Uniform),
        walk: of(Origin::Walk),
        calibration: calibration(&model, data),
        timing: timing(&model, data),
        described: described(&card.architecture),
        cases: judged,
        largest,
        name,
        card,
        model,
    }
}

/// Seconds per design on one thread: of the surrogate alone and in batches, and of the exact size
/// in the same run.
fn timing(model: &Model, data: &Dataset) -> [f64; 3] {
    let designs: Vec<_> = data
        .designs()
        .iter()
        .map(|design| design.design())
        .collect();
    let few = &designs[..designs.len().min(TIMED_ALONE)];
    let alone = |surrogate: &dyn Surrogate| {
        let one = |design| {
            black_box(surrogate.sizes(std::slice::from_ref(design)));
        };
        per_design(few.len(), || few.iter().for_each(one))
    };
    let batch = per_design(designs.len(), || {
        black_box(model.sizes(&designs));
    });
    [alone(model), batch, alone(model.arm())]
}

fn per_design(designs: usize, mut work: impl FnMut()) -> f64 {
    let started = Instant::now();
    let mut times = 0;
    loop {
        work();
        times += 1;
        let seconds = started.elapsed().as_secs_f64();
        if seconds >= TIMED_SECONDS {
            return seconds / f64::from(times) / designs.max(1) as f64;
        }
    }
}
