//! Tables survive the way to disk, and nothing else passes for one.

use std::collections::BTreeMap;

use shotdamp::atomic;
use shotdamp::table::{Column, Data, ParquetError, Table, TableError, parquet};

fn table() -> Table {
    Table { metadata: BTreeMap::from([("experiment".to_owned(), "ch3-gap".to_owned())]), ..Table::default() }
        .with(Column::new("gap_ratio", Data::Float(vec![10.0, f64::INFINITY, f64::NAN])).with_symbol("h′"))
        .with(Column::new("rms_velocity", Data::Float(vec![0.1 + 0.2, -0.0, 5e-324])).with_unit("m/s"))
        .with(Column::new("events", Data::Int(vec![490, 0, -1])))
        .with(Column::new("variant", Data::Text(vec!["baseline".into(), String::new(), "gravity=9.8".into()])))
        .with(Column::new("time", Data::FloatList(vec![vec![0.0, 0.5, f64::NAN], vec![], vec![1.0]])).with_unit("s"))
}

/// `==` on tables says no for NaN, so compare the bits that were meant.
fn assert_same(a: &Table, b: &Table) {
    assert_eq!(format!("{a:?}"), format!("{b:?}"));
}

#[test]
fn a_table_comes_back_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deep/er/ch3-gap.parquet");
    parquet::write(&table(), &path).unwrap();
    assert_same(&parquet::read(&path).unwrap(), &table());

    let empty_rows = table().select(&[]);
    parquet::write(&empty_rows, &path).unwrap();
    assert_same(&parquet::read(&path).unwrap(), &empty_rows);
}

#[test]
fn the_same_table_gives_the_same_bytes() {
    let bytes = parquet::to_bytes(&table()).unwrap();
    assert!((0..3).all(|_| parquet::to_bytes(&table()).unwrap() == bytes));
}

#[test]
fn every_cut_and_every_flipped_byte_is_an_error() {
    let whole = parquet::to_bytes(&table()).unwrap();
    for length in 0..whole.len() {
        assert!(parquet::from_bytes(whole[..length].to_vec(), "cut").is_err(), "cut to {length} bytes");
    }
    for at in 0..whole.len() {
        let mut flipped = whole.clone();
        flipped[at] ^= 0x10;
        assert!(
            matches!(parquet::from_bytes(flipped, "flipped"), Err(ParquetError::Damaged { .. })),
            "byte {at} flipped"
        );
    }
}

#[test]
fn foreign_files_are_refused_with_their_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("foreign.parquet");
    for foreign in [&b""[..], b"PAR1PAR1", b"title: not a table\n", &[0; 4096]] {
        std::fs::write(&path, foreign).unwrap();
        assert!(parquet::read(&path).unwrap_err().to_string().contains("foreign.parquet"));
    }
    let absent = parquet::read(&folder.path().join("absent.parquet")).unwrap_err();
    assert!(matches!(absent, ParquetError::File(_)) && absent.to_string().contains("absent.parquet"));
}

#[test]
fn a_malformed_table_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.parquet");
    let ragged = table().with(Column::new("short", Data::Int(vec![1])));
    assert!(matches!(
        parquet::write(&ragged, &path),
        Err(ParquetError::Table(TableError::Ragged { rows: 1, expected: 3, .. }))
    ));
    let twice = table().with(Column::new("events", Data::Int(vec![1, 2, 3])));
    assert!(matches!(parquet::write(&twice, &path), Err(ParquetError::Table(TableError::Twice(_)))));
    assert!(!path.exists());
}

#[test]
fn columns_are_found_by_name_and_rows_by_text() {
    let table = table();
    assert_eq!(table.floats("events").unwrap(), [490.0, 0.0, -1.0]);
    assert!(table.floats("variant").is_none() && table.texts("events").is_none() && table.column("psi").is_none());
    assert_eq!(table.baseline().rows(), 1);
    assert_eq!(table.select(&table.rows_where("variant", "gravity=9.8")).lists("time").unwrap(), [vec![1.0]]);
}

/// What a kill between two steps leaves behind: the old file whole, and a hidden neighbour that the next run sweeps.
#[test]
fn a_file_is_written_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report.md");
    atomic::write(&path, b"old").unwrap();
    std::fs::write(folder.path().join(".shotdamp-half"), b"hal").unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
    atomic::sweep(folder.path());
    let names: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names, ["report.md"]);

    // A name that cannot be taken: the error names it, and no neighbour stays.
    let taken = folder.path().join("taken");
    std::fs::create_dir_all(taken.join("full")).unwrap();
    assert!(atomic::write(&taken, b"new").unwrap_err().to_string().contains("taken"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);

    assert!(!atomic::write_if_changed(&path, b"old").unwrap());
    assert!(atomic::write_if_changed(&path, b"new").unwrap());
}

/// For pandas, DuckDB and all that is built on Arrow: a script under `tests/interop` opens real tables with them.
#[test]
fn units_symbols_and_provenance_stand_where_other_readers_look_for_them() {
    let bytes = parquet::to_bytes(&table()).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    let attributes = "{\"experiment\":\"ch3-gap\",\"units\":{\"rms_velocity\":\"m/s\",\"time\":\"s\"},\"symbols\":{\"gap_ratio\":\"h′\"}}";
    assert!(text.contains("PANDAS_ATTRS") && text.contains(attributes));
    // Readers built on Arrow see only what stands in its schema, which is in base64.
    let encoded = text.split("ARROW:schema").nth(1).unwrap();
    let encoded: String = encoded
        .chars()
        .skip_while(|c| *c != '/')
        .take_while(|c| c.is_ascii_alphanumeric() || "+/=".contains(*c))
        .collect();
    let schema = base64::Engine::decode(&base64::engine::general_purpose::STANDARD, encoded).unwrap();
    let schema = String::from_utf8_lossy(&schema);
    for description in ["PANDAS_ATTRS", attributes, "unit", "m/s", "symbol", "h′"] {
        assert!(schema.contains(description), "{description}");
    }
}
