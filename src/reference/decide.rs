//! Decides predicates: each requirement leaves its margin, and the worst one speaks for the claim.

use super::extract::{Direction, Extracted, Side};
use super::line::{common, lines};
use super::predicate::{
    Between, ColumnsAgree, Equal, GreatestAtEnd, Level, LevelsOff, Linear, LinesAgree, Monotone, Onsets, Part,
    PathMonotone, PathsCross, Peaks, Predicate, Trend, Within,
};
use super::text::{percent, significant, with_unit};
use super::view::{Absence, Cell, Line, View};

/// What a predicate is worth, best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Outcome {
    Holds,
    Undecided,
    Fails,
}

/// A decided claim, and the sentence that explains it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Decision {
    pub outcome: Outcome,
    pub found: String,
}

/// Decides a claim over the rows that the view means.
pub(crate) fn decide(predicate: &Predicate, view: &View<'_>) -> Result<Decision, Absence> {
    let decided = match predicate {
        Predicate::Monotone(claim) => monotone(claim, view),
        Predicate::Trend(claim) => trend(claim, view),
        Predicate::GreatestFirst(list) => {
            list.iter().map(|one| one.take(view)).collect::<Result<Vec<_>, _>>().map(|values| greatest_first(&values))
        }
        Predicate::Equal(claim) => equal(claim, view),
        Predicate::Between(claim) => between(claim, view),
        Predicate::Above(claim) => level(claim, view, 1.0),
        Predicate::Below(claim) => level(claim, view, -1.0),
        Predicate::ColumnsAgree(claim) => columns_agree(claim, view),
        Predicate::LinesAgree(claim) => lines_agree(claim, view),
        Predicate::Linear(claim) => linear(claim, view),
        Predicate::LevelsOff(claim) => levels_off(claim, view),
        Predicate::GreatestAtEnd(claim) => greatest_at_end(claim, view),
        Predicate::Peaks(claim) => peaks(claim, view),
        Predicate::Onsets(claim) => onsets(claim, view),
        Predicate::PathsCross(claim) => paths_cross(claim, view),
        Predicate::PathMonotone(claim) => path_monotone(claim, view),
    };
    match decided {
        // What the claim speaks of does not happen: that is an answer.
        Err(Absence::Nowhere(reason)) => Ok(Decision { outcome: Outcome::Fails, found: reason }),
        other => other,
    }
}

/// Requirements so far: the worst one and its words.
struct Tally {
    worst: Option<(Outcome, f64, String)>,
}

impl Tally {
    fn new() -> Self {
        Self { worst: None }
    }

    /// `margin` ± `u` is to be positive (or zero, where nothing is uncertain).
    fn require(&mut self, margin: f64, u: f64, says: impl FnOnce() -> String) {
        let outcome = if margin >= 2.0 * u {
            Outcome::Holds
        } else if margin <= -2.0 * u {
            Outcome::Fails
        } else {
            Outcome::Undecided
        };
        let worse = match &self.worst {
            None => true,
            Some((worst, smallest, _)) => outcome > *worst || (outcome == *worst && margin < *smallest),
        };
        if worse {
            self.worst = Some((outcome, margin, says()));
        }
    }

    /// As [`Tally::require`], and zero is not positive.
    fn require_strictly(&mut self, margin: f64, u: f64, says: impl FnOnce() -> String) {
        self.require(if margin == 0.0 { -f64::MIN_POSITIVE } else { margin }, u, says);
    }

    fn decision(self) -> Result<Decision, Absence> {
        let (outcome, _, found) =
            self.worst.ok_or_else(|| Absence::NoRow("nothing to compare: too few points".into()))?;
        Ok(Decision { outcome, found })
    }
}

impl Within {
    fn allows(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Relative(fraction) => fraction * a.abs().max(b.abs()),
            Self::Absolute(distance) => distance,
        }
    }

    fn words(self) -> String {
        match self {
            Self::Relative(fraction) => percent(fraction),
            Self::Absolute(distance) => significant(distance, 3),
        }
    }
}

