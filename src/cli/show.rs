//! `shotdamp show ID`: the experiment in words, within a bound of processor time whatever its file says.
//!
//! A thread makes the sections, the cheapest first; when the time is used up, those that are there are printed and the others
//! named. Nothing is waited for that cannot be broken off.

use std::collections::BTreeMap;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::time::Duration;

use cpu_time::ProcessTime;

use super::args::Choice;
use super::error::CliError;
use super::exit::Exit;
use super::output::{columns, print, print_error, print_unread};
use super::select::{choose, matches, no_match};
use super::thresholds::{self, PATIENCE};
use crate::accuracy::{idle_cases, out_of_reach_in_words, unreached_cases};
use crate::dynamics::{Allowance, Limit, Until, in_words};
use crate::experiment::{
    Assumptions, Case, Continuation, Experiment, GapRecipe, Given, Recipe, RowSource, value_in_words,
};
use crate::measure::{Settings, rounded};
use crate::report::{LastVerdicts, VERDICTS, scenes};
use crate::scene::{Scene, effects};
use crate::study::{Item, Layout, State, Study, Texts, Untried, forecast, simulations};
use crate::text::number::quantity;
use crate::text::words::{counted, of_key};

/// Processor time of all threads for an experiment.
const BOUND: Duration = Duration::from_millis(1500);
/// Between two looks at it.
const LOOK: Duration = Duration::from_millis(5);

/// Parts of the text, in its order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Section {
    Heading,
    Scene,
    Effects,
    Idle,
    Assumptions,
    Cases,
    Warnings,
    Fingerprint,
}

/// The same, as they are made: what takes longest comes last.
const IN_ORDER_OF_COST: [Section; 8] = [
    Section::Heading,
    Section::Assumptions,
    Section::Scene,
    Section::Cases,
    Section::Fingerprint,
    Section::Warnings,
    Section::Effects,
    Section::Idle,
];

impl Section {
    /// What is left out with it.
    fn name(self) -> &'static str {
        match self {
            Self::Heading => "heading",
            Self::Scene => "scene",
            Self::Effects => "effects in force",
            Self::Idle => "proof that effects are idle",
            Self::Assumptions => "assumptions",
            Self::Cases => "number of cases",
            Self::Warnings => "warnings",
            Self::Fingerprint => "fingerprint",
        }
    }
}

/// What the thread has made.
enum Made {
    /// What is known of one more experiment before its cases are tried, in the place of its sections.
    Untried(String),
    /// The files are read; so many experiments are to be described.
    Read { experiments: u32 },
    /// A section of an experiment.
    Section(usize, Section, String),
    /// All is there.
    All(Result<Exit, CliError>),
}

/// Prints all that is known of an experiment before it runs.
pub(super) fn show(layout: &Layout, id: &str) -> Result<Exit, CliError> {
    let begun = ProcessTime::now();
    let (made, inbox) = mpsc::channel();
    {
        let (layout, id) = (layout.clone(), id.to_owned());
        std::thread::spawn(move || {
            let exit = make(&layout, &id, &made);
            // Nobody is left to be told when the time was up.
            let _ = made.send(Made::All(exit));
        });
    }
    let mut texts: BTreeMap<(usize, Section), String> = BTreeMap::new();
    let (mut untried, mut read) = (Vec::new(), None);
    let exit = loop {
        match inbox.recv_timeout(LOOK) {
            Ok(Made::Untried(text)) => untried.push(text),
            Ok(Made::Read { experiments }) => read = Some(experiments),
            Ok(Made::Section(index, section, text)) => drop(texts.insert((index, section), text)),
            Ok(Made::All(exit)) => break exit?,
            Err(RecvTimeoutError::Disconnected) => break Exit::CouldNot,
            Err(RecvTimeoutError::Timeout) => {}
        }
        if begun.elapsed() > BOUND * read.unwrap_or(1).max(1) {
            break if read.is_some() || !untried.is_empty() { Exit::AsExpected } else { Exit::CouldNot };
        }
    };
    let mut text = String::new();
    for index in 0..read.unwrap_or(0) as usize {
        let parts: String =
            texts.range((index, Section::Heading)..=(index, Section::Fingerprint)).map(|(_, t)| t.as_str()).collect();
        let missing = IN_ORDER_OF_COST.iter().filter(|section| !texts.contains_key(&(index, **section)));
        let missing: Vec<&str> = missing.map(|section| section.name()).collect();
        if !text.is_empty() {
            text.push('\n');
        }
        text += &parts;
        if !missing.is_empty() {
            text += &format!("\nLeft out, since it takes more than {}: {}\n", in_words(BOUND), missing.join(", "));
        }
    }
    if read.is_none() {
        let bound = in_words(BOUND);
        if untried.is_empty() {
            print_error(&format!("error: {id}: reading it takes more than {bound}\n"));
        } else {
            text = untried.join("\n")
                + &format!("\nLeft out, since checking all cases takes more than {bound}: all else\n");
        }
    }
    print(&text)?;
    Ok(exit)
}

