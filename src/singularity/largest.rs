//! The location with the largest self-motion manifolds [S1 §III, Table II].
//!
//! N random starts go down to singular configurations of every rank (Algorithm 1). The locations
//! of all starts and of all these configurations are screened for their size, the best of every
//! rank loss are refined locally, and the winner is explored whole (Algorithm 2). A Pareto front
//! weighs size against dexterity [S1 Fig. 7d].

use super::catalogue::{Catalogue, SingularitySettings, find_singularities, random_configuration};
use super::dexterity::{Dexterity, STILL, measures};
use super::location::{Location, LocationSearch, STALLED};
use super::pareto::{Measure, front};
use super::ranges::joint_ranges;
use super::refine::{RefineSettings, Refined, refine};
use crate::manifold::{CurveStatus, SelfMotionManifold};
use crate::sampling::stream;
use rand::Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// How the largest location is searched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargestSettings {
    /// How singular configurations are searched.
    pub singularities: SingularitySettings,
    /// Candidates of every rank loss that are refined.
    pub finalists: usize,
    /// How they are refined.
    pub refine: RefineSettings,
    /// Rounds in which members of the Pareto front are varied; each computes as many locations as
    /// the front has members.
    pub pareto_rounds: usize,
}

impl Default for LargestSettings {
    fn default() -> LargestSettings {
        LargestSettings {
            singularities: SingularitySettings::default(),
            finalists: 2,
            refine: RefineSettings::default(),
            pareto_rounds: 3,
        }
    }
}

/// Where a location came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// A random start.
    Random,
    /// A singular configuration that a descent reached.
    Singular,
    /// Local refinement.
    Refined,
    /// A variation of a member of the Pareto front.
    Varied,
}

/// A location that was screened.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// A configuration there, n internal joint variables.
    pub theta: Vec<f64>,
    /// The rank loss of that configuration.
    pub loss: usize,
    /// Number of the random start it came from.
    pub start: usize,
    /// Where it came from.
    pub origin: Origin,
    /// Sum of joint ranges over all manifolds, radians.
    pub size: f64,
    /// Whether the manifolds were traced to their ends, so that nothing is missing in the size;
    /// remains of starts that stalled next to nodes do not count.
    pub is_whole: bool,
    /// The best local measures over its configurations.
    pub dexterity: Dexterity,
}

/// What the search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Largest {
    /// The singular configurations of Algorithm 1.
    pub catalogue: Catalogue,
    /// The locations of all random starts, in order.
    pub random: Vec<Candidate>,
    /// The locations of all singular configurations that were reached.
    pub singular: Vec<Candidate>,
    /// The refined candidates, largest first.
    pub refined: Vec<Candidate>,
    /// Locations computed for each of these.
    pub evaluations: Vec<usize>,
    /// The winner, explored whole.
    pub largest: Location,
    /// A configuration at the winner: that of the best refined candidate.
    pub best: Candidate,
    /// The location with the least size of all that were screened, explored whole, and a
    /// configuration there.
    pub smallest: (Location, Vec<f64>),
    /// For each of [`Measure::ALL`] the locations that no other beats in both size and measure,
    /// largest first.
    pub pareto: [Vec<Candidate>; 3],
}

/// Vertices at which the dexterity of a screened location is measured.
const SCREENED_VERTICES: usize = 48;
/// Streams of random numbers of the stages, beside those of the starts.
const SCREEN: u64 = 1 << 32;
const EXPLORE: u64 = 2 << 32;
const VARY: u64 = 3 << 32;
/// Candidates of which the smallest location is chosen.
const SMALL: usize = 4;
/// Sizes nearer than this are equal, radians.
const TIE: f64 = 1e-6;

/// Watches the search: stage, steps done and steps in all.
pub type Watch<'a> = &'a (dyn Fn(&str, usize, usize) + Sync);

