//! What a search of planar links tells beyond its optimum: the design beside the robot found, files
//! of that robot, and what manufacturing tolerances cost.

use super::found_robot;
use super::optimise::Session;
use super::picture;
use super::planar_arm::PlanarStudy;
use super::planar_run::{POSE_SWEEPS, POSE_TOLERANCE};
use super::planar_tolerances::PlanarTolerances;
use super::result::limits_deg;
use super::run::RunError;
use super::settings::{DegreeLimits, Optimise, Study};
use crate::angle::wrap;
use crate::design::{Geometry, Robot};
use crate::optimiser::{
    Control, CoordinateAscent, CoordinateAscentSettings, Search, SearchState, run_search,
};
use crate::report::{WorkspaceFigure, WorkspacePairFigure};
use crate::workspace::{ArtificialLimits, JointLimit, WorkspaceMap, WorkspaceSizes};
use nalgebra::Isometry3;
use serde_json::{Value, json};
use std::sync::Arc;

/// The robot that a search of links has found, and the design it began with.
pub(super) struct PlanarWinner<'a> {
    study: &'a Study,
    arm: &'a PlanarStudy,
    /// Limits between links.
    limits: &'a ArtificialLimits,
    design: DesignArm,
    /// What tolerances cost.
    pub tolerances: PlanarTolerances,
}

/// The design with its limits.
struct DesignArm {
    arm: PlanarStudy,
    /// Limits between links.
    limits: ArtificialLimits,
    /// Whether they are the study's; else the best found.
    given: bool,
    sizes: WorkspaceSizes,
    map: WorkspaceMap,
}

/// Random starts of the search for the design's limits: pose tasks cost milliseconds a score.
const STARTS: usize = 32;
const POSE_STARTS: usize = 12;

/// Lengths are written in files to the nanometre.
const PER_METRE: f64 = 1e9;

impl<'a> PlanarWinner<'a> {
    /// Measures the design of `study`, and the tolerances of `arm` with `limits`, which was found.
    ///
    /// # Errors
    /// The run was interrupted.
    pub fn new(
        study: &'a Study,
        optimise: &Optimise,
        arm: &'a PlanarStudy,
        limits: &'a ArtificialLimits,
        session: &Session,
    ) -> Result<PlanarWinner<'a>, RunError> {
        let design = DesignArm::new(study, optimise, session)?;
        Ok(PlanarWinner {
            study,
            arm,
            limits,
            design,
            tolerances: PlanarTolerances::new(arm, limits),
        })
    }

    /// The robot as files have it: links alone, so that its joint variables are the angles between
    /// them whatever those of the design were.
    fn robot(&self) -> Robot {
        let tidy = |length: &f64| (length * PER_METRE).round() / PER_METRE;
        Robot {
            name: "robot".into(),
            source: Some(found_robot::source(self.study)),
            geometry: Geometry::Planar {
                lengths: self.arm.lengths.iter().map(tidy).collect(),
            },
            tool: Isometry3::identity(),
            physical_limits: None,
        }
    }

    /// The robot's files and a study that measures it anew.
    pub fn files(&self) -> Vec<(String, String)> {
        let robot = self.robot();
        let centred = |limit: &JointLimit| match limit.is_full() {
            true => JointLimit::FREE,
            false => JointLimit::around(wrap(limit.centre()), limit.width()),
        };
        let limits = self.limits.joints().iter().map(centred);
        let limits = ArtificialLimits::new(limits.collect());
        let mut files = found_robot::robot_files(&robot, &limits);
        let failures = self.arm.failures();
        let study = found_robot::robot_study(self.study, &robot, &limits, failures, "exact");
        files.push(study);
        files
    }

    /// Adds the design and the tolerances to `result.json`.
    pub fn add_to(&self, result: &mut Value) {
        let design = &self.design;
        let robot = &self.study.design.robot;
        let limits = DegreeLimits::from_limits(&design.arm.to_joints(&design.limits), robot);
        result["reference"] = json!({
            "robot": robot.name,
            "lengths": design.arm.lengths,
            "limits_deg": limits_deg(&limits),
            "limits_given": design.given,
            "size": {
                "fault_tolerant": design.sizes.fault_tolerant.value,
                "error": design.sizes.fault_tolerant.error,
                "unrestricted": design.sizes.unrestricted.value,
                "normalised": design.sizes.normalised(),
                "unit": self.study.task.unit(),
            },
        });
        result["sensitivity"] = self.tolerances.to_json();
    }

    /// Both robots with their workspaces; `map` and `sizes` are those of the one found.
    pub fn pair<'f>(
        &'f self,
        map: &'f WorkspaceMap,
        sizes: &WorkspaceSizes,
    ) -> WorkspacePairFigure<'f> {
        let design = &self.design;
        let name = &self.study.design.robot.name;
        let percent =
            |sizes: &WorkspaceSizes| format!("{:.2} % fault tolerant", 100.0 * sizes.normalised());
        WorkspacePairFigure {
            robots: [
                WorkspaceFigure {
                    map: &design.map,
                    limits: &design.limits,
                    links: &design.arm.lengths,
                    arm_angles: picture::posture(&design.arm, &design.limits, &design.map),
                    title: format!("{name}: {}", percent(&design.sizes)),
                },
                WorkspaceFigure {
                    map,
                    limits: self.limits,
                    links: &self.arm.lengths,
                    arm_angles: picture::posture(self.arm, self.limits, map),
                    title: format!("found: {}", percent(sizes)),
                },
            ],
        }
    }
}

