//! The structure of a scene: read by the table of its kind, whatever structure that is.

use std::cell::RefCell;
use std::collections::BTreeMap;

use crate::scene::{FieldValue, Form, KINDS, Kind, Parameter, StructureRecipe};

use super::diagnostic::{Findings, Span};
use super::quantity::Dimension;
use super::reader::{Choice, above_zero, count, list, ratio, scalar, unknown, zero_or_more};
use super::yaml::{Node, Value};

/// Most modes that are read at all; how many a structure carries is its own affair.
pub(super) const MOST_MODES: u32 = 100_000;
/// Stands where the file says `swept`.
const PLACEHOLDER: f64 = 1.0;

/// A structure as read.
pub(super) struct ReadStructure {
    pub kind: &'static Kind,
    pub recipe: StructureRecipe,
}

/// Reads the node under `structure`; what it says is swept goes to `swept`.
pub(super) fn read_structure(
    node: &Node,
    findings: &Findings,
    swept: &RefCell<Vec<(Parameter, Span)>>,
) -> Option<ReadStructure> {
    let names: Vec<&'static str> = KINDS.iter().map(|kind| kind.name).collect();
    let choice = Choice::read(node, "the structure", &names, findings)?;
    let kind = KINDS.iter().find(|kind| kind.name == choice.name)?;
    let fields = choice.fields(kind.what, findings)?;
    let mut values = BTreeMap::new();
    let mut fine = true;
    for field in kind.fields {
        let read = |node: &Node| match (&node.value, field.parameter) {
            (Value::Scalar(word), Some(parameter)) if word == "swept" => {
                swept.borrow_mut().push((parameter, node.span));
                Some(match field.form {
                    Form::Modes(_) => FieldValue::Counts(vec![1]),
                    _ => FieldValue::Number(PLACEHOLDER),
                })
            }
            _ => read_value(node, field.form, findings),
        };
        let value = match field.form {
            Form::Word(_) => fields.optional(field.key, read),
            _ => fields.required(field.key, read).map(Some),
        };
        match value {
            Some(Some(value)) => drop(values.insert(field.key.to_owned(), value)),
            Some(None) => {}
            None => fine = false,
        }
    }
    fields.close()?;
    fine.then_some(ReadStructure { kind, recipe: StructureRecipe { kind: kind.name.into(), values } })
}

fn read_value(node: &Node, form: Form, findings: &Findings) -> Option<FieldValue> {
    let size = |dimension| above_zero(node, dimension, findings).map(FieldValue::Number);
    match form {
        Form::Length => size(Dimension::Length),
        Form::Mass => size(Dimension::Mass),
        Form::Stiffness => zero_or_more(node, Dimension::Stiffness, findings).map(FieldValue::Number),
        Form::Stress => size(Dimension::Stress),
        Form::Density => size(Dimension::Density),
        Form::Ratio => ratio(node, findings).map(FieldValue::Number),
        Form::Modes(assumption) => match &node.value {
            Value::Scalar(word) if word == "assumed" => Some(FieldValue::Assumed(assumption)),
            Value::Sequence(_) => {
                list(node, findings, |node| count(node, "modes", MOST_MODES, findings)).map(FieldValue::Counts)
            }
            _ => count(node, "modes", MOST_MODES, findings).map(|count| FieldValue::Counts(vec![count])),
        },
        Form::Word(words) => {
            let word = scalar(node, findings)?;
            if words.contains(&word) {
                return Some(FieldValue::Word(word.into()));
            }
            unknown(findings, node.span, "this key", "word", word, words)
        }
    }
}
