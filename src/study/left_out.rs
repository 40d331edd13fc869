//! What a calibration recorded of its fitted entries, each left out in turn, in a file beside its page. The reports read it
//! like any other text of the study.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::canonical::hash;
use super::texts::Texts;
use crate::experiment::Calibration;
use crate::text::json;

/// Relative errors, the least and the largest, 0 for a claim that holds; none where there is no number.
pub type PredictedErrors = Option<[f64; 2]>;

/// How far off each entry comes out where the others alone choose the inputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOutRecord {
    /// Of what was calibrated.
    calibration: String,
    /// By entry.
    errors: BTreeMap<String, PredictedErrors>,
}

impl LeftOutRecord {
    /// What came of this calibration.
    #[must_use]
    pub fn of(calibration: &Calibration, errors: BTreeMap<String, PredictedErrors>) -> Self {
        Self { calibration: hash(calibration.question().as_bytes()), errors }
    }

    /// The name of its file within the study; `id` is the calibration's.
    #[must_use]
    pub fn name(id: &str) -> String {
        format!("reports/calibrations/{id}.json")
    }

    /// The file's text.
    #[must_use]
    pub fn text(&self) -> String {
        json::page(self)
    }

    /// The entries that calibrations left out in turn, as they are asked for now, each with the widest range.
    pub(super) fn all(
        texts: &Texts,
        calibrations: &BTreeMap<String, Calibration>,
    ) -> BTreeMap<String, PredictedErrors> {
        let mut all: BTreeMap<String, PredictedErrors> = BTreeMap::new();
        for (id, calibration) in calibrations.iter().filter(|(_, calibration)| calibration.leave_one_out) {
            let record = texts.bytes(&Self::name(id)).and_then(|bytes| serde_json::from_slice::<Self>(bytes).ok());
            let asked = hash(calibration.question().as_bytes());
            for (entry, errors) in record.filter(|it| it.calibration == asked).into_iter().flat_map(|it| it.errors) {
                let known = all.entry(entry).or_insert(errors);
                *known = known.zip(errors).map(|([a, b], [c, d])| [a.min(c), b.max(d)]);
            }
        }
        all
    }
}
