//! Adaptive quadrature over panels whose ends may hold square-root singularities.

/// Nodes and weights of the 15-point Kronrod rule on [−1, 1] (the non-negative half), and the
/// weights of the 7-point Gauss rule on every second of them [Piessens et al., QUADPACK].
const NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_83,
];
const GAUSS: [f64; 4] = [
    0.129_484_966_168_869_7,
    0.279_705_391_489_276_64,
    0.381_830_050_505_118_9,
    0.417_959_183_673_469_4,
];

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
    breaks: &[f64],
    tolerance: f64,
    max_panels: usize,
    mut f: impl FnMut(f64) -> f64,
) -> Integral {
    let mut panels: Vec<Panel> = breaks
        .windows(2)
        .filter(|pair| pair[1] > pair[0])
        .map(|pair| panel(pair[0], pair[1], &mut f))
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
        panels[worst] = panel(from, middle, &mut f);
        panels.push(panel(middle, to, &mut f));
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
fn panel(from: f64, to: f64, f: &mut impl FnMut(f64) -> f64) -> Panel {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut at = |t: f64| {
        let (sine, cosine) = (quarter * t).sin_cos();
        f(middle + half * sine) * half * quarter * cosine
    };
    let (mut kronrod, mut gauss) = (0.0, 0.0);
    for (k, &node) in NODES.iter().enumerate() {
        let value = if node == 0.0 {
            at(0.0)
        } else {
            at(node) + at(-node)
        };
        kronrod += KRONROD[k] * value;
        if k % 2 == 1 {
            gauss += GAUSS[k / 2] * value;
        }
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
        let disc = integrate(&[-1.0, 1.0], 1e-12, 100, |x| (1.0 - x * x).max(0.0).sqrt());
        assert!((disc.value - 0.5 * PI).abs() < 1e-12);
        let jump = integrate(&[0.0, 1.0], 1e-4, 400, |x| if x > 0.3 { 1.0 } else { 0.0 });
        assert!((jump.value - 0.7).abs() <= 2e-4 && jump.error > 0.0);
        assert_eq!(integrate(&[], 1e-6, 10, |_| 1.0).value, 0.0);
    }

    #[test]
    fn flattened_midpoints_take_square_roots_at_the_ends() {
        let sum: f64 = flattened_midpoints(24)
            .map(|(x, w)| w * (x * (1.0 - x)).sqrt())
            .sum();
        assert!((sum - PI / 8.0).abs() < 1e-6);
    }
}
