//! The objectives of `[synthesis]`: read as written, checked, and what they ask of a robot's size.

use super::synthesis_table::SynthesisTable;
use crate::design::TaskSpace;
use crate::diagnostic::{Item, Problems, Table};
use crate::synthesis::Merit;

/// Least S_F/S_0max by default where the objectives do not see the size of W_F: half of what good
/// robots have, twice the median of random ones.
const LEAST_SHARE: f64 = 0.1;

/// Reads `objectives`.
pub(super) fn read(table: &Table) -> Option<Item<Vec<Item<Merit>>>> {
    let entry = table.entry("objectives")?;
    let choices = Merit::ALL.map(|merit| (merit.name(), merit));
    let entries = entry.array("an array of merits, e.g. `[\"share\"]`")?;
    let read: Vec<_> = entries.iter().map(|e| e.choice(&choices)).collect();
    Some(entry.item(read.into_iter().collect::<Option<_>>()?))
}

/// What is searched for.
pub(super) fn objectives(table: &SynthesisTable, problems: &Problems) -> Vec<Merit> {
    let Some(item) = &table.objectives else {
        return vec![Merit::Share];
    };
    let mut merits: Vec<Merit> = Vec::new();
    if item.value.is_empty() {
        let (expected, help) = ("at least one merit", "write `objectives = [\"share\"]`");
        problems.reject(&item.place, "there is no objective", expected, help);
        return vec![Merit::Share];
    }
    for merit in &item.value {
        if merits.contains(&merit.value) {
            let (expected, help) = ("each merit once", "remove one of the two");
            problems.reject(&merit.place, "a merit is listed twice", expected, help);
        }
        merits.push(merit.value);
    }
    merits
}

/// Least S_F/S_0max, if the study names none.
pub(super) fn least_share(objectives: &[Merit]) -> f64 {
    let sees_size = objectives.iter().any(|merit| merit.rewards_size());
    match objectives.iter().any(|merit| merit.is_blind_to_size()) {
        true if !sees_size => LEAST_SHARE,
        _ => 0.0,
    }
}

/// Refuses merits that robots with so many joints do not have.
pub(super) fn check(table: &SynthesisTable, joints: usize, task: TaskSpace, problems: &Problems) {
    let listed = table.objectives.iter().flat_map(|item| &item.value);
    for merit in listed.filter(|merit| merit.value.needs_configurations()) {
        let most = task.dimension() + 1;
        if joints > most {
            problems.reject(
                &merit.place,
                &format!(
                    "this merit is measured along self-motion manifolds that are curves, and robots \
                     with {joints} joints have surfaces"
                ),
                &format!("robots with {most} joints for \"{task}\", or another merit"),
                "choose \"margin\" or another merit, or fewer `joints`",
            );
        }
    }
}
