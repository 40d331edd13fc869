//! What the study says beside what came out.

use std::cmp::Reverse;

use crate::reference::{Comparison, Judged, MotionBehind, Moved, Price, PrintedUnit, Role, Verdict};
use crate::text::number::{compact, signed, significant};

use super::markdown::{Align, MarkdownTable, first_sentence, one_line};
use super::motions::by_count;
use super::tally::{Tally, agrees, role, shown};
use super::view::{anchor, name};
use crate::text::words::counted;

/// The entry that a page leads with: the worst, and of several the first.
pub(super) fn lead<'a>(judged: impl IntoIterator<Item = &'a Judged>) -> Option<&'a Judged> {
    // Of those that agree a fitted one proves nothing.
    let rank = |one: &&Judged| {
        let severity = if agrees(one.verdict) { 0 } else { one.verdict.severity() };
        (Reverse(severity), one.verdict == Verdict::Fitted)
    };
    judged.into_iter().min_by_key(rank)
}

/// What the page says, in a few lines.
pub(super) fn in_short(judged: &[Judged]) -> String {
    let Some(lead) = lead(judged) else {
        return "**In short.** Nothing to compare: the study makes no claim and quotes no number here.\n\n".to_owned();
    };
    let mut text = format!("**In short.** {}\n\n", conclusion(judged));
    text += &format!(
        "- The study says: {}\n- Here: {}\n",
        closed(&one_line(&lead.statement)),
        closed(&one_line(&lead.found))
    );
    let why = first_sentence(&explanation(lead));
    if !agrees(lead.verdict) && closed(&why) != closed(&one_line(&lead.found)) {
        text += &format!("- Why: {why}\n");
    }
    text + "\n"
}

/// `Stands in part: of 4 statements, 2 agree, 2 differ; of 3 used in fits 1 more agrees (fitted), which proves nothing.`
fn conclusion(judged: &[Judged]) -> String {
    let tally = Tally::of(judged);
    let (fitted, evidence) = (tally.count(Verdict::Fitted), tally.evidence());
    if evidence == 0 {
        return format!("{}: {}.", outcome(&tally), tally.describe());
    }
    let agreeing = counted(tally.count(Verdict::Reproduced), "agrees", "agree");
    let others = tally.without(Verdict::Fitted).without(Verdict::Reproduced);
    let others = if others.total() == 0 { String::new() } else { format!(", {}", others.describe()) };
    let agree = counted(fitted, "more agrees", "more agree");
    let fitted = match (tally.used_in_fits(), fitted) {
        (0, 0) => String::new(),
        (1, 0) => "; 1 of them was used in a fit".to_owned(),
        (used, 0) => format!("; {used} of them were used in fits"),
        (used, all) if used <= all => format!(
            "; {agree}, but {} used in fits (fitted), which proves nothing",
            if all == 1 { "was" } else { "were" }
        ),
        (used, _) => format!("; of {used} used in fits {agree} (fitted), which proves nothing"),
    };
    let statements = counted(evidence, "statement", "statements");
    format!("{}: of {statements}, {agreeing}{others}{fitted}.", outcome(&tally))
}

/// What became of these entries together, in a few words. What was fitted is no evidence.
pub(super) fn outcome(tally: &Tally) -> &'static str {
    let evidence = tally.evidence();
    match tally.count(Verdict::Reproduced) {
        _ if tally.total() == 0 || tally.has(Verdict::Missing) => "Not complete",
        _ if evidence == 0 => "Fitted, not tested",
        agree if agree == evidence => "Stands",
        0 if !tally.has(Verdict::Differs) => "Cannot be decided",
        // Of a few that are decided nothing follows for the many that are not.
        agree if 2 * (agree + tally.count(Verdict::Differs)) < evidence => "Mostly undecided",
        0 => "Does not stand",
        agree if agree < tally.count(Verdict::Differs) => "Mostly does not stand",
        _ => "Stands in part",
    }
}

