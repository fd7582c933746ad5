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
        // More than six decimals help nobody on a terminal; result.json has them.
        let error = size["error"].as_f64().unwrap_or(0.0);
        let value = if error < 5e-7 {
            format!("{value:.6}")
        } else {
            with_error(value, error)
        };
        let _ = writeln!(text, "  {:<25} {value} {unit}", "fault-tolerant workspace");
    }
    if let Some(value) = size["unrestricted"].as_f64() {
        let _ = writeln!(text, "  {:<25} {value:.6} {unit}", "unrestricted workspace");
    }
    if let Some(share) = size["normalised"].as_f64() {
        let _ = writeln!(text, "  {:<25} {:.3} %", "share", 100.0 * share);
    }
    for (joint, limits) in limits(result).iter().enumerate() {
        let label = format!("limits of joint {}", joint + 1);
        let _ = writeln!(text, "  {label:<25} {:.3}° to {:.3}°", limits[0], limits[1]);
    }
    let _ = writeln!(text, "  {:<25} {}", "report", out.display());
    text
}

fn limits(result: &Value) -> Vec<[f64; 2]> {
    let limits = &result["limits_deg"];
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
    fn an_odd_result_is_no_panic() {
        assert!(summary(&json!([1]), Path::new("x")).contains('?'));
    }
}
