//! Which study, and which of its experiments.

use std::collections::BTreeSet;
use std::path::Path;

use super::args::{CheckArgs, Choice, Command, ExportArgs, GatherArgs, RunArgs, StatusArgs};
use super::error::CliError;
use super::exit::Exit;
use crate::atomic::place_of;
use crate::report::Judgement;
use crate::study::FileKind;
use crate::study::{
    ASSUMPTIONS, Item, Layout, Refused, STUDY, Snapshot, State, Study, Summary, Texts, folder_of, stem,
};
use crate::yaml::did_you_mean;

/// The study that is meant.
pub(super) fn layout(root: Option<&Path>) -> Result<Layout, CliError> {
    if let Some(root) = root {
        let layout = Layout::new(root);
        return if layout.path("experiments").is_dir() { Ok(layout) } else { Err(CliError::NoStudyAt(root.into())) };
    }
    let here = std::env::current_dir().map_err(CliError::Here)?;
    Layout::find(&here).ok_or(CliError::NoStudy(here))
}

/// Puts ids in the place of paths to experiments and calibrations, as a shell completes them: `experiments/ch3/ch3-gap.yaml`, seen
/// from here or from the folder of the study.
pub(super) fn name_files(layout: &Layout, command: &mut Command) {
    let experiments = |named: &mut String| name_file(layout, FileKind::Experiment.folder(), named);
    match command {
        Command::Run(RunArgs { choice, .. })
        | Command::Gather(GatherArgs { choice, .. })
        | Command::Export(ExportArgs { choice, .. })
        | Command::Status(StatusArgs { choice, .. })
        | Command::Check(CheckArgs { choice, .. }) => choice.patterns.iter_mut().for_each(experiments),
        Command::Accuracy(accuracy) => accuracy.patterns.iter_mut().for_each(experiments),
        Command::Show { id } | Command::Effects { id, .. } => experiments(id),
        Command::Calibrate(calibrate) => name_file(layout, FileKind::Calibration.folder(), &mut calibrate.id),
        Command::Report(_)
        | Command::List
        | Command::Diff(_)
        | Command::Clean(_)
        | Command::New(_)
        | Command::Schema(_)
        | Command::Completions { .. }
        | Command::Explain { .. } => {}
    }
}

/// No id has a dot or a slash: what is the path of such a file is nothing else.
fn name_file(layout: &Layout, folder: &str, named: &mut String) {
    let path = Path::new(named.as_str());
    let is_file = |path: &Path| path.is_file() && place_of(path).starts_with(place_of(&layout.path(folder)));
    if path.extension().is_some_and(|ending| ending == "yaml") && (is_file(path) || is_file(&layout.root().join(path)))
    {
        *named = stem(named).to_owned();
    }
}

/// Reads and plans the study.
pub(super) fn open(layout: &Layout) -> Result<Study, CliError> {
    Ok(Study::new(layout.clone(), Texts::read(layout)?))
}

/// The texts of a study, and what the last runs left up to date.
pub(super) struct Found {
    pub texts: Texts,
    pub snapshot: Snapshot,
}

impl Found {
    pub fn look(layout: &Layout) -> Result<Self, CliError> {
        let texts = Texts::read(layout)?;
        let snapshot = Snapshot::current(layout, &texts);
        Ok(Self { texts, snapshot })
    }

    /// The study, in which only the experiments are planned that are not known to be up to date, or are chosen and to be looked at `anyway`.
    pub fn open(self, layout: &Layout, choice: &Choice, anyway: bool) -> Study {
        let Snapshot { mut experiments, mut used, .. } = self.snapshot;
        if anyway {
            for (id, known) in experiments.extract_if(.., |_, known| choice.admits_known(known)) {
                used.insert(id, known.used);
            }
        }
        Study::beside(layout.clone(), self.texts, experiments, used)
    }
}

impl Choice {
    /// True for an experiment that is known to be up to date.
    pub fn admits_known(&self, known: &Summary) -> bool {
        self.admits(&known.heading.id.0, &known.folder)
    }

    /// True if nothing was chosen, which means everything.
    pub fn is_all(&self) -> bool {
        self.patterns.is_empty() && self.folder.is_none()
    }

    fn admits(&self, id: &str, folder: &str) -> bool {
        let within =
            |wanted: &str| folder.strip_prefix(wanted).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
        self.folder.as_deref().is_none_or(|wanted| within(wanted.trim_end_matches('/'))) && self.admits_any_folder(id)
    }

    fn admits_any_folder(&self, id: &str) -> bool {
        self.patterns.is_empty() || self.patterns.iter().any(|pattern| matches(pattern, id))
    }
}

