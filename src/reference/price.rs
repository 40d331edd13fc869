//! What a verdict cost: the rows that it rests on, and what was simulated for them.

use serde::{Deserialize, Serialize};

use super::view::{RowsByTable, TableState, Tables};

/// What was simulated for an entry; the same on every machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Price {
    /// Rows of tables, those with an assumption moved among them.
    pub rows: u64,
    /// Runs behind them: one a row, or as many as its ensemble or its search has.
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
                ["events", "members", "evaluations"].map(|name| table.floats(name).unwrap_or_default());
            for row in rows {
                let count = |column: &[f64]| column.get(*row).copied().filter(|count| *count > 0.0).unwrap_or(0.0);
                price.rows += 1;
                price.runs += whole(count(&members).max(count(&evaluations)).max(1.0));
                price.events += whole(count(&events));
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