/// Looks for the location with the largest self-motion manifolds.
///
/// Depends on `seed` alone, not on threads. `None` if `stop` returned true in between.
pub fn find_largest(
    search: &LocationSearch,
    settings: &LargestSettings,
    seed: u64,
    watch: Watch,
    stop: &(dyn Fn() -> bool + Sync),
) -> Option<Largest> {
    let arm = search.arm();
    watch("descending to singular configurations", 0, 4);
    let catalogue = find_singularities(&arm, search.physical(), &settings.singularities, seed);
    if stop() {
        return None;
    }
    watch("screening locations", 1, 4);
    let starts = settings.singularities.starts;
    let of_start = |start: usize| {
        let theta = random_configuration(&arm, search.physical(), seed, start);
        (theta, 0, start, Origin::Random)
    };
    let mut items: Vec<_> = (0..starts).map(of_start).collect();
    let reached = catalogue.reached.iter();
    items.extend(
        reached.map(|(start, loss, theta)| (theta.clone(), *loss, *start, Origin::Singular)),
    );
    let screened = screen_all(search, items, seed, SCREEN);
    let (random, singular): (Vec<_>, Vec<_>) = screened
        .into_iter()
        .partition(|candidate| candidate.origin == Origin::Random);
    if stop() {
        return None;
    }
    watch("refining the largest", 2, 4);
    let (refined, evaluations) = refine_all(search, &random, &singular, settings, seed);
    if stop() {
        return None;
    }
    watch("exploring locations", 3, 4);
    let all = || random.iter().chain(&singular).chain(&refined);
    let best = all().max_by(|a, b| {
        let tie = (a.size - b.size).abs() < TIE;
        match tie {
            true => b.dexterity.condition.total_cmp(&a.dexterity.condition),
            false => a.size.total_cmp(&b.size),
        }
    })?;
    let mut own = search.clone();
    let largest = explore(&mut own, &best.theta, best.loss, seed);
    let smallest = smallest(search, &random, &singular, seed)?;
    let known: Vec<Candidate> = all().filter(|c| c.is_whole).cloned().collect();
    let pareto = Measure::ALL.map(|measure| pareto(search, &known, measure, settings, seed));
    Some(Largest {
        best: best.clone(),
        largest,
        smallest,
        pareto,
        catalogue,
        random,
        singular,
        refined,
        evaluations,
    })
}

fn explore(search: &mut LocationSearch, theta: &[f64], loss: usize, seed: u64) -> Location {
    let tool = search.arm().chain.tool(theta);
    let known: Vec<Vec<f64>> = (loss > 0).then(|| theta.to_vec()).into_iter().collect();
    search.explore(&tool, &known, &mut stream(seed, EXPLORE))
}

/// A configuration with its rank loss, start and origin.
type Item = (Vec<f64>, usize, usize, Origin);

fn screen_all(search: &LocationSearch, items: Vec<Item>, seed: u64, from: u64) -> Vec<Candidate> {
    let screen = |own: &mut LocationSearch, (index, item): (usize, Item)| {
        screen_one(own, item, seed, from + index as u64)
    };
    let items: Vec<(usize, Item)> = items.into_iter().enumerate().collect();
    let found = items.into_par_iter().map_init(|| search.clone(), screen);
    found
        .collect::<Vec<Option<Candidate>>>()
        .into_iter()
        .flatten()
        .collect()
}

/// The size and dexterity of a configuration's location; `None` if it holds no configuration
/// inside the physical limits.
pub(super) fn screen_one(
    search: &mut LocationSearch,
    (theta, loss, start, origin): Item,
    seed: u64,
    item: u64,
) -> Option<Candidate> {
    let tool = search.arm().chain.tool(&theta);
    let (manifolds, size) = search.screen(&tool, false, &mut stream(seed, item));
    let physical = search.physical().to_vec();
    let ranges = joint_ranges(&manifolds, &physical);
    let closed = |manifold: &SelfMotionManifold| {
        matches!(manifold.status, CurveStatus::Closed | CurveStatus::Stroke)
    };
    let whole = |manifold: &SelfMotionManifold| closed(manifold) || manifold.length < STALLED;
    let is_whole = manifolds.iter().any(closed) && manifolds.iter().all(whole);
    let moves: Vec<bool> = ranges.iter().map(|range| range.measure() > STILL).collect();
    let inside = |theta: &[f64]| {
        let mut pairs = theta.iter().zip(&physical);
        pairs.all(|(&angle, arc)| arc.contains(angle))
    };
    let arm = search.arm();
    let at_hand = || {
        let [condition, manipulability, fault_tolerant] = measures(&arm, &theta, &moves);
        inside(&theta).then(|| Dexterity {
            condition,
            theta: theta.clone(),
            manipulability,
            fault_tolerant,
        })
    };
    let dexterity = Dexterity::of(&arm, &manifolds, &moves, SCREENED_VERTICES, inside);
    let dexterity = dexterity.or_else(at_hand)?;
    Some(Candidate {
        theta,
        loss,
        start,
        origin,
        size,
        is_whole,
        dexterity,
    })
}

