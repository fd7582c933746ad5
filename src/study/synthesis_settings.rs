//! Settings of `kind = "synthesis"`: the table `[synthesis]`, validated. Field names are its keys.

use crate::design::{Robot, TaskSpace};
use crate::synthesis::{
    Bounds, DesignProblem, LinkRow, LinkSpace, Links, Merit, Parameter, ParetoSettings,
    SynthesisSettings,
};
use crate::workspace::FailureSet;
use crate::workspace::hybrid::AtlasSettings;
use serde::Serialize;

/// Which robots are searched, if `links` says nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Twists of ±90°.
    RightAngles,
    /// Any twists.
    General,
    /// Any twists, starting from the design alone.
    Design,
}

/// How one robot is searched; a front always by the genetic algorithm NSGA-II.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RobotSearch {
    /// CMA-ES over links with limits refitted inside.
    CmaEs,
    /// A genetic algorithm over links and limits together.
    Genetic,
}

/// What is known of a parameter beforehand: degrees or metres.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ParameterRange {
    /// It has this value.
    Fixed(f64),
    /// It is one of these.
    OneOf(Vec<f64>),
    /// It lies between these.
    Between {
        /// Least value.
        min: f64,
        /// Greatest value.
        max: f64,
    },
}

/// A row of the search space.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RowRange {
    /// Twist α, degrees.
    pub alpha_deg: ParameterRange,
    /// Length a, metres.
    pub a: ParameterRange,
    /// Offset d, metres.
    pub d: ParameterRange,
}

/// How much work is done.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Effort {
    /// Random robots that are looked at first.
    pub screened: u64,
    /// Task points for each of them.
    pub screening_samples: u64,
    /// Robots from which the search goes on.
    pub runs: u64,
    /// Generations after which the better half of these goes on, until `full_runs` are left.
    pub trial_generations: u64,
    /// Runs that go on to their end.
    pub full_runs: u64,
    /// Most generations of each stage after the trials; of a search for a front, all generations.
    pub generations: u64,
    /// Robots per generation.
    pub population: u64,
    /// Task points for each robot of a generation, new ones for every generation.
    pub samples: u64,
    /// Generations without a better median after which a stage ends.
    pub patience: u64,
    /// Task points on which limits are fitted last.
    pub fit_samples: u64,
    /// Task points on which the winner is chosen.
    pub selection_samples: u64,
    /// Task points on which the numbers of the report are measured.
    pub report_samples: u64,
    /// Reachable task points of the check by inverse kinematics; 0 for none.
    pub check_poses: u64,
    /// Task points on which the sensitivity to every parameter is measured; 0 for none.
    pub sensitivity_samples: u64,
}

/// Settings of `kind = "synthesis"`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SynthesisStudy {
    /// What is made as large as possible: one merit for one robot, several for a front.
    pub objectives: Vec<Merit>,
    /// How one robot is searched.
    pub method: RobotSearch,
    /// Which robots are searched.
    pub family: Family,
    /// Reach of the robots, metres: the largest distance of the wrist (for positions, of the
    /// tool) from the origin of joint 1's frame.
    pub reach: f64,
    /// Whether the design is a first candidate.
    pub include_design: bool,
    /// Narrowest allowed limits of a joint, degrees.
    pub min_width_deg: f64,
    /// Most total length Σ(|a| + |d|), metres.
    pub max_length: f64,
    /// Least S_0max as a share of the ball of the reach.
    pub min_fill: f64,
    /// Least W₀ / S_0max.
    pub min_pre_failure_share: f64,
    /// Least S_F / S_0max.
    pub min_share: f64,
    /// Lengths of the winner are multiples of this, metres; 0 for no rounding.
    pub round_length: f64,
    /// Limits of the winner are multiples of this, degrees; 0 for no rounding.
    pub round_limit_deg: f64,
    /// Manufacturing tolerance of lengths and offsets, metres.
    pub tolerance: f64,
    /// Manufacturing tolerance of twists, and of limits, degrees.
    pub tolerance_deg: f64,
    /// Values of each surplus joint at which pre-images of more than one degree of redundancy are
    /// cut while searching.
    pub slices: u64,
    /// How much work is done.
    #[serde(flatten)]
    pub effort: Effort,
    /// What is known of every parameter, one row per joint.
    pub links: Vec<RowRange>,
}

