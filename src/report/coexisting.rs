//! Where motions coexist: sweeps followed up and down whose two directions end in different motions, and random starts that do.

use super::markdown::{Align, MarkdownTable, details};
use crate::dynamics::MotionKind;
use crate::experiment::{Direction, Experiment, Starts};
use crate::measure::Measure;
use crate::reference::symbol;
use crate::study::{CaseShares, Motions};
use crate::table::Table;
use crate::text::number::{compact, significant};
use crate::text::words::{counted, of_key};

/// A velocity ratio that differs by less is the same for every reader.
const SAME: f64 = 1e-3;

/// The answer of a page of sweeps in a sentence; `None` where the rows are not followed in both directions, or their motion was not measured.
pub(super) fn in_short(experiment: &Experiment, table: &Table) -> Option<String> {
    let [continued] = experiment.continued.as_slice() else { return None };
    let table = table.baseline();
    let motions = table.texts(&of_key(&Measure::Motion))?;
    let ratios = table.floats(&of_key(&Measure::VelocityRatio))?;
    if motions.len() != experiment.cases.len() {
        return None;
    }
    let rows = |direction| (0..motions.len()).filter(move |&row| experiment.cases[row].direction == Some(direction));
    let pairs: Vec<(usize, usize)> = rows(Direction::Up)
        .filter_map(|up| {
            Some((
                up,
                rows(Direction::Down).find(|&down| experiment.cases[down].values == experiment.cases[up].values)?,
            ))
        })
        .collect();
    if pairs.is_empty() {
        return None;
    }
    let off = |&(up, down): &(usize, usize)| (ratios[down] / ratios[up] - 1.0).abs();
    let differ: Vec<(usize, usize)> =
        pairs.iter().copied().filter(|pair| are_two(&motions[pair.0], &motions[pair.1]) && off(pair) > SAME).collect();
    let all = counted(pairs.len(), "value", "values");
    let name = symbol(&of_key(&continued.along));
    let at = differ.iter().filter_map(|&(up, _)| experiment.cases[up].number(continued.along));
    let (least, most) = at.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| (least.min(x), most.max(x)));
    let Some(worst) = differ.iter().max_by(|a, b| off(a).total_cmp(&off(b))) else {
        return Some(format!("**In short.** No two motions coexist at {all} of {name}, going up and coming down.\n\n"));
    };
    Some(format!(
        "**In short.** Two motions coexist at {} of {all}, {name} = {} to {}: {} going up, {} coming down. \
         Their velocity ratios differ by at most {} %.\n\n",
        differ.len(),
        compact(least, 4),
        compact(most, 4),
        motions[worst.0],
        motions[worst.1],
        significant(100.0 * off(worst), 2),
    ))
}

/// Cases of several motions that the page lists.
const MOST_LISTED: usize = 24;

