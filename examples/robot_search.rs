//! Searches a 4R robot for positions in space, with limits, in some seconds:
//! `cargo run --release --example robot_search`.

use faultspace::design::TaskSpace;
use faultspace::synthesis::{
    Bounds, DesignProblem, LinkRow, LinkSpace, Merit, Parameter, Synthesis, SynthesisSettings,
};
use faultspace::workspace::FailureSet;
use faultspace::workspace::hybrid::AtlasSettings;
use std::f64::consts::FRAC_PI_2;

fn main() {
    let row = LinkRow {
        twist: Parameter::OneOf(vec![-FRAC_PI_2, FRAC_PI_2]),
        length: Parameter::Bounded([0.0, 0.5]),
        offset: Parameter::Bounded([-0.5, 0.5]),
    };
    let problem = DesignProblem {
        links: LinkSpace::new(vec![row; 4], TaskSpace::SpatialPosition),
        failures: FailureSet::any(4),
        min_width: 20f64.to_radians(),
        merit: Merit::Share,
        merits: vec![Merit::Share],
        bounds: Bounds {
            most_length: 1.8,
            least_fill: 0.25,
            least_pre_failure_share: 0.3,
            least_share: 0.0,
        },
        atlas: AtlasSettings::default(),
    };
    let settings = SynthesisSettings {
        screened: 32,
        screening_samples: 200,
        runs: 1,
        trial_generations: 5,
        full_runs: 1,
        generations: 5,
        population: 8,
        samples: 300,
        patience: 10,
        fit_samples: 2000,
        selection_samples: 4000,
        round_length: 0.01,
        round_limit: 1f64.to_radians(),
    };
    let mut search = Synthesis::new(settings, 1, Vec::new());
    while !search.is_done() {
        search.advance(&problem);
    }
    for finalist in search.finalists() {
        let (score, error) = (100.0 * finalist.score, 100.0 * finalist.error);
        println!(
            "{}: S_F / S_0max = {score:.2} ± {error:.2} %",
            finalist.name
        );
        for (link, limit) in finalist
            .draft
            .links
            .iter()
            .zip(finalist.draft.limits.joints())
        {
            println!(
                "  α {:4.0}°  a {:.3}  d {:6.3}  limits {:.0}° to {:.0}°",
                link.twist.to_degrees(),
                link.length,
                link.offset,
                limit.lower.to_degrees(),
                limit.upper.to_degrees()
            );
        }
    }
}