fn sign(direction: Direction) -> f64 {
    if direction == Direction::Increasing { 1.0 } else { -1.0 }
}

fn monotone(claim: &Monotone, view: &View<'_>) -> Result<Decision, Absence> {
    let mut line = view.line(claim.source(), &claim.of, &claim.over, None)?;
    let (top, range) = (line.highest(), line.range());
    let part = match claim.part {
        Part::Whole => 0..line.x.len(),
        Part::BeforeMaximum => 0..top + 1,
        Part::AfterMaximum => top..line.x.len(),
    };
    line.x = line.x[part.clone()].to_vec();
    line.y = line.y[part].to_vec();
    if line.x.len() < 2 {
        return Err(Absence::Nowhere(format!("that part of the line is one point, {} = {}", claim.over, line.x[0])));
    }
    let line = if claim.direction == Direction::Increasing { line } else { line.inverted() };
    let mut tally = Tally::new();
    let (first, last) = (line.y[0], line.y[line.y.len() - 1]);
    tally.require_strictly(last.value - first.value, last.run.hypot(first.run), || {
        format!("from end to end it changes by {}", significant(sign(claim.direction) * (last.value - first.value), 3))
    });
    let mut reached = line.y[0];
    let mut largest = (0.0, line.x[0]);
    let allowed = claim.slack * range;
    for (&x, &cell) in line.x.iter().zip(&line.y).skip(1) {
        let back = reached.value - cell.value;
        if back > largest.0 {
            largest = (back, x);
        }
        tally.require(allowed - back, cell.run.hypot(reached.run), || {
            format!(
                "step back of {} of the range at {} = {}",
                percent(back / range),
                claim.over,
                with_unit(x, 4, &line.over_unit)
            )
        });
        if cell.value > reached.value {
            reached = cell;
        }
    }
    let mut decision = tally.decision()?;
    if decision.outcome == Outcome::Holds {
        decision.found = if largest.0 > 0.0 {
            format!("largest step back {} of the range, {} allowed", percent(largest.0 / range), percent(claim.slack))
        } else {
            format!("no step back in {} points", line.x.len())
        };
    }
    Ok(decision)
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
        let (margin, u) = (sign(claim.direction) * (pair[1].value - pair[0].value), pair[0].run.hypot(pair[1].run));
        if claim.slack > 0.0 {
            tally.require(margin + claim.slack * range, u, String::new);
        } else {
            tally.require_strictly(margin, u, String::new);
        }
    }
    if claim.slack > 0.0
        && let (Some(first), Some(last)) = (numbers.first(), numbers.last())
    {
        let margin = sign(claim.direction) * (last.value - first.value);
        tally.require_strictly(margin, first.run.hypot(last.run), String::new);
    }
    let outcome = tally.decision()?.outcome;
    Ok(Decision { outcome, found: list.join(", ") })
}

fn list(values: &[Extracted], between: &str) -> String {
    values.iter().map(|one| with_unit(one.value, 5, &one.unit)).collect::<Vec<_>>().join(between)
}

fn greatest_first(values: &[Extracted]) -> Decision {
    let mut tally = Tally::new();
    for pair in values.windows(2) {
        tally.require_strictly(pair[0].value - pair[1].value, pair[0].run.hypot(pair[1].run), String::new);
    }
    let outcome = tally.worst.map_or(Outcome::Fails, |(outcome, ..)| outcome);
    let words = match outcome {
        Outcome::Holds => list(values, " > "),
        Outcome::Undecided => format!("{}: too near to tell", list(values, ", ")),
        Outcome::Fails => format!("{}: not in this order", list(values, ", ")),
    };
    Decision { outcome, found: words }
}

