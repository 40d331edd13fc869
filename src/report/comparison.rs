//! What the study says beside what came out.

use crate::reference::{Comparison, Judged, Moved, Price, Verdict};
use crate::text::number::{compact, signed, significant};

use super::markdown::{Align, MarkdownTable, counted, one_line};
use super::tally::{Tally, role, shown};

/// The section on an experiment's page.
pub(super) fn section(judged: &[Judged]) -> String {
    let mut text = String::from("## What the study says, and what came out\n\n");
    if judged.is_empty() {
        text += "The study makes no claim and quotes no number here that a run could be held against.\n\n";
        return text;
    }
    text += &format!("{}.\n\n", sentence_of(&Tally::of(judged)));
    text += &entries(judged);
    text += &numbers(judged);
    text += &other_readings(judged);
    text += &by_hand(judged);
    text += &explanations(judged);
    text
}

fn sentence_of(tally: &Tally) -> String {
    let total = tally.total();
    if total == 1 {
        format!("One entry: {}", tally.describe())
    } else {
        format!("{total} entries: {}", tally.describe())
    }
}

fn entries(judged: &[Judged]) -> String {
    let moved = judged.iter().any(|one| one.robust.is_some());
    let mut header = vec![
        ("Entry", Align::Left),
        ("The study says", Align::Left),
        ("Where", Align::Left),
        ("What came out", Align::Left),
        ("Verdict", Align::Left),
        ("Fitted or held out", Align::Left),
        ("Rests on", Align::Right),
    ];
    if moved {
        header.push(("Same verdict with one assumption moved", Align::Right));
    }
    let mut table = MarkdownTable::new(&header);
    for one in judged {
        let mut row = vec![
            entry(one),
            one.statement.clone(),
            one.place.clone(),
            one.found.clone(),
            shown(one),
            role(one).into(),
            rests_on(one.price),
        ];
        if moved {
            row.push(one.robust.map_or_else(String::new, |(kept, run)| format!("{kept} of {run} runs")));
        }
        table.row(row);
    }
    table.finish()
}

/// `124 runs, 30120 events`; nothing where nothing was run.
pub(crate) fn rests_on(price: Price) -> String {
    let Price { runs, events, .. } = price;
    match price.rows {
        0 => String::new(),
        _ => format!("{}, {}", counted(runs as usize, "run", "runs"), counted(events as usize, "event", "events")),
    }
}

/// The numbers with their uncertainties.
fn numbers(judged: &[Judged]) -> String {
    let mut table = MarkdownTable::new(&[
        ("Number", Align::Left),
        ("Study, D", Align::Right),
        ("Here, S", Align::Right),
        ("E = S − D", Align::Right),
        ("u_num", Align::Right),
        ("u_input", Align::Right),
        ("u_D", Align::Right),
        ("u_val", Align::Right),
        ("|E|/u_val", Align::Right),
        ("Digits that agree", Align::Right),
    ]);
    for one in judged {
        let Some(comparison) = &one.comparison else { continue };
        table.row([
            entry(one),
            compact(comparison.published, 12),
            significant(comparison.simulated, 6),
            signed(comparison.error(), 2),
            significant(comparison.u_num, 2),
            significant(comparison.u_input, 2),
            significant(comparison.u_data, 2),
            significant(comparison.u_val(), 2),
            significant(comparison.deviation(), 2),
            digits(comparison),
        ]);
    }
    let table = table.finish();
    if table.is_empty() {
        return table;
    }
    format!(
        "How far each number is off, and how far it may be (all in the number’s own unit): u_num is what the run \
         itself may be off, u_input what the unstated inputs may shift, u_D half a unit of the last printed digit, and \
         u_val = √(u_num² + u_input² + u_D²).\n\n{table}"
    )
}

