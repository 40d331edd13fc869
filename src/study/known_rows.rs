//! Rows that need not be simulated, because an earlier table has them: only what a change touches is computed again, and
//! going back to an earlier value computes nothing.
//!
//! Their sources are the experiment's table on disk, if it is still the one in its record, and the tables that
//! it had before ([`super::earlier`]). A damaged table is ignored. Rows of an optimisation, or of
//! branches, depend on each other: such a table is used as a whole or not at all. Of random starts a case is known with all its rows.

use std::collections::{BTreeMap, BTreeSet};

use super::earlier;
use super::job::jobs;
use super::layout::{Layout, record_name, table_name};
use super::plan::Item;
use super::record::Record;
use super::row_fingerprint::RowFingerprints;
use super::tabulate::Row;
use super::untabulate::Cells;
use crate::experiment::{Experiment, RowSource};
use crate::table::{RowFingerprint, Table, parquet};
use crate::text::name;

/// What is known of an experiment's rows.
#[derive(Debug, Default)]
pub struct KnownRows {
    /// Of each table the rows that nothing before it has.
    tables: Vec<Table>,
    /// Table, and row in it.
    places: BTreeMap<RowFingerprint, (usize, usize)>,
    /// The table of the whole experiment.
    whole: Option<Table>,
    /// All rows of a case of which there are several, none of them failed.
    groups: BTreeMap<RowFingerprint, Table>,
}

impl KnownRows {
    /// Nothing: everything is simulated.
    #[must_use]
    pub fn nothing() -> Self {
        Self::default()
    }

    /// Reads what there is of an experiment.
    #[must_use]
    pub fn of(layout: &Layout, item: &Item) -> Self {
        let experiment = &item.source.experiment;
        let mut known = Self::nothing();
        let mut tables = on_disk(layout, item).into_iter().chain(earlier::tables(layout, &experiment.id)).peekable();
        if tables.peek().is_none() {
            return known;
        }
        if let RowSource::Basins(_) = experiment.row_source() {
            tables.for_each(|table| known.take_groups(&table));
            return known;
        }
        if experiment.is_whole() {
            known.whole = tables.into_iter().find(|table| is_of(item, table));
            return known;
        }
        // Which points a refined curve will get is not known before its rows are.
        let mut wanted = experiment.refined.is_empty().then(|| fingerprints(item));
        for table in tables {
            known.take(experiment, &table, wanted.as_mut());
            if wanted.as_ref().is_some_and(BTreeSet::is_empty) {
                break;
            }
        }
        known
    }

    /// Takes cases that are new.
    fn take_groups(&mut self, table: &Table) {
        let Some(failures) = table.texts(name::FAILURE) else { return };
        let mut groups: BTreeMap<RowFingerprint, Vec<usize>> = BTreeMap::new();
        for (row, fingerprint) in table.fingerprints.iter().enumerate() {
            // Variants that do not depend on what was moved repeat the case.
            let of_variant = table.texts(name::VARIANT).map(|variants| &variants[row]);
            let rows = groups.entry(*fingerprint).or_default();
            if rows
                .first()
                .is_none_or(|&first| table.texts(name::VARIANT).map(|variants| &variants[first]) == of_variant)
            {
                rows.push(row);
            }
        }
        for (fingerprint, rows) in groups {
            if rows.iter().all(|&row| failures[row].is_empty()) {
                self.groups.entry(fingerprint).or_insert_with(|| table.select(&rows));
            }
        }
    }

    /// Takes those rows that are wanted and new.
    fn take(&mut self, experiment: &Experiment, table: &Table, mut wanted: Option<&mut BTreeSet<RowFingerprint>>) {
        let Some(cells) = Cells::of(experiment, table) else { return };
        let mut rows = Vec::new();
        for (row, fingerprint) in table.fingerprints.iter().enumerate() {
            let is_wanted = match &mut wanted {
                Some(wanted) => wanted.contains(fingerprint),
                None => !self.places.contains_key(fingerprint),
            };
            if is_wanted && cells.row(row).is_some() {
                if let Some(wanted) = &mut wanted {
                    wanted.remove(fingerprint);
                }
                self.places.insert(*fingerprint, (self.tables.len(), rows.len()));
                rows.push(row);
            }
        }
        if !rows.is_empty() {
            self.tables.push(table.select(&rows));
        }
    }

    /// The row of this fingerprint.
    pub(super) fn row(&self, experiment: &Experiment, fingerprint: RowFingerprint) -> Option<Row> {
        let (table, row) = *self.places.get(&fingerprint)?;
        Cells::of(experiment, &self.tables[table])?.row(row)
    }

    /// True if there is a row of this fingerprint.
    pub(super) fn has(&self, fingerprint: RowFingerprint) -> bool {
        self.places.contains_key(&fingerprint)
    }

    /// All rows of the case of this fingerprint.
    pub(super) fn group(&self, fingerprint: RowFingerprint) -> Option<&Table> {
        self.groups.get(&fingerprint)
    }

    /// True if no row is known.
    pub(super) fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// True if some rows of the plan are known and others are not; which points a refined curve will get is not known before.
    pub(super) fn is_part_of(&self, item: &Item) -> bool {
        if self.is_empty() && self.groups.is_empty() {
            return false;
        }
        let wanted = fingerprints(item);
        let known = wanted.iter().filter(|one| self.has(**one) || self.groups.contains_key(one)).count();
        known > 0 && (known < wanted.len() || !item.source.experiment.refined.is_empty())
    }

    /// The whole table, of an experiment whose rows depend on each other.
    pub(super) fn whole(&self) -> Option<&Table> {
        self.whole.as_ref()
    }
}

/// The table that is in force on disk.
fn on_disk(layout: &Layout, item: &Item) -> Option<Table> {
    let id = &item.source.experiment.id;
    let path = layout.path(&table_name(id));
    let record = Record::read(&layout.path(&record_name(id)), id).ok()?;
    record.table.matches(&path).then(|| parquet::read(&path).ok()).flatten()
}

/// True if the table has the experiment's current fingerprint, and a number in every row.
fn is_of(item: &Item, table: &Table) -> bool {
    table.metadata.get("fingerprint") == Some(&item.fingerprint())
        && table.texts(name::FAILURE).is_some()
        && !table.has_failures()
}

fn fingerprints(item: &Item) -> BTreeSet<RowFingerprint> {
    let experiment = &item.source.experiment;
    RowFingerprints::new(experiment).all(&item.variants, &jobs(experiment, &item.variants)).into_iter().collect()
}
