//! The building blocks of the schemas; each mirrors a reader of the same name.

use serde::de::DeserializeOwned;
use serde_json::{Map, Value, json};

use super::quantity::Dimension;
use super::word::words;

/// A number as people write it.
pub(crate) const NUMBER: &str = r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?";
/// Prefixes of units.
pub(crate) const PREFIX: &str = "[nuµμmckMG]?";

/// A mapping: its keys, which must be there, and which exclude each other.
pub(crate) struct Object {
    about: String,
    properties: Map<String, Value>,
    required: Vec<String>,
    rules: Vec<Value>,
}

impl Object {
    pub(crate) fn new(about: &str) -> Self {
        Self { about: about.into(), properties: Map::new(), required: Vec::new(), rules: Vec::new() }
    }

    /// A key that may be absent.
    pub(crate) fn add(&mut self, key: &str, schema: Value) {
        self.properties.insert(key.into(), schema);
    }

    /// A key that must be there.
    pub(crate) fn require(&mut self, key: &str, schema: Value) {
        self.required.push(key.into());
        self.add(key, schema);
    }

    /// One of these keys must be there, and no other.
    pub(crate) fn demand_one(&mut self, keys: &[&str]) {
        match keys {
            [only] => self.required.push((*only).into()),
            _ => {
                let one: Vec<Value> = keys.iter().map(|key| json!({"required": [key]})).collect();
                self.add_rule(json!({"oneOf": one}));
            }
        }
    }

    /// No two of these keys.
    pub(crate) fn exclude(&mut self, keys: &[&str]) {
        for (index, one) in keys.iter().enumerate() {
            for other in &keys[index + 1..] {
                self.add_rule(json!({"not": {"required": [one, other]}}));
            }
        }
    }

    /// Whatever else holds of it.
    pub(crate) fn add_rule(&mut self, rule: Value) {
        self.rules.push(rule);
    }

    pub(crate) fn optional(mut self, key: &str, schema: Value) -> Self {
        self.add(key, schema);
        self
    }

    pub(crate) fn required(mut self, key: &str, schema: Value) -> Self {
        self.require(key, schema);
        self
    }

    /// Exactly one of these keys.
    pub(crate) fn exactly_one(mut self, keys: Vec<(&str, Value)>) -> Self {
        self.demand_one(&keys.iter().map(|(key, _)| *key).collect::<Vec<_>>());
        keys.into_iter().fold(self, |object, (key, schema)| object.optional(key, schema))
    }

    pub(crate) fn schema(self) -> Value {
        let mut schema = json!({
            "type": "object",
            "description": self.about,
            "properties": self.properties,
            "additionalProperties": false,
        });
        if !self.required.is_empty() {
            schema["required"] = json!(self.required);
        }
        if !self.rules.is_empty() {
            schema["allOf"] = json!(self.rules);
        }
        schema
    }
}

/// Exactly one of these keys.
pub(crate) fn one_of_keys<'k>(about: &str, keys: impl Iterator<Item = (&'k str, Value)>) -> Value {
    let mut schema = keys.fold(Object::new(about), |object, (key, schema)| object.optional(key, schema)).schema();
    schema["minProperties"] = json!(1);
    schema["maxProperties"] = json!(1);
    schema
}

/// `{name: schema}`.
pub(crate) fn form(name: &str, about: &str, schema: Value) -> Value {
    Object::new(about).required(name, schema).schema()
}

/// One of these; the description is for an editor's hover.
pub(crate) fn any_of(about: &str, forms: Vec<Value>) -> Value {
    json!({"description": about, "anyOf": forms})
}

pub(crate) fn reference(name: &str) -> Value {
    json!({"$ref": format!("#/definitions/{name}")})
}

pub(crate) fn word(word: &str) -> Value {
    json!({"const": word})
}

pub(crate) fn one_of_words<S: AsRef<str>>(about: &str, words: &[S]) -> Value {
    let words: Vec<&str> = words.iter().map(AsRef::as_ref).collect();
    json!({"description": about, "enum": words})
}

/// The words of an enum.
pub(crate) fn words_of<T: DeserializeOwned>(about: &str) -> Value {
    one_of_words(about, words::<T>())
}

