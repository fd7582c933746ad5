//! Locations that no other beats in size and dexterity at once.

use super::largest::Candidate;

/// Sizes and condition numbers nearer than this share are equal.
const EQUAL: f64 = 1e-6;

/// The Pareto front of greatest size and least condition number, largest first.
pub fn front(mut all: Vec<Candidate>) -> Vec<Candidate> {
    let order = |a: &Candidate, b: &Candidate| {
        let size = b.size.total_cmp(&a.size);
        size.then(a.dexterity.condition.total_cmp(&b.dexterity.condition))
    };
    all.sort_by(order);
    let mut kept: Vec<Candidate> = Vec::new();
    for candidate in all {
        let least = kept.last().map_or(f64::INFINITY, |c| c.dexterity.condition);
        let condition = candidate.dexterity.condition;
        if condition >= least * (1.0 - EQUAL) {
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
