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
//! leave_one_out: true                                               # every combination only; false if absent
//! fit: [ch5-impulse-ratio/tuned-184]
//! hold_out: [ch5-mass-crossing/*]
//! ```

use std::collections::BTreeSet;

use serde::Deserialize;
use serde_json::{Value as Schema, json};

use super::assumed_schema;
use super::assumption_reader::any_value;
use super::calibration_input::{CalibrationInput, Tried};
use super::finding::FindingText;
use super::recipe::{AssumptionName, AssumptionSheet, AssumptionValue, Quantity};
use super::solver::read_solver;
use crate::yaml::reader::{all, no_such};
use crate::yaml::schema::{any_of, list};
use crate::yaml::{At, Findings, Keys, Node, Problems, Span, Value, described, parsed};

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
    /// What its result means, written by a person who has seen it. Markdown.
    pub finding: FindingText,
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
    /// Whether each fitted entry is also predicted by the fit of the others.
    pub leave_one_out: bool,
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
    /// All over the space, by CMA-ES over the inputs that matter, then one input after the other.
    Global {
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

impl Calibration {
    /// What it asks, without what is said about it.
    #[must_use]
    pub fn question(&self) -> String {
        let Self { title: _, about: _, finding: _, inputs, search, ensemble, residual, fit, leave_one_out, hold_out } =
            self;
        format!("{inputs:?} {search:?} {ensemble} {residual:?} {fit:?} {leave_one_out} {hold_out:?}")
    }

    /// How many combinations of values there are.
    #[must_use]
    pub fn combinations(&self) -> usize {
        self.inputs.iter().fold(1, |product, input| product.saturating_mul(input.tried.count()))
    }
}

/// Reads a calibration from its text; `file` only names it in messages.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn parse_calibration(file: &str, text: &str, sheet: &AssumptionSheet) -> Result<Calibration, Problems> {
    parsed(file, text, |at| calibration(at, sheet))
}

fn calibration(at: At<'_>, sheet: &AssumptionSheet) -> Option<Calibration> {
    let keys = at.keys("a calibration")?;
    let title = keys.required("title", "Its title", |at| at.text());
    let about = keys.required("about", "What it is to show", |at| at.text());
    let of_finding = "What it showed, written when it has been run; `{best}`, `{in force}`, `{held out}` and `{INPUT: VALUE}` stand for \
                      its numbers";
    let finding = keys.optional("finding", of_finding, |at| at.text().map(|text| (text, at.span())));
    let free = "The inputs that are free, with the values that are tried";
    let inputs = keys.required("calibrate", free, |at| inputs(at, sheet));
    let search = keys.optional("search", "How sets of values are chosen; every combination if absent", search);
    let of_chaotic = "Members of the ensemble of a chaotic point; single runs if absent";
    let ensemble = keys.optional("ensemble", of_chaotic, |at| some(at, "members"));
    let of_entry = "What the residual of an entry is";
    let residual = keys.optional("residual", of_entry, |at| at.word::<Residual>("residual"));
    let of_one = "Each fitted entry is also predicted by the sets that fit the others best; false if absent";
    let leave_one_out =
        keys.optional("leave_one_out", of_one, |at| at.boolean().map(|wanted| wanted.then(|| at.span())));
    let ids = |at: At<'_>| at.list(|at| at.text());
    let fit = keys.required("fit", "The entries that are fitted, experiment/entry", ids);
    let hold_out = keys.optional("hold_out", "The entries that are held out", ids);
    keys.close()?;
    let (inputs, leave_one_out) = (inputs?, leave_one_out?.flatten());
    let finding = match finding?.map(|(text, span)| (FindingText::parse(&text, &inputs), span)) {
        Some((Err(error), span)) => return at.wrong_at(span, format!("the finding has {error}")),
        Some((Ok(finding), _)) => finding,
        None => FindingText::default(),
    };
    let calibration = Calibration {
        title: title?,
        about: about?,
        finding,
        inputs,
        search: search?.unwrap_or(CalibrationSearch::Grid),
        ensemble: ensemble?.unwrap_or(0),
        residual: residual?.unwrap_or_default(),
        fit: fit?,
        leave_one_out: leave_one_out.is_some(),
        hold_out: hold_out?.unwrap_or_default(),
    };
    if let Some(span) = leave_one_out
        && calibration.search != CalibrationSearch::Grid
    {
        return at.report_at(
            span,
            "`leave_one_out` wants every combination to be tried",
            Some(
                "leave out `search`: what a search for the best fit of all entries passes by may fit the others better"
                    .into(),
            ),
        );
    }
    let combinations = calibration.combinations();
    if calibration.search == CalibrationSearch::Grid && combinations > MOST_COMBINATIONS {
        return at.report(
            format!("{combinations} combinations of values: {MOST_COMBINATIONS} at most"),
            Some("write `search: {coordinate: {starts: 4, budget: 400 sets}}`, which tries a part of them".into()),
        );
    }
    Some(calibration)
}

/// `grid`, `{coordinate: {starts: 4, budget: 400 sets}}`, or `{global: {budget: 1000 sets}}`.
fn search(at: At<'_>) -> Option<CalibrationSearch> {
    let forms = [
        ("grid", "Every combination"),
        ("coordinate", "One input after another, from several starts"),
        ("global", "CMA-ES over the inputs that matter, then one input after another"),
    ];
    at.choose("a search", &forms, |choice| {
        if choice.name() == "grid" {
            choice.bare()?;
            return Some(CalibrationSearch::Grid);
        }
        let budget = |keys: &Keys<'_>| keys.required("budget", "Sets of values that are tried", |at| some(at, "sets"));
        if choice.name() == "global" {
            let keys = choice.keys("a global search")?;
            let budget = budget(&keys);
            keys.close()?;
            return Some(CalibrationSearch::Global { budget: budget? });
        }
        let keys = choice.keys("a coordinate search")?;
        let starts = keys.required("starts", "Starts of the search", |at| some(at, "starts"));
        let budget = budget(&keys);
        keys.close()?;
        Some(CalibrationSearch::Coordinate { starts: starts?, budget: budget? })
    })
}