fn equal(claim: &Equal, view: &View<'_>) -> Result<Decision, Absence> {
    let values = claim.values.iter().map(|one| one.take(view)).collect::<Result<Vec<_>, _>>()?;
    let mut tally = Tally::new();
    for (i, a) in values.iter().enumerate() {
        for b in &values[i + 1..] {
            let apart = (a.value - b.value).abs();
            tally.require(claim.within.allows(a.value, b.value) - apart, a.run.hypot(b.run), String::new);
        }
    }
    let outcome = tally.decision()?.outcome;
    Ok(Decision { outcome, found: format!("{}, to agree within {}", list(&values, " and "), claim.within.words()) })
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
    let outcome = tally.decision()?.outcome;
    let end = |end: Option<f64>| end.map_or_else(|| "…".to_string(), |x| significant(x, 4));
    let found = format!(
        "{} ± {}, to lie in {} to {}",
        with_unit(value.value, 4, &value.unit),
        significant(value.run, 2),
        end(claim.from),
        end(claim.to)
    );
    Ok(Decision { outcome, found })
}

fn level(claim: &Level, view: &View<'_>, side: f64) -> Result<Decision, Absence> {
    let rows = view.rows(claim.source(), None)?;
    let cells = view.cells(&rows, &claim.of)?;
    let unit = view.unit(&rows, &claim.of)?;
    let mut tally = Tally::new();
    for cell in &cells {
        tally.require(side * (cell.value - claim.level) + claim.slack, cell.run, || {
            format!("nearest to the level in {} rows: {}", cells.len(), with_unit(cell.value, 5, unit))
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

fn agree(tally: &mut Tally, cells: &[Cell], within: Within, place: impl FnOnce() -> String) {
    if let Some((low, high)) = extremes(cells) {
        let apart = high.value - low.value;
        let margin = within.allows(low.value, high.value) - apart;
        tally.require(margin, low.run.hypot(high.run), || {
            let shown = match within {
                Within::Relative(_) => percent(apart / low.value.abs().max(high.value.abs())),
                Within::Absolute(_) => significant(apart, 3),
            };
            format!("at most {shown} apart{}, {} allowed", place(), within.words())
        });
    }
}

fn linear(claim: &Linear, view: &View<'_>) -> Result<Decision, Absence> {
    let line = view.line(claim.source(), &claim.of, &claim.over, None)?;
    if line.x.len() < 3 {
        return Err(Absence::NoRow("a straight line is judged by three points or more".into()));
    }
    #[expect(clippy::cast_precision_loss, reason = "row counts are far below 2^53")]
    let n = line.x.len() as f64;
    let mean_x = line.x.iter().sum::<f64>() / n;
    let mean_y = line.y.iter().map(|cell| cell.value).sum::<f64>() / n;
    let (mut xx, mut xy) = (0.0, 0.0);
    for (x, cell) in line.x.iter().zip(&line.y) {
        xx += (x - mean_x) * (x - mean_x);
        xy += (x - mean_x) * (cell.value - mean_y);
    }
    let slope = xy / xx;
    let mut tally = Tally::new();
    for (x, cell) in line.x.iter().zip(&line.y) {
        let off = (cell.value - mean_y - slope * (x - mean_x)).abs();
        tally.require(claim.within * line.range() - off, cell.run, || {
            format!(
                "departs from a straight line by {} of its range, {} allowed",
                percent(off / line.range()),
                percent(claim.within)
            )
        });
    }
    tally.decision()
}

fn levels_off(claim: &LevelsOff, view: &View<'_>) -> Result<Decision, Absence> {
    let line = view.line(claim.source(), &claim.of, &claim.over, None)?;
    let last = line.y[line.y.len() - 1];
    let mut tally = Tally::new();
    for (_, cell) in line.x.iter().zip(&line.y).rev().skip(1).filter(|(x, _)| **x >= claim.from) {
        let off = (cell.value - last.value).abs();
        tally.require(claim.within * line.range() - off, cell.run.hypot(last.run), || {
            format!(
                "from {} = {} on it stays within {} of its range, {} allowed",
                claim.over,
                significant(claim.from, 4),
                percent(off / line.range()),
                percent(claim.within)
            )
        });
    }
    tally.decision()
}

fn greatest_at_end(claim: &GreatestAtEnd, view: &View<'_>) -> Result<Decision, Absence> {
    let line = view.line(claim.source(), &claim.of, &claim.over, None)?;
    let end = if claim.end == Side::Low { 0 } else { line.x.len() - 1 };
    let at_end = line.y[end];
    let mut tally = Tally::new();
    for (i, cell) in line.y.iter().enumerate().filter(|(i, _)| *i != end) {
        tally.require_strictly(at_end.value - cell.value, at_end.run.hypot(cell.run), || {
            format!(
                "{} at the end, {} at {} = {}",
                with_unit(at_end.value, 4, &line.unit),
                with_unit(cell.value, 4, &line.unit),
                claim.over,
                significant(line.x[i], 4)
            )
        });
    }
    tally.decision()
}

fn peaks(claim: &Peaks, view: &View<'_>) -> Result<Decision, Absence> {
    let line: Line = view.line(claim.source(), &claim.of, &claim.over, None)?;
    let threshold = claim.prominence * line.range();
    let candidates = line.prominences();
    let sure: Vec<f64> =
        candidates.iter().filter(|(_, height)| height.value >= threshold + 2.0 * height.run).map(|(x, _)| *x).collect();
    let possible = candidates.iter().filter(|(_, height)| height.value + 2.0 * height.run >= threshold).count();
    let at_least = claim.at_least.map_or(Outcome::Holds, |least| {
        if sure.len() >= least {
            Outcome::Holds
        } else if possible < least {
            Outcome::Fails
        } else {
            Outcome::Undecided
        }
    });
    let at_most = claim.at_most.map_or(Outcome::Holds, |most| {
        if possible <= most {
            Outcome::Holds
        } else if sure.len() > most {
            Outcome::Fails
        } else {
            Outcome::Undecided
        }
    });
    let places: Vec<String> = sure.iter().map(|&x| significant(x, 3)).collect();
    let found = if places.is_empty() {
        format!("no peak stands out by {} of the range", percent(claim.prominence))
    } else {
        format!("{} peaks: {} = {}", sure.len(), claim.over, places.join(", "))
    };
    Ok(Decision { outcome: at_least.max(at_most), found })
}

fn onsets(claim: &Onsets, view: &View<'_>) -> Result<Decision, Absence> {
    let found = claim
        .order
        .iter()
        .map(|onset| {
            let line = view.line(claim.source(), &onset.of, &claim.over, None)?;
            Ok(line.onset(onset.above)?.1.x)
        })
        .collect::<Result<Vec<f64>, Absence>>()?;
    let mut tally = Tally::new();
    for pair in found.windows(2) {
        // On one grid, a later first point is a later onset, however wide the grid's steps are.
        tally.require_strictly(pair[1] - pair[0], 0.0, String::new);
    }
    let outcome = tally.decision()?.outcome;
    let words: Vec<String> = claim
        .order
        .iter()
        .zip(&found)
        .map(|(onset, x)| format!("{} from {} = {}", onset.of, claim.over, significant(*x, 3)))
        .collect();
    Ok(Decision { outcome, found: words.join(", ") })
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

fn path_monotone(claim: &PathMonotone, view: &View<'_>) -> Result<Decision, Absence> {
    let rows = view.rows(claim.source(), None)?;
    let path = view.path(&rows, &claim.of)?;
    let cell = |&value: &f64| Cell { value: sign(claim.direction) * value, run: 0.0, spread: 0.0 };
    let line = Line {
        over: String::new(),
        over_unit: String::new(),
        of: claim.of.clone(),
        unit: String::new(),
        x: vec![0.0; path.len()],
        y: path.iter().map(cell).collect(),
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
