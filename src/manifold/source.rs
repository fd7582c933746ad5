//! A stream of pre-images for many task points: curves are shown, not kept.

use super::any_solver::{AnySolver, CurveVisitor};
use super::bounds::physical_arcs;
use super::curve::{Curve, CurveStatus};
use super::extents::Extent;
use super::pre_image::ManifoldError;
use super::segment::Segment;
use super::sliced::{Faces, Sliced};
use super::solver::{BATCH, SearchSettings};
use crate::angle::{AngleSet, Arc};
use crate::design::{Robot, TaskSpace};
use crate::kinematics::{Chain, Goal};
use nalgebra::Isometry3;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// A traced curve with all joints of the robot, in internal joint variables.
#[derive(Clone, Copy, Debug)]
pub struct CurveRef<'a> {
    /// Number of joints n.
    pub joints: usize,
    points: &'a [f64],
    tangents: &'a [f64],
    /// How tracing ended.
    pub status: CurveStatus,
    winding: &'a [i32],
}

impl<'a> CurveRef<'a> {
    pub(super) fn new(
        joints: usize,
        points: &'a [f64],
        tangents: &'a [f64],
        status: CurveStatus,
        winding: &'a [i32],
    ) -> CurveRef<'a> {
        CurveRef {
            joints,
            points,
            tangents,
            status,
            winding,
        }
    }

    /// Full turns of every joint along the curve.
    pub fn winding(&self) -> &'a [i32] {
        self.winding
    }

    /// The number of vertices, at least 1.
    pub fn vertices(&self) -> usize {
        self.points.len() / self.joints
    }

    /// Vertex `index`, unwrapped along the curve.
    pub fn point(&self, index: usize) -> &'a [f64] {
        &self.points[index * self.joints..][..self.joints]
    }

    /// Unit tangent at vertex `index`.
    pub fn tangent(&self, index: usize) -> &'a [f64] {
        &self.tangents[index * self.joints..][..self.joints]
    }

    /// Arc length of segment `index` and the angle by which its tangent turns.
    pub fn bend(&self, index: usize) -> (f64, f64) {
        let square =
            |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum() };
        let chord = square(self.point(index), self.point(index + 1));
        let turn = square(self.tangent(index), self.tangent(index + 1));
        (chord.sqrt() * (1.0 + turn / 24.0), turn.sqrt())
    }

    fn coordinate(&self, index: usize, joint: usize, length: f64) -> Segment<1> {
        let (a, b) = (self.point(index)[joint], self.point(index + 1)[joint]);
        Segment {
            start: [a],
            chord: [b - a],
            first: [self.tangent(index)[joint]],
            last: [self.tangent(index + 1)[joint]],
            length,
        }
    }

    /// Hands the configuration at parameter `u` of segment `index` to `take`.
    pub fn at(&self, index: usize, u: f64, take: impl FnOnce(&[f64])) {
        let (length, _) = self.bend(index);
        let mut point = smallvec::SmallVec::<[f64; 8]>::new();
        for joint in 0..self.joints {
            point.push(self.coordinate(index, joint, length).coordinate(0, u));
        }
        take(&point);
    }

    /// The angles that `joint` (from 0) takes along the curve.
    pub fn range(&self, joint: usize) -> Arc {
        if self.winding[joint] != 0 {
            return Arc::FULL;
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut widen = |value: f64| {
            low = low.min(value);
            high = high.max(value);
        };
        for index in 0..self.vertices() {
            widen(self.point(index)[joint]);
            let inner = index + 1 < self.vertices()
                && self.tangent(index)[joint] * self.tangent(index + 1)[joint] <= 0.0;
            if inner {
                let segment = self.coordinate(index, joint, self.bend(index).0);
                for u in segment.extrema(0).into_iter().flatten() {
                    widen(segment.coordinate(0, u));
                }
            }
        }
        if high - low >= TAU {
            Arc::FULL
        } else {
            Arc::from_interval(low, high)
        }
    }
}

