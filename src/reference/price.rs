//! What a verdict cost: the rows that it rests on, and what was simulated for them.

use serde::{Deserialize, Serialize};

use super::view::{RowsByTable, TableState, Tables};
use crate::text::name;

/// What was simulated for an entry; the same on every machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Price {
    /// Rows of tables, those with an assumption moved among them.
    pub rows: u64,
    /// Runs behind them: as many as the ensemble or the search of each has, one as a rule, none of what needs no run.
    pub runs: u64,
    /// Events of these rows.
    pub events: u64,
}

impl Price {
    /// Of the rows whose cells were looked at for more than to choose rows.
    pub(super) fn of(decisive: &RowsByTable, tables: &Tables<'_>) -> Self {
        let mut price = Self::default();
        for (id, rows) in decisive {
            let Some(TableState::Present(table)) = tables.get(id) else { continue };
            let [events, members, evaluations] =
                ["events", name::MEMBERS, "evaluations"].map(|name| table.floats(name).unwrap_or_default());
            for row in rows {
                let count = |column: &[f64]| column.get(*row).copied().filter(|count| *count >= 0.0);
                price.rows += 1;
                price.runs += match [&members, &evaluations].map(|column| count(column)) {
                    [Some(0.0), None] if !table.has_failed(*row) => 0,
                    counts => whole(counts.into_iter().flatten().fold(1.0, f64::max)),
                };
                price.events += whole(count(&events).unwrap_or(0.0));
            }
        }
        price
    }
}

/// Counts stand in tables as floats.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts of a table, zero or more")]
fn whole(count: f64) -> u64 {
    count as u64
}
