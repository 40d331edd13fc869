//! What branches of periodic motions did: where each begins and ends, and its special points.

use crate::experiment::{BranchColumn, Continuation, Stability};
use crate::measure::{Measure, column_words};
use crate::table::Table;
use crate::text::number::compact;
use crate::text::words::{self, capitalised};

use super::markdown::{Align, MarkdownTable};

/// Digits of a special point.
const DIGITS: usize = 8;

/// The section on an experiment's page.
pub(super) fn section(continuation: &Continuation, table: &Table) -> String {
    let table = table.baseline();
    let along = words::of_key(&continuation.along);
    let (Some(at), Some(branches)) = (table.floats(&along), table.floats(BranchColumn::Branch.name())) else {
        return String::new();
    };
    let words = |column: &str| table.texts(column).unwrap_or_default();
    let motions = words(&words::of_key(&Measure::Motion));
    let stability = words(BranchColumn::Stability.name());
    let special = words(BranchColumn::SpecialPoint.name());
    let ends = words(BranchColumn::BranchEnd.name());
    let name = capitalised(&column_words(&along));
    let mut markdown = MarkdownTable::new(&[
        ("Branch", Align::Right),
        ("Motion", Align::Left),
        (&name, Align::Left),
        ("Stable", Align::Right),
        ("Special points", Align::Left),
        ("Ends", Align::Left),
    ]);
    let mut from = 0;
    while from < branches.len() {
        let count = branches[from..].iter().take_while(|branch| **branch == branches[from]).count();
        let rows = from..from + count;
        from += count;
        let mut kinds: Vec<&str> = Vec::new();
        for row in rows.clone().filter(|row| !motions[*row].is_empty()) {
            if !kinds.contains(&motions[row].as_str()) {
                kinds.push(&motions[row]);
            }
        }
        let places = || rows.clone().map(|row| at[row]);
        let [least, most] = [places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max)];
        let stable = rows.clone().filter(|row| stability[*row] == Stability::Stable.word()).count();
        let points: Vec<String> = rows
            .clone()
            .filter(|row| !special[*row].is_empty())
            .map(|row| format!("{} at {}", special[row], compact(at[row], DIGITS)))
            .collect();
        let reasons: Vec<String> = rows
            .clone()
            .filter(|row| !ends[*row].is_empty())
            .map(|row| format!("at {}: {}", compact(at[row], DIGITS), ends[row]))
            .collect();
        markdown.row([
            compact(branches[rows.start], 6),
            kinds.join(", "),
            format!("{} to {}", compact(least, DIGITS), compact(most, DIGITS)),
            format!("{stable} of {count}"),
            points.join("; "),
            reasons.join("; "),
        ]);
    }
    format!(
        "## Branches\n\n{}Motions that come again, by Newton's method on the exact flow, stable or not, in the order along each branch.\n\n",
        markdown.finish()
    )
}
