//! The last robots of a search: as they came and rounded, with limits fitted with care, compared on
//! samples that none was fitted to.

use super::assessment::{Care, DesignProblem, Draft, Look};
use super::link_space::{Column, Links};
use super::measures::Measures;
use super::search::SynthesisSettings;
use super::seeds::{Purpose, sample_seed};
use crate::workspace::ArtificialLimits;
use serde::{Deserialize, Serialize};

/// Independent shifts of the samples of selection and report.
pub const REPLICATES: u32 = 16;

/// Where a stage of a search ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct End {
    /// The stage's name.
    pub name: String,
    /// The robot.
    pub links: Links,
    /// Limits that were good for it.
    pub limits: Vec<ArtificialLimits>,
}

/// A finalist with its merits on the samples of the selection, which it was not fitted on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finalist {
    /// What it is.
    pub name: String,
    /// The robot as fitted; its own score is that of the fit and biased.
    pub draft: Draft,
    /// Merits on the samples of the selection.
    pub held_out: Measures,
    /// Score there.
    pub score: f64,
    /// Its standard error.
    pub error: f64,
    /// Whether its numbers are round.
    pub is_round: bool,
}

/// Fits limits to the end of a stage and to its rounded robot, and measures both.
pub(super) fn with_finalists(
    problem: &DesignProblem,
    settings: &SynthesisSettings,
    seed: u64,
    end: &End,
) -> Vec<Finalist> {
    let maker = Maker {
        problem,
        settings,
        seed,
    };
    // One after the other: each has an atlas of its own, which fills the cores.
    let plain = maker.finalist(end.clone(), Care::Last, false);
    let rounded = (settings.round_length > 0.0).then(|| End {
        name: format!("{}, rounded", end.name),
        links: rounded(problem, &end.links, settings.round_length),
        limits: match &plain {
            Some(plain) => vec![plain.draft.limits.clone()],
            None => end.limits.clone(),
        },
    });
    let rounded = rounded.and_then(|end| maker.finalist(end, Care::Polish, true));
    plain.into_iter().chain(rounded).collect()
}

/// Best first, on the samples of the selection.
pub(super) fn sort_finalists(finalists: &mut [Finalist]) {
    finalists.sort_by(|a, b| b.score.total_cmp(&a.score));
}

struct Maker<'a> {
    problem: &'a DesignProblem,
    settings: &'a SynthesisSettings,
    seed: u64,
}

impl Maker<'_> {
    fn finalist(&self, end: End, care: Care, is_round: bool) -> Option<Finalist> {
        let (problem, settings) = (self.problem, self.settings);
        let look = Look {
            samples: settings.fit_samples,
            seed: sample_seed(self.seed, Purpose::Fit, 0),
            replicates: 1,
        };
        let mut draft = problem.draft(&end.links, &end.limits, look, care)?;
        if is_round && settings.round_limit > 0.0 {
            let step = settings.round_limit;
            draft.limits = problem.rounded_limits(&end.links, &draft.limits, step, look)?;
        }
        let look = Look {
            samples: settings.selection_samples,
            seed: sample_seed(self.seed, Purpose::Selection, 0),
            replicates: REPLICATES,
        };
        let held_out = problem.measured(&end.links, &draft.limits, look)?.measures;
        Some(Finalist {
            name: end.name,
            score: problem.score(&held_out),
            error: held_out.merit(problem.merit).error,
            draft,
            held_out,
            is_round,
        })
    }
}

/// `links` with lengths that are multiples of `step`, and twists of whole degrees, inside the
/// bounds. The reach is no longer 1 to the last digit.
fn rounded(problem: &DesignProblem, links: &Links, step: f64) -> Links {
    let mut round = links.clone();
    for link in &mut round {
        for column in [Column::Length, Column::Offset] {
            let value = link.get_mut(column);
            *value = (*value / step).round() * step;
        }
        link.twist = link.twist.to_degrees().round().to_radians();
    }
    problem.links.confine(&mut round);
    round
}
