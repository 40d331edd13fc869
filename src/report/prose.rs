//! Numbers into prose: explanations and reasons with the numbers of the tables.

use std::collections::BTreeMap;

use crate::reference::{Judged, Prose};

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
