//! Sweeps and ranges.

use serde_json::{Value, json};

use super::parts::{
    Object, any_of, count, form, list, one_of_words, one_or_more, quantity, ratio, reference, word, words_of,
};
use crate::experiment::continued::{Direction, RowStart};
use crate::experiment::definition::AxisScale;
use crate::experiment::range::MOST_POINTS;
use crate::experiment::recipe::{Parameter, Takes};
use crate::experiment::refined;
use crate::experiment::sweep::NAME;
use crate::experiment::word::{from_word, word_of, words};

/// The definitions that sweeps share.
pub(in crate::experiment) fn definitions() -> Vec<(String, Value)> {
    let percent = json!({"type": "string", "pattern": r"^\s*[0-9.]+\s*%\s*$"});
    let share = any_of(
        "A share, for example 1 %",
        vec![percent, json!({"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1})],
    );
    let mut definitions: Vec<(String, Value)> = vec![
        ("share".into(), share),
        ("sweep".into(), sweep()),
        ("named_sweep".into(), product(true)),
        ("point".into(), point()),
        ("paired".into(), paired()),
    ];
    // Most parameters take the same values: one definition for all that do.
    for (_, parameter) in parameters() {
        let kind = Values::of(parameter);
        if definitions.iter().all(|(name, _)| *name != kind.one()) {
            definitions.extend([
                (kind.one(), kind.value()),
                (kind.fixed(), kind.values(false)),
                (kind.any(), kind.values(true)),
                (kind.along(), kind.followed()),
            ]);
        }
    }
    definitions
}

/// A sweep: a product of its keys, or a union of named ones.
fn sweep() -> Value {
    let union = json!({
        "description": "Named sweeps joined",
        "type": "object",
        "minProperties": 1,
        "propertyNames": {"pattern": NAME},
        "additionalProperties": reference("named_sweep"),
    });
    let mut all = product(false);
    all["properties"]["union"] = union;
    all["if"] = json!({"required": ["union"]});
    all["then"] = json!({"maxProperties": 1});
    all
}

fn product(within_union: bool) -> Value {
    let mut object = by_parameter("What varies: the product of its keys", parameters(), Values::any)
        .optional("paired", reference("paired"))
        .optional("points", list("Points one by one", reference("point")))
        .optional("along", words_of::<Parameter>("The parameter that runs from row to row"))
        .optional(
            "direction",
            one_or_more("Upwards, downwards, or both", words_of::<Direction>("Up, or down")),
        )
        .optional("from", words_of::<RowStart>("Each row starts where the row before ended"))
        .rule(json!({"if": {"anyOf": [{"required": ["along"]}, {"required": ["direction"]}]}, "then": {"required": ["from"]}}));
    if within_union {
        object = object.optional("solver", one_or_more("Solvers of this sweep", reference("solver")));
    }
    not_empty(object)
}

fn point() -> Value {
    not_empty(by_parameter("A point", parameters(), Values::one))
}

fn paired() -> Value {
    not_empty(by_parameter("Ranges of equal length that go in step", parameters(), Values::fixed))
}

fn by_parameter(
    about: &str,
    parameters: impl Iterator<Item = (&'static str, Parameter)>,
    definition: impl Fn(Values) -> String,
) -> Object {
    parameters.fold(Object::new(about), |object, (name, parameter)| {
        let values = reference(&definition(Values::of(parameter)));
        // Beside a reference a description would not count.
        object.optional(name, json!({"description": describe(name), "allOf": [values]}))
    })
}

fn not_empty(object: Object) -> Value {
    let mut schema = object.schema();
    schema["minProperties"] = json!(1);
    schema
}

fn parameters() -> impl Iterator<Item = (&'static str, Parameter)> {
    words::<Parameter>().iter().filter_map(|name| Some((*name, from_word::<Parameter>(name)?)))
}

/// `force_ratio: dimensionless forcing amplitude`.
fn describe(name: &str) -> String {
    format!("{name}: {}", crate::text::words::of_column(name))
}

/// The definitions that values of one kind have: of one, of fixed ones, and of those that may be refined.
#[derive(Clone, Copy)]
struct Values(Takes);

impl Values {
    fn of(parameter: Parameter) -> Self {
        Self(parameter.takes())
    }

    /// The name of the definition of one value.
    fn one(self) -> String {
        match self.0 {
            Takes::Words(words) => words.iter().map(|word| word_of(*word)).collect::<Vec<_>>().join("_or_"),
            Takes::Quantity(dimension) => dimension.name().replace(' ', "_"),
            Takes::Ratio => "a_ratio".into(),
            Takes::RatioOrInfinite => "a_ratio_or_infinite".into(),
        }
    }

    /// Of fixed values.
    fn fixed(self) -> String {
        format!("values_{}", self.one())
    }

    /// Of values that may also be refined.
    fn any(self) -> String {
        format!("swept_{}", self.one())
    }

    /// Of the range that a branch is followed in.
    fn along(self) -> String {
        format!("along_{}", self.one())
    }

    fn followed(self) -> Value {
        let size = self.number();
        Object::new("Its range")
            .required("from", size.clone())
            .required("to", size)
            .optional("spacing", words_of::<AxisScale>("The scale on which steps are equal"))
            .schema()
    }

    fn value(self) -> Value {
        match self.0 {
            Takes::Words(words) => {
                one_of_words("One of these", &words.iter().map(|word| word_of(*word)).collect::<Vec<_>>())
            }
            Takes::RatioOrInfinite => any_of("A ratio, or infinite", vec![ratio("A ratio"), word("infinite")]),
            Takes::Quantity(dimension) => quantity("A value", dimension),
            Takes::Ratio => ratio("A ratio"),
        }
    }

    /// One that is a number, by reference.
    fn number(self) -> Value {
        match self.0 {
            Takes::RatioOrInfinite => reference(&Self(Takes::Ratio).one()),
            _ => reference(&self.one()),
        }
    }

    /// One value, a range, or a list of both.
    fn values(self, may_be_refined: bool) -> Value {
        let about = "A value, a range, or a list of both";
        let mut forms = vec![reference(&self.one())];
        let is_number = !matches!(self.0, Takes::Words(_));
        if is_number {
            forms.push(range(&self.number()));
        }
        let item = any_of("A value or a range", forms.clone());
        if is_number && may_be_refined {
            forms.push(refined(&self.number()));
        }
        forms.push(list(about, item));
        any_of(about, forms)
    }
}

fn range(size: &Value) -> Value {
    let ends = |about: &str| Object::new(about).required("from", size.clone()).required("to", size.clone());
    let points = || count("Number of points", "points", 2, MOST_POINTS);
    Object::new("A range")
        .exactly_one(vec![
            ("linear", ends("Evenly spaced points").required("points", points()).schema()),
            ("log", ends("Points evenly spaced in the logarithm").required("points", points()).schema()),
            ("step", ends("Points a step apart").required("step", size.clone()).schema()),
        ])
        .schema()
}

fn refined(size: &Value) -> Value {
    let points = |about| count(about, "points", 5, refined::MOST_POINTS);
    let object = Object::new("A range that gets more points where a curve bends")
        .required("from", size.clone())
        .required("to", size.clone())
        .optional("start", points("Points to start with"))
        .optional("most", points("Points at most"))
        .optional("tolerance", reference("share"))
        .optional("spacing", words_of::<AxisScale>("Spacing of the first points"))
        .optional("value_scale", words_of::<AxisScale>("Scale on which the curve is looked at"))
        .optional("of", one_or_more("Measures whose curve is looked at", reference("measure")));
    form("refined", "A refined range", object.schema())
}

/// The parameter that a branch is followed along, with its range.
pub(in crate::experiment) fn followed() -> Value {
    let smooth = parameters().filter(|(_, parameter)| parameter.varies_smoothly());
    let mut schema = not_empty(by_parameter("The parameter, and its range", smooth, Values::along));
    schema["maxProperties"] = json!(1);
    schema
}

/// The points of a maximisation over any parameter.
pub(in crate::experiment) fn any_range() -> Value {
    let any = json!({"type": ["number", "string"]});
    let range = range(&any);
    let item = any_of("A value or a range", vec![any.clone(), range.clone()]);
    any_of("Increasing points", vec![range, any, list("Values and ranges", item)])
}
