//! Self-motion manifolds: the configurations with which a redundant robot holds one task point.

mod curve;
mod seeds;
mod segment;
mod solver;
mod trace;

pub use curve::CurveStatus;
pub use solver::SearchSettings;
pub use trace::TraceSettings;

#[cfg(test)]
mod probe {
    use super::solver::Solver;
    use super::*;
    use crate::design::TaskSpace;
    use crate::kinematics::*;
    use std::time::Instant;

    #[test]
    #[ignore]
    fn timing() {
        let robot = crate::design::read_design(std::path::Path::new("/tmp/h/s7.toml")).unwrap();
        let chain = Chain::new(&robot).unwrap();
        let kernel = Kernel::<7, 6>::new(&chain, TaskSpace::SpatialPose).unwrap();
        let mut rng = crate::sampling::stream(1, 0);
        use rand::Rng;
        let goals: Vec<_> = (0..1000)
            .map(|_| {
                let q: Vec<f64> = (0..7).map(|_| rng.random_range(-3.14..3.14)).collect();
                Goal::new(&chain, &chain.tool(&q))
            })
            .collect();
        let mut th = [0.1; 7];
        let t = Instant::now();
        let mut s = 0.0;
        for _ in 0..1_000_000 {
            let l = kernel.linearise(&th, &goals[0]);
            s += l.residual[0];
            th[0] += 1e-9 * s;
        }
        println!("linearise {:?} ns", t.elapsed().as_nanos() as f64 / 1e6);
        let t = Instant::now();
        for _ in 0..1_000_000 {
            let l = kernel.linearise(&th, &goals[0]);
            let n = newton_step(&l).unwrap();
            th[0] += 1e-9 * n.correction[0];
        }
        println!("newton {:?} ns {}", t.elapsed().as_nanos() as f64 / 1e6, s);
        for settings in [SearchSettings::coarse(), SearchSettings::default()] {
            let mut solver = Solver::new(kernel.clone());
            let t = Instant::now();
            let (mut comps, mut seeds, mut bad, mut wind, mut verts, mut len, mut landed) = (0, 0, 0, 0, 0, 0.0, 0);
            let mut worst = 0.0f64;
            for (i, goal) in goals.iter().enumerate() {
                let mut rng = crate::sampling::stream(2, i as u64);
                solver.solve(goal, &settings, &mut rng);
                comps += solver.curves().len();
                seeds += solver.seeds;
                landed += solver.landed;
                bad += solver.curves().iter().filter(|c| c.status != CurveStatus::Closed).count();
                wind += (solver.winding_sum() != [0; 7]) as usize;
                verts += solver.curves().iter().map(|c| c.points.len()).sum::<usize>();
                len += solver.curves().iter().map(|c| c.length).sum::<f64>();
                for c in solver.curves() {
                    for p in &c.points {
                        let l = kernel.linearise(p, goal);
                        worst = worst.max(l.residual.iter().map(|x| x * x).sum::<f64>().sqrt());
                    }
                }
            }
            println!("{:?}/pose comps {comps} seeds {seeds} landed {landed} bad {bad} wind {wind} verts {verts} len {len} worst {worst:e}", t.elapsed() / 1000);
        }
        let mut solver = Solver::new(kernel.clone());
        let t = Instant::now();
        let settings = SearchSettings { least_seeds: 10000, most_seeds: 10000, ..SearchSettings::coarse() };
        let mut rng = crate::sampling::stream(2, 1);
        solver.solve(&goals[5], &settings, &mut rng);
        println!("10000 seeds {:?} each, {} landed {:?}", t.elapsed() / 10000, solver.landed, solver.hits());
    }
}
