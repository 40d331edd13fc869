//! Shards: a study's work in n parts for n tasks of a cluster's scheduler, each with tables of its own.
//!
//! The plan alone decides which rows belong to which shard, so tasks need no communication: the rows of an
//! experiment are dealt out, the longest first, rows that follow each other together. Where all rows depend on each other (refined
//! curves, searches, branches), or how many there are is not known before (random starts), the experiment is one shard's as a whole. A shard's table is that of the experiment with fewer rows and one column more, `row`, the
//! place of each in the whole table.

use std::fmt;
use std::fs;
use std::path::PathBuf;
use std::str::FromStr;

use super::finished::Finished;
use super::job::{Job, cost, jobs, units};
use super::layout::Layout;
use super::plan::Item;
use super::variant::Variant;
use crate::experiment::{Experiment, ExperimentId};
use crate::table::{Column, Data, ParquetError, Table, parquet};

/// The column with a row's place in the whole table.
pub(super) const ROW: &str = "row";
/// The key of the shard in a table's metadata.
const SHARD: &str = "shard";

/// One of n parts, written `1/8` to `8/8`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shard {
    /// From 0.
    index: u32,
    of: u32,
}

/// Why a table is not the one that its name says.
#[derive(Debug, thiserror::Error)]
pub enum NotThePart {
    /// It cannot be read.
    #[error("{}", damage(.0))]
    Unreadable(#[from] ParquetError),
    /// It lacks the column that says where its rows belong.
    #[error("its rows have no places")]
    NoPlaces,
    /// The plan has no such row.
    #[error("its row {0} is not a row of the experiment")]
    NoSuchRow(usize),
    /// It is another shard's.
    #[error("it is the table of shard {0}")]
    OfAnotherShard(String),
    /// It is a whole table.
    #[error("it is the table of no shard")]
    OfNoShard,
    /// It is out of date.
    #[error("it was computed from other inputs than the current ones")]
    OtherInputs,
    /// It was written by an older version.
    #[error("its rows do not say what they were computed from")]
    NoFingerprints,
}

/// The error without the name of the file, which stands in front of it.
fn damage(error: &ParquetError) -> String {
    match error {
        ParquetError::Damaged { what, .. } => what.clone(),
        other => other.to_string(),
    }
}

/// A text that names no shard.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a shard is written as 3/8, the third of eight; the first is 1/8")]
pub struct ShardError;

impl Shard {
    /// All `of` shards.
    pub fn all(of: u32) -> impl Iterator<Item = Self> {
        (0..of).map(move |index| Self { index, of })
    }

    /// How many there are of them.
    #[must_use]
    pub fn of(self) -> u32 {
        self.of
    }

    /// The folder of its tables within the study.
    #[must_use]
    pub fn folder(self) -> String {
        format!("results/shards/{}-of-{}", self.index + 1, self.of)
    }

    /// Its table of an experiment, within the study.
    #[must_use]
    pub fn table_name(self, id: &ExperimentId) -> String {
        format!("{}/{id}.parquet", self.folder())
    }

    /// The journal of an optimisation that it has under way, within the study.
    #[must_use]
    pub fn journal_name(self, id: &ExperimentId) -> String {
        format!("{}/{id}.journal", self.folder())
    }

    /// The numbers of shards that there are tables for: usually one.
    #[must_use]
    pub fn counts(layout: &Layout) -> Vec<u32> {
        let entries = fs::read_dir(layout.path("results/shards")).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut counts: Vec<u32> =
            names.filter_map(|name| name.replacen("-of-", "/", 1).parse::<Self>().ok()).map(Self::of).collect();
        counts.sort_unstable();
        counts.dedup();
        counts
    }

    /// True if it has something to compute for the experiment.
    #[must_use]
    pub fn has_part_of(self, item: &Item) -> bool {
        let experiment = &item.source.experiment;
        if divisible(experiment) {
            owners(self.of, experiment, &item.variants, &jobs(experiment, &item.variants)).contains(&self)
        } else {
            owner(self.of, experiment) == self
        }
    }

    /// True if its table of the experiment is there, whole, and is up to date.
    #[must_use]
    pub fn has_done(self, layout: &Layout, item: &Item) -> bool {
        let path = layout.path(&self.table_name(&item.source.experiment.id));
        parquet::read(&path).is_ok_and(|table| self.check(&table, item).is_ok() && !table.has_failures())
    }

