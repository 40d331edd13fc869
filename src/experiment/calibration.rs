//! A calibration file: which unstated inputs are free, which entries they are fitted to, and which are held out.
//!
//! ```yaml
//! title: Inputs of chapter 5
//! about: What it is to show.
//! finding: What it showed, written by hand when it has been run.     # may be absent
//! search: {coordinate: {starts: 2, budget: 110 sets}}                 # every combination if absent
//! ensemble: 4 members                                                # of chaotic points; single runs if absent
//! residual: logarithmic                                              # of ratios to the printed numbers; of relative errors if absent
//! calibrate:
//!   damping_ratio_of_floors: [0.1, 0.2, equivalent_viscous]           # values of an assumption
//!   curve_height: {scales: curve_of_the_foam, by: [0.5, 1, 2]}      # factors of one
//!   damper_mass: {moves: [mass_on_beams, mass_on_plates], values: [total, modal]}   # several at once
//!   impulse: {moves: [factor_of_impulses, time_of_impulses], values: [[1, radian], [2, half_sine]]}
//!   solver: [event_driven, {fixed_step: {time_step: 1 ms}}]
//! fit: [ch5-impulse-ratio/tuned-184]
//! hold_out: [ch5-mass-crossing/*]
//! ```

use std::collections::BTreeSet;
use std::path::Path;

use serde::Deserialize;

use super::recipe::{AssumptionName, AssumptionValue};

use super::assumption_sheet::{AssumptionSheet, Quantity};
use super::at::At;
use super::diagnostic::{Findings, Problems};
use super::load::read;
use super::reader::{Choice, Fields, all, count, list, no_such, number, text, word};
use super::solver::read_solver;
use super::yaml::{Entry, Node, Value, read_tree};
use crate::measure::SolverChoice;

/// Most combinations of values of a full grid: each is a run of every experiment concerned.
const MOST_COMBINATIONS: usize = 10_000;
/// Most sets of inputs that a search may try.
const MOST_SETS: u32 = 10_000;

/// A calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Its title.
    pub title: String,
    /// What it is to show. Markdown.
    pub about: String,
    /// What its result means, written by a person who has seen it. Markdown; empty before that.
    pub finding: String,
    /// The free inputs.
    pub inputs: Vec<CalibrationInput>,
    /// How their values are searched.
    pub search: CalibrationSearch,
    /// Members of the ensemble that a chaotic point gets in the search; 0: a single run, as in the study.
    pub ensemble: u32,
    /// What of a number's error is squared and summed.
    pub residual: Residual,
    /// Ids of the entries to fit, or `EXPERIMENT/*` for all of an experiment.
    pub fit: Vec<String>,
    /// Ids of the entries held out, or `EXPERIMENT/*` for all that are not fitted.
    pub hold_out: Vec<String>,
}

/// How the sets of inputs to be tried are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CalibrationSearch {
    /// Every combination of the values.
    Grid,
    /// One input after the other, all others held, from several starts.
    Coordinate {
        /// Starts: the inputs in force first, the others drawn.
        starts: u32,
        /// Most sets that are tried.
        budget: u32,
    },
}

/// The error of a number that comes out as s where d is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Residual {
    /// (s − d)/d.
    #[default]
    Relative,
    /// ln(s/d): twice and half as much are equally far off.
    Logarithmic,
}

/// A free input.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrationInput {
    /// As the file names it.
    pub name: String,
    /// What is tried.
    pub tried: Tried,
}

/// The values of a free input.
#[derive(Debug, Clone, PartialEq)]
pub enum Tried {
    /// Values of an assumption, or of several that are moved together.
    Values {
        /// The assumptions.
        moves: Vec<AssumptionName>,
        /// Unit symbols of their numbers.
        units: Vec<&'static str>,
        /// The values, each one for every assumption.
        values: Vec<Vec<AssumptionValue>>,
    },
    /// Factors of an assumption that is a number or a curve.
    Factors {
        /// The assumption, as in force or as another input has set it.
        of: AssumptionName,
        /// The factors.
        by: Vec<f64>,
    },
    /// Solvers, in the place of the exact one.
    Solvers(Vec<SolverChoice>),
}

