//! Studies: a file that asks one question, validated whole before anything runs.
//!
//! Two layers: [`StudyFile`] is what the file says, with the place of every value; [`Study`] is
//! what it means, typed, with defaults filled in and checked against the robot. `check` and `run`
//! take the same path.

mod as_run;
mod checkpoint;
mod failure_run;
mod file;
mod first_candidates;
mod folder;
mod found_robot;
mod hybrid_arm;
mod hybrid_result;
mod hybrid_run;
mod hybrid_sensitivity;
mod hybrid_settings;
mod hybrid_table;
mod largest_result;
mod largest_run;
mod limits;
mod load;
mod location_result;
mod locked_check;
mod manifold_report;
mod manifold_result;
mod manifold_run;
mod margin;
mod optimise;
mod parts;
mod picture;
mod planar_arm;
mod planar_run;
mod planar_tolerances;
mod planar_winner;
mod pose_table;
mod report_parts;
mod result;
mod robot_view;
mod run;
mod search;
mod serve;
mod settings;
mod shards;
mod singular_settings;
mod singular_table;
mod singularity_run;
mod spatial_picture;
mod structure;
mod surface_result;
mod surface_run;
mod surrogate_check;
mod surrogate_search;
mod surrogate_settings;
mod surrogate_table;
mod synthesis_check;
mod synthesis_figures;
mod synthesis_merit;
mod synthesis_objectives;
mod synthesis_page;
mod synthesis_result;
mod synthesis_run;
mod synthesis_settings;
mod synthesis_table;
mod train_report;
mod train_run;
mod validate;
mod validate_picture;
mod validate_report;
mod validate_run;

pub use file::StudyFile;
pub use folder::check_folder;
pub use hybrid_settings::{Hybrid, HybridSampling};
pub use load::is_study;
pub use robot_view::spatial_robot;
pub use run::{Progress, RunError, RunOptions, run};
pub use settings::{
    CoordinateAscent, DegreeLimits, Design, Estimate, Estimator, EstimatorMethod, FigureFormat,
    Genetic, LinkBounds, ManifoldSearch, Manifolds, Optimise, OptimiserSettings, Pose, Question,
    ReportSettings, Search, Study,
};
pub use shards::{MergeReport, Part, ShardReport, build_part, merge};
pub use singular_settings::{
    Configuration, FailureStudy, LargestManifold, LargestSearch, NamedGoal, SingularitySearch,
};
pub use surrogate_settings::{
    Arcs, DatasetSettings, DecoderKind, Mdn, ModelFile, SurrogateEstimator, SurrogateMethod,
    SurrogateSettings, Train, Training, Validate,
};
pub use synthesis_check::SynthesisQuestion;
pub use synthesis_settings::{
    Effort, Family, ParameterRange, RobotSearch, RowRange, SynthesisStudy,
};
