//! Merits of robots as reports write them: labels, units, keys of `result.json`.

use crate::report::with_error;
use crate::synthesis::{Generation, Measures, Merit};
use crate::workspace::Estimate;
use serde_json::{Value, json};

/// Merits in words.
pub(super) fn merit_label(merit: Merit) -> &'static str {
    match merit {
        Merit::Share => "S_F / S_0max",
        Merit::BallShare => "ball share: S_F / ball of the reach",
        Merit::SizePerLength => "S_F / (total length)^d",
        Merit::PreFailureShare => "pre-failure share: W_0 / S_0max",
        Merit::Survival => "survival: W_F / W_0",
        Merit::Slenderness => "reach / total length",
        Merit::Condition => "1 / condition number, mean over W_F",
        Merit::NullComponent => "least null-vector component, mean over W_F",
        Merit::Margin => "margin that costs a tenth of S_F",
    }
}

/// Merits in a few words, for axes.
pub(super) fn merit_axis(merit: Merit) -> &'static str {
    match merit {
        Merit::Share => "S_F / S₀ₘₐₓ",
        Merit::BallShare => "ball share",
        Merit::SizePerLength => "S_F / length^d",
        Merit::PreFailureShare => "pre-failure share",
        Merit::Survival => "survival W_F / W_0",
        Merit::Slenderness => "reach / total length",
        Merit::Condition => "1 / condition number",
        Merit::NullComponent => "null-vector component",
        Merit::Margin => "margin",
    }
}

/// Whether a merit is read in percent.
fn is_share(merit: Merit) -> bool {
    matches!(
        merit,
        Merit::Share | Merit::BallShare | Merit::PreFailureShare | Merit::Survival
    )
}

/// The unit in which figures and tables show a merit.
pub(super) fn merit_unit(merit: Merit) -> &'static str {
    match merit {
        Merit::Margin => "deg",
        merit if is_share(merit) => "%",
        _ => "",
    }
}

/// What a merit is multiplied by to be shown in its unit.
pub(super) fn merit_scale(merit: Merit) -> f64 {
    match merit {
        merit if is_share(merit) => 100.0,
        merit => factor(merit),
    }
}

/// A merit with its error and unit.
pub(super) fn merit_text(merit: Merit, estimate: &Estimate) -> String {
    let scale = merit_scale(merit);
    let text = with_error(scale * estimate.value, scale * estimate.error);
    match merit_unit(merit) {
        "" => text,
        "deg" => format!("{text}°"),
        unit => format!("{text} {unit}"),
    }
}

/// What a merit is multiplied by in `result.json`, which has shares and degrees.
fn factor(merit: Merit) -> f64 {
    match merit {
        Merit::Margin => 1f64.to_degrees(),
        _ => 1.0,
    }
}

/// A merit, or a change of it, in `result.json`.
pub(super) fn merit_number(merit: Merit, value: f64) -> f64 {
    factor(merit) * value
}

/// A merit with its error in `result.json`.
pub(super) fn merit_json(merit: Merit, estimate: &Estimate) -> Value {
    json!({
        "value": merit_number(merit, estimate.value),
        "standard_error": merit_number(merit, estimate.error),
    })
}

/// Scores of generations in the unit of `result.json`.
pub(super) fn history_json(merit: Merit, history: &[Generation]) -> Value {
    let scaled = |generation: &Generation| Generation {
        best: merit_number(merit, generation.best),
        quartiles: generation.quartiles.map(|q| merit_number(merit, q)),
        ..*generation
    };
    json!(history.iter().map(scaled).collect::<Vec<Generation>>())
}

/// All merits by name, null where one was not measured, with L/R and the fill.
pub(super) fn merits_json(measures: &Measures) -> Value {
    let mut all = serde_json::Map::new();
    for merit in Merit::ALL {
        let key = match merit {
            Merit::Margin => "margin_deg",
            merit => merit.name(),
        };
        let value = measures
            .has(merit)
            .then(|| merit_json(merit, &measures.merit(merit)));
        all.insert(key.into(), json!(value));
    }
    let fill = merit_json(Merit::Share, &measures.fill);
    all.insert("fill".into(), fill);
    all.insert("length_in_reaches".into(), json!(measures.length));
    Value::Object(all)
}
