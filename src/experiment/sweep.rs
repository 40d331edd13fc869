//! The `sweep` of an experiment: nodes to the list of its cases.
//!
//! Product of its keys by default; `paired` ranges go in step, `points` are listed one by one, and a `union` joins named
//! sweeps, each of which may have its own solver. Keys of a YAML mapping have no order, so neither has the result: the
//! parameters stand in the order of [`Parameter`], the first varies slowest, and named sweeps follow their names.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use serde_json::json;

use super::case::{Case, Direction};
use super::continued::{Continued, ContinuedSweep, KEYS, chains};
use super::range::{MOST_POINTS, by_kind, too_many, value, values};
use super::recipe::{Parameter, ParameterValue};
use super::refined::{Refinement, is_refined, refined};
use super::solver::read_solver;
use crate::measure::SolverChoice;
use crate::text::words::of_column;
use crate::yaml::reader::unknown;
use crate::yaml::word::{from_word, word_of, words};
use crate::yaml::{At, Span, Value};

/// A sweep as read.
pub(super) struct ReadSweep {
    /// Cases; those of a named sweep without its own solver have none yet.
    pub cases: Vec<Case>,
    /// All parameters that some case sets, in order.
    pub swept: Vec<Parameter>,
    /// Where each of them stands.
    pub places: BTreeMap<Parameter, Span>,
    /// Rules of refined ranges, and where they stand.
    pub refined: Vec<(Refinement, Span)>,
    /// Sweeps whose rows start where the row before ended, and where they say so.
    pub continued: Vec<(ContinuedSweep, Span)>,
}

impl ReadSweep {
    /// Where nothing is swept there is one case.
    pub fn none() -> Self {
        Self {
            cases: vec![Case::default()],
            swept: Vec::new(),
            places: BTreeMap::new(),
            refined: Vec::new(),
            continued: Vec::new(),
        }
    }
}

type Point = BTreeMap<Parameter, ParameterValue>;

/// Reads what stands under `sweep`.
pub(super) fn read_sweep(at: At<'_>) -> Option<ReadSweep> {
    at.named("sweep", "What varies: the product of its keys", |at| {
        let reader = SweepReader::default();
        let mut cases = Vec::new();
        let named = if at.holds(is_union) {
            reader.joined(at)
        } else {
            reader.product(at, false).map(|product| vec![(String::new(), product)])
        };
        for (name, product) in named? {
            product.add(&name, &mut cases);
        }
        if cases.len() > MOST_POINTS as usize {
            return too_many(at, at.span(), cases.len() as f64);
        }
        let swept: BTreeSet<_> =
            cases.iter().flat_map(|case| case.values.iter().map(|(parameter, _)| *parameter)).collect();
        let SweepReader { places, refined, continued } = reader;
        let (places, refined, continued) = (places.into_inner(), refined.into_inner(), continued.into_inner());
        for (continuation, from_last) in &continued {
            if chains(&cases, std::slice::from_ref(continuation)).iter().any(|chain| chain.len() < 2) {
                let name = word_of(continuation.along);
                return at.wrong_at(*from_last, format!("`{name}` has one value here, and no row follows another"));
            }
        }
        Some(ReadSweep { cases, swept: swept.into_iter().collect(), places, refined, continued })
    })
}

fn is_union(value: &Value) -> bool {
    matches!(value, Value::Mapping(entries) if entries.iter().any(|entry| entry.key == UNION))
}

/// The key of named sweeps.
const UNION: &str = "union";
const JOINED: &str = "Named sweeps joined";

/// All parameters, by name.
pub(super) fn parameters() -> impl Iterator<Item = (&'static str, Parameter)> {
    words::<Parameter>().iter().filter_map(|name| Some((*name, from_word::<Parameter>(name)?)))
}

/// `force_ratio: dimensionless forcing amplitude`.
pub(super) fn about(name: &str) -> String {
    format!("{name}: {}", of_column(name))
}

fn described() -> impl Iterator<Item = (&'static str, String)> {
    parameters().map(|(name, _)| (name, about(name)))
}

/// The points of a sweep, the same for each direction in which they are gone through.
struct Product {
    points: Vec<Point>,
    directions: Vec<Option<Direction>>,
    solvers: Vec<SolverChoice>,
}

impl Product {
    fn add(self, sweep: &str, cases: &mut Vec<Case>) {
        let Self { points, directions, solvers } = self;
        for direction in directions {
            cases.extend(points.iter().map(|point| Case {
                values: point.iter().map(|(parameter, value)| (*parameter, *value)).collect(),
                sweep: sweep.into(),
                direction,
                solvers: solvers.clone(),
            }));
        }
    }
}

#[derive(Default)]
struct SweepReader {
    places: RefCell<BTreeMap<Parameter, Span>>,
    refined: RefCell<Vec<(Refinement, Span)>>,
    continued: RefCell<Vec<(ContinuedSweep, Span)>>,
}

