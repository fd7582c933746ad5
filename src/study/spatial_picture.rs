//! What the figures of a hybrid study show.

use crate::design::Robot;
use crate::report::{Figure, HalfPlaneFigure, SpatialWorkspaceFigure, WorkspaceFigure};
use crate::workspace::hybrid::Atlas;
use crate::workspace::{ArtificialLimits, FailureSet, JointLimit, SpatialShareMap, WorkspaceMap};

/// Maps of a workspace over an atlas.
pub(super) enum Picture {
    /// Of a spatial task.
    Spatial(SpatialShareMap),
    /// Of a planar task: the map, limits between links and link lengths.
    Planar(Box<PlanarPicture>),
}

pub(super) struct PlanarPicture {
    map: WorkspaceMap,
    limits: ArtificialLimits,
    links: Vec<f64>,
}

impl Picture {
    /// The workspace for `limits` (internal joint variables) over `atlas`; none where samples stand
    /// for themselves: maps show what is turned about joint 1's axis.
    pub fn of(
        atlas: &Atlas,
        robot: &Robot,
        limits: &ArtificialLimits,
        failures: &FailureSet,
    ) -> Option<Picture> {
        if !atlas.plan().sampling.uses_turns() {
            return None;
        }
        let Ok(chain) = robot.planar_chain() else {
            return Some(Picture::Spatial(atlas.share_map(limits, failures)));
        };
        let pairs = limits.joints().iter().zip(&chain.angle_offsets);
        let between: Vec<JointLimit> = pairs.map(|(limit, &by)| limit.shifted(by)).collect();
        Some(Picture::Planar(Box::new(PlanarPicture {
            map: atlas.planar_map(limits, failures),
            limits: ArtificialLimits::new(between),
            links: chain.lengths,
        })))
    }

    /// The map of a spatial task.
    pub fn spatial(&self) -> Option<&SpatialShareMap> {
        match self {
            Picture::Spatial(map) => Some(map),
            Picture::Planar(_) => None,
        }
    }

    /// The figure of a planar task; the arm stands in the middle of its limits.
    pub fn planar(&self, title: &str) -> Option<WorkspaceFigure<'_>> {
        let Picture::Planar(picture) = self else {
            return None;
        };
        let middles = picture.limits.joints().iter().map(JointLimit::centre);
        Some(WorkspaceFigure {
            map: &picture.map,
            limits: &picture.limits,
            links: &picture.links,
            arm_angles: middles.collect(),
            title: title.to_owned(),
        })
    }

    /// The figures of a spatial task.
    pub fn figures(&self, title: &str) -> Vec<Box<dyn Figure + '_>> {
        let Picture::Spatial(map) = self else {
            return Vec::new();
        };
        let title = title.to_owned();
        vec![
            Box::new(SpatialWorkspaceFigure {
                map,
                title: title.clone(),
            }),
            Box::new(HalfPlaneFigure { map, title }),
        ]
    }
}
