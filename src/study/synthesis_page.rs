//! The page of `kind = "synthesis"`: sentences and tables.

use super::locked_check::{self, contradiction};
use super::settings::DegreeLimits;
use super::synthesis_merit::{merit_label, merit_text};
use super::synthesis_result::{Reference, SynthesisFinding, Winner, parameter_name};
use crate::design::{Geometry, Robot};
use crate::report::{Section, Table, with_error};
use crate::synthesis::{
    Column, Links, MARGIN_SAMPLES, Measures, Merit, Perturbed, Synthesis, WIDEST_MARGIN,
};
use crate::workspace::{ArtificialLimits, Estimate};

fn percent(estimate: &Estimate) -> String {
    format!(
        "{} %",
        with_error(100.0 * estimate.value, 100.0 * estimate.error)
    )
}

/// Share of robots that miss the reach from which on a reader must know.
const NOTABLE: f64 = 0.02;

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
            sentences.push(locked_check::sentence(check, &winner.measures.share));
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
        if let Some(winner) = self.winner {
            let check = winner.check.as_ref();
            notes.extend(check.and_then(|c| contradiction(c, &winner.measures.share)));
        }
        notes.extend(self.off_reach_note());
        notes.extend(self.objectives_notes());
        if self.study.failures.margin() > 0.0 {
            notes.push(format!(
                "Joints may lock up to {}° beyond their limits.",
                self.study.failures.margin().to_degrees()
            ));
        }
        notes
    }

    /// That robots were left out since their lengths cannot be scaled to the reach.
    fn off_reach_note(&self) -> Option<String> {
        let search = &self.question.search;
        let (missed, of, which) = match self.pareto {
            Some(pareto) => (pareto.off_reach(), pareto.evaluations(), "robots"),
            None => {
                let missed = u64::from(self.screened_off_reach());
                (missed, search.effort.screened, "random robots")
            }
        };
        (missed as f64 > NOTABLE * of as f64).then(|| {
            format!(
                "{missed} of {of} {which} cannot be brought to the reach of {} m within 1 % by the \
                 lengths that `links` leaves free. The search leaves out robots that miss the reach.",
                search.reach
            )
        })
    }

    /// What is not obvious of a search for merits that are blind to the size of W_F.
    fn objectives_notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let search = &self.question.search;
        let [merit, ..] = search.objectives[..] else {
            return notes;
        };
        if let Some(winner) = self.winner {
            if merit.is_blind_to_size() {
                notes.push(format!(
                    "Links were searched for \"{merit}\", limits were fitted for S_F: other limits \
                     may do better by it."
                ));
            }
            let share = winner.measures.share;
            if share.value + 2.0 * share.error < search.min_share {
                notes.push(format!(
                    "The robot found misses `min_share` = {}: the search ended at a robot whose \
                     score is lowered for that.",
                    search.min_share
                ));
            }
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
            add(merit_label(merit), &|m| match m.has(merit) {
                true => merit_text(merit, &m.merit(merit)),
                false => "–".into(),
            });
        }
        add("S_0max / ball of the reach", &|m| percent(&m.fill));
        Section {
            heading: "Merits".into(),
            text: "Measured on samples that were used for nothing else, ± one standard error. The \
                   ball of the reach holds all task points within the reach of the wrist. Means over \
                   W_F are those of the best configuration inside the limits; there are none where \
                   W_F is empty, or with more than one degree of redundancy."
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
        let (fit, samples) = match merit {
            // Every margin is 0 on the samples themselves.
            Merit::Margin => {
                let samples = u64::from(MARGIN_SAMPLES) * effort.fit_samples;
                ("samples its limits were not fitted on", samples)
            }
            _ => (
                "samples its limits were fitted on (biased)",
                effort.fit_samples,
            ),
        };
        add(fit, samples, exactly(fitted));
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
    for point in &winner.margins {
        let margin = format!("{:.0}", point.margin.to_degrees());
        table.rows.push(vec![margin, percent(&point.share)]);
    }
    let text = match tenth(&winner.measures) {
        Some(margin) => format!(
            "A joint that overshoots its limits before it locks costs fault tolerance. A margin of \
             {} costs a tenth of it.",
            merit_text(Merit::Margin, &margin)
        ),
        None => "A joint that overshoots its limits before it locks costs fault tolerance.".into(),
    };
    Section {
        heading: "Safety margin".into(),
        text,
        table,
    }
}

/// The margin that costs a tenth of S_F, if that is lost within the margins looked at.
pub(super) fn tenth(measures: &Measures) -> Option<Estimate> {
    let is_inside = |margin: &Estimate| margin.value > 0.0 && margin.value < WIDEST_MARGIN;
    measures.margin.filter(is_inside)
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
