//! What of the study stands, whatever the inputs are that it does not state.
//!
//! Each assumption that an experiment names is moved, alone, to every other value of its range. An entry that agrees under all of
//! these moves stands, one that differs under all of them does not; any other depends on an input, which is then a question
//! to the author. Nothing here is written by hand: the page is made from the verdicts.

use std::collections::{BTreeMap, BTreeSet};

use super::markdown::one_line;
use super::tally::agrees;
use super::view::{AssumptionView, ExperimentView};
use crate::experiment::{AssumptionName, AssumptionSheet, value_in_words};
use crate::reference::{Judged, Verdict};
use crate::text::words::counted;

/// The page's name below `reports/`.
pub(super) const PAGE: &str = "what-stands.md";

/// Questions that the first lines name.
const FIRST_QUESTIONS: usize = 3;

/// Missing inputs that the first lines name.
const WAITED_FOR: usize = 6;

/// What becomes of an entry when the unstated inputs are moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Robustness {
    /// Agrees under every move.
    Stands,
    /// Differs under every move.
    Fails,
    /// Agrees with one value of an input and not with another.
    Depends,
    /// Undecidable or blocked, with the inputs in force or under some move, and no move turns it.
    Open,
    /// Agrees, and an assumption was chosen by it.
    Chosen,
    /// Its experiment uses unstated inputs that have other values, and none of them was moved.
    NotMoved,
    /// Without a result.
    Missing,
}

/// `reports/what-stands.md`. `assumptions` are all of the sheet, with the entries that use them.
#[must_use]
pub fn what_stands(
    experiments: &[ExperimentView<'_>],
    sheet: &AssumptionSheet,
    assumptions: &[AssumptionView],
) -> String {
    let movable: BTreeSet<&str> = assumptions
        .iter()
        .filter(|one| sheet.iter().any(|(name, entry)| name.as_str() == one.name && !entry.range.is_empty()))
        .flat_map(|one| one.used_by.iter().map(String::as_str))
        .collect();
    let mut groups: BTreeMap<Robustness, Vec<Line<'_>>> = BTreeMap::new();
    for view in experiments {
        for judged in view.judged {
            let robustness = robustness(judged, movable.contains(judged.id.as_str()));
            groups.entry(robustness).or_default().push(Line { view, judged });
        }
    }
    let questions = questions(groups.get(&Robustness::Depends).map_or(&[], Vec::as_slice), sheet);
    let group = |robustness: Robustness| groups.get(&robustness).map_or(&[][..], Vec::as_slice);
    let mut text = String::from("# What stands\n\n[The study in one page](README.md)\n\n");
    text += &in_short(&group, &questions);
    let missing = missing_inputs(experiments.iter().flat_map(|view| view.judged));
    if !missing.is_empty() {
        text += &format!(
            "Inputs that blocked entries depend on: {}.\n\n",
            missing.into_iter().take(WAITED_FOR).collect::<Vec<_>>().join(", ")
        );
    }
    text += &section("Stands: agrees under every move that was made", group(Robustness::Stands));
    text += &section("Does not stand: differs under every move that was made", group(Robustness::Fails));
    text += &in_question(&questions);
    text +=
        &section("Open: undecidable or blocked, with the inputs in force or under some move", group(Robustness::Open));
    text += &section("Agrees, but was used to choose an input", group(Robustness::Chosen));
    text += &section("Not tested: no unstated input of its experiment was moved", group(Robustness::NotMoved));
    text + &section("No result", group(Robustness::Missing))
}

/// An entry with its page.
struct Line<'a> {
    view: &'a ExperimentView<'a>,
    judged: &'a Judged,
}

impl Line<'_> {
    fn link(&self) -> String {
        format!("[`{}`]({})", self.judged.id, self.view.place_of(self.judged))
    }

    /// How often its verdict was tried, if ever.
    fn moves(&self) -> String {
        match self.judged.moved.len() {
            0 => String::new(),
            moves => format!(" ({})", counted(moves, "move", "moves")),
        }
    }
}

fn robustness(judged: &Judged, movable: bool) -> Robustness {
    let all = |verdict: Verdict| judged.moved.iter().all(|moved| moved.verdict == verdict);
    let turns = judged.moved.iter().any(|moved| turned(judged, moved.verdict));
    match judged.verdict {
        Verdict::Missing => Robustness::Missing,
        Verdict::Fitted => Robustness::Chosen,
        _ if turns => Robustness::Depends,
        Verdict::Undecidable | Verdict::Blocked => Robustness::Open,
        _ if judged.moved.is_empty() && movable => Robustness::NotMoved,
        Verdict::Reproduced if all(Verdict::Reproduced) => Robustness::Stands,
        Verdict::Differs if all(Verdict::Differs) => Robustness::Fails,
        Verdict::Reproduced | Verdict::Differs => Robustness::Open,
    }
}

/// True where a move makes an entry agree that does not, or differ where it agrees.
fn turned(judged: &Judged, moved: Verdict) -> bool {
    if agrees(judged.verdict) { moved == Verdict::Differs } else { agrees(moved) }
}

/// One unstated input and the entries that it decides.
struct Question<'a> {
    name: AssumptionName,
    in_force: String,
    /// By the other value, in words: the entries that turn with it.
    turns: BTreeMap<String, Vec<(&'a Line<'a>, Verdict)>>,
}

