//! Which rows of a table an entry means: `where: {stop: with, gap_ratio: [10, 50], force_ratio: {from: 0.1, to: 2}}`.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::table::Data;

/// Conditions by column; all must hold. Empty selects every row.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Selection(pub BTreeMap<String, Allowed>);

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
            Self::Number(number) => cell(data, row).is_some_and(|x| same(x, *number)),
            Self::Range { from, to } => cell(data, row).is_some_and(|x| {
                from.is_none_or(|from| x >= from || same(x, from)) && to.is_none_or(|to| x <= to || same(x, to))
            }),
        }
    }

    fn is_sound(&self) -> bool {
        match self {
            Self::Number(x) => x.is_finite(),
            Self::Text(_) => true,
            Self::OneOf(list) => !list.is_empty() && list.iter().all(Self::is_sound),
            Self::Range { from, to } => [from, to].iter().all(|end| end.is_none_or(f64::is_finite)),
        }
    }
}

/// Equal to nine digits: a sweep's points are computed, an entry's are written.
pub(crate) fn same(a: f64, b: f64) -> bool {
    // Infinite levels (a gap without ceiling) are equal to themselves only.
    a == b || (a.is_finite() && b.is_finite() && (a - b).abs() <= 1e-9 * a.abs().max(b.abs()))
}

fn cell(data: &Data, row: usize) -> Option<f64> {
    match data {
        Data::Float(cells) => Some(cells[row]),
        #[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
        Data::Int(cells) => Some(cells[row] as f64),
        Data::Text(_) | Data::FloatList(_) => None,
    }
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

impl<'de> Deserialize<'de> for Allowed {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let allowed = deserializer.deserialize_any(AllowedVisitor)?;
        if allowed.is_sound() { Ok(allowed) } else { Err(D::Error::custom("a condition needs finite numbers")) }
    }
}

struct AllowedVisitor;

impl<'de> Visitor<'de> for AllowedVisitor {
    type Value = Allowed;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, a word, a list of them, or a range such as `{from: 0.1, to: 2}`")
    }

    fn visit_f64<E>(self, x: f64) -> Result<Allowed, E> {
        Ok(Allowed::Number(x))
    }

    #[expect(clippy::cast_precision_loss, reason = "parameters are far below 2^53")]
    fn visit_i64<E>(self, x: i64) -> Result<Allowed, E> {
        Ok(Allowed::Number(x as f64))
    }

    #[expect(clippy::cast_precision_loss, reason = "parameters are far below 2^53")]
    fn visit_u64<E>(self, x: u64) -> Result<Allowed, E> {
        Ok(Allowed::Number(x as f64))
    }

    fn visit_str<E>(self, text: &str) -> Result<Allowed, E> {
        Ok(Allowed::Text(text.into()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Allowed, A::Error> {
        let mut list = Vec::new();
        while let Some(one) = seq.next_element()? {
            list.push(one);
        }
        Ok(Allowed::OneOf(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Allowed, A::Error> {
        let (mut from, mut to) = (None, None);
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "from" => from = Some(map.next_value()?),
                "to" => to = Some(map.next_value()?),
                _ => return Err(A::Error::unknown_field(&key, &["from", "to"])),
            }
        }
        Ok(Allowed::Range { from, to })
    }
}
