//! The page of `kind = "synthesis"`: sentences and tables.

use super::settings::DegreeLimits;
use super::synthesis_result::{Reference, SynthesisFinding, Winner, parameter_name};
use crate::design::{Geometry, Robot};
use crate::report::{Section, Table, with_error};
use crate::synthesis::{Column, Links, Measures, Merit, Perturbed, Synthesis};
use crate::workspace::{ArtificialLimits, Estimate};

/// Merits in words.
pub(super) fn merit_label(merit: Merit) -> &'static str {
    match merit {
        Merit::Share => "S_F / S_0max",
        Merit::BallShare => "ball share: S_F / ball of the reach",
        Merit::SizePerLength => "S_F / (total length)^d",
        Merit::PreFailureShare => "pre-failure share: W_0 / S_0max",
        Merit::Survival => "survival: W_F / W_0",
        Merit::Slenderness => "reach / total length",
    }
}

/// Whether a merit is read in percent.
pub(super) fn is_share(merit: Merit) -> bool {
    !matches!(merit, Merit::SizePerLength | Merit::Slenderness)
}

pub(super) fn merit_text(merit: Merit, estimate: &Estimate) -> String {
    match is_share(merit) {
        true => percent(estimate),
        false => with_error(estimate.value, estimate.error),
    }
}

fn percent(estimate: &Estimate) -> String {
    format!(
        "{} %",
        with_error(100.0 * estimate.value, 100.0 * estimate.error)
    )
}

