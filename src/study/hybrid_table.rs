//! The table `[estimator.hybrid]`: read as written, then checked against the task.

use super::hybrid_settings::{
    DEFAULT_CELL, DEFAULT_REPLICATES, Hybrid, HybridSampling, default_orientations, default_samples,
};
use crate::design::TaskSpace;
use crate::diagnostic::{Item, Place, Problem, Problems, Table};
use crate::workspace::hybrid::Rule;

/// Keys of the table.
const KEYS: &[&str] = &[
    "sampling",
    "samples",
    "replicates",
    "cell",
    "orientations",
    "centres",
    "tolerance_rad",
    "memory_limit_mb",
    "slices",
    "rule",
    "check_poses",
];

/// Most samples in all; an atlas of more fits no memory.
pub(super) const MOST_SAMPLES: u64 = 100_000_000;

/// Most task points of a check by inverse kinematics: hours.
const MOST_CHECKED: u64 = 10_000_000;

/// Samples of a replicate at least, so that its estimate means something.
const LEAST_OF_REPLICATE: u64 = 16;

/// Most memory that may be allowed, megabytes: 16 TB.
const MOST_MEGABYTES: u64 = 1 << 24;

/// The table as written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct HybridTable {
    sampling: Option<Item<Named>>,
    samples: Option<Item<u64>>,
    replicates: Option<Item<u64>>,
    cell: Option<Item<f64>>,
    orientations: Option<Item<u64>>,
    centres: Option<Item<bool>>,
    tolerance_rad: Option<f64>,
    memory_limit_mb: Option<u64>,
    slices: Option<u64>,
    rule: Option<Item<Rule>>,
    check_poses: Option<Item<u64>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Named {
    Lattice,
    Grid,
}

/// Reads the table out of `[estimator]`.
pub(super) fn read(estimator: &Table) -> Option<HybridTable> {
    let table = estimator.table("hybrid", KEYS)?;
    let samplings = [("lattice", Named::Lattice), ("grid", Named::Grid)];
    let rules = [("definition", Rule::Definition), ("paper", Rule::Paper)];
    Some(HybridTable {
        sampling: table.choice("sampling", &samplings),
        samples: table.integer("samples", 2 * LEAST_OF_REPLICATE..=MOST_SAMPLES),
        replicates: table.integer("replicates", 2..=MOST_SAMPLES),
        cell: table.number("cell", 0.002..=0.5, ""),
        orientations: table.integer("orientations", 1..=MOST_SAMPLES),
        centres: table.boolean("centres"),
        tolerance_rad: table
            .number("tolerance_rad", 1e-4..=0.2, " rad")
            .map(|item| item.value),
        memory_limit_mb: table
            .integer("memory_limit_mb", 1..=MOST_MEGABYTES)
            .map(|item| item.value),
        slices: table.integer("slices", 8..=1024).map(|item| item.value),
        rule: table.choice("rule", &rules),
        check_poses: table.integer("check_poses", 0..=MOST_CHECKED),
    })
}

/// The settings for `task`; reports what does not go together.
pub(super) fn settings(
    table: Option<&HybridTable>,
    task: TaskSpace,
    problems: &Problems,
) -> Hybrid {
    let default = Hybrid::for_task(task);
    let Some(table) = table else {
        return default;
    };
    let named = table.sampling.as_ref().map(|item| item.value);
    let sampling = match named.unwrap_or(Named::Lattice) {
        Named::Lattice => {
            table.refuse_grid_keys(problems);
            table.lattice(task, problems)
        }
        Named::Grid => {
            table.refuse_lattice_keys(problems);
            table.grid(task, problems)
        }
    };
    table.refuse_check_of_another_rule(problems);
    Hybrid {
        sampling,
        tolerance_rad: table.tolerance_rad.unwrap_or(default.tolerance_rad),
        memory_limit_mb: table.memory_limit_mb.unwrap_or(default.memory_limit_mb),
        slices: table.slices.unwrap_or(default.slices),
        rule: table.rule.as_ref().map_or(default.rule, |item| item.value),
        check_poses: table
            .check_poses
            .as_ref()
            .map_or(default.check_poses, |item| item.value),
    }
}

