//! Entries and tables to verdicts.
//!
//! The baseline of the assumptions decides; the variants, each with one assumption moved, give u_input of a value and say
//! how robust a verdict is: how many of them keep it. A variant that was run and failed leaves the uncertainty unknown, so
//! the entry is missing; one that was not run for the rows in question is left out.

use std::collections::{BTreeMap, BTreeSet};

use super::absence::{Absence, NoTable};
use super::compare;
use super::compare::Comparison;
use super::decide::decide;
use super::entry::{Check, Entry, ReferenceFile, Tolerance, ToleranceSize};
use super::extracted::Extracted;
use super::extraction::Extraction;
use super::fit::Fit;
use super::judged::{Judged, Kind, Moved, Part, Role};
use super::motion_behind::MotionBehind;
use super::price::Price;
use super::printed::{Printed, PrintedUnit};
use super::resonance::PrintedPeak;
use super::tally::{Decision, Outcome};
use super::verdict::Verdict;
use super::view::{Reads, Tables, View};
use crate::experiment::assumption_of;
use crate::table::BASELINE;

/// Share of u_input² that is most of it.
const MOST: f64 = 0.8;

/// Gives every entry of a file its verdict. `fitted` holds the ids of the entries that an assumption was fitted to; whether a
/// calibration knows them is left to the caller ([`Judged::role`]).
#[must_use]
pub fn judge(file: &ReferenceFile, tables: &Tables<'_>, fitted: &BTreeSet<String>) -> Vec<Judged> {
    let priced = |entry: &Entry| {
        let reads = Reads::default();
        let judged = judge_entry(entry, &file.experiment, tables, fitted, &reads);
        let rows = reads.decisive_rows();
        Judged { price: Price::of(&rows, tables), motion: MotionBehind::of(&rows, &reads.places(), tables), ..judged }
    };
    file.entries.iter().map(priced).collect()
}

/// One entry; `reads` gathers the cells that decided it.
fn judge_entry(
    entry: &Entry,
    experiment: &str,
    tables: &Tables<'_>,
    fitted: &BTreeSet<String>,
    reads: &Reads,
) -> Judged {
    let view = View { tables, home: experiment, variant: BASELINE, given: entry.rows.clone(), reads };
    let fitted = fitted.contains(&entry.id);
    let judgement = match &entry.check {
        Check::Value { published, from, tolerance } => value(&view, published, from, tolerance.as_ref(), fitted),
        Check::Peak { peak, tolerance } => Ok(numbers(&view, peak, tolerance.as_ref(), fitted)),
        Check::Claim { predicate, .. } => {
            let blocked = !entry.blocked_by.is_empty();
            let verdict = |outcome| match outcome {
                _ if blocked => Verdict::Blocked,
                Outcome::Holds if fitted => Verdict::Fitted,
                Outcome::Holds => Verdict::Reproduced,
                Outcome::Undecided => Verdict::Undecidable,
                Outcome::Fails => Verdict::Differs,
            };
            decide(predicate, &view).and_then(|baseline| {
                let others = moved(&view, |variant| decide(predicate, variant))?;
                let description = |(variant, other): &(&str, Decision)| Moved {
                    variant: (*variant).into(),
                    found: in_words(other.outcome).into(),
                    value: None,
                    verdict: verdict(other.outcome),
                    kept: other.outcome == baseline.outcome,
                };
                let moved: Vec<Moved> = others.iter().map(description).collect();
                let mut found = format!("{}: {}", in_words(baseline.outcome), baseline.words());
                if blocked {
                    found += &format!(" (not stated: {})", entry.blocked_by.join(", "));
                }
                Ok(Judgement {
                    found,
                    blocked_by: entry.blocked_by.clone(),
                    robust: robust(&moved),
                    moved,
                    fit: predicate.fit(&view),
                    ..Judgement::of(verdict(baseline.outcome))
                })
            })
        }
    };
    let judgement = judgement.unwrap_or_else(|absence| Judgement::missing(&absence));
    let tolerance_reason = match &entry.check {
        Check::Value { tolerance, .. } | Check::Peak { tolerance, .. } => {
            tolerance.as_ref().map(|tolerance| tolerance.reason.clone())
        }
        Check::Claim { threshold_reason, .. } => Some(threshold_reason.clone()).filter(|reason| !reason.is_empty()),
    };
    let ends = if judgement.verdict == Verdict::Missing { String::new() } else { reads.ends() };
    Judged {
        id: entry.id.clone(),
        experiment: experiment.into(),
        kind: match entry.check {
            Check::Value { .. } | Check::Peak { .. } => Kind::Number,
            Check::Claim { .. } => Kind::Claim,
        },
        statement: entry.says.clone(),
        place: entry.place.clone(),
        verdict: judgement.verdict,
        expected: entry.expected,
        found: judgement.found + &ends,
        no_table: judgement.no_table,
        comparison: judgement.comparison,
        printed_unit: judgement.printed_unit,
        parts: judgement.parts,
        fit: judgement.fit,
        explanation: entry.explanation.clone(),
        blocked_by: judgement.blocked_by,
        tolerance_reason,
        robust: judgement.robust,
        moved: judgement.moved,
        price: Price::default(),
        motion: None,
        role: Role::Neither,
    }
}

