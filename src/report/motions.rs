//! What moves how: on an experiment's page in a sentence, over the whole study on a page of its own.

use std::collections::BTreeMap;

use super::markdown::{Align, MarkdownTable, details, one_line};
use super::view::ExperimentView;
use crate::dynamics::MotionKind;
use crate::study::{Motions, Settling, StartShares};
use crate::text::number::{self, compact, significant};
use crate::text::words::counted;

/// The page's name below `reports/`.
pub(super) const PAGE: &str = "what-moves-how.md";

/// Experiments whose rows are listed under the page's table.
const MOST_LISTED: usize = 8;

/// Kinds of motion with their rows, the most frequent first.
pub(super) fn by_count(kinds: &BTreeMap<String, usize>) -> Vec<(&str, usize)> {
    let mut kinds: Vec<(&str, usize)> = kinds.iter().map(|(kind, count)| (kind.as_str(), *count)).collect();
    kinds.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    kinds
}

/// Kinds of motion, and what the averages are worth, in a few sentences; nothing of one row alone.
pub(super) fn in_words(motions: &Motions) -> Option<String> {
    if motions.rows() < 2 {
        return None;
    }
    let parts: Vec<String> = by_count(&motions.kinds)
        .iter()
        .map(|(kind, count)| format!("{count} {kind} ({})", share(*count, motions.rows())))
        .collect();
    let rows = counted(motions.rows(), "row", "rows");
    let mut text = format!("Of {rows}: {}.", parts.join(", "));
    let late = motions.late();
    if let (Some(last), true) = (motions.settled_after.last(), late > 0) {
        let again = motions.settled_after.len();
        let of = match (late, again) {
            (1, 1) => "The only one that repeats settles".into(),
            (1, _) => format!("One of the {again} that repeat settles"),
            (2, 2) => "Both rows that repeat settle".into(),
            _ if late == again => format!("All {again} that repeat settle"),
            _ => format!("{late} of the {again} that repeat settle"),
        };
        let after = if late == 1 { format!("after {last}") } else { format!("the last after {last}") };
        text += &format!(
            " {of} to a millionth only after the {} left out, {after}.",
            counted(motions.skip as usize, "cycle", "cycles"),
        );
    }
    if let Some(settling) = &motions.settling {
        text += &format!(" {}", of_settling(settling, motions.skip));
    }
    Some(text)
}

/// Rows whose averages are off, closed.
pub(super) fn unsettled(motions: &Motions) -> String {
    let of = |settling| details("Rows whose averages differ from the settled motion", &rows_off(settling));
    motions.settling.as_ref().map_or_else(String::new, of)
}

