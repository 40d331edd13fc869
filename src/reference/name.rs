//! Names that an entry gives, of columns and of other experiments. They keep their places in the file: which there are is known
//! when the experiments have been read.

use std::borrow::Borrow;
use std::cmp::Ordering;
use std::fmt;
use std::ops::Deref;

use serde::{Serialize, Serializer};

use crate::experiment::Columns;
use crate::yaml::{At, Span};

/// A name with its place in the file, which is no part of what it means.
#[derive(Debug, Clone)]
struct Placed {
    name: String,
    span: Span,
}

impl PartialEq for Placed {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Placed {}

impl PartialOrd for Placed {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Placed {
    fn cmp(&self, other: &Self) -> Ordering {
        self.name.cmp(&other.name)
    }
}

impl Serialize for Placed {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.name)
    }
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Column(Placed);

impl Column {
    pub(crate) fn read(at: At<'_>) -> Option<Self> {
        let name = |at: At<'_>| at.form(|node, findings| At::Node(node, findings).text(), |_| Columns::offered());
        Some(Self(Placed { name: at.named("column", "A column of the table", name)?, span: at.span() }))
    }

    /// One that is a key.
    pub(crate) fn at(name: &str, span: Span) -> Self {
        Self(Placed { name: name.into(), span })
    }

    /// Its name.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0.name
    }

    /// Its unit, if it is known by its name.
    pub(crate) fn unit(&self) -> Option<&'static str> {
        Columns::unit(self)
    }

    pub(crate) fn span(&self) -> Span {
        self.0.span
    }
}

/// Numbers in the unit of a column, or with a unit of that kind.
pub(super) fn in_unit_of(column: Option<&Column>) -> impl Fn(At<'_>) -> Option<f64> + use<> {
    in_unit(column.and_then(Column::unit))
}

/// Numbers in this unit, if it is known, or with one of its kind.
pub(super) fn in_unit(unit: Option<&'static str>) -> impl Fn(At<'_>) -> Option<f64> {
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
        self.as_str()
    }
}

impl Borrow<str> for Column {
    fn borrow(&self) -> &str {
        self
    }
}

impl fmt::Display for Column {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self)
    }
}

/// Another experiment, whose table is read.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TableName(Placed);

impl TableName {
    pub(crate) fn read(at: At<'_>) -> Option<Self> {
        Some(Self(Placed { name: at.text()?, span: at.span() }))
    }

    pub(crate) fn span(&self) -> Span {
        self.0.span
    }
}

impl Deref for TableName {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0.name
    }
}