fn in_words(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Holds => "true",
        Outcome::Undecided => "too close to call",
        Outcome::Fails => "false",
    }
}

struct Judgement {
    verdict: Verdict,
    found: String,
    no_table: Option<NoTable>,
    comparison: Option<Comparison>,
    printed_unit: PrintedUnit,
    parts: Vec<Part>,
    fit: Option<Fit>,
    blocked_by: Vec<String>,
    robust: Option<(u32, u32)>,
    moved: Vec<Moved>,
}

impl Judgement {
    fn of(verdict: Verdict) -> Self {
        Self {
            verdict,
            found: String::new(),
            no_table: None,
            comparison: None,
            printed_unit: PrintedUnit::default(),
            parts: Vec::new(),
            fit: None,
            blocked_by: Vec::new(),
            robust: None,
            moved: Vec::new(),
        }
    }

    fn missing(absence: &Absence) -> Self {
        let (found, no_table) = (absence.reason().to_string(), absence.no_table().cloned());
        Self { found, no_table, ..Self::of(Verdict::Missing) }
    }
}

/// Several numbers of one entry: the worst verdict is the entry's.
fn numbers(view: &View<'_>, peak: &PrintedPeak, by_hand: Option<&Tolerance>, fitted: bool) -> Judgement {
    let judged: Vec<(&str, Judgement)> = peak
        .numbers()
        .into_iter()
        .map(|number| {
            let name = number.peak.read.words();
            let judgement = value(view, number.published, &Extraction::Peak(number.peak), by_hand, fitted);
            (name, judgement.unwrap_or_else(|absence| Judgement::missing(&absence)))
        })
        .collect();
    let verdict = judged.iter().map(|(_, judgement)| judgement.verdict).max_by_key(|verdict| verdict.severity());
    // An assumption moved that turns one of the numbers turns the entry; which ones it turns is not kept, so at best the
    // smallest share is.
    let share = |&(kept, run): &(u32, u32)| f64::from(kept) / f64::from(run);
    let robust =
        judged.iter().filter_map(|(_, judgement)| judgement.robust).min_by(|a, b| share(a).total_cmp(&share(b)));
    let found: Vec<String> = judged.iter().map(|(name, judgement)| format!("{name} {}", judgement.found)).collect();
    let blocked_by: BTreeSet<String> =
        judged.iter().flat_map(|(_, judgement)| judgement.blocked_by.iter().cloned()).collect();
    let no_table = judged.iter().find_map(|(_, judgement)| judgement.no_table.clone());
    let parts = judged.into_iter().map(|(name, Judgement { verdict, found, comparison, printed_unit, .. })| Part {
        name: name.into(),
        verdict,
        found,
        comparison,
        printed_unit,
    });
    let parts = parts.collect();
    Judgement {
        found: found.join("; "),
        no_table,
        parts,
        blocked_by: blocked_by.into_iter().collect(),
        robust,
        ..Judgement::of(verdict.unwrap_or(Verdict::Missing))
    }
}

fn robust(moved: &[Moved]) -> Option<(u32, u32)> {
    let (kept, run) = (moved.iter().filter(|one| one.kept).count(), moved.len());
    (run > 0).then(|| (u32::try_from(kept).unwrap_or(u32::MAX), u32::try_from(run).unwrap_or(u32::MAX)))
}

/// The same question put to every variant of the assumptions that was run for the rows in question.
fn moved<'a, T>(
    view: &View<'a>,
    mut ask: impl FnMut(&View<'a>) -> Result<T, Absence>,
) -> Result<Vec<(&'a str, T)>, Absence> {
    let mut answers = Vec::new();
    for variant in view.variants() {
        match ask(&View { variant, ..view.clone() }) {
            Ok(answer) => answers.push((variant, answer)),
            Err(Absence::NoRow(_)) => {}
            Err(Absence::NoTable { table, reason }) => {
                return Err(Absence::NoTable { table, reason: format!("with {variant}: {reason}") });
            }
            Err(Absence::Broken(reason)) => return Err(Absence::Broken(format!("with {variant}: {reason}"))),
            Err(Absence::Nowhere(reason)) => return Err(Absence::Nowhere(format!("with {variant}: {reason}"))),
        }
    }
    Ok(answers)
}

