//! A few lines about a result, for people.

use crate::report::with_error;
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// The main numbers of a `result.json`; what it does not have is left out.
pub(super) fn summary(result: &Value, out: &Path) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let text_of = |key: &str| result[key].as_str().unwrap_or("?");
    let _ = writeln!(
        text,
        "{} ({}): {}",
        text_of("study"),
        text_of("kind"),
        text_of("status")
    );
    let size = &result["size"];
    let unit = size["unit"].as_str().unwrap_or("");
    if let Some(value) = size["fault_tolerant"].as_f64() {
        let value = number(value, &size["error"]);
        let _ = writeln!(text, "  {:<25} {value} {unit}", "fault-tolerant workspace");
    }
    if let Some(value) = size["unrestricted"].as_f64() {
        let value = number(value, &result["workspaces"]["unrestricted"]["error"]);
        let _ = writeln!(text, "  {:<25} {value} {unit}", "unrestricted workspace");
    }
    if let Some(share) = size["normalised"].as_f64() {
        let _ = writeln!(text, "  {:<25} {:.3} %", "share", 100.0 * share);
    }
    structure(result, &mut text);
    pose(result, &mut text);
    singular(result, &mut text);
    robots(result, &mut text);
    let slides = limits(&result["limits_m"]);
    let kind = if slides.is_empty() { "" } else { "revolute " };
    for (joint, limits) in limits(&result["limits_deg"]).iter().enumerate() {
        let label = format!("limits of {kind}joint {}", joint + 1);
        let _ = writeln!(text, "  {label:<25} {:.3}° to {:.3}°", limits[0], limits[1]);
    }
    for (joint, limits) in slides.iter().enumerate() {
        let label = format!("limits of prismatic joint {}", joint + 1);
        let _ = writeln!(
            text,
            "  {label:<25} {:.4} m to {:.4} m",
            limits[0], limits[1]
        );
    }
    let _ = writeln!(text, "  {:<25} {}", "report", out.display());
    text
}

/// More than six decimals help nobody on a terminal; result.json has them.
fn number(value: f64, error: &Value) -> String {
    let error = error.as_f64().unwrap_or(0.0);
    if error < 5e-7 {
        format!("{value:.6}")
    } else {
        with_error(value, error)
    }
}

/// Why no limits make the robot fault tolerant: the first note says it.
fn structure(result: &Value, text: &mut String) {
    if let (true, Some(note)) = (result["structure"].is_object(), result["notes"][0].as_str()) {
        let _ = writeln!(text, "  {note}");
    }
}

/// What a study of one pose found.
fn pose(result: &Value, text: &mut String) {
    let Some(manifolds) = result["manifolds"].as_array() else {
        return;
    };
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<25} {value}");
    };
    let lengths = manifolds
        .iter()
        .filter_map(|manifold| manifold["length"].as_f64());
    let lengths: Vec<String> = lengths.map(|length| format!("{length:.3}")).collect();
    // Of a surface there are slices, and no count of its parts.
    match result["slices"]["curves"].as_u64() {
        Some(curves) => {
            let dimension = result["degree_of_redundancy"].as_u64().unwrap_or(2);
            let slices = result["slices"]["with_curves"].as_u64().unwrap_or(0);
            line("surface of dimension", dimension.to_string());
            line("curves on slices", format!("{curves} on {slices}"));
        }
        None => line("self-motion manifolds", manifolds.len().to_string()),
    }
    if !lengths.is_empty() {
        line("lengths", format!("{} rad", lengths.join(", ")));
    }
    let completeness = &result["completeness"];
    let missed = completeness["missed"].as_f64();
    let share = completeness["missed_share"].as_f64();
    let kind = completeness["kind"].as_str().unwrap_or("?");
    line(
        "completeness",
        match (missed, share) {
            (Some(missed), _) => {
                format!("{kind}, a manifold is missing with probability {missed:.1e}")
            }
            (_, Some(share)) => format!("{kind}, at most {:.1} % missing (95 %)", 100.0 * share),
            _ => kind.to_owned(),
        },
    );
    if let Some(answer) = result["fault_tolerant"].as_bool() {
        let answer = if answer { "yes" } else { "no" };
        line("fault tolerant", answer.to_owned());
    }
}

/// What a study about singular configurations found.
fn singular(result: &Value, text: &mut String) {
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<25} {value}");
    };
    let count = |key: &str| result[key].as_array().map(Vec::len);
    if let Some(found) = count("singularities") {
        line("singular configurations", found.to_string());
        line("families", count("families").unwrap_or(0).to_string());
    }
    if let Some(size) = result["largest_size"].as_f64() {
        line("largest location", format!("{size:.6} rad"));
        let most = result["most_possible"].as_f64().unwrap_or(f64::NAN);
        line("largest possible", format!("{most:.6} rad"));
        let least = result["smallest_size"].as_f64().unwrap_or(f64::NAN);
        line("smallest location", format!("{least:.6} rad"));
    }
    for goal in result["goals"].as_array().into_iter().flatten() {
        let name = goal["name"].as_str().unwrap_or("?");
        let success = 100.0 * goal["success"].as_f64().unwrap_or(f64::NAN);
        let worst = goal["worst_position_error_m"].as_f64().unwrap_or(f64::NAN);
        line(
            name,
            format!("reached after {success:.1} % of locks, worst {worst:.4} m off"),
        );
    }
}

