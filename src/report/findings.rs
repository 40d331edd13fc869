//! What the publication concludes, and what became of it: the verdicts of the entries that decide each conclusion.

use crate::experiment::{AboutStudy, Finding};
use crate::reference::Judged;

use super::comparison::{explanation, lead, outcome};
use super::markdown::{Align, MarkdownTable, first_sentence};
use super::tally::{agrees, mark};
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
    let find = |id: &String| {
        let judged = |view: &'_ ExperimentView<'_>| view.judged.iter().position(|one| one.id == *id);
        experiments.iter().find_map(|view| Some((view, judged(view)?)))
    };
    let mut links = String::new();
    let mut all: Vec<Judged> = Vec::new();
    for id in &finding.entries {
        match find(id) {
            Some((view, at)) => {
                let one = &view.judged[at];
                links += &format!("[{}]({})", mark(one.verdict), view.place_of(one));
                all.push(one.clone());
            }
            None => links += &format!(" no entry `{id}`"),
        }
    }
    let why = lead(&all).filter(|lead| !agrees(lead.verdict));
    let why = why.map_or_else(String::new, |lead| first_sentence(&explanation(lead)));
    let agree = all.iter().filter(|one| agrees(one.verdict)).count();
    let share = if agree > 0 && agree < all.len() { format!(", {agree} of {}", all.len()) } else { String::new() };
    [finding.says.clone(), format!("**{}**{share} {links}", outcome(&all).to_lowercase()), why]
}
