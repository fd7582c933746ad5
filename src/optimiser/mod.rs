//! Search methods on a box, as argmin solvers. They know scores and coordinates, nothing of robots.
//!
//! argmin minimises, so costs are negated scores; everything public here speaks of scores, which
//! are maximised.

mod climb;
mod cma_es;
mod coordinate_ascent;
mod genetic;
mod line_search;
mod nondominated;
mod problem;
mod search;

pub use climb::{Reach, climb};
pub use cma_es::CmaEs;
pub use coordinate_ascent::{CoordinateAscent, CoordinateAscentSettings};
pub use genetic::{Genetic, GeneticSettings};
pub use nondominated::{crowding, dominates, ranks, survivors};
pub use problem::Maximise;
pub use search::{
    Candidate, Control, HistoryPoint, OnProgress, OnSnapshot, Search, SearchState, Snapshot,
    run_search,
};
