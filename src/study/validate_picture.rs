//! Figures of a study that validates surrogates.

use super::validate_report::{Comparison, Judged};
use crate::angle::{AngleSet, wrap};
use crate::objective::Design;
use crate::report::{
    AngleDensity, Calibration, CalibrationBin, CalibrationCurve, Figure, FilterFigure,
    PredictedWorkspaces, SizeScatter, SizeSeries, WorkspaceCase,
};
use crate::sampling::stream;
use crate::surrogate::{
    Cell, Dataset, Decoder, DifferenceFilter, Head, Origin, Surrogate, SurrogateArm,
};
use crate::workspace::{Ring, RingMap};
use std::f64::consts::{PI, TAU};

/// Rings of a drawn workspace, radii and angles of a drawn density.
const RINGS: usize = 200;
const DENSITY_RADII: usize = 150;
const DENSITY_ANGLES: usize = 180;

/// Radii at which draws are shown, and draws at each.
const DRAWN_RADII: usize = 60;
const DRAWS: usize = 60;

/// Share of the largest size below which a design is no case to show.
const SHOWN: f64 = 0.05;

/// All figures; those that make no sense for the surrogates at hand are missing.
pub(super) struct Pictures {
    workspaces: Option<PredictedWorkspaces>,
    density: Option<AngleDensity>,
    filter: Option<FilterFigure>,
    sizes: SizeScatter,
    calibration: Option<Calibration>,
}

impl Pictures {
    pub fn of(comparison: &Comparison) -> Pictures {
        let known = |judged: &&Judged| judged.walk.overlap.is_some();
        let planar = |judged: &&Judged| !judged.model.arm().pose;
        let overlap = |judged: &Judged| judged.walk.overlap.map_or(0.0, |o| o.mean);
        let with_sets = || comparison.judged.iter().filter(known).filter(planar);
        let best = with_sets().max_by(|a, b| overlap(a).total_cmp(&overlap(b)));
        let mixture = with_sets().find(|j| matches!(j.model.architecture().head, Head::Mdn(_)));
        let unit = comparison.study.task.unit();
        let shown = |judged: &Judged| Some(Shown::of(comparison.designs_of(judged)?, judged));
        let mixture = mixture.and_then(|judged| Some((judged, shown(judged)?)));
        Pictures {
            workspaces: best.and_then(|judged| workspaces(judged, &shown(judged)?, unit)),
            density: mixture.as_ref().and_then(|(j, shown)| density(j, shown)),
            filter: mixture.as_ref().and_then(|(j, shown)| filter(j, shown)),
            sizes: sizes(comparison, unit),
            calibration: calibrated(comparison),
        }
    }

    pub fn figures(&self) -> Vec<&dyn Figure> {
        let mut figures: Vec<&dyn Figure> = Vec::new();
        figures.extend(self.workspaces.as_ref().map(|f| f as &dyn Figure));
        figures.push(&self.sizes);
        figures.extend(self.density.as_ref().map(|f| f as &dyn Figure));
        figures.extend(self.filter.as_ref().map(|f| f as &dyn Figure));
        figures.extend(self.calibration.as_ref().map(|f| f as &dyn Figure));
        figures
    }
}

/// The threshold walks whose workspaces are predicted best, at the median and worst.
struct Shown {
    cases: Vec<(&'static str, usize, Design)>,
}

impl Shown {
    fn of(data: &Dataset, judged: &Judged) -> Shown {
        let mut walks: Vec<(usize, f64)> = judged
            .cases
            .iter()
            .enumerate()
            .filter(|(k, _)| data.designs()[*k].origin == Origin::Walk)
            .filter(|(_, case)| case.exact >= SHOWN * judged.largest)
            .filter_map(|(k, case)| Some((k, case.overlap()?)))
            .collect();
        walks.sort_by(|a, b| b.1.total_cmp(&a.1));
        let places = match walks.len() {
            0 => Vec::new(),
            n => vec![("best", 0), ("median", n / 2), ("worst", n - 1)],
        };
        let case = |(label, place): (&'static str, usize)| {
            let k = walks[place].0;
            (label, k, data.designs()[k].design())
        };
        Shown {
            cases: places.into_iter().map(case).collect(),
        }
    }

