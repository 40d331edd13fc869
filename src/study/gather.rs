//! Gathering: the tables of all shards of an experiment joined into the one that a single run would have written.
//!
//! Nothing is taken on trust: each table has to be whole (its seal), of its shard and of today's inputs, and every row of
//! the plan has to come exactly once. Then the join is a matter of order, and the bytes are those of a single run.

use super::failures::Failures;
use super::finished::Finished;
use super::job::jobs;
use super::layout::Layout;
use super::plan::Item;
use super::shard::{NotThePart, ROW, Shard, divisible, owner, owners};
use crate::experiment::ExperimentId;
use crate::table::{Column, Data, Table, parquet};
use crate::text::name;
use crate::text::words::counted;

/// Why the tables of the shards do not make a whole.
#[derive(Debug, thiserror::Error)]
pub enum GatherError {
    /// Rows that no shard has.
    #[error("{id}: {} missing; first do {}", counted(*.rows, "row is", "rows are"), commands(.shards))]
    Missing {
        /// Of which experiment.
        id: ExperimentId,
        /// How many.
        rows: usize,
        /// Whose they are.
        shards: Vec<Shard>,
    },
    /// A row that two shards have.
    #[error(
        "{id}: row {row} comes from shard {first} and again from {second}; remove the tables of both and run both again"
    )]
    Twice {
        /// Of which experiment.
        id: ExperimentId,
        /// Its place in the whole table.
        row: usize,
        /// The shard that had it first.
        first: Shard,
        /// The other.
        second: Shard,
    },
    /// A table that is not what its name says.
    #[error("{name}: {what}; `shotdamp run --shard {shard}` makes it again")]
    NotThePart {
        /// Its name within the study.
        name: String,
        /// What is wrong with it.
        what: NotThePart,
        /// Whose it should be.
        shard: Shard,
    },
}

fn commands(shards: &[Shard]) -> String {
    const LISTED: usize = 4;
    let description: Vec<String> =
        shards.iter().take(LISTED).map(|shard| format!("`shotdamp run --shard {shard}`")).collect();
    match shards.len().saturating_sub(LISTED) {
        0 => description.join(", "),
        more => format!("{} and {more} more", description.join(", ")),
    }
}

/// The whole table of an experiment, from the tables of `of` shards.
///
/// # Errors
/// [`GatherError`] that names the table or the shard at fault, and the command that mends it.
pub fn gather(layout: &Layout, item: &Item, of: u32) -> Result<Finished, GatherError> {
    let experiment = &item.source.experiment;
    let id = &experiment.id;
    let mut parts: Vec<(Shard, Table, Vec<usize>)> = Vec::new();
    for shard in Shard::all(of) {
        let path = shard.path(layout, item);
        if path.exists() {
            let wrong = |what| GatherError::NotThePart { name: shard.table_name(id), what, shard };
            let mut table = parquet::read(&path).map_err(|error| wrong(error.into()))?;
            shard.check(&table, item).map_err(wrong)?;
            let places = take_places(&mut table).ok_or_else(|| wrong(NotThePart::NoPlaces))?;
            parts.push((shard, table, places));
        }
    }
    let owners = if divisible(experiment) {
        owners(of, experiment, &item.variants, &jobs(experiment, &item.variants))
    } else {
        // How many rows it has is known once they are there; there is at least one.
        let rows = parts.iter().flat_map(|(_, _, places)| places).max().map_or(1, |last| last + 1);
        vec![owner(of, experiment); rows]
    };
    let mut found: Vec<Option<(usize, usize)>> = vec![None; owners.len()];
    for (part, (shard, _, places)) in parts.iter().enumerate() {
        for (at, &row) in places.iter().enumerate() {
            let what = NotThePart::NoSuchRow(row);
            let wrong = || GatherError::NotThePart { name: shard.table_name(id), what, shard: *shard };
            match found.get_mut(row).ok_or_else(wrong)? {
                Some((first, _)) => {
                    return Err(GatherError::Twice { id: id.clone(), row, first: parts[*first].0, second: *shard });
                }
                empty => *empty = Some((part, at)),
            }
        }
    }
    let rows: Vec<(usize, usize)> = found.iter().copied().flatten().collect();
    if rows.len() < owners.len() {
        let mut shards: Vec<Shard> =
            owners.iter().zip(&found).filter(|(_, found)| found.is_none()).map(|(owner, _)| *owner).collect();
        shards.sort_unstable();
        shards.dedup();
        return Err(GatherError::Missing { id: id.clone(), rows: owners.len() - rows.len(), shards });
    }
    let tables: Vec<Table> = parts.into_iter().map(|(_, table, _)| table).collect();
    let table = Table { metadata: item.provenance(), ..join(&tables, &rows) };
    let reasons = table.texts(name::FAILURE).unwrap_or_default().iter();
    let failures = Failures::of(reasons.filter(|reason| !reason.is_empty()));
    Ok(Finished { table, failures, ..Finished::default() })
}

