//! Every self-motion manifold of a location, with the branches through its singular configurations
//! [S1 Algorithm 2].
//!
//! Random starts find the curves of a regular pose. At a singular one they also land next to
//! nodes, where curves meet and Newton steps crawl; there the branches are known from the null
//! space and second-order conditions ([`super::branches`]), and each is traced like any other
//! curve. Curves that share a node form one connected set, between whose configurations the robot
//! moves without moving its tool; the size of a location counts all sets [S1 §III].

use super::branches::directions;
use super::connected::{connected_sets, incidence, ranges_of};
use super::ranges::{joint_ranges, size};
use super::stratum::{Arm, SINGULAR};
use super::surface::SingularSurface;
use crate::angle::{AngleSet, Arc, wrap};
use crate::design::TaskSpace;
use crate::kinematics::Chain;
use crate::manifold::{
    Completeness, CurveStatus, ManifoldError, PreImageSearch, SearchSettings, SelfMotionManifold,
};
use nalgebra::Isometry3;
use rand_chacha::ChaCha8Rng;

/// A singular configuration at which self-motion manifolds of a location meet or end.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// n internal joint variables.
    pub theta: Vec<f64>,
    /// By how much J falls short of rank m.
    pub loss: usize,
    /// Singular values, greatest first.
    pub sigma: Vec<f64>,
    /// Branches of self-motion through it, both senses as one.
    pub branches: usize,
    /// Indices of the manifolds that run through it.
    pub manifolds: Vec<usize>,
}

/// Configurations between which the robot can move without moving its tool.
#[derive(Clone, Debug, PartialEq)]
pub struct ConnectedSet {
    /// Indices of its manifolds.
    pub manifolds: Vec<usize>,
    /// Indices of its nodes.
    pub nodes: Vec<usize>,
    /// Indices of its singular surfaces.
    pub surfaces: Vec<usize>,
    /// Angles of every joint over the set.
    pub ranges: Vec<AngleSet>,
    /// Sum of the measures of these, radians.
    pub size: f64,
}

/// A tool pose with all its self-motion manifolds.
#[derive(Clone, Debug, PartialEq)]
pub struct Location {
    /// The pose of the tool in the world.
    pub tool: Isometry3<f64>,
    /// Its manifolds.
    pub manifolds: Vec<SelfMotionManifold>,
    /// Singular configurations on them.
    pub nodes: Vec<Node>,
    /// Parts of the pre-image that are singular throughout.
    pub surfaces: Vec<SingularSurface>,
    /// Connected sets, the largest first.
    pub sets: Vec<ConnectedSet>,
    /// Angles of every joint over all manifolds and surfaces, inside the physical limits.
    pub ranges: Vec<AngleSet>,
    /// Sum of the measures of these, radians: the size of the location.
    pub size: f64,
    /// How sure it is that no manifold is missing.
    pub completeness: Completeness,
}

impl Location {
    /// Whether every part of the pre-image was followed to its end, so that nothing is missing in
    /// the size.
    pub fn is_whole(&self) -> bool {
        let ended = |manifold: &SelfMotionManifold| {
            matches!(manifold.status, CurveStatus::Closed | CurveStatus::Stroke)
        };
        let some = !self.manifolds.is_empty() || !self.surfaces.is_empty();
        some && self.manifolds.iter().all(ended)
    }
}

/// Finds the manifolds of locations of one robot.
#[derive(Clone, Debug)]
pub struct LocationSearch {
    fine: PreImageSearch,
    coarse: PreImageSearch,
    task: TaskSpace,
    physical: Vec<Arc>,
}

/// Step from a node onto its branches, radians.
const AWAY: f64 = 0.03;
/// A configuration lies on a curve within this distance, radians.
pub(super) const ON_CURVE: f64 = 6e-3;
/// Nodes nearer to each other are one, radians.
const SAME: f64 = 2e-3;
/// A node may miss the pose by this, metres and radians.
const NEARLY: f64 = 2e-6;
/// Most nodes of a location: a pre-image with more is no set of curves.
const MOST_NODES: usize = 64;
/// Nodes are looked for where σ_m is below this share of σ₁.
const NEAR: f64 = 0.02;
/// Remains of starts that stalled next to a node are shorter, radians.
pub(super) const STALLED: f64 = 0.3;

impl LocationSearch {
    /// For `chain` with one joint more than `task` has dimensions; `physical` holds the physical
    /// limits of every joint as arcs of internal variables.
    ///
    /// # Errors
    /// Another degree of redundancy, or an arm that cannot do the task anywhere.
    pub fn new(
        chain: &Chain,
        task: TaskSpace,
        physical: Vec<Arc>,
    ) -> Result<LocationSearch, ManifoldError> {
        let search = |settings| PreImageSearch::from_chain(chain.clone(), task, settings);
        Ok(LocationSearch {
            fine: search(SearchSettings::default())?,
            coarse: search(SearchSettings::coarse())?,
            task,
            physical,
        })
    }

