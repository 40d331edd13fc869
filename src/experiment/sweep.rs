//! The `sweep` of an experiment: nodes to the list of its cases.
//!
//! Product of its keys by default; `paired` ranges go in step, `points` are listed one by one, and a `union` joins named
//! sweeps, each of which may have its own solver. Keys of a YAML mapping have no order, so neither has the result: the
//! parameters stand in the order of [`Parameter`], the first varies slowest, and named sweeps follow their names.

use std::collections::{BTreeMap, BTreeSet};

use super::recipe::{Parameter, ParameterValue};

use super::at::At;
use super::continued::{Continued, ContinuedSweep, Direction, KEYS, chains};
use super::definition::{Case, Refinement};
use super::diagnostic::{Findings, Span};
use super::range::{MOST_POINTS, too_many, value, values};
use super::reader::{Fields, all, list, one_or_more, unknown};
use super::refined::{is_refined, refined};
use super::solver::read_solver;
use super::word::{from_word, word_of, words};
use super::yaml::{Entry, Node, Value};
use crate::measure::SolverChoice;

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

/// Reads the node under `sweep`.
pub(super) fn read_sweep(node: &Node, findings: &Findings) -> Option<ReadSweep> {
    let mut reader = SweepReader { findings, places: BTreeMap::new(), refined: Vec::new(), continued: Vec::new() };
    let mut cases = Vec::new();
    if let Value::Mapping(entries) = &node.value
        && let Some(union) = entries.iter().find(|entry| entry.key == "union")
    {
        let fields = Fields::open(node, "a union of sweeps", findings)?;
        fields.get("union");
        let named = reader.union(&union.node);
        fields.close()?;
        for (name, product) in named? {
            product.add(&name, &mut cases);
        }
    } else {
        reader.product(node, false)?.add("", &mut cases);
    }
    if cases.len() > MOST_POINTS as usize {
        return too_many(node.span, cases.len() as f64, findings);
    }
    let swept: BTreeSet<_> =
        cases.iter().flat_map(|case| case.values.iter().map(|(parameter, _)| *parameter)).collect();
    for (continuation, at) in &reader.continued {
        if chains(&cases, std::slice::from_ref(continuation)).iter().any(|chain| chain.len() < 2) {
            let message = format!("`{}` has one value here, and no row follows another", word_of(continuation.along));
            return findings.wrong(*at, message);
        }
    }
    let SweepReader { places, refined, continued, .. } = reader;
    Some(ReadSweep { cases, swept: swept.into_iter().collect(), places, refined, continued })
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

struct SweepReader<'f> {
    findings: &'f Findings,
    places: BTreeMap<Parameter, Span>,
    refined: Vec<(Refinement, Span)>,
    continued: Vec<(ContinuedSweep, Span)>,
}

/// What an axis belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Axis {
    OfProduct { within_union: bool },
    OfPair,
}

type Named = BTreeMap<String, Product>;

