//! Decides predicates over the rows of a view.

use std::cmp::Ordering;

use super::absence::Absence;
use super::claims::{
    Apart, Between, ColumnsAgree, Equal, GreatestPoint, Level, LineAbove, LinesAgree, PathMonotone, PathsCross, Points,
    Trend, Within,
};
use super::compare::COVERAGE;
use super::extracted::{Extracted, listed};
use super::extraction::Extraction;
use super::line::{common, lines};
use super::place::{best_place, grows_towards};
use super::predicate::Predicate;
use super::shape::{greatest_at_end, levels_off, linear, monotone, onsets, peaks};
use super::tally::{Decision, Outcome, Tally, strict};
use super::text::{
    apart as told_apart, in_scale_of, percent, place, significant, symbol, with_error_in_scale_of, with_unit,
};
use super::view::{Cell, Line, Source, View};
use super::words;
use crate::measure::column_words;
use crate::text::name;

/// Decides a claim over the rows that the view means.
pub(crate) fn decide(predicate: &Predicate, view: &View<'_>) -> Result<Decision, Absence> {
    let decided = match predicate {
        Predicate::Monotone(claim) => monotone(claim, view),
        Predicate::Trend(claim) => trend(claim, view),
        Predicate::GreatestFirst(list) => greatest_first(list, view),
        Predicate::Equal(claim) => equal(claim, view),
        Predicate::Apart(claim) => apart(claim, view),
        Predicate::Between(claim) => between(claim, view),
        Predicate::Above(claim) => level(claim, view, 1.0),
        Predicate::Below(claim) => level(claim, view, -1.0),
        Predicate::ColumnsAgree(claim) => columns_agree(claim, view),
        Predicate::LinesAgree(claim) => lines_agree(claim, view),
        Predicate::LineAbove(claim) => line_above(claim, view),
        Predicate::Linear(claim) => linear(claim, view),
        Predicate::LevelsOff(claim) => levels_off(claim, view),
        Predicate::GreatestAtEnd(claim) => greatest_at_end(claim, view),
        Predicate::Peaks(claim) => peaks(claim, view),
        Predicate::Onsets(claim) => onsets(claim, view),
        Predicate::PathsCross(claim) => paths_cross(claim, view),
        Predicate::PathMonotone(claim) => path_monotone(claim, view),
        Predicate::GreatestPoint(claim) => greatest_point(claim, view),
        Predicate::BestPlace(claim) => best_place(claim, view),
        Predicate::GrowsTowards(claim) => grows_towards(claim, view),
        Predicate::Curve(claim) => claim.decide(view),
        Predicate::ModeShape(claim) => claim.decide(view),
    };
    match decided {
        // What the claim speaks of does not happen: that is an answer.
        Err(Absence::Nowhere(reason)) => {
            Ok(Decision { outcome: Outcome::Fails, found: reason, reach: None, margin: None })
        }
        other => other,
    }
}

fn trend(claim: &Trend, view: &View<'_>) -> Result<Decision, Absence> {
    let rows = view.rows(Source { table: None, rows: &view.given }, Some(&claim.along))?;
    let levels = view.levels(&rows, &claim.along)?;
    let along_unit = view.unit(&rows, &claim.along)?;
    let numbers =
        levels.iter().map(|level| claim.of.take(&view.narrowed(&claim.along, level))).collect::<Result<Vec<_>, _>>()?;
    let range = numbers.iter().map(|n| n.value).fold(f64::NEG_INFINITY, f64::max)
        - numbers.iter().map(|n| n.value).fold(f64::INFINITY, f64::min);
    let list: Vec<String> = levels
        .iter()
        .zip(listed(&numbers))
        .enumerate()
        .map(|(i, (level, number))| {
            let level = words::of_level(&claim.along, level, along_unit);
            match (i, &level) {
                (0, level) if &*claim.along != name::SWEEP => format!("{number} ({} = {level})", symbol(&claim.along)),
                (_, level) => format!("{number} ({level})"),
            }
        })
        .collect();
    let mut tally = Tally::new(unit_of(&numbers));
    for pair in numbers.windows(2) {
        let (margin, u) = lead(&pair[1], &pair[0]);
        let margin = claim.direction.sign() * margin;
        if claim.slack > 0.0 {
            tally.require(margin + claim.slack * range, u, String::new);
        } else {
            tally.require_strictly(margin, u, String::new);
        }
    }
    if claim.slack > 0.0
        && let (Some(first), Some(last)) = (numbers.first(), numbers.last())
    {
        let margin = claim.direction.sign() * (last.value - first.value);
        tally.require_strictly(margin, libm::hypot(first.run, last.run), String::new);
    }
    let margin = |i: usize| claim.direction.sign() * (numbers[i + 1].value - numbers[i].value);
    let worst = (0..numbers.len().saturating_sub(1)).min_by(|a, b| margin(*a).total_cmp(&margin(*b)));
    let what = words::common(std::slice::from_ref(&claim.of)).unwrap_or_default();
    Ok(Decision { found: what + &shortened(&list, worst.unwrap_or(0)), ..tally.decision()? })
}

