//! A search from code: the limits of a planar 3R arm that maximise its fault-tolerant workspace.

use faultspace::objective::{DesignSpace, PlanarObjective, PlanarTask};
use faultspace::optimiser::{
    Control, CoordinateAscent, CoordinateAscentSettings, Search, run_search,
};
use faultspace::workspace::FailureSet;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let space = DesignSpace::new(&[1.0, 1.0, 1.0], 0.0, false, None);
    let objective = PlanarObjective::new(
        space.clone(),
        PlanarTask::Position,
        FailureSet::any(3),
        false,
    );
    let solver = CoordinateAscent::new(CoordinateAscentSettings::default(), 1, Vec::new());
    let control = Control {
        interrupt: Arc::default(),
        on_progress: Arc::new(|_, _| {}),
        on_snapshot: Arc::new(|_, _| Ok(())),
    };
    let (found, _) = run_search(&objective, solver, None, control)?;
    let best = &found.solver.candidates()[0];
    println!("S_F = {:.6} m²", best.score);
    for (joint, limit) in (1..).zip(space.design(&best.x).limits.joints()) {
        let (lower, upper) = (limit.lower.to_degrees(), limit.upper.to_degrees());
        println!("joint {joint}: {lower:.3}° to {upper:.3}°");
    }
    Ok(())
}
