//! The table `[synthesis]`: read as written, then filled in beside the robot.

use super::file::{MAX_DEGREES, MAX_LENGTH};
use super::synthesis_objectives;
use super::synthesis_settings::{
    Effort, Family, ParameterRange, RobotSearch, RowRange, SLICES, SynthesisStudy,
};
use crate::design::TaskSpace;
use crate::diagnostic::{Entry, Item, Place, Problems, Table};
use crate::synthesis::{Column, LinkSpace, Merit};

/// The table as written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SynthesisTable {
    pub objectives: Option<Item<Vec<Item<Merit>>>>,
    pub joints: Option<Item<u64>>,
    method: Option<Item<RobotSearch>>,
    family: Option<Item<Family>>,
    reach: Option<f64>,
    include_design: Option<Item<bool>>,
    min_width_deg: Option<f64>,
    max_length: Option<f64>,
    min_fill: Option<f64>,
    min_pre_failure_share: Option<f64>,
    min_share: Option<f64>,
    round_length: Option<f64>,
    round_limit_deg: Option<f64>,
    tolerance: Option<f64>,
    tolerance_deg: Option<f64>,
    slices: Option<u64>,
    effort: Effort,
    pub links: Option<Item<Vec<RowTable>>>,
}

/// A row as written: what is left out comes from the family.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RowTable {
    alpha_deg: Option<Item<ParameterRange>>,
    a: Option<Item<ParameterRange>>,
    d: Option<Item<ParameterRange>>,
}

const KEYS: &[&str] = &[
    "objectives",
    "joints",
    "method",
    "family",
    "reach",
    "include_design",
    "min_width_deg",
    "max_length",
    "min_fill",
    "min_pre_failure_share",
    "min_share",
    "round_length",
    "round_limit_deg",
    "tolerance",
    "tolerance_deg",
    "slices",
    "effort",
    "screened",
    "screening_samples",
    "runs",
    "trial_generations",
    "full_runs",
    "generations",
    "population",
    "samples",
    "patience",
    "fit_samples",
    "selection_samples",
    "report_samples",
    "check_poses",
    "sensitivity_samples",
    "links",
];

/// Most random robots, generations and robots a generation: more would take weeks.
const MOST: u64 = 1_000_000;
/// Most task points of any kind.
const MOST_SAMPLES: u64 = 10_000_000;
/// Fewest task points from which anything can be told.
const FEWEST_SAMPLES: u64 = 64;

/// Default reach, metres.
const REACH: f64 = 1.0;
/// Default bounds, in reaches, and shares.
const MOST_LENGTH: f64 = 1.8;
const LONGEST: f64 = 0.5;
const LEAST_FILL: f64 = 0.25;
const LEAST_PRE_FAILURE: f64 = 0.3;
/// Default narrowest limits, degrees.
const MIN_WIDTH: f64 = 20.0;
/// Default manufacturing tolerances: of lengths in reaches, of angles in degrees.
const TOLERANCE: f64 = 0.001;
const TOLERANCE_DEG: f64 = 0.5;

/// Reads `[synthesis]`.
pub(super) fn read(root: &Table) -> Option<Item<SynthesisTable>> {
    let table = root.table("synthesis", KEYS)?;
    let number = |key, range, unit| table.number(key, range, unit).map(|item| item.value);
    let share = |key| number(key, 0.0..=0.99, "");
    let links = table.entry("links").and_then(|entry| {
        let rows = entry.array("an array of rows, one per joint, each `{ a = …, d = … }`")?;
        let rows: Vec<_> = rows.iter().map(read_row).collect();
        Some(entry.item(rows.into_iter().collect::<Option<_>>()?))
    });
    let value = SynthesisTable {
        objectives: synthesis_objectives::read(&table),
        joints: table.integer("joints", 3..=32),
        method: table.choice(
            "method",
            &[
                ("cma-es", RobotSearch::CmaEs),
                ("genetic", RobotSearch::Genetic),
            ],
        ),
        family: table.choice(
            "family",
            &[
                ("right-angles", Family::RightAngles),
                ("general", Family::General),
                ("design", Family::Design),
            ],
        ),
        reach: number("reach", 1e-3..=1e3, " m"),
        include_design: table.boolean("include_design"),
        min_width_deg: number("min_width_deg", 0.0..=360.0, " degrees"),
        max_length: number("max_length", 1e-3..=MAX_LENGTH, " m"),
        min_fill: share("min_fill"),
        min_pre_failure_share: share("min_pre_failure_share"),
        min_share: share("min_share"),
        round_length: number("round_length", 0.0..=MAX_LENGTH, " m"),
        round_limit_deg: number("round_limit_deg", 0.0..=30.0, " degrees"),
        tolerance: number("tolerance", 0.0..=MAX_LENGTH, " m"),
        tolerance_deg: number("tolerance_deg", 0.0..=30.0, " degrees"),
        slices: table.integer("slices", 4..=256).map(|item| item.value),
        effort: read_effort(&table),
        links,
    };
    Some(Item {
        value,
        place: root.key_place("synthesis")?,
    })
}

