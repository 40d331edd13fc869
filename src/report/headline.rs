//! The findings in a paragraph: what stands, what does not, and what the lost inputs prevent, counted from the verdicts.

use crate::experiment::AboutStudy;
use crate::reference::{Judged, Kind, Role, Verdict};

use super::findings;
use super::markdown::one_line;
use super::tally::{Tally, agrees};
use super::view::ExperimentView;
use super::what_stands::{PAGE as WHAT_STANDS, missing_inputs};
use crate::text::words::counted;

/// Experiments or inputs that are named one by one.
const NAMED: usize = 6;

/// The first paragraphs of the index.
pub(super) fn section(about: &AboutStudy, experiments: &[ExperimentView<'_>]) -> String {
    let all: Vec<&Judged> = experiments.iter().flat_map(|view| view.judged).collect();
    let mut text = counts(&all);
    text += &findings::section(about, experiments);
    text += &stands(experiments);
    text += &differs(experiments);
    text += &undecided(&all);
    text + &format!(
        "\n[What stands]({WHAT_STANDS}) when the unstated inputs are moved, what does not, and the questions that would settle \
         most.\n\n"
    )
}

fn counts(all: &[&Judged]) -> String {
    let of = |wanted: Kind| Tally::of(all.iter().copied().filter(|one| one.kind == wanted));
    let (numbers, claims) = (of(Kind::Number), of(Kind::Claim));
    let mut sentences: Vec<String> = Vec::new();
    for (tally, one, many) in [(numbers, "number", "numbers"), (claims, "claim", "claims")] {
        if tally.total() > 0 {
            sentences.push(format!("**{}**: {}.", counted(tally.total(), one, many), tally.describe()));
        }
    }
    sentences.extend(used_in_fits(all));
    let held_out: Vec<_> = all.iter().filter(|one| one.role == Role::HeldOut).collect();
    if !held_out.is_empty() {
        let agree = Tally::of(held_out.iter().copied().copied()).agreeing();
        sentences.push(format!("**Held out** of all fits: {agree} of {} agree.", held_out.len()));
    }
    sentences.push(match all.iter().filter(|one| !one.as_expected()).count() {
        0 if all.is_empty() => "No published number or claim is judged.".to_owned(),
        0 => "Every verdict is the one that `reference/` expects.".to_owned(),
        1 => "**One verdict is not the expected one.**".to_owned(),
        more => format!("**{more} verdicts are not the expected ones.**"),
    });
    sentences.join(" ") + "\n\n"
}

/// How many entries were used in fits, how many of these agree, and how many of those the fit of the others predicts.
fn used_in_fits(all: &[&Judged]) -> Option<String> {
    let tally = Tally::of(all.iter().copied());
    let (used, fitted) = (tally.used_in_fits(), tally.count(Verdict::Fitted));
    let come_out = || all.iter().filter(|one| one.verdict == Verdict::Fitted && one.role == Role::CrossValidated);
    let numbers = counted(come_out().filter(|one| one.kind == Kind::Number).count(), "number", "numbers");
    let left_out = match come_out().count() {
        0 => String::new(),
        1 => format!("; **left out one at a time**, 1 of them ({numbers}) is still predicted by the others"),
        count => {
            format!("; **left out one at a time**, {count} of these ({numbers}) are still predicted by the others")
        }
    };
    let agree = if fitted == 1 { "agrees" } else { "agree" };
    let of = counted(used, "entry", "entries");
    (used > 0).then(|| format!("**Used in fits**: {of}, of which {fitted} {agree} (fitted){left_out}."))
}

/// Experiments all of whose statements agree, those with most evidence first.
fn stands(experiments: &[ExperimentView<'_>]) -> String {
    let evidence =
        |view: &ExperimentView<'_>| view.judged.iter().filter(|one| one.verdict == Verdict::Reproduced).count();
    let whole = |view: &&ExperimentView<'_>| evidence(view) > 0 && view.judged.iter().all(|one| agrees(one.verdict));
    let mut standing: Vec<_> = experiments.iter().filter(whole).collect();
    if standing.is_empty() {
        return String::new();
    }
    standing.sort_by_key(|view| std::cmp::Reverse(evidence(view)));
    let judged = experiments.iter().filter(|view| !view.judged.is_empty()).count();
    let links = standing.iter().map(|view| format!("{} ({})", link(view), evidence(view)));
    let is_fitted = |view: &&&ExperimentView<'_>| view.judged.iter().any(|one| one.verdict == Verdict::Fitted);
    let fitted = match standing.iter().filter(is_fitted).count() {
        0 => String::new(),
        count => format!(" ({count} of them with fitted entries, too, which prove nothing)"),
    };
    format!(
        "- **Agrees in full,** with the inputs in force: every statement of {} of {}{fitted}: {}.\n",
        standing.len(),
        counted(judged, "experiment with statements", "experiments with statements"),
        some(links.collect())
    )
}

/// Experiments with statements that differ, those with most first, and the numbers that are farthest off.
fn differs(experiments: &[ExperimentView<'_>]) -> String {
    let of = |view: &ExperimentView<'_>| view.judged.iter().filter(|one| one.verdict == Verdict::Differs).count();
    let mut differing: Vec<_> = experiments.iter().filter(|view| of(view) > 0).collect();
    if differing.is_empty() {
        return String::new();
    }
    differing.sort_by_key(|view| std::cmp::Reverse(of(view)));
    let count: usize = differing.iter().map(|view| of(view)).sum();
    let links = differing.iter().map(|view| format!("{} ({} of {})", link(view), of(view), view.judged.len()));
    let mut text = format!(
        "- **Does not stand:** {} in {}, most in {}.",
        counted(count, "statement differs", "statements differ"),
        counted(differing.len(), "experiment", "experiments"),
        some(links.collect())
    );
    let numbers = differing.iter().flat_map(|view| view.judged.iter().map(move |one| (*view, one)));
    let off = |one: &Judged| one.comparison.as_ref().map_or(0.0, |c| libm::log(c.simulated / c.published).abs());
    let mut numbers: Vec<_> =
        numbers.filter(|(_, one)| one.verdict == Verdict::Differs && off(one).is_finite() && off(one) > 0.0).collect();
    numbers.sort_by(|a, b| off(b.1).total_cmp(&off(a.1)));
    let farthest = numbers
        .iter()
        .take(3)
        .map(|(view, one)| format!("[{}]({}), {}", one.id, view.place_of(one), one_line(&one.found)));
    let farthest: Vec<String> = farthest.collect();
    if !farthest.is_empty() {
        text += &format!(" Farthest off: {}.", farthest.join("; "));
    }
    text + "\n"
}

/// What cannot be decided, and the inputs that are missing.
fn undecided(all: &[&Judged]) -> String {
    let count = |verdict: Verdict| all.iter().filter(|one| one.verdict == verdict).count();
    let (blocked, undecidable) = (count(Verdict::Blocked), count(Verdict::Undecidable));
    let mut sentences = Vec::new();
    if blocked > 0 {
        let inputs = missing_inputs(all.iter().copied());
        let inputs = if inputs.is_empty() { String::new() } else { format!(": {}", some(inputs)) };
        let depends = counted(blocked, "statement depends", "statements depend");
        sentences.push(format!("{depends} on inputs that the study does not state{inputs}."));
    }
    if undecidable > 0 {
        let lie = counted(undecidable, "statement lies", "statements lie");
        sentences.push(format!("{lie} within the chaotic spread or the grid of the sweep."));
    }
    if sentences.is_empty() { String::new() } else { format!("- **Cannot be decided:** {}\n", sentences.join(" ")) }
}

fn link(view: &ExperimentView<'_>) -> String {
    format!("[{}]({})", one_line(&view.experiment.title), view.page)
}

/// The first few, and how many more there are.
fn some(mut list: Vec<String>) -> String {
    let more = list.len().saturating_sub(NAMED);
    if more > 1 {
        list.truncate(NAMED);
        list.push(format!("and {more} more"));
    }
    list.join(", ")
}
