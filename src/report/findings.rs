//! What the publication concludes, and what became of it: the verdicts of the entries that decide each conclusion.

use crate::experiment::{AboutStudy, Finding};
use crate::reference::{Judged, Verdict};

use super::comparison::{explanation, lead, outcome};
use super::markdown::{Align, MarkdownTable, first_sentence, one_line};
use super::tally::{Tally, agrees, mark};
use super::view::ExperimentView;

/// A row for each conclusion; nothing where the study names none.
pub(super) fn section(about: &AboutStudy, experiments: &[ExperimentView<'_>]) -> String {
    let mut table =
        MarkdownTable::new(&[("The study concludes", Align::Left), ("Here", Align::Left), ("Why", Align::Left)]);
    for finding in &about.findings {
        table.row(row(finding, experiments));
    }
    table.finish()
}

fn row(finding: &Finding, experiments: &[ExperimentView<'_>]) -> [String; 3] {
    let entries = || experiments.iter().flat_map(|view| view.judged.iter().map(move |one| (view, one)));
    let mut links = String::new();
    let mut all: Vec<(&ExperimentView<'_>, &Judged)> = Vec::new();
    for id in &finding.entries {
        match entries().find(|(_, one)| one.id == *id) {
            Some((view, one)) => {
                links += &format!("[{}]({})", mark(one.verdict), view.place_of(one));
                all.push((view, one));
            }
            None => links += &format!(" no entry `{id}`"),
        }
    }
    let why = lead(all.iter().map(|(_, one)| *one)).filter(|lead| !agrees(lead.verdict));
    let why = why.map_or_else(String::new, |lead| {
        let why = first_sentence(&explanation(lead));
        let several = all.windows(2).any(|pair| pair[0].0.page != pair[1].0.page);
        match all.iter().find(|(_, one)| one.id == lead.id).filter(|_| several) {
            Some((view, _)) => format!("{}: {why}", one_line(&view.experiment.title)),
            None => why,
        }
    });
    let tally = Tally::of(all.iter().map(|(_, one)| *one));
    let (agree, fitted) = (tally.count(Verdict::Reproduced), tally.count(Verdict::Fitted));
    let evidence = tally.evidence();
    let mut share = if agree > 0 && agree < evidence { format!(", {agree} of {evidence}") } else { String::new() };
    if fitted > 0 && evidence > 0 {
        share += &format!("; {fitted} more fitted");
    }
    [finding.says.clone(), format!("**{}**{share} {links}", outcome(&tally).to_lowercase()), why]
}