fn read_effort(table: &Table) -> Effort {
    let presets = [
        ("quick", Effort::QUICK),
        ("usual", Effort::USUAL),
        ("thorough", Effort::THOROUGH),
    ];
    let preset = table.choice("effort", &presets);
    let mut effort = preset.map_or(Effort::USUAL, |item| item.value);
    let set = |key, range, value: &mut u64| {
        if let Some(item) = table.integer(key, range) {
            *value = item.value;
        }
    };
    let samples = FEWEST_SAMPLES..=MOST_SAMPLES;
    set("screened", 1..=MOST, &mut effort.screened);
    set(
        "screening_samples",
        samples.clone(),
        &mut effort.screening_samples,
    );
    set("runs", 1..=100, &mut effort.runs);
    set("trial_generations", 1..=MOST, &mut effort.trial_generations);
    set("full_runs", 1..=99, &mut effort.full_runs);
    set("generations", 1..=MOST, &mut effort.generations);
    set("population", 4..=10_000, &mut effort.population);
    set("samples", samples.clone(), &mut effort.samples);
    set("patience", 5..=MOST, &mut effort.patience);
    set("fit_samples", samples.clone(), &mut effort.fit_samples);
    let measured = 1024..=MOST_SAMPLES;
    set(
        "selection_samples",
        measured.clone(),
        &mut effort.selection_samples,
    );
    set("report_samples", measured, &mut effort.report_samples);
    set("check_poses", 0..=MOST, &mut effort.check_poses);
    set(
        "sensitivity_samples",
        0..=MOST_SAMPLES,
        &mut effort.sensitivity_samples,
    );
    effort
}

fn read_row(entry: &Entry) -> Option<RowTable> {
    let table = entry.table(&["alpha_deg", "a", "d"])?;
    let parameter = |key, most, unit| {
        let entry = table.entry(key)?;
        read_parameter(&entry, most, unit, table.problems())
    };
    Some(RowTable {
        alpha_deg: parameter("alpha_deg", MAX_DEGREES, " degrees"),
        a: parameter("a", MAX_LENGTH, " m"),
        d: parameter("d", MAX_LENGTH, " m"),
    })
}

/// A number, an array of numbers, or `{ min = …, max = … }`.
fn read_parameter(
    entry: &Entry,
    most: f64,
    unit: &str,
    problems: &Problems,
) -> Option<Item<ParameterRange>> {
    if entry.is_array() {
        let values = entry.array("an array of numbers")?;
        if values.is_empty() {
            let (expected, help) = ("at least one number", "name the values to choose from");
            problems.reject(
                entry.place(),
                "there is nothing to choose from",
                expected,
                help,
            );
            return None;
        }
        let read: Vec<_> = values
            .iter()
            .map(|v| v.number(-most..=most, unit))
            .collect();
        let values = read.into_iter().collect::<Option<Vec<_>>>()?;
        let values = values.into_iter().map(|item| item.value).collect();
        return Some(entry.item(ParameterRange::OneOf(values)));
    }
    if entry.is_table() {
        let table = entry.table(&["min", "max"])?;
        table.require("min", "min = 0.0");
        table.require("max", "max = 0.5");
        let [min, max] = ["min", "max"].map(|key| table.number(key, -most..=most, unit));
        let (min, max) = (min?, max?);
        if min.value > max.value {
            let help = "swap the two";
            problems.reject(&max.place, "`max` is less than `min`", "min ≤ max", help);
            return None;
        }
        let (min, max) = (min.value, max.value);
        return Some(entry.item(ParameterRange::Between { min, max }));
    }
    let value = entry.number(-most..=most, unit)?;
    Some(entry.item(ParameterRange::Fixed(value.value)))
}

