//! What the parts of an experiment share.

use serde_json::Value;

use super::{assumptions, scene, sweep};
use crate::experiment::assumption_sheet::AssumptionSheet;

pub(in crate::experiment) fn definitions(sheet: &AssumptionSheet) -> Vec<(String, Value)> {
    [sweep::definitions(), scene::definitions(), assumptions::definitions(sheet)].concat()
}
