//! A new experiment to begin with: whole, valid, and short enough to be rewritten.

use crate::scene::{Form, KINDS, Kind};

use super::id::ExperimentId;

/// Words for the structures that a scaffold can have.
#[must_use]
pub fn structures() -> Vec<&'static str> {
    KINDS.iter().map(|kind| kind.name).collect()
}

/// The text of an experiment on this structure; `schema` is where its JSON Schema stands, as seen from its file. `None` if there
/// is no such structure.
#[must_use]
pub fn scaffold(id: &ExperimentId, structure: &str, schema: &str) -> Option<String> {
    let kind = KINDS.iter().find(|kind| kind.name == structure)?;
    let fields: Vec<String> = kind
        .fields
        .iter()
        .filter_map(|field| Some(format!("{}: {}", field.key, example(kind, field.key, field.form)?)))
        .collect();
    let place = match kind.sides.len() {
        0 => "",
        1 => "0.5",
        _ => "[0.5, 0.5]",
    };
    // A single mass has no places, and a spring that a floor can be compared with.
    let (at_damper, at_force, share, stiffness) = if place.is_empty() {
        (String::new(), String::new(), "", "stiffness_ratio: 1")
    } else {
        let share = "      particle_share: 0.5\n";
        (format!("at: {place}\n      "), format!("at: {place}, "), share, "stiffness: tuned")
    };
    let title = crate::text::words::capitalised(&id.0.replace('-', " "));
    Some(format!(
        "\
# yaml-language-server: $schema={schema}
title: {title}
about: >-
  One or two sentences: what is varied, and what is looked at.
scene:
  structure:
    {structure}: {{{fields}}}
  dampers:
    - {at_damper}mass_ratio: 0.05
{share}      gap_ratio: 50
      floor: {{resilient: {{{stiffness}, damping_ratio: 0.15}}}}
  excitation: {{impulse_train: {{{at_force}force_ratio: swept, frequency_ratio: 1}}}}
sweep:
  force_ratio: {{log: {{from: 0.1, to: 100, points: 31}}}}
run: {{skip: 100 cycles, average: 100 cycles, ensemble: 8 members}}
measure: velocity_ratio
figure:
  x: {{column: force_ratio, scale: log}}
  y: velocity_ratio
  band: spread
  caption: Velocity ratio against the forcing amplitude.
",
        fields = fields.join(", "),
    ))
}

/// A plausible value of a structure's key; none for a key that may be left out.
fn example(kind: &Kind, key: &str, form: Form) -> Option<&'static str> {
    Some(match (form, key) {
        (Form::Word(_), _) => return None,
        (Form::Modes, _) => "4",
        (Form::Length, "thickness") => "5 mm",
        (Form::Length, "width") if kind.sides.len() < 2 => "30 mm",
        (Form::Length, _) => "1 m",
        (Form::Mass, _) => "1 kg",
        (Form::Stiffness, _) => "1000 N/m",
        (Form::Stress, _) => "200 GPa",
        (Form::Density, _) => "7800 kg/m^3",
        (Form::Ratio, "rayleigh") => "1e-3",
        (Form::Ratio, "poisson_ratio") => "0.3",
        (Form::Ratio, _) => "0.05",
    })
}
