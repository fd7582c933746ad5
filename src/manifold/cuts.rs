//! Where a pre-image of two or three dimensions is cut into curves: which joints are held, and at
//! which values, so that one degree of redundancy is left.

use crate::angle::Arc;

/// Joints (from 0, ascending) with the values at which they are held.
pub(super) type Held = Vec<(usize, f64)>;

/// The cuts through one robot's pre-images.
#[derive(Clone, Debug)]
pub(super) struct Cuts {
    joints: usize,
    /// The joints that the grid holds, one fewer than the degree of redundancy.
    pub cut: Vec<usize>,
    /// Values of each.
    pub per_joint: usize,
    /// Physical limits of every joint.
    bounds: Vec<Arc>,
}

impl Cuts {
    /// Cuts for a robot with physical limits `bounds` and 2 or 3 degrees of redundancy.
    pub fn new(bounds: Vec<Arc>, degree: usize, per_joint: usize) -> Cuts {
        let joints = bounds.len();
        // The joints in the middle: neither joint 1, whose angle is the image that is wanted, nor
        // the last one, on which position tasks depend least.
        let first = 1 + (joints - degree) / 2;
        Cuts {
            joints,
            cut: (first..first + degree - 1).collect(),
            per_joint,
            bounds,
        }
    }

    /// Distance between neighbouring values of `joint`, radians.
    pub fn spacing(&self, joint: usize) -> f64 {
        self.bounds[joint].width() / self.per_joint as f64
    }

    /// The values of `joint`, within its physical limits.
    fn values(&self, joint: usize) -> impl Iterator<Item = f64> + use<> {
        let bound = self.bounds[joint];
        // Limits of width 0 leave it one.
        let count = match bound.width() > 0.0 {
            true => self.per_joint,
            false => 1,
        };
        (0..count).map(move |k| bound.start() + bound.width() * (k as f64 + 0.5) / count as f64)
    }

    /// The grid.
    pub fn grid(&self) -> Vec<Held> {
        let mut grid = vec![Held::new()];
        for &joint in &self.cut {
            let longer = |held: &Held| {
                let held = held.clone();
                let with = move |value| [held.as_slice(), &[(joint, value)]].concat();
                self.values(joint).map(with)
            };
            grid = grid.iter().flat_map(longer).collect();
        }
        grid
    }

    /// The cuts with `joint` held at `value`: one with two degrees of redundancy; with three, one
    /// for every value of another joint.
    pub fn through(&self, joint: usize, value: f64) -> Vec<Held> {
        if self.cut.len() == 1 {
            return vec![vec![(joint, value)]];
        }
        let other = self.cut.iter().copied().find(|&other| other != joint);
        let others = other
            .into_iter()
            .flat_map(|other| self.values(other).map(move |value| (other, value)));
        others
            .map(|other| ascending(vec![(joint, value), other]))
            .collect()
    }

    /// The cut through a configuration.
    pub fn at(&self, theta: &[f64]) -> Held {
        self.cut
            .iter()
            .map(|&joint| (joint, theta[joint]))
            .collect()
    }

    /// The faces of a box of arcs; with three degrees of redundancy they are cut themselves, over
    /// the grid and at their edges.
    pub fn faces(&self, bounds: &[Arc]) -> Vec<Held> {
        let ends = |joint: usize| {
            let arc = bounds[joint];
            let ends = match (arc.is_full(), arc.width() > 0.0) {
                (true, _) => vec![],
                (_, true) => vec![arc.start(), arc.end()],
                (_, false) => vec![arc.start()],
            };
            ends.into_iter().map(move |end| (joint, end))
        };
        let sides: Vec<(usize, f64)> = (0..self.joints).flat_map(ends).collect();
        let mut faces: Vec<Held> = sides
            .iter()
            .flat_map(|&(joint, end)| self.through(joint, end))
            .collect();
        if self.cut.len() > 1 {
            for (k, &a) in sides.iter().enumerate() {
                let others = sides[k + 1..].iter().filter(|b| b.0 != a.0);
                faces.extend(others.map(|&b| ascending(vec![a, b])));
            }
        }
        faces
    }
}

fn ascending(mut held: Held) -> Held {
    held.sort_by_key(|&(joint, _)| joint);
    held
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nine joints and six dimensions hold joints 5 and 6 (from 1).
    #[test]
    fn as_many_joints_are_held_as_surplus_ones() {
        let mut bounds = vec![Arc::FULL; 9];
        bounds[4] = Arc::new(0.0, 1.0);
        let cuts = Cuts::new(bounds, 3, 4);
        assert_eq!(cuts.cut, [4, 5]);
        let grid = cuts.grid();
        assert_eq!(grid.len(), 16);
        assert!(grid.iter().all(|held| held.len() == 2 && held[0].1 < 1.0));
        let through = cuts.through(7, 0.5);
        assert!(through.iter().all(|held| held[1] == (7, 0.5)));
        assert_eq!(cuts.through(4, 0.5)[0][1].0, 5);
    }

    #[test]
    fn boxes_have_faces_and_edges() {
        let bounds = |joints| vec![Arc::FULL; joints];
        let mut limits = bounds(5);
        limits[1] = Arc::new(0.0, 1.0);
        limits[3] = Arc::point(2.0);
        let two = Cuts::new(bounds(5), 2, 4);
        assert_eq!(two.faces(&limits).len(), 3);
        let three = Cuts::new(bounds(5), 3, 4);
        // Four curves on each of three faces, two edges.
        assert_eq!(three.faces(&limits).len(), 3 * 4 + 2);
    }
}