/// Makes all sections of all experiments.
fn make(layout: &Layout, id: &str, made: &Sender<Made>) -> Result<Exit, CliError> {
    let texts = Texts::read(layout)?;
    let ids = texts.ids();
    // Told from the names of the files: to read all of them may take longer than anyone waits.
    if !ids.is_empty() && !ids.iter().any(|known| matches(id, known)) {
        return Err(no_match(id, &ids));
    }
    let on_untried = |one: &Untried<'_>| drop(made.send(Made::Untried(untried(one))));
    let study = Study::of(layout.clone(), texts, &|stem| matches(id, stem), &on_untried);
    let chosen = choose(&study, &Choice { patterns: vec![id.into()], folder: None })?;
    print_unread(chosen.unread.iter().copied());
    let experiments = u32::try_from(chosen.items.len()).unwrap_or(u32::MAX);
    let _ = made.send(Made::Read { experiments });
    // Reasons quote entries of other experiments, too, which are not read here.
    let verdicts = std::fs::read_to_string(layout.path(VERDICTS)).unwrap_or_default();
    let verdicts = LastVerdicts::read(&verdicts);
    for (index, item) in chosen.items.iter().enumerate() {
        let mut all = None;
        for section in IN_ORDER_OF_COST {
            let text = describe(&study, &verdicts, item, section, &mut all);
            let _ = made.send(Made::Section(index, section, text));
        }
    }
    Ok(if chosen.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot })
}

/// The cheapest sections of an experiment.
fn untried(&Untried { experiment, file, assumptions }: &Untried<'_>) -> String {
    let cases = counted(experiment.cases.len(), "case", "cases");
    heading(experiment, file) + &first_scene(assumptions, experiment) + &format!("\nCases\n  {cases}\n")
}

/// A section; `all` keeps the scenes of all cases once they are there.
fn describe(
    study: &Study,
    verdicts: &LastVerdicts,
    item: &Item,
    section: Section,
    all: &mut Option<Vec<Scene>>,
) -> String {
    let experiment = &item.source.experiment;
    match section {
        Section::Heading => heading(experiment, &item.source.file),
        Section::Scene => first_scene(&study.sheet.assumptions(), experiment),
        Section::Effects => in_force(all.get_or_insert_with(|| scenes(study, experiment))),
        Section::Idle => {
            let idle = idle(experiment, all.get_or_insert_with(|| scenes(study, experiment)));
            idle + &thresholds::in_words(study, experiment)
        }
        Section::Assumptions => assumptions(study, verdicts, item),
        Section::Cases => cases(item),
        Section::Warnings => {
            let warnings = forecast(experiment, &study.sheet.assumptions());
            warnings.into_iter().map(|warning| format!("  warning: {warning}\n")).collect()
        }
        Section::Fingerprint => {
            let state = match &item.state {
                State::Current(_) => "up to date",
                State::Failed(_) => "computed, with failed rows",
                State::Stale(_) => "stale",
            };
            format!("\nFingerprint {}\n({state})\n", item.fingerprint())
        }
    }
}

fn heading(experiment: &Experiment, file: &str) -> String {
    let source = &experiment.source;
    let section = source.section.as_ref().map(|section| format!("s. {section}"));
    let place: Vec<String> = section.into_iter().chain(source.shown_in.iter().cloned()).collect();
    let place = if place.is_empty() { String::new() } else { place.join(", ") + "; " };
    format!("{}: {}\n{place}{}\n\n{}\n", experiment.id, experiment.title, file, experiment.about)
}

/// The first scene that has all that there is to see: one without dampers hides what the others have.
fn first_scene(assumptions: &Assumptions, experiment: &Experiment) -> String {
    let has_dampers = |case: &&Case| experiment.recipe_of(case).is_ok_and(|recipe| !recipe.without_dampers);
    let (first, which) = match (experiment.cases.first(), experiment.cases.iter().find(has_dampers)) {
        (Some(first), Some(with)) if first != with => (Some(with), "first case with dampers"),
        (first, _) => (first, "first case"),
    };
    let recipe = first.and_then(|case| experiment.recipe_of(case).ok());
    let scene = recipe.as_ref().and_then(|recipe| recipe.resolve(assumptions).ok());
    let scene = scene.map(|scene| rounded(scene, &experiment.settings));
    let case = first.map(|case| case.describe()).filter(|case| !case.is_empty());
    let mut text = format!("\nScene{}\n", case.map_or_else(String::new, |case| format!(" of the {which} ({case})")));
    for line in scene.as_ref().map(Scene::describe).unwrap_or_default() {
        text += &format!("  {line}\n");
    }
    let unit_gap = recipe.zip(scene).and_then(|(recipe, scene)| unit_gap(&recipe, &scene));
    text + &unit_gap.map_or_else(String::new, |gap| format!("  h′ = 1 is a gap of {}\n", quantity(gap, "m", 5)))
}