/// What comes out with each assumption moved: the other readings of the source. Nothing where none was moved.
fn other_readings(judged: &[Judged]) -> String {
    let description: Vec<&Judged> = judged.iter().filter(|one| !one.moved.is_empty()).collect();
    let mut variants: Vec<&str> = Vec::new();
    for one in description.iter().flat_map(|judged| &judged.moved) {
        if !variants.contains(&one.variant.as_str()) {
            variants.push(&one.variant);
        }
    }
    let names: Vec<String> = description.iter().map(|one| entry(one)).collect();
    let mut header = vec![("Assumption moved", Align::Left)];
    header.extend(names.iter().map(|name| (name.as_str(), Align::Right)));
    let mut table = MarkdownTable::new(&header);
    for variant in variants {
        let mut row = vec![format!("`{variant}`")];
        row.extend(description.iter().map(|one| {
            let moved = one.moved.iter().find(|moved| moved.variant == variant);
            moved.map_or_else(
                String::new,
                |Moved { found, kept, .. }| if *kept { found.clone() } else { format!("**{found}**") },
            )
        }));
        table.row(row);
    }
    let table = table.finish();
    if table.is_empty() {
        return table;
    }
    format!(
        "What the other values of the assumptions give, one moved at a time; bold where the verdict would be another:\n\n{table}"
    )
}

fn digits(comparison: &Comparison) -> String {
    let digits = comparison.digits();
    if digits == f64::INFINITY {
        "all".to_owned()
    } else if digits.is_finite() {
        format!("{:.1}", digits.max(0.0))
    } else {
        "n/a".to_owned()
    }
}

/// Tolerances set by hand; nothing if there are none.
fn by_hand(judged: &[Judged]) -> String {
    let mut text = String::new();
    for one in judged {
        if let Some(tolerance) = tolerance(one) {
            text += &format!("- {}: {tolerance}\n", entry(one));
        }
    }
    if text.is_empty() { text } else { format!("**Tolerances set by hand**, not derived from u_val:\n\n{text}\n") }
}

/// The tolerance that was set by hand, with its reason, and whether it is looser than the one that it replaces.
pub(super) fn tolerance(judged: &Judged) -> Option<String> {
    let widths: Vec<String> = judged.comparisons().filter_map(|(name, comparison)| width(name, comparison)).collect();
    if widths.is_empty() && judged.tolerance_reason.is_none() {
        return None;
    }
    let widths = if widths.is_empty() { String::new() } else { format!("{}. ", widths.join("; ")) };
    let reason = judged.tolerance_reason.as_deref().map_or_else(|| "No reason is given.".to_owned(), one_line);
    Some(widths + &reason)
}

fn width(name: &str, comparison: &Comparison) -> Option<String> {
    let width = comparison.tolerance_by_hand?;
    let derived = comparison.derived_tolerance();
    let beside = if width > derived { "**loosened** from" } else { "narrower than" };
    let name = if name.is_empty() { String::new() } else { format!("{name} ") };
    Some(format!("{name}±{}, {beside} the derived ±{}", compact(width, 6), significant(derived, 2)))
}

/// Why entries are not reproduced, and notes on those that are.
fn explanations(judged: &[Judged]) -> String {
    let description = |one: &&Judged| one.verdict != Verdict::Reproduced || !one.explanation.trim().is_empty();
    let mut text = String::new();
    for one in judged.iter().filter(description) {
        text += &format!("- {}: {}. {}\n", entry(one), shown(one), explanation(one));
    }
    if text.is_empty() { text } else { format!("### Notes on the verdicts\n\n{text}\n") }
}

/// The entry's explanation, or a plain word that there is none.
pub(super) fn explanation(judged: &Judged) -> String {
    let explanation = one_line(&judged.explanation);
    if !explanation.is_empty() {
        explanation
    } else if judged.verdict == Verdict::Missing {
        one_line(&judged.found)
    } else {
        "The entry gives no explanation.".to_owned()
    }
}

/// The entry's name without its experiment's.
fn entry(judged: &Judged) -> String {
    let name = judged.id.rsplit('/').next().unwrap_or(&judged.id);
    format!("`{name}`")
}
