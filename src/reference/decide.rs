//! Decides predicates over the rows of a view.

use super::extract::Extracted;
use super::line::{common, lines};
use super::place::{best_place, grows_towards};
use super::predicate::{
    Apart, Between, ColumnsAgree, Equal, GreatestPoint, Level, LineAbove, LinesAgree, PathMonotone, PathsCross,
    Predicate, Trend, Within,
};
use super::selection::Allowed;
use super::shape::{greatest_at_end, levels_off, linear, monotone, onsets, peaks};
use super::tally::{Decision, Outcome, Tally};
use super::text::{percent, significant, with_unit};
use super::view::{Absence, Cell, Line, View};

/// Decides a claim over the rows that the view means.
pub(crate) fn decide(predicate: &Predicate, view: &View<'_>) -> Result<Decision, Absence> {
    let decided = match predicate {
        Predicate::Monotone(claim) => monotone(claim, view),
        Predicate::Trend(claim) => trend(claim, view),
        Predicate::GreatestFirst(list) => list
            .iter()
            .map(|one| one.take(view))
            .collect::<Result<Vec<_>, _>>()
            .and_then(|values| greatest_first(&values)),
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
        Err(Absence::Nowhere(reason)) => Ok(Decision { outcome: Outcome::Fails, found: reason, reach: None }),
        other => other,
    }
}

