//! The structure of a scene: read by the table of its kind, whatever structure that is.

use std::collections::BTreeMap;

use super::assumption_sheet::{Quantity, Takes};
use super::quantity::Dimension;
use super::reader::{Choice, above_zero, count, list, ratio, scalar, unknown, zero_or_more};
use super::recipe::{Given, Parameter, Slot, StructureRecipe};
use super::scene::{SceneReader, is_word};
use super::word::from_word;
use super::yaml::{Node, Value};
use crate::scene::{FieldValue, Form, KINDS, Kind};

/// Most modes that are read at all; how many a structure carries is its own affair.
pub(super) const MOST_MODES: u32 = 100_000;
/// Stands where the file says `swept`.
const PLACEHOLDER: f64 = 1.0;

/// A structure as read.
pub(super) struct ReadStructure {
    pub kind: &'static Kind,
    pub recipe: StructureRecipe,
}

/// Reads the node under `structure`.
pub(super) fn read_structure<'t>(node: &'t Node, reader: &SceneReader<'t>) -> Option<ReadStructure> {
    let findings = reader.findings;
    let names: Vec<&'static str> = KINDS.iter().map(|kind| kind.name).collect();
    let choice = Choice::read(node, "the structure", &names, findings)?;
    let kind = Kind::named(choice.name)?;
    let fields = choice.fields(kind.what, findings)?;
    let mut values = BTreeMap::new();
    let mut fine = true;
    for field in kind.fields {
        let read = |node: &'t Node| match field.swept.then(|| from_word::<Parameter>(field.key)).flatten() {
            Some(parameter) if is_word(node, "swept") => {
                reader.swept.borrow_mut().push((parameter, node.span));
                Some(Given::Stated(match field.form {
                    Form::Modes => FieldValue::Counts(vec![1]),
                    _ => FieldValue::Number(PLACEHOLDER),
                }))
            }
            _ => read_value(node, field.form, kind, reader),
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

fn read_value<'t>(
    node: &'t Node,
    form: Form,
    kind: &'static Kind,
    reader: &SceneReader<'t>,
) -> Option<Given<FieldValue>> {
    let findings = reader.findings;
    let size = |dimension: Dimension| {
        reader.given(node, Takes::quantity(dimension), |node| {
            above_zero(node, dimension, findings).map(FieldValue::Number)
        })
    };
    let modes = |node: &Node| count(node, "modes", MOST_MODES, findings);
    match form {
        Form::Length => size(Dimension::Length),
        Form::Mass => size(Dimension::Mass),
        Form::Stiffness => reader.given(node, Takes::quantity(Dimension::Stiffness), |node| {
            zero_or_more(node, Dimension::Stiffness, findings).map(FieldValue::Number)
        }),
        Form::Stress => size(Dimension::Stress),
        Form::Density => size(Dimension::Density),
        Form::Ratio => reader.given(node, Takes::ratio(), |node| ratio(node, findings).map(FieldValue::Number)),
        Form::Modes => reader.slot(node, Slot::Modes, kind, |node| {
            Some(FieldValue::Counts(match &node.value {
                Value::Sequence(_) => list(node, findings, modes)?,
                _ => vec![modes(node)?],
            }))
        }),
        Form::Word(words) => reader.given(node, Takes { quantity: None::<Quantity>, readings: words }, |node| {
            let word = scalar(node, findings)?;
            if words.contains(&word) {
                return Some(FieldValue::Word(word.into()));
            }
            unknown(findings, node.span, "this key", "word", word, words)
        }),
    }
}
