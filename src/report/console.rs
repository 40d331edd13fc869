//! The summary that a run and `check` print: counts by verdict, and in full what is not as expected. No colour.

use comfy_table::{CellAlignment, LineStyle, Table, TableStyle};

use crate::reference::{Judged, Verdict};

use super::finding;
use super::markdown::one_line;
use super::tally::{Tally, VERDICTS};
use crate::text::words::counted;

/// Up to so many experiments are shown one by one; of more only those with a verdict that is not as expected.
const SHOWN: usize = 20;

/// Counts by experiment, what is known to differ, what is unexpected; ends with a line that says it all.
///
/// `experiments` are names with their entries, in the order to show.
#[must_use]
pub fn summary<N: AsRef<str>>(experiments: &[(N, &[Judged])]) -> String {
    let judged = || experiments.iter().flat_map(|(_, judged)| judged.iter());
    let mut text = format!("{}\n", table(experiments));
    let known: Vec<&Judged> = judged().filter(|one| one.as_expected() && one.verdict != Verdict::Reproduced).collect();
    if !known.is_empty() && experiments.len() > SHOWN {
        let entries = counted(known.len(), "entry", "entries");
        text += &format!("\nNot reproduced, as expected: {entries}, which `shotdamp check ID` lists.\n");
    } else if !known.is_empty() {
        text += "\nNot reproduced, as expected:\n";
        for one in known {
            text += &format!("  {:<11} {}: {}\n", one.verdict.word(), one.id, one_line(&one.found));
        }
    }
    let unexpected: Vec<&Judged> = judged().filter(|one| !one.as_expected()).collect();
    if !unexpected.is_empty() {
        text += "\nNot as expected:\n";
        for one in &unexpected {
            text += &in_full(one);
        }
    }
    let tally = Tally::of(judged());
    if tally.total() == 0 {
        return text;
    }
    text += &format!(
        "\n{}: {}; {}.\n",
        counted(tally.total(), "entry", "entries"),
        tally.describe(),
        match unexpected.len() {
            0 => "all as expected".to_owned(),
            some => format!("{some} not as expected"),
        }
    );
    text
}

fn table<N: AsRef<str>>(experiments: &[(N, &[Judged])]) -> Table {
    let mut table = Table::new();
    table.load_style(TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'))).force_no_tty();
    let heads = ["experiment".to_owned()].into_iter().chain(VERDICTS.map(|verdict| verdict.word().to_owned()));
    table.set_header(heads.collect::<Vec<_>>());
    let surprises = |judged: &[Judged]| judged.iter().any(|one| !one.as_expected());
    for (name, judged) in experiments.iter().filter(|(_, judged)| experiments.len() <= SHOWN || surprises(judged)) {
        table.add_row(row(name.as_ref(), &Tally::of(*judged)));
    }
    if experiments.len() > 1 {
        table.add_row(row("all", &Tally::of(experiments.iter().flat_map(|(_, judged)| judged.iter()))));
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

fn row(name: &str, tally: &Tally) -> Vec<String> {
    let counts = tally.each().map(|(_, count)| if count == 0 { "·".to_owned() } else { count.to_string() });
    [name.to_owned()].into_iter().chain(counts).collect()
}

fn in_full(one: &Judged) -> String {
    let mut text = format!("  {}: {}, expected {}\n", one.id, one.verdict.word(), one.expected.word());
    for (label, line) in finding::lines(one) {
        text += &format!("    {label:<10} {line}\n");
    }
    text
}
