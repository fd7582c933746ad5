//! Runs `kind = "singularities"`: where the robot loses rank.

use super::location_result::location_search;
use super::manifold_report::drawn;
use super::manifold_result::Joints;
use super::report_parts::{formats, provenance_rows};
use super::result::{SCHEMA, provenance};
use super::run::{Ready, RunError, RunOptions};
use super::settings::Study;
use super::singular_settings::SingularitySearch;
use crate::kinematics::Chain;
use crate::report::{
    Figure, FindingReport, ManifoldCurve, Section, SingularPoint, SingularityFigure, SplitFigure,
    SplitPanel, Table, joint_symbol, write_finding_report,
};
use crate::singularity::{Arm, Catalogue, SingularFamily, Split, find_singularities, find_split};
use anyhow::anyhow;
use serde_json::{Value, json};

/// The tool is moved this far beside a singular configuration, metres and radians.
const BESIDE: f64 = 0.03;

/// Runs `study` and returns the content of `result.json`.
///
/// # Errors
/// A file could not be written, or the robot cannot do the task.
pub(super) fn run(
    study: &Study,
    search: &SingularitySearch,
    options: &RunOptions,
    ready: Ready,
) -> Result<Value, RunError> {
    ready.begin(options)?;
    let progress = &ready.session.progress;
    progress.update(0, 3, f64::NAN, "descending to singular configurations");
    let robot = &study.design.robot;
    let chain =
        Chain::new(robot).ok_or_else(|| anyhow!("a prismatic joint without physical limits"))?;
    let physical = crate::manifold::physical_arcs(robot);
    let arm = Arm {
        chain: &chain,
        task: study.task,
    };
    let mut catalogue = find_singularities(&arm, &physical, &search.settings(), study.seed);
    progress.update(1, 3, f64::NAN, "tracing manifolds beside one of them");
    // With another degree of redundancy there are no curves to show.
    let mut locations = location_search(study).ok();
    if let Some(search) = &mut locations {
        catalogue.merge_self_motion(search, study.seed);
    }
    let split = locations
        .as_mut()
        .and_then(|search| find_split(search, &catalogue, BESIDE, study.seed));
    let seconds = json!({ "total": ready.session.store.seconds() });
    let result = to_json(study, search, &catalogue, split.as_ref(), seconds);
    progress.update(2, 3, f64::NAN, "writing the report");
    write(
        study,
        &catalogue,
        split,
        &result,
        options,
        &ready.study_toml,
    )
    .map_err(anyhow::Error::from)?;
    ready.session.store.remove();
    Ok(result)
}

fn to_json(
    study: &Study,
    search: &SingularitySearch,
    catalogue: &Catalogue,
    split: Option<&Split>,
    seconds: Value,
) -> Value {
    let rank = study.task.dimension();
    let joints = Joints::of(&study.design.robot);
    let mut result = json!({
        "schema": SCHEMA,
        "study": study.name,
        "kind": study.question.kind(),
        "status": "done",
        "full_rank": rank,
        "starts": search.starts,
    });
    let tallies = catalogue.tallies.iter().map(|tally| {
        json!({
            "rank": rank - tally.loss,
            "singular": tally.singular,
            "local_minimum": tally.local_minimum,
            "too_many_steps": tally.too_many_steps,
        })
    });
    result["descents"] = tallies.collect();
    result["families"] = catalogue
        .families
        .iter()
        .map(|family| family_json(family, rank, &joints))
        .collect();
    let singularities = catalogue.singularities.iter().map(|found| {
        let mut value = json!({
            "rank": rank - found.loss,
            "family": found.family + 1,
            "starts": found.hits,
            "singular_values": found.sigma,
        });
        joints.put_theta(&mut value, &found.theta);
        value
    });
    result["singularities"] = singularities.collect();
    if let Some(split) = split {
        result["split"] = json!({
            "singularity": split.index + 1,
            "step": split.step,
            "manifolds": split.locations.each_ref().map(|(manifolds, _)| manifolds.len()),
            "sizes": split.locations.each_ref().map(|(_, size)| *size),
        });
    }
    result["notes"] = json!(notes(study, catalogue));
    result["seconds"] = seconds;
    result["provenance"] = provenance(study, rayon::current_num_threads());
    result
}

fn family_json(family: &SingularFamily, rank: usize, joints: &Joints) -> Value {
    let held = family.held.iter().map(|&(joint, value)| {
        let mut theta = vec![0.0; joint + 1];
        theta[joint] = value;
        let key = if joints.slides[joint] { "m" } else { "deg" };
        json!({ "joint": joint + 1, key: joints.outer(joint, &theta) })
    });
    json!({
        "rank": rank - family.loss,
        "dimension": family.dimension,
        "held": held.collect::<Vec<Value>>(),
        "starts": family.hits,
        "members": family.members,
    })
}

fn notes(study: &Study, catalogue: &Catalogue) -> Vec<String> {
    let mut notes = Vec::new();
    if catalogue.singularities.is_empty() {
        notes.push(
            "No start reached a singular configuration: the robot may have none, or `starts` is \
             too low."
                .into(),
        );
    }
    if study.design.robot.physical_limits.is_some() {
        notes.push(
            "Starts lie inside the physical limits; singular configurations beyond them are listed too."
                .into(),
        );
    }
    notes
}

