//! Where an axis has its ticks and how they read.

use super::number::{plain, rounded, superscript};

/// A labelled position on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub value: f64,
    pub label: String,
}

/// About `count` round numbers in [`low`, `high`]: multiples of 1, 2, 2.5 or 5 times a power of
/// ten.
pub(super) fn round(low: f64, high: f64, count: usize) -> Vec<Tick> {
    let rough = (high - low) / count.max(1) as f64;
    if !(rough.is_finite() && rough > 0.0) {
        return Vec::new();
    }
    let power = rough.log10().floor();
    let unit = 10f64.powf(power);
    let (factor, digits) = [(1.0, 0), (2.0, 0), (2.5, 1), (5.0, 0), (10.0, -1)]
        .into_iter()
        .find(|(factor, _)| factor * unit >= 0.75 * rough)
        .unwrap_or((10.0, -1));
    multiples(low, high, factor * unit, power as i32 - digits)
}

/// Multiples of a usual angle in degrees, at most about `count` of them.
pub(super) fn degrees(low: f64, high: f64, count: usize) -> Vec<Tick> {
    let rough = (high - low) / count.max(1) as f64;
    let usual = [1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 60.0, 90.0, 180.0];
    match usual.into_iter().find(|step| *step >= rough) {
        Some(step) if rough >= 0.5 => multiples(low, high, step, 0),
        _ => round(low, high, count),
    }
}

/// Whole powers of ten; `low` and `high` are decimal logarithms.
pub(super) fn decades(low: f64, high: f64, count: usize) -> Vec<Tick> {
    let step = ((high - low) / count.max(1) as f64).ceil().max(1.0);
    let mut ticks = multiples(low, high, step, 0);
    for tick in &mut ticks {
        tick.label = format!("10{}", superscript(tick.value as i32));
    }
    ticks
}

/// Losses and the like between two powers of ten: `low` and `high` are decimal logarithms, and so
/// are the ticks' values. Whole powers over two decades, else 1, 2 and 5 times them or, where that
/// is too coarse, round numbers.
pub(super) fn logarithmic(low: f64, high: f64, count: usize) -> Vec<Tick> {
    if !(low.is_finite() && high.is_finite()) || high - low >= 2.0 {
        return decades(low, high, count);
    }
    let place = |value: f64, label: String| Tick {
        value: value.log10(),
        label,
    };
    let powers = low.floor() as i32..=high.ceil() as i32;
    let usual = powers.flat_map(|power| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(power)));
    let usual = usual.map(|value| place(value, plain(value)));
    let usual: Vec<Tick> = usual
        .filter(|t| low <= t.value && t.value <= high)
        .collect();
    if usual.len() >= 3 {
        return usual;
    }
    let even = round(10f64.powf(low), 10f64.powf(high), count).into_iter();
    let even = even.filter(|tick| tick.value > 0.0);
    even.map(|tick| place(tick.value, tick.label)).collect()
}

/// Multiples of 90° from −180° to 180°.
pub(super) fn quarters() -> Vec<Tick> {
    degrees(-180.0, 180.0, 4)
}

/// The same ticks without labels, where a neighbour shows them.
pub(super) fn unlabelled(ticks: &[Tick]) -> Vec<Tick> {
    let bare = |tick: &Tick| Tick {
        value: tick.value,
        label: String::new(),
    };
    ticks.iter().map(bare).collect()
}

fn multiples(low: f64, high: f64, step: f64, last: i32) -> Vec<Tick> {
    let slack = 1e-6 * step;
    let (first, end) = (
        ((low - slack) / step).ceil(),
        ((high + slack) / step).floor(),
    );
    if !(first.is_finite() && end.is_finite()) || end - first > 100.0 {
        return Vec::new();
    }
    let tick = |k: i64| {
        let value = k as f64 * step;
        Tick {
            value,
            label: rounded(value, last),
        }
    };
    (first as i64..=end as i64).map(tick).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &[Tick]) -> Vec<&str> {
        ticks.iter().map(|t| t.label.as_str()).collect()
    }

    #[test]
    fn steps_are_round() {
        assert_eq!(
            labels(&round(-3.1, 3.1, 6)),
            ["−3", "−2", "−1", "0", "1", "2", "3"]
        );
        assert_eq!(
            labels(&round(0.0, 1.0, 4)),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(
            labels(&round(0.0, 1.3, 4)),
            ["0.00", "0.25", "0.50", "0.75", "1.00", "1.25"]
        );
        assert_eq!(
            labels(&degrees(-200.0, 200.0, 5)),
            ["−180", "−90", "0", "90", "180"]
        );
        assert_eq!(
            labels(&decades(0.2, 5.0, 5)),
            ["10¹", "10²", "10³", "10⁴", "10⁵"]
        );
    }

    #[test]
    fn no_range_no_ticks() {
        assert!(round(1.0, 1.0, 5).is_empty());
        assert!(round(f64::NAN, 1.0, 5).is_empty());
        assert!(degrees(0.0, f64::INFINITY, 5).is_empty());
        assert!(round(1e300, 1.1e300, 5).len() < 12);
    }
}
