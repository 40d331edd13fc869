//! Texts to experiments, with an error for every file that cannot be read.

use std::collections::BTreeMap;

use super::layout::{ASSUMPTIONS, STUDY, folder_of, stem};
use super::texts::{Bytes, Texts, Unreadable};
use crate::experiment::{
    AboutStudy, AssumptionSheet, Assumptions, Cases, Columns, Experiment, ExperimentId, IdError, parse_assumptions,
    parse_study, parse_with,
};
use crate::text::utf8::{NotUtf8, decode};
use crate::yaml::Problems;

/// How the file of an experiment ends.
const YAML: &str = ".yaml";

/// The experiments of a study with the assumptions that they share.
#[derive(Debug, Default)]
pub struct Loaded {
    /// What the study says of itself; nothing if there is no such file.
    pub about: AboutStudy,
    /// The assumptions; empty if there is no such file.
    pub sheet: AssumptionSheet,
    /// What could be read, by name of the file.
    pub sources: Vec<Source>,
    /// What could not.
    pub refused: Vec<Refused>,
}

/// An experiment and the file that it stands in.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// The experiment.
    pub experiment: Experiment,
    /// Its file within the study, `experiments/ch3/ch3-gap.yaml`.
    pub file: String,
}

impl Source {
    /// The folder of the file below `experiments/`: `ch3`; empty for a file that stands there itself.
    #[must_use]
    pub fn folder(&self) -> &str {
        folder_of(&self.file)
    }
}

/// An experiment that was read, before its cases are tried, which takes longest.
#[derive(Debug, Clone, Copy)]
pub struct Untried<'a> {
    /// The experiment.
    pub experiment: &'a Experiment,
    /// Its file within the study.
    pub file: &'a str,
    /// What it is read with.
    pub assumptions: &'a Assumptions,
}

/// A file that is not what it should be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Refused {
    /// Its text has mistakes.
    #[error("{0}")]
    Text(#[from] Problems),
    /// Its name does not make an id.
    #[error("{file}: {error}")]
    Name {
        /// Which file.
        file: String,
        /// What is wrong with it.
        error: IdError,
    },
    /// It cannot be read at all.
    #[error("{file} cannot be read: {error}")]
    Unreadable {
        /// Which file.
        file: String,
        /// Why.
        error: Unreadable,
    },
    /// It is not a text.
    #[error("{file}: this is {error}")]
    Encoding {
        /// Which file.
        file: String,
        /// The first bad byte.
        error: NotUtf8,
    },
    /// Another ending than the one that is looked for would be overlooked.
    #[error("{0}: rename it to end in .yaml")]
    Ending(String),
    /// Two files of one id would write into each other's table; nobody knows which of them is meant.
    #[error("{file}: {other} has the same id; an id stands for one experiment in the whole study")]
    Twice {
        /// Which file.
        file: String,
        /// Another one.
        other: String,
    },
}

impl Refused {
    /// The mistakes with their lines, where there are lines.
    #[must_use]
    pub fn problems(&self) -> Option<&Problems> {
        match self {
            Self::Text(problems) => Some(problems),
            _ => None,
        }
    }

    /// Each mistake in words, with its line, counted from 1, if it has one.
    #[must_use]
    pub fn mistakes(&self) -> Vec<(Option<u64>, String)> {
        match self {
            Self::Text(problems) => problems.one_by_one(),
            Self::Encoding { error, .. } => vec![(u64::try_from(error.line).ok(), self.to_string())],
            Self::Unreadable { .. } | Self::Name { .. } | Self::Ending(_) | Self::Twice { .. } => {
                vec![(None, self.to_string())]
            }
        }
    }

    /// The name of the file.
    #[must_use]
    pub fn file(&self) -> &str {
        match self {
            Self::Text(problems) => &problems.file,
            Self::Unreadable { file, .. }
            | Self::Name { file, .. }
            | Self::Encoding { file, .. }
            | Self::Ending(file)
            | Self::Twice { file, .. } => file,
        }
    }
}

