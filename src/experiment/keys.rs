//! A mapping that is read or described: see [`At`].

use std::cell::RefCell;

use serde_json::{Value as Schema, json};

use super::at::{At, Sketch};
use super::diagnostic::Span;
use super::reader::{Fields, all};
use super::schema::parts::Object;
use super::yaml::Entry;

/// A mapping. The keys that a reader asks for are the keys that exist.
pub(super) enum Keys<'t> {
    /// As it is written.
    Read(Fields<'t>),
    /// As it may be written.
    Outline(&'t Sketch<'t>, RefCell<Object>),
}

/// A key, with what an editor says of it.
pub(super) type Key<'a> = (&'static str, &'a str);

impl<'t> Keys<'t> {
    pub fn of(fields: Fields<'t>) -> Self {
        Self::Read(fields)
    }

    pub fn outline(sketch: &'t Sketch<'t>) -> Self {
        Self::Outline(sketch, RefCell::new(Object::new(sketch.about())))
    }

    /// Where the mapping stands.
    pub fn span(&self) -> Span {
        match self {
            Self::Read(fields) => fields.span(),
            Self::Outline(..) => Span::default(),
        }
    }

    /// Reports a problem of the mapping as a whole.
    pub fn wrong<T>(&self, message: &str) -> Option<T> {
        match self {
            Self::Read(fields) => fields.findings.wrong(fields.span(), message),
            Self::Outline(..) => None,
        }
    }

    /// The node under `key`, if it is there: of a key that is described elsewhere.
    pub fn get(&self, key: &'static str) -> Option<At<'t>> {
        match self {
            Self::Read(fields) => fields.get(key).map(|node| At::Node(node, fields.findings)),
            Self::Outline(..) => None,
        }
    }

    /// Where its value stands, if it is there.
    pub fn span_of(&self, key: &'static str) -> Option<Span> {
        self.get(key).map(At::span)
    }

    /// A part that must be there. `None`: reported.
    pub fn required<T>(&self, key: &'static str, about: &str, read: impl FnOnce(At<'_>) -> Option<T>) -> Option<T> {
        match self {
            Self::Read(fields) => fields.required(key, |node| read(At::Node(node, fields.findings))),
            Self::Outline(sketch, object) => {
                object.borrow_mut().require(key, part(sketch, about, read));
                None
            }
        }
    }