impl Tried {
    /// How many values there are.
    #[must_use]
    pub fn count(&self) -> usize {
        match self {
            Self::Values { values, .. } => values.len(),
            Self::Factors { by, .. } => by.len(),
            Self::Solvers(solvers) => solvers.len(),
        }
    }
}

impl Calibration {
    /// How many combinations of values there are.
    #[must_use]
    pub fn combinations(&self) -> usize {
        self.inputs.iter().fold(1, |product, input| product.saturating_mul(input.tried.count()))
    }
}

/// Reads a calibration file.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn load_calibration(path: &Path, sheet: &AssumptionSheet) -> Result<Calibration, Problems> {
    let file = path.display().to_string();
    parse_calibration(&file, &read(path, &file)?, sheet)
}

/// Reads a calibration from its text; `file` only names it in messages.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn parse_calibration(file: &str, text: &str, sheet: &AssumptionSheet) -> Result<Calibration, Problems> {
    let findings = Findings::default();
    let calibration = read_tree(text, &findings).and_then(|root| calibration(&root, sheet, &findings));
    findings.finish(file, text, calibration)
}

fn calibration(root: &Node, sheet: &AssumptionSheet, findings: &Findings) -> Option<Calibration> {
    let fields = Fields::open(root, "a calibration", findings)?;
    let title = fields.required("title", |node| text(node, findings));
    let about = fields.required("about", |node| text(node, findings));
    let finding = fields.optional("finding", |node| text(node, findings));
    let inputs = fields.required("calibrate", |node| inputs(node, sheet, findings));
    let search = fields.optional("search", |node| search(node, findings));
    let ensemble = fields.optional("ensemble", |node| some(node, "members", findings));
    let residual = fields.optional("residual", |node| word::<Residual>(node, "residual", findings));
    let ids = |node| list(node, findings, |node| text(node, findings));
    let fit = fields.required("fit", ids);
    let hold_out = fields.optional("hold_out", ids);
    fields.close()?;
    let calibration = Calibration {
        title: title?,
        about: about?,
        finding: finding?.unwrap_or_default(),
        inputs: inputs?,
        search: search?.unwrap_or(CalibrationSearch::Grid),
        ensemble: ensemble?.unwrap_or(0),
        residual: residual?.unwrap_or_default(),
        fit: fit?,
        hold_out: hold_out?.unwrap_or_default(),
    };
    let combinations = calibration.combinations();
    if calibration.search == CalibrationSearch::Grid && combinations > MOST_COMBINATIONS {
        return findings.report(
            root.span,
            format!("{combinations} combinations of values: {MOST_COMBINATIONS} at most"),
            Some("write `search: {coordinate: {starts: 4, budget: 400 sets}}`, which tries a part of them".into()),
        );
    }
    Some(calibration)
}

/// `grid`, or `{coordinate: {starts: 4, budget: 400 sets}}`.
fn search(node: &Node, findings: &Findings) -> Option<CalibrationSearch> {
    let choice = Choice::read(node, "a search", &["grid", "coordinate"], findings)?;
    if choice.name == "grid" {
        choice.bare(findings)?;
        return Some(CalibrationSearch::Grid);
    }
    let fields = choice.fields("a coordinate search", findings)?;
    let starts = fields.required("starts", |node| some(node, "starts", findings));
    let budget = fields.required("budget", |node| some(node, "sets", findings));
    fields.close()?;
    Some(CalibrationSearch::Coordinate { starts: starts?, budget: budget? })
}

/// A number of things, one at least.
fn some(node: &Node, noun: &str, findings: &Findings) -> Option<u32> {
    match count(node, noun, MOST_SETS, findings)? {
        0 => findings.wrong(node.span, format!("no {noun} at all would find nothing")),
        some => Some(some),
    }
}

