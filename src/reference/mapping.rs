//! Types of a reference file with their readers: a key, its type, how it is read and what an editor says of it, all in one line
//! of one list.

use std::collections::{BTreeMap, BTreeSet};

use super::name::{Column, TableName};
use super::selection::Selection;
use super::view::Source;
use crate::experiment::Columns;
use crate::yaml::{Findings, did_you_mean};

/// A mapping, by what messages call it. `key: Type = required("What it is", read),` is that call of `Keys`, without the key. A
/// reader may use what keys above it gave; the method after the type's name looks at all of them together.
macro_rules! mapping {
    (
        $what:literal $name:ident $(, $checked:ident)? {
            $($field:ident $(as $key:literal)?: $type:ty = $how:ident($about:literal, $($with:expr),+),)+
        }
    ) => {
        #[doc = $what]
        #[derive(Debug, Clone, PartialEq, serde::Serialize)]
        pub struct $name {
            $(#[doc = $about] $(#[serde(rename = $key)])? pub $field: $type,)+
        }

        impl $name {
            pub(crate) fn read(at: $crate::yaml::At<'_>) -> Option<Self> {
                let all = [$(($crate::reference::mapping::key!($field $($key)?), stringify!($how))),+];
                let required = all.iter().filter(|(_, how)| *how == "required").map(|(key, _)| *key);
                let keys = at.keys_with($what, &required.collect::<Vec<_>>())?;
                $(let $field = keys.$how($crate::reference::mapping::key!($field $($key)?), $about, $($with),+);)+
                keys.close()?;
                let read = Self { $($field: $field?,)+ };
                $(read.$checked(at)?;)?
                Some(read)
            }
        }

        impl $crate::reference::mapping::Reads for $name {
            fn note<'a>(&'a self, seen: &mut $crate::reference::mapping::Seen<'a>) {
                let mut own = $crate::reference::mapping::Seen::default();
                $($crate::reference::mapping::Reads::note(&self.$field, &mut own);)+
                seen.below.push(own);
            }
        }
    };
}

/// A mapping that reads rows of a table, with the keys of `where` and, behind it, those that say which table it is.
macro_rules! of_rows {
    ($what:literal $name:ident $(, $checked:ident)? { $($keys:tt)+ } { $($behind:tt)* } $table:expr) => {
        $crate::reference::mapping::mapping! {
            $what $name $(, $checked)? {
                $($keys)+
                rows as "where": $crate::reference::selection::Selection =
                    or("Conditions beyond the entry's own", $crate::reference::selection::Selection::read, Default::default()),
                $($behind)*
            }
        }

        impl $name {
            pub(crate) fn source(&self) -> $crate::reference::view::Source<'_> {
                let table: fn(&Self) -> Option<&str> = $table;
                $crate::reference::view::Source { table: table(self), rows: &self.rows }
            }
        }
    };
}

/// A mapping that reads rows of the experiment's own table.
macro_rules! claim {
    ($what:literal $name:ident $(, $checked:ident)? { $($keys:tt)+ }) => {
        $crate::reference::mapping::of_rows! { $what $name $(, $checked)? { $($keys)+ } {} |_| None }
    };
}

/// A mapping that reads rows of the experiment's own table or another one.
macro_rules! word {
    ($what:literal $name:ident $(, $checked:ident)? { $($keys:tt)+ }) => {
        $crate::reference::mapping::of_rows! {
            $what $name $(, $checked)? { $($keys)+ } {
                table: Option<$crate::reference::name::TableName> = optional(
                    "Another experiment's table; the entry's conditions do not hold there",
                    $crate::reference::name::TableName::read
                ),
            } |own| own.table.as_deref()
        }
    };
}

