//! Assumptions in words.

use std::collections::{BTreeMap, BTreeSet};

use super::markdown::{Align, MarkdownTable, details, one_line};
use super::run::joined;
use super::view::AssumptionView;
use crate::experiment::{AssumptionName, Unsourced};

/// The assumptions on an experiment's page: their values, and where their reasons stand.
pub(super) fn links(assumptions: &[AssumptionView], to_reports: &str) -> String {
    if assumptions.is_empty() {
        return String::new();
    }
    let link =
        |one: &AssumptionView| format!("[`{name}`]({to_reports}assumptions.md#{name}) {}", one.value, name = one.name);
    assumptions.iter().map(link).collect::<Vec<_>>().join(" · ") + "\n\n"
}

/// Those that have other values and are not among the `moved`: u_input leaves them out.
pub(super) fn not_moved(assumptions: &[AssumptionView], moved: &BTreeSet<AssumptionName>) -> String {
    let is_left = |one: &&AssumptionView| one.has_range && !moved.iter().any(|name| name.to_string() == one.name);
    let left: Vec<String> = assumptions.iter().filter(is_left).map(|one| format!("`{}`", one.name)).collect();
    match left.len() {
        0 => String::new(),
        many => {
            let have = if many == 1 { "has" } else { "have" };
            format!("Of these {} {have} other values that were not tried here.\n\n", joined(&left))
        }
    }
}

/// The inputs on an experiment's page that neither the text of the study nor an assumption gives.
pub(super) fn without_source(inputs: &[Unsourced]) -> String {
    if inputs.is_empty() {
        return String::new();
    }
    let others = if inputs.iter().any(|one| !one.stated.is_empty()) {
        " (in brackets another value that the text does state)"
    } else {
        ""
    };
    format!(
        "Neither stated in the text of the study nor declared as an assumption{others}: {}.\n\n",
        inputs.iter().map(|one| format!("`{one}`")).collect::<Vec<_>>().join(" · ")
    )
}

/// `reports/assumptions.md`: all assumptions with the entries of the experiments that use them.
#[must_use]
pub fn assumptions(assumptions: &[AssumptionView]) -> String {
    let head = "# Assumptions\n\nInputs that the study uses and does not state. [The study in one page](README.md)\n\n";
    format!("{head}{}{}", table_with_counts(assumptions), dependents(assumptions))
}

fn table_with_counts(assumptions: &[AssumptionView]) -> String {
    let mut table = MarkdownTable::new(&[
        ("Assumption", Align::Left),
        ("Value", Align::Left),
        ("Why", Align::Left),
        ("Entries of experiments that use it", Align::Right),
    ]);
    for assumption in assumptions {
        let name = format!("<a id=\"{name}\"></a>`{name}`", name = assumption.name);
        table.row([name, assumption.value.clone(), reason(assumption), assumption.used_by.len().to_string()]);
    }
    table.finish() + "\n"
}

/// The entries of the experiments that use each assumption, closed.
fn dependents(assumptions: &[AssumptionView]) -> String {
    let used = assumptions.iter().filter(|assumption| !assumption.used_by.is_empty());
    let lines: String =
        used.map(|assumption| format!("- `{}`: {}.\n", assumption.name, entries(&assumption.used_by))).collect();
    details("The entries of the experiments that use each", &lines)
}

fn reason(assumption: &AssumptionView) -> String {
    let reason = one_line(&assumption.reason);
    if assumption.fitted_to.is_empty() {
        reason
    } else {
        format!("{reason} Chosen by {}.", entries(&assumption.fitted_to))
    }
}

/// Ids grouped by experiment, so that a long list stays readable: `ch3-gap` (maximum, order).
fn entries(ids: &[String]) -> String {
    let mut groups: Vec<(&str, Vec<&str>)> = Vec::new();
    let mut known = BTreeMap::new();
    for id in ids {
        let (experiment, entry) = id.split_once('/').unwrap_or((id, ""));
        let group = *known.entry(experiment).or_insert_with(|| {
            groups.push((experiment, Vec::new()));
            groups.len() - 1
        });
        groups[group].1.push(entry);
    }
    let group = |(experiment, entries): &(&str, Vec<&str>)| {
        let entries: Vec<&str> = entries.iter().copied().filter(|entry| !entry.is_empty()).collect();
        if entries.is_empty() { format!("`{experiment}`") } else { format!("`{experiment}` ({})", entries.join(", ")) }
    };
    groups.iter().map(group).collect::<Vec<_>>().join(", ")
}
