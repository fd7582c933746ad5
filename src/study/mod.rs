//! Studies: a file that asks one question, validated whole before anything runs.
//!
//! Two layers: [`StudyFile`] is what the file says, with the place of every value; [`Study`] is
//! what it means, typed, with defaults filled in and checked against the robot. `check` and `run`
//! take the same path.

mod as_run;
mod checkpoint;
mod file;
mod folder;
mod limits;
mod load;
mod optimise;
mod picture;
mod planar_arm;
mod result;
mod run;
mod search;
mod serve;
mod settings;
mod validate;

pub use file::StudyFile;
pub use folder::check_folder;
pub use load::is_study;
pub use run::{Progress, RunError, RunOptions, run};
pub use settings::{
    CoordinateAscent, DegreeLimits, Design, Estimate, Estimator, EstimatorMethod, FigureFormat,
    Genetic, LinkBounds, Optimise, OptimiserSettings, Question, ReportSettings, Search, Study,
};
