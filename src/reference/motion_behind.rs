//! What moves how in the rows that decided an entry: a maximum belongs to one motion, a whole curve to many.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::text::{significant, symbol, with_unit};
use super::view::{Place, RowsByTable, TableState, Tables};
use crate::dynamics::MotionKind;
use crate::measure::Measure;
use crate::table::Table;
use crate::text::name;
use crate::text::words::of_key;

/// The motion behind a verdict.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MotionBehind {
    /// The rows that decided, by kind of motion, in its word; those with an assumption moved are not counted.
    pub kinds: BTreeMap<String, usize>,
    /// The motion at each point of a curve that a number or claim speaks of, such as its maximum:
    /// `f′ = 2.512: periodic 1:2, largest multiplier 0.72`.
    pub at: Vec<String>,
}

impl MotionBehind {
    /// Of the rows whose cells were looked at for more than to choose rows; `None` where it was not measured.
    pub(super) fn of(decisive: &RowsByTable, places: &[Place], tables: &Tables<'_>) -> Option<Self> {
        let mut behind = Self::default();
        for (id, rows) in decisive {
            let Some(TableState::Present(table)) = tables.get(id) else { continue };
            let Some(names) = table.texts(&of_key(&Measure::Motion)) else { continue };
            let in_force = rows.iter().filter(|row| table.is_baseline(**row));
            for kind in in_force.filter_map(|row| names.get(*row)?.parse::<MotionKind>().ok()) {
                *behind.kinds.entry(kind.word().to_owned()).or_default() += 1;
            }
            let places = places.iter().filter(|place| place.table == *id);
            behind.at.extend(places.filter_map(|place| at(place, table)));
        }
        (!behind.kinds.is_empty()).then_some(behind)
    }
}

/// The motions of the rows at a point of a curve, in words; `None` where it was not measured there.
fn at(place: &Place, table: &Table) -> Option<String> {
    let over = table.column(&place.over)?;
    let mut motions: Vec<String> = place.rows.iter().filter_map(|&row| in_words(table, row)).collect();
    motions.dedup();
    let x = with_unit(place.x, 4, &over.unit);
    (!motions.is_empty()).then(|| format!("{} = {x}: {}", symbol(&place.over), motions.join(" and ")))
}

/// `periodic 1:2, largest multiplier 0.72`.
fn in_words(table: &Table, row: usize) -> Option<String> {
    let kind: MotionKind = table.texts(&of_key(&Measure::Motion))?.get(row)?.parse().ok()?;
    let cell = |name: String| table.column(&name)?.data.number(row).filter(|x| x.is_finite());
    let exponent = of_key(&Measure::LyapunovExponent);
    let more = match kind {
        MotionKind::Periodic { .. } => cell(of_key(&Measure::LargestMultiplier))
            .map(|largest| format!(", largest multiplier {}", significant(largest, 2))),
        MotionKind::Chaotic => cell(exponent.clone()).zip(cell(name::numerical(&exponent))).map(|(value, error)| {
            format!(", Lyapunov exponent {} ± {} a cycle", significant(value, 2), significant(error, 1))
        }),
        _ => None,
    };
    Some(format!("{kind}{}", more.unwrap_or_default()))
}