/// A text; a section such as 3.6 is one, though YAML reads a number.
pub(crate) fn text(about: &str) -> Value {
    json!({"description": about, "type": ["string", "number"], "minLength": 1})
}

pub(crate) fn boolean(about: &str) -> Value {
    json!({"description": about, "type": "boolean"})
}

pub(crate) fn number(about: &str) -> Value {
    json!({"description": about, "type": "number"})
}

/// A number alone, or with a unit where there may be one.
pub(crate) fn number_with_unit(about: &str, unit: Option<&str>) -> Value {
    if unit == Some("") {
        return number(about);
    }
    let pattern = format!(r"^\s*{NUMBER}\s*{PREFIX}[A-Za-z].*$");
    json!({"description": about, "type": ["number", "string"], "pattern": pattern})
}

/// A fraction that is not the whole.
pub(crate) fn fraction(about: &str) -> Value {
    json!({"description": about, "type": "number", "minimum": 0, "exclusiveMaximum": 1})
}

pub(crate) fn ratio(about: &str) -> Value {
    json!({"description": about, "type": "number", "minimum": 0})
}

pub(crate) fn between(about: &str, low: f64, high: f64) -> Value {
    json!({"description": about, "type": "number", "minimum": low, "maximum": high})
}

/// A share that is neither nothing nor the whole.
pub(crate) fn inner_share(about: &str) -> Value {
    json!({"description": about, "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1})
}

/// A whole number, alone or with its noun.
pub(crate) fn count(about: &str, noun: &str, least: u32, most: u32) -> Value {
    let whole = json!({"type": "integer", "minimum": least, "maximum": most});
    if noun.is_empty() {
        return json!({"description": about, "type": "integer", "minimum": least, "maximum": most});
    }
    let singular = noun.strip_suffix('s').unwrap_or(noun);
    let pattern = format!(r"^\s*\d+\s*({noun}|{singular})?\s*$");
    let with_noun = json!({"type": "string", "pattern": pattern, "examples": [format!("25 {noun}")]});
    any_of(&format!("{about}: 25, or 25 {noun}"), vec![with_noun, whole])
}

/// A number with a unit of this kind.
pub(crate) fn quantity(about: &str, dimension: Dimension) -> Value {
    let pattern = format!(r"^\s*{NUMBER}\s*({})\s*$", units(dimension));
    let example = dimension.example().split(" or ").next().unwrap_or_default();
    json!({
        "description": format!("{about}: {}, for example {}", dimension.name(), dimension.example()),
        "type": "string",
        "pattern": pattern,
        "examples": [example],
    })
}

/// The units of a dimension as people write them, each with any prefix.
fn units(dimension: Dimension) -> String {
    let unit = |symbol: &str| format!("{PREFIX}{symbol}");
    let (metre, gram, second, newton) = (unit("m"), unit("g"), unit("s"), unit("N"));
    let times = r"\s*[ *·]\s*";
    let (square, cube) = (r"(\^2|²)", r"(\^3|³)");
    match dimension {
        Dimension::Length => metre,
        Dimension::Mass => gram,
        Dimension::Time => second,
        Dimension::Force => format!("{newton}|{gram}{times}{metre}/{second}{square}"),
        Dimension::Impulse => format!("{newton}{times}{second}|{gram}{times}{metre}/{second}"),
        Dimension::Stiffness => format!("{newton}/{metre}|{gram}/{second}{square}"),
        Dimension::Damping => format!("{newton}{times}{second}/{metre}|{gram}/{second}"),
        Dimension::Velocity => format!("{metre}/{second}"),
        Dimension::Acceleration => format!("{metre}/{second}{square}"),
        Dimension::AngularFrequency => format!("{}/{second}|{}", unit("rad"), unit("Hz")),
        Dimension::Stress => format!("{}|{newton}/{metre}{square}", unit("Pa")),
        Dimension::Density => format!("{gram}/{metre}{cube}"),
    }
}

/// Items of one kind, one at least.
pub(crate) fn list(about: &str, item: Value) -> Value {
    json!({"description": about, "type": "array", "items": item, "minItems": 1})
}

/// One, or a list.
pub(crate) fn one_or_more(about: &str, item: Value) -> Value {
    any_of(about, vec![item.clone(), json!({"type": "array", "items": item, "minItems": 1})])
}