    /// The robot and its task.
    pub fn arm(&self) -> Arm<'_> {
        Arm {
            chain: self.fine.chain(),
            task: self.task,
        }
    }

    /// Physical limits of every joint as arcs of internal variables.
    pub fn physical(&self) -> &[Arc] {
        &self.physical
    }

    /// Manifolds and size of a location as random starts find them, quickly: the size is good to
    /// about 1e-4 rad, or with `fine` 1e-6.
    pub fn screen(
        &mut self,
        tool: &Isometry3<f64>,
        fine: bool,
        rng: &mut ChaCha8Rng,
    ) -> (Vec<SelfMotionManifold>, f64) {
        let search = if fine {
            &mut self.fine
        } else {
            &mut self.coarse
        };
        let found = search.find(tool, rng);
        let size = size(&joint_ranges(&found.manifolds, &self.physical));
        (found.manifolds, size)
    }

    /// Everything about a location. `known` are singular configurations on it that are known
    /// already, such as the one it was made from.
    pub fn explore(
        &mut self,
        tool: &Isometry3<f64>,
        known: &[Vec<f64>],
        rng: &mut ChaCha8Rng,
    ) -> Location {
        let found = self.fine.find(tool, rng);
        let completeness = found.completeness;
        let mut work = Work {
            search: &self.fine,
            arm: self.arm(),
            tool,
            manifolds: found.manifolds,
            nodes: Vec::new(),
            surfaces: Vec::new(),
            physical: &self.physical,
        };
        for theta in known {
            work.add_node(theta);
        }
        let mut looked_at = 0;
        while looked_at < work.manifolds.len() {
            work.nodes_of(looked_at);
            looked_at += 1;
        }
        let mut followed = 0;
        while followed < work.nodes.len() {
            work.follow_branches(followed);
            followed += 1;
        }
        work.drop_stalled();
        work.finish(completeness)
    }
}

/// A location while it is explored.
struct Work<'a> {
    search: &'a PreImageSearch,
    arm: Arm<'a>,
    tool: &'a Isometry3<f64>,
    manifolds: Vec<SelfMotionManifold>,
    nodes: Vec<Node>,
    surfaces: Vec<SingularSurface>,
    physical: &'a [Arc],
}

