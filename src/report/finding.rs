//! What a check found, as every output of it tells: which entries are not as expected, how far off, and how to see it again.

use std::cmp::Ordering;

use crate::reference::{Comparison, Fit, Judged, NoTable, PrintedUnit, Verdict, WhyNoTable};
use crate::text::number::{compact, signed, significant};

use super::comparison::plus_minus;
use super::markdown::one_line;

/// All that a check found.
#[derive(Debug, Clone, Default)]
pub struct CheckView<'a> {
    /// The entries, in the order to show.
    pub entries: Vec<CheckedEntry<'a>>,
    /// Why files could not be used.
    pub troubles: Vec<Trouble>,
}

/// An entry and where it is written.
#[derive(Debug, Clone)]
pub struct CheckedEntry<'a> {
    /// With its verdict.
    pub judged: &'a Judged,
    /// Its file, by the name within the study.
    pub file: &'a str,
    /// Its first line, counted from 1.
    pub line: u64,
}

/// A mistake for which a file could not be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Trouble {
    /// By its name within the study.
    pub file: String,
    /// The line of the mistake, if it has one.
    pub line: Option<u64>,
    /// The mistake, in words.
    pub message: String,
}

impl<'a> CheckView<'a> {
    /// The entries that are not as expected, the worst verdict first, then the distance in units of their uncertainty.
    pub(super) fn unexpected(&self) -> Vec<&CheckedEntry<'a>> {
        let mut found: Vec<_> = self.entries.iter().filter(|entry| !entry.judged.as_expected()).collect();
        found.sort_by(|a, b| worse_first(a.judged, b.judged));
        found
    }

    /// The entries that are as expected and yet not reproduced.
    pub(super) fn known(&self) -> Vec<&CheckedEntry<'a>> {
        let known =
            |entry: &&CheckedEntry<'a>| entry.judged.as_expected() && entry.judged.verdict != Verdict::Reproduced;
        self.entries.iter().filter(known).collect()
    }
}

fn worse_first(a: &Judged, b: &Judged) -> Ordering {
    b.verdict
        .severity()
        .cmp(&a.verdict.severity())
        .then(farthest(b).total_cmp(&farthest(a)))
        .then_with(|| a.id.cmp(&b.id))
}

/// The largest distance of any of its numbers, in units of its uncertainty; 0 where nothing is measured.
fn farthest(one: &Judged) -> f64 {
    one.comparisons().map(|(_, comparison)| comparison.deviation()).fold(0.0, f64::max)
}

/// What there is to say of an entry that is not as expected: labels and single lines.
pub(super) fn lines(one: &Judged) -> Vec<(&'static str, String)> {
    let mut lines =
        vec![("the study", one_line(&one.statement)), ("where", one_line(&one.place)), ("found", one_line(&one.found))];
    lines.extend(
        one.comparisons_with_units().map(|(name, comparison, unit)| ("off by", distance(name, comparison, unit))),
    );
    lines.extend(one.fit.iter().map(|fit| ("off by", departure(fit))));
    lines.push(("again", rerun(one)));
    lines.retain(|(_, line)| !line.is_empty());
    lines
}

/// The command that computes the entry's experiment anew, and nothing else; where another table is not there, that one's. Empty where
/// there is no experiment to be run.
pub(super) fn rerun(one: &Judged) -> String {
    match &one.no_table {
        Some(NoTable { why: WhyNoTable::NoExperiment, .. }) => String::new(),
        Some(NoTable { why: WhyNoTable::Stale | WhyNoTable::NotRun, experiment }) => {
            format!("shotdamp run {experiment}")
        }
        Some(NoTable { experiment, .. }) => format!("shotdamp run --force {experiment}"),
        // Forced, a run could only do again what it has done; a plain one tries a failed row again.
        None if one.verdict == Verdict::Missing => format!("shotdamp run {}", one.experiment),
        None => format!("shotdamp run --force {}", one.experiment),
    }
}

fn distance(name: &str, comparison: &Comparison, unit: &PrintedUnit) -> String {
    let name = if name.is_empty() { String::new() } else { format!("{name}: ") };
    let allowed = match comparison.tolerance_by_hand {
        Some(width) => format!("{} set by hand is allowed", plus_minus(width, 3, unit)),
        None => "2 u_val are allowed".to_owned(),
    };
    let symbol = if unit.symbol.is_empty() { String::new() } else { format!(" {}", unit.symbol) };
    let [u_val, u_num, u_input, u_data] = [comparison.u_val(), comparison.u_num, comparison.u_input, comparison.u_data]
        .map(|u| significant(u / unit.worth, 2));
    format!(
        "{name}E = {}{symbol}, that is {} u_val; {allowed}. u_val = {u_val}{symbol} (u_num {u_num}, u_input {u_input}, u_D {u_data})",
        signed(comparison.error() / unit.worth, 3),
        significant(comparison.deviation(), 2),
    )
}

fn departure(fit: &Fit) -> String {
    let beyond = fit.value - fit.limit;
    let units = if fit.u > 0.0 {
        format!(", {} times its uncertainty of {}", significant((beyond / fit.u).abs(), 2), significant(fit.u, 2))
    } else {
        String::new()
    };
    format!("{} where the limit is {}: {}{units}", significant(fit.value, 4), compact(fit.limit, 4), signed(beyond, 2))
}