fn take_places(table: &mut Table) -> Option<Vec<usize>> {
    let Some(Column { name, data: Data::Int(places), .. }) = table.columns.first() else { return None };
    let places = places.iter().map(|&place| usize::try_from(place).ok()).collect::<Option<Vec<_>>>()?;
    if name != ROW {
        return None;
    }
    table.columns.remove(0);
    Some(places)
}

/// The rows, each given by its table and its place in it, as one table.
fn join(tables: &[Table], rows: &[(usize, usize)]) -> Table {
    let mut table = Table::default();
    let Some(first) = tables.first() else { return table };
    if tables.len() == 1 {
        return first.select(&rows.iter().map(|&(_, at)| at).collect::<Vec<_>>());
    }
    for column in first.columns.iter().filter(|column| !is_list(column)) {
        table.columns.push(joined(column, tables, rows));
    }
    // Columns of what is to be doubted are there only where some row gives cause; each stands behind the same one in every table.
    for other in &tables[1..] {
        let mut place = 0;
        for column in other.columns.iter().filter(|column| !is_list(column)) {
            match table.columns.iter().position(|known| known.name == column.name) {
                Some(known) => place = known + 1,
                None => {
                    table.columns.insert(place, joined(column, tables, rows));
                    place += 1;
                }
            }
        }
    }
    let fingerprint = |&(of, at): &(usize, usize)| tables[of].fingerprints.get(at).copied();
    table.fingerprints = rows.iter().filter_map(fingerprint).collect();
    // A table lists only the time histories that its rows have; the first row that has one fixes its place.
    for &(of, at) in rows {
        for column in tables[of].columns.iter().filter(|column| has_samples(column, at)) {
            if table.column(&column.name).is_none() {
                table.columns.push(joined(column, tables, rows));
            }
        }
    }
    table
}

fn is_list(column: &Column) -> bool {
    matches!(column.data, Data::FloatList(_))
}

fn has_samples(column: &Column, row: usize) -> bool {
    matches!(&column.data, Data::FloatList(cells) if cells.get(row).is_some_and(|cell| !cell.is_empty()))
}

/// The column of that name from all tables.
fn joined(column: &Column, tables: &[Table], rows: &[(usize, usize)]) -> Column {
    let sources: Vec<Option<&Data>> =
        tables.iter().map(|table| table.column(&column.name).map(|column| &column.data)).collect();
    macro_rules! cells {
        ($kind:path, $absent:expr) => {{
            let cell = |&(table, row): &(usize, usize)| match sources[table] {
                Some($kind(cells)) => cells.get(row).cloned().unwrap_or($absent),
                _ => $absent,
            };
            $kind(rows.iter().map(cell).collect())
        }};
    }
    let data = match &column.data {
        Data::Float(_) => cells!(Data::Float, f64::NAN),
        Data::Int(_) => cells!(Data::Int, 0),
        Data::Text(_) => cells!(Data::Text, String::new()),
        Data::FloatList(_) => cells!(Data::FloatList, Vec::new()),
    };
    Column { data, ..column.clone() }
}
