//! Which manifolds, nodes and surfaces of a location hang together.

use super::location::{ConnectedSet, Node, ON_CURVE};
use super::ranges::{joint_ranges, size};
use super::surface::SingularSurface;
use crate::angle::{AngleSet, Arc};
use crate::manifold::SelfMotionManifold;

/// Joint ranges over some manifolds and surfaces.
pub(super) fn ranges_of(
    (manifolds, own): (&[SelfMotionManifold], &[usize]),
    (surfaces, touched): (&[SingularSurface], &[usize]),
    physical: &[Arc],
) -> Vec<AngleSet> {
    let own: Vec<SelfMotionManifold> = own.iter().map(|&k| manifolds[k].clone()).collect();
    let mut ranges = joint_ranges(&own, physical);
    for &k in touched {
        for (range, more) in ranges.iter_mut().zip(&surfaces[k].ranges) {
            *range = range.union(more);
        }
    }
    ranges
}

/// Finds which manifolds run through which nodes.
pub(super) fn incidence(nodes: &mut [Node], manifolds: &[SelfMotionManifold]) {
    for node in nodes {
        let through = |k: &usize| manifolds[*k].locate(&node.theta, 2.0 * ON_CURVE).is_some();
        node.manifolds = (0..manifolds.len()).filter(through).collect();
    }
}

/// Groups manifolds that share nodes, and surfaces that touch these.
pub(super) fn connected_sets(
    manifolds: &[SelfMotionManifold],
    nodes: &[Node],
    surfaces: &[SingularSurface],
    physical: &[Arc],
) -> Vec<ConnectedSet> {
    // Manifolds first, then surfaces.
    let mut group: Vec<usize> = (0..manifolds.len() + surfaces.len()).collect();
    for node in nodes {
        let on = |k: &usize| surfaces[*k].holds(&node.theta);
        let touched = (0..surfaces.len()).filter(on).map(|k| manifolds.len() + k);
        let parts: Vec<usize> = node.manifolds.iter().copied().chain(touched).collect();
        let joined: Vec<usize> = parts.iter().map(|&k| group[k]).collect();
        let Some(&least) = joined.iter().min() else {
            continue;
        };
        for entry in group.iter_mut().filter(|entry| joined.contains(entry)) {
            *entry = least;
        }
    }
    let mut sets = Vec::new();
    for name in 0..group.len() {
        let members = |k: &usize| group[*k] == name;
        let own: Vec<usize> = (0..manifolds.len()).filter(members).collect();
        let behind = |k: &usize| group[manifolds.len() + k] == name;
        let touched: Vec<usize> = (0..surfaces.len()).filter(behind).collect();
        if own.is_empty() && touched.is_empty() {
            continue;
        }
        let ranges = ranges_of((manifolds, &own), (surfaces, &touched), physical);
        let touches = |k: &usize| nodes[*k].manifolds.iter().any(|m| own.contains(m));
        sets.push(ConnectedSet {
            nodes: (0..nodes.len()).filter(touches).collect(),
            manifolds: own,
            surfaces: touched,
            size: size(&ranges),
            ranges,
        });
    }
    sets.sort_by(|a, b| b.size.total_cmp(&a.size));
    sets
}