/// What a search for robots found: percentages of shares.
fn robots(result: &Value, text: &mut String) {
    let mut line = |label: &str, estimate: &Value| {
        let of = |key: &str| 100.0 * estimate[key].as_f64().unwrap_or(f64::NAN);
        let value = with_error(of("value"), of("standard_error"));
        let _ = writeln!(text, "  {label:<25} {value} %");
    };
    for (label, estimate) in [
        ("share S_F / S_0max", &result["merits"]["share"]),
        ("the same, checked", &result["locked_joint_check"]["share"]),
        ("of the design", &result["reference"]["merits"]["share"]),
    ] {
        if estimate.is_object() {
            line(label, estimate);
        }
    }
    let honesty = &result["honesty"];
    if let Some(merit) = honesty["merit"].as_str().filter(|merit| *merit != "share") {
        let of = |key: &str| honesty["reported"][key].as_f64().unwrap_or(f64::NAN);
        let unit = if merit == "margin" { "°" } else { "" };
        let value = with_error(of("value"), of("standard_error"));
        let _ = writeln!(text, "  {merit:<25} {value}{unit}");
    }
    if let Some(front) = result["front"].as_array() {
        let _ = writeln!(text, "  {:<25} {}", "robots of the front", front.len());
    }
    for (index, row) in result["robot"].as_array().into_iter().flatten().enumerate() {
        let number = |key: &str| row[key].as_f64().unwrap_or(f64::NAN);
        let label = format!("joint {}", index + 1);
        let _ = writeln!(
            text,
            "  {label:<25} α {:.2}°, a {:.4} m, d {:.4} m",
            number("alpha_deg"),
            number("a"),
            number("d")
        );
    }
}

/// Pairs of a lower and an upper limit.
fn limits(limits: &Value) -> Vec<[f64; 2]> {
    let side = |key: &str| limits[key].as_array().cloned().unwrap_or_default();
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let pairs = side("lower").into_iter().zip(side("upper"));
    pairs
        .map(|(lower, upper)| [number(&lower), number(&upper)])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_main_numbers_are_there() {
        let result = json!({
            "study": "3r", "kind": "optimise", "status": "converged",
            "size": { "fault_tolerant": 3.562127, "unrestricted": 28.27, "normalised": 0.126,
                      "unit": "m^2" },
            "limits_deg": { "lower": [-18.2], "upper": [18.2] },
        });
        let text = summary(&result, Path::new("reports/3r"));
        for part in [
            "3r (optimise): converged",
            "3.562127 m^2",
            "12.600 %",
            "-18.200°",
        ] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
    }

    #[test]
    fn manifolds_are_counted() {
        let result = json!({
            "study": "m", "kind": "manifolds", "status": "done",
            "manifolds": [{ "length": 9.1 }, { "length": 26.0 }],
            "completeness": { "kind": "evidence", "missed": 0.015 }, "fault_tolerant": true,
        });
        let text = summary(&result, Path::new("x"));
        for part in ["manifolds     2", "9.100, 26.000 rad", "1.5e-2", "yes"] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
    }

    #[test]
    fn surfaces_are_not_counted() {
        let result = json!({
            "study": "m", "kind": "manifolds", "status": "done", "degree_of_redundancy": 2,
            "manifolds": [], "slices": { "curves": 41, "with_curves": 20 },
            "completeness": { "kind": "sampled", "missed_share": 0.0125 },
        });
        let text = summary(&result, Path::new("x"));
        for part in ["dimension      2", "41 on 20", "at most 1.2 % missing"] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
        assert!(!text.contains("manifolds     0"), "{text}");
    }

    #[test]
    fn robots_are_shown_with_their_share() {
        let result = json!({
            "study": "d", "kind": "synthesis", "status": "done",
            "merits": { "share": { "value": 0.1839, "standard_error": 0.0009 } },
            "robot": [{ "alpha_deg": 90.0, "a": 0.16, "d": -0.12 }],
        });
        let text = summary(&result, Path::new("x"));
        for part in ["18.390 ± 0.090 %", "α 90.00°, a 0.1600 m, d -0.1200 m"] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
    }

    #[test]
    fn an_odd_result_is_no_panic() {
        assert!(summary(&json!([1]), Path::new("x")).contains('?'));
    }
}
