//! The tables of studies with neural surrogates, read as written.

use super::file::MAX_LENGTH;
use super::surrogate_settings::{DecoderKind, SurrogateMethod, Train};
use crate::diagnostic::{Item, Table};
use crate::surrogate::{ClosedForms, Draw, Encoding, UNIT};

/// Fewest designs: one unit of each origin to keep back and one to learn from.
const LEAST_DESIGNS: u64 = 4 * UNIT as u64;

/// Most designs; their labels would not fit any memory.
const MOST_DESIGNS: u64 = 20_000_000;

/// Widest layer, most layers.
const WIDEST: u64 = 4096;
const DEEPEST: usize = 16;

/// The tables of a study that trains.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TrainTable {
    /// Everything but the link bounds.
    pub settings: Train,
    pub link_lower: Option<Item<Vec<Item<f64>>>>,
    pub link_upper: Option<Item<Vec<Item<f64>>>>,
}

/// `[validate]` as written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ValidateTable {
    pub models: Item<Vec<Item<String>>>,
    pub designs: u64,
    pub draw: Option<Item<Draw>>,
}

/// `[estimator.surrogate]` as written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SurrogateEstimatorTable {
    pub model: Item<String>,
    pub polish: bool,
    pub compare: bool,
}

/// Reads `[dataset]`, `[surrogate]` and `[training]`; what is missing has its default.
pub(super) fn read_train(root: &Table) -> Option<TrainTable> {
    let surrogate = root.table(
        "surrogate",
        &[
            "method",
            "widths",
            "encoding",
            "closed_forms",
            "mdn",
            "arcs",
        ],
    );
    let method = surrogate.as_ref().and_then(read_method);
    let mut settings = Train::defaults(method.unwrap_or(SurrogateMethod::Arcs));
    if let Some(table) = &surrogate {
        read_surrogate(table, &mut settings)?;
    }
    let dataset = root.table(
        "dataset",
        &["designs", "walk_share", "cells", "link_lower", "link_upper"],
    );
    if let Some(table) = &dataset {
        let data = &mut settings.dataset;
        set(
            &mut data.designs,
            table.integer("designs", LEAST_DESIGNS..=MOST_DESIGNS),
        );
        set(
            &mut data.walk_share,
            table.number("walk_share", 0.0..=1.0, ""),
        );
        set(&mut data.cells, table.integer("cells", 1..=1024));
    }
    if let Some(table) = root.table(
        "training",
        &[
            "epochs",
            "batch",
            "learning_rate",
            "weight_decay",
            "patience",
            "mirror",
        ],
    ) {
        let training = &mut settings.training;
        set(&mut training.epochs, table.integer("epochs", 1..=100_000));
        set(&mut training.batch, table.integer("batch", 1..=65_536));
        set(
            &mut training.learning_rate,
            table.number("learning_rate", 1e-9..=1e3, ""),
        );
        set(
            &mut training.weight_decay,
            table.number("weight_decay", 0.0..=1.0, ""),
        );
        set(
            &mut training.patience,
            table.integer("patience", 1..=100_000),
        );
        set(&mut training.mirror, table.boolean("mirror"));
    }
    let lengths = |key| {
        let table = dataset.as_ref()?;
        table.numbers(key, -MAX_LENGTH..=MAX_LENGTH, " m")
    };
    Some(TrainTable {
        link_lower: lengths("link_lower"),
        link_upper: lengths("link_upper"),
        settings,
    })
}

fn read_method(table: &Table) -> Option<SurrogateMethod> {
    table.require("method", "method = \"arcs\"");
    let methods = [
        ("mdn", SurrogateMethod::Mdn),
        ("arcs", SurrogateMethod::Arcs),
        ("size", SurrogateMethod::Size),
    ];
    table.choice("method", &methods).map(|item| item.value)
}