impl Work<'_> {
    /// Looks for nodes where the manifold was led across a singular configuration or ended, and
    /// where σ_m is least along it.
    fn nodes_of(&mut self, index: usize) {
        let manifold = self.manifolds[index].clone();
        let last = manifold.vertices() - 1;
        if manifold.crossings.len() > MOST_NODES {
            // The tracer crawls along singular configurations.
            self.add_node(manifold.point(last / 2));
            return;
        }
        for k in self.least_regular(&manifold) {
            self.add_node(manifold.point(k));
        }
        for &behind in &manifold.crossings {
            let after = behind.min(last);
            let before = after.saturating_sub(1);
            let middle = (manifold.point(before).iter())
                .zip(manifold.point(after))
                .map(|(a, b)| 0.5 * (a + b))
                .collect::<Vec<f64>>();
            self.add_node(&middle);
        }
        if manifold.status == CurveStatus::Singular {
            self.add_node(manifold.point(0));
            self.add_node(manifold.point(last));
        }
    }

    /// Vertices at which σ_m has a minimum near 0.
    fn least_regular(&self, manifold: &SelfMotionManifold) -> Vec<usize> {
        let share = |k: usize| {
            let sigma = self.arm.singular_values(manifold.point(k));
            sigma[sigma.len() - 1] / sigma[0]
        };
        let shares: Vec<f64> = (0..manifold.vertices()).map(share).collect();
        let is_least = |k: &usize| {
            let beside = [k.saturating_sub(1), (k + 1).min(shares.len() - 1)];
            shares[*k] < NEAR && beside.iter().all(|&other| shares[*k] <= shares[other])
        };
        (0..shares.len()).filter(is_least).collect()
    }

    /// Adds the singular configuration of the location next to `theta`, if there is one.
    fn add_node(&mut self, theta: &[f64]) {
        if self.nodes.len() >= MOST_NODES {
            return;
        }
        let sigma = self.arm.singular_values(theta);
        let guess = sigma.iter().filter(|s| **s < 0.03 * sigma[0]).count();
        for loss in (1..=guess.max(1)).rev() {
            let exact = self.arm.settle(theta, loss, Some(self.tool));
            let Some(theta) = exact.or_else(|| self.nearly(theta, loss)) else {
                continue;
            };
            let parts = self.arm.parts(&theta);
            let loss = parts.loss(SINGULAR);
            if loss == 0 {
                continue;
            }
            let same = |surface: &SingularSurface| surface.loss == loss && surface.holds(&theta);
            if self.surfaces.iter().any(same) {
                return;
            }
            if self
                .nodes
                .iter()
                .any(|node| apart(&node.theta, &theta) < SAME)
            {
                return;
            }
            let point = (theta.as_slice(), loss);
            let around =
                SingularSurface::beside(&self.arm, self.tool, point, self.physical, &self.surfaces);
            self.surfaces.extend(around);
            let surface =
                SingularSurface::through(&self.arm, self.tool, &theta, loss, self.physical);
            if let Some(surface) = surface {
                self.surfaces.push(surface);
            } else {
                self.nodes.push(Node {
                    theta,
                    loss,
                    sigma: parts.sigma,
                    branches: 0,
                    manifolds: Vec::new(),
                });
            }
            return;
        }
    }

    /// The singular configuration next to `theta` if it holds the pose but for [`NEARLY`].
    ///
    /// A location that was refined numerically misses its nodes by what the refinement left.
    fn nearly(&self, theta: &[f64], loss: usize) -> Option<Vec<f64>> {
        let close = self
            .arm
            .settle_within(theta, loss, Some(self.tool), NEARLY)?;
        let settled = self.arm.settle(&close, loss, None)?;
        (apart(&settled, &close) < SAME).then_some(settled)
    }

    /// Traces every branch through a node that no known manifold follows.
    fn follow_branches(&mut self, index: usize) {
        let (theta, loss) = (self.nodes[index].theta.clone(), self.nodes[index].loss);
        let mut branches = 0;
        for direction in directions(&self.arm, &theta, loss) {
            let mut exists = false;
            for sense in [1.0, -1.0] {
                let step = |(angle, share): (&f64, &f64)| angle + sense * AWAY * share;
                let guess: Vec<f64> = theta.iter().zip(&direction).map(step).collect();
                if self.is_covered(&guess) {
                    exists = true;
                    continue;
                }
                let Some(manifold) = self.search.trace(self.tool, &guess) else {
                    continue;
                };
                // Newton steps may lead from a guess beside all curves to a branch known already.
                let near = manifold.locate(&guess, 0.5 * AWAY).is_some();
                exists |= near;
                if near && !self.is_known(&manifold) {
                    self.manifolds.push(manifold);
                    self.nodes_of(self.manifolds.len() - 1);
                }
            }
            branches += usize::from(exists);
        }
        self.nodes[index].branches = branches;
    }

    fn is_covered(&self, theta: &[f64]) -> bool {
        let whole = |m: &&SelfMotionManifold| m.length > STALLED;
        let mut manifolds = self.manifolds.iter().filter(whole);
        manifolds.any(|manifold| manifold.locate(theta, ON_CURVE).is_some())
    }

    /// Whether samples of a new manifold all lie on one known.
    fn is_known(&self, new: &SelfMotionManifold) -> bool {
        let stride = new.vertices().div_ceil(8);
        let mut manifolds = self.manifolds.iter();
        manifolds.any(|old| {
            (0..new.vertices())
                .step_by(stride)
                .all(|k| old.locate(new.point(k), ON_CURVE).is_some())
        })
    }

    /// Drops what starts left that stalled next to nodes, whose branches have been traced, or to
    /// surfaces, whose ranges are known.
    fn drop_stalled(&mut self) {
        let is_stalled = |manifold: &SelfMotionManifold| {
            let mut points = (0..manifold.vertices()).map(|k| manifold.point(k));
            let near_node = |point: &[f64]| {
                let mut nodes = self.nodes.iter();
                nodes.any(|node| apart(&node.theta, point) < STALLED)
            };
            let near_surface =
                |point: &[f64]| self.surfaces.iter().any(|surface| surface.is_near(point));
            let short = manifold.status == CurveStatus::Singular && manifold.length < STALLED;
            match short {
                true => points.all(|p| near_node(p) || near_surface(p)),
                false => points.all(near_surface),
            }
        };
        let kept: Vec<bool> = self.manifolds.iter().map(|m| !is_stalled(m)).collect();
        let mut kept = kept.into_iter();
        self.manifolds.retain(|_| kept.next().unwrap_or(true));
    }

    fn finish(self, completeness: Completeness) -> Location {
        let Work {
            manifolds,
            mut nodes,
            surfaces,
            physical,
            tool,
            ..
        } = self;
        incidence(&mut nodes, &manifolds);
        let all: Vec<usize> = (0..manifolds.len()).collect();
        let every: Vec<usize> = (0..surfaces.len()).collect();
        let ranges = ranges_of((&manifolds, &all), (&surfaces, &every), physical);
        Location {
            tool: *tool,
            sets: connected_sets(&manifolds, &nodes, &surfaces, physical),
            size: size(&ranges),
            ranges,
            manifolds,
            nodes,
            surfaces,
            completeness,
        }
    }
}

/// Distance of configurations, full turns left out.
pub(super) fn apart(a: &[f64], b: &[f64]) -> f64 {
    let square = |(x, y): (&f64, &f64)| wrap(x - y).powi(2);
    a.iter().zip(b).map(square).sum::<f64>().sqrt()
}