impl Effort {
    /// Seconds, to see that all is well.
    pub const QUICK: Effort = Effort {
        screened: 24,
        screening_samples: 300,
        runs: 1,
        trial_generations: 3,
        full_runs: 1,
        generations: 3,
        population: 8,
        samples: 300,
        patience: 10,
        fit_samples: 2000,
        selection_samples: 4000,
        report_samples: 8000,
        check_poses: 300,
        sensitivity_samples: 0,
    };
    /// Minutes: the default.
    pub const USUAL: Effort = Effort {
        screened: 300,
        screening_samples: 600,
        runs: 6,
        trial_generations: 10,
        full_runs: 1,
        generations: 60,
        population: 12,
        samples: 800,
        patience: 20,
        fit_samples: 20_000,
        selection_samples: 30_000,
        report_samples: 100_000,
        check_poses: 10_000,
        sensitivity_samples: 8000,
    };
    /// Half an hour, with twice as many starts: two of them are followed to their end.
    pub const THOROUGH: Effort = Effort {
        screened: 600,
        screening_samples: 600,
        runs: 12,
        trial_generations: 10,
        full_runs: 2,
        generations: 60,
        population: 16,
        samples: 800,
        patience: 25,
        fit_samples: 30_000,
        selection_samples: 50_000,
        report_samples: 200_000,
        check_poses: 30_000,
        sensitivity_samples: 20_000,
    };
}

/// Polylines of atlases that live for one candidate may be this far from their curves, radians:
/// far below the noise of so few samples.
const SEARCH_TOLERANCE: f64 = 0.02;

/// Values of each surplus joint while searching, if the study names none.
pub(super) const SLICES: u64 = 8;

impl ParameterRange {
    /// The parameter with all values multiplied by `unit`.
    fn times(&self, unit: f64) -> Parameter {
        match self {
            ParameterRange::Fixed(value) => Parameter::Fixed(value * unit),
            ParameterRange::OneOf(values) => {
                Parameter::OneOf(values.iter().map(|value| value * unit).collect())
            }
            ParameterRange::Between { min, max } => Parameter::Bounded([min * unit, max * unit]),
        }
    }
}

impl SynthesisStudy {
    /// The space of robots of reach 1.
    pub(super) fn link_space(&self, task: TaskSpace) -> LinkSpace {
        let per_metre = 1.0 / self.reach;
        let row = |row: &RowRange| LinkRow {
            twist: row.alpha_deg.times(1f64.to_radians()),
            length: row.a.times(per_metre),
            offset: row.d.times(per_metre),
        };
        LinkSpace::new(self.links.iter().map(row).collect(), task)
    }

    /// The question that the search answers.
    pub(super) fn problem(&self, task: TaskSpace, failures: &FailureSet) -> DesignProblem {
        DesignProblem {
            links: self.link_space(task),
            failures: failures.clone(),
            min_width: self.min_width_deg.to_radians(),
            merit: self.objectives[0],
            merits: self.objectives.clone(),
            bounds: Bounds {
                most_length: self.max_length / self.reach,
                least_fill: self.min_fill,
                least_pre_failure_share: self.min_pre_failure_share,
                least_share: self.min_share,
            },
            atlas: AtlasSettings {
                tolerance: SEARCH_TOLERANCE,
                slices: self.slices as usize,
                ..AtlasSettings::default()
            },
        }
    }

    pub(super) fn search_settings(&self) -> SynthesisSettings {
        let effort = &self.effort;
        SynthesisSettings {
            screened: effort.screened as u32,
            screening_samples: effort.screening_samples as u32,
            runs: effort.runs as u32,
            trial_generations: effort.trial_generations as u32,
            full_runs: effort.full_runs as u32,
            generations: effort.generations as u32,
            population: effort.population as u32,
            samples: effort.samples as u32,
            patience: effort.patience as u32,
            fit_samples: effort.fit_samples as u32,
            selection_samples: effort.selection_samples as u32,
            round_length: self.round_length / self.reach,
            round_limit: self.round_limit_deg.to_radians(),
        }
    }

    pub(super) fn pareto_settings(&self) -> ParetoSettings {
        let effort = &self.effort;
        ParetoSettings {
            screened: effort.screened as u32,
            population: effort.population as u32,
            generations: effort.generations as u32,
            samples: effort.samples as u32,
            report_samples: effort.selection_samples as u32,
        }
    }

    /// The links of `robot` at reach 1, if it is of the searched kind: revolute joints in standard
    /// rows.
    pub(super) fn links_of(&self, robot: &Robot, task: TaskSpace) -> Option<Links> {
        let mut links = LinkSpace::links_of(robot)?;
        if links.len() != self.links.len() {
            return None;
        }
        self.link_space(task).settle(&mut links);
        Some(links)
    }
}