/// A tool pose with the random stream of its search.
pub type Pose = (Isometry3<f64>, ChaCha8Rng);

/// Finds the pre-image of one task point after the other, as curves.
#[derive(Clone, Debug)]
pub struct CurveSource {
    chain: Chain,
    settings: SearchSettings,
    method: Method,
}

#[derive(Clone, Debug)]
enum Method {
    /// One degree of redundancy: the pre-image is curves.
    Curves(AnySolver),
    /// More: it is cut into curves.
    Slices(Box<Sliced>),
}

/// Largest degree of redundancy that is served.
pub const MOST_REDUNDANT: usize = 3;

impl CurveSource {
    /// Curves of `robot` for `task`, in the frame of joint 1 (see
    /// [`crate::kinematics::Chain::base`]). With more than one degree of redundancy, `slices`
    /// values of each surplus joint.
    ///
    /// # Errors
    /// A degree of redundancy outside 1 … [`MOST_REDUNDANT`], or a prismatic joint without
    /// limits.
    pub fn new(
        robot: &Robot,
        task: TaskSpace,
        slices: usize,
        settings: SearchSettings,
    ) -> Result<CurveSource, ManifoldError> {
        let mut chain = Chain::new(robot).ok_or(ManifoldError::Unlimited)?;
        chain.base = Isometry3::identity();
        let method = AnySolver::new(&chain, task)
            .map(Method::Curves)
            .or_else(|| {
                let sliced =
                    Sliced::new(&chain, physical_arcs(robot), task, slices.max(4), settings)?;
                Some(Method::Slices(Box::new(sliced)))
            })
            .ok_or_else(|| ManifoldError::Redundancy {
                joints: robot.joints(),
                dimension: task.dimension(),
                degree: robot.degree_of_redundancy(task),
                wanted: "1, 2 or 3",
            })?;
        Ok(CurveSource {
            chain,
            settings,
            method,
        })
    }

    /// Number of joints n.
    pub fn joints(&self) -> usize {
        self.chain.len()
    }

    /// Half the distance between slices along each joint, radians: 0 where the pre-image is not
    /// cut along that joint.
    pub fn slabs(&self) -> Vec<f64> {
        let mut slabs = vec![0.0; self.joints()];
        if let Method::Slices(sliced) = &self.method {
            for (joint, slab) in slabs.iter_mut().enumerate() {
                *slab = 0.5 * sliced.spacing(joint);
            }
        }
        slabs
    }

