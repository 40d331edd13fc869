//! Rows whose numbers are to be doubted: balances that do not close, ratios of nothing to nothing, and numbers whose spread or
//! uncertainty is unknown.

use std::collections::BTreeSet;

use super::markdown::escaped;
use super::verdicts::Judgement;
use crate::table::{Table, UNDEFINED, UNKNOWN};
use crate::text::number::significant;
use crate::text::words::counted;

/// The part of an experiment's page; nothing where there is no cause.
pub(super) fn section(table: &Table) -> String {
    let mut text = String::new();
    let unbalanced: Vec<usize> = (0..table.rows()).filter(|&row| table.is_unbalanced(row)).collect();
    if !unbalanced.is_empty() {
        text += &format!(
            "**Balances that do not close**\n\n- {}: {}. Their numbers count for no entry.\n\n",
            counted(unbalanced.len(), "row", "rows"),
            worst(table, &unbalanced)
        );
    }
    text += &listed("Undefined numbers", table, UNDEFINED);
    text += &listed("Unknown", table, UNKNOWN);
    text
}

/// What a column of reasons says, each reason once with its rows; nothing without such a column.
fn listed(title: &str, table: &Table, column: &str) -> String {
    let mut reasons: Vec<(&str, usize)> = Vec::new();
    for reason in table.texts(column).unwrap_or_default().iter().filter(|reason| !reason.is_empty()) {
        match reasons.iter_mut().find(|(known, _)| known == reason) {
            Some((_, count)) => *count += 1,
            None => reasons.push((reason, 1)),
        }
    }
    if reasons.is_empty() {
        return String::new();
    }
    let mut text = format!("**{title}**\n\n");
    for (reason, count) in reasons {
        text += &format!("- {}: {}\n", counted(count, "row", "rows"), escaped(reason));
    }
    text + "\n"
}

/// `the largest residual is 9e7, where rounding leaves 1e-9 at most`.
fn worst(table: &Table, rows: &[usize]) -> String {
    let cell = |column: &str, row: usize| table.floats(column).and_then(|cells| cells.get(row).copied());
    let residual = |row: usize| {
        let parts = ["momentum_residual", "energy_residual"].map(|column| cell(column, row).unwrap_or(f64::NAN).abs());
        if parts[0].is_nan() || parts[1].is_nan() { f64::INFINITY } else { parts[0].max(parts[1]) }
    };
    let worst = rows.iter().copied().max_by(|a, b| residual(*a).total_cmp(&residual(*b)));
    worst.map_or_else(String::new, |row| {
        let bound = cell(crate::table::RESIDUAL_BOUND, row).unwrap_or(f64::NAN);
        let (found, bound) = (significant(residual(row), 2), significant(bound, 2));
        format!("the largest residual is {found}, where rounding leaves {bound} at most")
    })
}

/// A line for each of these experiments whose rows give cause; nothing as a rule.
#[must_use]
pub fn doubts(judgement: &Judgement, ids: &BTreeSet<&str>) -> String {
    let mut text = String::new();
    for (id, table) in judgement.tables.iter().filter(|(id, _)| ids.contains(id.as_str())) {
        let unbalanced: Vec<usize> = (0..table.rows()).filter(|&row| table.is_unbalanced(row)).collect();
        if !unbalanced.is_empty() {
            let rows = counted(unbalanced.len(), "row does", "rows do");
            text += &format!("{id}: {rows} not balance and count for no entry: {}\n", worst(table, &unbalanced));
        }
        for (column, what) in [(UNDEFINED, "undefined numbers"), (UNKNOWN, "something unknown")] {
            let cells = table.texts(column).unwrap_or_default();
            let mut reasons = cells.iter().filter(|reason| !reason.is_empty());
            if let Some(first) = reasons.next() {
                let rows = counted(1 + reasons.count(), "row has", "rows have");
                text += &format!("{id}: {rows} {what}; the first: {first}\n");
            }
        }
    }
    text
}
