//! The assumptions file: each input that a study uses and does not state, with kind, value, reason and range.
//!
//! ```yaml
//! defaults:
//!   run: {skip: 25 cycles, average: 100 cycles}   # of experiments that do not say
//!   gravity: gravity                 # which assumption stands where one says `assumed` or leaves the slot out: on every structure
//!   modes: {cantilever_beam: eight_modes, supported_plate: six_a_side}
//! gravity: {quantity: acceleration, value: 9.81 m/s^2, range: [9.80665 m/s^2], reason: The usual rounding.}
//! ```
//!
//! The range is what a reader may believe as well; moving one assumption at a time to its ends gives the sensitivity of
//! every number to what is not known.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::assumption::{AssumptionName, AssumptionValue};
use super::quantity::AssumptionKind;
use super::slot::Slot;
use crate::experiment::stated::{StatedByChapter, Statement};
use crate::yaml::reader::{no_such, scalar};
use crate::yaml::word::closest;
use crate::yaml::{Findings, Node, Place, Problems};

/// The name of the file within a study.
pub const ASSUMPTIONS: &str = "experiments/assumptions.yaml";

/// The assumptions with all that the file says of them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AssumptionSheet {
    /// Entries in the order of the file.
    pub(in crate::experiment) entries: Vec<(AssumptionName, Arc<AssumptionEntry>)>,
    /// Which assumption stands for a slot on a kind of structure.
    pub(in crate::experiment) defaults: Arc<Defaults>,
    /// The cycles of experiments that do not say.
    pub(in crate::experiment) cycles: Option<Cycles>,
    /// What the text states, by chapter.
    pub(in crate::experiment) stated: Arc<StatedByChapter>,
}

/// The assumption of each slot that has one, by kind of structure.
pub(in crate::experiment) type Defaults = BTreeMap<(Slot, &'static str), AssumptionName>;

/// How many forcing cycles a run skips, and over how many it averages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cycles {
    /// Left out as transient.
    pub skip: u32,
    /// Averaged over.
    pub average: u32,
}

/// One assumption.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AssumptionEntry {
    /// What kind of value it has.
    pub kind: AssumptionKind,
    /// The value in force.
    pub value: AssumptionValue,
    /// Why this value. Markdown.
    pub reason: String,
    /// Other values that could be defended: the ends of an interval, or the other readings. May be empty.
    pub range: Vec<AssumptionValue>,
    /// Ids of the reference entries that the value was chosen by: their agreement proves nothing.
    pub fitted_to: Vec<String>,
    /// Where its name stands in the file.
    #[serde(skip)]
    pub place: Place,
}

/// The assumption that is moved under this label, `assumption=value`; another text as it is.
pub(crate) fn assumption_of(label: &str) -> &str {
    label.split_once('=').map_or(label, |(name, _)| name)
}

/// The assumptions in force: a value for each, and the sheet that declares them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Assumptions {
    /// The values.
    pub values: BTreeMap<AssumptionName, AssumptionValue>,
    /// Where they are declared.
    pub sheet: Arc<AssumptionSheet>,
}

/// One assumption moved to a value of its range.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// Such as `stop_length=0.05`.
    pub label: String,
    /// Which.
    pub name: AssumptionName,
    /// All values in force then.
    pub assumptions: Assumptions,
}

impl AssumptionEntry {
    /// Its range has values beside the one in force.
    #[must_use]
    pub fn has_range(&self) -> bool {
        self.moves().next().is_some()
    }

    /// The other values of its range, each as it is named in the label of a variant.
    fn moves(&self) -> impl Iterator<Item = (String, &AssumptionValue)> {
        self.range.iter().filter(|value| **value != self.value).enumerate().map(|(index, value)| {
            let description = match value {
                AssumptionValue::Number(number) => number.to_string(),
                AssumptionValue::Choice(word) => word.clone(),
                AssumptionValue::Curve(_) => format!("curve_{}", index + 1),
                AssumptionValue::Places(_) => format!("places_{}", index + 1),
            };
            (description, value)
        })
    }
}

impl AssumptionSheet {
    /// The ids of the entries of references that an assumption was fitted to.
    #[must_use]
    pub fn fitted(&self) -> BTreeSet<String> {
        self.iter().flat_map(|(_, entry)| entry.fitted_to.iter().cloned()).collect()
    }

