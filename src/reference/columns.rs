//! Columns of a table by name, as an entry asks for them. A column that every table has and this one lacks, and a number
//! that is missing among others, are an [`Absence`]: what is not there must not look like a smaller table.

use std::collections::BTreeMap;

use super::absence::Absence;
use crate::table::{Column, Data, Table};
use crate::text::name;

/// A column and where it stands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found<'t> {
    pub index: usize,
    pub column: &'t Column,
}

pub(super) fn find<'t>(table: &'t Table, name: &str) -> Result<Found<'t>, Absence> {
    find_if_any(table, name).ok_or_else(|| Absence::Broken(format!("there is no column `{name}`")))
}

pub(super) fn find_if_any<'t>(table: &'t Table, name: &str) -> Option<Found<'t>> {
    let index = table.columns.iter().position(|column| column.name == name)?;
    Some(Found { index, column: &table.columns[index] })
}

/// A column of labels.
pub(super) fn labels<'t>(table: &'t Table, name: &str) -> Result<(Found<'t>, &'t [String]), Absence> {
    let found = find(table, name)?;
    match &found.column.data {
        Data::Text(cells) => Ok((found, cells)),
        _ => Err(Absence::Broken(format!("`{name}` is no column of words"))),
    }
}

/// A column that chooses rows or is an abscissa. A parameter is NaN where a part of a union leaves it out, and then in every
/// row of that part; a NaN beside numbers is a number that got lost, and its row would quietly leave the line.
pub(super) fn parameter<'t>(table: &'t Table, name: &str) -> Result<Found<'t>, Absence> {
    let found = find(table, name)?;
    let Data::Float(cells) = &found.column.data else { return Ok(found) };
    if !cells.iter().any(|cell| cell.is_nan()) {
        return Ok(found);
    }
    let parts = match find_if_any(table, name::SWEEP).map(|sweep| &sweep.column.data) {
        Some(Data::Text(parts)) => Some(parts),
        _ => None,
    };
    // Of each part, whether its first row has the parameter.
    let mut given: BTreeMap<&str, bool> = BTreeMap::new();
    for (row, cell) in cells.iter().enumerate() {
        let part = parts.and_then(|parts| parts.get(row)).map_or("", String::as_str);
        if *given.entry(part).or_insert(!cell.is_nan()) == cell.is_nan() {
            return Err(Absence::Broken(format!("`{name}` is NaN in some rows only, near row {}", row + 1)));
        }
    }
    Ok(found)
}

/// Number of rows that every column has.
pub(super) fn height(table: &Table) -> usize {
    table.columns.iter().map(|column| column.data.len()).min().unwrap_or(0)
}
