//! Where the fault-tolerant workspace lies: sampled pictures of it.
//!
//! Both maps are polar about joint 1, because turning a task point about joint 1 changes nothing
//! but θ₁.

use crate::angle::AngleSet;

/// The planar workspace of a position task, ring by ring.
#[derive(Clone, Debug, PartialEq)]
pub struct RingMap {
    /// Radii [inner, outer] of the unrestricted workspace (an annulus), metres.
    pub unrestricted: [f64; 2],
    /// Disjoint rings in order of radius; radii without any fault-tolerant angle may be left out.
    pub rings: Vec<Ring>,
}

/// One thin ring and the polar angles of W_F at its middle radius.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// Inner radius, metres.
    pub inner: f64,
    /// Outer radius, metres.
    pub outer: f64,
    /// Fault-tolerant polar angles β at the middle radius.
    pub rotation_set: AngleSet,
}

/// The workspace of a planar pose task seen from above: for every tool position the share of
/// orientations that is fault tolerant [S4 Fig. 3b].
#[derive(Clone, Debug, PartialEq)]
pub struct ShareMap {
    /// Radii [inner, outer] of the unrestricted workspace of the tool point, metres.
    pub unrestricted: [f64; 2],
    /// Radii of the cell edges, ascending, metres; one more than rows of cells.
    pub radius_edges: Vec<f64>,
    /// Number of cells around the circle; cell k covers polar angles
    /// −π + 2πk/`angles` … −π + 2π(k+1)/`angles`.
    pub angles: usize,
    /// Share of orientations in [0, 1] at the cell's centre, row by row of radius.
    pub share: Vec<f64>,
}

/// A picture of the fault-tolerant workspace of a planar robot.
#[derive(Clone, Debug, PartialEq)]
pub enum WorkspaceMap {
    /// Position task.
    Rings(RingMap),
    /// Pose task.
    Shares(ShareMap),
}