fn inputs(node: &Node, sheet: &AssumptionSheet, findings: &Findings) -> Option<Vec<CalibrationInput>> {
    let Value::Mapping(entries) = &node.value else {
        return findings.wrong(node.span, "inputs are written as `assumption: [value, …]`");
    };
    let mut inputs: Vec<CalibrationInput> = Vec::new();
    let mut moved = BTreeSet::new();
    for entry in entries {
        let input = input(entry, sheet, findings)?;
        if let Tried::Values { moves, .. } = &input.tried
            && let Some(name) = moves.iter().find(|name| !moved.insert((*name).clone()))
        {
            return findings.wrong(entry.key_span, format!("`{name}` is moved by two inputs"));
        }
        inputs.push(input);
    }
    if inputs.is_empty() { findings.wrong(node.span, "there is no input to calibrate") } else { Some(inputs) }
}

/// `assumption: [value, …]`, `name: {moves: [assumption, …], values: [value, …]}` with a value for all of them or a list of one
/// for each, `name: {scales: assumption, by: [factor, …]}`, or `solver: [event_driven, {fixed_step: …}]`.
fn input(entry: &Entry, sheet: &AssumptionSheet, findings: &Findings) -> Option<CalibrationInput> {
    let Entry { key, key_span, node } = entry;
    let input = |tried| Some(CalibrationInput { name: key.clone(), tried });
    if key == "solver" {
        return input(Tried::Solvers(list(node, findings, |node| read_solver(At::Node(node, findings)))?));
    }
    let value = |node: &Node, moves: &[AssumptionName]| {
        let are_places =
            |name: &AssumptionName| sheet.get(name).is_some_and(|entry| entry.kind.quantity == Some(Quantity::Places));
        // Places are a list themselves.
        let (Value::Sequence(each), false) = (&node.value, matches!(moves, [name] if are_places(name))) else {
            return all(moves.iter().map(|name| sheet.value_of(name, node, findings)));
        };
        if each.len() != moves.len() {
            return findings.wrong(node.span, format!("{} values for {} assumptions", each.len(), moves.len()));
        }
        all(moves.iter().zip(each).map(|(name, node)| sheet.value_of(name, node, findings)))
    };
    let units = |moves: &[AssumptionName]| -> Vec<&'static str> {
        moves.iter().map(|name| sheet.get(name).map_or("", |entry| entry.kind.unit())).collect()
    };
    let values = |node: &Node, moves: &[AssumptionName]| list(node, findings, |node| value(node, moves));
    if matches!(node.value, Value::Sequence(_)) {
        let Some((name, _)) = sheet.iter().find(|(name, _)| name.as_str() == key) else {
            return no_such(findings, *key_span, "assumption", key, &sheet.names());
        };
        let tried = values(node, std::slice::from_ref(name))?;
        return input(Tried::Values {
            units: units(std::slice::from_ref(name)),
            moves: vec![name.clone()],
            values: tried,
        });
    }
    let named = |node: &Node| sheet.named(node, findings);
    let fields = Fields::open(node, "an input", findings)?;
    let tried = match fields.exactly_one(&["moves", "scales"]) {
        Some(("moves", node)) => {
            let moves = list(node, findings, named);
            let tried = fields.required("values", |node| values(node, moves.as_ref()?));
            moves.zip(tried).map(|(moves, values)| Tried::Values { units: units(&moves), moves, values })
        }
        Some((_, node)) => {
            let factor = |node: &Node| match number(node, findings)? {
                factor if factor > 0.0 => Some(factor),
                _ => findings.wrong(node.span, "a factor above zero is wanted"),
            };
            let by = fields.required("by", |node| list(node, findings, factor));
            named(node).zip(by).map(|(of, by)| Tried::Factors { of, by })
        }
        None => None,
    };
    fields.close()?;
    input(tried?)
}
