//! Structural verdicts: which robots have a joint that stands still in every self-motion.

use faultspace::design::{Robot, TaskSpace, read_design};
use faultspace::manifold::{Intolerance, SelfMotionShares};
use std::path::Path;

fn design(name: &str) -> Robot {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("designs");
    read_design(&folder.join(name)).unwrap()
}

#[test]
fn print_all() {
    for name in ["pa10.toml","kuka_iiwa_14.toml","kuka_iiwa_14_limits.toml","franka_panda.toml","kinova_gen3.toml","spatial_7r.toml","spatial_7r_wrist.toml","spatial_8r.toml","planar_3r_equal.toml","planar_4r.toml","spatial_4r.toml","spatial_5r.toml"] {
        let robot = design(name);
        for task in TaskSpace::ALL {
            if task.is_planar() != robot.planar_chain().is_ok() { continue; }
            let t = std::time::Instant::now();
            let Some(s) = SelfMotionShares::of(&robot, task) else { continue };
            let a = t.elapsed();
            let v = Intolerance::of(&robot, task, |_| true);
            println!("{name} {task}: {} {:.1e?} med {:.1e?} {a:?} {:?}", s.configurations, s.largest, s.median, t.elapsed());
            if let Some(v) = v { println!("   {v}\n {:?}", v.cures); }
        }
    }
}
