//! What branches of periodic motions did: where each begins and ends, and its special points.

use crate::experiment::{BranchColumn, Continuation, Stability};
use crate::measure::{Measure, column_words};
use crate::reference::symbol;
use crate::table::Table;
use crate::text::number::compact;
use crate::text::words::{self, capitalised, counted};

use super::markdown::{Align, MarkdownTable};

/// Digits of a special point.
const DIGITS: usize = 8;

/// Stretches that the answer of a page names.
const MOST_NAMED: usize = 4;

/// Rows of a branch that follow each other with one motion, stable all along.
struct Stretch<'a> {
    motion: &'a str,
    from: f64,
    to: f64,
}

/// The answer of the page in a sentence: the longest stretches of the range in which a motion attracts; `None` without any.
pub(super) fn in_short(continuation: &Continuation, table: &Table) -> Option<String> {
    let table = table.baseline();
    let at = table.floats(&words::of_key(&continuation.along))?;
    let branches = table.floats(BranchColumn::Branch.name())?;
    let motions = table.texts(&words::of_key(&Measure::Motion))?;
    let stability = table.texts(BranchColumn::Stability.name())?;
    let rows: Vec<usize> = (0..table.rows()).collect();
    let alike = |a: &usize, b: &usize| {
        branches[*a] == branches[*b] && motions[*a] == motions[*b] && stability[*a] == stability[*b]
    };
    let stable = rows.chunk_by(alike).filter(|rows| stability[rows[0]] == Stability::Stable.word());
    let mut stretches: Vec<Stretch<'_>> = stable
        .map(|rows| {
            let (first, last) = (at[rows[0]], at[rows[rows.len() - 1]]);
            Stretch { motion: &motions[rows[0]], from: first.min(last), to: first.max(last) }
        })
        .collect();
    let length = |one: &Stretch<'_>| continuation.share(one.to) - continuation.share(one.from);
    stretches.sort_by(|a, b| length(b).total_cmp(&length(a)));
    let left = stretches.len().saturating_sub(MOST_NAMED);
    stretches.truncate(MOST_NAMED);
    stretches.sort_by(|a, b| a.from.total_cmp(&b.from));
    let name = |one: &Stretch<'_>| match [one.from, one.to].map(|end| compact(end, 4)) {
        [from, to] if from == to => format!("{} at {from}", one.motion),
        [from, to] => format!("{} from {from} to {to}", one.motion),
    };
    let named: Vec<String> = stretches.iter().map(name).collect();
    let shorter = if left == 0 {
        String::new()
    } else {
        format!(", and {}", counted(left, "shorter stretch", "shorter stretches"))
    };
    let symbol = symbol(&words::of_key(&continuation.along));
    (!named.is_empty())
        .then(|| format!("**In short.** Motions that attract along {symbol}: {}{shorter}.\n\n", named.join(", ")))
}

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
            if least == most {
                compact(least, DIGITS)
            } else {
                format!("{} to {}", compact(least, DIGITS), compact(most, DIGITS))
            },
            format!("{stable} of {count}"),
            points.join("; "),
            reasons.join("; "),
        ]);
    }
    format!(
        "## Branches\n\n{}Periodic motions, stable or not, by Newton's method on the exact flow, in the order along each branch.\n\n",
        markdown.finish()
    )
}
