//! The stages that a run goes through, one after the other: what each may change, and with what
//! steps.

use super::assessment::{DesignProblem, Draft};
use super::finalists::End;
use super::link_space::Links;
use super::run::{Run, RunSettings, Stage};
use super::search::SynthesisSettings;
use std::f64::consts::FRAC_PI_2;

/// How a stage searches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// First step, in coordinates of links.
    step: f64,
    /// Task points, as a multiple of the usual number.
    times: u32,
}

/// The first stage. Larger steps lose the limits that robots inherit.
pub(super) const FIRST: Pace = Pace {
    step: 0.12,
    times: 1,
};

/// The later stages, which are about smaller differences.
const LATER: Pace = Pace {
    step: 0.05,
    times: 2,
};

/// Twists this near to a right angle become one, radians: beyond, another robot is meant.
const NEARLY_RIGHT: f64 = 0.35;

/// Added to the number of a run that goes on in another stage: its draws and task points are new.
const NEXT_NUMBER: u32 = 100;

impl Pace {
    pub fn settings(self, settings: &SynthesisSettings) -> RunSettings {
        RunSettings {
            population: settings.population,
            samples: self.times * settings.samples,
            patience: settings.patience,
            step: self.step,
        }
    }
}

/// A stage with the links it starts from.
pub(super) struct Leg {
    stage: Stage,
    links: Links,
}

impl Leg {
    /// What follows the stage that `run` has ended, if anything does.
    pub fn after(problem: &DesignProblem, run: &Run) -> Option<Leg> {
        let has_twists = problem.links.variables(true).len() > problem.links.variables(false).len();
        let links = run.centre().clone();
        match run.stage {
            Stage::Lengths if has_twists => Some(Leg {
                stage: Stage::All,
                links,
            }),
            Stage::Lengths => Some(Leg {
                stage: Stage::Refined,
                links,
            }),
            Stage::All => right_angles(problem, &links).map(|links| Leg {
                stage: Stage::RightAngles,
                links,
            }),
            Stage::Refined | Stage::RightAngles => None,
        }
    }

    /// The run of this stage, with the limits that `before` ended with.
    pub fn start(self, problem: &DesignProblem, before: &Run, settings: &SynthesisSettings) -> Run {
        let number = before.number + NEXT_NUMBER;
        let limits = before.limits().to_vec();
        let pace = LATER.settings(settings);
        Run::from_links(problem, self.links, limits, self.stage, pace, number)
    }
}

impl Run {
    /// A run that starts at `draft`.
    pub fn new(
        problem: &DesignProblem,
        draft: &Draft,
        stage: Stage,
        settings: RunSettings,
        number: u32,
    ) -> Run {
        let limits = vec![draft.limits.clone()];
        Run::from_links(
            problem,
            draft.links.clone(),
            limits,
            stage,
            settings,
            number,
        )
    }

    /// Where the run has ended. The name tells runs apart if there are `many`.
    pub fn end(&self, many: bool) -> End {
        let stage = match self.stage {
            Stage::Lengths => "lengths",
            Stage::All => "lengths and twists",
            Stage::Refined => "refined lengths",
            Stage::RightAngles => "right angles",
        };
        let run = self.number % NEXT_NUMBER + 1;
        End {
            name: match many {
                true => format!("run {run}, {stage}"),
                false => stage.into(),
            },
            links: self.centre().clone(),
            limits: self.limits().to_vec(),
        }
    }
}

/// `links` with twists near right angles set to them; `None` if that is no change or a twist is
/// far from one.
fn right_angles(problem: &DesignProblem, links: &Links) -> Option<Links> {
    let mut round = links.clone();
    for link in &mut round {
        let nearest = (link.twist / FRAC_PI_2).round() * FRAC_PI_2;
        if (link.twist - nearest).abs() > NEARLY_RIGHT {
            return None;
        }
        link.twist = nearest;
    }
    if round == *links {
        return None;
    }
    problem.links.settle(&mut round);
    Some(round)
}
