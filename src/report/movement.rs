//! What moved between two runs: numbers held against each other with their own uncertainties.

use std::collections::{BTreeMap, BTreeSet};

use crate::reference::{COVERAGE, Judged};
use crate::table::{Data, Table};
use crate::text::number::compact;

use super::json::{Number, Standing};
use crate::text::name;

/// A number that is not the same any more.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// Which number: the row or entry, and the column.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// As it was.
    pub from: f64,
    /// As it is.
    pub to: f64,
    /// Uncertainty of the difference, √(u_a² + u_b²); NaN where one of them has none.
    pub u: f64,
}

impl Moved {
    /// How far it moved, in units of the uncertainty of the difference; infinite where a number came or went.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        let ratio = (self.to - self.from).abs() / self.u;
        if ratio.is_nan() { f64::INFINITY } else { ratio }
    }

    /// True if its uncertainty does not explain it.
    #[must_use]
    pub fn is_beyond(&self) -> bool {
        self.deviation() > COVERAGE
    }
}

/// What moved in one experiment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Movement {
    /// Numbers that are the same to the bit.
    pub same: usize,
    /// Numbers that are not, the farthest first.
    pub moved: Vec<Moved>,
    /// Verdicts that changed: name, old, new.
    pub judged_differently: Vec<(String, String, String)>,
    /// What claims of the same verdict rest on: name, old, new.
    pub read_differently: Vec<(String, String, String)>,
    /// Rows or entries that only the first has.
    pub gone: Vec<String>,
    /// Rows or entries that only the second has.
    pub new: Vec<String>,
}

impl Movement {
    /// True if nothing moved, came or went.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.moved.is_empty() && self.words() == 0
    }

    /// Differences that are no number's.
    pub(super) fn words(&self) -> usize {
        self.judged_differently.len() + self.read_differently.len() + self.gone.len() + self.new.len()
    }

    /// True if something changed that no uncertainty explains.
    #[must_use]
    pub fn is_beyond(&self) -> bool {
        self.words() > 0 || self.moved.iter().any(Moved::is_beyond)
    }

    fn number(&mut self, name: &str, unit: &str, a: Number, b: Number) {
        if a.value.to_bits() == b.value.to_bits() || a.value.is_nan() && b.value.is_nan() {
            self.same += 1;
        } else {
            let u = libm::hypot(a.u, b.u);
            self.moved.push(Moved { name: name.into(), unit: unit.into(), from: a.value, to: b.value, u });
        }
    }

    fn sorted(mut self) -> Self {
        self.moved.sort_by(|a, b| b.deviation().total_cmp(&a.deviation()).then_with(|| a.name.cmp(&b.name)));
        self
    }
}

/// Two tables of one experiment: rows with the same parameters, measure by measure.
#[must_use]
pub fn between_tables(a: &Table, b: &Table) -> Movement {
    let (old, new) = (Rows::of(a), Rows::of(b));
    let mut movement = Movement::default();
    for (key, row) in &old.by_key {
        let Some(other) = new.by_key.get(key) else {
            movement.gone.push(key.clone());
            continue;
        };
        for (name, measure) in &old.measures {
            let there = new.measures.get(name).map_or(Number::NONE, |measure| measure.at(*other));
            movement.number(&format!("{name} at {key}"), measure.unit, measure.at(*row), there);
        }
    }
    movement.new = new.by_key.keys().filter(|key| !old.by_key.contains_key(*key)).cloned().collect();
    let columns = new.measures.keys().filter(|name| !old.measures.contains_key(*name));
    movement.new.extend(columns.map(|name| format!("column {name}")));
    movement.sorted()
}

