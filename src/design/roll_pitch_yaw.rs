//! A rotation as the three angles that robot files and URDF files hold.

use nalgebra::UnitQuaternion;

/// Roll, pitch and yaw of R_z(yaw) R_y(pitch) R_x(roll), radians.
///
/// Exact to round-off everywhere: next to pitch ±90°, where roll and yaw turn about one axis, any
/// yaw will do as long as roll is measured after the yaw that was chosen.
pub(super) fn roll_pitch_yaw(rotation: &UnitQuaternion<f64>) -> [f64; 3] {
    let matrix = rotation.to_rotation_matrix();
    let at = |row: usize, column: usize| matrix[(row, column)];
    let yaw = at(1, 0).atan2(at(0, 0));
    let (sine, cosine) = yaw.sin_cos();
    // The second row of R_z(−yaw) R is (0, cos roll, −sin roll).
    let second = |column: usize| cosine * at(1, column) - sine * at(0, column);
    let level = cosine * at(0, 0) + sine * at(1, 0);
    let pitch = (-at(2, 0)).atan2(level);
    // Adding zero turns −0 into 0.
    [(-second(2)).atan2(second(1)), pitch, yaw].map(|angle| angle + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_PI_2;

    fn assert_round_trip(rotation: UnitQuaternion<f64>) {
        let [roll, pitch, yaw] = roll_pitch_yaw(&rotation);
        let back = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        let (a, b) = (rotation.to_rotation_matrix(), back.to_rotation_matrix());
        let miss = (a.matrix() - b.matrix()).amax();
        assert!(miss < 1e-14, "{miss:e} for {roll} {pitch} {yaw}");
    }

    #[test]
    fn gimbal_lock_and_its_neighbourhood() {
        for roll in [-FRAC_PI_2, 0.0, 0.3, FRAC_PI_2, 3.0] {
            for yaw in [-2.0, 0.0, FRAC_PI_2, 3.0] {
                for off in [0.0, 1e-16, 1e-12, 1e-10, 1e-8, 1e-6, 1e-3] {
                    for pitch in [FRAC_PI_2 - off, off - FRAC_PI_2, FRAC_PI_2 + off] {
                        assert_round_trip(UnitQuaternion::from_euler_angles(roll, pitch, yaw));
                    }
                }
            }
        }
    }

    #[test]
    fn the_identity_has_no_angles() {
        assert_eq!(roll_pitch_yaw(&UnitQuaternion::identity()), [0.0; 3]);
    }

    proptest! {
        #[test]
        fn angles_give_the_rotation_back(roll in -4.0..4.0f64, pitch in -4.0..4.0f64, yaw in -4.0..4.0f64) {
            assert_round_trip(UnitQuaternion::from_euler_angles(roll, pitch, yaw));
        }
    }
}
