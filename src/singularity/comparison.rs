//! Sizes of locations chosen by local measures, beside those of random ones [S1 Fig. 6].

use super::catalogue::random_configuration;
use super::dexterity::measures;
use super::location::LocationSearch;
use crate::sampling::stream;
use rayon::prelude::*;

/// Sizes of the locations of as many configurations each, radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Random configurations.
    pub random: Vec<f64>,
    /// The best by manipulability of ten times as many random ones.
    pub manipulability: Vec<f64>,
    /// The best by worst-case fault-tolerant manipulability.
    pub fault_tolerant: Vec<f64>,
}

/// Random configurations among which the best are chosen, per one.
const CHOICE: usize = 10;
/// Streams of random numbers, beside those of the search.
const DRAW: usize = 1 << 36;
const SCREEN: u64 = 5 << 36;

/// Compares `count` configurations chosen in each way. The fault-tolerant measure counts the joints
/// for which `moves` holds.
pub fn compare(search: &LocationSearch, count: usize, moves: &[bool], seed: u64) -> Comparison {
    let arm = search.arm();
    let draw = |k: usize| {
        let theta = random_configuration(&arm, search.physical(), seed, DRAW + k);
        let [_, manipulability, fault_tolerant] = measures(&arm, &theta, moves);
        (theta, [manipulability, fault_tolerant])
    };
    let drawn: Vec<(Vec<f64>, [f64; 2])> = (0..CHOICE * count).into_par_iter().map(draw).collect();
    let best = |measure: usize| {
        let mut order: Vec<usize> = (0..drawn.len()).collect();
        order.sort_by(|&a, &b| drawn[b].1[measure].total_cmp(&drawn[a].1[measure]));
        order.truncate(count);
        order
    };
    let sizes = |chosen: Vec<usize>| -> Vec<f64> {
        let size = |own: &mut LocationSearch, index: usize| {
            let tool = own.arm().chain.tool(&drawn[index].0);
            own.screen(&tool, false, &mut stream(seed, SCREEN + index as u64))
                .1
        };
        chosen
            .into_par_iter()
            .map_init(|| search.clone(), size)
            .collect()
    };
    Comparison {
        random: sizes((0..count).collect()),
        manipulability: sizes(best(0)),
        fault_tolerant: sizes(best(1)),
    }
}