/// What an axis belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Axis {
    OfProduct { within_union: bool },
    OfPair,
}

impl SweepReader {
    /// `union: {name: {sweep}}`, by name.
    fn joined(&self, at: At<'_>) -> Option<Vec<(String, Product)>> {
        let keys = at.keys("a union of sweeps")?;
        let named = keys.required(UNION, JOINED, |at| self.union(at));
        keys.close()?;
        let mut named = named?;
        named.sort_by(|(a, _), (b, _)| a.cmp(b));
        Some(named)
    }

    fn union(&self, at: At<'_>) -> Option<Vec<(String, Product)>> {
        let form = "a union is written as `name: {sweep}` lines";
        let names = json!({"propertyNames": {"pattern": NAME}, "minProperties": 1});
        let named = at.by_name(names, form, |key, key_span, at| {
            let name = if is_name(key) {
                Some(key.to_owned())
            } else {
                let message = format!("`{key}` cannot name a sweep: use letters, digits, `-` and `_`");
                at.wrong_at(key_span, message)
            };
            let (refined, continued) = (self.refined.borrow().len(), self.continued.borrow().len());
            let product = at.named("named_sweep", "What varies: the product of its keys", |at| self.product(at, true));
            for (refinement, _) in &mut self.refined.borrow_mut()[refined..] {
                refinement.sweep = key.to_owned();
            }
            for (continuation, _) in &mut self.continued.borrow_mut()[continued..] {
                continuation.sweep = key.to_owned();
            }
            Some((name?, product?))
        })?;
        if named.is_empty() { at.wrong("this union is empty") } else { Some(named) }
    }

    /// A product of parameters, `paired` and `points`, and how its rows follow each other; within a union also a `solver`.
    fn product(&self, at: At<'_>, within_union: bool) -> Option<Product> {
        let keys = at.keys("a sweep")?;
        let pairs = "Ranges of equal length that go in step";
        let paired = keys.optional("paired", pairs, |at| at.named("paired", pairs, |at| self.paired(at)));
        let listed = keys.optional("points", "Points one by one", |at| {
            at.list(|at| at.named("point", "A point", |at| self.listed(at)))
        });
        let solvers = if within_union {
            keys.optional("solver", "Solvers of this sweep", |at| at.one_or_more(read_solver))
        } else {
            Some(None)
        };
        let continued = Continued::read(&keys, at);
        keys.rule(not_empty);
        if !within_union {
            // A union is read by itself.
            keys.elsewhere(UNION, JOINED, |at| self.union(at));
            keys.rule(|| json!({"if": {"required": [UNION]}, "then": {"maxProperties": 1}}));
        }
        let known = self.refined.borrow().len();
        let axes = keys
            .others(described(), |key, key_span, at| self.axis(key, key_span, at, Axis::OfProduct { within_union }));
        let refined: Vec<Span> = self.refined.borrow()[known..].iter().map(|(_, span)| *span).collect();
        if let [_, second, ..] = refined.as_slice() {
            return at.wrong_at(*second, "one parameter of a sweep is refined, not two");
        }
        let (paired, listed, solvers, axes) = (paired?, listed?, solvers?.unwrap_or_default(), axes?);
        let continued = continued?;
        let blocks: Vec<Vec<Point>> = axes
            .into_iter()
            .map(|(parameter, values)| values.into_iter().map(|value| Point::from([(parameter, value)])).collect())
            .chain(paired)
            .chain(listed)
            .collect();
        let points = multiply(at, blocks)?;
        let Some(continued) = continued else { return Some(Product { points, directions: vec![None], solvers }) };
        if let Some(refined) = refined.first() {
            return at.report_at(
                *refined,
                "rows that start where the row before ended have fixed points: this range is refined",
                Some("write `linear`, `log` or `step`, or leave `from: last` out".into()),
            );
        }
        let set: Vec<Parameter> = points.first().map(|point| point.keys().copied().collect()).unwrap_or_default();
        let along = continued.along(&set, at)?;
        self.continued.borrow_mut().push((ContinuedSweep { sweep: String::new(), along }, continued.at));
        Some(Product { points, directions: continued.directions.into_iter().map(Some).collect(), solvers })
    }