/// `reports/what-moves-how.md`.
#[must_use]
pub fn what_moves(experiments: &[ExperimentView<'_>]) -> String {
    let mut text = String::from("# Kinds of motion\n\n");
    let all: Vec<(&ExperimentView<'_>, &Motions)> =
        experiments.iter().filter_map(|view| Some((view, view.motions.as_ref()?))).collect();
    let best: Vec<_> = all.iter().filter(|(_, motions)| !motions.best.is_empty()).copied().collect();
    let starts: Vec<_> = all.iter().filter_map(|(view, motions)| Some((*view, motions.starts?))).collect();
    let all: Vec<_> = all.into_iter().filter(|(_, motions)| motions.rows() > 0).collect();
    let total: usize = all.iter().map(|(_, motions)| motions.rows()).sum();
    if total == 0 && starts.is_empty() {
        return text + "No experiment measures its motion.\n";
    }
    let count = |kind: &str| all.iter().filter_map(|(_, motions)| motions.kinds.get(kind)).sum::<usize>();
    let parts: Vec<String> = MotionKind::WORDS
        .iter()
        .filter(|kind| count(kind) > 0)
        .map(|kind| format!("{} {kind}", share(count(kind), total)))
        .collect();
    let of = counted(all.len(), "experiment", "experiments");
    if total > 0 {
        let total = number::count(total as u64);
        text += &format!("Of {total} rows in {of} that name their motion: {}.\n\n", parts.join(", "));
    }
    let settlings: Vec<&Settling> = all.iter().filter_map(|(_, motions)| motions.settling.as_ref()).collect();
    if !settlings.is_empty() {
        let [rows, off] = [settlings.iter().map(|it| it.rows).sum(), settlings.iter().map(|it| it.off).sum::<usize>()];
        let worst =
            settlings.iter().filter_map(|it| it.worst.first()).map(|one| one.relative().abs()).fold(0.0, f64::max);
        text += &format!(
            "**Are the cycles of a run enough?** In {} of the rows the motion had not settled, and the question is open. Of {} \
             whose settled motion was looked at, the velocity ratio is off from the settled one by more than {} in {off} ({}), \
             and by {} at most.\n\n",
            share(count(MotionKind::NotSettled.word()), total),
            counted(rows, "row", "rows"),
            percent(Settling::limit()),
            share(off, rows),
            percent(worst),
        );
    }
    if total > 0 {
        text += &table(&all);
    }
    text += &random_starts(&starts);
    text += &best_motions(&best);
    let mut listed: Vec<_> = all
        .iter()
        .filter_map(|(view, motions)| Some((view, motions.settling.as_ref().filter(|it| it.off > 0)?)))
        .collect();
    listed.sort_by_key(|(_, settling)| std::cmp::Reverse(settling.off));
    for (view, settling) in listed.into_iter().take(MOST_LISTED) {
        let title = one_line(&view.experiment.title);
        text += &details(&format!("{title}: rows that are not what they settle to"), &rows_off(settling));
    }
    if total > 0 {
        text += "The kinds of motion are proved by Floquet multipliers and Lyapunov exponents; the settled motion is the one that \
                 the run reaches within ten times its cycles, averaged over one period. ";
    }
    text + "[The study in one page](README.md)\n"
}

/// Experiments whose starts were drawn at random, by the motions that attract in each of their cases.
fn random_starts(all: &[(&ExperimentView<'_>, StartShares)]) -> String {
    if all.is_empty() {
        return String::new();
    }
    let mut table = MarkdownTable::new(&[
        ("Experiment", Align::Left),
        ("Cases", Align::Right),
        ("Random starts each", Align::Right),
        ("One motion attracts", Align::Right),
        ("Several attract", Align::Right),
        ("No start settled", Align::Right),
    ]);
    for (view, starts) in all {
        table.row(vec![
            format!("[{}]({})", one_line(&view.experiment.title), view.page),
            starts.cases().to_string(),
            starts.each.to_string(),
            starts.one.to_string(),
            starts.several.to_string(),
            starts.unsettled.to_string(),
        ]);
    }
    format!("**How many motions attract?** Each case from random starts, run until they settle.\n\n{}", table.finish())
}

/// Of each damper whose starts were drawn at random the best motion that attracts.
fn best_motions(all: &[(&ExperimentView<'_>, &Motions)]) -> String {
    let mut text = String::new();
    for (view, motions) in all {
        text += &format!(
            "**Which motion is best, and how likely is it?** [{}]({}): for each damper the motion of the largest velocity ratio among \
             those that attract, and the share of random starts that end in it. The grid of the sweep may miss a peak between two points, \
             so that the best ratio may be larger.\n\n",
            one_line(&view.experiment.title),
            view.page,
        );
        let mut table = MarkdownTable::new(&[
            ("Damper", Align::Left),
            ("At", Align::Left),
            ("Motion", Align::Left),
            ("ψ", Align::Right),
            ("Share of starts", Align::Right),
            ("95 %", Align::Right),
        ]);
        for one in &motions.best {
            let [low, high] = one.interval.map(percent);
            table.row(vec![
                one.damper.clone(),
                one.at.clone(),
                one.motion.clone(),
                significant(one.velocity_ratio, 4),
                percent(one.share),
                format!("{low} to {high}"),
            ]);
        }
        text += &table.finish();
    }
    text
}

fn table(all: &[(&ExperimentView<'_>, &Motions)]) -> String {
    let mut table = MarkdownTable::new(&[
        ("Experiment", Align::Left),
        ("Rows", Align::Right),
        ("Repeat", Align::Right),
        ("Of these, settled only after the cycles left out", Align::Right),
        ("Quasi-periodic", Align::Right),
        ("Chaotic", Align::Right),
        ("Not settled", Align::Right),
        ("Off from settled", Align::Right),
        ("Most", Align::Right),
    ]);
    for (view, motions) in all {
        let of = |kind: &str| motions.kinds.get(kind).copied().unwrap_or(0);
        let others =
            [MotionKind::QuasiPeriodic, MotionKind::Chaotic, MotionKind::NotSettled].map(|kind| of(kind.word()));
        let again = motions.rows() - others.iter().sum::<usize>();
        let [quasi_periodic, chaotic, not_settled] = others.map(|count| share(count, motions.rows()));
        let settling = motions.settling.as_ref();
        let worst = settling.and_then(|it| it.worst.first()).map(|one| percent(one.relative()));
        table.row(vec![
            format!("[{}]({})", one_line(&view.experiment.title), view.page),
            motions.rows().to_string(),
            share(again, motions.rows()),
            if motions.settled_after.is_empty() { String::new() } else { share(motions.late(), again) },
            quasi_periodic,
            chaotic,
            not_settled,
            settling.map_or_else(String::new, |it| format!("{} of {}", it.off, it.rows)),
            worst.unwrap_or_default(),
        ]);
    }
    table.finish() + "\n"
}

/// What the averages of 25 + 100 cycles are worth, in a sentence.
fn of_settling(settling: &Settling, skip: u32) -> String {
    let cycles = format!("cycles {} to {}", skip + 1, skip + settling.average);
    let median = significant(settling.median, 1);
    match settling.worst.first() {
        None => format!(
            "In all {} that settle within ten times the cycles, the velocity ratio of {cycles} is that of the settled motion to {} (median {median}).",
            settling.rows,
            percent(Settling::limit()),
        ),
        Some(worst) => format!(
            "Of the {} that settle within ten times the cycles, the velocity ratio of {cycles} is off by more than {} in {}: by {} at {} (median of all {median}).",
            counted(settling.rows, "row", "rows"),
            percent(Settling::limit()),
            settling.off,
            percent(worst.relative()),
            worst.row,
        ),
    }
}

fn rows_off(settling: &Settling) -> String {
    if settling.worst.is_empty() {
        return String::new();
    }
    let mut table = MarkdownTable::new(&[
        ("Row", Align::Left),
        ("ψ of the cycles given", Align::Right),
        ("ψ settled", Align::Right),
        ("Off by", Align::Right),
    ]);
    for one in &settling.worst {
        let [here, settled] = [one.velocity_ratio, one.settled].map(|ratio| significant(ratio, 4));
        table.row(vec![one.row.clone(), here, settled, percent(one.relative())]);
    }
    let rest = settling.off - settling.worst.len();
    let more = if rest == 0 { String::new() } else { format!("\nand {rest} more, off by less.\n") };
    table.finish() + &more + "\n"
}

fn share(count: usize, of: usize) -> String {
    if of == 0 { String::new() } else { format!("{:.0} %", 100.0 * count as f64 / of as f64) }
}

fn percent(relative: f64) -> String {
    format!("{} %", compact(100.0 * relative, 2))
}
