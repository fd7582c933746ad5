//! Curves of a robot with some joints fixed, as curves of the whole robot.

use super::source::CurveRef;

/// Room for a curve with the fixed joints put back.
#[derive(Default)]
pub(super) struct Lift {
    points: Vec<f64>,
    tangents: Vec<f64>,
    winding: Vec<i32>,
}

impl Lift {
    /// The whole robot's curve; `fixed` joints stand still, ascending.
    pub fn lift<'a>(&'a mut self, curve: &CurveRef<'_>, fixed: &[(usize, f64)]) -> CurveRef<'a> {
        self.points.clear();
        self.tangents.clear();
        self.winding.clear();
        for index in 0..curve.vertices() {
            spread(curve.point(index), fixed.iter().copied(), &mut self.points);
            let still = fixed.iter().map(|&(joint, _)| (joint, 0.0));
            spread(curve.tangent(index), still, &mut self.tangents);
        }
        let still = fixed.iter().map(|&(joint, _)| (joint, 0));
        spread(curve.winding(), still, &mut self.winding);
        CurveRef::new(
            curve.joints + fixed.len(),
            &self.points,
            &self.tangents,
            curve.status,
            &self.winding,
        )
    }
}

/// Appends `values` with the `fixed` entries (ascending joints) put in their places.
fn spread<T: Copy>(values: &[T], fixed: impl Iterator<Item = (usize, T)>, out: &mut Vec<T>) {
    let begin = out.len();
    out.extend_from_slice(values);
    for (joint, value) in fixed {
        out.insert(begin + joint, value);
    }
}
