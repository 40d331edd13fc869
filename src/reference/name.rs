//! Names that an entry gives, of columns and of other experiments. Columns keep their places in the file: which there are is
//! known when the experiments have been read.

use std::borrow::Borrow;
use std::cmp::Ordering;
use std::fmt;
use std::ops::Deref;

use serde::{Serialize, Serializer};

use crate::experiment::{At, Columns, Span};

/// A column of a table. Where it is named is no part of what it means.
#[derive(Debug, Clone)]
pub struct Column {
    name: String,
    span: Span,
}

impl Column {
    pub(crate) fn read(at: At<'_>) -> Option<Self> {
        let name = |at: At<'_>| at.form(|node, findings| At::Node(node, findings).text(), |_| Columns::offered());
        Some(Self { name: at.named("column", "A column of the table", name)?, span: at.span() })
    }

    /// One that is a key.
    pub(crate) fn at(name: &str, span: Span) -> Self {
        Self { name: name.into(), span }
    }

    /// Its name.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.name
    }

    /// Its unit, if it is known by its name.
    pub(crate) fn unit(&self) -> Option<&'static str> {
        Columns::unit(&self.name)
    }

    pub(crate) fn span(&self) -> Span {
        self.span
    }
}

/// Numbers in the unit of a column, or with a unit of that kind.
pub(super) fn in_unit_of(column: Option<&Column>) -> impl Fn(At<'_>) -> Option<f64> + use<> {
    let unit = column.and_then(Column::unit);
    move |at| at.number_in(unit)
}

impl From<&str> for Column {
    fn from(name: &str) -> Self {
        Self::at(name, Span::default())
    }
}

impl Deref for Column {
    type Target = str;

    fn deref(&self) -> &str {
        &self.name
    }
}

impl Borrow<str> for Column {
    fn borrow(&self) -> &str {
        self
    }
}

impl PartialEq for Column {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Column {}

impl PartialOrd for Column {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Column {
    fn cmp(&self, other: &Self) -> Ordering {
        self.name.cmp(&other.name)
    }
}

impl fmt::Display for Column {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self)
    }
}

impl Serialize for Column {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self)
    }
}

/// Another experiment, whose table is read. Where it is named is no part of what it means.
#[derive(Debug, Clone)]
pub struct TableName {
    name: String,
    span: Span,
}

impl TableName {
    pub(crate) fn read(at: At<'_>) -> Option<Self> {
        Some(Self { name: at.text()?, span: at.span() })
    }

    pub(crate) fn span(&self) -> Span {
        self.span
    }
}

impl Deref for TableName {
    type Target = str;

    fn deref(&self) -> &str {
        &self.name
    }
}

impl PartialEq for TableName {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Serialize for TableName {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self)
    }
}
