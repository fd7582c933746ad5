//! Checks `[synthesis]` against the robot and the task.

use super::file::StudyFile;
use super::serve;
use super::settings::{DegreeLimits, Design, Study};
use super::synthesis_settings::SynthesisStudy;
use super::{limits, synthesis_objectives, synthesis_table};
use crate::diagnostic::{Place, Problems};
use crate::manifold::MOST_REDUNDANT;
use crate::synthesis::{Arm, Links};
use crate::workspace::FailureSet;

/// Settings of `kind = "synthesis"`.
#[derive(Clone, Debug, PartialEq)]
pub struct SynthesisQuestion {
    /// Limits of the design, with which it is compared; fitted if there are none.
    pub limits: Option<DegreeLimits>,
    /// The table.
    pub search: SynthesisStudy,
}

impl SynthesisQuestion {
    /// F for the robots that are searched, which may have another number of joints than the design.
    pub(super) fn failures(&self, study: &Study) -> FailureSet {
        let joints = self.search.links.len();
        match joints == study.design.robot.joints() {
            true => study.failures.clone(),
            false => FailureSet::any(joints).with_margin(study.failures.margin()),
        }
    }
}

/// The validated question; reports to `problems` whatever is wrong.
pub(super) fn synthesis(
    file: &StudyFile,
    problems: &Problems,
    design: &Design,
) -> Option<SynthesisQuestion> {
    let task = file.space.value;
    if task.is_planar() {
        problems.reject(
            &file.space.place,
            "planar robots are searched exactly, by another kind of study",
            "a spatial task",
            "write `kind = \"optimise\"` with `link_lower` and `link_upper` in `[search]`",
        );
        return None;
    }
    serve::check_atlas(file, problems, &design.robot);
    let table = file.synthesis.as_ref();
    let joints = design.robot.joints();
    let wanted = table.and_then(|item| item.value.joints.as_ref());
    let count = wanted.map_or(joints, |item| item.value as usize);
    let (least, most) = (task.dimension() + 1, task.dimension() + MOST_REDUNDANT);
    if let Some(item) = wanted.filter(|_| !(least..=most).contains(&count)) {
        problems.reject(
            &item.place,
            "robots with so many joints cannot be searched for this task",
            &format!("{least} to {most} joints for \"{task}\""),
            "choose another number of joints",
        );
        return None;
    }
    if let Some(item) = table {
        synthesis_objectives::check(&item.value, count, task, problems);
    }
    check_failures(file, problems, count, joints);
    if Arm::of_robot(&design.robot, task).is_none() {
        problems.reject(
            &file.design.place,
            "the robot reaches nothing",
            "a robot with links",
            "choose another robot to compare with",
        );
        return None;
    }
    let search = synthesis_table::settings(table, joints, problems);
    check_idle(file, problems);
    check_reach(file, problems, &search, design);
    let start = table.and_then(|item| item.value.design_place());
    if let Some(place) = start.filter(|_| search.links_of(&design.robot, task).is_none()) {
        problems.reject(
            place,
            "the search cannot start from this design",
            &format!("a robot of {count} revolute joints in standard rows"),
            "choose another family, or another design",
        );
    }
    let given = match &file.limits {
        Some(table) => Some(limits::check(table, problems, &design.robot)?),
        None => None,
    };
    Some(SynthesisQuestion {
        limits: given,
        search,
    })
}

/// A failure set names joints of the design and of the robots that are searched.
fn check_failures(file: &StudyFile, problems: &Problems, count: usize, joints: usize) {
    let Some(super::file::Failures::Of(list)) = file.failures.as_ref().map(|item| &item.value)
    else {
        return;
    };
    if count != joints {
        let place: Option<&Place> = list.first().map(|item| &item.place);
        if let Some(place) = place {
            problems.reject(
                place,
                "joints are listed, but the design has another number of them than the robots \
                 that are searched",
                "`failures = \"any\"`",
                "write \"any\", or choose a design with as many joints",
            );
        }
    }
}

/// Random robots of which at least one must have the reach.
const TRIED: u32 = 64;

/// Fixed lengths may keep all robots from the reach that is asked for.
fn check_reach(file: &StudyFile, problems: &Problems, search: &SynthesisStudy, design: &Design) {
    let task = file.space.value;
    let links = file.synthesis.as_ref().and_then(|t| t.value.links.as_ref());
    // Wrong rows have been reported.
    let Some(links) = links.filter(|rows| rows.value.len() == search.links.len()) else {
        return;
    };
    let space = search.link_space(task);
    let start = search
        .include_design
        .then(|| search.links_of(&design.robot, task));
    if start.flatten().is_some_and(|start| space.has_reach(&start)) {
        return;
    }
    let robots: Vec<Links> = (0..TRIED).map(|k| space.numbered(1, k)).collect();
    if robots.iter().any(|robot| space.has_reach(robot)) {
        return;
    }
    let reaches = robots.iter().map(|robot| space.reach(robot));
    let reaches: Vec<f64> = reaches.collect();
    let metres = |share: f64| share * search.reach;
    let least = metres(reaches.iter().copied().fold(f64::INFINITY, f64::min));
    let most = metres(reaches.iter().copied().fold(0.0, f64::max));
    problems.reject(
        &links.place,
        &format!(
            "robots of these links reach from {least:.3} to {most:.3} m, none of them as far as asked"
        ),
        &format!("links of which robots with `reach` = {} m can be made", search.reach),
        "change `reach`, or leave more lengths free",
    );
}

fn check_idle(file: &StudyFile, problems: &Problems) {
    let table = file.synthesis.as_ref().map(|item| &item.value);
    let idle = table.and_then(|table| table.idle(file.space.value));
    if let Some((place, name)) = idle {
        problems.reject(
            place,
            &format!("{name} changes neither S_F nor S_0max, so it is not searched"),
            "0, or nothing",
            "leave it out; give it any value in the robot file afterwards",
        );
    }
}
