//! Figures, tables and result files of a study.
//!
//! This room draws result types and never computes results: what a [`Report`] holds comes ready
//! from the study. Every figure is a [`Figure`]: a drawing in printed points that the same code
//! puts on a PNG (1600 pixels wide for one column of a paper) or an SVG, and the table behind it as CSV. Files are written
//! whole or not at all, and the same input gives the same bytes.
//!
//! [`write_report`], for studies of one pose [`write_manifold_report`], of singular configurations
//! and of found robots [`write_finding_report`] and for surrogates [`write_surrogate_report`] write everything;
//! [`write_figure`], [`write_json`] and [`write_text`] write single files.

mod agreement;
mod angle_axes;
mod angle_density;
mod arm;
mod arm_poses_figure;
mod axonometry;
mod calibration;
mod canvas;
mod colour_bar;
mod convergence;
mod design_parameter;
mod distribution_figure;
mod error;
mod figure;
mod figure_of;
mod filter_figure;
mod finding_report;
mod free_place;
mod half_plane_figure;
mod html;
mod joint_bars;
mod joint_mark;
mod joint_ranges_figure;
mod label;
mod limits_figure;
mod link_rod;
mod locks_figure;
mod manifold;
mod manifold_figure;
mod manifold_page;
mod manifold_report;
mod manifold_view;
mod number;
mod outline;
mod panel;
mod parameter_sensitivity;
mod pareto_figure;
mod point_cloud;
mod points;
mod polar;
mod predicted_workspaces;
mod projection;
mod projections_figure;
mod render;
mod result_files;
mod ring_picture;
mod rings;
mod robot_3d;
mod robot_figure;
mod robot_pair_figure;
mod robot_view;
mod scene;
mod search_history;
mod section_pair_figure;
mod section_view;
mod sections;
mod sensitivity;
mod share_scale;
mod shares;
mod singularity_figure;
mod size_scatter;
mod sizes_figure;
mod slices;
mod spatial_figure;
mod split_figure;
mod style;
mod subscript;
mod surrogate_page;
mod surrogate_report;
mod symbol;
mod table;
#[cfg(test)]
mod tests;
mod ticks;
mod trade_off_figure;
mod training_curve;
mod workspace_figure;
mod workspace_pair_figure;
mod write;

pub use angle_density::AngleDensity;
pub use arm_poses_figure::{ArmPose, ArmPosesFigure};
pub use calibration::{Calibration, CalibrationBin, CalibrationCurve};
pub use canvas::{Canvas, Size};
pub use convergence::{Convergence, ConvergencePoint};
pub use design_parameter::DesignParameter;
pub use distribution_figure::{DistributionFigure, SizeSample};
pub use error::ReportError;
pub use figure::{Figure, Format, figure_png, figure_svg, write_figure};
pub use figure_of::FigureOf;
pub use filter_figure::FilterFigure;
pub use finding_report::{FindingReport, Section, write_finding_report};
pub use half_plane_figure::HalfPlaneFigure;
pub use html::{InlineFigure, page};
pub use joint_ranges_figure::JointRangesFigure;
pub use limits_figure::LimitsFigure;
pub use locks_figure::{GoalLocks, LockMark, LocksFigure};
pub use manifold::{CriticalPoint, ManifoldCurve};
pub use manifold_figure::ManifoldFigure;
pub use manifold_report::{
    JointRow, ManifoldReport, ManifoldRow, PoseVerdict, SurfaceSummary, write_manifold_report,
};
pub use manifold_view::ManifoldFigure3d;
pub use number::{degrees, estimate, joint_symbol, percentage, plain, unit, with_error};
pub use parameter_sensitivity::{ParameterSensitivity, ParameterSensitivityFigure};
pub use pareto_figure::{ParetoFigure, ParetoPoint};
pub use points::{write_curves, write_points};
pub use predicted_workspaces::{PredictedWorkspaces, WorkspaceCase};
pub use projections_figure::ProjectionsFigure;
pub use result_files::{is_unfinished, remove_unfinished, write_bytes, write_json, write_text};
pub use robot_3d::{JointMark, SpatialRobotFigure};
pub use robot_figure::RobotFigure;
pub use robot_pair_figure::{PairedRobot, RobotPairFigure};
pub use search_history::{HistoryGeneration, HistoryStage, SearchHistoryFigure};
pub use section_pair_figure::{SectionOf, SectionPairFigure};
pub use sensitivity::{LimitSide, Sensitivity, SensitivityCurve};
pub use singularity_figure::{SingularPoint, SingularityFigure};
pub use size_scatter::{SizeScatter, SizeSeries};
pub use sizes_figure::SizesFigure;
pub use spatial_figure::SpatialWorkspaceFigure;
pub use split_figure::{SplitFigure, SplitPanel};
pub use surrogate_report::{ReportTable, SurrogateReport, write_surrogate_report};
pub use table::Table;
pub use trade_off_figure::{TradeOffFigure, TradeOffObjective, TradeOffPoint};
pub use training_curve::{TrainingCurve, TrainingEpoch};
pub use workspace_figure::WorkspaceFigure;
pub use workspace_pair_figure::WorkspacePairFigure;
pub use write::{Report, write_report};
