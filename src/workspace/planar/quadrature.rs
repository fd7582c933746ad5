//! Adaptive quadrature over panels whose ends may hold square-root singularities.

/// A Kronrod rule on [−1, 1] with the Gauss rule on every second node [Piessens et al., QUADPACK].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kronrod {
    /// 7 points, 3 of them Gauss's: for a search.
    Seven,
    /// 15 points, 7 of them Gauss's: for a result.
    Fifteen,
}

/// Non-negative nodes with the Kronrod and (0 where there is none) the Gauss weight.
const SEVEN: [[f64; 3]; 4] = [
    [0.960_491_268_708_020_3, 0.104_656_226_026_467_27, 0.0],
    [
        0.774_596_669_241_483_4,
        0.268_488_089_868_333_44,
        0.555_555_555_555_555_6,
    ],
    [0.434_243_749_346_802_55, 0.401_397_414_775_962_2, 0.0],
    [0.0, 0.450_916_538_658_474_14, 0.888_888_888_888_888_8],
];
const FIFTEEN: [[f64; 3]; 8] = [
    [0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0],
    [
        0.949_107_912_342_758_5,
        0.063_092_092_629_978_55,
        0.129_484_966_168_869_7,
    ],
    [0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0],
    [
        0.741_531_185_599_394_4,
        0.140_653_259_715_525_92,
        0.279_705_391_489_276_64,
    ],
    [0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0],
    [
        0.405_845_151_377_397_2,
        0.190_350_578_064_785_4,
        0.381_830_050_505_118_9,
    ],
    [0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0],
    [0.0, 0.209_482_141_084_727_83, 0.417_959_183_673_469_4],
];

impl Kronrod {
    fn nodes(self) -> &'static [[f64; 3]] {
        match self {
            Kronrod::Seven => &SEVEN,
            Kronrod::Fifteen => &FIFTEEN,
        }
    }
}

/// An integral and an estimate of its error.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Integral {
    pub value: f64,
    pub error: f64,
}

#[derive(Clone, Copy, Debug)]
struct Panel {
    from: f64,
    to: f64,
    integral: Integral,
}

/// Integrates `f` over the panels between neighbouring `breaks` (ascending), halving the panel
/// with the largest error until the sum of errors is at most `tolerance` times the integral or
/// `max_panels` have been evaluated.
pub(super) fn integrate(
    rule: Kronrod,
    breaks: &[f64],
    tolerance: f64,
    max_panels: usize,
    mut f: impl FnMut(f64) -> f64,
) -> Integral {
    let mut panels: Vec<Panel> = breaks
        .windows(2)
        .filter(|pair| pair[1] > pair[0])
        .map(|pair| panel(rule, pair[0], pair[1], &mut f))
        .collect();
    let mut evaluated = panels.len();
    loop {
        let total = sum(&panels);
        let worst = (0..panels.len()).max_by(|&a, &b| {
            let error = |k: usize| panels[k].integral.error;
            error(a).total_cmp(&error(b))
        });
        let done = total.error <= tolerance * total.value.abs() || evaluated >= max_panels;
        let Some(worst) = worst.filter(|_| !done) else {
            return total;
        };
        let Panel { from, to, .. } = panels[worst];
        let middle = 0.5 * (from + to);
        panels[worst] = panel(rule, from, middle, &mut f);
        panels.push(panel(rule, middle, to, &mut f));
        evaluated += 2;
    }
}

fn sum(panels: &[Panel]) -> Integral {
    panels
        .iter()
        .fold(Integral::default(), |sum, panel| Integral {
            value: sum.value + panel.integral.value,
            error: sum.error + panel.integral.error,
        })
}

/// Gauss–Kronrod in t with x = middle + half·sin(πt/2): square roots at the ends become smooth.
fn panel(rule: Kronrod, from: f64, to: f64, f: &mut impl FnMut(f64) -> f64) -> Panel {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut at = |t: f64| {
        let (sine, cosine) = (quarter * t).sin_cos();
        f(middle + half * sine) * half * quarter * cosine
    };
    let (mut kronrod, mut gauss) = (0.0, 0.0);
    for &[node, kronrod_weight, gauss_weight] in rule.nodes() {
        let value = if node == 0.0 {
            at(0.0)
        } else {
            at(node) + at(-node)
        };
        kronrod += kronrod_weight * value;
        gauss += gauss_weight * value;
    }
    Panel {
        from,
        to,
        integral: Integral {
            value: kronrod,
            error: (kronrod - gauss).abs(),
        },
    }
}

/// Nodes and weights of the midpoint rule on [0, 1] after the substitution
/// t − sin(2πt)/(2π), which flattens both ends: exact to high order for functions that are smooth
/// inside and have roots at the ends.
pub(super) fn flattened_midpoints(count: usize) -> impl Iterator<Item = (f64, f64)> {
    let step = 1.0 / count as f64;
    (0..count).map(move |k| {
        let t = (k as f64 + 0.5) * step;
        let angle = std::f64::consts::TAU * t;
        (
            t - angle.sin() / std::f64::consts::TAU,
            step * (1.0 - angle.cos()),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn half_disc_and_jump_are_integrated() {
        for (rule, accuracy) in [(Kronrod::Seven, 1e-6), (Kronrod::Fifteen, 1e-12)] {
            let half_disc = |x: f64| (1.0 - x * x).max(0.0).sqrt();
            let disc = integrate(rule, &[-1.0, 1.0], accuracy, 100, half_disc);
            assert!((disc.value - 0.5 * PI).abs() < accuracy, "{disc:?}");
            let step = |x: f64| if x > 0.3 { 1.0 } else { 0.0 };
            let jump = integrate(rule, &[0.0, 1.0], 1e-4, 400, step);
            assert!((jump.value - 0.7).abs() <= 2e-4 && jump.error > 0.0);
            assert_eq!(integrate(rule, &[], 1e-6, 10, |_| 1.0).value, 0.0);
        }
    }

    /// Gauss with n points is exact to degree 2n − 1, its Kronrod extension to 3n + 1.
    #[test]
    fn rules_are_exact_for_polynomials() {
        for (rule, gauss_degree, kronrod_degree) in
            [(Kronrod::Seven, 5, 10), (Kronrod::Fifteen, 13, 22)]
        {
            let sum = |degree: i32, weight: usize| -> f64 {
                let twice = |node: f64| if node == 0.0 { 1.0 } else { 2.0 };
                let terms = rule.nodes().iter();
                terms
                    .map(|n| twice(n[0]) * n[weight] * n[0].powi(degree))
                    .sum()
            };
            for degree in (0..=kronrod_degree).step_by(2) {
                let exact = 2.0 / f64::from(degree + 1);
                assert!((sum(degree, 1) - exact).abs() < 1e-14);
                assert!(degree > gauss_degree || (sum(degree, 2) - exact).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn flattened_midpoints_take_square_roots_at_the_ends() {
        let sum: f64 = flattened_midpoints(24)
            .map(|(x, w)| w * (x * (1.0 - x)).sqrt())
            .sum();
        assert!((sum - PI / 8.0).abs() < 1e-6);
    }
}
