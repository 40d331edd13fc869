//! A place of a file that is read or described: one function gives the value that stands there, with every mistake reported, and the JSON
//! Schema of all that may stand there. A key, its limits and its unit are written once.
//!
//! A reader takes an [`At`]. On a node it reads. On a sketch it goes the same way: each building block adds what it would accept
//! as one more alternative and gives nothing. A reader asks for all of its parts before it gives up, so all of them are in the
//! sketch.

use std::cell::{Cell, RefCell};

use serde::de::DeserializeOwned;
use serde_json::{Map, Value as Schema, json};

use super::choice::Choice;
use super::diagnostic::{Findings, Span};
use super::keys::{Key, Keys};
use super::node::{Entry, Node, Value};
use super::quantity::Dimension;
use super::reader;
use super::schema::{self, Object};

/// A place that is read, or described.
#[derive(Clone, Copy)]
pub(crate) enum At<'t> {
    /// What stands there.
    Node(&'t Node, &'t Findings),
    /// What may stand there.
    Sketch(&'t Sketch<'t>),
}

/// Definitions that several places share, by name.
pub(crate) type Definitions = RefCell<Map<String, Schema>>;

/// Stands for the names of one's own in a description: one that every such mapping takes, of letters or digits.
const ANY_NAME: &str = "1";

/// The description of a place while it is made.
pub(crate) struct Sketch<'t> {
    about: &'t str,
    alternatives: RefCell<Vec<Schema>>,
    definitions: &'t Definitions,
}