/// The study's settings: the table with its defaults, for robots with as many joints as the
/// design.
pub(super) fn settings(
    item: Option<&Item<SynthesisTable>>,
    joints: usize,
    problems: &Problems,
) -> SynthesisStudy {
    let empty = SynthesisTable::default();
    let table = item.map_or(&empty, |item| &item.value);
    let family = table
        .family
        .as_ref()
        .map_or(Family::RightAngles, |f| f.value);
    let reach = table.reach.unwrap_or(REACH);
    let joints = table
        .joints
        .as_ref()
        .map_or(joints, |item| item.value as usize);
    let objectives = synthesis_objectives::objectives(table, problems);
    SynthesisStudy {
        min_share: table
            .min_share
            .unwrap_or_else(|| synthesis_objectives::least_share(&objectives)),
        objectives,
        method: table
            .method
            .as_ref()
            .map_or(RobotSearch::CmaEs, |m| m.value),
        family,
        reach,
        include_design: table.include_design.as_ref().is_some_and(|item| item.value)
            || family == Family::Design,
        min_width_deg: table.min_width_deg.unwrap_or(MIN_WIDTH),
        max_length: table.max_length.unwrap_or(MOST_LENGTH * reach),
        min_fill: table.min_fill.unwrap_or(LEAST_FILL),
        min_pre_failure_share: table.min_pre_failure_share.unwrap_or(LEAST_PRE_FAILURE),
        round_length: table.round_length.unwrap_or(0.01 * reach),
        round_limit_deg: table.round_limit_deg.unwrap_or(1.0),
        tolerance: table.tolerance.unwrap_or(TOLERANCE * reach),
        tolerance_deg: table.tolerance_deg.unwrap_or(TOLERANCE_DEG),
        slices: table.slices.unwrap_or(SLICES),
        effort: table.effort,
        links: rows(table, family, joints, reach, problems),
    }
}

fn rows(
    table: &SynthesisTable,
    family: Family,
    joints: usize,
    reach: f64,
    problems: &Problems,
) -> Vec<RowRange> {
    let of_family = RowRange {
        alpha_deg: match family {
            Family::RightAngles => ParameterRange::OneOf(vec![-90.0, 90.0]),
            Family::General | Family::Design => ParameterRange::Between {
                min: -180.0,
                max: 180.0,
            },
        },
        a: ParameterRange::Between {
            // Both signs: a row with -a and -alpha is the same link, so that a search may pass
            // through a = 0, where axes meet, to what would be another twist.
            min: -LONGEST * reach,
            max: LONGEST * reach,
        },
        d: ParameterRange::Between {
            min: -LONGEST * reach,
            max: LONGEST * reach,
        },
    };
    let Some(links) = &table.links else {
        return vec![of_family; joints];
    };
    if links.value.len() != joints {
        let expected = format!("{joints} rows, one per joint");
        let help = "give one row per joint, base first; `{}` leaves all to the family";
        problems.reject(&links.place, "wrong number of rows", &expected, help);
    }
    let of = |own: &Option<Item<ParameterRange>>, other: &ParameterRange| {
        own.as_ref()
            .map_or(other.clone(), |item| item.value.clone())
    };
    let row = |row: &RowTable| RowRange {
        alpha_deg: of(&row.alpha_deg, &of_family.alpha_deg),
        a: of(&row.a, &of_family.a),
        d: of(&row.d, &of_family.d),
    };
    links.value.iter().map(row).collect()
}

impl SynthesisTable {
    /// The first parameter that is asked to vary although it changes no share, with its name.
    pub fn idle(&self, task: TaskSpace) -> Option<(&Place, String)> {
        let rows = &self.links.as_ref()?.value;
        let varies = |item: &Option<Item<ParameterRange>>| match item {
            Some(item) => !matches!(item.value, ParameterRange::Fixed(0.0)),
            None => false,
        };
        LinkSpace::idle(rows.len(), task)
            .into_iter()
            .find_map(|(row, column)| {
                let (own, name) = match column {
                    Column::Twist => (&rows[row].alpha_deg, "alpha"),
                    Column::Length => (&rows[row].a, "a"),
                    Column::Offset => (&rows[row].d, "d"),
                };
                let place = own
                    .as_ref()
                    .map(|item| &item.place)
                    .filter(|_| varies(own))?;
                Some((place, format!("{name}_{}", row + 1)))
            })
    }

    /// Where it is asked for the design as a start.
    pub fn design_place(&self) -> Option<&Place> {
        let family = self.family.as_ref();
        let family = family.filter(|item| item.value == Family::Design);
        let included = self.include_design.as_ref().filter(|item| item.value);
        family
            .map(|item| &item.place)
            .or(included.map(|item| &item.place))
    }
}

impl Default for SynthesisTable {
    fn default() -> SynthesisTable {
        SynthesisTable {
            objectives: None,
            joints: None,
            method: None,
            family: None,
            reach: None,
            include_design: None,
            min_width_deg: None,
            max_length: None,
            min_fill: None,
            min_pre_failure_share: None,
            min_share: None,
            round_length: None,
            round_limit_deg: None,
            tolerance: None,
            tolerance_deg: None,
            slices: None,
            effort: Effort::USUAL,
            links: None,
        }
    }
}