impl SweepReader<'_> {
    fn union(&mut self, node: &Node) -> Option<Named> {
        let Value::Mapping(entries) = &node.value else {
            return self.findings.wrong(node.span, "a union is written as `name: {sweep}` lines");
        };
        let mut named = Named::new();
        let mut fine = true;
        for entry in entries {
            if !is_name(&entry.key) {
                fine = false;
                self.findings.wrong::<()>(
                    entry.key_span,
                    format!("`{}` cannot name a sweep: use letters, digits, `-` and `_`", entry.key),
                );
            }
            let (refined, continued) = (self.refined.len(), self.continued.len());
            match self.product(&entry.node, true) {
                Some(sweep) => drop(named.insert(entry.key.clone(), sweep)),
                None => fine = false,
            }
            for (refinement, _) in &mut self.refined[refined..] {
                refinement.sweep.clone_from(&entry.key);
            }
            for (continuation, _) in &mut self.continued[continued..] {
                continuation.sweep.clone_from(&entry.key);
            }
        }
        if named.is_empty() && fine {
            return self.findings.wrong(node.span, "this union is empty");
        }
        fine.then_some(named)
    }

    /// A product of parameters, `paired` and `points`, and how its rows follow each other; within a union also a `solver`.
    fn product(&mut self, node: &Node, within_union: bool) -> Option<Product> {
        let fields = Fields::open(node, "a sweep", self.findings)?;
        let paired = fields.optional("paired", |node| self.paired(node));
        let listed = fields.optional("points", |node| self.listed(node));
        let solvers = if within_union {
            fields.optional("solver", |node| {
                one_or_more(node, self.findings, |node| read_solver(At::Node(node, self.findings)))
            })
        } else {
            Some(None)
        };
        let continued = Continued::read(&fields, self.findings);
        let known = self.refined.len();
        let axes = all(fields.others().map(|entry| self.axis(entry, Axis::OfProduct { within_union })));
        if let [_, (_, second), ..] = self.refined[known..] {
            return self.findings.wrong(second, "one parameter of a sweep is refined, not two");
        }
        let (paired, listed, solvers, axes) = (paired?, listed?, solvers?.unwrap_or_default(), axes?);
        let (continued, refined) = (continued?, self.refined[known..].first().map(|(_, at)| *at));
        let blocks: Vec<Vec<Point>> = axes
            .into_iter()
            .map(|(parameter, values)| values.into_iter().map(|value| Point::from([(parameter, value)])).collect())
            .chain(paired)
            .chain(listed)
            .collect();
        let points = self.multiply(node.span, blocks)?;
        let Some(continued) = continued else { return Some(Product { points, directions: vec![None], solvers }) };
        if let Some(at) = refined {
            return self.findings.report(
                at,
                "rows that start where the row before ended have fixed points: this range is refined",
                Some("write `linear`, `log` or `step`, or leave `from: last` out".into()),
            );
        }
        let set: Vec<Parameter> = points.first().map(|point| point.keys().copied().collect()).unwrap_or_default();
        let along = continued.along(&set, self.findings)?;
        self.continued.push((ContinuedSweep { sweep: String::new(), along }, continued.at));
        Some(Product { points, directions: continued.directions.into_iter().map(Some).collect(), solvers })
    }

    fn axis(&mut self, entry: &Entry, axis: Axis) -> Option<(Parameter, Vec<ParameterValue>)> {
        let Some(parameter) = from_word::<Parameter>(&entry.key) else {
            let mut known = words::<Parameter>().to_vec();
            known.extend(["paired", "points", "union"]);
            known.extend(KEYS);
            known.extend((axis == Axis::OfProduct { within_union: true }).then_some("solver"));
            return unknown(self.findings, entry.key_span, "a sweep", "parameter", &entry.key, &known);
        };
        self.places.entry(parameter).or_insert(entry.key_span);
        if !is_refined(&entry.node) {
            return Some((parameter, values(&entry.node, parameter, self.findings)?));
        }
        if axis == Axis::OfPair {
            return self.findings.wrong(entry.node.span, "paired ranges have fixed points: this one is refined");
        }
        let (values, refinement) = refined(&entry.node, parameter, self.findings)?;
        self.refined.push((refinement, entry.node.span));
        Some((parameter, values))
    }

    /// Ranges of equal length that go in step.
    fn paired(&mut self, node: &Node) -> Option<Vec<Point>> {
        let fields = Fields::open(node, "a paired sweep", self.findings)?;
        let axes = all(fields.others().map(|entry| self.axis(entry, Axis::OfPair).map(|axis| (axis, entry.key_span))))?;
        let Some(((_, first), _)) = axes.first() else {
            return self.findings.wrong(node.span, "this sweep is empty: give it at least one parameter");
        };
        let mut points = vec![Point::new(); first.len()];
        for ((parameter, values), span) in &axes {
            if values.len() != points.len() {
                let message =
                    format!("paired ranges are of equal length: {} values here, {}", values.len(), points.len());
                return self.findings.wrong(*span, format!("{message} in the first"));
            }
            for (point, value) in points.iter_mut().zip(values) {
                point.insert(*parameter, *value);
            }
        }
        Some(points)
    }

    /// Points one by one.
    fn listed(&mut self, node: &Node) -> Option<Vec<Point>> {
        let findings = self.findings;
        let items = list(node, findings, Some)?;
        let mut points = Vec::new();
        for item in items {
            let fields = Fields::open(item, "a point of the sweep", findings)?;
            let mut point = Point::new();
            for entry in fields.others() {
                let Some(parameter) = from_word::<Parameter>(&entry.key) else {
                    return unknown(
                        findings,
                        entry.key_span,
                        "a point of the sweep",
                        "parameter",
                        &entry.key,
                        words::<Parameter>(),
                    );
                };
                self.places.entry(parameter).or_insert(entry.key_span);
                point.insert(parameter, value(&entry.node, parameter, findings)?);
            }
            if point.is_empty() {
                return findings.wrong(item.span, "this point sets nothing");
            }
            points.push(point);
        }
        Some(points)
    }

    /// Every combination; the lowest parameter varies slowest.
    fn multiply(&self, at: Span, mut blocks: Vec<Vec<Point>>) -> Option<Vec<Point>> {
        if blocks.is_empty() {
            return self.findings.wrong(at, "this sweep is empty: give it at least one parameter");
        }
        let count: f64 = blocks.iter().map(|block| block.len() as f64).product();
        if count > f64::from(MOST_POINTS) {
            return too_many(at, count, self.findings);
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
            return self.findings.wrong(at, "a parameter is swept twice here");
        }
        Some(points)
    }
}

/// Names of sweeps, candidates and figures, for a schema: see [`is_name`].
pub(super) const NAME: &str = "^[A-Za-z0-9_-]{1,64}$";

/// Letters, digits, `-` and `_`.
pub(super) fn is_name(text: &str) -> bool {
    (1..=64).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-_".contains(&byte))
}