/// The answer of a page of random starts in a sentence.
pub(super) fn of_starts_in_short(
    experiment: &Experiment,
    starts: &Starts,
    table: &Table,
    motions: Option<&Motions>,
) -> Option<String> {
    let cases = CaseShares::of(experiment, table);
    let several: Vec<&CaseShares> = cases.iter().filter(|case| case.settled().count() > 1).collect();
    let lead = format!("**In short.** {}", motions.and_then(best).unwrap_or_default());
    let from = format!("From {}", counted(starts.count as usize, "random start", "random starts"));
    let each = if cases.len() > 1 { " each" } else { "" };
    let left = |case: &CaseShares| 1.0 - case.settled().map(|motion| motion.share).sum::<f64>();
    let unsettled = cases.iter().map(left).fold(0.0, f64::max);
    let rest = if unsettled > 0.5 / f64::from(starts.count) {
        format!(" Up to {} of the starts of a case had not settled.", percent(unsettled))
    } else {
        String::new()
    };
    let second = |case: &&&CaseShares| case.settled().nth(1).map_or(0.0, |motion| motion.share);
    let Some(even) = several.iter().max_by(|a, b| second(a).total_cmp(&second(b))) else {
        let only = |case: &CaseShares| case.settled().next().map(|motion| motion.motion.clone());
        let first = cases.first().and_then(only)?;
        let name = if cases.iter().all(|case| only(case).as_ref() == Some(&first)) {
            format!(", {first}")
        } else {
            String::new()
        };
        let of = if cases.len() > 1 { format!(" in each of {} cases", cases.len()) } else { String::new() };
        return Some(format!("{lead}{from}{each}, one motion attracts{of}{name}.{rest}\n\n"));
    };
    let shares: Vec<String> = even
        .settled()
        .map(|it| {
            format!(
                "{} with {} ({} to {})",
                it.motion,
                percent(it.share),
                percent(it.interval[0]),
                percent(it.interval[1])
            )
        })
        .collect();
    let ratios = || even.settled().map(|motion| motion.velocity_ratio).filter(|ratio| ratio.is_finite());
    let (least, most) = ratios().fold((f64::INFINITY, 0.0_f64), |(least, most), x| (least.min(x), most.max(x)));
    let ratios = if most > least {
        format!(" Their velocity ratios are {} to {}.", significant(least, 4), significant(most, 4))
    } else {
        String::new()
    };
    let range = match experiment.swept.as_slice() {
        [_] => format!(", {} to {}", several[0].case, several[several.len() - 1].case),
        _ => String::new(),
    };
    let place = match cases.len() {
        1 => "several motions attract".to_owned(),
        all => {
            format!("several motions attract in {} of {all} cases{range}; most evenly at {}", several.len(), even.case)
        }
    };
    Some(format!("{lead}{from}{each}, {place}: {}.{ratios}{rest}\n\n", shares.join(", ")))
}

/// Of several dampers the best motion that attracts.
fn best(motions: &Motions) -> Option<String> {
    let best = motions.best.iter().max_by(|a, b| a.velocity_ratio.total_cmp(&b.velocity_ratio))?;
    let at = if best.at.is_empty() { String::new() } else { format!(" and {}", best.at) };
    Some(format!(
        "The best motion that attracts is {} at {}{at}: ψ = {}, reached from {} of the starts. ",
        best.motion,
        best.damper,
        significant(best.velocity_ratio, 4),
        percent(best.share),
    ))
}

/// The cases in which several motions attract.
pub(super) fn section(experiment: &Experiment, table: &Table) -> String {
    let cases = CaseShares::of(experiment, table);
    let several: Vec<&CaseShares> = cases.iter().filter(|case| case.motions.len() > 1).collect();
    let mut text = MarkdownTable::new(&[
        ("Case", Align::Left),
        ("Motion", Align::Left),
        ("Share", Align::Right),
        ("95 %", Align::Right),
        ("ψ", Align::Right),
    ]);
    for case in several.iter().take(MOST_LISTED) {
        for (place, one) in case.motions.iter().enumerate() {
            let [low, high] = one.interval.map(percent);
            let ratio = one.velocity_ratio;
            text.row(vec![
                if place == 0 { case.case.clone() } else { String::new() },
                one.motion.clone(),
                percent(one.share),
                format!("{low} to {high}"),
                if ratio.is_finite() { significant(ratio, 4) } else { String::new() },
            ]);
        }
    }
    let more = match several.len().saturating_sub(MOST_LISTED) {
        0 => String::new(),
        more => format!("and {more} more cases.\n\n"),
    };
    details("Cases with several motions", &(text.finish() + &more))
}

fn percent(share: f64) -> String {
    format!("{} %", compact(100.0 * share, 3))
}

/// True for names of two motions of which at least one comes again; a run that has not settled may be on its way to either.
fn are_two(up: &str, down: &str) -> bool {
    let kinds = [up, down].map(|name| name.parse::<MotionKind>().ok());
    let settled = kinds.iter().all(|kind| kind.is_some_and(|kind| kind != MotionKind::NotSettled));
    settled && up != down && kinds.iter().flatten().any(|kind| kind.repeats())
}