/// The experiments, files and entries that a command is about.
pub(super) struct Chosen<'a> {
    /// Experiments that were planned.
    pub items: Vec<&'a Item>,
    /// Those that are known to be up to date.
    pub known: Vec<&'a Summary>,
    /// Files that could not.
    pub unread: Vec<&'a Refused>,
    /// Ids of experiments and of reference files.
    pub ids: BTreeSet<&'a str>,
}

/// The chosen ids, if all of them are known to be up to date, and the index with them.
pub(super) fn matched<'a>(found: &'a Found, choice: &Choice) -> Option<BTreeSet<&'a str>> {
    let Found { texts, snapshot } = found;
    let admitted = |id: &&str| match snapshot.experiments.get(*id) {
        Some(known) => choice.admits_known(known),
        // One that has to be read first is known by its id alone.
        None => choice.admits_any_folder(id),
    };
    let ids: BTreeSet<&str> = texts.stems().into_iter().filter(admitted).collect();
    let is_known = |id: &&str| snapshot.experiments.contains_key(*id);
    let answers = |pattern: &String| ids.iter().any(|id| matches(pattern, id));
    let all = snapshot.index_is_current && !ids.is_empty() && ids.iter().all(is_known);
    (all && choice.patterns.iter().all(answers)).then_some(ids)
}

/// What `choice` means in this study.
///
/// # Errors
/// A pattern or a folder that nothing answers to: it would otherwise pass for success.
pub(super) fn choose<'a>(study: &'a Study, choice: &Choice) -> Result<Chosen<'a>, CliError> {
    if study.items.is_empty() && study.known.is_empty() && study.unread.is_empty() {
        return Err(CliError::NoExperiments);
    }
    let chosen = Chosen {
        items: study
            .items
            .iter()
            .filter(|item| choice.admits(&item.source.experiment.id.0, item.source.folder()))
            .collect(),
        known: study.known.values().filter(|known| choice.admits_known(known)).collect(),
        unread: study
            .unread
            .iter()
            .filter(|unread| {
                [ASSUMPTIONS, STUDY].contains(&unread.file())
                    || choice.admits(stem(unread.file()), folder_of(unread.file()))
            })
            .collect(),
        ids: BTreeSet::new(),
    };
    // While the assumptions cannot be read no experiment is: then no pattern is called wrong.
    let blind = chosen.unread.iter().any(|unread| unread.file() == ASSUMPTIONS);
    let stems: Vec<&str> = chosen.unread.iter().map(|unread| stem(unread.file())).collect();
    let answers = |pattern: &&String| chosen.ids().chain(stems.iter().copied()).any(|id| matches(pattern, id));
    if let Some(pattern) = choice.patterns.iter().find(|pattern| !blind && !answers(pattern)) {
        let readable = readable(study);
        return Err(match &choice.folder {
            Some(folder) if readable.iter().any(|id| matches(pattern, id)) => {
                CliError::ElsewhereOnly { pattern: pattern.clone(), folder: folder.clone() }
            }
            _ => no_match(pattern, &readable),
        });
    }
    if let Some(folder) = choice.folder.clone().filter(|_| chosen.is_empty()) {
        return Err(CliError::NoFolder { folder, known: folders(study) });
    }
    // A reference without its experiment is missing it, and must not be passed over.
    let planned: BTreeSet<&str> = study.items.iter().map(|item| item.source.experiment.id.0.as_str()).collect();
    let orphans = study.references.keys().map(String::as_str).filter(|id| !planned.contains(id));
    let names = study.reference_names();
    let folder = |id: &str| names.get(id).map_or("", |name| folder_of(name));
    let ids = chosen.ids().chain(orphans.filter(|id| choice.admits(id, folder(id)))).collect();
    Ok(Chosen { ids, ..chosen })
}

