//! Tables as Parquet files. The only file that names polars.
//!
//! A file carries keys of its own in its metadata: `shotdamp`, JSON with the units, the symbols and the provenance,
//! and `shotdamp_seal`, the hash of all the other bytes of the file. A reader checks the seal before it decodes a byte, so
//! a cut, flipped or foreign file is an error and never a wrong number.
//!
//! A third, `shotdamp_rows`, holds the fingerprint of each row.
//!
//! For others who open the file, each field's own metadata repeats unit and symbol, and `PANDAS_ATTRS` holds units, symbols
//! and provenance as pandas takes them for the attributes of a data frame.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::Path;

use base64::Engine;
use polars::prelude as pl;
use polars::prelude::{ListBuilderTrait, SerReader};
use polars_arrow::io::ipc::write::{default_ipc_fields, schema_to_bytes};
use serde::{Deserialize, Serialize};

use super::{Column, Data, Table, TableError, fingerprint};
use crate::atomic::{self, FileError, from_here};
use crate::text::json;

/// Raised when the content of the `shotdamp` key is to be read differently.
const FORMAT: u32 = 1;
const ABOUT_KEY: &str = "shotdamp";
const SCHEMA_KEY: &str = "ARROW:schema";
const ROWS_KEY: &str = "shotdamp_rows";
const PANDAS_KEY: &str = "PANDAS_ATTRS";
const SEAL_KEY: &str = "shotdamp_seal";
/// Stands before the hash, so that it can be found without decoding the file.
const SEAL_MARK: &[u8] = b"blake3-of-the-rest:";
const SEAL_DIGITS: usize = 64;

/// A table file that could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum ParquetError {
    /// The table itself is malformed.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The file could not be opened, read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// Not a table of this program, or only a part of one.
    #[error("{path} is not a whole table of shotdamp: {what}; `shotdamp run --force` makes it again")]
    Damaged {
        /// Which file.
        path: String,
        /// What is wrong with it.
        what: String,
    },
}

/// What the `shotdamp` key holds.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct About {
    format: u32,
    columns: Vec<Label>,
    provenance: BTreeMap<String, String>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Label {
    name: String,
    unit: String,
    symbol: String,
}

/// What the `PANDAS_ATTRS` key holds.
#[derive(Serialize)]
struct Attributes<'a> {
    #[serde(flatten)]
    provenance: &'a BTreeMap<String, String>,
    units: BTreeMap<&'a str, &'a str>,
    symbols: BTreeMap<&'a str, &'a str>,
}

impl<'a> Attributes<'a> {
    fn of(table: &'a Table) -> Self {
        let of_columns = |text: fn(&Column) -> &str| {
            let pairs = table.columns.iter().map(|column| (column.name.as_str(), text(column)));
            pairs.filter(|(_, text)| !text.is_empty()).collect()
        };
        Self { provenance: &table.metadata, units: of_columns(|c| &c.unit), symbols: of_columns(|c| &c.symbol) }
    }
}

/// The Arrow schema, as readers built on Arrow look for it in the file's metadata: with unit and symbol in the metadata of
/// each field. Such readers take the keys of the file from here too, and overlook those that stand beside it.
fn arrow_schema(frame: &pl::DataFrame, table: &Table, keys: &[(String, String)]) -> String {
    // The oldest types for text and lists: every reader supports them.
    let plain = pl::SchemaExt::to_arrow(&**frame.schema(), pl::CompatLevel::oldest());
    let fields = plain.iter_values().zip(&table.columns).map(|(field, column)| {
        let description = [("unit", &column.unit), ("symbol", &column.symbol)];
        let description = description.into_iter().filter(|(_, text)| !text.is_empty());
        let metadata = description.map(|(key, text)| (key.into(), text.as_str().into())).collect();
        (field.name.clone(), field.clone().with_metadata(metadata))
    });
    let schema: pl::ArrowSchema = fields.collect();
    let keys = keys.iter().map(|(key, text)| (key.as_str().into(), text.as_str().into())).collect();
    let message = schema_to_bytes(&schema, &default_ipc_fields(schema.iter_values()), Some(&keys));
    // A message of Arrow's stream format: a mark, the length, the bytes.
    let length = u32::try_from(message.len()).unwrap_or(u32::MAX).to_le_bytes();
    base64::engine::general_purpose::STANDARD.encode([&[0xff; 4][..], &length, &message].concat())
}

