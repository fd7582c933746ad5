//! Locations that no other beats in size and dexterity at once.

use super::dexterity::Dexterity;
use super::largest::Candidate;
use serde::{Deserialize, Serialize};

/// A local measure, the best of which over a location's configurations counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// Condition number, least.
    Condition,
    /// Manipulability, greatest.
    Manipulability,
    /// Worst-case fault-tolerant manipulability over the joints that move, greatest.
    FaultTolerant,
}

impl Measure {
    /// Every measure.
    pub const ALL: [Measure; 3] = [
        Measure::Condition,
        Measure::Manipulability,
        Measure::FaultTolerant,
    ];

    /// The measure of a location, turned so that less is better.
    fn cost(self, dexterity: &Dexterity) -> f64 {
        match self {
            Measure::Condition => dexterity.condition,
            Measure::Manipulability => -dexterity.manipulability,
            Measure::FaultTolerant => -dexterity.fault_tolerant,
        }
    }
}

/// Sizes and measures nearer than this share are equal.
const EQUAL: f64 = 1e-6;

/// The Pareto front of greatest size and best `measure`, largest first.
pub fn front(mut all: Vec<Candidate>, measure: Measure) -> Vec<Candidate> {
    let cost = |candidate: &Candidate| measure.cost(&candidate.dexterity);
    let order = |a: &Candidate, b: &Candidate| {
        let size = b.size.total_cmp(&a.size);
        size.then(cost(a).total_cmp(&cost(b)))
    };
    all.sort_by(order);
    let mut kept: Vec<Candidate> = Vec::new();
    for candidate in all {
        let least = kept.last().map_or(f64::INFINITY, cost);
        // Written so that an infinite least cost is beaten by any finite one.
        if cost(&candidate) + EQUAL * cost(&candidate).abs() >= least {
            continue;
        }
        // As large as the last one within the accuracy of screening, and better.
        let as_large = |c: &Candidate| c.size - candidate.size < EQUAL * c.size;
        if kept.last().is_some_and(as_large) {
            kept.pop();
        }
        kept.push(candidate);
    }
    kept
}