    /// Finds the pre-image of one tool pose; see [`CurveSource::show`].
    pub fn solve(
        &mut self,
        tool: &Isometry3<f64>,
        rng: &mut ChaCha8Rng,
        show: impl FnMut(CurveRef<'_>),
    ) -> Vec<AngleSet> {
        let mut poses = [(*tool, rng.clone())];
        self.search_all(&mut poses);
        let ranges = self.show(0, &mut poses[0], show);
        *rng = poses[0].1.clone();
        ranges
    }

    /// Most task points that [`CurveSource::search_all`] should be given.
    pub fn batch(&self) -> usize {
        match &self.method {
            Method::Curves(_) => BATCH,
            Method::Slices(sliced) => sliced.batch(),
        }
    }

    /// Searches many task points together, given as tool poses in the frame of joint 1, each with
    /// its own random stream; what is found does not depend on the others.
    pub fn search_all(&mut self, poses: &mut [Pose]) {
        match &mut self.method {
            Method::Curves(solver) => {
                let goal = |tool: &Isometry3<f64>| Goal::new(&self.chain, tool);
                let jobs = poses.iter_mut().map(|(tool, rng)| (goal(tool), rng));
                solver.solve_all(&mut jobs.collect::<Vec<_>>(), &self.settings);
            }
            Method::Slices(sliced) => sliced.search_all(poses),
        }
    }

    /// Shows the curves of task point `index` of the last [`CurveSource::search_all`], to be given
    /// once more, and returns the range Θ of every joint, physical limits left out. If a joint
    /// from 2 on has some, surfaces show their curves on these walls as well, and ranges are those
    /// of [`CurveSource::ranges_within`]. The other methods then speak of this task point.
    pub fn show(
        &mut self,
        index: usize,
        pose: &mut Pose,
        mut show: impl FnMut(CurveRef<'_>),
    ) -> Vec<AngleSet> {
        match &mut self.method {
            Method::Curves(solver) => {
                solver.turn_to(index);
                solver.show_with_ranges(show)
            }
            Method::Slices(sliced) => {
                let ranges = sliced.show(index, pose, &mut show);
                sliced.show_walls(pose, &mut show);
                ranges
            }
        }
    }

    /// Θ of every joint inside the physical limits of the joints from 2 on, from its ranges on
    /// all `parts` of the curves of [`CurveSource::solve`] inside them.
    pub fn ranges_within(&self, tool: &Isometry3<f64>, parts: &[Extent]) -> Vec<AngleSet> {
        match &self.method {
            Method::Curves(_) => {
                let own = |joint| parts.iter().filter(move |part| part.joint == joint);
                let set = |joint| AngleSet::from_arcs(own(joint).map(|part| part.arc));
                (0..self.joints()).map(set).collect()
            }
            Method::Slices(sliced) => sliced.ranges(tool, parts),
        }
    }

    /// The faces of a box of limits ([lower, upper] in internal radians, `None` where a joint is
    /// free), for [`CurveSource::search_faces`]; none with one degree of redundancy.
    pub fn faces(&self, limits: &[Option<[f64; 2]>]) -> Option<Faces> {
        match &self.method {
            Method::Curves(_) => None,
            Method::Slices(sliced) => Some(sliced.faces(limits)),
        }
    }

    /// Finds the curves of many task points on the faces of a box; see
    /// [`CurveSource::show_faces`].
    pub fn search_faces<'p>(&self, poses: impl Iterator<Item = &'p mut Pose>, faces: &mut Faces) {
        if let Method::Slices(sliced) = &self.method {
            sliced.search_faces(poses, faces);
        }
    }

    /// Shows the curves on the faces of task point `index` of the last
    /// [`CurveSource::search_faces`]; returns the random starts made.
    pub fn show_faces(
        &self,
        index: usize,
        faces: &mut Faces,
        mut show: impl FnMut(CurveRef<'_>),
    ) -> usize {
        faces.show(index, &mut show)
    }

    /// Random starts made for the last task point.
    pub fn seeds(&self) -> usize {
        match &self.method {
            Method::Curves(solver) => solver.effort().0,
            Method::Slices(sliced) => sliced.seeds,
        }
    }

    /// Whether every check of the last task point passed: all curves closed and the winding
    /// vectors sum to zero.
    pub fn is_sound(&self) -> bool {
        match &self.method {
            Method::Curves(solver) => solver.is_sound(),
            Method::Slices(sliced) => sliced.sound,
        }
    }
}

impl AnySolver {
    /// Shows every curve of the last task point.
    pub(super) fn show(&self, show: impl FnMut(CurveRef<'_>)) {
        self.visit(&mut Show(show));
    }

    /// Shows every curve of the last task point; returns the range of every joint.
    fn show_with_ranges(&self, mut show: impl FnMut(CurveRef<'_>)) -> Vec<AngleSet> {
        let mut arcs: Vec<Vec<Arc>> = vec![Vec::new(); self.joints()];
        self.show(|curve| {
            for (joint, arcs) in arcs.iter_mut().enumerate() {
                arcs.push(curve.range(joint));
            }
            show(curve);
        });
        arcs.into_iter().map(AngleSet::from_arcs).collect()
    }
}

struct Show<F>(F);

impl<F: FnMut(CurveRef<'_>)> CurveVisitor for Show<F> {
    fn visit<const N: usize>(&mut self, curve: &Curve<N>) {
        (self.0)(CurveRef {
            joints: N,
            points: curve.points.as_flattened(),
            tangents: curve.tangents.as_flattened(),
            status: curve.status,
            winding: &curve.winding,
        });
    }
}
