//! The figures of `kind = "synthesis"`.

use super::robot_view::spatial_robot;
use super::synthesis_merit::{merit_axis, merit_scale, merit_text, merit_unit};
use super::synthesis_result::{Reference, SynthesisFinding, Winner};
use crate::report::{
    DesignParameter, Figure, HistoryGeneration, HistoryStage, PairedRobot, ParameterSensitivity,
    ParameterSensitivityFigure, RobotPairFigure, SearchHistoryFigure, SectionOf, SectionPairFigure,
    TradeOffFigure, TradeOffObjective, TradeOffPoint,
};
use crate::synthesis::{Column, Measures, ParetoSearch, Perturbed, Stage, Synthesis, merit_values};

impl SynthesisFinding<'_> {
    /// All figures that there is something for.
    pub(super) fn figures(&self) -> Vec<Box<dyn Figure + '_>> {
        let mut figures: Vec<Box<dyn Figure>> = Vec::new();
        if let (Some(search), Some(winner)) = (self.search, self.winner) {
            if let Some(reference) = self.reference {
                figures.push(Box::new(self.pair(winner, reference)));
                figures.push(Box::new(self.workspaces(winner, reference)));
            }
            if !search.history().is_empty() {
                figures.push(Box::new(self.history(search, winner)));
            }
            if !winner.sensitivity.is_empty() {
                figures.push(Box::new(self.sensitivity(winner)));
            }
        }
        if let Some(pareto) = self.pareto {
            figures.push(Box::new(self.front_figure(pareto)));
        }
        figures
    }

    /// Above a figure: underscores of a file's name would lower what follows.
    fn heading(&self) -> String {
        let title = self.study.title.clone();
        title.unwrap_or_else(|| self.study.name.replace('_', " "))
    }

    fn titles(&self, winner: &Winner, reference: &Reference) -> [String; 2] {
        let merit = self.question.search.objectives[0];
        let text = |measures: &Measures| merit_text(merit, &measures.merit(merit));
        [
            format!(
                "{}: {}",
                self.study.design.robot.name,
                text(&reference.measures)
            ),
            format!("found: {}", text(&winner.measures)),
        ]
    }

    fn pair(&self, winner: &Winner, reference: &Reference) -> RobotPairFigure<'static> {
        let [old, new] = self.titles(winner, reference);
        let found = self.robot(&winner.draft.links);
        RobotPairFigure {
            robots: [
                PairedRobot::Spatial(spatial_robot(&self.study.design.robot, old)),
                PairedRobot::Spatial(spatial_robot(&found, new)),
            ],
        }
    }

    fn workspaces<'a>(
        &self,
        winner: &'a Winner,
        reference: &'a Reference,
    ) -> SectionPairFigure<'a> {
        let [old, new] = self.titles(winner, reference);
        SectionPairFigure {
            robots: [
                SectionOf {
                    title: old,
                    map: &reference.map,
                    reach: reference.arm.extent.reach,
                },
                SectionOf {
                    title: new,
                    map: &winner.map,
                    reach: winner.reach,
                },
            ],
        }
    }

    fn history(&self, search: &Synthesis, winner: &Winner) -> SearchHistoryFigure {
        let merit = self.question.search.objectives[0];
        let scale = merit_scale(merit);
        let mut stages: Vec<HistoryStage> = Vec::new();
        let mut part_before = None;
        for generation in search.history() {
            let part = (generation.run, generation.stage, generation.heat);
            if part_before.replace(part) != Some(part) {
                let name = match (generation.heat, generation.stage) {
                    (Some(heat), _) => format!("heat {heat}"),
                    (None, Stage::Lengths) => "lengths".into(),
                    (None, Stage::Refined) => "refined".into(),
                    (None, Stage::All) => "twists free".into(),
                    (None, Stage::RightAngles) => "right angles".into(),
                };
                let generations = Vec::new();
                let stage = HistoryStage { name, generations };
                stages.push(stage);
            }
            if let Some(stage) = stages.last_mut() {
                let [upper, median, lower] = generation.quartiles.map(|score| scale * score);
                stage.generations.push(HistoryGeneration {
                    at: generation.evaluations as f64,
                    best: scale * generation.best,
                    median,
                    quartiles: [lower, upper],
                });
            }
        }
        let reported = winner.measures.merit(merit);
        SearchHistoryFigure {
            score_label: merit_axis(merit).into(),
            unit: merit_unit(merit).into(),
            axis_label: "robots assessed".into(),
            stages,
            reported: Some([scale * reported.value, scale * reported.error]),
            title: self.heading(),
        }
    }

    fn sensitivity(&self, winner: &Winner) -> ParameterSensitivityFigure {
        let asked = &self.question.search;
        let merit = asked.objectives[0];
        let scale = merit_scale(merit);
        let parameter = |sensitivity: &crate::synthesis::ParameterSensitivity| {
            let changes = sensitivity.change;
            ParameterSensitivity {
                parameter: match sensitivity.what {
                    Perturbed::Link(row, Column::Twist) => DesignParameter::Twist(row + 1),
                    Perturbed::Link(row, Column::Length) => DesignParameter::Length(row + 1),
                    Perturbed::Link(row, Column::Offset) => DesignParameter::Offset(row + 1),
                    Perturbed::Lower(joint) => DesignParameter::LowerLimit(joint + 1),
                    Perturbed::Upper(joint) => DesignParameter::UpperLimit(joint + 1),
                },
                change: changes.map(|change| scale * change.value),
                error: changes.map(|change| scale * change.error),
            }
        };
        ParameterSensitivityFigure {
            score_label: merit_axis(merit).into(),
            tolerance: format!(
                "lengths ±{} mm, angles ±{}°",
                1000.0 * asked.tolerance,
                asked.tolerance_deg
            ),
            parameters: winner.sensitivity.iter().map(parameter).collect(),
            title: self.heading(),
        }
    }

    fn front_figure(&self, pareto: &ParetoSearch) -> TradeOffFigure {
        let merits = pareto.merits();
        let scaled = |values: &[f64]| -> Vec<f64> {
            let pairs = values.iter().zip(merits);
            pairs
                .map(|(value, merit)| merit_scale(*merit) * value)
                .collect()
        };
        let point = |label: String, measures: &Measures, is_on_front: bool| {
            let errors: Vec<f64> = merits.iter().map(|m| measures.merit(*m).error).collect();
            TradeOffPoint {
                label,
                values: scaled(&merit_values(measures, merits)),
                errors: scaled(&errors),
                is_on_front,
            }
        };
        let front = pareto.front();
        let named = self.reference.map(|reference| {
            point(
                self.study.design.robot.name.clone(),
                &reference.measures,
                false,
            )
        });
        TradeOffFigure {
            objectives: merits
                .iter()
                .map(|merit| TradeOffObjective {
                    name: merit_axis(*merit).into(),
                    unit: merit_unit(*merit).into(),
                    is_larger_better: true,
                })
                .collect(),
            points: front
                .iter()
                .map(|robot| point(String::new(), &robot.held_out, true))
                .collect(),
            named: named.into_iter().collect(),
            searched: pareto.seen().iter().map(|values| scaled(values)).collect(),
            title: self.heading(),
        }
    }
}