    /// Writes its table of an experiment.
    ///
    /// # Errors
    /// [`ParquetError`] if it cannot be written.
    pub fn save(self, layout: &Layout, item: &Item, finished: &Finished) -> Result<(), ParquetError> {
        let id = &item.source.experiment.id;
        parquet::write(&finished.table, &layout.path(&self.table_name(id)))?;
        if finished.failures.rows == 0 {
            // As for a whole table: what it was kept for is done.
            let _ = fs::remove_file(layout.path(&self.journal_name(id)));
        }
        Ok(())
    }

    /// Marks its table as that of a shard.
    pub(super) fn mark(self, table: &mut Table, places: &[usize]) {
        let rows = places.iter().map(|&row| i64::try_from(row).unwrap_or(i64::MAX)).collect();
        table.columns.insert(0, Column::new(ROW, Data::Int(rows)));
        table.metadata.insert(SHARD.into(), self.to_string());
    }

    /// What makes a table not its table of the experiment.
    pub(super) fn check(self, table: &Table, item: &Item) -> Result<(), NotThePart> {
        match table.metadata.get(SHARD) {
            Some(shard) if *shard == self.to_string() => {}
            Some(shard) => return Err(NotThePart::OfAnotherShard(shard.clone())),
            None => return Err(NotThePart::OfNoShard),
        }
        if table.metadata.get("fingerprint") != Some(&item.fingerprint()) {
            return Err(NotThePart::OtherInputs);
        }
        if !item.source.experiment.is_whole() && table.fingerprints.len() < table.rows() {
            return Err(NotThePart::NoFingerprints);
        }
        Ok(())
    }

    /// The path of its table.
    pub(super) fn path(self, layout: &Layout, item: &Item) -> PathBuf {
        layout.path(&self.table_name(&item.source.experiment.id))
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index + 1, self.of)
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let (number, of) = text.split_once('/').ok_or(ShardError)?;
        let number: u32 = number.parse().map_err(|_| ShardError)?;
        let of: u32 = of.parse().map_err(|_| ShardError)?;
        if number == 0 || number > of {
            return Err(ShardError);
        }
        Ok(Self { index: number - 1, of })
    }
}

/// False if all rows of the experiment depend on each other.
pub(super) fn divisible(experiment: &Experiment) -> bool {
    !experiment.is_whole() && experiment.refined.is_empty()
}

/// The shard of an experiment that is not divided, and of the first row of another: small experiments do not all go to the
/// first shard.
pub(super) fn owner(of: u32, experiment: &Experiment) -> Shard {
    let hash = blake3::hash(experiment.id.0.as_bytes());
    let [a, b, c, d, ..] = *hash.as_bytes();
    Shard { index: u32::from_le_bytes([a, b, c, d]) % of.max(1), of }
}

/// The shard of each row. A row that shares another's numbers goes with it.
pub(super) fn owners(shards: u32, experiment: &Experiment, variants: &[Variant], jobs: &[Job]) -> Vec<Shard> {
    let of = |rows: &[usize]| rows.iter().map(|&row| cost(experiment, variants, &jobs[row])).sum::<f64>();
    let mut longest: Vec<(f64, Vec<usize>)> =
        units(experiment, jobs).into_iter().map(|rows| (of(&rows), rows)).collect();
    longest.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let first = owner(shards, experiment);
    let mut owners = vec![first; jobs.len()];
    let deal = (0..shards).cycle().skip(first.index as usize);
    for ((_, rows), index) in longest.into_iter().zip(deal) {
        rows.into_iter().for_each(|row| owners[row] = Shard { index, of: shards });
    }
    for (row, job) in jobs.iter().enumerate() {
        if let Some(same) = job.same_as {
            owners[row] = owners[same];
        }
    }
    owners
}

/// The rows of a shard, by their places in the whole table, and the jobs of these rows.
pub(super) fn part(
    shard: Shard,
    experiment: &Experiment,
    variants: &[Variant],
    jobs: &[Job],
) -> (Vec<usize>, Vec<Job>) {
    let owners = owners(shard.of, experiment, variants, jobs);
    let places: Vec<usize> = (0..jobs.len()).filter(|&row| owners[row] == shard).collect();
    let mut here = vec![None; jobs.len()];
    places.iter().enumerate().for_each(|(at, &row)| here[row] = Some(at));
    let jobs = places.iter().map(|&row| Job { same_as: jobs[row].same_as.and_then(|same| here[same]), ..jobs[row] });
    let jobs = jobs.collect();
    (places, jobs)
}
