//! What figures and report of an experiment depend on, and whether those on disk were made from just that.

use std::collections::BTreeMap;

use serde_json::json;

use crate::study::{ASSUMPTIONS, Inputs, Item, PRESENTATION_VERSION, Publication, Reason, Record, Study, differences};

/// All that figures and report of an experiment depend on, other experiments' verdicts aside: pages are text, made anew
/// whenever anything at all has changed.
pub(super) fn inputs(study: &Study, item: &Item, record: &Record) -> Inputs {
    let experiment = &item.source.experiment;
    let assumptions: BTreeMap<_, _> = study.sheet.iter().filter(|(name, _)| item.used.contains(*name)).collect();
    Inputs::of([
        ("experiment", experiment.canonical_json()),
        ("assumptions", json!(assumptions)),
        ("reference", json!(study.references.get(&experiment.id.0))),
        ("table", json!(record.table.blake3)),
        ("presentation_version", json!(PRESENTATION_VERSION)),
    ])
}

/// Why figures and report have to be made again; empty if they need not, or cannot because there is no table yet.
#[must_use]
pub fn publication_reasons(study: &Study, item: &Item) -> Vec<Reason> {
    item.record().map_or_else(Vec::new, |record| reasons_beside(study, item, record, &inputs(study, item, record)))
}

/// The same, of what they depend on now.
pub(super) fn reasons_beside(study: &Study, item: &Item, record: &Record, inputs: &Inputs) -> Vec<Reason> {
    let Some(publication) = &record.publication else { return vec![Reason::NeverPublished] };
    let id = &item.source.experiment.id;
    let mut reasons = differences(&publication.inputs, inputs, &|path| match path {
        ["experiment", ..] => item.source.file.clone(),
        ["assumptions", ..] => ASSUMPTIONS.into(),
        ["reference", ..] => format!("reference of {id}"),
        ["table"] => format!("table of {id}"),
        _ => "this program".into(),
    });
    reasons.extend(publication.files.iter().filter_map(|(name, hash)| hash.departs(&study.layout.path(name), name)));
    reasons
}

/// True if the drawing of what is simulated is on disk and comes out the same: it depends on the scenes alone, and on how they
/// are drawn.
pub(super) fn shows_same_scene(old: &Publication, inputs: &Inputs) -> bool {
    old.inputs.agree_in(inputs, &["experiment", "assumptions", "presentation_version"])
}
