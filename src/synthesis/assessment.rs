//! One robot: its atlas, the best limits for it, its merits.

use super::arm::Arm;
use super::link_space::{LinkSpace, Links};
use super::measures::{Measures, Merit};
use crate::design::TaskSpace;
use crate::manifold::SearchSettings;
use crate::objective::{DesignSpace, HybridObjective};
use crate::optimiser::{Candidate, Reach, climb};
use crate::sampling::stream;
use crate::workspace::hybrid::{
    Atlas, AtlasRecipe, AtlasSettings, Region, Rule, SamplePlan, Sampling,
};
use crate::workspace::{ArtificialLimits, FailureSet, JointLimit};
use rand::Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use std::sync::atomic::AtomicBool;

/// What a robot must keep to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// Most total length L, in reaches.
    pub most_length: f64,
    /// Least S_0max as a share of the ball of the reach: without it a share of almost nothing
    /// could win.
    pub least_fill: f64,
    /// Least W₀ / S_0max.
    pub least_pre_failure_share: f64,
    /// Least S_F / S_0max.
    pub least_share: f64,
}

/// The question that a search for robots answers.
#[derive(Clone, Debug)]
pub struct DesignProblem {
    /// Which robots.
    pub links: LinkSpace,
    /// Which joints may lock, and how far beyond their limits.
    pub failures: FailureSet,
    /// Narrowest limits of a joint, radians.
    pub min_width: f64,
    /// What is made as large as possible.
    pub merit: Merit,
    /// Everything searched for or reported: of these, merits that cost more than sizes are measured.
    pub merits: Vec<Merit>,
    /// What a robot must keep to.
    pub bounds: Bounds,
    /// How manifolds are traced.
    pub atlas: AtlasSettings,
}

/// A robot with limits and what they came to on the samples it was searched on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Draft {
    /// Links of reach 1.
    pub links: Links,
    /// Limits of every joint.
    pub limits: ArtificialLimits,
    /// Its merits, without standard errors.
    pub measures: Measures,
    /// The merit searched for, less what it misses of the bounds.
    pub score: f64,
}

/// Which samples a robot is looked at with. The same for all robots that are to be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Number of task points.
    pub samples: u32,
    /// Seed of their shift.
    pub seed: u64,
    /// Independent shifts; 1 where no standard error is asked for.
    pub replicates: u32,
}

/// How far a sampled region reaches beyond the workspace, whose extent may be a rough one.
const MARGIN: f64 = 2e-3;

/// Random limits from which a fit from scratch begins, and how many of the best it climbs from.
const DRAWS: usize = 48;
/// See [`DRAWS`].
const CLIMBED: usize = 3;

/// Parts of the circle in which good limits are looked for.
const BINS: usize = 72;

/// Steps of the sweeps of a refit while searching, radians.
const STEPS: [f64; 2] = [0.1, 0.04];

/// Steps of the sweeps of the last fit: of the first ones, from every start, after one from wall to
/// wall, and of those that the best goes on with.
const LAST_STEPS: [f64; 2] = [0.1, 0.06];
/// See [`LAST_STEPS`].
const FINE_STEPS: [f64; 4] = [0.04, 0.03, 0.02, 0.01];

/// Most sweeps over all ends of rounded limits.
const ROUNDING_SWEEPS: usize = 4;

/// How carefully limits are fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Care {
    /// From the best of the given starts, a few short sweeps.
    Refit,
    /// From scratch as well.
    Scratch,
    /// From every given start, with many sweeps: once, for a robot that is to be kept.
    Last,
    /// From the best of the given starts, with many short sweeps: for a robot that hardly differs
    /// from one that limits were fitted to.
    Polish,
}

/// Power by which falling short of a bound lowers a score.
const PENALTY: i32 = 3;

impl DesignProblem {
    /// What the tool is asked to reach.
    pub fn task(&self) -> TaskSpace {
        self.links.task()
    }

    /// The atlas of `arm`; `None` if there is nothing to trace. For more than one degree of
    /// redundancy it is more accurate if it is for `limits` alone.
    pub fn atlas(&self, arm: &Arm, look: Look, limits: Option<&ArtificialLimits>) -> Option<Atlas> {
        self.atlas_with(self.atlas, arm, look, limits)
    }

    fn atlas_with(
        &self,
        settings: AtlasSettings,
        arm: &Arm,
        look: Look,
        limits: Option<&ArtificialLimits>,
    ) -> Option<Atlas> {
        let (task, extent) = (self.task(), &arm.extent);
        let margin = MARGIN * extent.reach;
        let plan = SamplePlan {
            task,
            region: Region {
                radius: extent.radius + margin,
                lower: extent.lower - margin,
                upper: extent.upper + margin,
                reach: extent.reach + margin,
            },
            sampling: Sampling::Lattice {
                samples: look.samples,
                replicates: look.replicates,
            },
            seed: look.seed,
        };
        let recipe = AtlasRecipe::new(&arm.robot, plan, settings).ok()?;
        let recipe = match limits {
            Some(limits) if arm.robot.degree_of_redundancy(task) > 1 => recipe.focused(limits),
            _ => recipe,
        };
        let never = AtomicBool::new(false);
        recipe.build(None, &never, &|_, _| {}).ok()
    }