/// The bytes of the file that holds `table`; the same table gives the same bytes.
///
/// # Errors
/// [`TableError`] if the columns do not make a table.
pub fn to_bytes(table: &Table) -> Result<Vec<u8>, ParquetError> {
    table.check()?;
    let refuse = |what: String| ParquetError::Damaged { path: "the table in memory".into(), what };
    let about = About {
        format: FORMAT,
        columns: table
            .columns
            .iter()
            .map(|c| Label { name: c.name.clone(), unit: c.unit.clone(), symbol: c.symbol.clone() })
            .collect(),
        provenance: table.metadata.clone(),
    };
    let (about, attributes) = (json::line(&about), json::line(&Attributes::of(table)));
    let open_seal = format!("{}{}", String::from_utf8_lossy(SEAL_MARK), "0".repeat(SEAL_DIGITS));
    let columns = table.columns.iter().map(|column| to_series(column).into()).collect();
    let mut frame = pl::DataFrame::new(table.rows(), columns).map_err(|error| refuse(error.to_string()))?;
    let mut keys = vec![(ABOUT_KEY.to_owned(), about), (PANDAS_KEY.to_owned(), attributes)];
    keys.insert(0, (SCHEMA_KEY.to_owned(), arrow_schema(&frame, table, &keys)));
    if !table.fingerprints.is_empty() {
        keys.push((ROWS_KEY.to_owned(), fingerprint::to_text(&table.fingerprints)));
    }
    keys.push((SEAL_KEY.to_owned(), open_seal));
    let metadata = pl::KeyValueMetadata::from_static(keys);
    let mut bytes = Vec::new();
    pl::ParquetWriter::new(&mut bytes)
        .set_parallel(false)
        .with_key_value_metadata(Some(metadata))
        .finish(&mut frame)
        .map_err(|error| refuse(error.to_string()))?;
    let hash = hash_around_seal(&mut bytes).ok_or_else(|| refuse("no room for the seal".into()))?;
    let at = find_seal(&bytes).ok_or_else(|| refuse("no room for the seal".into()))?;
    bytes[at..at + SEAL_DIGITS].copy_from_slice(hash.to_hex().as_bytes());
    Ok(bytes)
}

/// The table that `bytes` hold; `name` is how errors call the file.
///
/// # Errors
/// [`ParquetError::Damaged`] for anything but the whole bytes of [`to_bytes`].
pub fn from_bytes(mut bytes: Vec<u8>, name: &str) -> Result<Table, ParquetError> {
    let damaged = |what: &str| ParquetError::Damaged { path: name.into(), what: what.into() };
    let at = find_seal(&bytes).ok_or_else(|| damaged("it carries no seal"))?;
    let sealed = bytes[at..at + SEAL_DIGITS].to_vec();
    let hash = hash_around_seal(&mut bytes).ok_or_else(|| damaged("it carries no seal"))?;
    if hash.to_hex().as_bytes() != sealed {
        return Err(damaged("its bytes are not those that were written"));
    }
    let wrong = |error: pl::PolarsError| damaged(&error.to_string());
    let mut reader = pl::ParquetReader::new(Cursor::new(bytes)).read_parallel(pl::ParallelStrategy::None);
    let keys = reader.get_metadata().map_err(wrong)?.key_value_metadata().clone().unwrap_or_default();
    let value = |key: &str| keys.iter().find(|pair| pair.key == key).and_then(|pair| pair.value.as_deref());
    let about = value(ABOUT_KEY).ok_or_else(|| damaged("it does not say what its columns are"))?;
    let fingerprints = fingerprint::from_text(value(ROWS_KEY).unwrap_or_default())
        .ok_or_else(|| damaged("it does not say what its rows were computed from"))?;
    let about: About = serde_json::from_str(about).map_err(|error| damaged(&error.to_string()))?;
    if about.format != FORMAT {
        return Err(damaged(&format!("it has format {}, and this program reads format {FORMAT}", about.format)));
    }
    let frame = reader.set_rechunk(true).finish().map_err(wrong)?;
    if frame.width() != about.columns.len() {
        return Err(damaged("its columns are not those that its metadata list"));
    }
    let columns = about
        .columns
        .into_iter()
        .zip(frame.columns())
        .map(|(label, column)| {
            let data = to_data(column.as_materialized_series()).map_err(wrong)?;
            Ok(Column { name: label.name, unit: label.unit, symbol: label.symbol, data })
        })
        .collect::<Result<_, ParquetError>>()?;
    let table = Table { columns, metadata: about.provenance, fingerprints };
    table.check()?;
    Ok(table)
}

