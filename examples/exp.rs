use faultspace::objective::*;
use faultspace::optimiser::*;
use faultspace::workspace::planar::*;
use faultspace::workspace::*;
use std::sync::Arc;
fn run<S>(o: &dyn Objective, s: S) -> (Vec<Candidate>, u64, bool, f64)
where
    S: Search + Clone + serde::Serialize + serde::de::DeserializeOwned + 'static,
    S: for<'p> argmin::core::Solver<Maximise<'p>, SearchState>,
{
    let t = std::time::Instant::now();
    let c = Control {
        interrupt: Arc::default(),
        on_progress: Arc::new(|_, _| {}),
        on_snapshot: Arc::new(|_: &S, _: &SearchState| Ok(())),
    };
    let (snap, _) = run_search(o, s, None, c).unwrap();
    (
        snap.solver.candidates(),
        snap.solver.evaluations(),
        snap.solver.converged(),
        t.elapsed().as_secs_f64(),
    )
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let pose = a[1] == "pose";
    let lengths: Vec<f64> = a[2].split(',').map(|s| s.parse().unwrap()).collect();
    let restarts: usize = a[3].parse().unwrap();
    let seeds: u64 = a[4].parse().unwrap();
    let n = lengths.len();
    for seed in 1..=seeds {
        let mk = |res| {
            PlanarObjective::new(
                DesignSpace::new(&lengths, 0.0, pose, None),
                if pose {
                    PlanarTask::Pose(res)
                } else {
                    PlanarTask::Position
                },
                FailureSet::any(n),
                false,
            )
        };
        let o = mk(PoseResolution::coarse());
        let fine = mk(PoseResolution::default());
        let max = if pose {
            PlanarPose::unrestricted_size(&lengths)
        } else {
            PlanarPosition::unrestricted_size(&lengths)
        };
        let show = |name: &str, r: &(Vec<Candidate>, u64, bool, f64)| {
            let b = &r.0[0];
            let d = o.design_space().design(&b.x);
            println!(
                "{name} seed {seed}: {:.6} ({:.4}%) evals {} conv {} {:.2}s; top {:?} limits {:?}",
                b.score,
                100.0 * b.score / max,
                r.1,
                r.2,
                r.3,
                r.0.iter()
                    .take(8)
                    .map(|c| (c.score * 1e4).round() / 1e4)
                    .collect::<Vec<_>>(),
                d.limits
                    .joints()
                    .iter()
                    .map(|l| (l.lower.to_degrees(), l.upper.to_degrees()))
                    .map(|(a, b)| format!("{a:.3}..{b:.3}"))
                    .collect::<Vec<_>>()
            );
        };
        let tol = if pose { 1e-5 } else { 1e-9 };
        let st = CoordinateAscentSettings {
            restarts,
            tolerance: tol,
            max_sweeps: if pose { 25 } else { 100 },
            ..Default::default()
        };
        let r = run(&o, CoordinateAscent::new(st.clone(), seed, vec![]));
        show("CA", &r);
        if pose {
            let r2 = run(
                &fine,
                CoordinateAscent::polish(
                    &CoordinateAscentSettings {
                        max_sweeps: 10,
                        ..st.clone()
                    },
                    seed,
                    r.0.iter().take(2).map(|c| c.x.clone()).collect(),
                ),
            );
            show(" CA+", &r2);
        }
        let g = run(&o, Genetic::new(GeneticSettings::default(), seed, vec![]));
        show("GA", &g);
        let starts = g.0.iter().take(4).map(|c| c.x.clone()).collect();
        let st = if pose {
            CoordinateAscentSettings {
                max_sweeps: 15,
                ..st
            }
        } else {
            st
        };
        let p = run(&fine, CoordinateAscent::polish(&st, seed, starts));
        show(" GA+", &p);
    }
}
