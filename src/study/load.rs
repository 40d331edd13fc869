//! Texts to experiments, with an error for every file that cannot be read.

use super::file_ids::FileIds;
use super::file_kind::FileKind;
use super::layout::{ASSUMPTIONS, STUDY, folder_of, stem};
use super::refused::Refused;
use super::texts::{Bytes, Texts};
use crate::experiment::{
    AboutStudy, AssumptionSheet, Assumptions, Cases, Columns, Experiment, parse_assumptions, parse_study, parse_with,
};
use crate::text::utf8::decode;
use crate::yaml::Problems;

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

impl Loaded {
    /// The columns that the table of an experiment will have, which may be among those that were not asked for; nothing of one
    /// that there is not, or that has mistakes.
    pub(super) fn columns(&self, texts: &Texts, id: &str) -> Option<Columns> {
        if let Some(source) = self.sources.iter().find(|source| source.experiment.id.0 == id) {
            return Some(source.experiment.columns());
        }
        let (file, bytes) = texts.of(FileKind::Experiment).find(|(file, _)| stem(file) == id)?;
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
        let experiments = || texts.of(FileKind::Experiment).filter(|(file, _)| wanted(stem(file)));
        let ids = FileIds::of(experiments().map(|(file, _)| file));
        for (file, bytes) in experiments() {
            let source = text(file, bytes).and_then(|text| {
                let id = ids.id_of(file)?;
                let on_untried =
                    |experiment: &Experiment| on_untried(&Untried { experiment, file, assumptions: &assumptions });
                let cases = if tried(&id.0) { Cases::Tried } else { Cases::ToTry(&on_untried) };
                let experiment = parse_with(&id, file, text, &assumptions, cases).map_err(Refused::Text)?;
                Ok(Source { experiment, file: file.into() })
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

pub(super) fn text<'a>(file: &str, bytes: &'a Bytes) -> Result<&'a str, Refused> {
    let bytes = bytes.as_ref().map_err(|error| Refused::Unreadable { file: file.into(), error: error.clone() })?;
    decode(bytes).map_err(|error| Refused::Encoding { file: file.into(), error })
}