/// Writes the table, whole or not at all, and returns the bytes that it wrote.
///
/// # Errors
/// [`ParquetError`] if the columns do not make a table or the file cannot be written.
pub fn write(table: &Table, path: &Path) -> Result<Vec<u8>, ParquetError> {
    let bytes = to_bytes(table)?;
    atomic::write(path, &bytes)?;
    Ok(bytes)
}

/// Reads a table.
///
/// # Errors
/// [`ParquetError`] if the file is absent, damaged or not a table of this program.
pub fn read(path: &Path) -> Result<Table, ParquetError> {
    let bytes = fs::read(path).map_err(|source| FileError::new("read", path, source))?;
    from_bytes(bytes, &from_here(path))
}

/// Where the digits of the seal begin. The metadata stands at the end, behind all cells, so the last mark is the seal's.
fn find_seal(bytes: &[u8]) -> Option<usize> {
    let mark = bytes.windows(SEAL_MARK.len()).rposition(|window| window == SEAL_MARK)?;
    let at = mark + SEAL_MARK.len();
    (at + SEAL_DIGITS <= bytes.len()).then_some(at)
}

/// The hash of the bytes with an open seal, which is how they are left.
fn hash_around_seal(bytes: &mut [u8]) -> Option<blake3::Hash> {
    let at = find_seal(bytes)?;
    bytes[at..at + SEAL_DIGITS].fill(b'0');
    Some(blake3::hash(bytes))
}

fn to_series(column: &Column) -> pl::Series {
    let name: pl::PlSmallStr = column.name.as_str().into();
    match &column.data {
        Data::Float(cells) => <pl::Series as pl::NamedFrom<_, _>>::new(name, cells),
        Data::Int(cells) => <pl::Series as pl::NamedFrom<_, _>>::new(name, cells),
        Data::Text(cells) => <pl::Series as pl::NamedFrom<_, _>>::new(name, cells),
        Data::FloatList(cells) => {
            let samples = cells.iter().map(Vec::len).sum();
            let mut builder = pl::ListPrimitiveChunkedBuilder::<pl::Float64Type>::new(
                name,
                cells.len(),
                samples,
                pl::DataType::Float64,
            );
            for cell in cells {
                builder.append_slice(cell);
            }
            pl::IntoSeries::into_series(builder.finish())
        }
    }
}

fn to_data(series: &pl::Series) -> pl::PolarsResult<Data> {
    Ok(match series.dtype() {
        pl::DataType::Float64 => Data::Float(series.f64()?.iter().map(|x| x.unwrap_or(f64::NAN)).collect()),
        pl::DataType::Int64 => Data::Int(series.i64()?.iter().map(Option::unwrap_or_default).collect()),
        pl::DataType::String => {
            Data::Text(series.str()?.iter().map(|text| text.unwrap_or_default().to_owned()).collect())
        }
        _ => Data::FloatList(
            series
                .list()?
                .series_iter()
                .map(|cell| {
                    let Some(cell) = cell else { return Ok(Vec::new()) };
                    Ok(cell.f64()?.iter().map(|x| x.unwrap_or(f64::NAN)).collect())
                })
                .collect::<pl::PolarsResult<_>>()?,
        ),
    })
}