fn read_surrogate(table: &Table, settings: &mut Train) -> Option<()> {
    let surrogate = &mut settings.surrogate;
    if let Some(entry) = table.entry("widths") {
        let entries = entry.array("an array of layer widths, e.g. `[128, 128, 128]`")?;
        let widths = entries.iter().map(|entry| entry.integer(1..=WIDEST));
        let widths: Vec<_> = widths.collect::<Option<_>>()?;
        if widths.len() > DEEPEST {
            let expected = format!("at most {DEEPEST} hidden layers");
            let problems = table.problems();
            problems.reject(entry.place(), "too many layers", &expected, "remove some");
            return None;
        }
        surrogate.widths = widths.into_iter().map(|item| item.value).collect();
    }
    let encodings = [
        ("raw", Encoding::Raw),
        ("trigonometric", Encoding::Trigonometric),
    ];
    set(
        &mut surrogate.encoding,
        table.choice("encoding", &encodings),
    );
    let forms = [
        ("none", ClosedForms::None),
        ("gate", ClosedForms::Gate),
        ("post-failure", ClosedForms::PostFailure),
    ];
    let method = surrogate.method;
    match (method, table.choice("closed_forms", &forms)) {
        (SurrogateMethod::Size, Some(item)) if item.value != ClosedForms::Gate => {
            table.problems().reject(
                &item.place,
                "the method \"size\" always uses the closed-form radii",
                "\"gate\"",
                "remove the key",
            );
        }
        (_, item) => set(&mut surrogate.closed_forms, item),
    }
    let own = |key: &str, known: &[&str], of: SurrogateMethod| {
        let part = table.table(key, known)?;
        if method != of {
            let message = format!(
                "this table has no meaning for the method \"{}\"",
                name(method)
            );
            let expected = format!("`[surrogate.{key}]` only with `method = \"{key}\"`");
            let help = "remove the table, or change the method";
            table
                .problems()
                .reject(part.place(), &message, &expected, help);
        }
        Some(part)
    };
    let keys = ["components", "wrapped", "emptiness", "decoder"];
    if let (Some(part), Some(mdn)) = (own("mdn", &keys, SurrogateMethod::Mdn), &mut surrogate.mdn) {
        set(&mut mdn.components, part.integer("components", 1..=64));
        set(&mut mdn.wrapped, part.boolean("wrapped"));
        set(&mut mdn.emptiness, part.boolean("emptiness"));
        let decoders = [
            ("level", DecoderKind::Level),
            ("sampling", DecoderKind::Sampling),
        ];
        set(&mut mdn.decoder, part.choice("decoder", &decoders));
    }
    let part = own("arcs", &["harmonics"], SurrogateMethod::Arcs);
    if let (Some(part), Some(arcs)) = (part, &mut surrogate.arcs) {
        set(&mut arcs.harmonics, part.integer("harmonics", 1..=128));
    }
    Some(())
}

fn name(method: SurrogateMethod) -> &'static str {
    match method {
        SurrogateMethod::Mdn => "mdn",
        SurrogateMethod::Arcs => "arcs",
        SurrogateMethod::Size => "size",
    }
}

/// Reads `[validate]`.
pub(super) fn read_validate(root: &Table) -> Option<Item<ValidateTable>> {
    let table = root.table("validate", &["models", "designs", "draw"])?;
    table.require("models", "models = [\"../reports/x/model.safetensors\"]");
    let draws = [("held-out", Draw::HeldOut), ("training", Draw::Training)];
    let designs = table.integer("designs", UNIT as u64..=MOST_DESIGNS);
    let draw = table.choice("draw", &draws);
    let entry = table.entry("models")?;
    let entries = entry.array("an array of files, e.g. `[\"model.safetensors\"]`")?;
    let models: Option<Vec<_>> = entries.iter().map(|entry| entry.text()).collect();
    let value = ValidateTable {
        models: entry.item(models?),
        designs: designs.map_or(448, |item| item.value),
        draw,
    };
    Some(Item {
        value,
        place: root.key_place("validate")?,
    })
}

/// Reads `[estimator.surrogate]`.
pub(super) fn read_estimator(estimator: &Table) -> Option<SurrogateEstimatorTable> {
    let table = estimator.table("surrogate", &["model", "polish", "compare"])?;
    table.require("model", "model = \"../reports/x/model.safetensors\"");
    let flag = |key| table.boolean(key).is_none_or(|item| item.value);
    let (polish, compare) = (flag("polish"), flag("compare"));
    Some(SurrogateEstimatorTable {
        model: table.text("model")?,
        polish,
        compare,
    })
}

fn set<T>(value: &mut T, item: Option<Item<T>>) {
    if let Some(item) = item {
        *value = item.value;
    }
}