impl Loaded {
    /// The columns that the table of an experiment will have, which may be among those that were not asked for; nothing of one
    /// that there is not, or that has mistakes.
    pub(super) fn columns(&self, texts: &Texts, id: &str) -> Option<Columns> {
        if let Some(source) = self.sources.iter().find(|source| source.experiment.id.0 == id) {
            return Some(source.experiment.columns());
        }
        let is_it = |file: &str| Texts::is_experiment(file) && stem(file) == id;
        let (file, bytes) = texts.files.iter().find(|(file, _)| is_it(file))?;
        let text = text(file, bytes).ok()?;
        let read = parse_with(&id.parse().ok()?, file, text, &self.sheet.assumptions(), Cases::Tried);
        read.ok().map(|experiment| experiment.columns())
    }

    /// Reads all experiments among `texts`.
    #[must_use]
    pub fn from_texts(texts: &Texts) -> Self {
        Self::chosen(texts, &|_| true, &|_| false, &|_| {})
    }

    /// Reads the assumptions, and the experiments whose ids are `wanted`; the cases of some were `tried` before, for the others `on_untried`
    /// is called before theirs are.
    #[must_use]
    pub(super) fn chosen(
        texts: &Texts,
        wanted: &dyn Fn(&str) -> bool,
        tried: &dyn Fn(&str) -> bool,
        on_untried: &dyn Fn(&Untried<'_>),
    ) -> Self {
        let mut loaded = Self::default();
        match shared(texts, STUDY, parse_study) {
            Ok(about) => loaded.about = about,
            Err(refused) => loaded.refused.push(refused),
        }
        match shared(texts, ASSUMPTIONS, parse_assumptions) {
            Ok(sheet) => loaded.sheet = sheet,
            Err(refused) => {
                // Without the assumptions every experiment would only repeat that they are absent.
                loaded.refused.push(refused);
                return loaded;
            }
        }
        let assumptions = loaded.sheet.assumptions();
        let experiments = || texts.files.iter().filter(|(file, _)| Texts::is_experiment(file) && wanted(stem(file)));
        let mut files_by_stem = BTreeMap::<&str, Vec<&str>>::new();
        // A file of another ending is refused by itself.
        for (file, _) in experiments().filter(|(file, _)| file.ends_with(YAML)) {
            files_by_stem.entry(stem(file)).or_default().push(file);
        }
        for (file, bytes) in experiments() {
            let source = text(file, bytes).and_then(|text| {
                let id = identify(file, &files_by_stem)?;
                let on_untried =
                    |experiment: &Experiment| on_untried(&Untried { experiment, file, assumptions: &assumptions });
                let cases = if tried(&id.0) { Cases::Tried } else { Cases::ToTry(&on_untried) };
                let experiment = parse_with(&id, file, text, &assumptions, cases).map_err(Refused::Text)?;
                Ok(Source { experiment, file: file.clone() })
            });
            match source {
                Ok(source) => loaded.sources.push(source),
                Err(refused) => loaded.refused.push(refused),
            }
        }
        loaded
    }
}

/// A file that all experiments share; empty if there is none.
fn shared<T: Default>(
    texts: &Texts,
    file: &str,
    parse: impl FnOnce(&str, &str) -> Result<T, Problems>,
) -> Result<T, Refused> {
    let Some(bytes) = texts.files.get(file) else { return Ok(T::default()) };
    parse(file, text(file, bytes)?).map_err(Refused::Text)
}

/// The id that a file's name makes.
fn identify(file: &str, files_by_stem: &BTreeMap<&str, Vec<&str>>) -> Result<ExperimentId, Refused> {
    let name = file.rsplit('/').next().unwrap_or(file);
    let stem = name.strip_suffix(YAML).ok_or_else(|| Refused::Ending(file.into()))?;
    let id: ExperimentId = stem.parse().map_err(|error| Refused::Name { file: file.into(), error })?;
    match files_by_stem.get(stem).and_then(|files| files.iter().find(|other| **other != file)) {
        Some(other) => Err(Refused::Twice { file: file.into(), other: (*other).into() }),
        None => Ok(id),
    }
}

pub(super) fn text<'a>(file: &str, bytes: &'a Bytes) -> Result<&'a str, Refused> {
    let bytes = bytes.as_ref().map_err(|error| Refused::Unreadable { file: file.into(), error: error.clone() })?;
    decode(bytes).map_err(|error| Refused::Encoding { file: file.into(), error })
}
