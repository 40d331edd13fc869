//! Which study, and which of its experiments.

use std::collections::BTreeSet;
use std::path::Path;

use super::args::Choice;
use super::error::CliError;
use super::exit::Exit;
use crate::reference::Verdict;
use crate::report::Judgement;
use crate::study::{ASSUMPTIONS, Item, Layout, Study, Texts, Unread};

/// The study that is meant.
pub(super) fn layout(root: Option<&Path>) -> Result<Layout, CliError> {
    if let Some(root) = root {
        let layout = Layout::new(root);
        return if layout.path("experiments").is_dir() { Ok(layout) } else { Err(CliError::NoStudyAt(root.into())) };
    }
    let here = std::env::current_dir()?;
    Layout::find(&here).ok_or(CliError::NoStudy(here))
}

/// Reads and plans the study.
pub(super) fn open(layout: &Layout) -> Result<Study, CliError> {
    Ok(Study::new(layout.clone(), Texts::read(layout)?))
}

impl Choice {
    /// True for all experiments.
    pub fn is_all(&self) -> bool {
        self.patterns.is_empty() && self.chapter.is_none()
    }

    fn admits(&self, id: &str, chapter: u32) -> bool {
        self.chapter.is_none_or(|wanted| wanted == chapter)
            && (self.patterns.is_empty() || self.patterns.iter().any(|pattern| matches(pattern, id)))
    }
}

/// The experiments, files and entries that a command is about.
pub(super) struct Chosen<'a> {
    /// Experiments that could be read.
    pub items: Vec<&'a Item>,
    /// Files that could not.
    pub unread: Vec<&'a Unread>,
    /// Ids of experiments and of reference files.
    pub ids: BTreeSet<&'a str>,
}

/// What `choice` means in this study.
///
/// # Errors
/// A pattern or a chapter that nothing answers to: it would otherwise pass for success.
pub(super) fn choose<'a>(study: &'a Study, choice: &Choice) -> Result<Chosen<'a>, CliError> {
    if study.items.is_empty() && study.unread.is_empty() {
        return Err(CliError::NoExperiments);
    }
    let chosen = Chosen {
        items: study
            .items
            .iter()
            .filter(|item| choice.admits(&item.source.experiment.id.0, item.source.experiment.source.chapter))
            .collect(),
        unread: study
            .unread
            .iter()
            .filter(|unread| {
                unread.file() == ASSUMPTIONS || choice.admits(stem(unread.file()), chapter_of(unread.file()))
            })
            .collect(),
        ids: BTreeSet::new(),
    };
    // The assumptions are everybody's: while they cannot be read, no pattern can be told from a wrong one.
    let blind = chosen.unread.iter().any(|unread| unread.file() == ASSUMPTIONS);
    let stems: Vec<&str> = chosen.unread.iter().map(|unread| stem(unread.file())).collect();
    let answers = |pattern: &&String| {
        let known = chosen.items.iter().map(|item| item.source.experiment.id.0.as_str());
        known.chain(stems.iter().copied()).any(|id| matches(pattern, id))
    };
    if let Some(pattern) = choice.patterns.iter().find(|pattern| !blind && !answers(pattern)) {
        return Err(CliError::NoMatch { pattern: pattern.clone(), known: known(study) });
    }
    if let Some(chapter) = choice.chapter.filter(|_| chosen.items.is_empty() && chosen.unread.is_empty()) {
        return Err(CliError::NoChapter(chapter));
    }
    let items = chosen.items.iter().map(|item| item.source.experiment.id.0.as_str());
    // A reference without its experiment is missing it, and must not be passed over.
    let orphans = study.references.keys().map(String::as_str);
    let orphans = orphans.filter(|id| study.items.iter().all(|item| item.source.experiment.id.0 != *id));
    let ids = items.chain(orphans.filter(|id| choice.admits(id, chapter_of(id)))).collect();
    Ok(Chosen { ids, ..chosen })
}

impl Chosen<'_> {
    /// What the verdicts and what could not be read come to.
    pub fn exit(&self, judgement: &Judgement) -> Exit {
        let verdicts = judgement.verdicts.iter().filter(|(id, _)| self.ids.contains(id.as_str())).flat_map(|(_, v)| v);
        let verdict = |judged: &crate::reference::Judged| match judged {
            judged if judged.verdict == Verdict::Missing => Exit::CouldNot,
            judged if judged.as_expected() => Exit::AsExpected,
            _ => Exit::Unexpected,
        };
        let unread = if self.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot };
        verdicts.map(verdict).chain([unread]).max().unwrap_or(Exit::AsExpected)
    }
}

fn known(study: &Study) -> String {
    let ids: Vec<&str> = study.items.iter().map(|item| item.source.experiment.id.0.as_str()).collect();
    match ids.as_slice() {
        [] => "none that can be read".into(),
        few if few.len() <= 8 => few.join(", "),
        many => format!("{}, … ({} in all; see `shotdamp list`)", many[..4].join(", "), many.len()),
    }
}

/// Of a file that could not be read the name is all there is.
fn stem(file: &str) -> &str {
    let name = file.rsplit('/').next().unwrap_or(file);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

/// The chapter that a name speaks of, `ch3-gap` or `experiments/ch3/…`; 0 if none.
pub(super) fn chapter_of(name: &str) -> u32 {
    let chapter = |part: &str| -> Option<u32> {
        let digits: String = part.strip_prefix("ch")?.chars().take_while(char::is_ascii_digit).collect();
        digits.parse().ok()
    };
    name.split('/').find_map(chapter).unwrap_or(0)
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
