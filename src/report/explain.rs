//! What an entry depends on: how far each assumption, moved alone, shifts what came out, and which move would change its verdict.

use crate::experiment::{AssumptionName, AssumptionValue, value_in_words};
use crate::reference::{Judged, Moved, NoTable, Printed, Role, Verdict, WhyNoTable};
use crate::text::number;

use super::markdown::one_line;
use super::tally::{agrees, shown};

/// An entry with what was tried.
#[derive(Debug)]
pub struct EntryView<'a> {
    /// The entry and its verdict.
    pub judged: &'a Judged,
    /// The published number, where it is one.
    pub printed: Option<&'a Printed>,
    /// The moves that were run.
    pub moves: Vec<MoveView<'a>>,
    /// Assumptions that its experiment depends on and that were not moved.
    pub unmoved: Vec<AssumptionName>,
    /// Assumptions that were chosen by it.
    pub chosen_by: Vec<AssumptionName>,
}

/// One assumption moved.
#[derive(Debug)]
pub struct MoveView<'a> {
    /// Which.
    pub name: &'a AssumptionName,
    /// Unit symbol of its numbers.
    pub unit: &'static str,
    /// The value in force.
    pub from: &'a AssumptionValue,
    /// The other one.
    pub to: &'a AssumptionValue,
    /// What came out then.
    pub moved: &'a Moved,
}

/// The explanation, for a console.
#[must_use]
pub fn explain(view: &EntryView<'_>) -> String {
    let judged = view.judged;
    let mut text = format!("{}: {}\n", judged.id, shown(judged).replace('*', ""));
    let lines = [
        ("the study", &judged.statement),
        ("where", &judged.place),
        ("found", &judged.found),
        ("note", &judged.explanation),
    ];
    for (label, line) in lines.into_iter().filter(|(_, line)| !line.is_empty()) {
        text += &format!("  {label:<10} {}\n", one_line(line));
    }
    if !view.chosen_by.is_empty() {
        let also = match judged.role {
            Role::CrossValidated => "; it comes out when it is left out of the fit",
            _ => "",
        };
        text += &format!("  {:<10} {} chosen by it{also}\n", "fitted", names(&view.chosen_by));
    }
    let has_experiment = !matches!(judged.no_table, Some(NoTable { why: WhyNoTable::NoExperiment, .. }));
    if view.moves.is_empty() {
        text += &match &judged.no_table {
            Some(_) if !has_experiment => String::new(),
            Some(NoTable { experiment, .. }) => format!("\nWhat moves it is known once `{experiment}` has been run.\n"),
            None => "\nNo assumption was moved for it.\n".into(),
        };
    } else {
        text += "\nOne assumption moved at a time, the most telling first\n";
        if let Some(printed) = view.printed.filter(|_| view.moves.iter().any(|one| shift(view, one).is_some())) {
            text += &format!(
                "(what came out; how far the move shifts it, and how far off it is, in % of the published {})\n",
                printed.text()
            );
        }
        text += &rows(view);
        text += &format!("\n{}", turns(view));
    }
    if !view.unmoved.is_empty() && has_experiment {
        text += &format!(
            "\nIts experiment also depends on these, which were not moved: {}.\n\
             `shotdamp explain --run {}` moves those that have other values.\n",
            names(&view.unmoved),
            judged.id
        );
    }
    text
}

fn names(names: &[AssumptionName]) -> String {
    names.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// How far a move shifts the number, relative to the published one.
fn shift(view: &EntryView<'_>, one: &MoveView<'_>) -> Option<f64> {
    let comparison = view.judged.comparison.as_ref()?;
    Some((one.moved.value? - comparison.simulated) / comparison.published.abs())
}

/// What came out, in the unit of the published number; a move that was simulated just now comes without it.
fn found(view: &EntryView<'_>, moved: &Moved) -> String {
    match (moved.value, view.judged.comparison.as_ref(), view.printed) {
        (Some(value), Some(comparison), Some(printed)) => comparison.in_words(value, printed),
        _ => moved.found.clone(),
    }
}

fn rows(view: &EntryView<'_>) -> String {
    let mut moves: Vec<&MoveView<'_>> = view.moves.iter().collect();
    // A claim has no size: those that turn it come first.
    let weight = |one: &MoveView<'_>| shift(view, one).map_or(f64::from(u8::from(!one.moved.kept)), f64::abs);
    moves.sort_by(|a, b| weight(b).total_cmp(&weight(a)));
    let mut rows: Vec<[String; 5]> = Vec::new();
    let mut reasons: Vec<Option<&str>> = Vec::new();
    for one in moves {
        let (from, to) = (value_in_words(one.unit, one.from), value_in_words(one.unit, one.to));
        let shifted =
            shift(view, one).map_or_else(String::new, |shift| format!("{} %", number::signed(100.0 * shift, 2)));
        let off =
            one.moved.value.zip(view.judged.comparison.as_ref()).map_or_else(String::new, |(value, comparison)| {
                let off = (value - comparison.published) / comparison.published.abs();
                format!("{} % off", number::signed(100.0 * off, 2))
            });
        // A reason is a sentence, and no column is as wide as one.
        let reason = (one.moved.verdict == Verdict::Missing).then_some(one.moved.found.as_str());
        reasons.push(reason);
        rows.push([
            format!("{}: {from} → {to}", one.name),
            if reason.is_some() { "no result".into() } else { found(view, one.moved) },
            shifted,
            off,
            one.moved.verdict.word().into(),
        ]);
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..5).map(width).collect();
    let mut text = String::new();
    for (row, reason) in rows.iter().zip(reasons) {
        let cell =
            |column: usize| format!("{}{}", row[column], " ".repeat(widths[column] - row[column].chars().count()));
        text += &format!("  {}\n", (0..5).map(cell).collect::<Vec<_>>().join("  ").trim_end());
        if let Some(reason) = reason {
            text += &format!("    {}\n", one_line(reason));
        }
    }
    text
}

/// Which single change would reproduce it.
fn turns(view: &EntryView<'_>) -> String {
    let now = view.judged.verdict;
    let description = |one: &MoveView<'_>| {
        format!("  {} = {}: {}\n", one.name, value_in_words(one.unit, one.to), one.moved.verdict.word())
    };
    if agrees(now) {
        let lost: String = view.moves.iter().filter(|one| !agrees(one.moved.verdict)).map(description).collect();
        return match lost.as_str() {
            "" => "It agrees whichever of them is moved.\n".into(),
            lost => format!("It no longer agrees with\n{lost}"),
        };
    }
    let mut text: String = view.moves.iter().filter(|one| agrees(one.moved.verdict)).map(description).collect();
    if text.is_empty() {
        text = "No single one of these changes reproduces it.\n".into();
    } else {
        text = format!("It would agree with\n{text}");
    }
    let meets: String = view.moves.iter().filter_map(|one| meeting(view, one)).collect();
    if !meets.is_empty() {
        text += &format!("On a straight line through the two runs the published number is met at about\n{meets}");
    }
    text
}

/// Where between its two values an assumption would give the published number.
fn meeting(view: &EntryView<'_>, one: &MoveView<'_>) -> Option<String> {
    let comparison = view.judged.comparison.as_ref()?;
    let (AssumptionValue::Number(from), AssumptionValue::Number(to)) = (one.from, one.to) else { return None };
    let share = -comparison.error() / (one.moved.value? - comparison.simulated);
    if !(0.0..=1.0).contains(&share) {
        return None;
    }
    let at = number::quantity(from + share * (to - from), one.unit, 3);
    Some(format!("  {} = {at}\n", one.name))
}
