//! Seeds of samples that have nothing to do with each other.

/// What samples are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A random robot.
    Robot,
    /// Screening of random robots.
    Screening,
    /// A second look at the best of them.
    Confirmation,
    /// A generation's random numbers.
    Draw,
    /// A generation's task points.
    Generation,
    /// The last fit of limits.
    Fit,
    /// The choice between finalists.
    Selection,
    /// What is reported.
    Report,
    /// The check by inverse kinematics.
    Check,
    /// Sensitivity to tolerances.
    Sensitivity,
    /// The margin of limits that were fitted to other task points.
    Margin,
}

/// The seed of the samples for `purpose` number `number` in a search with the given seed.
///
/// Steps of SplitMix64 (Steele, Lea & Flood, 2014): neighbouring inputs give unrelated seeds.
pub fn sample_seed(seed: u64, purpose: Purpose, number: u64) -> u64 {
    let mix = |state: u64, with: u64| {
        let mut z = (state ^ with).wrapping_add(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    };
    mix(mix(mix(0, seed), purpose as u64), number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn seeds_differ() {
        let mut seen = BTreeSet::new();
        for seed in 0..20 {
            for purpose in [Purpose::Robot, Purpose::Generation, Purpose::Report] {
                for number in 0..20 {
                    assert!(seen.insert(sample_seed(seed, purpose, number)));
                }
            }
        }
    }
}