/// Short lists whole; of long ones both ends and the two numbers from `worst` on.
fn shortened(list: &[String], worst: usize) -> String {
    if list.len() <= 6 {
        return list.join(", ");
    }
    let mut shown: Vec<usize> = vec![0, worst, worst + 1, list.len() - 1];
    shown.dedup();
    let mut text = String::new();
    for (i, &at) in shown.iter().enumerate() {
        let before = i.checked_sub(1).map(|i| shown[i]);
        text += match before {
            None => "",
            Some(before) if before + 1 == at => ", ",
            Some(_) => " … ",
        };
        text += &list[at];
    }
    text
}

fn greatest_first(list: &[Extraction], view: &View<'_>) -> Result<Decision, Absence> {
    let values = list.iter().map(|one| one.take(view)).collect::<Result<Vec<_>, _>>()?;
    let mut tally = Tally::new(unit_of(&values));
    for pair in values.windows(2) {
        let (margin, u) = lead(&pair[0], &pair[1]);
        tally.require_strictly(margin, u, String::new);
    }
    let decision = tally.decision()?;
    let common = words::common(list);
    let mut found = common.clone().unwrap_or_default();
    let mut shown = listed(&values);
    for i in 1..shown.len() {
        if are_equal(&values[i - 1], &values[i]) {
            shown[i] = shown[i - 1].clone();
        }
    }
    for (i, text) in shown.iter().enumerate() {
        if let Some(before) = i.checked_sub(1) {
            found += match values[before].value.total_cmp(&values[i].value) {
                _ if are_equal(&values[before], &values[i]) => " = ",
                _ if decision.outcome == Outcome::Undecided => " ≈ ",
                Ordering::Greater => " > ",
                Ordering::Equal => " = ",
                Ordering::Less => " < ",
            };
        }
        if common.is_none()
            && let Some(what) = list[i].in_words()
        {
            found += &format!("{what} ");
        }
        found += text;
        // Too close for any number of digits.
        if let Some(before) = i.checked_sub(1)
            && shown[before] == *text
            && values[before].value != values[i].value
            && !are_equal(&values[before], &values[i])
        {
            let less = values[before].value - values[i].value;
            found += &format!(" {} {}", if less > 0.0 { '−' } else { '+' }, significant(less.abs(), 1));
        }
    }
    Ok(Decision { found, ..decision })
}

/// Share of two numbers below which their difference is nothing that one could be greater by.
const NOTHING: f64 = 1e-9;

/// By how much one number is above another, and its uncertainty; of equal ones neither has any.
fn lead(of: &Extracted, over: &Extracted) -> (f64, f64) {
    if are_equal(of, over) { (0.0, 0.0) } else { (of.value - over.value, libm::hypot(of.run, over.run)) }
}

/// Both are known so well, and are so near, that neither is greater.
fn are_equal(a: &Extracted, b: &Extracted) -> bool {
    let (apart, u) = ((a.value - b.value).abs(), libm::hypot(a.run, b.run));
    apart == 0.0 && u == 0.0 || apart.max(COVERAGE * u) <= NOTHING * a.value.abs().max(b.value.abs())
}

/// The unit that numbers of one claim share.
fn unit_of(numbers: &[Extracted]) -> &str {
    numbers.first().map_or("", |one| one.unit.as_str())
}

fn equal(claim: &Equal, view: &View<'_>) -> Result<Decision, Absence> {
    let values = claim.values.iter().map(|one| one.take(view)).collect::<Result<Vec<_>, _>>()?;
    let mut tally = Tally::new("");
    for (i, a) in values.iter().enumerate() {
        for b in &values[i + 1..] {
            let apart = (a.value - b.value).abs();
            tally.require_in(
                1.0,
                claim.within.shown(a.value, b.value, &a.unit),
                claim.within.allows(a.value, b.value) - apart,
                joint([a.value, a.run], [b.value, b.run]),
                String::new,
            );
        }
    }
    let what = words::common(&claim.values).unwrap_or_default();
    let found = format!(
        "{what}{} ({} allowed)",
        difference(&values, &claim.values, &claim.within),
        allowed(&values, &claim.within)
    );
    Ok(Decision { found, ..tally.decision()? })
}

