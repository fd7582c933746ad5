//! What the robot's tool is asked to reach.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The space of task points x, of dimension m.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TaskSpace {
    /// A point in the plane, m = 2.
    PlanarPosition,
    /// A point and a direction in the plane, m = 3.
    PlanarPose,
    /// A point in space, m = 3.
    SpatialPosition,
    /// A point and an orientation in space, m = 6.
    SpatialPose,
}

impl TaskSpace {
    /// Every task space, planar ones first.
    pub const ALL: [TaskSpace; 4] = [
        TaskSpace::PlanarPosition,
        TaskSpace::PlanarPose,
        TaskSpace::SpatialPosition,
        TaskSpace::SpatialPose,
    ];

    /// The name used in files.
    pub fn name(self) -> &'static str {
        match self {
            TaskSpace::PlanarPosition => "planar-position",
            TaskSpace::PlanarPose => "planar-pose",
            TaskSpace::SpatialPosition => "spatial-position",
            TaskSpace::SpatialPose => "spatial-pose",
        }
    }

    /// The task's dimension m.
    pub fn dimension(self) -> usize {
        match self {
            TaskSpace::PlanarPosition => 2,
            TaskSpace::PlanarPose | TaskSpace::SpatialPosition => 3,
            TaskSpace::SpatialPose => 6,
        }
    }

    /// Unit of a workspace's size.
    pub fn unit(self) -> &'static str {
        match self {
            TaskSpace::PlanarPosition => "m^2",
            TaskSpace::PlanarPose => "m^2 rad",
            TaskSpace::SpatialPosition => "m^3",
            TaskSpace::SpatialPose => "m^3 rad^3",
        }
    }

    /// Whether the task lies in the plane.
    pub fn is_planar(self) -> bool {
        matches!(self, TaskSpace::PlanarPosition | TaskSpace::PlanarPose)
    }
}

impl fmt::Display for TaskSpace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn serde_uses_the_names_of_files() {
        for task in TaskSpace::ALL {
            let written = serde_json::to_string(&task).unwrap();
            assert_eq!(written, format!("\"{}\"", task.name()));
        }
    }
}
