//! Rows that belong together: one combination of the levels of some columns.

use crate::experiment::BasinColumn;
use crate::measure::Measure;
use crate::table::Column;
use crate::text::words;

use super::label;

/// Whether a column names what came out, as a kind of motion: no sweep sets it.
pub(super) fn is_outcome(column: &Column) -> bool {
    column.name == BasinColumn::Basin.name()
        || Measure::ALL.iter().any(|measure| measure.is_name() && *words::of_key(measure) == *column.name)
}

/// Rows that share their levels of the `by` columns.
pub(super) struct Group {
    /// One word per `by` column; `None` where the sweep leaves the column out.
    pub words: Vec<Option<String>>,
    pub rows: Vec<usize>,
}

impl Group {
    /// The rows split by these columns, in the order of the table.
    pub(super) fn split(rows: usize, by: &[&Column]) -> Vec<Self> {
        let mut groups: Vec<Self> = Vec::new();
        for row in 0..rows {
            let words: Vec<_> = by.iter().map(|column| label::of_cell(column, row)).collect();
            match groups.iter_mut().find(|group| group.words == words) {
                Some(group) => group.rows.push(row),
                None => groups.push(Self { words, rows: vec![row] }),
            }
        }
        // The exact motion comes first wherever the table has it, so that it looks the same in every figure.
        let exact = words::of_solver(words::EVENT_DRIVEN);
        groups.sort_by_key(|group| !group.words.iter().flatten().any(|word| *word == exact));
        groups
    }

    /// The words that tell this group from the others.
    pub(super) fn varying_words(&self, groups: &[Self]) -> Vec<String> {
        let varies = |index: &usize| groups.iter().any(|group| group.words[*index] != self.words[*index]);
        (0..self.words.len()).filter(varies).filter_map(|index| self.words[index].clone()).collect()
    }

    /// What came out, in words.
    pub(super) fn outcome(&self, by: &[&Column]) -> Vec<String> {
        let words = self.words.iter().zip(by).filter(|(_, column)| is_outcome(column));
        words.filter_map(|(word, _)| word.clone()).collect()
    }
}