/// A distance that is allowed, or required, between these numbers, in the unit in which they are shown.
fn allowed(values: &[Extracted], within: &Within) -> String {
    let largest = values.iter().map(|one| one.value.abs()).fold(0.0, f64::max);
    within.words(largest, unit_of(values))
}

/// Of numbers that are equal to the last bit, of which only the first digits are shown.
const IDENTICAL: &str = "identical to the last digit";

/// Numbers and how far apart they are: `161.9 rad/s and 162.0 rad/s, 0.07 % apart`, `3.375, identical to the last digit`,
/// `2 × 12.843 rad/s and 25.69 rad/s, identical to the last digit`.
fn difference(values: &[Extracted], sources: &[Extraction], within: &Within) -> String {
    let multiples = values.iter().zip(sources).map(|(one, source)| match source {
        Extraction::Times(times) if times.factor.fract() == 0.0 => {
            let of = one.value / times.factor;
            let of = with_unit(of, digits_for_product(of, times.factor), &one.unit);
            Some(format!("{} × {of}", significant(times.factor, 4)))
        }
        _ => None,
    });
    let multiples: Vec<Option<String>> = multiples.collect();
    let (low, high) = values
        .iter()
        .map(|one| one.value)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if let (Some(first), true) = (values.first(), low == high && multiples.iter().all(Option::is_none)) {
        return format!("{}, {IDENTICAL}", with_unit(first.value, 4, &first.unit));
    }
    let apart = match within {
        Within::Relative(_) => percent((high - low) / low.abs().max(high.abs())),
        Within::Absolute(_) => in_scale_of(low.abs().max(high.abs()), high - low, 3, unit_of(values)),
    };
    // The outermost two differ to the eye; those between them need not.
    let ends = told_apart(&[(low, &values[0].unit), (high, &values[0].unit)]);
    let shown = |one: &Extracted| match one.value {
        x if x == low => ends[0].clone(),
        x if x == high => ends[1].clone(),
        x => with_unit(x, 4, &one.unit),
    };
    let shown = values.iter().zip(multiples).map(|(one, multiple)| multiple.unwrap_or_else(|| shown(one)));
    let shown = shown.collect::<Vec<_>>().join(" and ");
    if low == high { format!("{shown}, {IDENTICAL}") } else { format!("{shown}, {apart} apart") }
}

/// How many digits of a number have to be shown so that who multiplies them finds the product as it is shown beside them.
fn digits_for_product(number: f64, factor: f64) -> usize {
    let shown = |digits: usize| format!("{number:.0$e}", digits - 1).parse().unwrap_or(number);
    let is_enough = |digits: &usize| significant(factor * shown(*digits), 4) == significant(factor * number, 4);
    (4..=17).find(is_enough).unwrap_or(17)
}

/// Error of a difference of two (value, error). Numbers that are equal to the last bit come from the same motion, chaotic or
/// not (a stop that is never reached, say): their errors are one error.
fn joint(a: [f64; 2], b: [f64; 2]) -> f64 {
    if a == b { 0.0 } else { libm::hypot(a[1], b[1]) }
}

fn apart(claim: &Apart, view: &View<'_>) -> Result<Decision, Absence> {
    let values = claim.values.iter().map(|one| one.take(view)).collect::<Result<Vec<_>, _>>()?;
    let mut tally = Tally::new("");
    for (i, a) in values.iter().enumerate() {
        for b in &values[i + 1..] {
            let margin = (a.value - b.value).abs() - claim.by.allows(a.value, b.value);
            let shown = claim.by.shown(a.value, b.value, &a.unit);
            tally.require_in(1.0, shown, strict(margin), libm::hypot(a.run, b.run), String::new);
        }
    }
    let what = words::common(&claim.values).unwrap_or_default();
    let found = format!(
        "{what}{} (at least {} required)",
        difference(&values, &claim.values, &claim.by),
        allowed(&values, &claim.by)
    );
    Ok(Decision { found, ..tally.decision()? })
}