/// Refines the best candidates of every rank loss.
fn refine_all(
    search: &LocationSearch,
    random: &[Candidate],
    singular: &[Candidate],
    settings: &LargestSettings,
    seed: u64,
) -> (Vec<Candidate>, Vec<usize>) {
    let losses = 0..=settings.singularities.max_loss;
    let mut chosen: Vec<&Candidate> = Vec::new();
    for loss in losses {
        let own = random.iter().chain(singular).filter(|c| c.loss == loss);
        let mut own: Vec<&Candidate> = own.collect();
        own.sort_by(|a, b| b.size.total_cmp(&a.size));
        chosen.extend(own.into_iter().take(settings.finalists));
    }
    let run = |own: &mut LocationSearch, candidate: &&Candidate| {
        let seed = seed.wrapping_add(candidate.start as u64);
        let end = refine(
            own,
            &candidate.theta,
            candidate.loss,
            &settings.refine,
            seed,
        );
        let Refined {
            theta,
            loss,
            size,
            evaluations,
        } = end;
        let item = (theta, loss, candidate.start, Origin::Refined);
        let mut refined = screen_one(own, item, seed, SCREEN)?;
        refined.size = size;
        Some((refined, evaluations))
    };
    let ends: Vec<Option<(Candidate, usize)>> =
        chosen.par_iter().map_init(|| search.clone(), run).collect();
    let mut ends: Vec<(Candidate, usize)> = ends.into_iter().flatten().collect();
    ends.sort_by(|a, b| b.0.size.total_cmp(&a.0.size));
    ends.into_iter().unzip()
}

/// The smallest location of those that screening found smallest, and of some at which it could not
/// trace whole manifolds because J is singular all along them.
fn smallest(
    search: &LocationSearch,
    random: &[Candidate],
    singular: &[Candidate],
    seed: u64,
) -> Option<(Location, Vec<f64>)> {
    let mut chosen: Vec<&Candidate> = Vec::new();
    for group in [random, singular] {
        let mut own: Vec<&Candidate> = group.iter().filter(|c| c.is_whole).collect();
        own.sort_by(|a, b| a.size.total_cmp(&b.size));
        chosen.extend(own.into_iter().take(SMALL));
    }
    let mut rest: Vec<&Candidate> = singular.iter().filter(|c| !c.is_whole).collect();
    rest.sort_by_key(|candidate| candidate.loss);
    chosen.extend(rest.into_iter().take(SMALL));
    let run = |own: &mut LocationSearch, candidate: &&Candidate| {
        let location = explore(own, &candidate.theta, candidate.loss, seed);
        (location, candidate.theta.clone())
    };
    let found: Vec<(Location, Vec<f64>)> =
        chosen.par_iter().map_init(|| search.clone(), run).collect();
    let whole = found
        .into_iter()
        .filter(|(location, _)| location.is_whole());
    whole.min_by(|a, b| a.0.size.total_cmp(&b.0.size))
}

/// The front of size against `measure`, its members varied a few times.
fn pareto(
    search: &LocationSearch,
    all: &[Candidate],
    measure: Measure,
    settings: &LargestSettings,
    seed: u64,
) -> Vec<Candidate> {
    let mut best = front(all.to_vec(), measure);
    for round in 0..settings.pareto_rounds {
        let spread = 0.3 * 0.5f64.powi(round as i32);
        let vary = |(index, member): (usize, &Candidate)| {
            let item = VARY + ((round as u64) << 20) + index as u64;
            let mut rng = stream(seed, item);
            let moved = member.theta.iter();
            let moved: Vec<f64> = moved
                .map(|a| a + rng.random_range(-spread..spread))
                .collect();
            let theta = match member.loss {
                0 => moved,
                loss => search.arm().settle(&moved, loss, None)?,
            };
            Some((theta, member.loss, member.start, Origin::Varied))
        };
        let items: Vec<Item> = best.iter().enumerate().filter_map(vary).collect();
        let varied = screen_all(search, items, seed, VARY + ((round as u64) << 24));
        let whole = varied.into_iter().filter(|c| c.is_whole);
        best = front(best.into_iter().chain(whole).collect(), measure);
    }
    best
}
