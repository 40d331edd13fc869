//! The finding of a calibration: prose with numbers of its result, which may be others when it is run again.
//!
//! | in the text | on the page |
//! |---|---|
//! | `{best}`, `{in force}` | the least residual, and that of the inputs in force |
//! | `{fitted}`, `{fitted in force}` | how many of the fitted entries are reproduced with these: `1 of 8` |
//! | `{held out}`, `{held out in force}` | how many of those held out |
//! | `{INPUT: VALUE}` | the least residual with this value, as the table of inputs has them |

use super::calibration_input::CalibrationInput;
use crate::text::braces::{Part, Unclosed, parts};

/// A finding, taken apart; empty before there is one.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FindingText {
    pieces: Vec<Piece>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Piece {
    Text(String),
    Number(FindingNumber),
}

/// A number that a finding quotes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FindingNumber {
    /// The residual of these inputs.
    Residual(InputSet),
    /// How many fitted entries these inputs reproduce.
    Fitted(InputSet),
    /// How many of those held out.
    HeldOut(InputSet),
    /// The least residual with one value of one input.
    With {
        /// Which input of the calibration, from 0.
        input: usize,
        /// Which of its values, from 0.
        value: usize,
    },
}

/// A set of inputs that a result is given for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InputSet {
    /// The one with the least residual.
    Best,
    /// The one in force.
    InForce,
}

/// What a finding may quote of every calibration.
const NUMBERS: [(&str, FindingNumber); 6] = [
    ("best", FindingNumber::Residual(InputSet::Best)),
    ("in force", FindingNumber::Residual(InputSet::InForce)),
    ("fitted", FindingNumber::Fitted(InputSet::Best)),
    ("fitted in force", FindingNumber::Fitted(InputSet::InForce)),
    ("held out", FindingNumber::HeldOut(InputSet::Best)),
    ("held out in force", FindingNumber::HeldOut(InputSet::InForce)),
];

/// Why a text is no finding.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FindingError {
    /// No `}`.
    #[error("{0}")]
    Unclosed(#[from] Unclosed),
    /// A name that this calibration has no number for.
    #[error("the unknown placeholder `{{{name}}}`: write one of {known}")]
    Unknown {
        /// What stands in braces.
        name: String,
        /// What may.
        known: String,
    },
}

impl FindingText {
    /// Reads the finding of a calibration of these inputs.
    ///
    /// # Errors
    /// The first placeholder that is none.
    pub fn parse(text: &str, inputs: &[CalibrationInput]) -> Result<Self, FindingError> {
        let piece = |part| match part {
            Part::Text(text) => Ok(Piece::Text(text.into())),
            Part::Placeholder(name) => FindingNumber::parse(name, inputs).map(Piece::Number),
        };
        Ok(Self { pieces: parts(text)?.into_iter().map(piece).collect::<Result<_, _>>()? })
    }

    /// True before there is one.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// The text with its numbers.
    #[must_use]
    pub fn filled(&self, number: impl Fn(FindingNumber) -> String) -> String {
        let piece = |piece: &Piece| match piece {
            Piece::Text(text) => text.clone(),
            Piece::Number(one) => number(*one),
        };
        self.pieces.iter().map(piece).collect()
    }
}

impl FindingNumber {
    fn parse(name: &str, inputs: &[CalibrationInput]) -> Result<Self, FindingError> {
        if let Some((_, number)) = NUMBERS.iter().find(|(known, _)| *known == name) {
            return Ok(*number);
        }
        let wanted = name.split_once(": ").and_then(|(of, value)| {
            let input = inputs.iter().position(|known| known.name == of)?;
            Some((input, letters(value)))
        });
        let Some((input, wanted)) = wanted else {
            let fixed = NUMBERS.iter().map(|(known, _)| format!("`{{{known}}}`"));
            let values = inputs.iter().flat_map(|one| (0..one.tried.count()).map(|value| with(one, value)));
            return Err(FindingError::Unknown { name: name.into(), known: listed(fixed.chain(values)) });
        };
        let of = &inputs[input];
        let values = 0..of.tried.count();
        match values.clone().find(|&value| letters(&of.tried.in_words(value)) == wanted) {
            Some(value) => Ok(Self::With { input, value }),
            None => {
                Err(FindingError::Unknown { name: name.into(), known: listed(values.map(|value| with(of, value))) })
            }
        }
    }
}

/// The placeholder of a value.
fn with(input: &CalibrationInput, value: usize) -> String {
    format!("`{{{}: {}}}`", input.name, input.tried.in_words(value))
}

fn listed(all: impl Iterator<Item = String>) -> String {
    all.collect::<Vec<_>>().join(", ")
}

/// Groups of digits are parted by spaces of their own.
fn letters(text: &str) -> String {
    text.split_whitespace().collect()
}