fn between(claim: &Between, view: &View<'_>) -> Result<Decision, Absence> {
    let value = claim.value.take(view)?;
    let mut tally = Tally::new(&value.unit);
    if let Some(from) = claim.from {
        tally.require(value.value - from, value.run, String::new);
    }
    if let Some(to) = claim.to {
        tally.require(to - value.value, value.run, String::new);
    }
    // The number and its bounds in one unit.
    let ends = [claim.from, claim.to].into_iter().flatten();
    let largest = ends.fold(value.value.abs(), |largest, end| largest.max(end.abs()));
    let end = |x: f64| in_scale_of(largest, x, 4, &value.unit);
    let required = match (claim.from, claim.to) {
        (Some(from), Some(to)) => format!("{} to {}", end(from), end(to)),
        (Some(from), None) => format!("at least {}", end(from)),
        (None, Some(to)) => format!("at most {}", end(to)),
        (None, None) => "any".into(),
    };
    // Below the digits shown it is rounding and not worth a reader's time.
    let shown = if value.run > 1e-4 * value.value.abs() {
        with_error_in_scale_of(largest, value.value, COVERAGE * value.run, &value.unit)
    } else {
        end(value.value)
    };
    let what = words::common(std::slice::from_ref(&claim.value)).unwrap_or_default();
    let found = format!("{what}{shown} (required: {required})");
    Ok(Decision { found, margin: None, ..tally.decision()? })
}

fn level(claim: &Level, view: &View<'_>, side: f64) -> Result<Decision, Absence> {
    let rows = view.rows(claim.source(), None)?;
    let cells = view.cells(&rows, &claim.of)?;
    let unit = view.unit(&rows, &claim.of)?;
    let mut tally = Tally::new(unit);
    for cell in &cells {
        tally.require(side * (cell.value - claim.level) + claim.slack, cell.run, || {
            let (extreme, bound) = if side > 0.0 { ("lowest", "at least") } else { ("highest", "at most") };
            let shown = told_apart(&[(cell.value, unit), (claim.level, unit)]);
            let of =
                if cells.len() == 1 { String::new() } else { format!(", the {extreme} of {} points", cells.len()) };
            format!("{} {}{of} (required: {bound} {})", column_words(&claim.of), shown[0], shown[1])
        });
    }
    tally.decision()
}

fn extremes(cells: &[Cell]) -> Option<(Cell, Cell)> {
    let low = cells.iter().copied().min_by(|a, b| a.value.total_cmp(&b.value))?;
    let high = cells.iter().copied().max_by(|a, b| a.value.total_cmp(&b.value))?;
    Some((low, high))
}

fn columns_agree(claim: &ColumnsAgree, view: &View<'_>) -> Result<Decision, Absence> {
    let rows = view.rows(claim.source(), None)?;
    let columns = claim.columns.iter().map(|of| view.cells(&rows, of)).collect::<Result<Vec<_>, _>>()?;
    let unit = view.unit(&rows, &claim.columns[0])?;
    let mut tally = Tally::new("");
    for row in 0..rows.count() {
        let cells: Vec<Cell> = columns.iter().map(|column| column[row]).collect();
        agree(&mut tally, &cells, &claim.within, unit, String::new);
    }
    tally.decision()
}

fn lines_agree(claim: &LinesAgree, view: &View<'_>) -> Result<Decision, Absence> {
    let all = lines(view, claim.source(), &claim.of, &claim.over, &claim.by)?;
    let (unit, over_unit) = all.first().map_or(("", ""), |(_, line)| (line.unit.as_str(), line.over_unit.as_str()));
    let mut tally = Tally::new("");
    for (x, cells) in common(&all)? {
        agree(&mut tally, &cells, &claim.within, unit, || format!(" at {}", place(&claim.over, x, 4, over_unit)));
    }
    tally.decision()
}

fn line_above(claim: &LineAbove, view: &View<'_>) -> Result<Decision, Absence> {
    let mut lead = claim.pair().lead(view, claim.source())?;
    let mut tally = Tally::new(&lead.unit);
    if claim.points == Points::Most {
        // More than half are ahead if the one in the middle, or the next lower, is.
        let points = lead.y.len();
        let ahead = lead.y.iter().filter(|cell| cell.value > 0.0).count();
        lead.y.sort_by(|a, b| b.value.total_cmp(&a.value));
        let middle = lead.y[points / 2];
        tally.require_strictly(middle.value, middle.run, || {
            format!("ahead at {ahead} of {points} points, median lead {}", with_unit(middle.value, 3, &lead.unit))
        });
        return tally.decision();
    }
    for (x, ahead) in lead.x.iter().zip(&lead.y) {
        tally.require_strictly(ahead.value, ahead.run, || {
            let at = place(&claim.over, *x, 4, &lead.over_unit);
            format!("smallest lead {} at {at}", with_unit(ahead.value, 3, &lead.unit))
        });
    }
    tally.decision()
}