fn trend(claim: &Trend, view: &View<'_>) -> Result<Decision, Absence> {
    let rows = view.rows(super::view::Source { table: None, rows: &view.given }, Some(&claim.along))?;
    let levels = view.levels(&rows, &claim.along)?;
    let numbers =
        levels.iter().map(|level| claim.of.take(&view.narrowed(&claim.along, level))).collect::<Result<Vec<_>, _>>()?;
    let range = numbers.iter().map(|n| n.value).fold(f64::NEG_INFINITY, f64::max)
        - numbers.iter().map(|n| n.value).fold(f64::INFINITY, f64::min);
    let list: Vec<String> = levels
        .iter()
        .zip(&numbers)
        .map(|(level, number)| format!("{} ({level})", with_unit(number.value, 4, &number.unit)))
        .collect();
    let mut tally = Tally::new();
    for pair in numbers.windows(2) {
        let (margin, u) =
            (claim.direction.sign() * (pair[1].value - pair[0].value), libm::hypot(pair[0].run, pair[1].run));
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
    Ok(Decision { found: list.join(", "), ..tally.decision()? })
}

fn list(values: &[Extracted], between: &str) -> String {
    values.iter().map(|one| with_unit(one.value, 5, &one.unit)).collect::<Vec<_>>().join(between)
}

fn greatest_first(values: &[Extracted]) -> Result<Decision, Absence> {
    let mut tally = Tally::new();
    for pair in values.windows(2) {
        tally.require_strictly(pair[0].value - pair[1].value, libm::hypot(pair[0].run, pair[1].run), String::new);
    }
    let decision = tally.decision()?;
    let found = match decision.outcome {
        Outcome::Holds => list(values, " > "),
        Outcome::Undecided => list(values, ", "),
        Outcome::Fails => format!("{}: not in this order", list(values, ", ")),
    };
    Ok(Decision { found, ..decision })
}

fn equal(claim: &Equal, view: &View<'_>) -> Result<Decision, Absence> {
    let values = claim.values.iter().map(|one| one.take(view)).collect::<Result<Vec<_>, _>>()?;
    let mut tally = Tally::new();
    for (i, a) in values.iter().enumerate() {
        for b in &values[i + 1..] {
            let apart = (a.value - b.value).abs();
            tally.require(
                claim.within.allows(a.value, b.value) - apart,
                joint([a.value, a.run], [b.value, b.run]),
                String::new,
            );
        }
    }
    let found = format!("{}, to agree within {}", list(&values, " and "), claim.within.words());
    Ok(Decision { found, ..tally.decision()? })
}

/// Error of a difference of two (value, error). Numbers that are equal to the last bit come from the same motion, chaotic or
/// not (a stop that is never reached, say): their errors are one error.
fn joint(a: [f64; 2], b: [f64; 2]) -> f64 {
    if a == b { 0.0 } else { libm::hypot(a[1], b[1]) }
}

fn apart(claim: &Apart, view: &View<'_>) -> Result<Decision, Absence> {
    let values = claim.values.iter().map(|one| one.take(view)).collect::<Result<Vec<_>, _>>()?;
    let mut tally = Tally::new();
    for (i, a) in values.iter().enumerate() {
        for b in &values[i + 1..] {
            let apart = (a.value - b.value).abs();
            tally.require_strictly(apart - claim.by.allows(a.value, b.value), libm::hypot(a.run, b.run), String::new);
        }
    }
    let found = format!("{}, to differ by {}", list(&values, " and "), claim.by.words());
    Ok(Decision { found, ..tally.decision()? })
}

fn between(claim: &Between, view: &View<'_>) -> Result<Decision, Absence> {
    let value = claim.value.take(view)?;
    let mut tally = Tally::new();
    if let Some(from) = claim.from {
        tally.require(value.value - from, value.run, String::new);
    }
    if let Some(to) = claim.to {
        tally.require(to - value.value, value.run, String::new);
    }
    let end = |end: Option<f64>| end.map_or_else(|| "…".to_string(), |x| significant(x, 4));
    let found = format!(
        "{} ± {}, to lie in {} to {}",
        with_unit(value.value, 4, &value.unit),
        significant(value.run, 2),
        end(claim.from),
        end(claim.to)
    );
    Ok(Decision { found, ..tally.decision()? })
}

fn level(claim: &Level, view: &View<'_>, side: f64) -> Result<Decision, Absence> {
    let rows = view.rows(claim.source(), None)?;
    let cells = view.cells(&rows, &claim.of)?;
    let unit = view.unit(&rows, &claim.of)?;
    let mut tally = Tally::new();
    for cell in &cells {
        tally.require(side * (cell.value - claim.level) + claim.slack, cell.run, || {
            let nearest = with_unit(cell.value, 5, unit);
            if cells.len() == 1 { nearest } else { format!("nearest to the level in {} rows: {nearest}", cells.len()) }
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
    let mut tally = Tally::new();
    for row in 0..rows.count() {
        let cells: Vec<Cell> = columns.iter().map(|column| column[row]).collect();
        agree(&mut tally, &cells, claim.within, String::new);
    }
    tally.decision()
}

fn lines_agree(claim: &LinesAgree, view: &View<'_>) -> Result<Decision, Absence> {
    let all = lines(view, claim.source(), &claim.of, &claim.over, &claim.by)?;
    let mut tally = Tally::new();
    for (x, cells) in common(&all)? {
        agree(&mut tally, &cells, claim.within, || format!(" at {} = {}", claim.over, significant(x, 4)));
    }
    tally.decision()
}

fn line_above(claim: &LineAbove, view: &View<'_>) -> Result<Decision, Absence> {
    let all = lines(view, claim.source(), &claim.of, &claim.over, &claim.by)?;
    let line = |level: &String| {
        let found = all.iter().find(|(allowed, _)| *allowed == Allowed::Text(level.clone()));
        found.cloned().ok_or_else(|| Absence::NoRow(format!("no line with {} = {level}", claim.by)))
    };
    let pair = vec![line(&claim.above)?, line(&claim.below)?];
    let mut tally = Tally::new();
    for (x, cells) in common(&pair)? {
        let (above, below) = (cells[0], cells[1]);
        let margin = above.value - below.value;
        tally.require_strictly(margin, libm::hypot(above.run, below.run), || {
            format!("least lead {} at {} = {}", significant(margin, 3), claim.over, significant(x, 4))
        });
    }
    tally.decision()
}

fn agree(tally: &mut Tally, cells: &[Cell], within: Within, place: impl FnOnce() -> String) {
    if let Some((low, high)) = extremes(cells) {
        let apart = high.value - low.value;
        let margin = within.allows(low.value, high.value) - apart;
        tally.require(margin, joint([low.value, low.run], [high.value, high.run]), || {
            let shown = match within {
                Within::Relative(_) => percent(apart / low.value.abs().max(high.value.abs())),
                Within::Absolute(_) => significant(apart, 3),
            };
            format!("at most {shown} apart{}, {} allowed", place(), within.words())
        });
    }
}

fn paths_cross(claim: &PathsCross, view: &View<'_>) -> Result<Decision, Absence> {
    let rows = view.rows(claim.source(), None)?;
    let (one, other) = (view.path(&rows, &claim.of)?, view.path(&rows, &claim.other)?);
    let unit = view.unit(&rows, &claim.of)?;
    let apart = || one.iter().zip(other).map(|(a, b)| a - b);
    let (above, below) = (apart().fold(f64::NEG_INFINITY, f64::max), -apart().fold(f64::INFINITY, f64::min));
    let mut tally = Tally::new();
    tally.require_strictly(above.min(below), 0.0, || {
        format!(
            "`{}` rises above `{}` by up to {} and falls below by up to {}",
            claim.of,
            claim.other,
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
    let unit = view.unit(&rows, &claim.of)?;
    let mut tally = Tally::new();
    tally.require_strictly(value - most, 0.0, || {
        format!(
            "{} at {} = {}; elsewhere at most {}, at {}",
            with_unit(value, 4, unit),
            claim.over,
            significant(here, 4),
            with_unit(most, 4, unit),
            significant(other, 4)
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
        of: claim.of.clone(),
        unit: view.unit(&rows, &claim.of)?.into(),
        x: vec![0.0; samples.len()],
        y: samples.iter().map(cell).collect(),
    };
    let (range, back) = (line.range(), line.largest_fall().value);
    let mut tally = Tally::new();
    let rise = line.y[line.y.len() - 1].value - line.y[0].value;
    tally.require_strictly(rise, 0.0, || "it does not go that way from end to end".into());
    tally.require(claim.slack * range - back, 0.0, || {
        format!("largest step back {} of the range, {} allowed", percent(back / range), percent(claim.slack))
    });
    tally.decision()
}
