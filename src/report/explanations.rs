//! What is known of the sensitivity of an entry, gathered for the report.

use std::collections::{BTreeMap, BTreeSet};

use super::verdicts::Judgement;
use crate::experiment::{AssumptionEntry, AssumptionName, AssumptionValue, Tried};
use crate::reference::{Check, Entry, Judged, Moved};
use crate::report::{self, EntryView, MoveView};
use crate::study::{Item, Study, Variant};

/// An assumption that was moved for an entry alone.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// Which.
    pub name: AssumptionName,
    /// The value that it was moved to.
    pub to: AssumptionValue,
    /// What came out then.
    pub moved: Moved,
}

/// The explanation of each entry whose id `wanted` admits, in their order. `trials` holds by entry what was tried beyond the
/// tables on disk.
#[must_use]
pub fn explanations(
    study: &Study,
    judgement: &Judgement,
    trials: &BTreeMap<String, Vec<Trial>>,
    wanted: impl Fn(&str) -> bool,
) -> Vec<String> {
    let mut texts = Vec::new();
    for (experiment, judged) in &judgement.verdicts {
        let item = study.items.iter().find(|item| item.source.experiment.id.0 == *experiment);
        let entries = judged.iter().filter(|judged| wanted(&judged.id));
        texts.extend(entries.map(|judged| report::explain(&view(study, item, judged, trials))));
    }
    texts
}

/// The moves of assumptions that an entry depends on and that the tables on disk do not hold: to every value of their ranges, and
/// to every value that a calibration tries.
#[must_use]
pub fn untried(study: &Study, judged: &Judged) -> Vec<(AssumptionName, AssumptionValue)> {
    let Some(entry) = entry(study, judged) else { return Vec::new() };
    let read: BTreeSet<String> = entry.readings(&judged.experiment).into_iter().map(|one| one.experiment).collect();
    let items = || study.items.iter().filter(|item| read.contains(&item.source.experiment.id.0));
    let used: BTreeSet<&AssumptionName> = items().flat_map(|item| &item.used).collect();
    let known = |name: &AssumptionName, value: &AssumptionValue| {
        let own = study.items.iter().filter(|item| item.source.experiment.id.0 == judged.experiment);
        own.flat_map(|item| &item.variants).any(|variant| {
            variant.moved.as_ref() == Some(name)
                && variant.assumptions.values.get(name) == Some(value)
                && judged.moved.iter().any(|moved| moved.variant == variant.label)
        })
    };
    let mut moves: Vec<(AssumptionName, AssumptionValue)> = Vec::new();
    for (name, assumption) in study.sheet.iter().filter(|(name, _)| used.contains(name)) {
        let calibrated = study.calibrations.values().flat_map(|calibration| &calibration.inputs);
        let calibrated = calibrated.flat_map(|input| match &input.tried {
            Tried::Values { moves, values, .. } if moves.as_slice() == std::slice::from_ref(name) => {
                values.iter().flatten().collect()
            }
            _ => Vec::new(),
        });
        for value in assumption.range.iter().chain(calibrated) {
            let new = (name.clone(), value.clone());
            if *value != assumption.value && !known(name, value) && !moves.contains(&new) {
                moves.push(new);
            }
        }
    }
    moves
}

/// The entry of the reference that was judged.
#[must_use]
pub fn entry<'a>(study: &'a Study, judged: &Judged) -> Option<&'a Entry> {
    study.references.get(&judged.experiment)?.entries.iter().find(|entry| entry.id == judged.id)
}

fn view<'a>(
    study: &'a Study,
    item: Option<&'a Item>,
    judged: &'a Judged,
    trials: &'a BTreeMap<String, Vec<Trial>>,
) -> EntryView<'a> {
    let variants: &[Variant] = item.map_or(&[], |item| &item.variants);
    let mut moves: Vec<MoveView<'_>> = judged
        .moved
        .iter()
        .filter_map(|moved| {
            let variant = variants.iter().find(|variant| variant.label == moved.variant)?;
            let name = variant.moved.as_ref()?;
            let entry = study.sheet.get(name)?;
            let to = variant.assumptions.values.get(name)?;
            Some(MoveView { name, unit: entry.kind.unit(), from: &entry.value, to, moved })
        })
        .collect();
    let tried = trials.get(&judged.id).into_iter().flatten();
    moves.extend(tried.filter_map(|trial| {
        let entry = study.sheet.get(&trial.name)?;
        let (name, unit) = (&trial.name, entry.kind.unit());
        Some(MoveView { name, unit, from: &entry.value, to: &trial.to, moved: &trial.moved })
    }));
    let used = |name: &AssumptionName| item.is_some_and(|item| item.used.contains(name));
    let names = |wanted: &dyn Fn(&AssumptionName, &AssumptionEntry) -> bool| -> Vec<AssumptionName> {
        study.sheet.iter().filter(|(name, entry)| wanted(name, entry)).map(|(name, _)| name.clone()).collect()
    };
    let unmoved = names(&|name, _| used(name) && moves.iter().all(|one| one.name != name));
    let chosen_by = names(&|_, entry| entry.fitted_to.contains(&judged.id));
    let printed = entry(study, judged).and_then(|entry| match &entry.check {
        Check::Value { published, .. } => Some(published),
        _ => None,
    });
    EntryView { judged, printed, moves, unmoved, chosen_by }
}