impl Question<'_> {
    /// How many entries turn with it.
    fn settles(&self) -> usize {
        let entries = self.turns.values().flatten().map(|(line, _)| line.judged.id.as_str());
        entries.collect::<BTreeSet<_>>().len()
    }
}

/// Those that would settle most entries first.
fn questions<'a>(depending: &'a [Line<'a>], sheet: &AssumptionSheet) -> Vec<Question<'a>> {
    let every: BTreeSet<AssumptionName> = sheet.iter().map(|(name, _)| name.clone()).collect();
    let mut questions: Vec<Question<'a>> = Vec::new();
    for one in sheet.variants(&every) {
        let turning = depending.iter().flat_map(|line| {
            let moves = line.judged.moved.iter().filter(|moved| moved.variant == one.label);
            moves.filter(|moved| turned(line.judged, moved.verdict)).map(move |moved| (line, moved.verdict))
        });
        let turning: Vec<_> = turning.collect();
        let (Some(entry), Some(value)) = (sheet.get(&one.name), one.assumptions.values.get(&one.name)) else {
            continue;
        };
        if turning.is_empty() {
            continue;
        }
        let unit = entry.kind.unit();
        let value = value_in_words(unit, value);
        match questions.iter_mut().find(|question| question.name == one.name) {
            Some(question) => {
                question.turns.insert(value, turning);
            }
            None => questions.push(Question {
                name: one.name,
                in_force: value_in_words(unit, &entry.value),
                turns: BTreeMap::from([(value, turning)]),
            }),
        }
    }
    questions.sort_by_key(|one| (std::cmp::Reverse(one.settles()), one.name.clone()));
    questions
}

fn in_short<'a>(group: &dyn Fn(Robustness) -> &'a [Line<'a>], questions: &[Question<'_>]) -> String {
    let all = [
        (Robustness::Stands, "agree under every move"),
        (Robustness::Fails, "differ under every move"),
        (Robustness::Depends, "depend on one of them"),
        (Robustness::Open, "are open: undecidable or blocked, with the inputs in force or under some move"),
        (Robustness::Chosen, "agree, but were used to choose an input, which proves nothing"),
        (Robustness::NotMoved, "were not tested, as no unstated input of their experiment was moved"),
        (Robustness::Missing, "have no result"),
    ];
    let counts = all.map(|(robustness, words)| (group(robustness).len(), words));
    let total: usize = counts.iter().map(|(count, _)| count).sum();
    let counts =
        counts.into_iter().filter(|(count, _)| *count > 0).map(|(count, words)| format!("**{count}** {words}"));
    let unmoved =
        group(Robustness::Stands).iter().chain(group(Robustness::Fails)).filter(|line| line.judged.moved.is_empty());
    let unmoved = unmoved.count();
    let mut text = format!(
        "The unstated inputs that an experiment names are moved one at a time through the values of their ranges; what was not \
         moved is not covered. Of {}: {}.{}\n\n",
        counted(total, "entry", "entries"),
        counts.collect::<Vec<_>>().join("; "),
        if unmoved == 0 {
            String::new()
        } else {
            format!(
                " Where nothing is unstated there is nothing to move: {unmoved} of those that agree or differ under every move."
            )
        }
    );
    let first: Vec<String> =
        questions.iter().take(FIRST_QUESTIONS).map(|one| format!("`{}` ({})", one.name, one.settles())).collect();
    if !first.is_empty() {
        text += &format!("The inputs that would settle most entries: {}.\n\n", first.join(", "));
    }
    text
}

fn section(title: &str, lines: &[Line<'_>]) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let entries: String = lines
        .iter()
        .map(|line| {
            let Judged { statement, found, .. } = line.judged;
            format!("- {}: {} Here: {}{}\n", line.link(), one_line(statement), one_line(found), line.moves())
        })
        .collect();
    format!(
        "## {title}\n\n<details><summary>{}</summary>\n\n{entries}\n</details>\n\n",
        counted(lines.len(), "entry", "entries")
    )
}

fn in_question(questions: &[Question<'_>]) -> String {
    if questions.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "## Depends on an input: questions to the author\n\nThose that would settle most entries first. The value in force comes \
         first, then what turns with another one.\n\n",
    );
    for question in questions {
        text += &format!(
            "- **[`{name}`](assumptions.md#{name})**, {} in force; settles {}.\n",
            question.in_force,
            counted(question.settles(), "entry", "entries"),
            name = question.name
        );
        for (value, turning) in &question.turns {
            let entries = turning.iter().map(|(line, verdict)| format!("{} {}", line.link(), verdict.word()));
            text += &format!("  - {value}: {}\n", entries.collect::<Vec<_>>().join(", "));
        }
    }
    text + "\n"
}

/// The inputs that blocked entries name, with how many do, the most wanted first: `contact damping (24)`.
pub(super) fn missing_inputs<'a>(all: impl Iterator<Item = &'a Judged>) -> Vec<String> {
    let mut inputs = BTreeMap::<&str, usize>::new();
    for one in all.filter(|one| one.verdict == Verdict::Blocked) {
        for input in one.blocked_by.iter().flat_map(|inputs| inputs.split(" and ")) {
            *inputs.entry(input.trim_start_matches("the ")).or_default() += 1;
        }
    }
    let mut inputs: Vec<_> = inputs.into_iter().collect();
    inputs.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    inputs.into_iter().map(|(input, count)| format!("{input} ({count})")).collect()
}