impl<'a> Chosen<'a> {
    /// What there is to do; all of it where that is forced.
    pub fn todo(&self, force: bool) -> Vec<&'a Item> {
        self.items.iter().copied().filter(|item| force || !matches!(item.state, State::Current(_))).collect()
    }

    /// The ids of the experiments.
    fn ids(&self) -> impl Iterator<Item = &'a str> {
        let planned = self.items.iter().map(|item| item.source.experiment.id.0.as_str());
        planned.chain(self.known.iter().map(|known| known.heading.id.0.as_str()))
    }

    /// What files with mistakes leave out, a line each kind; nothing where there are none.
    pub fn left_out(&self) -> String {
        let of = |kind: FileKind| -> Vec<&str> {
            let files = self.unread.iter().map(|one| one.file());
            files.filter(|file| FileKind::of(file) == Some(kind)).map(stem).collect()
        };
        // A name in it that names nothing leaves no experiment out.
        let blind = self.count() == 0 && self.unread.iter().any(|unread| unread.file() == ASSUMPTIONS);
        let (experiments, references) = (of(FileKind::Experiment), of(FileKind::Reference));
        let mut text = String::new();
        if blind {
            text += &format!("Left out: every experiment, because {ASSUMPTIONS} has mistakes.\n");
        } else if !experiments.is_empty() {
            text += &format!("Left out, because of mistakes in their files: {}.\n", experiments.join(", "));
        }
        if !references.is_empty() {
            text += &format!("Not judged, because of mistakes in their references: {}.\n", references.join(", "));
        }
        text
    }

    /// The number of experiments.
    pub fn count(&self) -> usize {
        self.items.len() + self.known.len()
    }

    fn is_empty(&self) -> bool {
        self.count() == 0 && self.unread.is_empty()
    }

    /// What the verdicts and what could not be read come to.
    pub fn exit(&self, judgement: &Judgement) -> Exit {
        let verdicts = judgement.verdicts.iter().filter(|(id, _)| self.ids.contains(id.as_str())).flat_map(|(_, v)| v);
        let unread = if self.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot };
        Exit::of_verdicts(verdicts).max(unread)
    }
}

/// The ids of all experiments that can be read.
fn readable(study: &Study) -> BTreeSet<&str> {
    let planned = study.items.iter().map(|item| item.source.experiment.id.0.as_str());
    planned.chain(study.known.keys().map(String::as_str)).collect()
}

/// The error of a pattern that none of the `ids` answers to.
pub(super) fn no_match(pattern: &str, ids: &BTreeSet<&str>) -> CliError {
    let hint = match pattern.rsplit_once('/') {
        _ if ids.is_empty() => "there are none that can be read; `shotdamp check` says why".into(),
        Some(_) if pattern.ends_with(".yaml") => hint(stem(pattern), ids, "shotdamp list"),
        Some(_) => "ids have no `/`: a folder is named with --folder, an entry with `shotdamp explain`".into(),
        None => hint(pattern.trim_end_matches(".yaml"), ids, "shotdamp list"),
    };
    CliError::NoMatch { pattern: pattern.into(), hint }
}

/// The error of an entry that there is not.
pub(super) fn no_entry(entry: &str, judgement: &Judgement) -> CliError {
    let entries = judgement.verdicts.values().flatten().map(|judged| judged.id.as_str()).collect();
    CliError::NoEntry { entry: entry.into(), hint: hint(entry, &entries, "shotdamp check") }
}

/// The name that was probably meant, or those that there are; `all` shows them.
pub(super) fn hint(asked: &str, names: &BTreeSet<&str>, all: &str) -> String {
    if let Some(hint) = did_you_mean(asked, names.iter().copied()) {
        return hint;
    }
    if names.is_empty() {
        return "there are none that can be read".into();
    }
    let with_it: Vec<&str> = names.iter().copied().filter(|name| !asked.is_empty() && name.contains(asked)).collect();
    if with_it.is_empty() {
        return format!("there are {}", some(&names.iter().copied().collect::<Vec<_>>(), all));
    }
    format!("it is part of {}", some(&with_it, all))
}

/// The first of these names; `all` shows them.
fn some(names: &[&str], all: &str) -> String {
    match names {
        few if few.len() <= 8 => few.join(", "),
        many => format!("{}, … ({} in all; see `{all}`)", many[..4].join(", "), many.len()),
    }
}

/// The folders of `experiments/` that hold some.
fn folders(study: &Study) -> String {
    let planned = study.items.iter().map(|item| item.source.folder());
    let folders = planned.chain(study.known.values().map(|known| known.folder.as_str()));
    let folders: BTreeSet<&str> = folders.filter(|folder| !folder.is_empty()).collect();
    if folders.is_empty() { "no folders".into() } else { folders.into_iter().collect::<Vec<_>>().join(", ") }
}

/// `*` stands for any letters, `?` for one.
pub(super) fn matches(pattern: &str, id: &str) -> bool {
    let (pattern, id): (Vec<char>, Vec<char>) = (pattern.chars().collect(), id.chars().collect());
    let (mut p, mut i) = (0, 0);
    // Where the last star stood, and how many letters it has taken so far.
    let mut star: Option<(usize, usize)> = None;
    while i < id.len() {
        if p < pattern.len() && pattern[p] == '*' {
            star = Some((p, i));
            p += 1;
        } else if p < pattern.len() && (pattern[p] == '?' || pattern[p] == id[i]) {
            p += 1;
            i += 1;
        } else if let Some((at, taken)) = star {
            star = Some((at, taken + 1));
            p = at + 1;
            i = taken + 1;
        } else {
            return false;
        }
    }
    pattern[p..].iter().all(|letter| *letter == '*')
}
