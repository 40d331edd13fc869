//! What an experiment measures: the measures that are named, and those that come with them.

use crate::measure::Measure;
use crate::yaml::word::word_of;
use crate::yaml::{At, Span};

/// Measures, each with its companions, and where they stand; none of them twice.
pub(super) fn read_measures(at: At<'_>) -> Option<Vec<(Measure, Span)>> {
    let measures = at.one_or_more(|at| Some((read_measure(at)?, at.span())))?;
    for (index, (measure, span)) in measures.iter().enumerate() {
        if measures[..index].iter().any(|(other, _)| other == measure) {
            return at.wrong_at(*span, format!("`{}` is measured twice", word_of(*measure)));
        }
    }
    let mut all = Vec::with_capacity(measures.len());
    for (measure, span) in &measures {
        all.push((*measure, *span));
        let named = |companion: &Measure| measures.iter().any(|(other, _)| other == companion);
        all.extend(measure.companions().filter(|companion| !named(companion)).map(|companion| (companion, *span)));
    }
    Some(all)
}

/// The word of a measure.
pub(super) fn read_measure(at: At<'_>) -> Option<Measure> {
    at.named("measure", "A number that is measured", |at| at.word::<Measure>("measure"))
}

/// Adds the measures that come with something, where it stands, unless they are asked for already.
pub(super) fn bring(measures: &mut Vec<(Measure, Span)>, at: Option<Span>, others: impl Iterator<Item = Measure>) {
    let Some(at) = at else { return };
    for measure in others {
        if measures.iter().all(|(known, _)| *known != measure) {
            measures.push((measure, at));
        }
    }
}