    /// The entries in the order of the file.
    pub fn iter(&self) -> impl Iterator<Item = (&AssumptionName, &AssumptionEntry)> {
        self.entries.iter().map(|(name, entry)| (name, entry.as_ref()))
    }

    /// The entry of this name.
    #[must_use]
    pub fn get(&self, name: &AssumptionName) -> Option<&AssumptionEntry> {
        self.iter().find(|(known, _)| *known == name).map(|(_, entry)| entry)
    }

    /// The assumption that stands for a slot on this kind of structure, if the study declares one.
    #[must_use]
    pub fn default_of(&self, slot: Slot, structure: &'static str) -> Option<&AssumptionName> {
        self.defaults.get(&(slot, structure))
    }

    /// The assumptions that stand for a slot by default, with the slot and the kind of structure.
    pub fn defaults(&self) -> impl Iterator<Item = (Slot, &'static str, &AssumptionName)> {
        self.defaults.iter().map(|((slot, structure), name)| (*slot, *structure, name))
    }

    /// The cycles of experiments that do not say.
    #[must_use]
    pub fn cycles(&self) -> Option<Cycles> {
        self.cycles
    }

    /// What the text of this chapter states of the inputs.
    pub(in crate::experiment) fn stated(&self, chapter: Option<u32>) -> &[Statement] {
        chapter.and_then(|number| self.stated.get(&number)).map_or(&[], Vec::as_slice)
    }

    /// The values in force.
    #[must_use]
    pub fn assumptions(&self) -> Assumptions {
        let values = self.iter().map(|(name, entry)| (name.clone(), entry.value.clone())).collect();
        Assumptions { values, sheet: Arc::new(self.clone()) }
    }

    /// One assumption at a time moved to each value of its range.
    #[must_use]
    pub fn variants(&self, of: &BTreeSet<AssumptionName>) -> Vec<Moved> {
        let mut variants = Vec::new();
        let in_force = self.assumptions();
        for (name, entry) in self.iter().filter(|(name, _)| of.contains(*name)) {
            for (description, value) in entry.moves() {
                let mut assumptions = in_force.clone();
                assumptions.values.insert(name.clone(), value.clone());
                variants.push(Moved { label: format!("{name}={description}"), name: name.clone(), assumptions });
            }
        }
        variants
    }

    /// Some assumption is moved under this label.
    #[must_use]
    pub fn has_variant(&self, label: &str) -> bool {
        let moves = |entry: &AssumptionEntry, to: &str| entry.moves().any(|(description, _)| description == to);
        label
            .split_once('=')
            .is_some_and(|(name, to)| self.iter().any(|(own, entry)| own.as_str() == name && moves(entry, to)))
    }

    /// Names as they are declared, for suggestions.
    pub(in crate::experiment) fn names(&self) -> Vec<&str> {
        self.iter().map(|(name, _)| name.as_str()).collect()
    }

    /// Warnings of the assumptions that nothing uses; `file` and `text` are those that the sheet was read from.
    #[must_use]
    pub fn unused(&self, file: &str, text: &str, is_used: impl Fn(&AssumptionName) -> bool) -> Option<Problems> {
        let unused = self.iter().filter(|(name, _)| !is_used(name)).map(|(name, entry)| {
            let help =
                format!("write `{{assumed: {name}}}` where it is meant, make it the default of a slot, or remove it");
            (entry.place, format!("no experiment uses the assumption `{name}`"), help)
        });
        Problems::warnings(file, text, unused)
    }

    /// The declared name that a word is, or a refusal with the nearest one.
    pub(in crate::experiment) fn named(&self, node: &Node, findings: &Findings) -> Option<AssumptionName> {
        let word = scalar(node, findings)?;
        if let Some((name, _)) = self.iter().find(|(name, _)| name.as_str() == word) {
            return Some(name.clone());
        }
        if closest(word, self.names()).is_some() {
            return no_such(findings, node.span, "assumption", word, &self.names());
        }
        let help = format!("declare it in {ASSUMPTIONS}: `{word}: {{quantity: …, value: …, reason: …}}`");
        findings.report(node.span, format!("`{word}` is not an assumption"), Some(help))
    }
}