fn closed(text: &str) -> String {
    if text.ends_with(['.', '!', '?']) { text.to_owned() } else { format!("{text}.") }
}

/// The table of a page: a row for each statement.
pub(super) fn statements(judged: &[Judged]) -> String {
    let mut table = MarkdownTable::new(&[
        ("The study says", Align::Left),
        ("Here", Align::Left),
        ("Verdict", Align::Left),
        ("Why", Align::Left),
    ]);
    for one in judged {
        let statement = format!("<a id=\"{}\"></a>{}", anchor(name(one)), one.statement);
        let why =
            if one.explanation.trim().is_empty() && agrees(one.verdict) { String::new() } else { explanation(one) };
        table.row([statement, here(one), verdict(one), why]);
    }
    table.finish()
}

/// What came out; where that decides nothing, with the motion that it is of.
fn here(one: &Judged) -> String {
    match one.motion.as_ref().map_or(&[][..], |motion| &motion.at) {
        at if one.verdict == Verdict::Undecidable && !at.is_empty() => {
            format!("{}; motion at {}", one.found, at.join("; at "))
        }
        _ => one.found.clone(),
    }
}

/// The motion behind a verdict: at the points that it speaks of, else of all rows that it reads.
fn motion(one: &Judged) -> String {
    let Some(MotionBehind { kinds, at }) = &one.motion else { return String::new() };
    if !at.is_empty() {
        return format!("at {}", at.join("; at "));
    }
    match by_count(kinds).as_slice() {
        [] => String::new(),
        [(kind, rows)] => {
            format!("{kind} in {}", if *rows == 1 { "its row".into() } else { format!("all {rows} rows") })
        }
        many => many
            .iter()
            .map(|(kind, rows)| format!("{kind} in {}", counted(*rows, "row", "rows")))
            .collect::<Vec<_>>()
            .join(", "),
    }
}

/// The verdict with all that a reader has to know to believe it.
fn verdict(one: &Judged) -> String {
    let mut text = shown(one);
    if one.role == Role::HeldOut {
        text += ", held out";
    }
    for (name, comparison, unit) in one.comparisons_with_units() {
        if let Some(width) = comparison.tolerance_by_hand {
            let name = if name.is_empty() { String::new() } else { format!(" of the {name}") };
            text += &format!("; tolerance{name} set by hand: {}", plus_minus(width, 3, unit));
        }
    }
    text
}

/// Uncertainties, other readings and what each verdict depends on.
pub(super) fn uncertainties(judged: &[Judged]) -> String {
    numbers(judged) + &other_readings(judged) + &by_hand(judged) + &entries(judged)
}

fn entries(judged: &[Judged]) -> String {
    let mut columns = vec![
        ("Entry", Align::Left),
        ("Where", Align::Left),
        ("Used in fits", Align::Left),
        ("Depends on", Align::Left),
        ("Verdict kept with one assumption moved", Align::Left),
    ];
    let named = judged.iter().any(|one| one.motion.is_some());
    columns.extend(named.then_some(("Motion", Align::Left)));
    let mut table = MarkdownTable::new(&columns);
    for one in judged {
        let kept = one
            .robust
            .map_or_else(String::new, |(kept, run)| format!("in {kept} of {}", counted(run as usize, "move", "moves")));
        let cells = [entry(one), one.place.clone(), role(one).into(), rests_on(one.price), kept];
        table.row(cells.into_iter().chain(named.then(|| motion(one))));
    }
    table.finish()
}

/// `124 runs, 30120 events`; nothing where there is no row.
pub(crate) fn rests_on(price: Price) -> String {
    let Price { runs, events, .. } = price;
    match price.rows {
        0 => String::new(),
        _ if runs == 0 => "no run".into(),
        _ => format!("{}, {}", counted(runs as usize, "run", "runs"), counted(events as usize, "event", "events")),
    }
}

