//! A mapping that is read or described: see [`At`].

use std::cell::RefCell;

use serde_json::{Value as Schema, json};

use super::at::{At, Sketch};
use super::diagnostic::{Findings, Span};
use super::node::{Entry, Node, Value};
use super::reader::{all, kind, unknown};
use super::schema::Object;
use super::word::closest;

/// A mapping. The keys that a reader asks for are the keys that exist.
pub(crate) enum Keys<'t> {
    /// As it is written.
    Read(Fields<'t>),
    /// As it may be written.
    Outline(&'t Sketch<'t>, RefCell<Object>),
}

/// A key, with what an editor says of it.
pub(crate) type Key<'a> = (&'static str, &'a str);

impl<'t> Keys<'t> {
    /// Opens `node` as a mapping; `what` names it in messages (`a damper`), which show the `required` keys where it is none.
    pub fn open(node: &'t Node, what: &'static str, required: &[&'static str], findings: &'t Findings) -> Option<Self> {
        Fields::open(node, what, required, findings).map(Self::Read)
    }

    pub fn outline(sketch: &'t Sketch<'t>) -> Self {
        Self::Outline(sketch, RefCell::new(Object::new(sketch.about())))
    }

    /// Where the mapping stands.
    pub fn span(&self) -> Span {
        match self {
            Self::Read(fields) => fields.span,
            Self::Outline(..) => Span::default(),
        }
    }

    /// Reports a problem of the mapping as a whole.
    pub fn wrong<T>(&self, message: &str) -> Option<T> {
        match self {
            Self::Read(fields) => fields.findings.wrong(fields.span, message),
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

    /// A part that may be absent, and is this then.
    pub fn or<T>(&self, key: &'static str, about: &str, read: impl FnOnce(At<'_>) -> Option<T>, usual: T) -> Option<T> {
        self.optional(key, about, read).map(|given| given.unwrap_or(usual))
    }

    /// A part that must be there. `None`: reported.
    pub fn required<T>(&self, key: &'static str, about: &str, read: impl FnOnce(At<'_>) -> Option<T>) -> Option<T> {
        match self {
            Self::Read(fields) => match fields.get(key) {
                Some(node) => read(At::Node(node, fields.findings)),
                None => {
                    let what = in_words(&Sketch::of(about, &RefCell::default(), read));
                    fields.missing.borrow_mut().push((vec![key], what));
                    None
                }
            },
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

    /// A part that there is only where `holds`, and which may be absent there.
    #[expect(clippy::option_option, reason = "absent and wrong are two things")]
    pub fn optional_where<T>(
        &self,
        holds: bool,
        key: &'static str,
        about: &str,
        read: impl FnOnce(At<'_>) -> Option<T>,
    ) -> Option<Option<T>> {
        if holds { self.optional(key, about, read) } else { Some(None) }
    }

    /// A part that there is only where `holds`, and which must be there.
    #[expect(clippy::option_option, reason = "absent and wrong are two things")]
    pub fn required_where<T>(
        &self,
        holds: bool,
        key: &'static str,
        about: &str,
        read: impl FnOnce(At<'_>) -> Option<T>,
    ) -> Option<Option<T>> {
        if holds { self.required(key, about, read).map(Some) } else { Some(None) }
    }

    /// A part that may be absent, for the schema: it is read elsewhere.
    pub fn elsewhere<T>(&self, key: &'static str, about: &str, read: impl FnOnce(At<'_>) -> Option<T>) {
        if let Self::Outline(sketch, object) = self {
            object.borrow_mut().add(key, part(sketch, about, read));
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
        self.wants(&[key], "")
    }

    /// The same of one of several parts, with what it would say.
    pub fn wants<T>(&self, keys: &[&'static str], what: &'static str) -> Option<T> {
        if let Self::Read(fields) = self
            && keys.iter().all(|key| fields.get(key).is_none())
        {
            fields.missing.borrow_mut().push((keys.to_vec(), what.to_owned()));
        }
        None
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

/// A mapping as it is written, while it is read.
pub(crate) struct Fields<'t> {
    findings: &'t Findings,
    entries: &'t [Entry],
    what: &'static str,
    span: Span,
    asked: RefCell<Vec<&'static str>>,
    /// Of each of these groups one key should have been there, and what it would say.
    missing: RefCell<Vec<(Vec<&'static str>, String)>>,
}

impl<'t> Fields<'t> {
    fn open(node: &'t Node, what: &'static str, required: &[&'static str], findings: &'t Findings) -> Option<Self> {
        let Value::Mapping(entries) = &node.value else {
            let message = format!("{what} is written as keys with values, not as {}", kind(node));
            let help = if required.is_empty() {
                "write `key: value` lines below it, or {key: value, key: value}".into()
            } else {
                format!("write {{{}: …}}", required.join(": …, "))
            };
            return findings.report(node.span, message, Some(help));
        };
        let span = node.span;
        Some(Self { findings, entries, what, span, asked: RefCell::default(), missing: RefCell::default() })
    }

    /// The node under `key`, if it is there.
    fn get(&self, key: &'static str) -> Option<&'t Node> {
        self.entry(key).map(|entry| &entry.node)
    }

    fn entry(&self, key: &'static str) -> Option<&'t Entry> {
        let mut asked = self.asked.borrow_mut();
        if !asked.contains(&key) {
            asked.push(key);
        }
        self.entries.iter().find(|entry| entry.key == key)
    }

    /// A part that may be absent. `None`: reported; `Some(None)`: absent.
    #[expect(clippy::option_option, reason = "absent and wrong are two things")]
    fn optional<T>(&self, key: &'static str, read: impl FnOnce(&'t Node) -> Option<T>) -> Option<Option<T>> {
        self.get(key).map_or(Some(None), |node| read(node).map(Some))
    }

    /// The one key among `keys` that is given, if any; two are reported.
    #[expect(clippy::option_option, reason = "absent and wrong are two things")]
    fn at_most_one(&self, keys: &[&'static str]) -> Option<Option<(&'static str, &'t Node)>> {
        let mut given: Vec<_> = keys.iter().filter_map(|key| self.entry(key).map(|entry| (*key, entry))).collect();
        given.sort_by_key(|(_, entry)| entry.key_span.start);
        match given.as_slice() {
            [] => Some(None),
            [(key, entry)] => Some(Some((key, &entry.node))),
            [(first, _), (second, entry), ..] => self.findings.report(
                entry.key_span,
                format!("{} has both `{first}` and `{second}`, of which one is wanted", self.what),
                Some("keep one of the two".into()),
            ),
        }
    }

    /// The one key among `keys` that is given; none or two are reported.
    fn exactly_one(&self, keys: &[&'static str]) -> Option<(&'static str, &'t Node)> {
        let given = self.at_most_one(keys)?;
        if given.is_none() {
            self.missing.borrow_mut().push((keys.to_vec(), String::new()));
        }
        given
    }

    /// The keys that are there and have not been asked for yet.
    fn others(&self) -> impl Iterator<Item = &'t Entry> {
        let asked = self.asked.borrow().clone();
        self.entries.iter().filter(move |entry| !asked.contains(&&*entry.key))
    }

    /// Reports what is missing and what was never asked for.
    fn close(self) -> Option<()> {
        let asked = self.asked.borrow();
        let unknown_keys = || self.entries.iter().filter(|entry| !asked.contains(&&*entry.key));
        let mut fine = self.missing.borrow().is_empty();
        for (group, what) in self.missing.borrow().iter() {
            // A misspelt key is reported itself, with the right spelling.
            let meant = |entry: &Entry| closest(&entry.key, asked.iter().copied());
            if !unknown_keys().filter_map(meant).any(|key| group.contains(&key)) {
                let wanted: Vec<_> = group.iter().map(|key| format!("`{key}`")).collect();
                let colon = if what.is_empty() { "" } else { ": " };
                let message = format!("{} lacks {}{colon}{what}", self.what, wanted.join(" or "));
                self.findings.wrong::<()>(self.span, message);
            }
        }
        for entry in unknown_keys() {
            fine = false;
            unknown::<()>(self.findings, entry.key_span, self.what, "key", &entry.key, &asked);
        }
        fine.then_some(())
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

/// The words that a description accepts, and the keys of which one does: "`highest` or `{number: …}`". Empty if it takes no words.
fn in_words(schema: &Schema) -> String {
    let forms = schema["anyOf"].as_array().map_or(std::slice::from_ref(schema), Vec::as_slice);
    let words = |form: &Schema| form["enum"].as_array().cloned().unwrap_or_default();
    let words: Vec<String> =
        forms.iter().flat_map(words).filter_map(|word| Some(format!("`{}`", word.as_str()?))).collect();
    if words.is_empty() {
        return String::new();
    }
    let keys = forms.iter().filter_map(|form| form["properties"].as_object());
    let keys = keys.flat_map(|keys| keys.keys().map(|key| format!("`{{{key}: …}}`")));
    words.into_iter().chain(keys).collect::<Vec<_>>().join(" or ")
}

/// Beside a reference a description would not count.
fn part<T>(sketch: &Sketch<'_>, about: &str, read: impl FnOnce(At<'_>) -> Option<T>) -> Schema {
    match sketch.part(about, read) {
        schema if schema.get("$ref").is_some() => json!({"description": about, "allOf": [schema]}),
        schema => schema,
    }
}
