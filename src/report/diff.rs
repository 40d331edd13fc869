//! Two runs side by side: which numbers moved, and whether by more than they are uncertain.

use std::collections::BTreeSet;

use super::movement::{Moved, Movement};
use crate::reference::COVERAGE;
use crate::text::number::{quantity, signed, significant};
use crate::text::words::counted;

/// Told of each kind in each experiment; the rest is counted.
const TOLD: usize = 5;

/// How much is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// The farthest few of each experiment.
    Farthest,
    /// Everything.
    All,
}

/// For the console: what moved in each experiment (or file), then a line that says it all. `whole` names experiments whose tables cannot be
/// compared as they are, with what is the matter; `not_run` are entries of experiments without a table, which are no difference.
#[must_use]
pub fn diff(movements: &[(String, Movement)], whole: &[String], not_run: &[String], detail: Detail) -> String {
    let description = if detail == Detail::All { usize::MAX } else { TOLD };
    let mut text = String::new();
    for (name, movement) in movements.iter().filter(|(_, movement)| !movement.is_none()) {
        text += &format!("{name}\n");
        let (beyond, within): (Vec<&Moved>, Vec<&Moved>) = movement.moved.iter().partition(|moved| moved.is_beyond());
        text += &list("only in the first", &movement.gone, description, |name| name.clone());
        text += &list("only in the second", &movement.new, description, |name| name.clone());
        text += &list("judged differently", &movement.judged_differently, description, |(name, a, b)| {
            format!("{name}: {a} -> {b}")
        });
        text += &list("the same verdict, found otherwise", &movement.read_differently, description, |(name, a, b)| {
            format!("{name}: {a} -> {b}")
        });
        text += &list("beyond their uncertainty", &beyond, description, |moved| line(moved));
        text += &list("within their uncertainty", &within, description, |moved| line(moved));
    }
    text.extend(whole.iter().map(|line| format!("{line}\n")));
    let count = |what: fn(&Movement) -> usize| movements.iter().map(|(_, movement)| what(movement)).sum::<usize>();
    let beyond = count(|movement| movement.moved.iter().filter(|moved| moved.is_beyond()).count());
    let moved = count(|movement| movement.moved.len());
    let others = count(Movement::words);
    text += &format!(
        "{}: {} the same to the bit, {} moved within their uncertainty, {beyond} beyond it; {} otherwise{}.\n",
        counted(count(|movement| movement.same) + moved, "number", "numbers"),
        count(|movement| movement.same),
        moved - beyond,
        counted(others + whole.len(), "difference", "differences"),
        not_compared(not_run),
    );
    text
}

/// `; not compared: 379 entries without a table that they read`.
fn not_compared(not_run: &[String]) -> String {
    if not_run.is_empty() {
        return String::new();
    }
    let entries: BTreeSet<&String> = not_run.iter().collect();
    let whose = if entries.len() == 1 { "it reads" } else { "they read" };
    format!("; not compared: {} without a table that {whose}", counted(entries.len(), "entry", "entries"))
}

fn list<T>(heading: &str, all: &[T], description: usize, line: impl Fn(&T) -> String) -> String {
    if all.is_empty() {
        return String::new();
    }
    let mut text = format!("  {heading}: {}\n", all.len());
    text.extend(all.iter().take(description).map(|one| format!("    {}\n", line(one))));
    if all.len() > description {
        text += &format!("    and {} more\n", all.len() - description);
    }
    text
}

fn line(moved: &Moved) -> String {
    let Moved { name, unit, from, to, u } = moved;
    let number = |x: f64| if x.is_nan() { "nothing".into() } else { quantity(x, unit, 6) };
    let change = to - from;
    let by = if change.is_nan() {
        String::new()
    } else if *u > 0.0 {
        let (times, width) = (significant(moved.deviation() / COVERAGE, 2), significant(COVERAGE * u, 2));
        format!(", {}: {times} times its uncertainty of ± {width}", signed(change, 2))
    } else {
        format!(", {}; no uncertainty is known", signed(change, 2))
    };
    format!("{name}: {} -> {}{by}", number(*from), number(*to))
}