/// One of several forms, each under a word: `Variant(Type) = form("word", "What it is", read),`. What is made elsewhere has no
/// reader.
macro_rules! forms {
    (
        $what:literal $name:ident {
            $($variant:ident($type:ty) = $how:ident($word:literal, $about:literal $(, $read:expr)?),)+
        }
    ) => {
        #[doc = $what]
        #[derive(Debug, Clone, PartialEq, serde::Serialize)]
        pub enum $name {
            $(#[doc = $about] #[serde(rename = $word)] $variant($type),)+
        }

        impl $name {
            pub(crate) fn read(at: $crate::yaml::At<'_>) -> Option<Self> {
                type Read = fn($crate::yaml::At<'_>) -> Option<$name>;
                let forms = [$($(($word, $about, (|at| $read(at).map(Self::$variant)) as Read),)?)+];
                at.choose($what, &forms.map(|(word, about, _)| (word, about)), |choice| {
                    let (.., read) = forms.into_iter().find(|(word, ..)| *word == choice.name())?;
                    read(choice.value()?)
                })
            }
        }

        impl $crate::reference::mapping::Reads for $name {
            fn note<'a>(&'a self, seen: &mut $crate::reference::mapping::Seen<'a>) {
                match self {
                    $(Self::$variant(it) => $crate::reference::mapping::Reads::note(it, seen),)+
                }
            }
        }
    };
}

macro_rules! key {
    ($field:ident) => {
        stringify!($field)
    };
    ($field:ident $key:literal) => {
        $key
    };
}

pub(super) use {claim, forms, key, mapping, of_rows, word};

/// What is known of the tables that entries may read.
pub(crate) struct KnownTables<'a> {
    /// The experiments that there are.
    pub(crate) ids: BTreeSet<&'a str>,
    /// Of those without mistakes, by their names.
    pub(crate) columns: BTreeMap<String, Columns>,
}

/// What a part of an entry reads of tables.
#[derive(Debug, Default)]
pub(crate) struct Seen<'a> {
    table: Option<&'a TableName>,
    rows: Option<&'a Selection>,
    columns: Vec<&'a Column>,
    /// Parts that read for themselves.
    pub below: Vec<Self>,
}

impl<'a> Seen<'a> {
    /// All that `part` reads.
    pub(crate) fn of(part: &'a impl Reads) -> Self {
        let mut seen = Self::default();
        part.note(&mut seen);
        seen
    }

    /// Reports experiments that there are not, and columns that no table has: the experiment's `own` or another one, as far as
    /// they are known.
    pub(crate) fn check(&self, own: &str, tables: &KnownTables<'_>, findings: &Findings) {
        let table = self.table.map_or(own, |table| table);
        if let Some(other) = self.table.filter(|table| !tables.ids.contains(&***table)) {
            let near = did_you_mean(table, tables.ids.iter().copied());
            let help = near.unwrap_or_else(|| "`shotdamp list` shows them".into());
            findings.report::<()>(other.span(), format!("`{table}` is not an experiment of this study"), Some(help));
        }
        if let Some(columns) = tables.columns.get(table) {
            for column in self.columns.iter().filter(|column| columns.role(column).is_none()) {
                columns.unknown::<()>(&format!("the table of `{table}`"), column, column.span(), findings);
            }
        }
        self.below.iter().for_each(|part| part.check(own, tables, findings));
    }

    /// Where it reads.
    pub(crate) fn sources(&self) -> Vec<Source<'a>> {
        let own = self.rows.map(|rows| Source { table: self.table.map(|table| &**table), rows });
        own.into_iter().chain(self.below.iter().flat_map(Self::sources)).collect()
    }
}

/// A part of an entry that may read tables.
pub(crate) trait Reads {
    /// Adds what it reads.
    fn note<'a>(&'a self, _seen: &mut Seen<'a>) {}
}

impl Reads for Column {
    fn note<'a>(&'a self, seen: &mut Seen<'a>) {
        seen.columns.push(self);
    }
}

impl Reads for TableName {
    fn note<'a>(&'a self, seen: &mut Seen<'a>) {
        seen.table = Some(self);
    }
}

impl Reads for Selection {
    fn note<'a>(&'a self, seen: &mut Seen<'a>) {
        seen.rows = Some(self);
        seen.columns.extend(self.0.keys());
    }
}

impl<T: Reads> Reads for Option<T> {
    fn note<'a>(&'a self, seen: &mut Seen<'a>) {
        self.iter().for_each(|part| part.note(seen));
    }
}

impl<T: Reads> Reads for Vec<T> {
    fn note<'a>(&'a self, seen: &mut Seen<'a>) {
        self.iter().for_each(|part| part.note(seen));
    }
}

impl<T: Reads> Reads for Box<T> {
    fn note<'a>(&'a self, seen: &mut Seen<'a>) {
        (**self).note(seen);
    }
}

impl Reads for f64 {}
impl Reads for u32 {}
impl Reads for usize {}
impl Reads for String {}
impl<T> Reads for [T; 2] {}