fn agree(tally: &mut Tally, cells: &[Cell], within: &Within, unit: &str, at: impl FnOnce() -> String) {
    if let Some((low, high)) = extremes(cells) {
        let apart = high.value - low.value;
        let allowed = within.allows(low.value, high.value);
        let scale = if allowed > 0.0 { allowed } else { 1.0 };
        let shown = within.shown(low.value, high.value, unit);
        tally.require_in(scale, shown, allowed - apart, joint([low.value, low.run], [high.value, high.run]), || {
            let shown = match within {
                Within::Relative(_) => percent(apart / low.value.abs().max(high.value.abs())),
                Within::Absolute(_) => in_scale_of(apart.max(allowed), apart, 3, unit),
            };
            format!("up to {shown} apart{} ({} allowed)", at(), within.words(apart.max(allowed), unit))
        });
    }
}

fn paths_cross(claim: &PathsCross, view: &View<'_>) -> Result<Decision, Absence> {
    let rows = view.rows(claim.source(), None)?;
    let (one, other) = (view.path(&rows, &claim.of)?, view.path(&rows, &claim.other)?);
    let (unit, others) = (view.unit(&rows, &claim.of)?, view.unit(&rows, &claim.other)?);
    if unit != others {
        return Err(Absence::Broken(format!("`{}` in `{unit}` against `{}` in `{others}`", claim.of, claim.other)));
    }
    let apart = || one.iter().zip(other).map(|(a, b)| a - b);
    let (above, below) = (apart().fold(f64::NEG_INFINITY, f64::max), -apart().fold(f64::INFINITY, f64::min));
    let mut tally = Tally::new("");
    tally.require_strictly(above.min(below), 0.0, || {
        format!(
            "{} goes above {} by up to {} and below it by up to {}",
            symbol(&claim.of),
            symbol(&claim.other),
            with_unit(above, 3, unit),
            with_unit(below, 3, unit)
        )
    });
    tally.decision()
}

fn greatest_point(claim: &GreatestPoint, view: &View<'_>) -> Result<Decision, Absence> {
    let rows = view.rows(claim.source(), None)?;
    let (points, values) = (view.path(&rows, &claim.over)?, view.path(&rows, &claim.of)?);
    let distance = |&(point, _): &(&f64, &f64)| (point - claim.at).abs();
    let all = || points.iter().zip(values);
    let Some((&here, &value)) = all().min_by(|a, b| distance(a).total_cmp(&distance(b))) else {
        return Err(Absence::NoRow(format!("the list `{}` is empty", claim.over)));
    };
    let elsewhere = all().filter(|(point, _)| **point != here).max_by(|a, b| a.1.total_cmp(b.1));
    let Some((&other, &most)) = elsewhere else {
        return Err(Absence::NoRow(format!("the list `{}` has one point alone", claim.over)));
    };
    let (unit, over_unit) = (view.unit(&rows, &claim.of)?, view.unit(&rows, &claim.over)?);
    let mut tally = Tally::new("");
    tally.require_strictly(value - most, 0.0, || {
        format!(
            "{} at {}; elsewhere at most {}, at {}",
            with_unit(value, 4, unit),
            place(&claim.over, here, 4, over_unit),
            with_unit(most, 4, unit),
            with_unit(other, 4, over_unit)
        )
    });
    tally.decision()
}

fn path_monotone(claim: &PathMonotone, view: &View<'_>) -> Result<Decision, Absence> {
    let rows = view.rows(claim.source(), None)?;
    let path = view.path(&rows, &claim.of)?;
    let first = match claim.after {
        None => 0,
        Some(after) => view.path(&rows, "time")?.partition_point(|&time| time < after),
    };
    let samples = path.get(first..).filter(|samples| samples.len() > 1);
    let samples = samples.ok_or_else(|| Absence::NoRow("the time history ends before that time".into()))?;
    let cell = |&value: &f64| Cell { value: claim.direction.sign() * value, run: 0.0, spread: 0.0 };
    let line = Line {
        over: "time".into(),
        over_unit: "s".into(),
        of: claim.of.to_string(),
        unit: view.unit(&rows, &claim.of)?.into(),
        x: vec![0.0; samples.len()],
        y: samples.iter().map(cell).collect(),
    };
    let (range, back) = (line.range(), line.largest_fall().value);
    let mut tally = Tally::new("");
    let rise = line.y[line.y.len() - 1].value - line.y[0].value;
    tally.require_strictly(rise, 0.0, || {
        format!("changes by {} from end to end", with_unit(claim.direction.sign() * rise, 3, &line.unit))
    });
    tally.require(claim.slack * range - back, 0.0, || {
        if back == 0.0 {
            "never steps back".into()
        } else {
            format!("steps back by up to {} of the range ({} allowed)", percent(back / range), percent(claim.slack))
        }
    });
    tally.decision()
}