impl DesignArm {
    fn new(study: &Study, optimise: &Optimise, session: &Session) -> Result<DesignArm, RunError> {
        let arm = PlanarStudy::new(study)?;
        let limits = match &optimise.start {
            Some(given) => arm.to_links(&given.to_limits(&study.design.robot)),
            None => best_limits(study, optimise, &arm, session)?,
        };
        Ok(DesignArm {
            given: optimise.start.is_some(),
            sizes: arm.sizes(&limits),
            map: arm.map(&limits),
            arm,
            limits,
        })
    }
}

/// The best limits found for the design as it is, between links.
fn best_limits(
    study: &Study,
    optimise: &Optimise,
    arm: &PlanarStudy,
    session: &Session,
) -> Result<ArtificialLimits, RunError> {
    let mut fixed = optimise.clone();
    fixed.search.links = None;
    let space = arm.design_space(&fixed);
    let objective = arm.objective(space.clone(), false);
    let own = CoordinateAscentSettings::default();
    let settings = match arm.is_pose() {
        true => CoordinateAscentSettings {
            restarts: POSE_STARTS,
            max_sweeps: POSE_SWEEPS,
            tolerance: POSE_TOLERANCE,
            ..own
        },
        false => CoordinateAscentSettings {
            restarts: STARTS,
            ..own
        },
    };
    let progress = session.progress.clone();
    let control = Control {
        interrupt: session.interrupt.clone(),
        on_progress: Arc::new(move |share: f64, _| {
            let done = (1000.0 * share.clamp(0.0, 1.0)) as u64;
            progress.update(done, 1000, f64::NAN, "fitting limits to the design");
        }),
        on_snapshot: Arc::new(|_: &CoordinateAscent, _: &SearchState| Ok(())),
    };
    let solver = CoordinateAscent::new(settings, study.seed, Vec::new());
    let (snapshot, interrupted) = run_search(&objective, solver, None, control)?;
    if interrupted {
        return Err(RunError::Interrupted);
    }
    let best = snapshot.solver.candidates().into_iter().next();
    let free = || ArtificialLimits::free(arm.lengths.len());
    Ok(best.map_or_else(free, |best| space.design(&best.x).limits))
}
