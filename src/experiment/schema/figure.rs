//! Figures and maps.

use serde_json::{Value, json};

use super::parts::{
    Object, any_of, between, boolean, count, list, number, one_of_words, one_or_more, reference, text, words_of,
};
use super::sweep::NAME;
use crate::experiment::continuation::BranchColumn;
use crate::experiment::definition::{AxisScale, Best, Strip};
use crate::experiment::recipe::Parameter;
use crate::experiment::starts::{BasinColumn, START_LISTS};
use crate::experiment::word::words;
use crate::measure::{CycleValue, Measure, energy_columns, trace_columns};

/// The definitions that figures share.
pub(super) fn definitions() -> Vec<(String, Value)> {
    // Offered for completion; which columns there are depends on the rest of the file.
    let mut known: Vec<&str> = words::<Parameter>().to_vec();
    known.extend(words::<Measure>());
    known.extend(trace_columns());
    known.extend(energy_columns());
    known.extend(words::<CycleValue>());
    known.extend(["sweep", "direction", "solver", "variant", "candidate"]);
    known.extend(BranchColumn::ALL.map(BranchColumn::name));
    known.extend(BasinColumn::ALL.map(BasinColumn::name));
    known.extend(START_LISTS.map(|(name, _)| name));
    let mut offered: Vec<&str> = Vec::new();
    for name in known {
        if !offered.contains(&name) {
            offered.push(name);
        }
    }
    let column = any_of(
        "A column of the table",
        vec![json!({"enum": offered}), json!({"type": "string", "pattern": "^[a-z][a-z0-9_]*$"})],
    );
    let reach = json!({
        "description": "From one number to a larger one",
        "type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2,
    });
    let axis = Object::new("An axis")
        .required("column", reference("column"))
        .optional("label", text("Its label, in place of the column's own words"))
        .optional("scale", words_of::<AxisScale>("Its scale"))
        .optional("reach", reach);
    let axis = any_of("A column, or {column, scale, label, reach}", vec![reference("column"), axis.schema()]);
    vec![("column".into(), column), ("axis".into(), axis), ("figure".into(), figure())]
}

/// What a band shows.
const BAND: &str = "spread: standard deviation of the ensemble; seeds: least to largest of searches that differ in their seed; stacked: each \
     line stands on the one before, and the space between is filled";

fn shared(object: Object) -> Object {
    object
        .optional("x", reference("axis"))
        .optional("by", one_or_more("Columns that split rows into lines", reference("column")))
        .optional("band", one_of_words(BAND, &["spread", "none", "seeds", "stacked"]))
        .optional("markers", boolean("A mark at each point"))
}

fn own(object: Object) -> Object {
    let guide =
        Object::new("A level drawn across").required("at", number("Where")).optional("label", text("Its label"));
    let peaks = Object::new("Peaks that are marked")
        .optional("prominence", json!({"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1}))
        .optional("most", count("Peaks at most", "peaks", 0, 50));
    object
        .optional("y", one_or_more("What is drawn", reference("axis")))
        .optional("over_first", boolean("Each line over the first one"))
        .optional("guides", list("Levels", guide.schema()))
        .optional("peaks", peaks.schema())
        .optional("strip", words_of::<Strip>("What a strip below the frame shows along the x axis"))
}

fn figure() -> Value {
    let mut panel = own(shared(Object::new("A panel"))).schema();
    panel["required"] = json!(["y"]);
    let name =
        json!({"description": "Name of the file after the id; none for the first", "type": "string", "pattern": NAME});
    let only = Object::new("The rows to draw")
        .required("column", reference("column"))
        .required("words", one_or_more("The column's words that count", text("A word")));
    let animation = Object::new("The motion of damper and particle from the trace, slowed down")
        .optional("by", one_or_more("A row for each", reference("column")));
    own(shared(Object::new("A figure")))
        .optional("name", name)
        .required("caption", text("One line under it"))
        .optional("only", only.schema())
        .optional("panels", list("Panels above each other", panel))
        .optional("map", map())
        .optional("gaps", boolean("The gaps of an optimised array as bars"))
        .optional("animation", animation.schema())
        .rule(json!({
            "if": {"anyOf": [{"required": ["map"]}, {"required": ["gaps"]}, {"required": ["animation"]}]},
            "then": {"propertyNames": {"enum": ["name", "caption", "only", "map", "gaps", "animation"]}},
            "else": {"anyOf": [{"required": ["panels"]}, {"required": ["x", "y"]}]},
        }))
        .schema()
}

fn map() -> Value {
    let mark = Object::new("A place that is marked")
        .required("x", reference("column"))
        .required("y", reference("column"))
        .required("label", text("What is there"));
    Object::new("Colours over two columns")
        .required("x", reference("axis"))
        .required("y", reference("axis"))
        .required("value", reference("axis"))
        .optional("by", one_or_more("A panel for each", reference("column")))
        .optional("mark", mark.schema())
        .optional("best", words_of::<Best>("The place to mark and to name"))
        .optional("centre", number("The value of the middle of the colours"))
        .optional("aspect", between("Height of a panel over its width", 0.1, 10.0))
        .optional("columns", count("Panels side by side", "panels", 1, 6))
        .schema()
}
