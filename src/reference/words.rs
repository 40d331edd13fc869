//! What an extraction takes out of a table, in words: a bare number beside a claim does not say what it is.

use super::extraction::{Extraction, NearestPassage};
use super::resonance::Feature;
use super::selection::Allowed;
use super::text::{symbol, with_unit};
use crate::measure::column_words;
use crate::text::words;

impl Extraction {
    /// `mean velocity ratio`; nothing for a fixed number, where it would take a sentence, and where a figure in the words, as in
    /// `gap 1`, would be taken for the number.
    pub(crate) fn in_words(&self) -> Option<String> {
        self.words().filter(|words| !words.contains(|c: char| c.is_ascii_digit()))
    }

    fn words(&self) -> Option<String> {
        let of = |how: &str, column: &str| Some(format!("{how}{}", column_words(column)));
        match self {
            Self::Cell(word) => of("", &word.of),
            Self::Mean(word) => of("mean ", &word.of),
            Self::MeanOver(word) => of("mean ", &word.of),
            Self::StandardDeviationOver(word) => of("standard deviation of the ", &word.of),
            Self::Maximum(word) => of("largest ", &word.of),
            Self::Largest(word) => of("largest ", &word.of),
            Self::NearestPassage(NearestPassage { read: Some(read), .. }) => of("", read),
            Self::PathMaximum(word) => of("largest ", &word.of),
            Self::PathMinimum(word) => of("smallest ", &word.of),
            Self::Minimum(word) => of("smallest ", &word.of),
            Self::Smallest(word) => of("smallest ", &word.of),
            Self::Argmax(word) => Some(format!("{} of the largest {}", symbol(&word.over), column_words(&word.of))),
            Self::Argmin(word) => Some(format!("{} of the smallest {}", symbol(&word.over), column_words(&word.of))),
            Self::AtMaximum(word) => of("", &word.read),
            Self::End(word) => of("", &word.of),
            Self::Interpolated(word) => of("", &word.of),
            Self::Peak(peak) => match peak.read {
                Feature::Place => of("peak of the ", &peak.of),
                Feature::Height => of("peak ", &peak.of),
                Feature::HalfPowerWidth => Some("half-power width".into()),
            },
            Self::Number(_)
            | Self::Crossing(_)
            | Self::FirstAbove(_)
            | Self::Parting(_)
            | Self::Meeting(_)
            | Self::LargestStepBack(_)
            | Self::LargestLead(_)
            | Self::ArgmaxLead(_)
            | Self::Difference(_)
            | Self::NearestPassage(_)
            | Self::Ratio(_)
            | Self::Times(_) => None,
        }
    }
}

/// What all of these are, where they are the same; with the space that follows.
pub(crate) fn common(values: &[Extraction]) -> Option<String> {
    let mut all = values.iter().map(Extraction::in_words);
    let first = all.next()??;
    all.all(|other| other.as_ref() == Some(&first)).then(|| format!("{first} "))
}

/// A level of a column for a reader: `point 1`, `10 ms`.
pub(crate) fn of_level(column: &str, level: &Allowed, unit: &str) -> String {
    match level {
        Allowed::Number(x) => with_unit(*x, 12, unit),
        Allowed::Text(text) => words::of_level(column, text),
        other => other.to_string(),
    }
}
