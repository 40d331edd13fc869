//! What moves how: the kinds of motion that the rows of an experiment end in, and whether the cycles left out are enough.

use crate::dynamics::{MotionKind, Until};
use crate::experiment::Experiment;
use crate::measure::Measure;
use crate::table::Table;
use crate::text::words::{counted, of_key};

/// The part of an experiment's page; nothing where the motion is not measured, or of one row alone.
pub(super) fn section(experiment: &Experiment, table: &Table) -> String {
    let baseline = table.baseline();
    let names = baseline.texts(&of_key(&Measure::Motion)).unwrap_or_default();
    let kinds: Vec<MotionKind> = names.iter().filter_map(|name| name.parse().ok()).collect();
    let mut tally: Vec<(&str, usize)> = Vec::new();
    for kind in &kinds {
        match tally.iter_mut().find(|(word, _)| *word == kind.word()) {
            Some((_, count)) => *count += 1,
            None => tally.push((kind.word(), 1)),
        }
    }
    if kinds.len() < 2 {
        return String::new();
    }
    tally.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let share = |count: usize| format!("{:.0} %", 100.0 * count as f64 / kinds.len() as f64);
    let parts: Vec<String> = tally.iter().map(|(word, count)| format!("{count} {word} ({})", share(*count))).collect();
    let rows = counted(kinds.len(), "row", "rows");
    let mut text = format!("**What moves how.** Of {rows}: {}.", parts.join(", "));
    let settled: Vec<f64> = baseline
        .floats(&of_key(&Measure::SettledAfter))
        .unwrap_or_default()
        .into_iter()
        .filter(|x| !x.is_nan())
        .collect();
    let skip = f64::from(experiment.settings.skip);
    let late = settled.iter().filter(|cycles| **cycles > skip).count();
    if late > 0 && experiment.settings.until == Until::Cycles {
        let longest = settled.iter().copied().fold(0.0, f64::max);
        let which = if late == settled.len() { "All".into() } else { format!("{late} of the") };
        text += &format!(
            " {which} {} whose motion comes again settle to a millionth only after the {} left out, the last after {longest}: what \
             is left of the transient is in their averages.",
            settled.len(),
            counted(experiment.settings.skip as usize, "cycle", "cycles"),
        );
    }
    text + "\n\n"
}
