//! A short climb along the box's own directions: what refits limits to a robot that has changed a
//! little, many thousand times in a search for robots.

use super::line_search::Line;
use super::search::Candidate;
use crate::objective::Objective;

/// How far one sweep over all directions looks along each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// From wall to wall, both walls included: finds a free joint and one that is held still.
    Whole,
    /// Two steps of this length to either side (radians, for limits).
    Near(f64),
}

/// Climbs from `x`, one sweep over all directions per entry of `sweeps`. The score never falls.
pub fn climb(objective: &dyn Objective, x: Vec<f64>, sweeps: &[Reach]) -> Candidate {
    let score = objective.score(&x);
    let mut best = Candidate { x, score };
    for reach in sweeps {
        for direction in &objective.space().directions {
            improve(objective, &mut best, direction, *reach);
        }
    }
    best
}

/// Moves `best` to the highest point found along `direction`.
fn improve(objective: &dyn Objective, best: &mut Candidate, direction: &[f64], reach: Reach) {
    let space = objective.space();
    let range = space.travel(&best.x, direction);
    if range[1] - range[0] <= 0.0 {
        return;
    }
    let line = Line {
        objective,
        x: &best.x,
        score: best.score,
        direction,
        range,
    };
    let found = match reach {
        Reach::Whole => line.exact(0.0).unwrap_or_else(|| line.scan(SCAN)),
        Reach::Near(step) => line.exact_near(step).unwrap_or_else(|| line.step(step)),
    };
    if found.score > best.score {
        best.x = space.along(&best.x, direction, found.t);
        best.score = found.score;
    }
}

/// Points of a scan from wall to wall.
const SCAN: usize = 24;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::objective::{SearchSpace, Variable};

    struct Peak(SearchSpace);

    impl Objective for Peak {
        fn space(&self) -> &SearchSpace {
            &self.0
        }

        /// 1 at the upper wall of the first variable and 0.3 of the second.
        fn score(&self, x: &[f64]) -> f64 {
            (1.0 - (1.0 - x[0]).powi(2) - (x[1] - 0.3).powi(2)).max(0.0)
        }
    }

    fn peak() -> Peak {
        let variable = Variable {
            lower: -1.0,
            upper: 1.0,
            periodic: false,
            end_bias: 0.0,
        };
        Peak(SearchSpace {
            variables: vec![variable; 2],
            directions: vec![vec![1.0, 0.0], vec![0.0, 1.0]],
            blocks: Vec::new(),
        })
    }

    #[test]
    fn a_wall_is_reached_exactly() {
        let top = climb(&peak(), vec![0.0, 0.0], &[Reach::Whole, Reach::Near(0.02)]);
        assert_eq!(top.x[0], 1.0);
        assert!(top.score > 0.9999);
    }

    #[test]
    fn without_a_sweep_nothing_moves() {
        assert_eq!(climb(&peak(), vec![0.5, 0.5], &[]).x, [0.5, 0.5]);
    }
}
