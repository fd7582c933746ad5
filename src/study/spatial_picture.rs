//! What the figures of a hybrid study show.

use crate::report::Figure;
use crate::workspace::hybrid::Atlas;
use crate::workspace::{ArtificialLimits, FailureSet};

/// Figures of the workspace over `atlas`, for limits in internal joint variables.
///
/// PLUG FIGURES IN HERE: what is returned is written beside the report's own figures.
pub(super) fn figures(
    _atlas: &Atlas,
    _limits: &ArtificialLimits,
    _failures: &FailureSet,
) -> Vec<Box<dyn Figure>> {
    Vec::new()
}