impl SynthesisFinding<'_> {
    /// The answer in sentences.
    pub(super) fn summary(&self) -> Vec<String> {
        match (self.search, self.winner, self.pareto) {
            (Some(search), Some(winner), _) => self.winner_summary(search, winner),
            (_, _, Some(pareto)) => vec![format!(
                "{} robots of which none is worse than another in everything, out of {} that were \
                 assessed. All numbers are measured on samples that the search has not seen.",
                pareto.front().len(),
                pareto.evaluations()
            )],
            _ => Vec::new(),
        }
    }

    fn winner_summary(&self, search: &Synthesis, winner: &Winner) -> Vec<String> {
        let merit = self.question.search.objectives[0];
        let value = merit_text(merit, &winner.measures.merit(merit));
        let mut sentences = vec![format!(
            "The robot found has {} = {value}, measured on {} samples that were used for nothing \
             else, after {} robots had been assessed.",
            merit_label(merit),
            winner.counts.samples,
            search.evaluations()
        )];
        if let Some(reference) = self.reference {
            sentences.push(self.compared(merit, winner, reference));
        }
        if let Some(check) = &winner.check {
            let share = check.fault_tolerant_share();
            let error = share.error.hypot(winner.measures.share.error);
            let off = (share.value - winner.measures.share.value) / error;
            sentences.push(format!(
                "Inverse kinematics with locked joints, an independent way, finds S_F / S_0max = {} \
                 on {} reachable task points: {:.1} standard errors of the difference away.",
                percent(&share),
                check.reachable,
                off.abs()
            ));
        }
        sentences
    }

    fn compared(&self, merit: Merit, winner: &Winner, reference: &Reference) -> String {
        let name = &self.study.design.robot.name;
        if let Some(verdict) = &reference.verdict {
            return format!("{name}, for comparison, is {verdict}.");
        }
        let own = reference.measures.merit(merit);
        let times = winner.measures.merit(merit).value / own.value;
        let limits = match reference.given {
            true => "the given limits",
            false => "the best limits found for it",
        };
        let times = match times.is_finite() {
            true => format!(": {times:.1} times less"),
            false => String::new(),
        };
        format!(
            "{name}, for comparison, has {} with {limits}{times}.",
            merit_text(merit, &own)
        )
    }

    /// Remarks a reader must not miss.
    pub(super) fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let task = self.study.task;
        let idle = crate::synthesis::LinkSpace::idle(self.question.search.links.len(), task);
        let names: Vec<String> = idle
            .into_iter()
            .map(|(row, column)| parameter_name(Perturbed::Link(row, column)))
            .collect();
        notes.push(format!(
            "{} change neither S_F nor S_0max. They are 0 here and may be given any value.",
            names.join(", ")
        ));
        if let Some(check) = self.winner.and_then(|winner| winner.check.as_ref()) {
            let share = check.fault_tolerant_share();
            let reported = self.winner.map_or(share, |winner| winner.measures.share);
            if (share.value - reported.value).abs() > 3.0 * share.error.hypot(reported.error) {
                notes.push(
                    "The independent check disagrees with the reported share by more than three \
                     standard errors: do not rely on the number."
                        .into(),
                );
            }
        }
        if self.study.failures.margin() > 0.0 {
            notes.push(format!(
                "Joints may lock up to {}° beyond their limits.",
                self.study.failures.margin().to_degrees()
            ));
        }
        notes
    }

    /// Sections in order.
    pub(super) fn sections(&self) -> Vec<Section> {
        let mut sections = Vec::new();
        if let (Some(search), Some(winner)) = (self.search, self.winner) {
            let robot = self.robot(&winner.draft.links);
            sections.push(rows_section(
                "The robot found",
                &robot,
                &winner.draft.limits,
            ));
            sections.push(self.merits_section(winner));
            sections.push(self.honesty_section(search, winner));
            sections.push(margin_section(winner));
        }
        if self.pareto.is_some() {
            sections.push(self.front_section());
        }
        if let Some(reference) = self.reference {
            let heading = format!("For comparison: {}", self.study.design.robot.name);
            sections.push(rows_section(
                &heading,
                &self.study.design.robot,
                &reference.limits,
            ));
        }
        sections
    }

    fn merits_section(&self, winner: &Winner) -> Section {
        let mut table = Table::new(&["merit", "found"]);
        let reference = self.reference.map(|reference| &reference.measures);
        if reference.is_some() {
            table.header.push(self.study.design.robot.name.clone());
        }
        let mut add = |name: &str, of: &dyn Fn(&Measures) -> String| {
            let mut row = vec![name.to_owned(), of(&winner.measures)];
            row.extend(reference.map(of));
            table.rows.push(row);
        };
        for merit in Merit::ALL {
            add(merit_label(merit), &|m| merit_text(merit, &m.merit(merit)));
        }
        add("S_0max / ball of the reach", &|m| percent(&m.fill));
        if let Some(dexterity) = &winner.dexterity {
            for (name, value) in [
                (
                    "least null-vector component, mean over W_F",
                    dexterity.null_component,
                ),
                (
                    "1 / condition number, mean over W_F",
                    dexterity.inverse_condition,
                ),
            ] {
                let value = with_error(value.value, value.error);
                table.rows.push(vec![name.to_owned(), value]);
            }
        }
        Section {
            heading: "Merits".into(),
            text: "Measured on samples that were used for nothing else, ± one standard error. The \
                   ball of the reach holds all task points within the reach of the wrist."
                .into(),
            table,
        }
    }

    fn honesty_section(&self, search: &Synthesis, winner: &Winner) -> Section {
        let merit = self.question.search.objectives[0];
        let effort = &self.question.search.effort;
        let reported = winner.measures.merit(merit);
        let mut table = Table::new(&["measured on", "task points", "value", "minus reported"]);
        let mut add = |name: &str, samples: u64, value: Estimate| {
            let off = Estimate {
                value: value.value - reported.value,
                error: value.error.hypot(reported.error),
            };
            table.rows.push(vec![
                name.to_owned(),
                samples.to_string(),
                merit_text(merit, &value),
                merit_text(merit, &off),
            ]);
        };
        let exactly = |value| Estimate { value, error: 0.0 };
        let best = search.history().iter().map(|g| g.best).fold(0.0, f64::max);
        add(
            "best of any generation (biased)",
            effort.samples,
            exactly(best),
        );
        let fitted = winner.draft.measures.merit(merit).value;
        add(
            "samples its limits were fitted on (biased)",
            effort.fit_samples,
            exactly(fitted),
        );
        if let Some(chosen) = search.winner() {
            let value = chosen.held_out.merit(merit);
            add("samples it was chosen on", effort.selection_samples, value);
        }
        add("samples of this report", winner.counts.samples, reported);
        Section {
            heading: "How far the numbers of the search were off".into(),
            text: "A maximum over noisy scores is too high. Only the last line is unbiased.".into(),
            table,
        }
    }

    fn front_section(&self) -> Section {
        let merits = &self.question.search.objectives;
        let reach = self.question.search.reach;
        let mut table = Table::new(&["number"]);
        let labels = merits.iter().map(|merit| merit_label(*merit).to_owned());
        table.header.extend(labels);
        table.header.push("total length (m)".into());
        let front = self.pareto.map(|pareto| pareto.front()).unwrap_or_default();
        for (number, robot) in (1..).zip(front) {
            let mut row = vec![format!("{number}")];
            let values = merits
                .iter()
                .map(|m| merit_text(*m, &robot.held_out.merit(*m)));
            row.extend(values);
            row.push(format!("{:.3}", robot.held_out.length * reach));
            table.rows.push(row);
        }
        Section {
            heading: "The front".into(),
            text:
                "Each robot is in `front/` by its number, as a robot file and as URDF; its limits \
                   are in `result.json`."
                    .into(),
            table,
        }
    }
}