fn value(
    view: &View<'_>,
    published: &Printed,
    from: &Extraction,
    by_hand: Option<&Tolerance>,
    fitted: bool,
) -> Result<Judgement, Absence> {
    let simulated = match from.take(view) {
        Ok(simulated) => simulated,
        Err(Absence::Nowhere(reason)) => {
            return Ok(Judgement { found: reason, ..Judgement::of(Verdict::Differs) });
        }
        Err(absence) => return Err(absence),
    };
    let unit = &simulated.unit;
    let (datum, half_unit) = published.converted_to(unit).ok_or_else(|| Absence::Broken(published.unlike(unit)))?;
    let worth = half_unit / published.half_unit();
    // A feature that vanishes when an input is moved has no half range; it counts as a verdict that was not kept.
    let others: Vec<(&str, Option<Extracted>)> = moved(view, |variant| match from.take(variant) {
        Err(Absence::Nowhere(_)) => Ok(None),
        other => other.map(Some),
    })?;
    let shares = input_shares(simulated.value, &others);
    let from_inputs = shares.iter().map(|(_, square)| square).sum::<f64>().sqrt();
    let comparison = Comparison {
        simulated: simulated.value,
        published: datum,
        u_num: libm::hypot(simulated.run, simulated.spread),
        u_input: libm::hypot(from_inputs, from.left_by_tolerances(view)),
        u_data: if from.is_count() { 0.0 } else { half_unit },
        spread: simulated.spread,
        tolerance_by_hand: by_hand.map(|tolerance| match tolerance.size {
            ToleranceSize::Relative(fraction) => fraction * datum.abs(),
            ToleranceSize::Absolute(distance) => distance * worth,
        }),
        scale: simulated.scale,
    };
    let (verdict, remark) = compare::verdict(&comparison, fitted);
    let description = |(variant, other): &(&str, Option<Extracted>)| {
        let there = other.as_ref().map_or(Verdict::Differs, |other| comparison.verdict_of(other.value, fitted));
        let found = other.as_ref().map_or_else(|| "none".into(), |other| comparison.in_words(other.value, published));
        Moved {
            variant: (*variant).into(),
            found,
            value: other.as_ref().map(|other| other.value),
            verdict: there,
            kept: other.is_some() && there == verdict,
        }
    };
    let moved: Vec<Moved> = others.iter().map(description).collect();
    let mut found = comparison.measured(published);
    if let Some(remark) = remark {
        found = format!("{found}; {remark}");
    }
    let blocked_by = if verdict == Verdict::Blocked { most_of(&shares) } else { Vec::new() };
    if !blocked_by.is_empty() {
        found += &format!(", most of it `{}`", blocked_by.join("`, `"));
    }
    let robust = robust(&moved);
    let printed_unit = PrintedUnit { symbol: published.unit().to_owned(), worth };
    Ok(Judgement {
        found,
        comparison: Some(comparison),
        printed_unit,
        blocked_by,
        robust,
        moved,
        ..Judgement::of(verdict)
    })
}

/// What each assumption adds to u_input², largest first: the square of half the range that it gives the value.
fn input_shares<'a>(baseline: f64, others: &[(&'a str, Option<Extracted>)]) -> Vec<(&'a str, f64)> {
    let mut ranges: BTreeMap<&str, (f64, f64)> = BTreeMap::new();
    for (variant, other) in others.iter().filter_map(|(variant, other)| Some((variant, other.as_ref()?))) {
        let range = ranges.entry(assumption_of(variant)).or_insert((baseline, baseline));
        *range = (range.0.min(other.value), range.1.max(other.value));
    }
    let mut shares: Vec<_> =
        ranges.into_iter().map(|(assumption, (low, high))| (assumption, (high - low) * (high - low) / 4.0)).collect();
    shares.sort_by(|a, b| b.1.total_cmp(&a.1));
    shares
}

/// The assumptions that make up most of u_input: as many of the largest as it takes.
fn most_of(shares: &[(&str, f64)]) -> Vec<String> {
    let whole: f64 = shares.iter().map(|(_, square)| square).sum();
    let mut so_far = 0.0;
    let needed = shares.iter().take_while(|(_, square)| {
        let more = so_far < MOST * whole;
        so_far += square;
        more
    });
    needed.map(|(assumption, _)| (*assumption).to_owned()).collect()
}

/// Judges one entry and tells which cells of its own table decided it.
pub(crate) fn judge_noting(entry: &Entry, experiment: &str, tables: &Tables<'_>) -> (Judged, Reads) {
    let reads = Reads::default();
    let judged = judge_entry(entry, experiment, tables, &BTreeSet::new(), &reads);
    (judged, reads)
}