    /// A part that may be absent. `None`: reported; `Some(None)`: absent.
    #[expect(clippy::option_option, reason = "absent and wrong are two things")]
    pub fn optional<T>(
        &self,
        key: &'static str,
        about: &str,
        read: impl FnOnce(At<'_>) -> Option<T>,
    ) -> Option<Option<T>> {
        match self {
            Self::Read(fields) => fields.optional(key, |node| read(At::Node(node, fields.findings))),
            Self::Outline(sketch, object) => {
                object.borrow_mut().add(key, part(sketch, about, read));
                Some(None)
            }
        }
    }

    /// A part that there is only where `holds`, and which may be absent there; a schema allows it everywhere.
    #[expect(clippy::option_option, reason = "absent and wrong are two things")]
    pub fn optional_where<T>(
        &self,
        holds: bool,
        key: &'static str,
        about: &str,
        read: impl FnOnce(At<'_>) -> Option<T>,
    ) -> Option<Option<T>> {
        match self {
            Self::Read(_) if !holds => Some(None),
            _ => self.optional(key, about, read),
        }
    }

    /// A part that there is only where `holds`, and which must be there; a schema allows it everywhere.
    #[expect(clippy::option_option, reason = "absent and wrong are two things")]
    pub fn required_where<T>(
        &self,
        holds: bool,
        key: &'static str,
        about: &str,
        read: impl FnOnce(At<'_>) -> Option<T>,
    ) -> Option<Option<T>> {
        match self {
            Self::Read(_) if holds => self.required(key, about, read).map(Some),
            _ => self.optional_where(holds, key, about, read),
        }
    }

    /// The one key among `keys` that is given, if any; two are reported.
    #[expect(clippy::option_option, reason = "absent and wrong are two things")]
    pub fn at_most_one<T>(
        &self,
        keys: &[Key<'_>],
        read: impl Fn(&'static str, At<'_>) -> Option<T>,
    ) -> Option<Option<T>> {
        match self {
            Self::Read(fields) => match fields.at_most_one(&names(keys))? {
                Some((key, node)) => read(key, At::Node(node, fields.findings)).map(Some),
                None => Some(None),
            },
            Self::Outline(sketch, object) => {
                add_each(sketch, object, keys, read);
                object.borrow_mut().exclude(&names(keys));
                Some(None)
            }
        }
    }

    /// The one key among `keys` that is given; none or two are reported.
    pub fn exactly_one<T>(&self, keys: &[Key<'_>], read: impl Fn(&'static str, At<'_>) -> Option<T>) -> Option<T> {
        match self {
            Self::Read(fields) => {
                let (key, node) = fields.exactly_one(&names(keys))?;
                read(key, At::Node(node, fields.findings))
            }
            Self::Outline(sketch, object) => {
                add_each(sketch, object, keys, read);
                object.borrow_mut().demand_one(&names(keys));
                None
            }
        }
    }

    /// A part that may stand here or in the mapping above, which several of these share.
    #[expect(clippy::option_option, reason = "absent and wrong are two things")]
    pub fn inherited<T>(
        &self,
        above: Option<&Keys<'_>>,
        key: &'static str,
        about: &str,
        read: impl Fn(At<'_>) -> Option<T>,
    ) -> Option<Option<T>> {
        match (self, above) {
            (Self::Read(_), Some(above)) if self.get(key).is_none() => above.optional(key, about, read),
            _ => self.optional(key, about, read),
        }
    }

    /// A part that should have been there, as nothing stands for it.
    pub fn lacks<T>(&self, key: &'static str) -> Option<T> {
        match self {
            Self::Read(fields) => fields.required(key, |_| None),
            Self::Outline(..) => None,
        }
    }

    /// Where those of `others` stand that are beside `key`, which none of them may be.
    pub fn beside(&self, key: &'static str, others: &[&'static str]) -> Vec<Span> {
        match self {
            Self::Read(_) if self.get(key).is_none() => Vec::new(),
            Self::Read(_) => others.iter().filter_map(|other| self.span_of(other)).collect(),
            Self::Outline(_, object) => {
                let others: Vec<Schema> = others.iter().map(|other| json!({"required": [other]})).collect();
                object.borrow_mut().add_rule(json!({"not": {"required": [key], "anyOf": others}}));
                Vec::new()
            }
        }
    }

    /// Where those of `keys` stand that are given, of which one may be.
    pub fn of_which_one(&self, keys: &[&'static str]) -> Vec<Span> {
        match self {
            Self::Read(_) => keys.iter().filter_map(|key| self.span_of(key)).collect(),
            Self::Outline(_, object) => {
                object.borrow_mut().exclude(keys);
                Vec::new()
            }
        }
    }

    /// What else holds of these keys, for the schema; the reader checks it itself.
    pub fn rule(&self, rule: impl FnOnce() -> Schema) {
        if let Self::Outline(_, object) = self {
            object.borrow_mut().add_rule(rule());
        }
    }

    /// All other keys, which ends the mapping; of those in a description `known` says what they are.
    pub fn others<T>(
        self,
        known: impl Iterator<Item = (&'static str, String)>,
        read: impl Fn(&str, Span, At<'_>) -> Option<T>,
    ) -> Option<Vec<T>> {
        match &self {
            Self::Read(fields) => {
                let one = |entry: &Entry| read(&entry.key, entry.key_span, At::Node(&entry.node, fields.findings));
                all(fields.others().map(one))
            }
            Self::Outline(sketch, object) => {
                for (key, about) in known {
                    let schema = part(sketch, &about, |at| read(key, Span::default(), at));
                    object.borrow_mut().add(key, schema);
                }
                self.close()?;
                None
            }
        }
    }

    /// Reports what is missing and what was never asked for.
    pub fn close(self) -> Option<()> {
        match self {
            Self::Read(fields) => fields.close(),
            Self::Outline(sketch, object) => {
                sketch.add(object.into_inner().schema());
                None
            }
        }
    }
}

fn add_each<T>(
    sketch: &Sketch<'_>,
    object: &RefCell<Object>,
    keys: &[Key<'_>],
    read: impl Fn(&'static str, At<'_>) -> Option<T>,
) {
    for (key, about) in keys {
        let schema = part(sketch, about, |at| read(key, at));
        object.borrow_mut().add(key, schema);
    }
}

fn names(keys: &[Key<'_>]) -> Vec<&'static str> {
    keys.iter().map(|(key, _)| *key).collect()
}

/// Beside a reference a description would not count.
fn part<T>(sketch: &Sketch<'_>, about: &str, read: impl FnOnce(At<'_>) -> Option<T>) -> Schema {
    match sketch.part(about, read) {
        schema if schema.get("$ref").is_some() => json!({"description": about, "allOf": [schema]}),
        schema => schema,
    }
}
