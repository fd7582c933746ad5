//! The tables `[search]` and `[optimiser]` of a study file as written.

use super::file::MAX_LENGTH;
use super::settings::{CoordinateAscent, Genetic};
use crate::diagnostic::{Item, Table};

/// The table `[search]`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SearchTable {
    pub min_width_deg: Option<Item<f64>>,
    pub link_lower: Option<Item<Vec<Item<f64>>>>,
    pub link_upper: Option<Item<Vec<Item<f64>>>>,
}

/// The table `[optimiser]` with one sub-table per method.
///
/// Both sub-tables may stand in a file, so that changing `method` is all it takes to compare.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OptimiserTable {
    pub method: Method,
    pub coordinate_ascent: CoordinateAscent,
    pub genetic: Genetic,
    /// Where `elite` and `tournament` stand: they are limited by `population`.
    pub elite: Option<Item<u64>>,
    pub tournament: Option<Item<u64>>,
    /// Whether the file gives `restarts`: the default depends on what a score costs.
    pub restarts_given: bool,
    /// Whether the file names the genetic algorithm's population.
    pub population_given: bool,
}

/// The optimiser's `method`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Method {
    CoordinateAscent,
    Genetic,
}

/// Upper bound of counts that allocate memory or multiply the work.
const MANY: u64 = 1_000_000;

/// Reads `[search]`.
pub(super) fn read_search(root: &Table) -> Option<Item<SearchTable>> {
    let table = root.table("search", &["min_width_deg", "link_lower", "link_upper"])?;
    let lengths = |key| table.numbers(key, -MAX_LENGTH..=MAX_LENGTH, " m");
    let search = SearchTable {
        min_width_deg: table.number("min_width_deg", 0.0..=360.0, " degrees"),
        link_lower: lengths("link_lower"),
        link_upper: lengths("link_upper"),
    };
    Some(Item {
        value: search,
        place: root.key_place("search")?,
    })
}

/// Reads `[optimiser]` and its sub-tables.
pub(super) fn read_optimiser(root: &Table) -> Option<Item<OptimiserTable>> {
    let table = root.table("optimiser", &["method", "coordinate-ascent", "genetic"])?;
    let methods = [
        ("coordinate-ascent", Method::CoordinateAscent),
        ("genetic", Method::Genetic),
    ];
    let method = table.choice("method", &methods);
    let ascent = table.table(
        "coordinate-ascent",
        &[
            "restarts",
            "line_samples",
            "scout_sweeps",
            "finalists",
            "max_sweeps",
            "tolerance",
        ],
    );
    let genetic = table.table(
        "genetic",
        &[
            "population",
            "generations",
            "elite",
            "tournament",
            "crossover_rate",
            "mutation_rate",
            "patience",
            "polish",
        ],
    );
    let restarts = ascent.as_ref().and_then(|table| table.entry("restarts"));
    let population = genetic.as_ref().and_then(|table| table.entry("population"));
    let optimiser = OptimiserTable {
        restarts_given: restarts.is_some(),
        population_given: population.is_some(),
        method: method.map_or(Method::CoordinateAscent, |item| item.value),
        coordinate_ascent: ascent.as_ref().map(read_ascent).unwrap_or_default(),
        genetic: genetic.as_ref().map(read_genetic).unwrap_or_default(),
        elite: genetic.as_ref().and_then(|t| t.integer("elite", 0..=MANY)),
        tournament: genetic.and_then(|t| t.integer("tournament", 1..=MANY)),
    };
    Some(Item {
        value: optimiser,
        place: root.key_place("optimiser")?,
    })
}

fn read_ascent(table: &Table) -> CoordinateAscent {
    let default = CoordinateAscent::default();
    let count = |key, least, default| {
        let item = table.integer(key, least..=MANY);
        item.map_or(default, |item| item.value)
    };
    CoordinateAscent {
        restarts: count("restarts", 1, default.restarts),
        line_samples: count("line_samples", 4, default.line_samples),
        scout_sweeps: count("scout_sweeps", 1, default.scout_sweeps),
        finalists: count("finalists", 1, default.finalists),
        max_sweeps: count("max_sweeps", 1, default.max_sweeps),
        tolerance: table
            .number("tolerance", 0.0..=1.0, "")
            .map_or(default.tolerance, |item| item.value),
    }
}

fn read_genetic(table: &Table) -> Genetic {
    let default = Genetic::default();
    let count = |key, least, default| {
        let item = table.integer(key, least..=MANY);
        item.map_or(default, |item| item.value)
    };
    let rate = |key, default| {
        let item = table.number(key, 0.0..=1.0, "");
        item.map_or(default, |item| item.value)
    };
    Genetic {
        population: count("population", 4, default.population),
        generations: count("generations", 1, default.generations),
        elite: count("elite", 0, default.elite),
        tournament: count("tournament", 1, default.tournament),
        crossover_rate: rate("crossover_rate", default.crossover_rate),
        mutation_rate: rate("mutation_rate", default.mutation_rate),
        patience: count("patience", 1, default.patience),
        polish: table
            .boolean("polish")
            .map_or(default.polish, |item| item.value),
    }
}
