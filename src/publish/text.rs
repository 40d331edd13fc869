//! The texts of a study, by the report's functions. (Stand-ins until the report room is there.)

use super::opened::Opened;
use super::verdicts::Judgement;
use crate::reference::Verdict;
use crate::study::Item;

pub(super) fn page(opened: &Opened, judgement: &Judgement, item: &Item) -> String {
    let experiment = &item.source.experiment;
    let mut text = format!("# {}\n\n{}\n", experiment.title, experiment.about);
    for figure in &experiment.figures {
        text += &format!("\n![{}]({})\n", figure.caption, super::figures::figure_name(experiment, figure));
    }
    for judged in judgement.verdicts.get(&experiment.id.0).into_iter().flatten() {
        text += &format!("\n- {}: {:?}: {}", judged.id, judged.verdict, judged.found);
    }
    let _ = opened;
    text
}

pub(super) fn index(opened: &Opened, judgement: &Judgement) -> String {
    let mut text = String::from("# Reports\n");
    for item in &opened.items {
        let id = &item.source.experiment.id;
        text += &format!("\n- {id}: {} entries", judgement.verdicts.get(&id.0).map_or(0, Vec::len));
    }
    text
}

/// The summary on the console.
#[must_use]
pub fn summary(opened: &Opened, judgement: &Judgement, ids: &std::collections::BTreeSet<&str>) -> String {
    let mut text = String::new();
    let _ = opened;
    for (id, judged) in judgement.verdicts.iter().filter(|(id, _)| ids.contains(id.as_str())) {
        for one in judged.iter().filter(|one| !one.as_expected() || one.verdict == Verdict::Missing) {
            text += &format!("{id}: {}: {:?}, expected {:?}: {}\n", one.id, one.verdict, one.expected, one.found);
        }
        text += &format!("{id}: {} entries\n", judged.len());
    }
    text
}
