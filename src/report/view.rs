//! What reports are written from, gathered by the caller.

use crate::experiment::Experiment;
use crate::reference::{Judged, NotJudged};
use crate::scene::EffectUse;
use crate::study::{Heading, Motions};
use crate::table::Table;

/// An assumption in force, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AssumptionView {
    /// `stop_length`.
    pub name: String,
    /// `60 mm`; see [`crate::experiment::value_in_words`].
    pub value: String,
    /// Other values could be defended.
    pub has_range: bool,
    /// Why this value. Markdown.
    pub reason: String,
    /// Ids of the entries whose experiments depend on it.
    pub used_by: Vec<String>,
    /// Ids of the entries that it was chosen by.
    pub fitted_to: Vec<String>,
}

/// A figure as a link.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FigureView {
    /// Relative to the text that shows it.
    pub link: String,
    /// One line under it.
    pub caption: String,
    /// Why there is no such file; `None` if there is.
    pub missing: Option<String>,
}

/// The measured page of what accuracy costs, as a link.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AccuracyLinks {
    /// Relative to the text that shows it.
    pub page: String,
}

/// One experiment with its verdicts, for the index and the console.
#[derive(Debug, Clone)]
pub struct ExperimentView<'a> {
    /// The experiment.
    pub experiment: Heading,
    /// Its entries with their verdicts.
    pub judged: &'a [Judged],
    /// Processor time that its simulations took, s, where somebody has measured it.
    pub seconds: Option<f64>,
    /// What moves how in it, where that is measured.
    pub motions: Option<Motions>,
    /// Its page, relative to the index.
    pub page: String,
}

impl ExperimentView<'_> {
    /// Where one of its entries stands, relative to the index.
    pub(super) fn place_of(&self, judged: &Judged) -> String {
        format!("{}#{}", self.page, anchor(name(judged)))
    }
}

/// All that one experiment's page tells.
#[derive(Debug, Clone)]
pub struct PageView<'a> {
    /// The experiment.
    pub experiment: &'a Experiment,
    /// Its table; `None` if it has none.
    pub table: Option<&'a Table>,
    /// What moves how in it, where that is measured.
    pub motions: Option<&'a Motions>,
    /// Its entries with their verdicts.
    pub judged: &'a [Judged],
    /// What the study says of it without an entry.
    pub not_judged: &'a [NotJudged],
    /// The assumptions that it depends on.
    pub assumptions: &'a [AssumptionView],
    /// Effects over its cases.
    pub effects: &'a [EffectUse],
    /// Its figures, relative to the page.
    pub figures: &'a [FigureView],
    /// Its table, by its name within the study.
    pub table_name: &'a str,
    /// What its accuracy costs, if it was measured.
    pub accuracy: Option<AccuracyLinks>,
    /// The way to `reports/`: empty or ends in `/`.
    pub to_reports: &'a str,
}

/// The entry's name without its experiment's.
pub(super) fn name(judged: &Judged) -> &str {
    judged.id.rsplit('/').next().unwrap_or(&judged.id)
}

/// A name as the target of a link within a page; the prefix keeps it apart from headings.
pub(super) fn anchor(name: &str) -> String {
    format!("entry-{name}")
}
