//! Claims about the shape of a line: monotone, straight, levelling off, its peaks and onsets.

use super::absence::Absence;
use super::claims::{GreatestAtEnd, LevelsOff, Linear, Monotone, Onsets, Part, Peaks};
use super::compare::COVERAGE;
use super::extraction::{Direction, Side};
use super::tally::{Decision, Outcome, Tally};
use super::text::{percent, place, symbol, with_unit};
use super::view::View;

pub(crate) fn monotone(claim: &Monotone, view: &View<'_>) -> Result<Decision, Absence> {
    let mut line = view.line(claim.source(), &claim.of, &claim.over, None)?;
    if line.x.len() < 2 {
        return Err(Absence::NoRow(format!("one point of `{}` neither rises nor falls", claim.of)));
    }
    let (top, range) = (line.highest(), line.range());
    let part = match claim.part {
        Part::Whole => 0..line.x.len(),
        Part::BeforeMaximum => 0..top + 1,
        Part::AfterMaximum => top..line.x.len(),
    };
    line.x = line.x[part.clone()].to_vec();
    line.y = line.y[part].to_vec();
    if line.x.len() < 2 {
        return Err(Absence::Nowhere(format!(
            "that part of the line is one point, {}",
            place(&claim.over, line.x[0], 4, &line.over_unit)
        )));
    }
    let line = if claim.direction == Direction::Increasing { line } else { line.inverted() };
    let mut tally = Tally::of_range(range);
    let (first, last) = (line.y[0], line.y[line.y.len() - 1]);
    tally.require_strictly(last.value - first.value, libm::hypot(last.run, first.run), || {
        let change = claim.direction.sign() * (last.value - first.value);
        let sign = if change > 0.0 { "+" } else { "" };
        format!("changes by {sign}{} from end to end", with_unit(change, 3, &line.unit))
    });
    let (goes, turns) = match claim.direction {
        Direction::Increasing => ("rises", "falls back"),
        Direction::Decreasing => ("falls", "rises again"),
    };
    let mut reached = line.y[0];
    let mut largest = (0.0, line.x[0]);
    let allowed = claim.slack * range;
    for (&x, &cell) in line.x.iter().zip(&line.y).skip(1) {
        let back = reached.value - cell.value;
        if back > largest.0 {
            largest = (back, x);
        }
        tally.require(allowed - back, libm::hypot(cell.run, reached.run), || {
            format!(
                "{turns} by {} of the range up to {} ({} allowed)",
                percent(back / range),
                place(&claim.over, x, 3, &line.over_unit),
                percent(claim.slack)
            )
        });
        if cell.value > reached.value {
            reached = cell;
        }
    }
    if largest.0 > 0.0 {
        view.note_place(claim.source(), &claim.over, largest.1);
    }
    let mut decision = tally.decision()?;
    if decision.outcome == Outcome::Holds {
        decision.found = if largest.0 > 0.0 {
            format!("{turns} by at most {} of the range ({} allowed)", percent(largest.0 / range), percent(claim.slack))
        } else {
            format!("{goes} on each of {} steps", line.x.len() - 1)
        };
    }
    Ok(decision)
}

pub(crate) fn linear(claim: &Linear, view: &View<'_>) -> Result<Decision, Absence> {
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
    let mut tally = Tally::of_range(line.range());
    for (x, cell) in line.x.iter().zip(&line.y) {
        let off = (cell.value - mean_y - slope * (x - mean_x)).abs();
        tally.require(claim.within * line.range() - off, cell.run, || {
            format!(
                "departs from a straight line by {} of its range ({} allowed)",
                percent(off / line.range()),
                percent(claim.within)
            )
        });
    }
    tally.decision()
}

pub(crate) fn levels_off(claim: &LevelsOff, view: &View<'_>) -> Result<Decision, Absence> {
    let line = view.line(claim.source(), &claim.of, &claim.over, None)?;
    let last = line.y[line.y.len() - 1];
    let mut tally = Tally::of_range(line.range());
    for (_, cell) in line.x.iter().zip(&line.y).rev().skip(1).filter(|(x, _)| **x >= claim.from) {
        let off = (cell.value - last.value).abs();
        tally.require(claim.within * line.range() - off, libm::hypot(cell.run, last.run), || {
            format!(
                "stays within {1} of its range from {0} on ({2} allowed)",
                place(&claim.over, claim.from, 4, &line.over_unit),
                percent(off / line.range()),
                percent(claim.within)
            )
        });
    }
    tally.decision()
}

pub(crate) fn greatest_at_end(claim: &GreatestAtEnd, view: &View<'_>) -> Result<Decision, Absence> {
    let line = view.line(claim.source(), &claim.of, &claim.over, None)?;
    let end = if claim.end == Side::Low { 0 } else { line.x.len() - 1 };
    let at_end = line.y[end];
    let mut tally = Tally::new(&line.unit);
    for (i, cell) in line.y.iter().enumerate().filter(|(i, _)| *i != end) {
        tally.require_strictly(at_end.value - cell.value, libm::hypot(at_end.run, cell.run), || {
            format!(
                "{} at the end, {} at {}",
                with_unit(at_end.value, 4, &line.unit),
                with_unit(cell.value, 4, &line.unit),
                place(&claim.over, line.x[i], 4, &line.over_unit)
            )
        });
    }
    tally.decision()
}

pub(crate) fn peaks(claim: &Peaks, view: &View<'_>) -> Result<Decision, Absence> {
    let line = view.line(claim.source(), &claim.of, &claim.over, None)?;
    let threshold = claim.prominence * line.range();
    let candidates = line.prominences();
    let sure: Vec<f64> = candidates
        .iter()
        .filter(|(_, height)| height.value >= threshold + COVERAGE * height.run)
        .map(|(x, _)| *x)
        .collect();
    let possible = candidates.iter().filter(|(_, height)| height.value + COVERAGE * height.run >= threshold).count();
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
    let places: Vec<String> = sure.iter().map(|&x| with_unit(x, 3, &line.over_unit)).collect();
    let found = match places.len() {
        0 => format!("no peak stands out by {} of the range", percent(claim.prominence)),
        1 => format!("1 peak: {} = {}", symbol(&claim.over), places[0]),
        more => format!("{more} peaks: {} = {}", symbol(&claim.over), places.join(", ")),
    };
    Ok(Decision { outcome: at_least.max(at_most), found, reach: None, margin: None })
}

pub(crate) fn onsets(claim: &Onsets, view: &View<'_>) -> Result<Decision, Absence> {
    let found = claim
        .order
        .iter()
        .map(|onset| {
            let line = view.line(claim.source(), &onset.of, &claim.over, None)?;
            Ok((line.onset(onset.above)?.1.x, line.over_unit))
        })
        .collect::<Result<Vec<(f64, String)>, Absence>>()?;
    let mut tally = Tally::new("");
    for pair in found.windows(2) {
        // On one grid, a later first point is a later onset, however wide the grid's steps are.
        tally.require_strictly(pair[1].0 - pair[0].0, 0.0, String::new);
    }
    let words: Vec<String> = claim
        .order
        .iter()
        .zip(&found)
        .map(|(onset, (x, unit))| format!("{} from {}", symbol(&onset.of), place(&claim.over, *x, 3, unit)))
        .collect();
    Ok(Decision { found: words.join(", "), ..tally.decision()? })
}