/// The entries of two judgements.
#[must_use]
pub fn between_verdicts(a: &[Standing], b: &[Standing]) -> Movement {
    let mut movement = Movement::default();
    for old in a {
        let Some(new) = b.iter().find(|new| new.id == old.id) else {
            movement.gone.push(old.id.clone());
            continue;
        };
        if old.verdict != new.verdict {
            movement.judged_differently.push((old.id.clone(), old.verdict.clone(), new.verdict.clone()));
        } else if old.numbers.is_empty() && new.numbers.is_empty() && old.found != new.found {
            movement.read_differently.push((old.id.clone(), old.found.clone(), new.found.clone()));
        }
        for name in old.numbers.keys().chain(new.numbers.keys()).collect::<BTreeSet<_>>() {
            let [here, there] = [old, new].map(|standing| standing.numbers.get(name).copied().unwrap_or(Number::NONE));
            let name = if name.is_empty() { old.id.clone() } else { format!("{}, {name}", old.id) };
            movement.number(&name, "", here, there);
        }
    }
    movement.new = b.iter().filter(|new| a.iter().all(|old| old.id != new.id)).map(|new| new.id.clone()).collect();
    movement.sorted()
}

/// How an entry stands, from its verdict.
#[must_use]
pub fn standing(judged: &Judged) -> Standing {
    let numbers = judged
        .comparisons()
        .map(|(name, comparison)| (name.to_owned(), Number::of(comparison.simulated, comparison.u_num)));
    Standing {
        id: judged.id.clone(),
        verdict: judged.verdict.word().to_owned(),
        found: judged.found.clone(),
        no_table: judged.no_table.clone(),
        numbers: numbers.collect(),
    }
}

/// A column of measures with those that say how uncertain it is.
struct Measure<'t> {
    unit: &'t str,
    value: &'t [f64],
    own: &'t [f64],
    spread: Option<&'t [f64]>,
    members: Option<&'t [i64]>,
}

impl Measure<'_> {
    /// The number and its uncertainty: its own error, and no less than the standard error of the ensemble's mean.
    fn at(&self, row: usize) -> Number {
        let members = self.members.map_or(1, |members| members[row]).max(1);
        let spread = self.spread.map_or(0.0, |spread| spread[row]) / (members as f64).sqrt();
        Number { value: self.value[row], u: self.own[row].max(spread) }
    }
}

/// A table as rows that are known by their parameters.
struct Rows<'t> {
    by_key: BTreeMap<String, usize>,
    measures: BTreeMap<&'t str, Measure<'t>>,
}

impl<'t> Rows<'t> {
    fn of(table: &'t Table) -> Self {
        let floats = |name: &str| match &table.column(name)?.data {
            Data::Float(cells) => Some(cells.as_slice()),
            _ => None,
        };
        let members = table.column(name::MEMBERS).and_then(|column| match &column.data {
            Data::Int(cells) => Some(cells.as_slice()),
            _ => None,
        });
        let is_measure = |it: &str| floats(it).is_some() && floats(&name::numerical(it)).is_some();
        let mut measures = BTreeMap::new();
        for column in &table.columns {
            let measure = column.name.as_str();
            if let (Some(value), Some(own)) = (floats(measure), floats(&name::numerical(measure))) {
                let spread = floats(&name::spread(measure));
                measures.insert(measure, Measure { unit: &column.unit, value, own, spread, members });
            }
        }
        // What stands before the first measure tells the rows apart.
        let keys: Vec<_> = table.columns.iter().take_while(|column| !is_measure(&column.name)).collect();
        let mut by_key = BTreeMap::new();
        for row in 0..table.rows() {
            let cells = keys.iter().filter_map(|column| Some(format!("{} {}", column.name, cell(&column.data, row)?)));
            let key = cells.collect::<Vec<_>>().join(", ");
            let before = (1..).find(|n| !by_key.contains_key(&repeated(&key, *n))).unwrap_or(1);
            by_key.insert(repeated(&key, before), row);
        }
        Self { by_key, measures }
    }
}

fn repeated(key: &str, n: u32) -> String {
    if n == 1 { key.to_owned() } else { format!("{key} ({n})") }
}

/// A parameter in words; nothing where a union leaves it out.
fn cell(data: &Data, row: usize) -> Option<String> {
    match data {
        Data::Float(cells) if cells[row].is_nan() => None,
        // Enough digits to tell neighbours of any sweep apart.
        Data::Float(cells) => Some(compact(cells[row], 9)),
        Data::Int(cells) => Some(cells[row].to_string()),
        Data::Text(cells) if cells[row].is_empty() => None,
        Data::Text(cells) => Some(cells[row].clone()),
        Data::FloatList(_) => None,
    }
}