/// A number of things, one at least.
fn some(at: At<'_>, noun: &str) -> Option<u32> {
    at.count_from(1, noun, MOST_SETS, &format!("no {noun} at all would find nothing"))
}

fn inputs(at: At<'_>, sheet: &AssumptionSheet) -> Option<Vec<CalibrationInput>> {
    let solvers = "Solvers that are tried";
    let rules = match at {
        At::Node(..) => Schema::Null,
        At::Sketch(it) => json!({"properties": {SOLVER: it.part(solvers, tried_solvers)}, "minProperties": 1}),
    };
    let read = |key: &str, span: Span, at: At<'_>| {
        let tried = if key == SOLVER { tried_solvers(at) } else { tried(key, span, at, sheet) }?;
        Some((CalibrationInput { name: key.into(), tried }, span))
    };
    let inputs = at.by_name(rules, "inputs are written as `assumption: [value, …]`", read)?;
    let mut moved = BTreeSet::new();
    for (input, span) in &inputs {
        if let Tried::Values { moves, .. } = &input.tried
            && let Some(name) = moves.iter().find(|name| !moved.insert((*name).clone()))
        {
            return at.wrong_at(*span, format!("`{name}` is moved by two inputs"));
        }
    }
    if inputs.is_empty() {
        return at.wrong("there is no input to calibrate");
    }
    Some(inputs.into_iter().map(|(input, _)| input).collect())
}

/// The input that is no assumption.
const SOLVER: &str = "solver";

fn tried_solvers(at: At<'_>) -> Option<Tried> {
    at.list(read_solver).map(Tried::Solvers)
}

/// `assumption: [value, …]`, `name: {moves: [assumption, …], values: [value, …]}` with a value for all of them or a list of one
/// for each, or `name: {scales: assumption, by: [factor, …]}`.
fn tried(key: &str, span: Span, at: At<'_>, sheet: &AssumptionSheet) -> Option<Tried> {
    let of = |moves: Vec<AssumptionName>, values| {
        let units = moves.iter().map(|name| sheet.get(name).map_or("", |entry| entry.kind.unit())).collect();
        Tried::Values { units, moves, values }
    };
    let listed = |at: At<'_>| {
        let known = sheet.iter().map(|(name, _)| name).find(|name| name.as_str() == key);
        let name = match at {
            At::Node(_, findings) => known.or_else(|| no_such(findings, span, "assumption", key, &sheet.names())),
            At::Sketch(_) => None,
        };
        let moves: Option<Vec<_>> = name.map(|name| vec![name.clone()]);
        let values = values(at, moves.as_deref(), sheet);
        moves.zip(values).map(|(moves, values)| of(moves, values))
    };
    let named = |at: At<'_>| at.form(|node, findings| sheet.named(node, findings), |_| assumed_schema::any(sheet));
    let keyed = |at: At<'_>| {
        let keys = at.keys("an input")?;
        let forms = [("moves", "Assumptions that are moved together"), ("scales", "The assumption that is scaled")];
        let (of_moves, of_factors) = ("A value for all of them, or a list of one for each", "Factors");
        let tried = keys.exactly_one(&forms, |key, at| match key {
            "moves" => {
                let moves = at.list(named);
                let values = keys.optional("values", of_moves, |at| values(at, moves.as_deref(), sheet));
                let values = values?.or_else(|| keys.lacks("values"));
                moves.zip(values).map(|(moves, values)| of(moves, values))
            }
            _ => {
                let of = named(at);
                let by = keys.optional("by", of_factors, |at| at.list(factor))?.or_else(|| keys.lacks("by"));
                of.zip(by).map(|(of, by)| Tried::Factors { of, by })
            }
        });
        keys.rule(
            || json!({"if": {"required": ["moves"]}, "then": {"required": ["values"]}, "else": {"required": ["by"]}}),
        );
        keys.close()?;
        tried
    };
    at.either(|value| matches!(value, Value::Sequence(_)), listed, keyed)
}

fn factor(at: At<'_>) -> Option<f64> {
    match at.number()? {
        factor if factor > 0.0 => Some(factor),
        _ => at.wrong("a factor above zero is wanted"),
    }
}

/// The values that are tried: of each assumption that is moved one, or the same for all.
fn values(at: At<'_>, moves: Option<&[AssumptionName]>, sheet: &AssumptionSheet) -> Option<Vec<Vec<AssumptionValue>>> {
    at.list(|at| {
        at.form(
            |node, findings| value(node, moves?, sheet, findings),
            |_| any_of("A value", vec![any_value(), list("One for each", any_value())]),
        )
    })
}

fn value(
    node: &Node,
    moves: &[AssumptionName],
    sheet: &AssumptionSheet,
    findings: &Findings,
) -> Option<Vec<AssumptionValue>> {
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
}

/// JSON Schema of a calibration file, with the assumptions of the study.
#[must_use]
pub fn calibration_schema(sheet: &AssumptionSheet) -> Schema {
    described("Calibration", "A calibration", |at| calibration(at, sheet))
}
