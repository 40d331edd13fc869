//! Table words to the words of a reader.
//!
//! A table column is called as in the YAML (`gap_ratio`); a reader knows it as the dimensionless gap clearance h′. What
//! is not listed here is its own name with spaces, so that a new column needs no change.

use serde::Serialize;

use super::number;

/// The word that stands for a key in YAML and as a table column: `velocity_ratio` for `Measure::VelocityRatio`.
#[must_use]
pub fn of_key<K: Serialize>(key: &K) -> String {
    match serde_json::to_value(key) {
        Ok(serde_json::Value::String(word)) => word,
        _ => String::new(),
    }
}

/// The name in words of a column that is no measure: `dimensionless gap clearance`.
#[must_use]
pub fn of_column(name: &str) -> String {
    match name {
        "force_ratio" => "dimensionless forcing amplitude",
        "base_amplitude_ratio" => "dimensionless base amplitude",
        "gap_ratio" => "dimensionless gap clearance",
        "gap" => "gap clearance",
        "mass" => "mass of the damper",
        "damping_ratio" => "structural damping ratio",
        "contact_damping_ratio" => "damping ratio of floor and ceiling",
        "stop" => "limit stop",
        "stop_length" => "limit stop length",
        "rms_acceleration" => "RMS acceleration",
        "base_displacement" => "base",
        "particle_displacement" => "particle",
        "floor_displacement" => "floor",
        "ceiling_displacement" => "ceiling",
        "rigid_floor" => "rigid floor",
        "rigid_ceiling" => "rigid ceiling",
        "varied" => "gap",
        "evaluation" => "evaluations",
        "best_so_far" => "best fitness so far",
        "along_gap" => "gap clearance",
        "fitness_along" => "fitness",
        _ => return name.replace('_', " "),
    }
    .to_owned()
}

/// The label of the exact solver in tables, and its word in YAML.
pub const EVENT_DRIVEN: &str = "event_driven";

/// A solver as its label in tables names it: `event-driven`, `fixed step 10 µs`.
#[must_use]
pub fn of_solver(label: &str) -> String {
    let step = label.strip_prefix("fixed_step_").and_then(|rest| rest.strip_suffix('s'));
    match step.and_then(|seconds| seconds.parse::<f64>().ok()) {
        Some(seconds) => format!("fixed step {}", number::quantity(seconds, "s", 3)),
        None => label.replace(EVENT_DRIVEN, "event-driven").replace('_', " "),
    }
}

/// One level of a text column as a line of a figure is labelled: `without stop`, `event-driven`.
#[must_use]
pub fn of_level(column: &str, level: &str) -> String {
    match column {
        "solver" => of_solver(level),
        "stop" => format!("{level} stop"),
        "dampers" => format!("{level} damper"),
        "candidate" => match level {
            "genetic" => "genetic algorithm".into(),
            "two_opt" => "2-opt".into(),
            "cma_es" => "CMA-ES".into(),
            "dense" => "dense search".into(),
            "polish" => "polished".into(),
            _ => match level.strip_suffix("_two_opt") {
                Some(improved) => format!("{} after 2-opt", improved.replace('_', " ")),
                None => level.replace('_', " "),
            },
        },
        "filling" => format!("{level} gaps"),
        _ => level.replace('_', " "),
    }
}

/// What a number of this unit is, where no better word is at hand: `displacement` for m.
#[must_use]
pub fn of_unit(unit: &str) -> &'static str {
    match unit {
        "m" => "displacement",
        "s" | "ms" | "µs" => "time",
        "m/s" => "velocity",
        "m/s^2" | "m/s²" | "g" => "acceleration",
        "N s/m" => "damping",
        "Hz" => "frequency",
        "N" => "force",
        _ => "value",
    }
}

/// First letter in upper case.
#[must_use]
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().collect::<String>() + letters.as_str(),
        None => String::new(),
    }
}

/// `1 entry`, `2 entries`.
#[must_use]
pub fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{} {}", number::count(count as u64), if count == 1 { one } else { many })
}