/// Family in words: the joints that are held, as in "θ₂ = 0°, θ₃ = 90°".
fn held_words(family: &SingularFamily, joints: &Joints) -> String {
    let word = |&(joint, value): &(usize, f64)| {
        let mut theta = vec![0.0; joint + 1];
        theta[joint] = value;
        let value = joints.outer(joint, &theta);
        let value = if value.abs() < 5e-4 { 0.0 } else { value };
        let unit = if joints.slides[joint] { " m" } else { "°" };
        let number = format!("{value:.3}");
        let number = number.trim_end_matches('0').trim_end_matches('.');
        format!("{} = {number}{unit}", joint_symbol(joint + 1))
    };
    let words: Vec<String> = family.held.iter().map(word).collect();
    match words.is_empty() {
        true => "no joint stands still".into(),
        false => words.join(", "),
    }
}

fn sections(study: &Study, catalogue: &Catalogue) -> Vec<Section> {
    let rank = study.task.dimension();
    let joints = Joints::of(&study.design.robot);
    let mut tallies = Table::new(&[
        "rank aimed at",
        "singular",
        "local minimum",
        "too many steps",
    ]);
    for tally in &catalogue.tallies {
        let counts = [tally.singular, tally.local_minimum, tally.too_many_steps];
        let mut row = vec![(rank - tally.loss).to_string()];
        row.extend(counts.map(|count| count.to_string()));
        tallies.rows.push(row);
    }
    let mut families = Table::new(&["family", "rank", "dimension", "held joints", "starts"]);
    for (number, family) in (1..).zip(&catalogue.families) {
        families.rows.push(vec![
            format!("{number}"),
            (rank - family.loss).to_string(),
            family.dimension.to_string(),
            held_words(family, &joints),
            family.hits.to_string(),
        ]);
    }
    vec![
        Section {
            heading: "How the descents ended".into(),
            text: "Descents of the singular values from random starts, one for every start and \
                   rank [S1 Algorithm 1]."
                .into(),
            table: tallies,
        },
        Section {
            heading: "Families of singular configurations".into(),
            text: "Configurations that can be moved into each other without leaving the rank \
                   share a family. Its dimension counts all such motions; joints are held that \
                   stand still in all of them."
                .into(),
            table: families,
        },
    ]
}

fn summary(study: &Study, catalogue: &Catalogue) -> Vec<String> {
    let rank = study.task.dimension();
    let most = catalogue.singularities.iter().map(|s| s.loss).max();
    let families = catalogue.families.len();
    let count = catalogue.singularities.len();
    vec![match most {
        None => "No singular configuration was found.".into(),
        Some(most) => format!(
            "{count} different singular configurations in {families} families were found. The \
             Jacobian, of rank {rank} elsewhere, falls to rank {}.",
            rank - most
        ),
    }]
}

fn write(
    study: &Study,
    catalogue: &Catalogue,
    split: Option<Split>,
    result: &Value,
    options: &RunOptions,
    study_toml: &str,
) -> Result<(), crate::report::ReportError> {
    let point = |found: &crate::singularity::Singularity| SingularPoint {
        configuration: found.theta.clone(),
        loss: found.loss,
        sigma: found.sigma.clone(),
        hits: found.hits,
        family: found.family + 1,
    };
    let points: Vec<SingularPoint> = catalogue.singularities.iter().map(point).collect();
    let robot = &study.design.robot;
    let strip = SingularityFigure {
        points: &points,
        joint_count: robot.joints(),
        rank: study.task.dimension(),
        title: robot.name.clone(),
    };
    let split = split.map(|split| split_figure(split, study));
    let mut figures: Vec<&dyn Figure> = vec![&strip];
    figures.extend(split.as_ref().map(|figure| figure as &dyn Figure));
    let report = FindingReport {
        title: study.title.clone().unwrap_or_else(|| study.name.clone()),
        study: study.name.clone(),
        robot: robot.name.clone(),
        source: robot.source.clone().unwrap_or_default(),
        summary: summary(study, catalogue),
        sections: sections(study, catalogue),
        figures,
        files: Vec::new(),
        tables: Vec::new(),
        result_json: result.clone(),
        study_toml: study_toml.to_owned(),
        provenance: provenance_rows(study, rayon::current_num_threads()),
        notes: notes(study, catalogue),
    };
    let page = study.report.figures;
    write_finding_report(&report, &options.out, &formats(study), page)?;
    Ok(())
}

fn split_figure(split: Split, study: &Study) -> SplitFigure {
    let names = ["one side", "singular location", "other side"];
    let panels = split.locations.iter().zip(names);
    let panels: Vec<SplitPanel> = panels
        .map(|((manifolds, size), name)| SplitPanel {
            title: name.into(),
            curves: manifolds.iter().map(drawn).collect::<Vec<ManifoldCurve>>(),
            size: *size,
        })
        .collect();
    // The two joints that move most along the manifolds of the middle.
    let joints = study.design.robot.joints();
    let travel = |joint: usize| -> f64 {
        let [.., (manifolds, _), _] = &split.locations;
        manifolds
            .iter()
            .map(|m| {
                let [low, high] = m.span(joint);
                high - low
            })
            .sum()
    };
    let mut order: Vec<usize> = (0..joints).collect();
    order.sort_by(|a, b| travel(*b).total_cmp(&travel(*a)));
    let mut axes = [order[0] + 1, order.get(1).map_or(1, |joint| joint + 1)];
    axes.sort_unstable();
    SplitFigure {
        panels,
        node: split.node,
        joints: axes,
        joint_count: joints,
        title: study.design.robot.name.clone(),
    }
}