fn margin_section(winner: &Winner) -> Section {
    let mut table = Table::new(&["margin (deg)", "S_F / S_0max"]);
    for point in &winner.margins.points {
        let margin = format!("{:.0}", point.margin.to_degrees());
        table.rows.push(vec![margin, percent(&point.share)]);
    }
    let text = match winner.margins.ten_percent {
        Some(margin) => format!(
            "A joint that overshoots its limits before it locks costs fault tolerance. A margin of \
             {:.1}° costs a tenth of it.",
            margin.to_degrees()
        ),
        None => "A joint that overshoots its limits before it locks costs fault tolerance.".into(),
    };
    Section {
        heading: "Safety margin".into(),
        text,
        table,
    }
}

/// Rows of a robot with its limits; only the limits for one that has no rows.
fn rows_section(heading: &str, robot: &Robot, limits: &ArtificialLimits) -> Section {
    let degrees = DegreeLimits::from_limits(limits, robot);
    let mut table = Table::new(&["joint"]);
    let rows = match &robot.geometry {
        Geometry::Rows { joints, .. } => Some(joints),
        _ => None,
    };
    if rows.is_some() {
        table
            .header
            .extend(["α (deg)", "a (m)", "d (m)"].map(String::from));
    }
    table
        .header
        .extend(["lower limit (deg)", "upper limit (deg)"].map(String::from));
    let pairs = degrees.lower_deg.iter().zip(&degrees.upper_deg);
    for (index, (lower, upper)) in pairs.enumerate() {
        let mut row = vec![format!("{}", index + 1)];
        if let Some(joint) = rows.and_then(|rows| rows.get(index)) {
            let link = joint.link;
            row.push(short(link.twist.to_degrees(), 2));
            row.extend([link.length, link.offset].map(|value| short(value, 4)));
        }
        row.extend([lower, upper].map(|value| short(*value, 2)));
        table.rows.push(row);
    }
    Section {
        heading: heading.to_owned(),
        text: "Limits hold before a failure; [−180, 180] leaves a joint free.".into(),
        table,
    }
}

/// A number with at most so many decimals.
fn short(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" | "" => "0".into(),
        text => text.replace('-', "−"),
    }
}

/// `links` with lengths that are decimals of at most nine digits after the point, which a product
/// with the reach need not be.
pub(super) fn tidy(links: &Links, reach: f64) -> Links {
    let tidy = |value: f64| (value * reach * 1e9).round() / 1e9 / reach;
    let mut links = links.clone();
    for link in &mut links {
        for column in [Column::Length, Column::Offset] {
            let value = link.get_mut(column);
            *value = tidy(*value);
        }
    }
    links
}
