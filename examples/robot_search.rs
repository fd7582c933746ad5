//! dev
use faultspace::design::TaskSpace;
use faultspace::synthesis::*;
use faultspace::workspace::FailureSet;
use faultspace::workspace::hybrid::AtlasSettings;
use std::time::Instant;
fn main() {
    let arg = |k: usize, d: f64| {
        std::env::args()
            .nth(k)
            .and_then(|a| a.parse().ok())
            .unwrap_or(d)
    };
    let seed = arg(1, 1.0) as u64;
    let general = arg(2, 0.0) > 0.0;
    let n = arg(3, 7.0) as usize;
    let generations = arg(4, 60.0) as u32;
    let samples = arg(5, 800.0) as u32;
    let screened = arg(6, 200.0) as u32;
    let row = LinkRow {
        twist: if general {
            Parameter::Bounded([-std::f64::consts::PI, std::f64::consts::PI])
        } else {
            Parameter::OneOf(vec![
                -std::f64::consts::FRAC_PI_2,
                std::f64::consts::FRAC_PI_2,
            ])
        },
        length: Parameter::Bounded([0.0, 0.5]),
        offset: Parameter::Bounded([-0.5, 0.5]),
    };
    let problem = DesignProblem {
        links: LinkSpace::new(vec![row; n], TaskSpace::SpatialPose),
        failures: FailureSet::any(n),
        min_width: 20f64.to_radians(),
        merit: Merit::Share,
        bounds: Bounds {
            most_length: 1.8,
            least_fill: 0.25,
            least_pre_failure_share: 0.3,
        },
        atlas: AtlasSettings {
            tolerance: 0.02,
            slices: 8,
            ..AtlasSettings::default()
        },
    };
    let settings = SynthesisSettings {
        screened,
        screening_samples: 600,
        runs: 3,
        trial_generations: 20,
        generations,
        population: 12,
        samples,
        patience: 25,
        fit_samples: 12_000,
        selection_samples: 20_000,
        round_length: 0.01,
        round_limit: 1f64.to_radians(),
    };
    let mut s = Synthesis::new(settings, seed, vec![]);
    let t = Instant::now();
    let mut shown = 0;
    while !s.is_done() {
        s.advance(&problem);
        if s.history().is_empty() {
            println!(
                "{:.1}s screened {} best {:.4}",
                t.elapsed().as_secs_f64(),
                s.screening().len(),
                s.progress().1
            );
        }
        for g in &s.history()[shown..] {
            println!(
                "{:.1}s run {} {:?} evals {} best {:.4} q {:.4?}",
                t.elapsed().as_secs_f64(),
                g.run,
                g.stage,
                g.evaluations,
                g.best,
                g.quartiles
            );
        }
        shown = s.history().len();
    }
    for f in s.finalists() {
        println!(
            "{} fit {:.4} held-out {:.4} ± {:.4} fill {:.3} sigma {:.4} W0 {:.3} L {:.3}",
            f.name,
            f.draft.score,
            f.score,
            f.error,
            f.held_out.fill.value,
            f.held_out.ball_share.value,
            f.held_out.pre_failure_share.value,
            f.held_out.length
        );
        for l in &f.draft.links {
            print!(
                "[{:.1} {:.3} {:.3}] ",
                l.twist.to_degrees(),
                l.length,
                l.offset
            );
        }
        println!();
        for l in f.draft.limits.joints() {
            print!("[{:.0},{:.0}] ", l.lower.to_degrees(), l.upper.to_degrees());
        }
        println!();
    }
    if let Some(w) = s.winner() {
        let look = Look {
            samples: 100_000,
            seed: sample_seed(seed, Purpose::Report, 0),
            replicates: 16,
        };
        let m = problem
            .measured(&w.draft.links, &w.draft.limits, look)
            .unwrap()
            .measures;
        println!(
            "seed {seed} WINNER {} share {:.4} ± {:.4} at {:.1}s",
            w.name,
            m.share.value,
            m.share.error,
            t.elapsed().as_secs_f64()
        );
    }
}