    fn median(&self) -> Option<&Design> {
        let found = self.cases.iter().find(|(label, ..)| *label == "median");
        found.map(|(.., design)| design)
    }
}

fn workspaces(judged: &Judged, shown: &Shown, unit: &str) -> Option<PredictedWorkspaces> {
    let case = |(label, k, design): &(&'static str, usize, Design)| {
        let numbers = judged.cases[*k];
        Some(WorkspaceCase {
            label: (*label).into(),
            limits_label: limits_label(design),
            exact: rings(judged.model.arm(), judged.model.arm(), design)?,
            predicted: rings(judged.model.arm(), &judged.model, design)?,
            exact_size: numbers.exact,
            predicted_size: numbers.predicted,
            overlap: numbers.overlap()?,
        })
    };
    let cases: Option<Vec<WorkspaceCase>> = shown.cases.iter().map(case).collect();
    Some(PredictedWorkspaces {
        cases: cases.filter(|cases| !cases.is_empty())?,
        unit: unit.into(),
    })
}

fn limits_label(design: &Design) -> String {
    let joints = design.limits.joints().iter();
    let pairs = joints.map(|limit| {
        let ends = [limit.lower, limit.upper].map(f64::to_degrees);
        format!("[{:.1}°, {:.1}°]", ends[0], ends[1]).replace('-', "−")
    });
    pairs.collect::<Vec<_>>().join(", ")
}

/// The workspace that a surrogate, or the exact arm itself, gives.
fn rings(arm: &SurrogateArm, by: &dyn Surrogate, design: &Design) -> Option<RingMap> {
    let reach = arm.locked_joints(design).reach();
    let step = (reach[1] - reach[0]) / RINGS as f64;
    let edge = |k: usize| reach[0] + k as f64 * step;
    let cells: Vec<Cell> = (0..RINGS).map(|k| at(edge(k) + 0.5 * step)).collect();
    let sets = by.sets(design, &cells)?;
    let ring = |(k, rotation_set)| Ring {
        inner: edge(k),
        outer: edge(k + 1),
        rotation_set,
    };
    Some(RingMap {
        unrestricted: reach,
        rings: sets.into_iter().enumerate().map(ring).collect(),
    })
}

fn at(radius: f64) -> Cell {
    Cell {
        radius,
        bearing: 0.0,
    }
}

fn exact_sets(arm: &SurrogateArm, design: &Design, radii: usize) -> Vec<(f64, AngleSet)> {
    let reach = arm.locked_joints(design).reach();
    let step = (reach[1] - reach[0]) / radii as f64;
    let radius = |k: usize| reach[0] + (k as f64 + 0.5) * step;
    let cells: Vec<Cell> = (0..radii).map(|k| at(radius(k))).collect();
    let sets = arm.fault_tolerant_sets(design, &cells);
    cells.iter().map(|cell| cell.radius).zip(sets).collect()
}

fn density(judged: &Judged, shown: &Shown) -> Option<AngleDensity> {
    let design = shown.median()?;
    let arm = judged.model.arm();
    let locked = arm.locked_joints(design);
    let reach = locked.reach();
    let step = (reach[1] - reach[0]) / DENSITY_RADII as f64;
    let edge = |k: usize| reach[0] + k as f64 * step;
    let cells: Vec<Cell> = (0..DENSITY_RADII)
        .map(|k| at(edge(k) + 0.5 * step))
        .collect();
    let mixtures = judged.model.mixtures(design, &cells)?;
    let allowed = |cell: &Cell| match judged.model.is_ruled_out(&locked, cell) {
        true => 0.0,
        false => 1.0,
    };
    let density = mixtures.iter().zip(&cells).flat_map(|(mixture, cell)| {
        // What the decoder sees: nothing where the set is held to be empty.
        let present = if mixture.presence < 0.5 {
            0.0
        } else {
            allowed(cell)
        };
        (0..DENSITY_ANGLES).map(move |k| {
            let angle = -PI + (k as f64 + 0.5) * TAU / DENSITY_ANGLES as f64;
            present * mixture.density(angle)
        })
    });
    Some(AngleDensity {
        radii: (0..=DENSITY_RADII).map(edge).collect(),
        angles: DENSITY_ANGLES,
        density: density.collect(),
        exact: exact_sets(arm, design, DENSITY_RADII),
        gate: locked.radii(),
        title: format!(
            "{}: {}",
            judged.name.replace('_', " "),
            limits_label(design)
        ),
    })
}

fn filter(judged: &Judged, shown: &Shown) -> Option<FilterFigure> {
    let design = shown.median()?;
    let arm = judged.model.arm();
    let filter = match judged.card.decoder {
        Decoder::Sampling(filter) => filter,
        Decoder::Level { .. } => DifferenceFilter::default(),
    };
    let filter = DifferenceFilter {
        draws: DRAWS,
        ..filter
    };
    let exact = exact_sets(arm, design, DRAWN_RADII);
    let cells: Vec<Cell> = exact.iter().map(|(radius, _)| at(*radius)).collect();
    let mixtures = judged.model.mixtures(design, &cells)?;
    let locked = arm.locked_joints(design);
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for (k, (mixture, cell)) in mixtures.iter().zip(&cells).enumerate() {
        if mixture.presence < 0.5 || judged.model.is_ruled_out(&locked, cell) {
            continue;
        }
        let draws = mixture.draw(filter.draws, &mut stream(0, k as u64));
        let point = |angle: &f64| [cell.radius, wrap(*angle)];
        before.extend(draws.iter().map(point));
        after.extend(filter.filtered(draws, mixture.wrapped).iter().map(point));
    }
    Some(FilterFigure {
        before,
        after,
        exact,
        filter_label: format!("α = {}, ε = {:e}", filter.outlier, filter.closeness),
    })
}

fn sizes(comparison: &Comparison, unit: &str) -> SizeScatter {
    let mut series = Vec::new();
    for judged in comparison.judged {
        let Some(data) = comparison.designs_of(judged) else {
            continue;
        };
        for (origin, kind) in [(Origin::Uniform, "uniform limits"), (Origin::Walk, "walks")] {
            let pairs = judged.cases.iter().zip(data.designs());
            let chosen = || pairs.clone().filter(|(_, design)| design.origin == origin);
            series.push(SizeSeries {
                label: judged.name.clone(),
                kind: kind.into(),
                exact: chosen().map(|(case, _)| case.exact).collect(),
                predicted: chosen().map(|(case, _)| case.predicted).collect(),
            });
        }
    }
    let largest = comparison.judged.iter().map(|judged| judged.largest);
    SizeScatter {
        series,
        unit: unit.into(),
        largest: largest.fold(0.0, f64::max),
    }
}

fn calibrated(comparison: &Comparison) -> Option<Calibration> {
    let curve = |judged: &Judged| CalibrationCurve {
        label: judged.name.clone(),
        bins: judged
            .calibration
            .iter()
            .map(|bin| CalibrationBin {
                predicted: bin.predicted,
                observed: bin.observed,
                count: bin.count,
            })
            .collect(),
    };
    let curves = comparison.judged.iter().map(curve);
    let curves: Vec<_> = curves.filter(|curve| !curve.bins.is_empty()).collect();
    (!curves.is_empty()).then_some(Calibration { curves })
}
