//! Self-motion manifolds: the configurations with which a redundant robot holds one task point.
//!
//! With one degree of redundancy the pre-image of a task point is a set of curves
//! ([`SelfMotionManifold`]), almost always closed. [`PreImageSearch`] finds all of them from
//! random starts and says how sure that is ([`Completeness`]). [`CurveSource`] serves many task
//! points in a row and robots of more redundancy, whose pre-images it cuts into curves.
//!
//! Knows nothing of grids, volumes or rotations about joint 1.

mod any_solver;
mod ascent;
mod bounds;
mod correct;
mod curve;
mod cuts;
mod desk;
mod extents;
mod extrema;
mod findings;
mod lift;
mod march;
mod march_end;
mod nearby;
mod pre_image;
mod prober;
mod seeds;
mod segment;
mod self_motion;
mod sliced;
mod solver;
mod source;
mod structure;
mod summit;
mod surface;
mod surface_ranges;
mod trace;
mod within;

pub use bounds::physical_arcs;
pub use curve::CurveStatus;
pub use extents::Extent;
pub use pre_image::{Completeness, ManifoldError, PreImage, PreImageSearch};
pub use self_motion::{CriticalPoint, SelfMotionManifold};
pub use sliced::Faces;
pub use solver::SearchSettings;
pub use source::{CurveRef, CurveSource, MOST_REDUNDANT, Pose};
pub use structure::{Cure, Intolerance, SelfMotionShares};
pub use surface::{Surface, SurfaceEvidence, SurfaceSearch, SurfaceSlice};
pub use trace::TraceSettings;
pub use within::{Run, runs_in_box, runs_inside};
