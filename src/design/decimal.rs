//! Numbers as files hold them: the shortest decimals that are read back to the same value.

/// The shortest decimal of `value` that TOML and XML take for a floating-point number.
pub(super) fn decimal(value: f64) -> String {
    // Adding zero turns −0 into 0.
    format!("{:?}", value + 0.0)
}

/// An angle given in radians as the shortest decimal of degrees that [`f64::to_radians`] turns
/// into the same radians; the nearest one where none does.
pub(super) fn degrees(radians: f64) -> String {
    let degrees = radians.to_degrees();
    let short = |digits: usize| format!("{degrees:.digits$e}").parse().unwrap_or(degrees);
    let near = [degrees, degrees.next_up(), degrees.next_down()];
    let mut candidates = (0..17).map(short).chain(near);
    let found = candidates.find(|value: &f64| value.to_radians() == radians);
    decimal(found.unwrap_or(degrees))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn right_angles_are_short() {
        assert_eq!(degrees(FRAC_PI_2), "90.0");
        assert_eq!(degrees(-PI), "-180.0");
        assert_eq!(degrees(-0.0), "0.0");
        assert_eq!(
            degrees((-97.998701279176f64).to_radians()),
            "-97.998701279176"
        );
        assert_eq!(decimal(1e-7), "1e-7");
        assert_eq!(decimal(0.1 + 0.2), "0.30000000000000004");
    }

    proptest! {
        #[test]
        fn degrees_are_read_back(written in -3600.0..3600.0f64) {
            let radians = written.to_radians();
            let read: f64 = degrees(radians).parse().unwrap();
            prop_assert_eq!(read.to_radians(), radians);
        }

        #[test]
        fn any_radians_are_read_back_to_round_off(radians in -60.0..60.0f64) {
            let read: f64 = degrees(radians).parse().unwrap();
            prop_assert!((read.to_radians() - radians).abs() <= 2.0 * f64::EPSILON * radians.abs());
        }
    }
}
