//! Numbers as people read them: with as many digits as their error allows.

use crate::workspace::Estimate;

/// Relative errors below this are the round-off of the arithmetic and not worth a "±".
const NEGLIGIBLE: f64 = 1e-9;

/// `value ± error`, rounded to two significant digits of the error.
///
/// An error of zero (or of round-off) is left out, one that is not finite is called unknown. Very
/// large and very small numbers are written with a power of ten.
pub fn with_error(value: f64, error: f64) -> String {
    if !value.is_finite() {
        return "not known".into();
    }
    if !error.is_finite() || error < 0.0 {
        return format!("{} (error unknown)", plain(value));
    }
    if error <= NEGLIGIBLE * value.abs() {
        return plain(value);
    }
    let leading = exponent(error, 1);
    let power = exponent(value, 6).max(leading);
    if (-3..=6).contains(&power) {
        let last = leading - 1;
        return format!("{} ± {}", rounded(value, last), rounded(error, last));
    }
    let scale = 10f64.powi(power);
    let last = leading - power - 1;
    let (value, error) = (rounded(value / scale, last), rounded(error / scale, last));
    format!("({value} ± {error}) × 10{}", superscript(power))
}

/// [`with_error`] of an estimate.
pub fn estimate(estimate: &Estimate) -> String {
    with_error(estimate.value, estimate.error)
}

/// `part` as a percentage of `whole`; the errors of both add up, which is on the safe side.
pub fn percentage(part: &Estimate, whole: &Estimate) -> String {
    if whole.value <= 0.0 || !whole.value.is_finite() {
        return "–".into();
    }
    let share = part.value / whole.value;
    let error = (part.error + share.abs() * whole.error) / whole.value;
    format!("{} %", with_error(100.0 * share, 100.0 * error))
}

/// A number that has no error bar, with up to six significant digits.
pub fn plain(value: f64) -> String {
    if !value.is_finite() {
        return "not known".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let power = exponent(value, 5);
    if (-4..=8).contains(&power) {
        return trimmed(&rounded(value, power.min(5) - 5));
    }
    let mantissa = trimmed(&rounded(value / 10f64.powi(power), -5));
    format!("{mantissa} × 10{}", superscript(power))
}

/// An angle given in radians, in degrees with one decimal: "−18.0°". For figures.
pub fn degrees(radians: f64) -> String {
    degrees_to(radians, -1)
}

/// An angle given in radians, in degrees with four decimals: "−18.2075°". For tables, whose
/// readers set a controller's limits: a tenth of a degree can cost a percent of the workspace.
pub fn exact_degrees(radians: f64) -> String {
    degrees_to(radians, -4)
}

fn degrees_to(radians: f64, power: i32) -> String {
    let degrees = radians.to_degrees();
    match degrees.abs() {
        size if size < 1e5 => format!("{}°", rounded(degrees, power)),
        size if size.is_finite() => format!("{}°", plain(degrees)),
        _ => "not known".into(),
    }
}

/// A unit as it is printed: "m^2 rad" → "m² rad".
pub fn unit(unit: &str) -> String {
    unit.replace("^2", "²").replace("^3", "³")
}

/// "S_F (m²)", or the label alone without a unit.
pub(super) fn with_unit(label: &str, name: &str) -> String {
    match unit(name).as_str() {
        "" => label.to_string(),
        unit => format!("{label} ({unit})"),
    }
}

/// "θ₁" for joint 1.
pub fn joint_symbol(joint: usize) -> String {
    format!("θ{}", subscript(joint))
}

/// A number in subscript digits.
pub fn subscript(number: usize) -> String {
    let digit = |c: char| char::from_u32(0x2080 + c.to_digit(10).unwrap_or(0)).unwrap_or(c);
    number.to_string().chars().map(digit).collect()
}

/// A number in superscript digits.
pub(super) fn superscript(number: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32(0x2070 + c.to_digit(10).unwrap_or(0)).unwrap_or(c),
    };
    number.to_string().chars().map(digit).collect()
}

/// `value` rounded to the digit worth 10^`last`, with a true minus sign and never "−0".
pub(super) fn rounded(value: f64, last: i32) -> String {
    let text = if last > 0 {
        let step = 10f64.powi(last);
        format!("{:.0}", (value / step).round() * step)
    } else {
        format!("{value:.*}", last.unsigned_abs().min(15) as usize)
    };
    let is_zero = !text.contains(|c: char| c.is_ascii_digit() && c != '0');
    match text.strip_prefix('-') {
        Some(digits) if is_zero => digits.to_string(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// The power of ten of the leading digit, after rounding to `digits` more digits.
fn exponent(value: f64, digits: usize) -> i32 {
    let text = format!("{:.*e}", digits, value.abs());
    let power = text
        .split_once('e')
        .and_then(|(_, power)| power.parse().ok());
    if value == 0.0 {
        i32::MIN
    } else {
        power.unwrap_or(0)
    }
}

/// Without zeros behind the last digit of a decimal fraction.
fn trimmed(text: &str) -> String {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_string()
    } else {
        text.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_digits_of_the_error() {
        assert_eq!(with_error(3.56234, 0.0123), "3.562 ± 0.012");
        assert_eq!(with_error(3.56234, 0.0996), "3.56 ± 0.10");
        assert_eq!(with_error(1234.6, 230.0), "1230 ± 230");
        assert_eq!(with_error(0.0, 0.004), "0.0000 ± 0.0040");
        assert_eq!(with_error(-0.00001, 0.1), "0.00 ± 0.10");
        assert_eq!(with_error(0.12, 3.4), "0.1 ± 3.4");
        assert_eq!(with_error(-17.26, 1.5), "−17.3 ± 1.5");
    }

    #[test]
    fn no_error_no_bar() {
        assert_eq!(with_error(3.5619449, 0.0), "3.56194");
        assert_eq!(with_error(28.274333882308138, 1e-15), "28.2743");
        assert_eq!(with_error(0.0, 0.0), "0");
        assert_eq!(with_error(2.5, f64::NAN), "2.5 (error unknown)");
        assert_eq!(with_error(f64::NAN, 0.1), "not known");
    }

    #[test]
    fn far_magnitudes_have_a_power_of_ten() {
        assert_eq!(with_error(1.2345e-7, 2.3e-9), "(1.235 ± 0.023) × 10⁻⁷");
        assert_eq!(with_error(6.02214e23, 1e20), "(6.0221 ± 0.0010) × 10²³");
        assert_eq!(plain(1e-7), "1 × 10⁻⁷");
        assert_eq!(plain(123456.7), "123457");
        assert_eq!(plain(f64::MAX), "1.79769 × 10³⁰⁸");
    }

    #[test]
    fn shares_carry_both_errors() {
        let part = Estimate {
            value: 1.0,
            error: 0.01,
        };
        let whole = Estimate {
            value: 10.0,
            error: 0.1,
        };
        assert_eq!(percentage(&part, &whole), "10.00 ± 0.20 %");
        assert_eq!(percentage(&part, &Estimate::default()), "–");
    }

    #[test]
    fn symbols() {
        assert_eq!(joint_symbol(12), "θ₁₂");
        assert_eq!(superscript(-10), "⁻¹⁰");
        assert_eq!(unit("m^2 rad"), "m² rad");
        assert_eq!(degrees(-0.0001), "0.0°");
        assert_eq!(degrees(-std::f64::consts::PI), "−180.0°");
    }
}