    fn axis(&self, key: &str, key_span: Span, at: At<'_>, axis: Axis) -> Option<(Parameter, Vec<ParameterValue>)> {
        let Some(parameter) = from_word::<Parameter>(key) else {
            let mut known = words::<Parameter>().to_vec();
            known.extend(["paired", "points", UNION]);
            known.extend(KEYS);
            known.extend((axis == Axis::OfProduct { within_union: true }).then_some("solver"));
            return at.form(
                |_, findings| unknown(findings, key_span, "a sweep", "parameter", key, &known),
                |_| json!(false),
            );
        };
        self.places.borrow_mut().entry(parameter).or_insert(key_span);
        let takes = Some(parameter.takes());
        let fixed = |at: At<'_>| values(at, Some(parameter));
        let values = match axis {
            Axis::OfPair if at.holds(is_refined) => at.wrong("paired ranges have fixed points: this one is refined"),
            Axis::OfPair => by_kind(at, "values_", takes, fixed),
            Axis::OfProduct { .. } => {
                by_kind(at, "swept_", takes, |at| at.either(is_refined, |at| self.refined(at, parameter), fixed))
            }
        };
        let values = values?;
        if axis != Axis::OfPair && has_one_twice(&values) {
            return at.wrong("a value stands here twice: two rows would be the same");
        }
        Some((parameter, values))
    }

    fn refined(&self, at: At<'_>, parameter: Parameter) -> Option<Vec<ParameterValue>> {
        if let At::Sketch(_) = at
            && !parameter.words().is_empty()
        {
            return None;
        }
        let (values, refinement) = refined(at, parameter)?;
        self.refined.borrow_mut().push((refinement, at.span()));
        Some(values)
    }

    /// Ranges of equal length that go in step.
    fn paired(&self, at: At<'_>) -> Option<Vec<Point>> {
        let keys = at.keys("a paired sweep")?;
        keys.rule(not_empty);
        let axes = keys.others(described(), |key, key_span, at| {
            self.axis(key, key_span, at, Axis::OfPair).map(|axis| (axis, key_span))
        })?;
        let Some(((_, first), _)) = axes.first() else {
            return at.wrong("this sweep is empty: give it at least one parameter");
        };
        let mut points = vec![Point::new(); first.len()];
        for ((parameter, values), span) in &axes {
            if values.len() != points.len() {
                let message =
                    format!("paired ranges are of equal length: {} values here, {}", values.len(), points.len());
                return at.wrong_at(*span, format!("{message} in the first"));
            }
            for (point, value) in points.iter_mut().zip(values) {
                point.insert(*parameter, *value);
            }
        }
        Some(points)
    }

    /// One of the points that are listed.
    fn listed(&self, at: At<'_>) -> Option<Point> {
        const WHAT: &str = "a point of the sweep";
        let keys = at.keys(WHAT)?;
        keys.rule(not_empty);
        let set = keys.others(described(), |key, key_span, at| {
            let Some(parameter) = from_word::<Parameter>(key) else {
                return at.form(
                    |_, findings| unknown(findings, key_span, WHAT, "parameter", key, words::<Parameter>()),
                    |_| json!(false),
                );
            };
            self.places.borrow_mut().entry(parameter).or_insert(key_span);
            Some((parameter, value(at, Some(parameter))?))
        })?;
        if set.is_empty() { at.wrong("this point sets nothing") } else { Some(set.into_iter().collect()) }
    }
}

/// Some value stands among these more than once.
fn has_one_twice(values: &[ParameterValue]) -> bool {
    let (mut numbers, mut words) = (Vec::new(), Vec::new());
    for value in values {
        match value {
            ParameterValue::Number(number) => numbers.push(*number),
            word if words.contains(word) => return true,
            word => words.push(*word),
        }
    }
    numbers.sort_by(f64::total_cmp);
    numbers.windows(2).any(|pair| pair[0] == pair[1])
}

fn not_empty() -> serde_json::Value {
    json!({"minProperties": 1})
}

/// Every combination; the lowest parameter varies slowest.
fn multiply(at: At<'_>, mut blocks: Vec<Vec<Point>>) -> Option<Vec<Point>> {
    if blocks.is_empty() {
        return at.wrong("this sweep is empty: give it at least one parameter");
    }
    let count: f64 = blocks.iter().map(|block| block.len() as f64).product();
    if count > f64::from(MOST_POINTS) {
        return too_many(at, at.span(), count);
    }
    blocks.sort_by_key(|block| block.first().and_then(|point| point.keys().next().copied()));
    let mut points = vec![Point::new()];
    for block in &blocks {
        points = points
            .iter()
            .flat_map(|point| {
                block.iter().map(|more| {
                    let mut point = point.clone();
                    point.extend(more);
                    point
                })
            })
            .collect();
    }
    let set: usize = blocks.iter().filter_map(|block| block.first()).map(BTreeMap::len).sum();
    if points.first().is_some_and(|point| point.len() < set) {
        return at.wrong("a parameter is swept twice here");
    }
    Some(points)
}

/// Names of sweeps, candidates and figures, for a schema: see [`is_name`].
pub(super) const NAME: &str = "^[A-Za-z0-9_-]{1,64}$";

/// Letters, digits, `-` and `_`.
pub(super) fn is_name(text: &str) -> bool {
    (1..=64).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-_".contains(&byte))
}
