//! What becomes of self-motion manifolds next to a singular configuration [S1 Fig. 1].

use super::catalogue::Catalogue;
use super::location::LocationSearch;
use crate::manifold::SelfMotionManifold;
use crate::sampling::stream;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

/// A node with the manifolds of its location and of two neighbours.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// The singular configuration, n internal joint variables.
    pub node: Vec<f64>,
    /// Index of the singularity in its catalogue.
    pub index: usize,
    /// How far the tool is moved along the direction that is lost, metres and radians.
    pub step: f64,
    /// Manifolds and size (radians) behind, at and before the node.
    pub locations: [(Vec<SelfMotionManifold>, f64); 3],
}

/// Members of a family that are tried, and families.
const TRIED: [usize; 2] = [3, 8];

/// The first singular configuration of rank loss 1 through which two branches run, with its
/// neighbours at distance `step`; frequent families come first. `None` if there is none.
pub fn find_split(
    search: &mut LocationSearch,
    catalogue: &Catalogue,
    step: f64,
    seed: u64,
) -> Option<Split> {
    let families = catalogue.families.iter().enumerate();
    for (family, _) in families.filter(|(_, f)| f.loss == 1).take(TRIED[1]) {
        let members = catalogue.singularities.iter().enumerate();
        for (index, member) in members.filter(|(_, s)| s.family == family).take(TRIED[0]) {
            let tool = search.arm().chain.tool(&member.theta);
            let known = [member.theta.clone()];
            let location = search.explore(&tool, &known, &mut stream(seed, 7));
            let own =
                |node: &&super::Node| super::location::apart(&node.theta, &member.theta) < 1e-4;
            let crossed = location
                .nodes
                .iter()
                .find(own)
                .is_some_and(|node| node.branches == 2);
            if !crossed || !location.surfaces.is_empty() {
                continue;
            }
            let arm = search.arm();
            let lost: Vec<f64> = arm
                .parts(&member.theta)
                .lost(1)
                .column(0)
                .iter()
                .copied()
                .collect();
            let mut beside = |sense: f64| {
                let moved = displaced(&tool, &lost, sense * step);
                search.screen(&moved, true, &mut stream(seed, 8))
            };
            let (behind, before) = (beside(-1.0), beside(1.0));
            return Some(Split {
                node: member.theta.clone(),
                index,
                step,
                locations: [behind, (location.manifolds, location.size), before],
            });
        }
    }
    None
}

/// The pose moved along the rows of a task: position first, then rotation.
fn displaced(tool: &Isometry3<f64>, rows: &[f64], by: f64) -> Isometry3<f64> {
    let at = |k: usize| by * rows.get(k).copied().unwrap_or(0.0);
    let (v, w) = match rows.len() {
        2 => (Vector3::new(at(0), at(1), 0.0), Vector3::zeros()),
        6 => (
            Vector3::new(at(0), at(1), at(2)),
            Vector3::new(at(3), at(4), at(5)),
        ),
        _ => (Vector3::new(at(0), at(1), at(2)), Vector3::zeros()),
    };
    let translation = Translation3::from(tool.translation.vector + v);
    Isometry3::from_parts(
        translation,
        UnitQuaternion::from_scaled_axis(w) * tool.rotation,
    )
}