impl<'t> Sketch<'t> {
    /// The schema of what `read` reads.
    pub fn of<T>(about: &str, definitions: &Definitions, read: impl FnOnce(At<'_>) -> Option<T>) -> Schema {
        let sketch = Sketch { about, alternatives: RefCell::default(), definitions };
        read(At::Sketch(&sketch));
        sketch.schema().unwrap_or_default()
    }

    /// What was added; nothing if nothing was.
    fn schema(self) -> Option<Schema> {
        let mut all = self.alternatives.into_inner();
        if all.len() > 1 { Some(schema::any_of(self.about, all)) } else { all.pop() }
    }

    /// The same of a part of this place.
    pub fn part<T>(&self, about: &str, read: impl FnOnce(At<'_>) -> Option<T>) -> Schema {
        Self::of(about, self.definitions, read)
    }

    /// For an editor's hover.
    pub fn about(&self) -> &'t str {
        self.about
    }

    /// One more that may stand here.
    pub fn add(&self, schema: Schema) {
        self.alternatives.borrow_mut().push(schema);
    }

    /// A reference to what is described once, under `name`.
    pub fn shared<T>(&self, name: &str, about: &str, read: impl FnOnce(At<'_>) -> Option<T>) -> Schema {
        if !self.definitions.borrow().contains_key(name) {
            self.definitions.borrow_mut().insert(name.into(), Schema::Null);
            let schema = self.part(about, read);
            self.definitions.borrow_mut().insert(name.into(), schema);
        }
        schema::reference(name)
    }
}

impl<'t> At<'t> {
    /// Where it stands.
    pub fn span(self) -> Span {
        match self {
            Self::Node(node, _) => node.span,
            Self::Sketch(_) => Span::default(),
        }
    }

    /// Reports what is wrong here, and what would be right.
    pub fn report<T>(self, message: impl Into<String>, help: Option<String>) -> Option<T> {
        self.report_at(self.span(), message, help)
    }

    /// Reports a problem whose message says all.
    pub fn wrong<T>(self, message: impl Into<String>) -> Option<T> {
        self.report(message, None)
    }

    /// Reports a problem at a key or another part of what stands here.
    pub fn report_at<T>(self, span: Span, message: impl Into<String>, help: Option<String>) -> Option<T> {
        match self {
            Self::Node(_, findings) => findings.report(span, message, help),
            Self::Sketch(_) => None,
        }
    }

    /// The same where the message says all.
    pub fn wrong_at<T>(self, span: Span, message: impl Into<String>) -> Option<T> {
        self.report_at(span, message, None)
    }

    /// A building block: how it is read, and the schema of what it accepts.
    pub fn form<T>(
        self,
        read: impl FnOnce(&'t Node, &'t Findings) -> Option<T>,
        schema: impl FnOnce(&Sketch<'_>) -> Schema,
    ) -> Option<T> {
        match self {
            Self::Node(node, findings) => read(node, findings),
            Self::Sketch(sketch) => {
                sketch.add(schema(sketch));
                None
            }
        }
    }

    /// What is shared by several places: described once, under `name`.
    pub fn named<T>(self, name: &str, about: &str, read: impl FnOnce(At<'_>) -> Option<T>) -> Option<T> {
        match self {
            Self::Node(..) => read(self),
            Self::Sketch(sketch) => {
                sketch.add(sketch.shared(name, about, read));
                None
            }
        }
    }

    /// In other words than the key's.
    pub fn called<T>(self, about: &str, read: impl FnOnce(At<'_>) -> Option<T>) -> Option<T> {
        match self {
            Self::Node(..) => read(self),
            Self::Sketch(sketch) => {
                sketch.add(sketch.part(about, read));
                None
            }
        }
    }

    /// One of two forms, by what stands here.
    pub fn either<T>(
        self,
        is_one: impl FnOnce(&Value) -> bool,
        one: impl FnOnce(Self) -> Option<T>,
        other: impl FnOnce(Self) -> Option<T>,
    ) -> Option<T> {
        match self {
            Self::Node(node, _) if is_one(&node.value) => one(self),
            Self::Node(..) => other(self),
            Self::Sketch(_) => {
                one(self);
                other(self)
            }
        }
    }

    /// What stands under `key`; of what does not, all of it.
    pub fn under(self, key: &str) -> Self {
        match self {
            Self::Node(Node { value: Value::Mapping(entries), .. }, findings) => {
                let entry = entries.iter().find(|entry| entry.key == key);
                entry.map_or(self, |entry| Self::Node(&entry.node, findings))
            }
            _ => self,
        }
    }

    /// What stands here is of this kind; of a description nothing is known.
    pub fn holds(self, is_one: impl FnOnce(&Value) -> bool) -> bool {
        matches!(self, Self::Node(node, _) if is_one(&node.value))
    }

    /// It is a sketch of all files, not one of them.
    pub fn is_sketch(self) -> bool {
        matches!(self, Self::Sketch(_))
    }

    /// It says this word, which is one that it may say.
    pub fn is_word(self, word: &str) -> bool {
        match self {
            Self::Node(node, _) => matches!(&node.value, Value::Scalar(text) if text == word),
            Self::Sketch(sketch) => {
                sketch.add(schema::word(word));
                false
            }
        }
    }

    /// A quantity in SI.
    pub fn quantity(self, wanted: Dimension) -> Option<f64> {
        self.form(
            |node, findings| reader::quantity(node, wanted, findings),
            |sketch| schema::quantity(sketch.about, wanted),
        )
    }

    /// A quantity above zero.
    pub fn above_zero(self, wanted: Dimension) -> Option<f64> {
        let value = self.quantity(wanted)?;
        if value > 0.0 { Some(value) } else { self.wrong(format!("{} above zero is wanted", wanted.name())) }
    }

    /// A quantity that is not negative.
    pub fn zero_or_more(self, wanted: Dimension) -> Option<f64> {
        let value = self.quantity(wanted)?;
        if value >= 0.0 { Some(value) } else { self.wrong(format!("{} cannot be negative", wanted.name())) }
    }

    /// A dimensionless number.
    pub fn number(self) -> Option<f64> {
        self.form(reader::number, |sketch| schema::number(sketch.about))
    }

    /// A number alone, or with a unit: in `unit` where that is known, and in SI otherwise.
    pub fn number_in(self, unit: Option<&str>) -> Option<f64> {
        self.form(
            |node, findings| reader::number_in(node, unit, findings),
            |sketch| schema::number_with_unit(sketch.about, unit),
        )
    }

    /// A dimensionless number above zero.
    pub fn number_above_zero(self) -> Option<f64> {
        self.form(
            |node, findings| match reader::number(node, findings)? {
                value if value > 0.0 => Some(value),
                _ => findings.wrong(node.span, "a number above zero is wanted"),
            },
            |sketch| json!({"description": sketch.about, "type": "number", "exclusiveMinimum": 0}),
        )
    }

    /// A fraction that is not the whole: from 0 to less than 1.
    pub fn fraction(self) -> Option<f64> {
        self.form(
            |node, findings| match reader::number(node, findings)? {
                fraction if (0.0..1.0).contains(&fraction) => Some(fraction),
                _ => findings.wrong(node.span, "a fraction is wanted, from 0 to less than 1"),
            },
            |sketch| schema::fraction(sketch.about),
        )
    }

    /// A dimensionless number that is not negative.
    pub fn ratio(self) -> Option<f64> {
        self.form(reader::ratio, |sketch| schema::ratio(sketch.about))
    }

    /// A share, 0 to 1; `too_large` says what it is a share of.
    pub fn share(self, too_large: &str) -> Option<f64> {
        self.form(
            |node, findings| match reader::ratio(node, findings)? {
                share if share <= 1.0 => Some(share),
                _ => findings.wrong(node.span, too_large),
            },
            |sketch| schema::between(sketch.about, 0.0, 1.0),
        )
    }

    /// A dimensionless number within limits; `otherwise` says which.
    pub fn within(self, [low, high]: [f64; 2], otherwise: &str) -> Option<f64> {
        self.form(
            |node, findings| match reader::number(node, findings)? {
                value if (low..=high).contains(&value) => Some(value),
                _ => findings.wrong(node.span, otherwise),
            },
            |sketch| schema::between(sketch.about, low, high),
        )
    }

    /// A whole number up to `most`, with or without its noun: `25` or `25 cycles`.
    pub fn count(self, noun: &str, most: u32) -> Option<u32> {
        self.count_from(0, noun, most, "")
    }

    /// The same from `least` on.
    pub fn count_from(self, least: u32, noun: &str, most: u32, too_few: &str) -> Option<u32> {
        self.form(
            |node, findings| match reader::count(node, noun, most, findings)? {
                count if count < least => findings.wrong(node.span, too_few),
                count => Some(count),
            },
            |sketch| schema::count(sketch.about, noun, least, most),
        )
    }

    /// A text, not empty.
    pub fn text(self) -> Option<String> {
        self.form(reader::text, |sketch| schema::text(sketch.about))
    }

    /// `true` or `false`.
    pub fn boolean(self) -> Option<bool> {
        self.form(reader::boolean, |sketch| schema::boolean(sketch.about))
    }

    /// One of the words of an enum.
    pub fn word<T: DeserializeOwned>(self, role: &str) -> Option<T> {
        self.form(|node, findings| reader::word(node, role, findings), |sketch| schema::words_of::<T>(sketch.about))
    }

    /// Each item of a list.
    pub fn list<T>(self, read: impl Fn(At<'_>) -> Option<T>) -> Option<Vec<T>> {
        self.form(
            |node, findings| reader::list(node, findings, |node| read(At::Node(node, findings))),
            |sketch| schema::list(sketch.about, sketch.part(sketch.about, &read)),
        )
    }

    /// A list that is meant to have two items; how many it has is for the caller to judge.
    pub fn pair<T>(self, read: impl Fn(At<'_>) -> Option<T>) -> Option<Vec<T>> {
        self.form(
            |node, findings| reader::list(node, findings, |node| read(At::Node(node, findings))),
            |sketch| {
                let item = sketch.part(sketch.about, &read);
                json!({"description": sketch.about, "type": "array", "items": item, "minItems": 2, "maxItems": 2})
            },
        )
    }

    /// A list, or one thing that stands for a list of one.
    pub fn one_or_more<T>(self, read: impl Fn(At<'_>) -> Option<T>) -> Option<Vec<T>> {
        self.form(
            |node, findings| reader::one_or_more(node, findings, |node| read(At::Node(node, findings))),
            |sketch| schema::one_or_more(sketch.about, sketch.part(sketch.about, &read)),
        )
    }

    /// Keys with values; `what` names the mapping in messages (`a damper`).
    pub fn keys(self, what: &'static str) -> Option<Keys<'t>> {
        self.keys_with(what, &[])
    }

    /// The same; where no keys stand here, the message shows those that are `required`.
    pub fn keys_with(self, what: &'static str, required: &[&'static str]) -> Option<Keys<'t>> {
        match self {
            Self::Node(node, findings) => Keys::open(node, what, required, findings),
            Self::Sketch(sketch) => Some(Keys::outline(sketch)),
        }
    }

    /// Values by names of one's own, which `rules` limits in a schema; `form` says how they are written.
    pub fn by_name<T>(
        self,
        rules: Schema,
        form: &str,
        read: impl Fn(&str, Span, At<'_>) -> Option<T>,
    ) -> Option<Vec<T>> {
        self.form(
            |node, findings| {
                let Value::Mapping(entries) = &node.value else { return findings.wrong(node.span, form) };
                let one = |Entry { key, key_span, node }: &Entry| read(key, *key_span, At::Node(node, findings));
                reader::all(entries.iter().map(one))
            },
            |sketch| {
                let mut schema = rules;
                schema["description"] = json!(sketch.about);
                schema["type"] = json!("object");
                schema["additionalProperties"] = sketch.part(sketch.about, |at| read(ANY_NAME, Span::default(), at));
                schema
            },
        )
    }

    /// Values by names out of a list; `form` says how they are written, `role` what a name is.
    pub fn by_known_name<T>(
        self,
        form: &str,
        role: &str,
        known: &[Key<'_>],
        read: impl Fn(&str, At<'_>) -> Option<T>,
    ) -> Option<Vec<T>> {
        let one = |entry: &Entry, findings: &Findings| {
            if known.iter().any(|(name, _)| *name == entry.key) {
                return read(&entry.key, At::Node(&entry.node, findings));
            }
            let known: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
            reader::no_such(findings, entry.key_span, role, &entry.key, &known)
        };
        self.form(
            |node, findings| match &node.value {
                Value::Mapping(entries) => reader::all(entries.iter().map(|entry| one(entry, findings))),
                _ => findings.wrong(node.span, form),
            },
            |sketch| {
                let each = known.iter().map(|(name, about)| (*name, sketch.part(about, |at| read(name, at))));
                each.fold(Object::new(sketch.about), |object, (name, schema)| object.optional(name, schema)).schema()
            },
        )
    }

    /// One of named forms: `rigid`, or `resilient: {…}`. Each name stands with what an editor says of it.
    pub fn choose<T>(
        self,
        what: &'static str,
        names: &[(&'static str, &str)],
        read: impl Fn(Choice<'_>) -> Option<T>,
    ) -> Option<T> {
        match self {
            Self::Node(node, findings) => {
                let words: Vec<&'static str> = names.iter().map(|(name, _)| *name).collect();
                read(Choice::Read(reader::Choice::read(node, what, &words, findings)?, findings))
            }
            Self::Sketch(sketch) => {
                let (mut words, mut forms) = (Vec::new(), Vec::new());
                for (name, about) in names {
                    let bare = Cell::new(false);
                    let content = Sketch { about, alternatives: RefCell::default(), definitions: sketch.definitions };
                    read(Choice::Sketch(name, &content, &bare));
                    words.extend(bare.get().then_some(*name));
                    forms.extend(content.schema().map(|content| (*name, content)));
                }
                if !words.is_empty() {
                    sketch.add(schema::one_of_words(sketch.about, &words));
                }
                if !forms.is_empty() {
                    sketch.add(Object::new(sketch.about).exactly_one(forms).schema());
                }
                None
            }
        }
    }
}
