//! An objective as argmin sees it.

use crate::objective::Objective;
use argmin::core::{CostFunction, Error};

/// Minimises the negated score of an objective.
pub struct Maximise<'a>(pub &'a dyn Objective);

impl CostFunction for Maximise<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, x: &Vec<f64>) -> Result<f64, Error> {
        Ok(-self.0.score(x))
    }
}
