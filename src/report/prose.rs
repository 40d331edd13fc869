//! Numbers into prose: explanations and reasons with the numbers of the tables.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::reference::{CameOut, Judged, Prose};

/// Fills the placeholders of all explanations.
pub(super) fn fill(verdicts: &mut BTreeMap<String, Vec<Judged>>) {
    let texts: Vec<Vec<String>> = verdicts
        .values()
        .map(|judged| judged.iter().map(|one| filled(verdicts, &one.explanation, Some(one))).collect())
        .collect();
    for (one, text) in verdicts.values_mut().flatten().zip(texts.into_iter().flatten()) {
        one.explanation = text;
    }
}

/// One text with the numbers of the entries that it names; `own` is the entry that it explains, if it is one.
pub(super) fn filled(verdicts: &BTreeMap<String, Vec<Judged>>, text: &str, own: Option<&Judged>) -> String {
    let entry = |name: Option<&str>| -> Option<&Judged> {
        let Some(name) = name else { return own };
        let id = match own {
            Some(own) if !name.contains('/') => format!("{}/{name}", own.experiment),
            _ => name.to_owned(),
        };
        let (experiment, _) = id.split_once('/')?;
        verdicts.get(experiment)?.iter().find(|one| one.id == id)
    };
    // What cannot be read was refused with its file.
    Prose::parse(text).map_or_else(|_| text.to_owned(), |prose| prose.filled(entry))
}

/// An entry as `verdicts.json` has it.
#[derive(Deserialize)]
struct Written {
    id: String,
    found: String,
    moved: Vec<WrittenMove>,
    comparison: Option<WrittenComparison>,
}

#[derive(Deserialize)]
struct WrittenMove {
    variant: String,
    found: String,
}

#[derive(Deserialize)]
struct WrittenComparison {
    simulated: Option<f64>,
    published: Option<f64>,
}

/// The verdicts that were published last, as far as prose quotes them.
#[derive(Deserialize, Default)]
pub struct LastVerdicts {
    entries: Vec<Written>,
}

impl LastVerdicts {
    /// Reads the text of `verdicts.json`; one that cannot be read has no numbers.
    #[must_use]
    pub fn read(text: &str) -> Self {
        serde_json::from_str(text).unwrap_or_default()
    }

    /// The reason of an assumption with the numbers of these verdicts; what they do not have is `…`.
    #[must_use]
    pub fn reason(&self, text: &str) -> String {
        let entry = |name: Option<&str>| {
            let written = self.entries.iter().find(|one| Some(one.id.as_str()) == name)?;
            let moved = written.moved.iter().map(|moved| (moved.variant.as_str(), moved.found.as_str())).collect();
            let error = written.comparison.as_ref().and_then(|it| Some([it.simulated? - it.published?, it.published?]));
            Some(CameOut { found: &written.found, moved, error })
        };
        Prose::parse(text).map_or_else(|_| text.to_owned(), |prose| prose.filled_or("…", entry))
    }
}
