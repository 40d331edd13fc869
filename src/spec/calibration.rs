//! A calibration file: which unstated inputs are free, which entries they are fitted to, and which are held out.

use std::collections::BTreeSet;
use std::path::Path;

use crate::scene::{Assumption, AssumptionValue};

use super::assumption_sheet::read_value_of;
use super::diagnostic::{Findings, Problems};
use super::load::read;
use super::reader::{Fields, list, no_such, text};
use super::word::{from_word, words};
use super::yaml::{Entry, Node, Value, read_tree};

/// Most combinations of values: each is a run of every experiment concerned.
const MOST_COMBINATIONS: usize = 10_000;

/// A calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Its title.
    pub title: String,
    /// What it is to show. Markdown.
    pub about: String,
    /// The free inputs.
    pub inputs: Vec<CalibrationInput>,
    /// Ids of the entries to fit.
    pub fit: Vec<String>,
    /// Ids of the entries held out, or `EXPERIMENT/*` for all that are not fitted.
    pub hold_out: Vec<String>,
}

/// A free input: one assumption, or several that are moved together.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrationInput {
    /// As the file names it.
    pub name: String,
    /// The assumptions that it moves.
    pub moves: Vec<Assumption>,
    /// The values that are tried.
    pub values: Vec<AssumptionValue>,
}

impl Calibration {
    /// How many combinations of values there are.
    #[must_use]
    pub fn combinations(&self) -> usize {
        self.inputs.iter().fold(1, |product, input| product.saturating_mul(input.values.len()))
    }
}

/// Reads a calibration file.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn load_calibration(path: &Path) -> Result<Calibration, Problems> {
    let file = path.display().to_string();
    parse_calibration(&file, &read(path, &file)?)
}

/// Reads a calibration from its text; `file` only names it in messages.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn parse_calibration(file: &str, text: &str) -> Result<Calibration, Problems> {
    let findings = Findings::default();
    let calibration = read_tree(text, &findings).and_then(|root| calibration(&root, &findings));
    findings.finish(file, text, calibration)
}

fn calibration(root: &Node, findings: &Findings) -> Option<Calibration> {
    let fields = Fields::open(root, "a calibration", findings)?;
    let title = fields.required("title", |node| text(node, findings));
    let about = fields.required("about", |node| text(node, findings));
    let inputs = fields.required("calibrate", |node| inputs(node, findings));
    let ids = |node| list(node, findings, |node| text(node, findings));
    let fit = fields.required("fit", ids);
    let hold_out = fields.optional("hold_out", ids);
    fields.close()?;
    let calibration = Calibration {
        title: title?,
        about: about?,
        inputs: inputs?,
        fit: fit?,
        hold_out: hold_out?.unwrap_or_default(),
    };
    let combinations = calibration.combinations();
    if combinations > MOST_COMBINATIONS {
        return findings
            .wrong(root.span, format!("{combinations} combinations of values: {MOST_COMBINATIONS} at most"));
    }
    Some(calibration)
}

fn inputs(node: &Node, findings: &Findings) -> Option<Vec<CalibrationInput>> {
    let Value::Mapping(entries) = &node.value else {
        return findings.wrong(node.span, "inputs are written as `assumption: [value, …]`");
    };
    let mut inputs: Vec<CalibrationInput> = Vec::new();
    let mut moved = BTreeSet::new();
    for entry in entries {
        let input = input(entry, findings)?;
        if let Some(name) = input.moves.iter().find(|name| !moved.insert(**name)) {
            return findings.wrong(entry.key_span, format!("{name:?} is moved by two inputs"));
        }
        inputs.push(input);
    }
    if inputs.is_empty() { findings.wrong(node.span, "there is no input to calibrate") } else { Some(inputs) }
}

/// `assumption: [value, …]`, or `name: {moves: [assumption, …], values: [value, …]}`.
fn input(entry: &Entry, findings: &Findings) -> Option<CalibrationInput> {
    let assumption = |word: &str, span| match from_word::<Assumption>(word) {
        Some(name) => Some(name),
        None => no_such(findings, span, "assumption", word, words::<Assumption>()),
    };
    let values = |node: &Node, name: Assumption| {
        let values = list(node, findings, |node| read_value_of(name, node, findings))?;
        if values.is_empty() { findings.wrong(node.span, "there is no value to try") } else { Some(values) }
    };
    let Entry { key, key_span, node } = entry;
    if matches!(node.value, Value::Sequence(_)) {
        let name = assumption(key, *key_span)?;
        return Some(CalibrationInput { name: key.clone(), moves: vec![name], values: values(node, name)? });
    }
    let fields = Fields::open(node, "an input", findings)?;
    let moves =
        fields.required("moves", |node| list(node, findings, |node| assumption(&text(node, findings)?, node.span)));
    let first = moves.as_ref().and_then(|moves| moves.first()).copied();
    let tried = fields.required("values", |node| match first {
        Some(first) => values(node, first),
        None => findings.wrong(node.span, "it moves no assumption"),
    });
    fields.close()?;
    Some(CalibrationInput { name: key.clone(), moves: moves?, values: tried? })
}