impl HybridTable {
    /// Reports what rests on turns about joint 1, for a robot whose joint 1 slides.
    pub(super) fn refuse_turns(&self, problems: &Problems) {
        if let Some(item) = self
            .sampling
            .as_ref()
            .filter(|item| item.value == Named::Grid)
        {
            problems.reject(
                &item.place,
                "a grid lies in the half-plane that joint 1 turns, and joint 1 of this robot slides",
                "\"lattice\", which then lies in the whole space",
                "remove `sampling` and the keys of the grid",
            );
        }
        if let Some(item) = self.rule.as_ref().filter(|item| item.value == Rule::Paper) {
            problems.reject(
                &item.place,
                "the paper's rule takes intervals of joint 1's angle, and joint 1 of this robot slides",
                "\"definition\"",
                "remove `rule`",
            );
        }
    }

    /// Inverse kinematics checks the definition, which the paper's rule is not.
    fn refuse_check_of_another_rule(&self, problems: &Problems) {
        let asked = self.check_poses.as_ref().filter(|item| item.value > 0);
        let differs = self
            .rule
            .as_ref()
            .is_some_and(|rule| rule.value == Rule::Paper);
        if let Some(item) = asked.filter(|_| differs) {
            problems.reject(
                &item.place,
                "inverse kinematics checks workspaces by their definition, and `rule` is another",
                "`rule = \"definition\"`",
                "remove `check_poses` or `rule`",
            );
        }
    }

    fn lattice(&self, task: TaskSpace, problems: &Problems) -> HybridSampling {
        let samples = value(&self.samples, default_samples(task));
        let most = samples / LEAST_OF_REPLICATE as u32;
        let replicates = value(&self.replicates, DEFAULT_REPLICATES.min(most));
        if let Some(item) = self.replicates.as_ref().filter(|_| replicates > most) {
            problems.reject(
                &item.place,
                "too many replicates for the samples",
                &format!("from 2 to {most}: at least {LEAST_OF_REPLICATE} samples in each"),
                "lower it, or raise `samples`",
            );
        }
        HybridSampling::Lattice {
            samples,
            replicates,
        }
    }

    fn grid(&self, task: TaskSpace, problems: &Problems) -> HybridSampling {
        let has_orientation = matches!(task, TaskSpace::PlanarPose | TaskSpace::SpatialPose);
        if let Some(item) = &self.orientations
            && !has_orientation
            && item.value != 1
        {
            problems.reject(
                &item.place,
                &format!("the task \"{task}\" has no orientations"),
                "1",
                "remove the key, or choose a pose task",
            );
        }
        HybridSampling::Grid {
            cell: self.cell.as_ref().map_or(DEFAULT_CELL, |item| item.value),
            orientations: value(&self.orientations, default_orientations(task)),
            centres: self.centres.as_ref().is_some_and(|item| item.value),
        }
    }

    fn refuse_grid_keys(&self, problems: &Problems) {
        let cell = self.cell.as_ref().map(|item| &item.place);
        let orientations = self.orientations.as_ref().map(|item| &item.place);
        let centres = self.centres.as_ref().map(|item| &item.place);
        for place in [cell, orientations, centres].into_iter().flatten() {
            refuse_key(problems, place, "lattice", "grid");
        }
    }

    fn refuse_lattice_keys(&self, problems: &Problems) {
        let samples = self.samples.as_ref().map(|item| &item.place);
        let replicates = self.replicates.as_ref().map(|item| &item.place);
        for place in [samples, replicates].into_iter().flatten() {
            refuse_key(problems, place, "grid", "lattice");
        }
    }
}

/// The value of a count that was read within a range that fits.
fn value(item: &Option<Item<u64>>, default: u32) -> u32 {
    item.as_ref()
        .and_then(|item| u32::try_from(item.value).ok())
        .unwrap_or(default)
}

fn refuse_key(problems: &Problems, place: &Place, sampling: &str, other: &str) {
    let key = place.key.rsplit('.').next().unwrap_or_default();
    let problem = Problem {
        message: format!("this key has no meaning for `sampling = \"{sampling}\"`"),
        found: format!("`{key}`"),
        expected: format!("`{key}` only with `sampling = \"{other}\"`"),
        help: format!("remove the key, or write `sampling = \"{other}\"`"),
    };
    problems.report(place, problem);
}
