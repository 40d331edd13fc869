//! Sweeps followed up and down: where the two directions end in different motions, two motions coexist.

use super::branch::symbol;
use crate::dynamics::MotionKind;
use crate::experiment::{Case, Direction, Experiment, Parameter, ParameterValue};
use crate::measure::Measure;
use crate::table::Table;
use crate::text::number::{compact, significant};
use crate::text::words::{counted, of_key};

/// A velocity ratio that differs by less is the same for every reader.
const SAME: f64 = 1e-3;

/// The answer of the page in a sentence; `None` where the rows are not followed in both directions, or their motion was not measured.
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
    let name = symbol(continued.along);
    let at = differ.iter().filter_map(|&(up, _)| value(&experiment.cases[up], continued.along));
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

/// True for names of two motions of which at least one comes again; a run that has not settled may be on its way to either.
fn are_two(up: &str, down: &str) -> bool {
    let kinds = [up, down].map(|name| name.parse::<MotionKind>().ok());
    let settled = kinds.iter().all(|kind| kind.is_some_and(|kind| kind != MotionKind::NotSettled));
    settled && up != down && kinds.iter().flatten().any(|kind| kind.repeats())
}

fn value(case: &Case, along: Parameter) -> Option<f64> {
    match case.get(along) {
        Some(ParameterValue::Number(x)) => Some(x),
        _ => None,
    }
}