/// The gap clearance that h′ = 1 stands for, m, where the first damper states the ratio.
fn unit_gap(recipe: &Recipe, scene: &Scene) -> Option<f64> {
    let GapRecipe::Ratio(Given::Stated(ratio)) = recipe.dampers.first()?.gap else { return None };
    Some(scene.dampers.first()?.gap / ratio).filter(|gap| gap.is_finite())
}

fn in_force(scenes: &[Scene]) -> String {
    let rows: Vec<Vec<String>> = effects(scenes)
        .into_iter()
        .map(|effect| {
            let state = match effect.in_force {
                0 => format!("left out: {}", effect.why_not),
                n if n == effect.cases => "in force".into(),
                n => format!("in force in {n} of {}", counted(effect.cases, "case", "cases")),
            };
            vec![format!("  {}", effect.name), state]
        })
        .collect();
    format!("\nEffects\n{}", columns(&rows))
}

/// Cases in which what only a particle in flight can meet is named and provably never met.
fn idle(experiment: &Experiment, scenes: &[Scene]) -> String {
    let limit = Limit { time: PATIENCE, ..Limit::default() };
    let all = counted(scenes.len(), "case", "cases");
    let mut text = match Allowance::new(limit).simulate(|| idle_cases(experiment, scenes)) {
        0 => String::new(),
        count => format!(
            "  In {count} of {all} it is proved that no particle leaves its floor: ceilings, stops and impacts are idle \
             there and skipped.\n",
        ),
    };
    for (effect, count, nearest) in unreached_cases(experiment, scenes) {
        let nearest = out_of_reach_in_words(nearest);
        text +=
            &format!("  In {count} of {all} it is proved that the {effect} is out of reach, and skipped: {nearest}.\n");
    }
    text
}

fn assumptions(study: &Study, verdicts: &LastVerdicts, item: &Item) -> String {
    let mut text = String::from(if item.used.is_empty() { "" } else { "\nAssumptions\n" });
    for (name, entry) in study.sheet.iter().filter(|(name, _)| item.used.contains(*name)) {
        text += &format!("  {name} = {}\n", value_in_words(entry.kind.unit(), &entry.value));
        text += &wrapped(&verdicts.reason(&entry.reason), "      ", 100);
    }
    text
}

fn cases(item: &Item) -> String {
    let experiment = &item.source.experiment;
    let mut solvers: Vec<String> = Vec::new();
    for (_, solver) in experiment.runs() {
        if !solvers.contains(&solver.label()) {
            solvers.push(solver.label());
        }
    }
    let (rows, most) = item.size();
    let cases = counted(experiment.cases.len(), "case", "cases");
    let mut text = match experiment.row_source() {
        RowSource::Branches(Continuation { along, from, to, starts, .. }) => {
            let (along, starts) = (of_key(along), starts.iter().map(f64::to_string).collect::<Vec<_>>());
            let starts = starts.join(", ");
            format!(
                "\nCases\n  branches of periodic motions along {along} from {from} to {to}, begun by runs at {starts}\n"
            )
        }
        RowSource::Basins(starts) => {
            let starts = counted(starts.count as usize, "random start", "random starts");
            format!("\nCases\n  {cases}, each from {starts}; a row for each motion that they end in\n")
        }
        RowSource::Cases | RowSource::Search(_) => format!("\nCases\n  {cases}, under {}\n", solvers.join(" and ")),
    };
    if item.variants.len() > 1 {
        let ends: Vec<&str> = item.variants.iter().skip(1).map(|variant| variant.label.as_str()).collect();
        text += &format!("  and event-driven with each of {}\n", ends.join(", "));
    }
    let Settings { skip, average, until, round_period_to, .. } = experiment.settings;
    if until == Until::Settled {
        text += &format!("  each run ends where it has settled, or after {skip} + {average} cycles\n");
    }
    if let Some(step) = round_period_to {
        text += &format!("  the forcing period is rounded to whole steps of {}\n", quantity(step, "s", 4));
    }
    text + &format!("  {}, {} at most\n", counted(rows, "row", "rows"), simulations(most))
}

/// The text wrapped at `width` letters, each line after a margin.
fn wrapped(text: &str, margin: &str, width: usize) -> String {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    lines.into_iter().map(|line| format!("{margin}{line}\n")).collect()
}