/// The numbers with their uncertainties, each in the unit in which it is published.
fn numbers(judged: &[Judged]) -> String {
    // A column that is empty on most pages would say nothing there.
    let with_unit = judged.iter().any(|one| one.comparison.is_some() && !one.printed_unit.symbol.is_empty());
    let mut columns = vec![("Number", Align::Left)];
    columns.extend(with_unit.then_some(("Unit", Align::Left)));
    columns.extend([
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
    let mut table = MarkdownTable::new(&columns);
    for one in judged {
        let Some(comparison) = &one.comparison else { continue };
        let digits_shown = printed_digits(comparison).clamp(6, MOST_DIGITS);
        let PrintedUnit { symbol, worth } = &one.printed_unit;
        let in_unit = |x: f64| x / worth;
        let cells = [
            compact(in_unit(comparison.published), digits_shown),
            significant(in_unit(comparison.simulated), digits_shown),
            signed(in_unit(comparison.error()), 2),
            significant(in_unit(comparison.u_num), 2),
            significant(in_unit(comparison.u_input), 2),
            significant(in_unit(comparison.u_data), 2),
            significant(in_unit(comparison.u_val()), 2),
            significant(comparison.deviation(), 2),
            digits(comparison),
        ];
        let named = [entry(one)].into_iter().chain(with_unit.then(|| symbol.clone()));
        table.row(named.chain(cells));
    }
    table.finish()
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
    format!("With one assumption moved; bold where the verdict would change:\n\n{table}")
}

/// Digits of a number of double precision that may mean something.
const MOST_DIGITS: usize = 15;

/// How many significant digits were printed, by half a unit of the last of them.
fn printed_digits(comparison: &Comparison) -> usize {
    let unit = 2.0 * comparison.u_data;
    let digits = libm::floor(libm::log10(comparison.published.abs())) - libm::round(libm::log10(unit)) + 1.0;
    if digits.is_finite() && digits > 0.0 { digits as usize } else { 0 }
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
    if text.is_empty() { text } else { format!("Tolerances set by hand:\n\n{text}\n") }
}

/// The tolerance that was set by hand, with its reason, and whether it is looser than the one that it replaces.
pub(super) fn tolerance(judged: &Judged) -> Option<String> {
    let widths: Vec<String> =
        judged.comparisons_with_units().filter_map(|(name, comparison, unit)| width(name, comparison, unit)).collect();
    if widths.is_empty() && judged.tolerance_reason.is_none() {
        return None;
    }
    let widths = if widths.is_empty() { String::new() } else { format!("{}. ", widths.join("; ")) };
    let reason = judged.tolerance_reason.as_deref().map_or_else(|| "No reason is given.".to_owned(), one_line);
    Some(widths + &reason)
}

/// A width in a column's unit, in the one in which its number is published: `±7.1 mm/s`.
pub(super) fn plus_minus(width: f64, digits: usize, unit: &PrintedUnit) -> String {
    format!("±{} {}", compact(width / unit.worth, digits), unit.symbol).trim_end().to_owned()
}

fn width(name: &str, comparison: &Comparison, unit: &PrintedUnit) -> Option<String> {
    let width = comparison.tolerance_by_hand?;
    let derived = comparison.derived_tolerance();
    let beside = if width > derived { "**loosened** from" } else { "narrower than" };
    let name = if name.is_empty() { String::new() } else { format!("{name} ") };
    let derived = format!("±{} {}", significant(derived / unit.worth, 2), unit.symbol);
    Some(format!("{name}{}, {beside} the derived {}", plus_minus(width, 6, unit), derived.trim_end()))
}

/// The entry's explanation, or a plain word that there is none.
pub(super) fn explanation(judged: &Judged) -> String {
    let explanation = one_line(&judged.explanation);
    if !explanation.is_empty() {
        explanation
    } else if judged.verdict == Verdict::Missing {
        one_line(&judged.found)
    } else {
        "Not explained.".to_owned()
    }
}

fn entry(judged: &Judged) -> String {
    format!("`{}`", name(judged))
}