    /// The box of limits of `arm`.
    pub fn limit_space(&self, arm: &Arm) -> DesignSpace {
        DesignSpace::of_robot(&arm.robot, self.task(), self.min_width)
    }

    /// Fits limits to `links` on fresh samples.
    pub fn draft(
        &self,
        links: &Links,
        starts: &[ArtificialLimits],
        look: Look,
        care: Care,
    ) -> Option<Draft> {
        let arm = Arm::of_links(&self.links, links)?;
        // The noise of so few samples is far above what a manifold missed now and then takes away.
        let settings = match care {
            Care::Last | Care::Polish => self.atlas,
            Care::Refit | Care::Scratch => AtlasSettings {
                search: SearchSettings::sparse(),
                ..self.atlas
            },
        };
        let atlas = self.atlas_with(settings, &arm, look, None)?;
        let limits = self.fit(&arm, &atlas, starts, care, look.seed);
        let draft = self.draft_of(links, &arm, &atlas, limits);
        Some(self.with_margin_apart(draft, look))
    }

    /// `links` with given limits, measured on fresh samples.
    pub fn measured(&self, links: &Links, limits: &ArtificialLimits, look: Look) -> Option<Draft> {
        let arm = Arm::of_links(&self.links, links)?;
        let atlas = self.atlas(&arm, look, Some(limits))?;
        Some(self.draft_of(links, &arm, &atlas, limits.clone()))
    }

    /// `links` with `limits`, measured over `atlas`.
    pub fn draft_of(
        &self,
        links: &Links,
        arm: &Arm,
        atlas: &Atlas,
        limits: ArtificialLimits,
    ) -> Draft {
        let measures = self.measures(arm, atlas, &limits);
        Draft {
            score: self.score(&measures),
            links: links.clone(),
            limits,
            measures,
        }
    }

    /// The best limits found on `atlas`.
    pub fn fit(
        &self,
        arm: &Arm,
        atlas: &Atlas,
        starts: &[ArtificialLimits],
        care: Care,
        seed: u64,
    ) -> ArtificialLimits {
        let space = self.limit_space(arm);
        let failures = self.failures.clone();
        let objective = HybridObjective::new(space.clone(), atlas, failures, Rule::Definition);
        let near =
            |steps: &[f64]| -> Vec<Reach> { steps.iter().copied().map(Reach::Near).collect() };
        let with_whole = |steps: &[f64]| [&[Reach::Whole][..], &near(steps)].concat();
        let mut found: Vec<Candidate> = Vec::new();
        let scored = starts.iter().map(|limits| Candidate {
            x: space.point(limits),
            score: objective.score_of(&space.design(&space.point(limits))),
        });
        let mut starts: Vec<Candidate> = scored.collect();
        starts.sort_by(|a, b| b.score.total_cmp(&a.score));
        let (climbed, sweeps) = match care {
            Care::Last => (starts.len(), with_whole(&LAST_STEPS)),
            Care::Polish => (1, near(&FINE_STEPS)),
            Care::Refit | Care::Scratch => (1, near(&STEPS)),
        };
        let starts = starts.into_iter().take(climbed);
        found.extend(starts.map(|start| climb(&objective, start.x, &sweeps)));
        if care == Care::Scratch {
            let mut drawn = self.random_limits(arm, atlas, &objective, seed);
            drawn.sort_by(|a, b| b.score.total_cmp(&a.score));
            let sweeps = with_whole(&STEPS);
            let starts = drawn.into_iter().take(CLIMBED);
            found.extend(starts.map(|start| climb(&objective, start.x, &sweeps)));
        }
        let best = found
            .into_iter()
            .reduce(|a, b| if b.score > a.score { b } else { a });
        let best = best.map(|best| match care {
            Care::Last => climb(&objective, best.x, &near(&FINE_STEPS)),
            _ => best,
        });
        match best {
            Some(best) => space.design(&best.x).limits,
            None => ArtificialLimits::free(arm.robot.joints()),
        }
    }

