//! The structure of a scene: read by the table of its kind, whatever structure that is.

use std::collections::BTreeMap;

use super::recipe::{Given, Parameter, Quantity, Slot, StructureRecipe, Takes};
use super::scene_reader::{PLACEHOLDER, SceneReader};
use crate::scene::{FieldValue, Form, KINDS, Kind};
use crate::yaml::reader::{scalar, unknown};
use crate::yaml::schema::one_of_words;
use crate::yaml::word::from_word;
use crate::yaml::{At, Dimension};

/// Most modes that are read at all; how many a structure carries is its own affair.
const MOST_MODES: u32 = 100_000;

/// A structure as read.
pub(super) struct ReadStructure {
    pub kind: &'static Kind,
    pub recipe: StructureRecipe,
}

/// Reads what stands under `structure`.
pub(super) fn read_structure(at: At<'_>, reader: &SceneReader<'_>) -> Option<ReadStructure> {
    let names: Vec<(&'static str, &str)> = KINDS.iter().map(|kind| (kind.name, kind.what)).collect();
    at.choose("the structure", &names, |choice| {
        let kind = Kind::named(choice.name())?;
        let keys = choice.keys(kind.what)?;
        let mut values = BTreeMap::new();
        let mut fine = true;
        for field in kind.fields {
            let about = field.key.replace('_', " ");
            let read = |at: At<'_>| match field.swept.then(|| from_word::<Parameter>(field.key)).flatten() {
                Some(parameter) if reader.is_swept(at, parameter) => Some(Given::Stated(match field.form {
                    Form::Modes => FieldValue::Counts(vec![1]),
                    _ => FieldValue::Number(PLACEHOLDER),
                })),
                _ => read_value(at, field.form, kind, reader),
            };
            let value = match field.form {
                Form::Word(_) => keys.optional(field.key, &about, read),
                _ => keys.required(field.key, &about, read).map(Some),
            };
            match value {
                Some(Some(value)) => drop(values.insert(field.key.to_owned(), value)),
                Some(None) => {}
                None => fine = false,
            }
        }
        keys.close()?;
        fine.then_some(ReadStructure { kind, recipe: StructureRecipe { kind: kind.name.into(), values } })
    })
}

fn read_value(at: At<'_>, form: Form, kind: &'static Kind, reader: &SceneReader<'_>) -> Option<Given<FieldValue>> {
    let size = |dimension: Dimension| {
        reader.given(at, Takes::quantity(dimension), |at| at.above_zero(dimension).map(FieldValue::Number))
    };
    match form {
        Form::Length => size(Dimension::Length),
        Form::Mass => size(Dimension::Mass),
        Form::Stiffness => reader.given(at, Takes::quantity(Dimension::Stiffness), |at| {
            at.zero_or_more(Dimension::Stiffness).map(FieldValue::Number)
        }),
        Form::Stress => size(Dimension::Stress),
        Form::Density => size(Dimension::Density),
        Form::Ratio => reader.given(at, Takes::ratio(), |at| at.ratio().map(FieldValue::Number)),
        Form::Modes => reader.slot(at, Slot::Modes, kind, |at| {
            at.called("Number of modes, or one number a side", |at| {
                at.one_or_more(|at| at.count("modes", MOST_MODES)).map(FieldValue::Counts)
            })
        }),
        Form::Word(words) => reader.given(at, Takes { quantity: None::<Quantity>, readings: words }, |at| {
            at.form(
                |node, findings| match scalar(node, findings)? {
                    word if words.contains(&word) => Some(FieldValue::Word(word.into())),
                    word => unknown(findings, node.span, "this key", "word", word, words),
                },
                |it| one_of_words(it.about(), words),
            )
        }),
    }
}
