//! Damage for the self-test: what can be done to the cells of a table that an entry read.

use crate::table::{Data, Table};

/// A change of numbers that keeps them finite. Its size is given apart: how far outside is for the claim to say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Damage {
    /// Upside down: what rose falls.
    Mirrored,
    /// All the same.
    Flattened,
    /// All moved.
    Moved,
    /// Every other one moved, the second first.
    Comb,
    /// Every other one moved, the first first.
    OtherComb,
    /// One moved.
    Spike(usize),
}

impl Damage {
    /// All there is to be tried on so many numbers, of which at most `spikes`, evenly spread, are moved one at a time.
    pub(super) fn all(numbers: usize, spikes: usize) -> Vec<Self> {
        let mut all = vec![Self::Moved, Self::Mirrored, Self::Flattened, Self::Comb, Self::OtherComb];
        let count = numbers.min(spikes);
        all.extend((0..count).map(|k| Self::Spike(if count < 2 { 0 } else { k * (numbers - 1) / (count - 1) })));
        all
    }

    /// True if its size matters.
    pub(super) fn has_size(self) -> bool {
        !matches!(self, Self::Mirrored | Self::Flattened)
    }

    /// Does it to the cells of a column in these rows; `by` moves up or, negative, down.
    pub(super) fn inflict(self, table: &mut Table, column: usize, rows: &[usize], by: f64) {
        let (low, high) = extremes(&numbers(table, column, rows));
        alter(table, column, rows, |x, i| match self {
            Self::Mirrored => low + high - x,
            Self::Flattened => low,
            Self::Moved => x + by,
            Self::Comb if i % 2 == 1 => x + by,
            Self::OtherComb if i % 2 == 0 => x + by,
            Self::Spike(at) if i == at => x + by,
            _ => x,
        });
    }
}

/// Smallest and largest.
pub(super) fn extremes(numbers: &[f64]) -> (f64, f64) {
    numbers.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)))
}

/// The numbers of a column in these rows; a time history gives its samples.
pub(super) fn numbers(table: &Table, column: usize, rows: &[usize]) -> Vec<f64> {
    let Some(column) = table.columns.get(column) else { return Vec::new() };
    let of_row = |row: usize| match &column.data {
        Data::FloatList(lists) => lists.get(row).cloned().unwrap_or_default(),
        data => data.number(row).into_iter().collect(),
    };
    rows.iter().flat_map(|&row| of_row(row)).collect()
}

/// Replaces numbers of a column, counted through the given rows and, in time histories, through their samples. Counts
/// become plain numbers, so that they can be anything.
pub(super) fn alter(table: &mut Table, column: usize, rows: &[usize], change: impl Fn(f64, usize) -> f64) {
    let Some(column) = table.columns.get_mut(column) else { return };
    if let Data::Int(counts) = &column.data {
        #[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
        let numbers = counts.iter().map(|&count| count as f64).collect();
        column.data = Data::Float(numbers);
    }
    let mut i = 0;
    let mut next = |x: &mut f64| {
        *x = change(*x, i);
        i += 1;
    };
    match &mut column.data {
        Data::Float(cells) => rows.iter().for_each(|&row| {
            if let Some(x) = cells.get_mut(row) {
                next(x);
            }
        }),
        Data::FloatList(lists) => rows.iter().for_each(|&row| {
            if let Some(list) = lists.get_mut(row) {
                list.iter_mut().for_each(&mut next);
            }
        }),
        Data::Int(_) | Data::Text(_) => {}
    }
}
