//! Circles that bound planar workspaces, seen from joint 1.
//!
//! The boundary of what a planar chain with limited joints reaches consists of circular arcs
//! (some joints at a limit, the free ones collinear with the end point). On the circle |z| = r
//! around joint 1 such a boundary circle marks at most two polar angles, in closed form, and the
//! integral ∫ r·angle(r) dr has a closed form too. Lengths in metres, angles in radians.

use nalgebra::Complex;

/// Circles that miss each other by this share of their radii touch. Touching is the rule, not the
/// exception: where a joint is stretched at the limit of the one before it, the boundary passes
/// from one circle to another with a common tangent. A touch too many only splits a panel.
const TANGENT: f64 = 1e-10;

/// A circle of given `radius` around `centre`, with the centre in polar form.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    pub centre: Complex<f64>,
    /// |centre|
    pub distance: f64,
    /// arg(centre)
    pub bearing: f64,
    pub radius: f64,
}

/// One of the two families of points in which a circle meets the circles |z| = r:
/// counter-clockwise (+1) or clockwise (−1) of the centre's bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Side {
    Left,
    Right,
}

impl Side {
    pub fn sign(self) -> f64 {
        match self {
            Side::Left => 1.0,
            Side::Right => -1.0,
        }
    }
}

impl Circle {
    pub fn new(centre: Complex<f64>, radius: f64) -> Circle {
        Circle {
            centre,
            distance: centre.norm(),
            bearing: centre.arg(),
            radius,
        }
    }

    /// A circle whose centre lies on the x axis, at a positive distance.
    pub fn on_axis(distance: f64, radius: f64) -> Circle {
        Circle {
            centre: Complex::new(distance, 0.0),
            distance,
            bearing: 0.0,
            radius,
        }
    }

    /// The same circle turned about joint 1.
    pub fn rotated(&self, angle: f64) -> Circle {
        let bearing = self.bearing + angle;
        Circle {
            centre: Complex::from_polar(self.distance, bearing),
            bearing,
            ..*self
        }
    }

    /// Smallest distance of the circle from joint 1.
    pub fn nearest(&self) -> f64 {
        (self.distance - self.radius).abs()
    }

    /// Largest distance of the circle from joint 1.
    pub fn farthest(&self) -> f64 {
        self.distance + self.radius
    }

    /// Whether the circle crosses |z| = `r` in two points.
    pub fn crosses(&self, r: f64) -> bool {
        self.nearest() < r && r < self.farthest()
    }

    /// Four times the area of the triangle with sides r, distance, radius (Heron), zero where
    /// the circles do not meet.
    fn quadruple_area(&self, r: f64) -> f64 {
        let (d, s) = (self.distance, self.radius);
        ((r + d + s) * (r + d - s) * (r - d + s) * (s + d - r))
            .max(0.0)
            .sqrt()
    }

    /// Angle at joint 1 between the centre and either meeting point with |z| = `r`, in [0, π].
    pub fn half_angle(&self, r: f64) -> f64 {
        let (d, s) = (self.distance, self.radius);
        self.quadruple_area(r).atan2(r * r + d * d - s * s)
    }

    /// Polar angle of the meeting point with |z| = `r` on `side`, not wrapped.
    pub fn polar_angle(&self, r: f64, side: Side) -> f64 {
        self.bearing + side.sign() * self.half_angle(r)
    }

    /// Antiderivative of r · [`Circle::polar_angle`] over r: twice differentiable inside the
    /// range of radii that the circle crosses.
    ///
    /// With the circle's own angle ψ, cos ψ = (r² − d² − s²) / (2ds), integration by parts gives
    /// ½ (r²·h − s²·ψ − 2·area of the triangle) for the half angle h.
    pub fn swept_area(&self, r: f64, side: Side) -> f64 {
        let (d, s) = (self.distance, self.radius);
        let area4 = self.quadruple_area(r);
        let half_angle = area4.atan2(r * r + d * d - s * s);
        let own_angle = area4.atan2(r * r - d * d - s * s);
        let half = r * r * half_angle - s * s * own_angle - 0.5 * area4;
        0.5 * (r * r * self.bearing + side.sign() * half)
    }

    /// Distances from joint 1 of the points in which two circles meet; none for circles that are
    /// apart, nested, concentric or equal.
    pub fn crossing_radii(&self, other: &Circle) -> Option<[f64; 2]> {
        let between = other.centre - self.centre;
        let gap2 = between.norm_sqr();
        let (r1, r2) = (self.radius, other.radius);
        if gap2 <= 1e-24 * (r1 * r1 + r2 * r2) {
            return None;
        }
        let sum = r1 + r2;
        let difference = r1 - r2;
        // Meeting points: self.centre + between·(along ± i·across).
        let across2 = (sum * sum - gap2) * (gap2 - difference * difference);
        if across2 < -TANGENT * sum * sum * gap2 {
            return None;
        }
        let along = 0.5 * (1.0 + (r1 * r1 - r2 * r2) / gap2);
        let across = 0.5 * across2.max(0.0).sqrt() / gap2;
        let foot = self.centre + between * along;
        let offset = Complex::new(-between.im, between.re) * across;
        Some([(foot + offset).norm(), (foot - offset).norm()])
    }

    /// Whether two circles are the same within `tolerance` metres.
    pub fn coincides(&self, other: &Circle, tolerance: f64) -> bool {
        (self.radius - other.radius).abs() <= tolerance
            && (self.centre - other.centre).l1_norm() <= tolerance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_the_polar_angles_lie_on_the_circle() {
        let circle = Circle::new(Complex::new(0.3, -1.1), 0.9);
        for r in [0.25, 0.8, 1.4, 2.0] {
            assert!(circle.crosses(r));
            for side in [Side::Left, Side::Right] {
                let z = Complex::from_polar(r, circle.polar_angle(r, side));
                assert!(((z - circle.centre).norm() - 0.9).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn swept_area_is_the_antiderivative_of_r_times_angle() {
        // Once with the origin outside, once inside the circle.
        for (distance, radius) in [(1.2, 0.7), (0.4, 1.5)] {
            let circle = Circle::new(Complex::from_polar(distance, 2.0), radius);
            let (lo, hi) = (circle.nearest() + 0.05, circle.farthest() - 0.05);
            for side in [Side::Left, Side::Right] {
                let n = 2000;
                let h = (hi - lo) / n as f64;
                let midpoint: f64 = (0..n)
                    .map(|k| lo + (k as f64 + 0.5) * h)
                    .map(|r| h * r * circle.polar_angle(r, side))
                    .sum();
                let closed = circle.swept_area(hi, side) - circle.swept_area(lo, side);
                assert!((midpoint - closed).abs() < 1e-5, "{midpoint} {closed}");
            }
        }
    }

    #[test]
    fn crossing_radii_agree_with_a_right_angle() {
        // Circles of radius 1 around (1, 0) and (0, 1) meet at the origin and at (1, 1).
        let a = Circle::new(Complex::new(1.0, 0.0), 1.0);
        let b = Circle::new(Complex::new(0.0, 1.0), 1.0);
        let mut radii = a.crossing_radii(&b).unwrap();
        radii.sort_by(f64::total_cmp);
        assert!(radii[0].abs() < 1e-15 && (radii[1] - 2f64.sqrt()).abs() < 1e-15);
        assert!(a.crossing_radii(&a).is_none());
    }
}
