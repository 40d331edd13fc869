//! Which rows of a table an entry means: `where: {stop: with, gap_ratio: [10, 50], force_ratio: {from: 0.1, to: 2}}`.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;
use serde_json::json;

use super::name::{Column, in_unit_of};
use crate::experiment::Columns;
use crate::table::Data;
use crate::yaml::{At, Value};

/// Conditions by column; all must hold. Empty selects every row.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[serde(transparent)]
pub struct Selection(pub BTreeMap<Column, Allowed>);

/// What a cell may be.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Allowed {
    /// This number, to nine digits.
    Number(f64),
    /// This text; in a column of numbers, `infinite` stands for ∞.
    Text(String),
    /// One of these.
    OneOf(Vec<Allowed>),
    /// A range, ends included; an absent end is open.
    Range {
        /// Lower end.
        from: Option<f64>,
        /// Upper end.
        to: Option<f64>,
    },
}

impl Allowed {
    /// Whether it is the level of this name: `with`, or `0.05` in a column of numbers.
    pub(crate) fn is_level(&self, name: &str) -> bool {
        match self {
            Self::Text(word) => word == name,
            Self::Number(x) => name.parse().is_ok_and(|level| same(*x, level)),
            Self::OneOf(_) | Self::Range { .. } => false,
        }
    }
}

impl Selection {
    /// These conditions, and `more`; where both speak of a column, `more` holds.
    #[must_use]
    pub fn and(&self, more: &Self) -> Self {
        let mut all = self.0.clone();
        all.extend(more.0.iter().map(|(column, allowed)| (column.clone(), allowed.clone())));
        Self(all)
    }

    /// These conditions, and one more.
    pub(crate) fn with(&self, column: &str, allowed: Allowed) -> Self {
        let mut all = self.0.clone();
        all.insert(column.into(), allowed);
        Self(all)
    }
}

impl Allowed {
    /// Whether the cell of this row is allowed.
    pub fn admits(&self, data: &Data, row: usize) -> bool {
        match self {
            Self::OneOf(list) => list.iter().any(|one| one.admits(data, row)),
            Self::Text(text) => match data {
                Data::Text(cells) => cells[row] == *text,
                Data::Float(cells) => text == "infinite" && cells[row] == f64::INFINITY,
                Data::Int(_) | Data::FloatList(_) => false,
            },
            Self::Number(number) => data.number(row).is_some_and(|x| same(x, *number)),
            Self::Range { from, to } => data.number(row).is_some_and(|x| {
                from.is_none_or(|from| x >= from || same(x, from)) && to.is_none_or(|to| x <= to || same(x, to))
            }),
        }
    }
}

/// Equal to nine digits: a sweep's points are computed, an entry's are written.
pub(crate) fn same(a: f64, b: f64) -> bool {
    // Infinite levels (a gap without ceiling) are equal to themselves only.
    a == b || (a.is_finite() && b.is_finite() && (a - b).abs() <= 1e-9 * a.abs().max(b.abs()))
}

impl fmt::Display for Selection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (column, allowed)) in self.0.iter().enumerate() {
            write!(f, "{}{column} {allowed}", if i == 0 { "" } else { ", " })?;
        }
        Ok(())
    }
}

impl fmt::Display for Allowed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(x) => write!(f, "{x}"),
            Self::Text(text) => f.write_str(text),
            Self::OneOf(list) => {
                for (i, one) in list.iter().enumerate() {
                    write!(f, "{}{one}", if i == 0 { "" } else { " or " })?;
                }
                Ok(())
            }
            Self::Range { from: Some(from), to: Some(to) } => write!(f, "{from} to {to}"),
            Self::Range { from: Some(from), to: None } => write!(f, "from {from}"),
            Self::Range { from: None, to: Some(to) } => write!(f, "to {to}"),
            Self::Range { from: None, to: None } => f.write_str("any"),
        }
    }
}

impl Selection {
    pub(crate) fn read(at: At<'_>) -> Option<Self> {
        at.named("where", "Rows, by columns", |at| {
            let form = "rows are chosen as `column: number`, a word, a list of them, or {from: 0.1, to: 2}";
            let one = |key: &str, span, at: At<'_>| {
                let column = Column::at(key, span);
                let allowed = Allowed::read(at, &column)?;
                Some((column, allowed))
            };
            at.by_name(json!({}), form, one).map(|conditions| Self(conditions.into_iter().collect()))
        })
    }
}

impl Allowed {
    fn read(at: At<'_>, column: &Column) -> Option<Self> {
        let range = |at: At<'_>| {
            let keys = at.keys("a range")?;
            let from = keys.optional("from", "Lower end; open if absent", in_unit_of(Some(column)));
            let to = keys.optional("to", "Upper end; open if absent", in_unit_of(Some(column)));
            keys.close()?;
            Some(Self::Range { from: from?, to: to? })
        };
        let cell = |at: At<'_>| Self::cell(at, column);
        let one = |at: At<'_>| at.either(|value| matches!(value, Value::Mapping(_)), range, cell);
        let list = |at: At<'_>| at.list(one).map(Self::OneOf);
        at.either(|value| matches!(value, Value::Sequence(_)), list, one)
    }

    /// A number, in the unit of the column or with one, or a word.
    fn cell(at: At<'_>, column: &Column) -> Option<Self> {
        let number = |at: At<'_>| in_unit_of(Some(column))(at).map(Self::Number);
        let word = |at: At<'_>| at.text().map(Self::Text);
        at.either(|value| is_number(value) && !Columns::holds_words(column), number, word)
    }
}

/// It starts as a number does, or is one that is not finite.
pub(super) fn is_number(value: &Value) -> bool {
    let Value::Scalar(text) = value else { return false };
    let text = text.trim_start_matches(['+', '-', '.']);
    text.starts_with(|c: char| c.is_ascii_digit()) || ["nan", "inf", "infinity"].contains(&text.to_lowercase().as_str())
}
