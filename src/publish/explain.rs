//! What is known of the sensitivity of an entry, gathered for the report.

use super::opened::Opened;
use super::verdicts::Judgement;
use crate::reference::Judged;
use crate::report::{self, EntryView, MoveView};
use crate::scene::Assumption;
use crate::study::{Item, Variant};

/// The explanation of each entry whose id `wanted` admits, in their order.
#[must_use]
pub fn explanations(opened: &Opened, judgement: &Judgement, wanted: impl Fn(&str) -> bool) -> Vec<String> {
    let mut texts = Vec::new();
    for (experiment, judged) in &judgement.verdicts {
        let item = opened.items.iter().find(|item| item.source.experiment.id.0 == *experiment);
        let entries = judged.iter().filter(|judged| wanted(&judged.id));
        texts.extend(entries.map(|judged| report::explain(&view(opened, item, judged))));
    }
    texts
}

fn view<'a>(opened: &'a Opened, item: Option<&'a Item>, judged: &'a Judged) -> EntryView<'a> {
    let variants: &[Variant] = item.map_or(&[], |item| &item.variants);
    let moves: Vec<MoveView<'_>> = judged
        .moved
        .iter()
        .filter_map(|moved| {
            let variant = variants.iter().find(|variant| variant.label == moved.variant)?;
            let name = variant.moved?;
            let from = &opened.sheet.entries.get(&name)?.value;
            Some(MoveView { name, from, to: variant.assumptions.values.get(&name)?, moved })
        })
        .collect();
    let used = item.map(|item| item.source.experiment.assumptions_used(&opened.sheet)).unwrap_or_default();
    let unmoved: Vec<Assumption> = used.into_iter().filter(|name| moves.iter().all(|one| one.name != *name)).collect();
    let chosen_by = opened.sheet.entries.iter().filter(|(_, entry)| entry.fitted_to.contains(&judged.id));
    EntryView { judged, moves, unmoved, chosen_by: chosen_by.map(|(name, _)| *name).collect() }
}