    /// Limits of random widths around the angles that most task points can do without.
    fn random_limits(
        &self,
        arm: &Arm,
        atlas: &Atlas,
        objective: &HybridObjective,
        seed: u64,
    ) -> Vec<Candidate> {
        let space = self.limit_space(arm);
        let coverage = atlas.coverage(BINS);
        let mut rng = stream(seed, u64::MAX);
        let mut limit = |shares: &Vec<f64>| {
            let best = (0..BINS).fold(0, |a, b| if shares[b] > shares[a] { b } else { a });
            // The share at a random place decides how far the limits may reach.
            let [place, width]: [f64; 2] = std::array::from_fn(|_| rng.random());
            let least = shares[best] * place;
            let wide = |step: isize| {
                let next = |k: usize| (best as isize + step * k as isize).rem_euclid(BINS as isize);
                (1..BINS)
                    .find(|&k| shares[next(k) as usize] < least)
                    .unwrap_or(BINS)
            };
            let [down, up] = [wide(-1), wide(1)].map(|k| (k as f64 - 0.5) * TAU / BINS as f64);
            let centre = -PI + (best as f64 + 0.5) * TAU / BINS as f64;
            if down + up >= TAU || width < 0.1 && shares[best] > 0.5 {
                return JointLimit::FREE;
            }
            JointLimit::new(centre - down * width.sqrt(), centre + up * width.sqrt())
        };
        (0..DRAWS)
            .map(|_| {
                let limits = ArtificialLimits::new(coverage.iter().map(&mut limit).collect());
                let x = space.point(&limits);
                let score = objective.score_of(&space.design(&x));
                Candidate { x, score }
            })
            .collect()
    }

    /// `limits` with both ends at multiples of `step` (radians), no narrower than allowed; ends are
    /// moved by one step as long as that helps on fresh samples.
    pub fn rounded_limits(
        &self,
        links: &Links,
        limits: &ArtificialLimits,
        step: f64,
        look: Look,
    ) -> Option<ArtificialLimits> {
        let arm = Arm::of_links(&self.links, links)?;
        let atlas = self.atlas(&arm, look, None)?;
        let score = |limits: &ArtificialLimits| atlas.fault_tolerant_size(limits, &self.failures);
        let round = limits
            .joints()
            .iter()
            .map(|limit| self.rounded(limit, step));
        let mut best = ArtificialLimits::new(round.collect());
        let mut most = score(&best);
        for _ in 0..ROUNDING_SWEEPS {
            let before = most;
            for moved in self.neighbours(&arm, &best, step) {
                let mut joints = best.joints().to_vec();
                joints[moved.0] = self.rounded(&moved.1, step);
                let candidate = ArtificialLimits::new(joints);
                let size = score(&candidate);
                if size > most {
                    (best, most) = (candidate, size);
                }
            }
            if most <= before {
                break;
            }
        }
        Some(best)
    }

    fn rounded(&self, limit: &JointLimit, step: f64) -> JointLimit {
        if limit.is_full() {
            return JointLimit::FREE;
        }
        let [lower, upper] = [limit.lower, limit.upper].map(|end| (end / step).round() * step);
        let missing = (self.min_width - (upper - lower)).max(0.0);
        JointLimit::new(
            lower,
            upper + (missing / step - 1e-9).ceil().max(0.0) * step,
        )
    }

    /// Every joint's limits with one end a step away; both ends where they stay symmetric.
    fn neighbours(
        &self,
        arm: &Arm,
        limits: &ArtificialLimits,
        step: f64,
    ) -> Vec<(usize, JointLimit)> {
        let space = self.limit_space(arm);
        let mut all = Vec::new();
        for (joint, limit) in limits.joints().iter().enumerate() {
            if limit.is_full() {
                continue;
            }
            let moves: &[[f64; 2]] = match space.is_centred(joint) {
                true => &[[-1.0, 1.0], [1.0, -1.0]],
                false => &[[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]],
            };
            for [low, high] in moves {
                let (lower, upper) = (limit.lower + low * step, limit.upper + high * step);
                if upper - lower >= self.min_width - 1e-9 {
                    all.push((joint, JointLimit::new(lower, upper)));
                }
            }
        }
        all
    }

    /// The merits of `arm` with `limits` over `atlas`.
    pub fn measures(&self, arm: &Arm, atlas: &Atlas, limits: &ArtificialLimits) -> Measures {
        let sizes = atlas.sizes(limits, &self.failures, Rule::Definition);
        let mut measures = Measures::new(&sizes, arm.length, arm.extent.reach, self.task());
        self.measure_beyond_size(&mut measures, arm, atlas, limits);
        measures
    }

    /// The merit searched for, lowered for every bound that is missed.
    pub fn score(&self, measures: &Measures) -> f64 {
        measures.merit(self.merit).value * self.discount(measures)
    }

    /// 1 for a robot that keeps to all bounds, less for others.
    pub fn discount(&self, measures: &Measures) -> f64 {
        let short = |value: f64, least: f64| match value < least {
            true => (value / least).max(0.0).powi(PENALTY),
            false => 1.0,
        };
        let bounds = &self.bounds;
        short(measures.fill.value, bounds.least_fill)
            * short(measures.share.value, bounds.least_share)
            * short(
                measures.pre_failure_share.value,
                bounds.least_pre_failure_share,
            )
            * short(
                bounds.most_length / measures.length.max(f64::MIN_POSITIVE),
                1.0,
            )
    }
}
